#define_import_path asvgf::sample

// A pixel's demodulated radiance in this frame: from the image of the path tracer or of ingest_radiance.wgsl or, with HOST_LIGHT,
// from the host's own images.

#ifdef HOST_LIGHT
#import asvgf::host_light::host_sample
#else
@group(0) @binding(28) var radiance: texture_2d<u32>;
#endif

fn sample_at(pixel: vec2<i32>, hit: bool) -> vec2<u32> {
#ifdef HOST_LIGHT
    return host_sample(pixel, hit);
#else
    return textureLoad(radiance, pixel, 0).xy;
#endif
}
