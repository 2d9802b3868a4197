// Asked for: the light of a view.

fn asked(p: Place) -> vec4f {
    return answer(p);
}
