// `compact` by a frame's slices; wants shell.wgsl, slices.wgsl and compact.wgsl.

// As compact_scattering, for a view of the slices' altitude and sun.
fn compact_scattering_sliced(
    t: Tables,
    slices: texture_2d_array<f32>,
    depth: texture_2d<f32>,
    scatterers: texture_2d<f32>,
    phase: texture_2d<f32>,
    filtering: sampler,
    p: Place,
) -> vec4f {
    if !p.inside || !sun_is_up(t.volume, p.mu_s) {
        return vec4f(0.0);
    }
    var source = decode(t.volume, fetch_sliced(t.volume, slices, filtering, p, 0));
    let groups = i32(t.counts.x);
    if groups > 0 {
        source += compact_group(t, fetch_sliced(t.single, slices, filtering, p, 1), phase, filtering, p.nu, 0);
    }
    if groups > 1 {
        source += compact_group(t, fetch_sliced(t.single, slices, filtering, p, 2), phase, filtering, p.nu, 1);
    }
    if groups > 2 {
        source += compact_group(t, fetch_sliced(t.single, slices, filtering, p, 3), phase, filtering, p.nu, 2);
    }
    if groups > 3 {
        source += compact_group(t, fetch_sliced(t.single, slices, filtering, p, 4), phase, filtering, p.nu, 3);
    }
    if groups > 4 {
        source += compact_group(t, fetch_sliced(t.single, slices, filtering, p, 5), phase, filtering, p.nu, 4);
    }
    if groups > 5 {
        source += compact_group(t, fetch_sliced(t.single, slices, filtering, p, 6), phase, filtering, p.nu, 5);
    }
    return compact_fill(t, source, depth, scatterers, filtering, p);
}
