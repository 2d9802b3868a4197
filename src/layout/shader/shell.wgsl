// Look-ups in baked skies: what both layouts share. Concatenated with compact.wgsl or elek2010.wgsl.
//
// Conventions
//  - Lengths in m. `altitude` is height over the ground, never a radius; the ground's radius is Table.radii.x.
//  - `mu` cosine of the view's zenith angle (1 looks up), `mu_s` that of the direction to the sun, `nu` cosine of the
//    angle between the two, all at the observer. Every view goes through `enter` first, which moves observers outside
//    the shell to it.
//  - Radiance comes over the star's irradiance, 1/sr, at four wavelengths; `rgb_of` makes linear RGB of it, luminance
//    over the star's illuminance. The sun's disc is in no table.
//  - Texel i of n of an axis has the coordinate i / (n - 1): both ends lie on texel centres. The view axis has two
//    halves, rays that hit the ground and rays that do not; nothing is filtered across them.
//  - A 4D table (altitude, view, sun, azimuth) is a 3D texture, x altitude, y view, z = azimuth index * suns + sun index;
//    azimuth is interpolated by hand between two fetches. Tables of single scattering, all of one size, are textures
//    each, or stacked in z.
//  - Samples are interpolated as they are stored, then decoded. Textures are half-float RGBA and want linear filtering.
//    Most GPUs weigh texels in steps of 1/256, which a table of logarithms shows where neighbours differ by much: at
//    the dark edge by 4 %. With HAND_FILTERED the weights are those of f32.
//  - Everything that these functions need of bake.json is in `Tables`, made by the code that loads the textures: a constant
//    written into the shader, or a uniform.

override HAND_FILTERED: bool = false;

struct Table {
    // Texels along altitude, view, sun, azimuth (1 where there is no such axis).
    size: vec4f,
    // Radii of the ground and the top, lowest cosine of the sun, 1 where samples are means over the ray's length.
    radii: vec4f,
    // altitude_bend, view_power, horizon_power, kind of the sun axis: 0 the paper's, 1 `shift`, 2 `centre`.
    bends: vec4f,
    // shift or centre, and width, of the sun axis; 1 where the view axis has its second half alone, the sky.
    sun: vec4f,
    // What part of the altitude and of the sun axis the texels hold: the coordinate of its start, and 1 over its extent
    // (0 where it has none), of each.
    window: vec4f,
    // A layer that the altitude axis of thick air is finer in: its share of the axis, 0 without one, its altitude and
    // width, m, and altitude_power.
    layer: vec4f,
    // Decoding, for each channel: value = scale * stored + offset, or, where `log` is 1, 0 for stored <= floor and
    // scale * exp(stored + offset) above it.
    scale: vec4f,
    offset: vec4f,
    floor: vec4f,
    log: vec4f,
}

// All that a layout has; what it lacks is zero. GROUPS is a constant beside it, the number of groups of constituents
// whose light scattered once has a table, at least 1.
struct Tables {
    // `compact`: light scattered more than once. `elek2010`: all of it.
    volume: Table,
    // Light scattered once by each group of constituents; scale and offset of a group are below.
    single: Table,
    depth: Table,
    scatterers: Table,
    irradiance: Table,
    phase: Table,
    group_scale: array<vec4f, GROUPS>,
    group_offset: array<vec4f, GROUPS>,
    ground_albedo: vec4f,
    // Rows R, G, B from the four wavelengths, over the star's illuminance.
    rgb: array<vec4f, 3>,
    // Groups, 1 where `scatterers` is there, row of the phase table for `elek2010`'s aerosol (-1: none), the star's
    // illuminance in lx.
    counts: vec4f,
}

// Stored samples of a view: of `Tables.volume`, and of each group's table of light scattered once.
struct Stored {
    volume: vec4f,
    single: array<vec4f, GROUPS>,
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
    // Of the ray to the ground or to the top, m.
    reach: f32,
    // The paper's V within its half, 0 nadir or zenith, 1 the horizon.
    share: f32,
    // Half of 1 plus the cosine of the azimuth between view and sun.
    azimuth: f32,
}

// `then` where a <= b, else `otherwise`, channel by channel: languages differ in how they choose by vectors.
fn where_at_most(a: vec4f, b: vec4f, then: vec4f, otherwise: vec4f) -> vec4f {
    return vec4f(
        select(otherwise.x, then.x, a.x <= b.x),
        select(otherwise.y, then.y, a.y <= b.y),
        select(otherwise.z, then.z, a.z <= b.z),
        select(otherwise.w, then.w, a.w <= b.w),
    );
}

