// A made-up relief around the observer: heights over the sphere from a few octaves of value noise, level where the
// observer stands.

fn lattice(cell: vec2i) -> f32 {
    let h = noise(bitcast<u32>(cell.x) * 1597334677u ^ bitcast<u32>(cell.y) * 3812015801u);
    return 2.0 * h - 1.0;
}

// Value noise, -1..1, with continuous slope.
fn smooth_noise(q: vec2f) -> f32 {
    let low = floor(q);
    let f = q - low;
    let w = f * f * (3.0 - 2.0 * f);
    let i = vec2i(low);
    let below = mix(lattice(i), lattice(i + vec2i(1, 0)), w.x);
    let above = mix(lattice(i + vec2i(0, 1)), lattice(i + vec2i(1, 1)), w.x);
    return mix(below, above, w.y);
}

// Height over the sphere at a place, m east and towards the star's azimuth of the observer.
fn relief_height(at: vec2f) -> f32 {
    var q = at / 9000.0;
    var size = 1.0;
    var sum = 0.0;
    for (var k = 0; k < 7; k++) {
        // Ridges where the noise changes sign.
        sum += size * (1.0 - abs(smooth_noise(q)));
        q = mat2x2f(1.6, 1.2, -1.2, 1.6) * q + 17.0;
        size *= 0.45;
    }
    let away = smoothstep(1500.0, 12000.0, length(at));
    return 3500.0 * away * max(sum - 1.0, 0.0);
}

// Height over the level of the observer's feet: the sphere falls away.
fn relief_rise(at: vec2f) -> f32 {
    let r = tables.volume.radii.x;
    let away = dot(at, at);
    return relief_height(at) - away / (r + sqrt(max(r * r - away, 0.0)));
}
