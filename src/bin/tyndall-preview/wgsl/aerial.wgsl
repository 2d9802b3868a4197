// Terrain seen through air: positions from depth, and the two-fetch difference of Schafhitzel et al. 2007 with the
// transmittance that their Eq. 8 lacks: light between A and B is I(A) - T(A, B) I(B).

@group(3) @binding(0) var depths: texture_depth_2d;

// The same ray looked at `s` further on. Whether it ends on the ground is the ray's own, not that of the rounded angle.
fn along_ray(p: Place, s: f32) -> Place {
    let r = tables.volume.radii.x + p.altitude;
    let rise = s * (2.0 * r * p.mu + s);
    let there = sqrt(max(r * r + rise, 0.0));
    let altitude = clamp(p.altitude + rise / (there + r), 0.0, shell_height(tables.volume));
    let mu = clamp((r * p.mu + s) / there, -1.0, 1.0);
    let mu_s = clamp((r * p.mu_s + s * p.nu) / there, -1.0, 1.0);
    return place(tables.volume, altitude, mu, mu_s, p.nu, p.hits_ground, true);
}

// Transmittance of the first `s` of a ray.
fn transmittance_to(p: Place, q: Place) -> vec4f {
    let between = depth_at(tables.depth, depth, filtering, p) - depth_at(tables.depth, depth, filtering, q);
    return exp(-max(between, vec4f(0.0)));
}

// Near the horizon both fetches are large and nearly alike, and a texel's error of either is more than their
// difference. There the ray's mean light, which hardly changes along its first part, is a better guess: light that
// fills the share of opacity that lies before B.
fn light_between(p: Place, q: Place, through: vec4f) -> vec3f {
    let all = scattered_here(p, frame.forward.w);
    let t = rgb_of(tables, through) / rgb_of(tables, vec4f(1.0));
    let difference = max(all - t * scattered(q, frame.forward.w), vec3f(0.0));
    let tau = depth_at(tables.depth, depth, filtering, p);
    let share = rgb_of(tables, opacity(-log(max(through, vec4f(1e-30)))) / max(opacity(tau), vec4f(1e-6)))
        / rgb_of(tables, vec4f(1.0));
    let guess = all * clamp(share, vec3f(0.0), vec3f(1.0));
    let horizon = -horizon_distance(tables.volume, p.altitude) / (tables.volume.radii.x + p.altitude);
    let near = 1.0 - smoothstep(0.002, 0.02, abs(p.mu - horizon));
    return mix(difference, guess, near * frame.display[0].w);
}

// Light of the relief at a pixel; negative where there is none.
fn relief_seen(d: vec3f, pixel: vec2f) -> vec3f {
    let stored = textureLoad(depths, vec2i(pixel), 0);
    if stored <= 0.0 {
        return vec3f(-1.0);
    }
    let s = 1.0 / stored / dot(d, frame.forward.xyz);
    let p = enter(tables.volume, frame.observer.x, d.y, frame.sun.y, dot(d, frame.sun.xyz));
    let q = along_ray(p, s);
    let at = s * d.xz;
    // Where the relief is level, the sea is.
    if SEA && relief_height(at) <= 0.0 {
        return vec3f(-1.0);
    }
    let h = max(2.0, 0.001 * s);
    let slope = vec2f(
        relief_rise(at + vec2f(h, 0.0)) - relief_rise(at - vec2f(h, 0.0)),
        relief_rise(at + vec2f(0.0, h)) - relief_rise(at - vec2f(0.0, h)),
    ) / (2.0 * h);
    let normal = normalize(vec3f(-slope.x, 1.0, -slope.y));
    let facing = max(dot(normal, frame.sun.xyz), 0.0);
    let through = transmittance_to(p, q);
    // Ground light of a level place, its direct part turned to the slope's.
    let sun = sunlight_at(tables.depth, depth, filtering, q.altitude, q.mu_s);
    let direct = rgb_of(tables, through * tables.ground_albedo / 3.14159265 * sun * facing);
    let level = ground_after(q.mu_s, through);
    let sun_below = sunlight_at(tables.depth, depth, filtering, 0.0, q.mu_s);
    let level_direct = rgb_of(tables, through * tables.ground_albedo / 3.14159265 * sun_below * max(q.mu_s, 0.0));
    let ambient = max(level - level_direct, vec3f(0.0)) * (0.5 + 0.5 * normal.y);
    return direct + ambient + light_between(p, q, through);
}

fn scene(d: vec3f, pixel: vec2f) -> vec3f {
    let relief = relief_seen(d, pixel);
    if relief.r < 0.0 {
        return seen(d);
    }
    return relief;
}
