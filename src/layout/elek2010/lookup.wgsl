// Look-ups in the layout `elek2010`, that of Elek & Kmoch 2010; wants shell.wgsl, where the conventions stand.

// Phase function of the aerosol from its table, 1/sr; any other may be put in its place.
fn elek2010_phase(t: Tables, phase: texture_2d<f32>, filtering: sampler, nu: f32) -> vec4f {
    if t.counts.z < 0.0 {
        return vec4f(0.0);
    }
    return phase_at(t.phase, phase, filtering, nu, t.counts.z);
}

// Light of a stored sample under sunlight of this transmittance.
fn elek2010_light(t: Tables, stored: vec4f, sunlight: vec4f, phase: vec4f) -> vec3f {
    let light: vec4f = decode(t.volume, stored);
    return light.rgb / t.counts.w + light.a * max(rgb_of(t, sunlight * phase), vec3f(0.0));
}

// Light that the air scatters into a view, linear RGB (I_F = I_S + I_P e^-t of the paper's section 5), the aerosol's
// with the phase function `phase`, 1/sr at the four wavelengths.
fn elek2010_scattering(
    t: Tables,
    scattering: texture_3d<f32>,
    depth: texture_2d<f32>,
    filtering: sampler,
    p: Place,
    phase: vec4f,
) -> vec3f {
    if !p.inside || !sun_is_up(t.volume, p.mu_s) {
        return vec3f(0.0);
    }
    let stored: vec4f = fetch_4d(t.volume, scattering, filtering, volume_texel(t.volume, p), 0.0);
    let sunlight: vec4f = sunlight_at(t.depth, depth, filtering, p.altitude, p.mu_s);
    return elek2010_light(t, stored, sunlight, phase);
}

// Light that a Lambertian ground reflects under a sun of zenith cosine `mu_s`, linear RGB, after a ray of
// transmittance `through`: direct light is attenuated by wavelength, ambient light in RGB.
fn elek2010_ground(
    t: Tables,
    depth: texture_2d<f32>,
    irradiance: texture_2d<f32>,
    filtering: sampler,
    mu_s: f32,
    through: vec4f,
) -> vec3f {
    let reflected: vec4f = t.ground_albedo * through;
    let direct: vec3f = rgb_of(t, reflected * sunlight_at(t.depth, depth, filtering, 0.0, mu_s)) * max(mu_s, 0.0);
    let share: vec3f = max(rgb_of(t, reflected) / rgb_of(t, vec4f(1.0)), vec3f(0.0));
    let ambient: vec3f = irradiance_at(t.irradiance, irradiance, filtering, mu_s).rgb / t.counts.w;
    return (max(direct, vec3f(0.0)) + ambient * share) / 3.14159265;
}
