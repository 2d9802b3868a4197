// The ground is land, Lambertian.

const SEA: bool = false;

// What of the ground's light arrives along a view that hits it.
fn surface_seen(p: Place, d: vec3f) -> vec3f {
    return ground_after(sun_at_ground(tables.volume, p), transmittance_of(p));
}
