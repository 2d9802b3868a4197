// Asked for: the light that leaves water where a view meets it.

override DEPTH: f32;

fn asked(p: Place) -> vec4f {
    return sea_leaving(p, DEPTH);
}
