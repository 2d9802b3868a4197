// A frame: sky, ground and the star's disc as the camera meets them, tone-mapped and dithered.

struct Frame {
    // Orthonormal axes of the camera in a frame whose y is up at the observer and whose z holds the sun.
    // right.w: 0 a perspective, 1 a fisheye of the half sphere around `forward`.
    right: vec4f,
    // up.w: tangent of half the vertical field of view.
    up: vec4f,
    // forward.w: g of the aerosol's phase function in `elek2010`; below -1 that of the table.
    forward: vec4f,
    // Towards the sun; sun.w: angular radius of its disc, rad.
    sun: vec4f,
    // Altitude in m, what 1 cd/m2 becomes on the display, tone mapping (0 the paper's, 1 Khronos PBR neutral),
    // linear limb darkening u.
    observer: vec4f,
    // Width and height in pixels, angle of a pixel in rad, number of the frame for the dither.
    picture: vec4f,
    // Rows: from the bake's RGB to linear sRGB.
    display: array<vec4f, 3>,
    // Depth of the water in m, where there is water.
    water: vec4f,
}

@group(1) @binding(0) var<uniform> frame: Frame;

@vertex
fn corner(@builtin(vertex_index) k: u32) -> @builtin(position) vec4f {
    // One triangle that covers the picture.
    return vec4f(f32(k & 1u) * 4.0 - 1.0, f32(k >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

// The direction of a pixel; zero outside a fisheye's circle.
fn direction(pixel: vec2f) -> vec3f {
    let size = frame.picture.xy;
    let across = (2.0 * pixel - size) * vec2f(1.0, -1.0) / size.y;
    if frame.right.w < 0.5 {
        let side = frame.right.xyz * across.x + frame.up.xyz * across.y;
        return normalize(frame.forward.xyz + side * frame.up.w);
    }
    // Equal angles: the edge of the circle, which fits the picture's shorter side, is 90 degrees from the middle.
    let q = across * size.y / min(size.x, size.y);
    let radius = length(q);
    if radius > 1.0 {
        return vec3f(0.0);
    }
    let angle = 0.5 * 3.14159265 * radius;
    let side = (frame.right.xyz * q.x + frame.up.xyz * q.y) / max(radius, 1e-6);
    return frame.forward.xyz * cos(angle) + side * sin(angle);
}

// Radiance of the star's disc over its irradiance, mean 1 / (pi sin^2 radius), darker to the limb. A disc smaller than
// a pixel, an angle in rad, is spread over one.
fn disc(d: vec3f, pixel: f32) -> f32 {
    let toward = dot(d, frame.sun.xyz);
    let radius = max(frame.sun.w, 0.5 * pixel);
    let off = length(cross(d, frame.sun.xyz));
    if toward <= 0.0 || off > radius + pixel {
        return 0.0;
    }
    let cover = clamp((radius - off) / pixel + 0.5, 0.0, 1.0);
    let mu = sqrt(max(1.0 - off * off / (radius * radius), 0.0));
    let u = frame.observer.w;
    let limb = (1.0 - u * (1.0 - mu)) / (1.0 - u / 3.0);
    return cover * limb / (3.14159265 * sin(radius) * sin(radius));
}

fn star(d: vec3f) -> f32 {
    return disc(d, frame.picture.z);
}

// Linear RGB of the bake's colour space, luminance over the star's illuminance, from a direction.
fn seen(d: vec3f) -> vec3f {
    let p = enter(tables.volume, frame.observer.x, d.y, frame.sun.y, dot(d, frame.sun.xyz));
    if !p.inside {
        return rgb_of(tables, vec4f(star(d)));
    }
    let light = scattered_here(p, frame.forward.w);
    // Once for both: processors that draw in software go through all branches.
    let through = transmittance_of(p);
    if GROUND && p.hits_ground {
        return light + surface_seen(p, d, through);
    }
    return light + rgb_of(tables, star(d) * through);
}

// O'Neil 2005, the paper's: 1 - exp(-x).
fn tone_exponential(x: vec3f) -> vec3f {
    return 1.0 - exp(-x);
}

// Khronos PBR neutral tone mapper (Khronos Group 2024, specification 1.0): true below 0.76, above it compressed and
// led to white.
fn tone_neutral(x: vec3f) -> vec3f {
    let start = 0.8 - 0.04;
    let least = min(x.r, min(x.g, x.b));
    let toe = select(0.04, least - 6.25 * least * least, least < 0.08);
    let c = x - toe;
    let peak = max(c.r, max(c.g, c.b));
    if peak < start {
        return c;
    }
    let room = 1.0 - start;
    let lowered = 1.0 - room * room / (peak + room - start);
    let saturated = 1.0 / (0.15 * (peak - lowered) + 1.0);
    return mix(vec3f(lowered), c * (lowered / peak), saturated);
}

fn srgb(x: vec3f) -> vec3f {
    let c = clamp(x, vec3f(0.0), vec3f(1.0));
    return select(1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055, 12.92 * c, c <= vec3f(0.0031308));
}

// PCG hash (Jarzynski & Olano 2020), 0..1.
fn noise(seed: u32) -> f32 {
    let state = seed * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return f32((word >> 22u) ^ word) / 4294967296.0;
}

// What the display shows of light in cd/m2: exposed, tone-mapped, coded as sRGB, dithered by triangular noise of one
// step of 8 bits.
fn shown(light: vec3f, pixel: vec2f) -> vec4f {
    let d = frame.display;
    let linear = vec3f(dot(d[0].xyz, light), dot(d[1].xyz, light), dot(d[2].xyz, light));
    let exposed = max(linear, vec3f(0.0)) * frame.observer.y;
    var mapped = tone_exponential(exposed);
    if frame.observer.z > 0.5 {
        mapped = tone_neutral(exposed);
    }
    let at = vec2u(pixel);
    let seed = at.x + 16384u * at.y + 268435456u * u32(frame.picture.w);
    let dither = noise(seed) - noise(seed ^ 0x9e3779b9u);
    return vec4f(srgb(mapped) + dither / 255.0, 1.0);
}

@fragment
fn draw(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let d = direction(at.xy);
    if dot(d, d) < 0.5 {
        return vec4f(0.0, 0.0, 0.0, 1.0);
    }
    return shown(scene(d, at.xy) * tables.counts.w, at.xy);
}

// The same frame as light: linear RGB of the bake, luminance over the star's illuminance.
@fragment
fn measure(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let d = direction(at.xy);
    if dot(d, d) < 0.5 {
        return vec4f(0.0);
    }
    return vec4f(scene(d, at.xy), 1.0);
}
