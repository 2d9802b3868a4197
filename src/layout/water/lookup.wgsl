// Look-ups in baked waters, seen from above; wants shell.wgsl, where the conventions of angles and of decoding stand.
//
// Conventions
//  - The surface is flat and bends with the planet: a sphere of the ground's radius. `mu` is the cosine between the ray
//    in the air and the vertical where the two meet, 0..1, `mu_s` that of the sun's zenith angle there: `water_cosine`
//    and `sun_at_ground` find them for a view. Refraction is in the tables, whose view axis is even in the cosine of the
//    refracted ray.
//  - `depth` is that of the water in m, 0 to Water.axes.x, and may differ from pixel to pixel.
//  - Light comes over the star's irradiance, 1/sr, at four wavelengths, as it leaves the surface; the air before it is
//    the caller's: times exp(-optical depth) of the view. `water_rgb_of` makes linear RGB of it, luminance over the
//    star's illuminance, by a matrix of the water's own.
//  - It is the mean over the azimuth between view and sun. What the surface mirrors is no part of it: that is
//    `water_mirrors` times the sky's answer at altitude 0 for (mu, mu_s, nu + 2 mu mu_s), the mirrored view.
//  - <name> and <name>_sky are 3D textures (depth, view, and sun or part of the sky), the others 2D; of `fresnel`
//    the water's own slice. All are half-float RGBA and want linear filtering, but across parts of the sky and rows.
//  - Everything that these functions need of bake.json is in `Water`, made by the code that loads the textures.

struct Water {
    // <name>, <name>_sky, <name>_seabed, <name>_seabed_sun, <name>_seabed_depth, irradiance, fresnel: sizes and decoding.
    own: Table,
    sky: Table,
    seabed: Table,
    seabed_sun: Table,
    seabed_depth: Table,
    irradiance: Table,
    fresnel: Table,
    // Constants of the axes: D_max in m and p of the depth, n of the view, mu_min of the sun in `irradiance`.
    axes: vec4f,
    // Albedo of the bed. Any other may be put in its place: the bed's light is apart in the tables.
    bed: vec4f,
    // Rate of the rise with depth that the tables of own light leave out, 1/m.
    kappa: vec4f,
    // Rows R, G, B from the four wavelengths, over the star's illuminance.
    rgb: array<vec4f, 3>,
}

// Irradiance that the sun brings into the water, and that of the surface by the sky: by a part as bright as mu, which
// is high in the sky, and one as bright as (1 - mu)^2, which is low.
struct Entering {
    sun: vec4f,
    high: vec4f,
    low: vec4f,
}

// Cosine between a ray that hits the ground and the vertical there; of differences as products, see `ray_length`.
fn water_cosine(t: Table, p: Place) -> f32 {
    let along = (t.radii.x + p.altitude) * p.mu;
    let z1 = horizon_distance(t, p.altitude);
    return clamp(sqrt(max((-along - z1) * (z1 - along), 0.0)) / t.radii.x, 0.0, 1.0);
}

// 0..1 along the depth axes.
fn water_depth_coordinate(w: Water, depth: f32) -> f32 {
    return pow(clamp(depth / w.axes.x, 0.0, 1.0), 1.0 / w.axes.y);
}

// 0..1 along the view axes: the cosine in the water, from the edge of Snell's window on.
fn water_view_coordinate(w: Water, mu: f32) -> f32 {
    let n2 = w.axes.z * w.axes.z;
    let critical = sqrt(1.0 - 1.0 / n2);
    let inside = sqrt(1.0 - (1.0 - mu) * (1.0 + mu) / n2);
    return mu * mu / (n2 * max(inside + critical, 1e-6) * (1.0 - critical));
}

// A row at 0..1 along x. Two texels, weighed by hand: rows are not filtered, and near the horizon steps of a texture
// unit would show.
fn water_row(t: Table, texture: texture_2d<f32>, x: f32, row: i32) -> vec4f {
    let at = texel(x, t.size.x);
    let low = i32(at);
    let high = min(low + 1, i32(t.size.x) - 1);
    let stored = mix(textureLoad(texture, vec2i(low, row), 0), textureLoad(texture, vec2i(high, row), 0), at - f32(low));
    return decode(t, stored);
}

