// A baked water as the preview binds it.

@group(1) @binding(1) var<uniform> sea: Water;
@group(1) @binding(2) var sea_own: texture_3d<f32>;
@group(1) @binding(3) var sea_sky: texture_3d<f32>;
@group(1) @binding(4) var sea_seabed: texture_2d<f32>;
@group(1) @binding(5) var sea_seabed_sun: texture_2d<f32>;
@group(1) @binding(6) var sea_seabed_depth: texture_2d<f32>;
@group(1) @binding(7) var sea_irradiance: texture_2d<f32>;
@group(1) @binding(8) var sea_fresnel: texture_2d<f32>;

// Light at the four wavelengths that leaves the water where a view meets it.
fn sea_leaving(p: Place, deep: f32) -> vec4f {
    return water_leaving(
        sea,
        sea_own,
        sea_sky,
        sea_seabed,
        sea_seabed_sun,
        sea_seabed_depth,
        sea_irradiance,
        sea_fresnel,
        filtering,
        deep,
        water_cosine(tables.volume, p),
        sun_at_ground(tables.volume, p),
    );
}
