// Look-ups in baked skies: what both layouts share. Concatenate this file with compact.wgsl or elek2010.wgsl.
//
// Conventions
//  - Lengths in m. `altitude` is height over the ground, never a radius; the ground's radius is Table.radii.x.
//  - `mu` cosine of the view's zenith angle (1 looks up), `mu_s` that of the direction to the sun, `nu` cosine of the
//    angle between the two, all at the observer. Outside the shell, move the observer with `enter` first.
//  - Texel i of n of an axis has the coordinate i / (n - 1): both ends lie on texel centres. The view axis has two
//    halves, rays that hit the ground and rays that do not; nothing is filtered across them.
//  - A 4D table (altitude, view, sun, azimuth) is a 3D texture, x altitude, y view, z = azimuth index * suns + sun index;
//    azimuth is interpolated by hand between two fetches. Textures want linear filtering and clamped edges.
//  - Samples are interpolated as they are stored, then decoded.
//  - Everything that these functions need of bake.json is in `Table`, one for each texture.

struct Table {
    // Texels along altitude, view, sun, azimuth (1 where there is no such axis).
    size: vec4f,
    // Radii of the ground and the top, lowest cosine of the sun, 1 where samples are means over the ray's length.
    radii: vec4f,
    // altitude_bend, view_power, horizon_power, kind of the sun axis: 0 the paper's, 1 `shift`, 2 `centre`.
    bends: vec4f,
    // shift or centre, and width, of the sun axis.
    sun: vec4f,
    // Decoding, for each channel: value = scale * stored + offset, or, where `log` is 1, 0 for stored <= floor and
    // scale * exp(stored + offset) above it.
    scale: vec4f,
    offset: vec4f,
    floor: vec4f,
    log: vec4f,
}

// A view inside the shell.
struct Place {
    altitude: f32,
    mu: f32,
    mu_s: f32,
    nu: f32,
    hits_ground: bool,
    // False where the ray misses the shell.
    inside: bool,
}

fn decode(t: Table, stored: vec4f) -> vec4f {
    let linear = t.scale * stored + t.offset;
    let exponential = select(t.scale * exp(stored + t.offset), vec4f(0.0), stored <= t.floor);
    return select(linear, exponential, t.log > vec4f(0.5));
}

// Z1: distance to the horizon, m.
fn horizon_distance(t: Table, altitude: f32) -> f32 {
    return sqrt(max(altitude * (2.0 * t.radii.x + altitude), 0.0));
}

fn shell_height(t: Table) -> f32 {
    return t.radii.y - t.radii.x;
}

fn hits_ground(t: Table, altitude: f32, mu: f32) -> bool {
    return mu < -horizon_distance(t, altitude) / (t.radii.x + altitude);
}

// Distance along a ray to the ground or to the top, m. Differences are written as products, so that f32 keeps digits.
fn ray_length(t: Table, altitude: f32, mu: f32, ground: bool) -> f32 {
    let along = (t.radii.x + altitude) * mu;
    if ground {
        let z1 = horizon_distance(t, altitude);
        let root = sqrt(max((-along - z1) * (z1 - along), 0.0));
        return select(z1 * z1 / (root - along), 0.0, z1 == 0.0);
    }
    let height = shell_height(t);
    let to_top = max((height - altitude) * (2.0 * t.radii.x + height + altitude), 0.0);
    let root = sqrt(along * along + to_top);
    return select(root - along, to_top / (along + root), along > 0.0);
}

// 0..1 along the altitude axis.
fn altitude_coordinate(t: Table, altitude: f32) -> f32 {
    let u = horizon_distance(t, altitude) / horizon_distance(t, shell_height(t));
    return (1.0 + t.bends.x) * u / (1.0 + t.bends.x * u);
}

// 0..1 within a half of the view axis: 0 nadir or zenith, 1 the horizon.
fn view_coordinate(t: Table, altitude: f32, mu: f32, ground: bool) -> f32 {
    let z1 = horizon_distance(t, altitude);
    let height = shell_height(t);
    let shortest = select(height - altitude, altitude, ground);
    let longest = select(z1 + horizon_distance(t, height), z1, ground);
    if longest <= shortest {
        return select(0.0, 1.0, mu >= 0.0);
    }
    let v = clamp((ray_length(t, altitude, mu, ground) - shortest) / (longest - shortest), 0.0, 1.0);
    let x = pow(v, 1.0 / t.bends.y);
    return select(1.0 - pow(1.0 - x, 1.0 / t.bends.z), x, ground);
}

// The bent cosine that the sun axis is even in.
fn sun_quotient(t: Table, mu_s: f32) -> f32 {
    let u = select(mu_s + t.sun.x, t.sun.x - sqrt(max(0.5 * (1.0 - mu_s), 0.0)), t.bends.w > 1.5);
    return u / (abs(u) + t.sun.y);
}

// 0..1 along the sun axis. Below mu_s_min it is dark: ask `sun_is_up` first.
fn sun_coordinate(t: Table, mu_s: f32) -> f32 {
    let lowest = t.radii.z;
    if t.bends.w < 0.5 {
        let a = 3.6 / (1.0 - lowest);
        return (1.0 - exp(-a * (mu_s - lowest))) / 0.97267628;
    }
    let first = sun_quotient(t, lowest);
    return (sun_quotient(t, mu_s) - first) / (sun_quotient(t, 1.0) - first);
}

