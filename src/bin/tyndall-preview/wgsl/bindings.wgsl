// A baked layout as the preview binds it. `volume` is `multiple` or `scattering`. Its `Tables` are the constant `tables`
// that follows; a uniform does too, at twice the time in software.

@group(0) @binding(1) var filtering: sampler;
@group(0) @binding(2) var volume: texture_3d<f32>;
@group(0) @binding(3) var single: texture_3d<f32>;
@group(0) @binding(4) var depth: texture_2d<f32>;
@group(0) @binding(5) var scatterers: texture_2d<f32>;
@group(0) @binding(6) var irradiance: texture_2d<f32>;
@group(0) @binding(7) var phase: texture_2d<f32>;
@group(0) @binding(8) var slices: texture_2d_array<f32>;

// Whether slices are there and hold the observer's altitude and sun.
override SLICED: bool = false;
// Whether any of the pixels drawn may show ground.
override GROUND: bool = true;
