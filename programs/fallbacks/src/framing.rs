//! A camera for scenes that have none.

use asvgf::Camera;
use asvgf::scene::Scene;
use glam::DVec3;

/// Returns the box around everything, at rest and at some moments of the animation.
pub fn bounds(scene: &Scene) -> Option<[DVec3; 2]> {
    let moments = 12;
    let duration = scene.duration(Some(0));
    let times = (0..moments).map(|i| duration * i as f32 / moments as f32);
    let boxes = times.filter_map(|time| scene.bounds(&scene.pose(Some(0), time)));
    boxes.map(|b| b.map(DVec3::from)).reduce(|[low, high], [l, h]| [low.min(l), high.max(h)])
}

/// Returns a camera in front, to the right and slightly above, so far away that the box just fits.
pub fn framing([low, high]: [DVec3; 2], aspect: f32, fov_y: f32) -> Camera {
    let towards = DVec3::new(0.55, 0.35, 1.0).normalize();
    let right = DVec3::Y.cross(towards).normalize();
    let up = towards.cross(right);
    let centre = 0.5 * (low + high);
    let (slope, aspect) = (f64::from(fov_y / 2.0).tan(), f64::from(aspect));
    // A corner at (x, y, z) in the camera's directions is in the picture if the distance is at least z + |y| / slope.
    let distance = (0..8_u32).fold(0.0_f64, |distance, i| {
        let corner = DVec3::select(glam::BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), high, low) - centre;
        let sideways = (corner.dot(right).abs() / aspect).max(corner.dot(up).abs());
        distance.max(corner.dot(towards) + 1.05 * sideways / slope)
    });
    // The maximum handles a scene that is one point.
    let eye = centre + towards * distance.max(1e-3);
    Camera { eye: eye.to_array(), target: centre.to_array(), up: [0.0, 1.0, 0.0], fov_y, jitter: [0.0; 2] }
}