// Share of light that the surface mirrors, from the air.
fn water_mirrors(w: Water, fresnel: texture_2d<f32>, mu: f32) -> vec4f {
    return water_row(w.fresnel, fresnel, mu, 0);
}

// Share that passes the surface. Not 1 - water_mirrors, which has few digits near the horizon.
fn water_passes(w: Water, fresnel: texture_2d<f32>, mu: f32) -> vec4f {
    return water_row(w.fresnel, fresnel, mu, 3);
}

fn water_entering(w: Water, irradiance: texture_2d<f32>, fresnel: texture_2d<f32>, mu_s: f32) -> Entering {
    let lowest = w.axes.w;
    if mu_s < lowest {
        return Entering(vec4f(0.0), vec4f(0.0), vec4f(0.0));
    }
    let x = (mu_s - lowest) / (1.0 - lowest);
    let sun = water_row(w.irradiance, irradiance, x, 0) * water_passes(w, fresnel, mu_s);
    return Entering(sun, water_row(w.irradiance, irradiance, x, 1), water_row(w.irradiance, irradiance, x, 2));
}

// Light of the water itself over a black bed, below the surface over n^2.
fn water_own(
    w: Water,
    own: texture_3d<f32>,
    sky: texture_3d<f32>,
    filtering: sampler,
    entering: Entering,
    depth: f32,
    mu: f32,
    mu_s: f32,
) -> vec4f {
    let x = water_depth_coordinate(w, depth);
    let y = water_view_coordinate(w, mu);
    let at = vec3f(texel(x, w.own.size.x), texel(y, w.own.size.y), texel(mu_s, w.own.size.z));
    let above = vec2f(texel(x, w.sky.size.x), texel(y, w.sky.size.y));
    let light = entering.sun * decode(w.own, fetch_volume(own, filtering, at))
        + entering.high * decode(w.sky, fetch_volume(sky, filtering, vec3f(above, 0.0)))
        + entering.low * decode(w.sky, fetch_volume(sky, filtering, vec3f(above, 1.0)));
    return light * select(vec4f(1.0), opacity(w.kappa * depth), w.kappa > vec4f(0.0));
}

// Radiance of the bed itself with all its bounces between water and surface.
fn water_bed(
    w: Water,
    seabed_sun: texture_2d<f32>,
    seabed_depth: texture_2d<f32>,
    filtering: sampler,
    entering: Entering,
    depth: f32,
    mu_s: f32,
) -> vec4f {
    let x = water_depth_coordinate(w, depth);
    let at = vec2f(texel(x, w.seabed_sun.size.x), texel(mu_s, w.seabed_sun.size.y));
    let lit = entering.sun * decode(w.seabed_sun, fetch_plane(seabed_sun, filtering, at))
        + entering.high * water_row(w.seabed_depth, seabed_depth, x, 0)
        + entering.low * water_row(w.seabed_depth, seabed_depth, x, 1);
    return w.bed * lit / (3.14159265 - w.bed * water_row(w.seabed_depth, seabed_depth, x, 2));
}

// All light that leaves the water along a view.
fn water_leaving(
    w: Water,
    own: texture_3d<f32>,
    sky: texture_3d<f32>,
    seabed: texture_2d<f32>,
    seabed_sun: texture_2d<f32>,
    seabed_depth: texture_2d<f32>,
    irradiance: texture_2d<f32>,
    fresnel: texture_2d<f32>,
    filtering: sampler,
    depth: f32,
    mu: f32,
    mu_s: f32,
) -> vec4f {
    let entering = water_entering(w, irradiance, fresnel, mu_s);
    let x = water_depth_coordinate(w, depth);
    let at = vec2f(texel(x, w.seabed.size.x), texel(water_view_coordinate(w, mu), w.seabed.size.y));
    let bed = water_bed(w, seabed_sun, seabed_depth, filtering, entering, depth, mu_s)
        * decode(w.seabed, fetch_plane(seabed, filtering, at));
    let light = water_own(w, own, sky, filtering, entering, depth, mu, mu_s);
    return water_passes(w, fresnel, mu) * (light + bed);
}

// Linear RGB, luminance over the star's illuminance, of light that has left the water.
fn water_rgb_of(w: Water, light: vec4f) -> vec3f {
    return vec3f(dot(w.rgb[0], light), dot(w.rgb[1], light), dot(w.rgb[2], light));
}
