// What is asked of a bake in the layout `elek2010`.

fn sky_scattered(p: Place) -> vec3f {
    let phase: vec4f = elek2010_phase(tables, table_phase, table_filtering, p.nu);
    return elek2010_scattering(tables, table_scattering, table_transmittance, table_filtering, p, phase);
}

// Light that the air scatters into a view, linear RGB, luminance over the star's illuminance, 1/sr.
fn sky_radiance(altitude: f32, mu: f32, mu_s: f32, nu: f32) -> vec3f {
    let p: Place = enter(tables.volume, altitude, mu, mu_s, nu);
    return sky_scattered(p);
}

// The same with the light of the ground, where the view meets it.
fn sky_total(altitude: f32, mu: f32, mu_s: f32, nu: f32) -> vec3f {
    let p: Place = enter(tables.volume, altitude, mu, mu_s, nu);
    let light: vec3f = sky_scattered(p);
    if !p.inside || !p.hits_ground {
        return light;
    }
    let through: vec4f = exp(-depth_at(tables.depth, table_transmittance, table_filtering, p));
    let sun: f32 = sun_at_ground(tables.volume, p);
    return light + elek2010_ground(tables, table_transmittance, table_irradiance, table_filtering, sun, through);
}
