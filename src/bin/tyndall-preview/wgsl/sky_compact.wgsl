// What a frame asks of the layout `compact`.

fn transmittance_of(p: Place) -> vec4f {
    return exp(-depth_at(tables.depth, depth, filtering, p));
}

// Light at the four wavelengths, as `tyndall sample` prints it.
fn answer(p: Place) -> vec4f {
    if !p.inside {
        return vec4f(0.0);
    }
    var light = scattered_at_four(p);
    if p.hits_ground {
        let mu_s = sun_at_ground(tables.volume, p);
        light += transmittance_of(p) * compact_ground(tables, depth, irradiance, filtering, mu_s);
    }
    return light;
}

fn scattered_at_four(p: Place) -> vec4f {
    let stored = compact_fetch(tables, volume, single, filtering, p);
    return compact_scattering(tables, stored, depth, scatterers, phase, filtering, p);
}

fn scattered(p: Place, g: f32) -> vec3f {
    return rgb_of(tables, scattered_at_four(p));
}

// From the observer's own place.
fn scattered_here(p: Place, g: f32) -> vec3f {
    if !SLICED {
        return scattered(p, g);
    }
    let stored = fetch_slices(tables, slices, filtering, p);
    return rgb_of(tables, compact_scattering(tables, stored, depth, scatterers, phase, filtering, p));
}

fn ground_after(mu_s: f32, through: vec4f) -> vec3f {
    return rgb_of(tables, through * compact_ground(tables, depth, irradiance, filtering, mu_s));
}

// Light of the sky along a ray, of which `kept` is left at the four wavelengths.
fn sky_after(p: Place, g: f32, kept: vec4f) -> vec3f {
    return rgb_of(tables, kept * scattered_at_four(p));
}
