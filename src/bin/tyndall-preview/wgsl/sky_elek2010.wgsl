// What a frame asks of the layout `elek2010`.

fn transmittance_of(p: Place) -> vec4f {
    return exp(-depth_at(tables.depth, depth, filtering, p));
}

// Linear RGB, as `tyndall sample` prints it.
fn answer(p: Place) -> vec4f {
    if !p.inside {
        return vec4f(0.0);
    }
    var light = scattered(p, -2.0);
    if p.hits_ground {
        light += ground_after(sun_at_ground(tables.volume, p), transmittance_of(p));
    }
    return vec4f(light, 0.0);
}

// Cornette & Shanks 1992, Eq. 8, normalised to 1 over the sphere.
fn cornette_shanks(g: f32, nu: f32) -> f32 {
    let g2 = g * g;
    let bracket = max(1.0 + g2 - 2.0 * g * nu, 1e-6);
    return 3.0 / (8.0 * 3.14159265) * (1.0 - g2) * (1.0 + nu * nu) / ((2.0 + g2) * bracket * sqrt(bracket));
}

// The table's phase function for g below -1, else that of Cornette and Shanks.
fn aerosol_phase(nu: f32, g: f32) -> vec4f {
    if g < -1.0 {
        return elek2010_phase(tables, phase, filtering, nu);
    }
    return vec4f(cornette_shanks(g, nu));
}

fn scattered(p: Place, g: f32) -> vec3f {
    return elek2010_scattering(tables, volume, depth, filtering, p, aerosol_phase(p.nu, g));
}

// From the observer's own place. The slices' layer 1 holds the sunlight there.
fn scattered_here(p: Place, g: f32) -> vec3f {
    if !SLICED {
        return scattered(p, g);
    }
    if !sun_is_up(tables.volume, p.mu_s) {
        return vec3f(0.0);
    }
    let stored = fetch_sliced(tables.volume, slices, filtering, p, 0);
    let sunlight = textureLoad(slices, vec2i(0), 1, 0);
    return elek2010_light(tables, stored, sunlight, aerosol_phase(p.nu, g));
}

fn ground_after(mu_s: f32, through: vec4f) -> vec3f {
    return elek2010_ground(tables, depth, irradiance, filtering, mu_s, through);
}

// Light of the sky along a ray, of which `kept` is left at the four wavelengths.
fn sky_after(p: Place, g: f32, kept: vec4f) -> vec3f {
    return scattered(p, g) * max(rgb_of(tables, kept) / rgb_of(tables, vec4f(1.0)), vec3f(0.0));
}
