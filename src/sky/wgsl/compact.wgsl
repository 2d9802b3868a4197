// Look-ups in the layout `compact`; wants shell.wgsl, where the conventions stand.

// Phase function times mean source along the ray of what group number `group` scatters once. Both are stored as
// logarithms in every bake of this layout, so that one exponential does for their product.
fn compact_group(t: Tables, stored: vec4f, phase: texture_2d<f32>, filtering: sampler, nu: f32, group: i32) -> vec4f {
    let p = fetch_phase(t.phase, phase, filtering, nu, f32(group));
    let product = t.group_scale[group] * t.phase.scale * exp(stored + p + (t.group_offset[group] + t.phase.offset));
    return select(product, vec4f(0.0), (stored <= t.single.floor) | (p <= t.phase.floor));
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

// Stored samples of a view: more than once scattered light, then each group's.
fn compact_fetch(
    t: Tables,
    multiple: texture_3d<f32>,
    single: texture_3d<f32>,
    filtering: sampler,
    p: Place,
) -> array<vec4f, 7> {
    var stored = array<vec4f, 7>();
    stored[0] = fetch_4d(t.volume, multiple, filtering, volume_texel(t.volume, p), 0.0);
    let at = volume_texel(t.single, p);
    for (var k = 0; k < i32(t.counts.x); k++) {
        stored[k + 1] = fetch_4d(t.single, single, filtering, at, f32(k));
    }
    return stored;
}

// Light that the air scatters into a view, at the four wavelengths, 1/sr, from its stored samples: those of
// `compact_fetch`, or of `fetch_slices` in slices.wgsl.
fn compact_scattering(
    t: Tables,
    stored: array<vec4f, 7>,
    depth: texture_2d<f32>,
    scatterers: texture_2d<f32>,
    phase: texture_2d<f32>,
    filtering: sampler,
    p: Place,
) -> vec4f {
    if !p.inside || !sun_is_up(t.volume, p.mu_s) {
        return vec4f(0.0);
    }
    var source = decode(t.volume, stored[0]);
    for (var k = 0; k < i32(t.counts.x); k++) {
        source += compact_group(t, stored[k + 1], phase, filtering, p.nu, k);
    }
    return compact_fill(t, source, depth, scatterers, filtering, p);
}

// Light that a Lambertian ground of the preset's albedo reflects under a sun of zenith cosine `mu_s`, as it leaves it.
fn compact_ground(t: Tables, depth: texture_2d<f32>, irradiance: texture_2d<f32>, filtering: sampler, mu_s: f32) -> vec4f {
    let direct = sunlight_at(t.depth, depth, filtering, 0.0, mu_s) * max(mu_s, 0.0);
    return t.ground_albedo / 3.14159265 * (direct + irradiance_at(t.irradiance, irradiance, filtering, mu_s));
}
