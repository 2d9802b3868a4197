// Look-ups in the layout `compact`; wants shell.wgsl, where the conventions stand.

// Phase function times mean source along the ray of what group number `group` scatters once. Both are stored as
// logarithms in every bake of this layout, so that one exponential does for their product.
fn compact_group(t: Tables, stored: vec4f, phase: texture_2d<f32>, filtering: sampler, nu: f32, group: i32) -> vec4f {
    let p: vec4f = fetch_phase(t.phase, phase, filtering, nu, f32(group));
    let scale: vec4f = t.group_scale[group] * t.phase.scale;
    let product: vec4f = scale * exp(stored + p + (t.group_offset[group] + t.phase.offset));
    let lit: vec4f = where_at_most(stored, t.single.floor, vec4f(0.0), product);
    return where_at_most(p, t.phase.floor, vec4f(0.0), lit);
}

// Light of a mean source that fills a ray; what only absorbs adds nothing, where there is such.
fn compact_fill(
    t: Tables,
    source: vec4f,
    depth: texture_2d<f32>,
    scatterers: texture_2d<f32>,
    filtering: sampler,
    p: Place,
) -> vec4f {
    if t.counts.y > 0.5 {
        return source * opacity(depth_at(t.scatterers, scatterers, filtering, p));
    }
    return source * opacity(depth_at(t.depth, depth, filtering, p));
}

// Light that the air scatters into a view, at the four wavelengths, 1/sr, from its stored samples.
fn compact_scattering(
    t: Tables,
    stored: Stored,
    depth: texture_2d<f32>,
    scatterers: texture_2d<f32>,
    phase: texture_2d<f32>,
    filtering: sampler,
    p: Place,
) -> vec4f {
    if !p.inside || !sun_is_up(t.volume, p.mu_s) {
        return vec4f(0.0);
    }
    var source: vec4f = decode(t.volume, stored.volume);
    for (var k: i32 = 0; k < i32(t.counts.x); k++) {
        source += compact_group(t, stored.single[k], phase, filtering, p.nu, k);
    }
    return compact_fill(t, source, depth, scatterers, filtering, p);
}

// Light that a Lambertian ground of the preset's albedo reflects under a sun of zenith cosine `mu_s`, as it leaves it.
fn compact_ground(t: Tables, depth: texture_2d<f32>, irradiance: texture_2d<f32>, filtering: sampler, mu_s: f32) -> vec4f {
    let direct: vec4f = sunlight_at(t.depth, depth, filtering, 0.0, mu_s) * max(mu_s, 0.0);
    return t.ground_albedo / 3.14159265 * (direct + irradiance_at(t.irradiance, irradiance, filtering, mu_s));
}