fn decode(t: Table, stored: vec4f) -> vec4f {
    let light: vec4f = t.scale * exp(stored + t.offset);
    let exponential: vec4f = where_at_most(stored, t.floor, vec4f(0.0), light);
    return where_at_most(t.log, vec4f(0.5), t.scale * stored + t.offset, exponential);
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
    let along: f32 = (t.radii.x + altitude) * mu;
    if ground {
        let z1: f32 = horizon_distance(t, altitude);
        let root: f32 = sqrt(max((-along - z1) * (z1 - along), 0.0));
        return select(z1 * z1 / (root - along), 0.0, z1 == 0.0);
    }
    let height: f32 = shell_height(t);
    let to_top: f32 = max((height - altitude) * (2.0 * t.radii.x + height + altitude), 0.0);
    let root: f32 = sqrt(along * along + to_top);
    return select(root - along, to_top / (along + root), along > 0.0);
}

// Quotient that a layer's part of the altitude axis is even in.
fn layer_quotient(t: Table, altitude: f32) -> f32 {
    let v: f32 = (altitude - t.layer.y) / t.layer.z;
    return v / (1.0 + abs(v));
}

// 0..1 along the altitude axis.
fn altitude_coordinate(t: Table, altitude: f32) -> f32 {
    let u: f32 = horizon_distance(t, altitude) / horizon_distance(t, shell_height(t));
    if t.layer.x == 0.0 {
        return (1.0 + t.bends.x) * u / (1.0 + t.bends.x * u);
    }
    let v: f32 = pow(u, t.layer.w);
    let bent: f32 = (1.0 + t.bends.x) * v / (1.0 + t.bends.x * v);
    let low: f32 = layer_quotient(t, 0.0);
    let share: f32 = (layer_quotient(t, altitude) - low) / (layer_quotient(t, shell_height(t)) - low);
    return mix(bent, share, t.layer.x);
}

// The paper's V, 0..1 within a half, of a ray of this length in m.
fn view_share(t: Table, altitude: f32, mu: f32, ground: bool, reach: f32) -> f32 {
    let z1: f32 = horizon_distance(t, altitude);
    let height: f32 = shell_height(t);
    let shortest: f32 = select(height - altitude, altitude, ground);
    let longest: f32 = select(z1 + horizon_distance(t, height), z1, ground);
    if longest <= shortest {
        return select(0.0, 1.0, mu >= 0.0);
    }
    return clamp((reach - shortest) / (longest - shortest), 0.0, 1.0);
}

fn azimuth_share(mu: f32, mu_s: f32, nu: f32) -> f32 {
    let sines: f32 = sqrt(max((1.0 - mu) * (1.0 + mu) * (1.0 - mu_s) * (1.0 + mu_s), 0.0));
    return 0.5 + 0.5 * select(1.0, clamp((nu - mu * mu_s) / sines, -1.0, 1.0), sines > 0.0);
}

// A view inside the shell, with what all tables want of it. All tables of a bake have the same shell.
fn place(t: Table, altitude: f32, mu: f32, mu_s: f32, nu: f32, ground: bool, inside: bool) -> Place {
    var p: Place;
    p.altitude = altitude;
    p.mu = mu;
    p.mu_s = mu_s;
    p.nu = nu;
    p.hits_ground = ground;
    p.inside = inside;
    p.reach = ray_length(t, altitude, mu, ground);
    p.share = view_share(t, altitude, mu, ground, p.reach);
    p.azimuth = azimuth_share(mu, mu_s, nu);
    return p;
}

// 0..1 within a half of the view axis: 0 nadir or zenith, 1 the horizon.
fn view_coordinate(t: Table, p: Place) -> f32 {
    let x: f32 = pow(p.share, 1.0 / t.bends.y);
    return select(1.0 - pow(1.0 - x, 1.0 / t.bends.z), x, p.hits_ground);
}

// The bent cosine that the sun axis is even in.
fn sun_quotient(t: Table, mu_s: f32) -> f32 {
    let u: f32 = select(mu_s + t.sun.x, t.sun.x - sqrt(max(0.5 * (1.0 - mu_s), 0.0)), t.bends.w > 1.5);
    return u / (abs(u) + t.sun.y);
}

