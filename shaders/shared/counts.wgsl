#define_import_path asvgf::counts

// Numbers of the host's pixels that had to be cleaned. Mirrored by `InputCounts` in src/gpu/counts.rs.
struct Counts {
    // Pixels with a depth and without a usable normal or motion.
    surfaces: atomic<u32>,
    // Pixels with a number that is not finite in radiance, albedo or emission.
    non_finite: atomic<u32>,
    // Pixels with a negative number there.
    negative: atomic<u32>,
    // Strata whose pair is not finite.
    pairs: atomic<u32>,
    // Pixels whose sample is brighter than is believed (outliers.wgsl).
    outliers: atomic<u32>,
}

@group(0) @binding(29) var<storage, read_write> counts: Counts;
