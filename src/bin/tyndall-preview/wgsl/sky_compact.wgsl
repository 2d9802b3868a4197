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

// Stored samples of a view. The groups' tables, all of one size, are stacked in `single`.
fn fetched(p: Place) -> Stored {
    var stored: Stored;
    stored.volume = fetch_4d(tables.volume, volume, filtering, volume_texel(tables.volume, p), 0.0);
    let at = volume_texel(tables.single, p);
    for (var k = 0; k < i32(tables.counts.x); k++) {
        stored.single[k] = fetch_4d(tables.single, single, filtering, at, f32(k));
    }
    return stored;
}

fn scattered_at_four(p: Place) -> vec4f {
    return compact_scattering(tables, fetched(p), depth, scatterers, phase, filtering, p);
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