// 0..1 along the sun axis. Below mu_s_min it is dark: ask `sun_is_up` first.
fn sun_coordinate(t: Table, mu_s: f32) -> f32 {
    let lowest: f32 = t.radii.z;
    if t.bends.w < 0.5 {
        let a: f32 = 3.6 / (1.0 - lowest);
        return (1.0 - exp(-a * (mu_s - lowest))) / 0.97267628;
    }
    let first: f32 = sun_quotient(t, lowest);
    return (sun_quotient(t, mu_s) - first) / (sun_quotient(t, 1.0) - first);
}

fn sun_is_up(t: Table, mu_s: f32) -> bool {
    return mu_s >= t.radii.z;
}

// Position of a coordinate 0..1 among n texels, counted from the centre of the first.
fn texel(x: f32, n: f32) -> f32 {
    return clamp(x, 0.0, 1.0) * (n - 1.0);
}

// Texels of an altitude and of a sun; beyond what the table holds the last that it does.
fn altitude_texel(t: Table, altitude: f32) -> f32 {
    return texel((altitude_coordinate(t, altitude) - t.window.x) * t.window.y, t.size.x);
}

fn sun_texel(t: Table, mu_s: f32) -> f32 {
    return texel((sun_coordinate(t, mu_s) - t.window.z) * t.window.w, t.size.z);
}

fn view_texel(t: Table, p: Place) -> f32 {
    if t.sun.z > 0.5 {
        return texel(select(view_coordinate(t, p), 1.0, p.hits_ground), t.size.y);
    }
    let rows: f32 = 0.5 * t.size.y;
    return texel(view_coordinate(t, p), rows) + select(rows, 0.0, p.hits_ground);
}

// Stored sample at a position in texels.
fn fetch_plane(image: texture_2d<f32>, filtering: sampler, at: vec2f) -> vec4f {
    let size: vec2f = vec2f(textureDimensions(image));
    if !HAND_FILTERED {
        return textureSampleLevel(image, filtering, (at + 0.5) / size, 0.0);
    }
    let low: vec2f = floor(at);
    let w: vec2f = at - low;
    let i: vec2i = vec2i(low);
    let j: vec2i = min(i + 1, vec2i(size) - 1);
    let below: vec4f = mix(textureLoad(image, i, 0), textureLoad(image, vec2i(j.x, i.y), 0), w.x);
    let above: vec4f = mix(textureLoad(image, vec2i(i.x, j.y), 0), textureLoad(image, j, 0), w.x);
    return mix(below, above, w.y);
}

fn fetch_slice(image: texture_3d<f32>, i: vec2i, j: vec2i, w: vec2f, z: i32) -> vec4f {
    let below: vec4f = mix(textureLoad(image, vec3i(i, z), 0), textureLoad(image, vec3i(j.x, i.y, z), 0), w.x);
    let above: vec4f = mix(textureLoad(image, vec3i(i.x, j.y, z), 0), textureLoad(image, vec3i(j, z), 0), w.x);
    return mix(below, above, w.y);
}

fn fetch_volume(image: texture_3d<f32>, filtering: sampler, at: vec3f) -> vec4f {
    let size: vec3f = vec3f(textureDimensions(image));
    if !HAND_FILTERED {
        return textureSampleLevel(image, filtering, (at + 0.5) / size, 0.0);
    }
    let low: vec3f = floor(at);
    let w: vec3f = at - low;
    let i: vec3i = vec3i(low);
    let j: vec3i = min(i + 1, vec3i(size) - 1);
    return mix(fetch_slice(image, i.xy, j.xy, w.xy, i.z), fetch_slice(image, i.xy, j.xy, w.xy, j.z), w.z);
}

// Where a place lies in a 4D table: x, y, z in the slices of the lower azimuth, and the share of the next azimuth.
fn volume_texel(t: Table, p: Place) -> vec4f {
    let azimuth: f32 = texel(p.azimuth, t.size.w);
    let lower: f32 = max(min(floor(azimuth), t.size.w - 2.0), 0.0);
    let z: f32 = lower * t.size.z + sun_texel(t, p.mu_s);
    return vec4f(altitude_texel(t, p.altitude), view_texel(t, p), z, azimuth - lower);
}

