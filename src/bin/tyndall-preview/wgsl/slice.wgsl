// Fills the slices of a frame.

// Altitude and sun of the observer.
@group(1) @binding(0) var<uniform> here: vec4f;
@group(1) @binding(1) var filled: texture_storage_2d_array<rgba32float, write>;

@compute @workgroup_size(8, 8, 1)
fn slice(@builtin(global_invocation_id) id: vec3u) {
    let at = vec2i(id.xy);
    let layer = i32(id.z);
    if layer == 0 {
        if all(vec2f(at) < tables.volume.size.wy) {
            textureStore(filled, at, 0, slice_texel(tables.volume, volume, here.x, here.y, at, 0));
        }
        return;
    }
    if tables.counts.x > 0.5 {
        if all(vec2f(at) < tables.single.size.wy) {
            textureStore(filled, at, layer, slice_texel(tables.single, single, here.x, here.y, at, layer - 1));
        }
        return;
    }
    textureStore(filled, at, layer, sunlight_at(tables.depth, depth, filtering, here.x, here.y));
}
