// Answers to a list of views. `asked`, which stands elsewhere, is what is asked of each.

// Altitude, mu, mu_s, nu of each.
@group(2) @binding(0) var<storage, read> views: array<vec4f>;
@group(2) @binding(1) var<storage, read_write> answers: array<vec4f>;

@compute @workgroup_size(64)
fn answer_views(@builtin(global_invocation_id) id: vec3u) {
    let k = id.x;
    if k >= arrayLength(&views) {
        return;
    }
    let v = views[k];
    answers[k] = asked(enter(tables.volume, v.x, v.y, v.z, v.w));
}
