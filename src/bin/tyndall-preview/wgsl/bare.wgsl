// A planet without relief.

fn scene(d: vec3f, pixel: vec2f) -> vec3f {
    return seen(d);
}
