// Look-ups in the layout `compact`; wants shell.wgsl, where the conventions stand.

// What one group of constituents scatters once: phase function times the mean source along the ray.
fn compact_group(
    t: Tables,
    single: texture_3d<f32>,
    phase: texture_2d<f32>,
    filtering: sampler,
    at: vec4f,
    nu: f32,
    group: f32,
    scale: vec4f,
    offset: vec4f,
) -> vec4f {
    let stored = fetch_4d(t.single, single, filtering, at, group);
    let source = select(scale * exp(stored + offset), vec4f(0.0), stored <= t.single.floor);
    return source * phase_at(t.phase, phase, filtering, nu, group);
}

// Sum over groups of phase function times mean source of light scattered once, and the mean source of the rest.
fn compact_source(
    t: Tables,
    multiple: texture_3d<f32>,
    single: texture_3d<f32>,
    phase: texture_2d<f32>,
    filtering: sampler,
    p: Place,
) -> vec4f {
    var sum = decode(t.volume, fetch_4d(t.volume, multiple, filtering, volume_texel(t.volume, p), 0.0));
    let at = volume_texel(t.single, p);
    // Each group by its number: compilers then know which decoding it wants.
    let groups = t.counts.x;
    if groups > 0.5 {
        sum += compact_group(t, single, phase, filtering, at, p.nu, 0.0, t.group_scale[0], t.group_offset[0]);
    }
    if groups > 1.5 {
        sum += compact_group(t, single, phase, filtering, at, p.nu, 1.0, t.group_scale[1], t.group_offset[1]);
    }
    if groups > 2.5 {
        sum += compact_group(t, single, phase, filtering, at, p.nu, 2.0, t.group_scale[2], t.group_offset[2]);
    }
    if groups > 3.5 {
        sum += compact_group(t, single, phase, filtering, at, p.nu, 3.0, t.group_scale[3], t.group_offset[3]);
    }
    if groups > 4.5 {
        sum += compact_group(t, single, phase, filtering, at, p.nu, 4.0, t.group_scale[4], t.group_offset[4]);
    }
    if groups > 5.5 {
        sum += compact_group(t, single, phase, filtering, at, p.nu, 5.0, t.group_scale[5], t.group_offset[5]);
    }
    return sum;
}

// Light that the air scatters into a view, at the four wavelengths, 1/sr.
fn compact_scattering(
    t: Tables,
    multiple: texture_3d<f32>,
    single: texture_3d<f32>,
    depth: texture_2d<f32>,
    scatterers: texture_2d<f32>,
    phase: texture_2d<f32>,
    filtering: sampler,
    p: Place,
) -> vec4f {
    if !p.inside || !sun_is_up(t.volume, p.mu_s) {
        return vec4f(0.0);
    }
    let source = compact_source(t, multiple, single, phase, filtering, p);
    // Without what only absorbs, where there is such.
    if t.counts.y > 0.5 {
        return source * opacity(depth_at(t.scatterers, scatterers, filtering, p));
    }
    return source * opacity(depth_at(t.depth, depth, filtering, p));
}

// Light that a Lambertian ground of the preset's albedo reflects under a sun of zenith cosine `mu_s`, as it leaves it.
fn compact_ground(t: Tables, depth: texture_2d<f32>, irradiance: texture_2d<f32>, filtering: sampler, mu_s: f32) -> vec4f {
    let direct = sunlight_at(t.depth, depth, filtering, 0.0, mu_s) * max(mu_s, 0.0);
    return t.ground_albedo / 3.14159265 * (direct + irradiance_at(t.irradiance, irradiance, filtering, mu_s));
}
