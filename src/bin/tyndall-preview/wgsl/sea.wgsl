// The ground is water, flat and of one depth: what leaves it, and what it mirrors of sky and star, through the air.

const SEA: bool = true;

// Radiance of the star's disc in the surface, before the surface takes its share. Under a pixel the planet bends, and
// mirrored rays part by twice that: by 2 s / (mu r) in the plane of incidence and 2 s mu / r across. A disc smaller than
// what a pixel so spans is spread over as large an area.
fn star_mirrored(d: vec3f, mu: f32) -> f32 {
    let r = tables.volume.radii.x;
    let s = ray_length(tables.volume, frame.observer.x, d.y, true);
    let up = normalize(vec3f(0.0, r + frame.observer.x, 0.0) + s * d);
    let bend = 2.0 * s / r;
    let spread = sqrt((1.0 + bend / max(mu, 1e-4)) * (1.0 + bend * mu));
    return disc(reflect(d, up), frame.picture.z * spread);
}

// What of the water's light arrives along a view that hits it, through the air's transmittance.
fn surface_seen(p: Place, d: vec3f, through: vec4f) -> vec3f {
    let mu = water_cosine(tables.volume, p);
    let mu_s = sun_at_ground(tables.volume, p);
    let leaving = water_rgb_of(sea, through * sea_leaving(p, frame.water.x));
    let mirrored = through * water_mirrors(sea, sea_fresnel, mu);
    let nu = clamp(p.nu + 2.0 * mu * mu_s, -1.0, 1.0);
    let up = place(tables.volume, 0.0, mu, mu_s, nu, false, true);
    var light = leaving + sky_after(up, frame.forward.w, mirrored);
    let star = star_mirrored(d, mu);
    if star > 0.0 {
        light += rgb_of(tables, star * mirrored * transmittance_of(up));
    }
    return light;
}
