// A frame's slice of the 4D tables. All views of an observer inside the shell share altitude and sun, so that the tables
// can be weighed along those two axes once a frame, and looked up in two: the same answer for a fraction of the fetches.
// Wants shell.wgsl. Slices are an array of 32-bit float textures, azimuth along x, view along y, a layer for each
// table: 0 the main one, 1 + k the k-th group of single scattering. 32-bit floats that can be filtered are a feature
// that a GPU may lack.

// The texel of a slice, for the pass that fills it: stored samples weighed by altitude and sun.
fn slice_texel(t: Table, texture: texture_3d<f32>, altitude: f32, mu_s: f32, at: vec2i, group: i32) -> vec4f {
    let x = altitude_texel(t, altitude);
    let sun = sun_texel(t, mu_s);
    let low = vec2i(vec2f(x, sun));
    let high = min(low + 1, vec2i(t.size.xz) - 1);
    let w = vec2f(x, sun) - vec2f(low);
    let suns = i32(t.size.z);
    let first = (group * i32(t.size.w) + at.x) * suns;
    let below = mix(
        textureLoad(texture, vec3i(low.x, at.y, first + low.y), 0),
        textureLoad(texture, vec3i(high.x, at.y, first + low.y), 0),
        w.x,
    );
    let above = mix(
        textureLoad(texture, vec3i(low.x, at.y, first + high.y), 0),
        textureLoad(texture, vec3i(high.x, at.y, first + high.y), 0),
        w.x,
    );
    return mix(below, above, w.y);
}

// Stored sample of a view of the slice's altitude and sun.
fn fetch_sliced(t: Table, slices: texture_2d_array<f32>, filtering: sampler, p: Place, layer: i32) -> vec4f {
    let at = vec2f(texel(p.azimuth, t.size.w), view_texel(t, p));
    return textureSampleLevel(slices, filtering, (at + 0.5) / vec2f(textureDimensions(slices)), layer, 0.0);
}

// Stored samples of a view of the slices' altitude and sun, of all layers.
fn fetch_slices(t: Tables, slices: texture_2d_array<f32>, filtering: sampler, p: Place) -> Stored {
    var stored: Stored;
    stored.volume = fetch_sliced(t.volume, slices, filtering, p, 0);
    for (var k = 0; k < i32(t.counts.x); k++) {
        stored.single[k] = fetch_sliced(t.single, slices, filtering, p, k + 1);
    }
    return stored;
}
