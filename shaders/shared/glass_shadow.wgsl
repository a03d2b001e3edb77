#define_import_path asvgf::glass_shadow

// Light through glass on its way to a matte surface. Failure: behind glass it was dark, because a light sample is blocked and the
// scattered rays that find a small lamp are few. Reason: the way that refraction takes to the lamp is not known. Rule: such light
// goes straight. Each boundary takes what it mirrors and colours the rest; bodies absorb over the length inside, so nothing is lost
// but the focus of lenses (caustics) and the shift of thick panes.
//
// Rays meet boundaries in any order, so lengths are sums: a ray that enters at t₁ and leaves at t₂ has σ·t₂ − σ·t₁ of optical depth.

#import asvgf::glass_scattering::{is_glass, straight_part}
#import asvgf::material::surface_at
#import asvgf::scene::{geometry_word, load_material, TRANSMITTING}
#import asvgf::surface::{Visible, triangle_now}

// The part of the light that boundaries let through.
var<private> boundaries: vec3<f32>;
// Optical depth of the bodies that have been left, less that before the entries.
var<private> optical_depth: vec3<f32>;
// Absorption of the bodies that have been entered, less that of those that have been left.
var<private> entered: vec3<f32>;
// True if the ray has met glass.
var<private> met_glass: bool;

// Starts a ray.
fn begin_shadow() {
    boundaries = vec3(1.0);
    optical_depth = vec3(0.0);
    entered = vec3(0.0);
    met_glass = false;
}

// True if a ray goes through this point of a triangle, because it is glass; then its colour is taken into account.
fn goes_through(v: Visible, weights: vec2<f32>, distance: f32, direction: vec3<f32>) -> bool {
    if (load_material(geometry_word(v.row * 3u).w).flags & TRANSMITTING) == 0u {
        return false;
    }
    let s = surface_at(v, triangle_now(v), weights, direction);
    if !is_glass(s) {
        return false;
    }
    met_glass = true;
    boundaries *= straight_part(s, abs(dot(s.view, s.normal)));
    if !s.thin {
        let sign = select(-1.0, 1.0, s.inside);
        optical_depth += sign * distance * s.absorption;
        entered -= sign * s.absorption;
    }
    return true;
}

// The part of the light that arrives over a free ray of this length.
fn arriving_part(length: f32) -> vec3<f32> {
    // A ray that ends inside a body has entered it and not left it.
    return boundaries * exp(-max(optical_depth + max(entered, vec3(0.0)) * length, vec3(0.0)));
}
