//! Where a constituent ends with an edge, as layers of cloud do.
//!
//! Looking up from above it there is nothing of it, and the logarithm of nothing is the floor of the table: between that
//! and the light of the texel below, interpolated logarithms would lose nearly all of the light. So the first dark texel
//! holds what makes the interpolation right half-way to it.

use rayon::prelude::*;

/// Bridges the edges of `texels`, `[altitude][view][group][pair]`, in the channels that `four` names first. `between`
/// finds the texels of a ray half-way (in the axis' coordinate) between an altitude and the next.
pub fn bridge(
    texels: &mut [[f32; 4]],
    [altitudes, views, groups, pairs]: [usize; 4],
    four: &[(usize, usize)],
    between: impl Fn(usize, usize, &mut [[f32; 4]]) + Sync,
) {
    let place =
        |altitude: usize, view: usize, group: usize| ((altitude * views + view) * groups + group) * pairs;
    let channels = || four.iter().map(|&(k, _)| k);
    let found: &[[f32; 4]] = texels;
    let dark = |at: usize| found[at..at + pairs].iter().all(|t| channels().all(|k| t[k] == 0.0));
    let rays: Vec<(usize, usize)> =
        (1..altitudes).flat_map(|upper| (0..views).map(move |view| (upper - 1, view))).collect();
    let bridges = |&(lower, view): &(usize, usize)| -> Vec<(usize, Vec<[f32; 4]>)> {
        let ends = |g: usize| [place(lower, view, g), place(lower + 1, view, g)];
        let edges: Vec<usize> = (0..groups).filter(|&g| dark(ends(g)[0]) != dark(ends(g)[1])).collect();
        if edges.is_empty() {
            return Vec::new();
        }
        let mut middle = vec![[0.0; 4]; groups * pairs];
        between(lower, view, &mut middle);
        let mended = |g: usize| {
            let [a, b] = ends(g);
            let (lit, edge) = if dark(a) { (b, a) } else { (a, b) };
            let sides = found[lit..lit + pairs].iter().zip(&middle[g * pairs..]);
            let level = |(lit, half): (&[f32; 4], &[f32; 4])| {
                let mut texel = [0.0; 4];
                channels()
                    .filter(|&k| lit[k] > 0.0)
                    .for_each(|k| texel[k] = half[k] * (half[k] / lit[k]).min(1.0));
                texel
            };
            (edge, sides.map(level).collect())
        };
        edges.into_iter().map(mended).collect()
    };
    let all: Vec<(usize, Vec<[f32; 4]>)> = rays.par_iter().flat_map_iter(bridges).collect();
    for (at, values) in all {
        for (texel, value) in texels[at..].iter_mut().zip(values) {
            // Of a gap with light at both sides, the brighter.
            channels().for_each(|k| texel[k] = texel[k].max(value[k]));
        }
    }
}