fn sun_is_up(t: Table, mu_s: f32) -> bool {
    return mu_s >= t.radii.z;
}

// Texture coordinate of a place 0..1 on an axis of n texels, `first` texels into a row of `all`.
fn texel_centre(x: f32, n: f32, first: f32, all: f32) -> f32 {
    return (first + 0.5 + clamp(x, 0.0, 1.0) * (n - 1.0)) / all;
}

fn view_texture(t: Table, p: Place) -> f32 {
    let half = 0.5 * t.size.y;
    return texel_centre(view_coordinate(t, p.altitude, p.mu, p.hits_ground), half, select(half, 0.0, p.hits_ground), t.size.y);
}

fn cos_azimuth(p: Place) -> f32 {
    let sines = sqrt(max((1.0 - p.mu * p.mu) * (1.0 - p.mu_s * p.mu_s), 0.0));
    return select(1.0, clamp((p.nu - p.mu * p.mu_s) / sines, -1.0, 1.0), sines > 0.0);
}

// Decoded value of a 4D table; 0 where the sun is below its axis.
fn volume_at(t: Table, texture: texture_3d<f32>, filtering: sampler, p: Place) -> vec4f {
    if !sun_is_up(t, p.mu_s) {
        return vec4f(0.0);
    }
    let x = texel_centre(altitude_coordinate(t, p.altitude), t.size.x, 0.0, t.size.x);
    let y = view_texture(t, p);
    let sun = sun_coordinate(t, p.mu_s);
    let azimuth = 0.5 * (1.0 + cos_azimuth(p)) * (t.size.w - 1.0);
    let slice = min(floor(azimuth), t.size.w - 2.0);
    let depth = t.size.z * t.size.w;
    let a = textureSampleLevel(texture, filtering, vec3f(x, y, texel_centre(sun, t.size.z, slice * t.size.z, depth)), 0.0);
    let b = textureSampleLevel(texture, filtering, vec3f(x, y, texel_centre(sun, t.size.z, (slice + 1.0) * t.size.z, depth)), 0.0);
    return decode(t, mix(a, b, azimuth - slice));
}

// Optical depth of a ray, of a table over altitude and view.
fn depth_at(t: Table, texture: texture_2d<f32>, filtering: sampler, p: Place) -> vec4f {
    let x = texel_centre(altitude_coordinate(t, p.altitude), t.size.x, 0.0, t.size.x);
    let stored = textureSampleLevel(texture, filtering, vec2f(x, view_texture(t, p)), 0.0);
    return decode(t, stored) * select(1.0, ray_length(t, p.altitude, p.mu, p.hits_ground), t.radii.w > 0.5);
}

// Transmittance from a place towards the sun; 0 behind the planet.
fn sunlight_at(t: Table, texture: texture_2d<f32>, filtering: sampler, altitude: f32, mu_s: f32) -> vec4f {
    if hits_ground(t, altitude, mu_s) {
        return vec4f(0.0);
    }
    return exp(-depth_at(t, texture, filtering, Place(altitude, mu_s, mu_s, 1.0, false, true)));
}

// A row of the phase table: 1/sr at the cosine of the scattering angle.
fn phase_at(t: Table, texture: texture_2d<f32>, filtering: sampler, nu: f32, row: f32) -> vec4f {
    let x = texel_centre(sqrt(max(0.5 * (1.0 - nu), 0.0)), t.size.x, 0.0, t.size.x);
    return decode(t, textureSampleLevel(texture, filtering, vec2f(x, (row + 0.5) / t.size.y), 0.0));
}

// Diffuse irradiance of the ground.
fn irradiance_at(t: Table, texture: texture_2d<f32>, filtering: sampler, mu_s: f32) -> vec4f {
    if !sun_is_up(t, mu_s) {
        return vec4f(0.0);
    }
    let x = texel_centre(sun_coordinate(t, mu_s), t.size.x, 0.0, t.size.x);
    return decode(t, textureSampleLevel(texture, filtering, vec2f(x, 0.5), 0.0));
}

// The place where a ray meets the shell, for observers outside; the observer's own inside.
fn enter(t: Table, altitude: f32, mu: f32, mu_s: f32, nu: f32) -> Place {
    let height = shell_height(t);
    if altitude <= height {
        return Place(altitude, mu, mu_s, nu, hits_ground(t, altitude, mu), true);
    }
    let r = t.radii.x + altitude;
    let top = t.radii.y;
    let across = r * sqrt(max(1.0 - mu * mu, 0.0));
    let along = -sqrt(max((top - across) * (top + across), 0.0));
    let mu_s_there = clamp((r * mu_s + (along - r * mu) * nu) / top, -1.0, 1.0);
    return Place(height, along / top, mu_s_there, nu, across <= t.radii.x, mu < 0.0 && across < top);
}

// Cosine of the sun's zenith angle where a ray meets the ground.
fn sun_at_ground(t: Table, p: Place) -> f32 {
    let length = ray_length(t, p.altitude, p.mu, true);
    return clamp(((t.radii.x + p.altitude) * p.mu_s + length * p.nu) / t.radii.x, -1.0, 1.0);
}