// Stored sample of the 4D table number `group` of a stack.
fn fetch_4d(t: Table, image: texture_3d<f32>, filtering: sampler, at: vec4f, group: f32) -> vec4f {
    let lower: vec3f = at.xyz + vec3f(0.0, 0.0, group * t.size.z * t.size.w);
    // With one sun the azimuth alone runs along z, and with one azimuth the sun: one fetch does.
    if min(t.size.z, t.size.w) < 1.5 {
        return fetch_volume(image, filtering, lower + vec3f(0.0, 0.0, at.w));
    }
    let a: vec4f = fetch_volume(image, filtering, lower);
    let b: vec4f = fetch_volume(image, filtering, lower + vec3f(0.0, 0.0, t.size.z));
    return mix(a, b, at.w);
}

// Optical depth of a ray, of a table over altitude and view.
fn depth_at(t: Table, image: texture_2d<f32>, filtering: sampler, p: Place) -> vec4f {
    let at: vec2f = vec2f(altitude_texel(t, p.altitude), view_texel(t, p));
    let stored: vec4f = fetch_plane(image, filtering, at);
    return decode(t, stored) * select(1.0, p.reach, t.radii.w > 0.5);
}

// Transmittance from a place towards the sun; 0 behind the planet.
fn sunlight_at(t: Table, image: texture_2d<f32>, filtering: sampler, altitude: f32, mu_s: f32) -> vec4f {
    if hits_ground(t, altitude, mu_s) {
        return vec4f(0.0);
    }
    return exp(-depth_at(t, image, filtering, place(t, altitude, mu_s, mu_s, 1.0, false, true)));
}

// Stored sample of a row of the phase table at the cosine of the scattering angle.
fn fetch_phase(t: Table, image: texture_2d<f32>, filtering: sampler, nu: f32, row: f32) -> vec4f {
    // Two texels, weighed by hand: rows are not filtered.
    let x: f32 = texel(sqrt(max(0.5 * (1.0 - nu), 0.0)), t.size.x);
    let low: i32 = min(i32(x), i32(t.size.x) - 2);
    let a: vec4f = textureLoad(image, vec2i(low, i32(row)), 0);
    let b: vec4f = textureLoad(image, vec2i(low + 1, i32(row)), 0);
    return mix(a, b, x - f32(low));
}

// Phase function, 1/sr.
fn phase_at(t: Table, image: texture_2d<f32>, filtering: sampler, nu: f32, row: f32) -> vec4f {
    return decode(t, fetch_phase(t, image, filtering, nu, row));
}

// Diffuse irradiance of the ground.
fn irradiance_at(t: Table, image: texture_2d<f32>, filtering: sampler, mu_s: f32) -> vec4f {
    if !sun_is_up(t, mu_s) {
        return vec4f(0.0);
    }
    return decode(t, fetch_plane(image, filtering, vec2f(texel(sun_coordinate(t, mu_s), t.size.x), 0.0)));
}

// Linear RGB, luminance over the star's illuminance, of light at the four wavelengths.
fn rgb_of(t: Tables, light: vec4f) -> vec3f {
    return vec3f(dot(t.rgb[0], light), dot(t.rgb[1], light), dot(t.rgb[2], light));
}

// 1 - exp(-x) with all its digits.
fn opacity(x: vec4f) -> vec4f {
    let few: vec4f = x * (1.0 - x * 0.5 * (1.0 - x / 3.0 * (1.0 - x * 0.25)));
    return where_at_most(x, vec4f(0.05), few, 1.0 - exp(-x));
}

// The place of a view: the observer's own inside the shell, for observers outside where the ray meets it.
fn enter(t: Table, altitude: f32, mu: f32, mu_s: f32, nu: f32) -> Place {
    let height: f32 = shell_height(t);
    if altitude <= height {
        return place(t, altitude, mu, mu_s, nu, hits_ground(t, altitude, mu), true);
    }
    let r: f32 = t.radii.x + altitude;
    let top: f32 = t.radii.y;
    let across: f32 = r * sqrt(max((1.0 - mu) * (1.0 + mu), 0.0));
    let along: f32 = -sqrt(max((top - across) * (top + across), 0.0));
    let mu_s_there: f32 = clamp((r * mu_s + (along - r * mu) * nu) / top, -1.0, 1.0);
    return place(t, height, along / top, mu_s_there, nu, across <= t.radii.x, mu < 0.0 && across < top);
}

// Cosine of the sun's zenith angle where a ray that hits the ground meets it.
fn sun_at_ground(t: Table, p: Place) -> f32 {
    return clamp(((t.radii.x + p.altitude) * p.mu_s + p.reach * p.nu) / t.radii.x, -1.0, 1.0);
}
