// The relief as a grid of triangles into a depth buffer. Depth is near / distance along the camera's axis: 1 near, 0
// infinitely far.

struct Corner {
    @builtin(position) position: vec4f,
}

const SIDE: u32 = 384u;
const FAR: f32 = 160000.0;
const NEAR: f32 = 1.0;

// Cells grow with distance, as the picture wants them.
fn spread(k: u32) -> f32 {
    let u = 2.0 * f32(k) / f32(SIDE - 1u) - 1.0;
    return FAR * u * abs(u) * (0.3 + 0.7 * abs(u));
}

@vertex
fn raise(@builtin(vertex_index) k: u32) -> Corner {
    let at = vec2f(spread(k % SIDE), spread(k / SIDE));
    let p = vec3f(at.x, relief_rise(at) - frame.observer.x, at.y);
    let along = dot(p, frame.forward.xyz);
    let side = vec2f(dot(p, frame.right.xyz) * frame.picture.y / frame.picture.x, dot(p, frame.up.xyz)) / frame.up.w;
    return Corner(vec4f(side, NEAR, along));
}

@fragment
fn nothing() {}
