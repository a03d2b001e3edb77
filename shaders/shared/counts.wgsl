#define_import_path asvgf::counts

// How many pixels of the host's had to be cleaned. Mirrored by `InputCounts` in src/gpu/counts.rs.
struct Counts {
    // A depth without a usable normal or motion.
    surfaces: atomic<u32>,
    // Something not finite in radiance, albedo or emission.
    non_finite: atomic<u32>,
    // Something negative there.
    negative: atomic<u32>,
    // Strata whose pair is not finite.
    pairs: atomic<u32>,
    // Pixels whose sample was brighter than is believed.
    outliers: atomic<u32>,
}

@group(0) @binding(29) var<storage, read_write> counts: Counts;
