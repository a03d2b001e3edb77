//! The camera that the mouse moves: around a point, or on foot.

use asvgf::Camera;
use glam::{DVec3, Vec3};
use std::f32::consts::{FRAC_PI_2, TAU};

/// Angle in radians of a drag across the whole height of the picture.
const TURN: f32 = 3.0;

/// A camera as angles about its target, +Y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// Target, in double precision so that the camera moves smoothly far from the origin.
    target: DVec3,
    /// Angle from +Z towards +X.
    yaw: f32,
    /// Angle above the horizon.
    pitch: f32,
    distance: f32,
    fov_y: f32,
}

impl Orbit {
    /// Starts from another camera, with a target as far away as the scene's centre.
    pub fn from(camera: &Camera, centre: [f64; 3]) -> Self {
        let (eye, target) = (DVec3::from(camera.eye), DVec3::from(camera.target));
        let forward = (target - eye).normalize_or(DVec3::NEG_Z);
        // A scene's own camera has a target one metre ahead, whatever it looks at.
        let distance = (DVec3::from(centre) - eye).dot(forward).max(0.1);
        let target = eye + forward * distance;
        let forward = forward.as_vec3();
        let pitch = (-forward.y).clamp(-1.0, 1.0).asin();
        Self { target, yaw: (-forward.x).atan2(-forward.z), pitch, distance: distance as f32, fov_y: camera.fov_y }
            .level()
    }

    /// Goes around the target by a drag in fractions of the picture's height.
    pub fn orbit(&mut self, [x, y]: [f32; 2]) {
        *self = Self { yaw: (self.yaw - TURN * x) % TAU, pitch: self.pitch + TURN * y, ..*self }.level();
    }

    /// Turns the head.
    pub fn look(&mut self, [x, y]: [f32; 2]) {
        let eye = self.eye();
        // Turning has a pace of its own: the picture has to follow the pointer.
        *self = Self { yaw: self.yaw + self.fov_y * x, pitch: self.pitch - self.fov_y * y, ..*self }.level();
        self.target = eye - (self.backward() * self.distance).as_dvec3();
    }

    /// Moves sideways and up so that the target follows the pointer.
    pub fn pan(&mut self, [x, y]: [f32; 2]) {
        let height = 2.0 * self.distance * (self.fov_y / 2.0).tan();
        self.target += (height * (y * self.up() - x * self.right())).as_dvec3();
    }

    /// Moves nearer to the target if steps > 0, else farther away.
    pub fn approach(&mut self, steps: f32) {
        self.distance = (self.distance * 0.9_f32.powf(steps)).clamp(1e-3, 1e6);
    }

    /// Walks to the right, up and forward, by fractions of the distance to the target.
    pub fn walk(&mut self, [right, up, forward]: [f32; 3]) {
        let way = right * self.right() + up * Vec3::Y - forward * self.backward();
        self.target += (self.distance * way).as_dvec3();
    }

    /// Turns a quarter of the way around, at once.
    pub fn cut(&mut self) {
        self.orbit([TAU / 4.0 / TURN, 0.0]);
    }

    /// The camera for the renderer.
    pub fn camera(&self) -> Camera {
        Camera { eye: self.eye().to_array(), target: self.target.to_array(), fov_y: self.fov_y, ..Camera::default() }
    }

    fn eye(&self) -> DVec3 {
        self.target + (self.backward() * self.distance).as_dvec3()
    }

    fn backward(&self) -> Vec3 {
        let (yaw, pitch) = (self.yaw.sin_cos(), self.pitch.sin_cos());
        Vec3::new(yaw.0 * pitch.1, pitch.0, yaw.1 * pitch.1)
    }

    fn right(&self) -> Vec3 {
        Vec3::new(self.yaw.cos(), 0.0, -self.yaw.sin())
    }

    fn up(&self) -> Vec3 {
        self.backward().cross(self.right())
    }

    /// Limits the pitch, because there is no sideways direction straight up or down.
    fn level(self) -> Self {
        let most = FRAC_PI_2 - 0.01;
        Self { pitch: self.pitch.clamp(-most, most), ..self }
    }
}

/// Returns the same camera in a trembling hand.
pub fn shaken(camera: Camera, time: f32) -> Camera {
    let distance = DVec3::from(camera.eye).distance(camera.target.into()).max(1.0);
    // Frequencies without a common period, so that no frame repeats.
    let offset = Vec3::new((17.0 * time).sin(), (23.0 * time).sin(), (29.0 * time).sin()).as_dvec3();
    Camera { eye: (DVec3::from(camera.eye) + 0.01 * distance * offset).to_array(), ..camera }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn orbit() -> Orbit {
        let camera = Camera { eye: [1.0, 2.0, 4.0], target: [0.5, 1.5, 3.0], ..Camera::default() };
        Orbit::from(&camera, [0.0, 1.0, 0.0])
    }

    fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
        DVec3::from(a).distance(b.into())
    }

    #[test]
    fn it_starts_where_the_other_camera_is_and_looks_the_same_way() {
        let camera = orbit().camera();
        assert!(distance(camera.eye, [1.0, 2.0, 4.0]) < 1e-5);
        let forward = (DVec3::from(camera.target) - DVec3::from(camera.eye)).normalize();
        assert!(forward.distance(DVec3::new(-0.5, -0.5, -1.0).normalize()) < 1e-5);
    }

    #[test]
    fn going_around_keeps_the_distance_and_looking_keeps_the_eye() {
        let (before, mut around, mut head) = (orbit(), orbit(), orbit());
        around.orbit([0.3, -0.2]);
        assert_eq!(around.camera().target, before.camera().target);
        let apart = |o: &Orbit| distance(o.camera().eye, o.camera().target);
        assert!((apart(&around) - apart(&before)).abs() < 1e-5);
        head.look([0.3, -0.2]);
        assert!(distance(head.camera().eye, before.camera().eye) < 1e-5);
        assert!(distance(head.camera().target, before.camera().target) > 0.1);
    }

    #[test]
    fn dragging_to_the_right_moves_what_is_seen_to_the_right() {
        // The place of the old target after a drag to the right and down, in the picture's axes.
        for drag in [Orbit::look, Orbit::pan] {
            let (before, mut after) = (orbit(), orbit());
            drag(&mut after, [0.1, 0.1]);
            let seen = (before.target - after.eye()).as_vec3();
            assert!(seen.dot(after.right()) > 0.0 && seen.dot(after.up()) < 0.0);
        }
    }

    #[test]
    fn far_from_the_origin_it_moves_in_small_steps_too() {
        let camera = Camera { eye: [524_288.0, 2.0, 4.0], target: [524_288.0, 2.0, 3.0], ..Camera::default() };
        let mut orbit = Orbit::from(&camera, [524_288.0, 2.0, 0.0]);
        let before = orbit.camera().eye;
        orbit.walk([1e-4, 0.0, 0.0]);
        assert!((orbit.camera().eye[0] - before[0] - 4e-4).abs() < 1e-8);
    }

    #[test]
    fn it_never_looks_straight_down() {
        let mut orbit = orbit();
        orbit.orbit([0.0, 100.0]);
        assert!(orbit.right().dot(orbit.up()).abs() < 1e-5 && orbit.camera().eye[1] > orbit.camera().target[1]);
        assert!((DVec3::from(orbit.camera().eye) - orbit.target).normalize().y < 1.0);
    }

    #[test]
    fn four_cuts_come_back() {
        let mut orbit = orbit();
        let eye = orbit.camera().eye;
        (0..4).for_each(|_| orbit.cut());
        assert!(distance(orbit.camera().eye, eye) < 1e-4);
    }
}
