// What is asked of a bake in the layout `compact`.

// Light that the air scatters into a view, radiance over the star's irradiance, 1/sr, at the four wavelengths.
fn sky_radiance_at_four(altitude: f32, mu: f32, mu_s: f32, nu: f32) -> vec4f {
    let p: Place = enter(tables.volume, altitude, mu, mu_s, nu);
    return sky_scattered(p);
}

// The same with the light of the ground, where the view meets it.
fn sky_total_at_four(altitude: f32, mu: f32, mu_s: f32, nu: f32) -> vec4f {
    let p: Place = enter(tables.volume, altitude, mu, mu_s, nu);
    let light: vec4f = sky_scattered(p);
    if !p.inside || !p.hits_ground {
        return light;
    }
    let through: vec4f = exp(-depth_at(tables.depth, table_transmittance, table_filtering, p));
    let sun: f32 = sun_at_ground(tables.volume, p);
    return light + through * compact_ground(tables, table_transmittance, table_irradiance, table_filtering, sun);
}

// Both as linear RGB, luminance over the star's illuminance, 1/sr.
fn sky_radiance(altitude: f32, mu: f32, mu_s: f32, nu: f32) -> vec3f {
    return rgb_of(tables, sky_radiance_at_four(altitude, mu, mu_s, nu));
}

fn sky_total(altitude: f32, mu: f32, mu_s: f32, nu: f32) -> vec3f {
    return rgb_of(tables, sky_total_at_four(altitude, mu, mu_s, nu));
}
