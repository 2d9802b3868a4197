// The ground is land, Lambertian.

const SEA: bool = false;

// What of the ground's light arrives along a view that hits it, through the air's transmittance.
fn surface_seen(p: Place, d: vec3f, through: vec4f) -> vec3f {
    return ground_after(sun_at_ground(tables.volume, p), through);
}
