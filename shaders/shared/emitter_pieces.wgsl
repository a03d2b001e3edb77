#define_import_path asvgf::emitter_pieces

#import asvgf::scene::{Light, light_word}
#import asvgf::random::hash

// An emitting triangle with an uneven image is divided into n² equal triangles on the grid of its barycentric weights, n = 2^level, and
// light samples choose a piece by its mean light. The numbers of the pieces are those of src/scene/gpu/emission/grid.rs: an upright piece
// is a cell of a square of n × n cells, and a point reflection in the middle of the square takes the other pieces to the other cells.

// A sampled point of an emitter.
struct Piece {
    // Barycentric weights of `b` and `c`.
    weights: vec2<f32>,
    // Density of the point, in units of the even density over the triangle.
    density: f32,
}

// An entry of the table: the other piece, the threshold below which this one is kept, the density of this one.
fn piece_entry(light: Light, piece: u32) -> vec4<u32> {
    return light_word(light.pieces + piece);
}

// Density with which `sample_piece` finds a point.
fn piece_density(light: Light, weights: vec2<f32>) -> f32 {
    if light.level == 0u {
        return 1.0;
    }
    let rows = 1u << light.level;
    let place = max(weights, vec2(0.0)) * f32(rows);
    let cell = min(vec2<u32>(place), vec2(rows - 1u));
    let within = place - vec2<f32>(cell);
    let number = select(cell, rows - 1u - cell, within.x + within.y > 1.0);
    return bitcast<f32>(piece_entry(light, (number.x << light.level) | number.y).z);
}

// Samples a point of an emitter.
fn sample_piece(light: Light, u: vec2<f32>) -> Piece {
    if light.level == 0u {
        // Uniform over the triangle.
        let r = sqrt(u.x);
        return Piece(vec2(r * (1.0 - u.y), r * u.y), 1.0);
    }
    // The number of the piece uses up to 12 of the 24 bits of a random number. The thresholds of faint pieces need more than the rest: a
    // hash of both numbers gives 32 more.
    let more = hash(bitcast<u32>(u.x) ^ hash(bitcast<u32>(u.y)));
    let number = u32(u.x * 16777216.0);
    let bits = 2u * light.level;
    let entry = number >> (24u - bits);
    let within = f32((number << (8u + bits)) | (more >> (24u - bits))) * (1.0 / 4294967296.0);
    let choice = piece_entry(light, entry);
    let piece = select(choice.x, entry, within < bitcast<f32>(choice.y));
    let density = bitcast<f32>(piece_entry(light, piece).z);
    // Uniform over the piece.
    let r = sqrt(f32(hash(more)) * (1.0 / 4294967296.0));
    let rows = 1u << light.level;
    let cell = vec2(piece >> light.level, piece & (rows - 1u));
    let place = (vec2<f32>(cell) + vec2(r * (1.0 - u.y), r * u.y)) / f32(rows);
    return Piece(select(place, 1.0 - place, cell.x + cell.y >= rows), density);
}
