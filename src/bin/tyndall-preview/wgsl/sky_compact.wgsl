// What a frame asks of the layout `compact`.

fn transmittance_of(p: Place) -> vec4f {
    return exp(-depth_at(tables.depth, depth, filtering, p));
}

// Light at the four wavelengths, as `tyndall sample` prints it.
fn answer(p: Place) -> vec4f {
    if !p.inside {
        return vec4f(0.0);
    }
    var light = compact_scattering(tables, volume, single, depth, scatterers, phase, filtering, p);
    if p.hits_ground {
        let mu_s = sun_at_ground(tables.volume, p);
        light += transmittance_of(p) * compact_ground(tables, depth, irradiance, filtering, mu_s);
    }
    return light;
}

fn scattered(p: Place, g: f32) -> vec3f {
    return rgb_of(tables, compact_scattering(tables, volume, single, depth, scatterers, phase, filtering, p));
}

// From the observer's own place.
fn scattered_here(p: Place, g: f32) -> vec3f {
    if SLICED {
        let light = compact_scattering_sliced(tables, slices, depth, scatterers, phase, filtering, p);
        return rgb_of(tables, light);
    }
    return scattered(p, g);
}

fn ground_after(mu_s: f32, through: vec4f) -> vec3f {
    return rgb_of(tables, through * compact_ground(tables, depth, irradiance, filtering, mu_s));
}

// Light of the sky along a ray, of which `kept` is left at the four wavelengths.
fn sky_after(p: Place, g: f32, kept: vec4f) -> vec3f {
    return rgb_of(tables, kept * compact_scattering(tables, volume, single, depth, scatterers, phase, filtering, p));
}
