//! Where a constituent ends with an edge, as layers of cloud do.
//!
//! Looking up from above it there is nothing of it, and the logarithm of nothing is the floor of the table: between that
//! and the light of the texel below, interpolated logarithms would lose nearly all of the light. So the first dark texel
//! holds what makes the interpolation right half-way to it or, where it is dark there already, a quarter of the way.

use crate::mapping::Elek2010;
use crate::transport::fill::RayLight;
use rayon::prelude::*;

/// Two neighbouring rays of a table.
#[derive(Clone, Copy)]
enum Gap {
    /// Of a view, from an altitude to the next.
    Altitude { lower: usize, view: usize },
    /// At the last altitude, from a view to the next.
    View { view: usize },
}

/// A ray: its altitude, cosine, and whether it hits the ground.
pub(super) type Ray = (f64, (f64, bool));

/// The neighbours that are looked at: along the altitude, and at the top, from where observers outside look in, along the
/// view instead, where rays come back into the air. There the altitude is always the last.
fn gaps(mapping: &Elek2010) -> Vec<Gap> {
    let [altitudes, views, ..] = mapping.size();
    let [ground, top] = mapping.radii();
    let last = altitudes - 1;
    let looked_into = mapping.altitudes()[1] >= top - ground;
    let direction = |view: usize| mapping.mu(mapping.inner_altitude(last), view);
    let from_outside = |view: usize| looked_into && direction(view).0 < 0.0;
    let pairs = (0..last).flat_map(|lower| (0..views).map(move |view| Gap::Altitude { lower, view }));
    let kept = pairs.filter(
        |gap| !matches!(*gap, Gap::Altitude { lower, view } if lower + 1 == last && from_outside(view)),
    );
    let one_half = |view: usize| direction(view).1 == direction(view + 1).1;
    let along = (0..views - 1).filter(|&view| from_outside(view) && from_outside(view + 1) && one_half(view));
    kept.chain(along.map(|view| Gap::View { view })).collect()
}

impl Gap {
    /// Numbers of its rays.
    fn ends(self, [altitudes, views]: [usize; 2]) -> [usize; 2] {
        match self {
            Gap::Altitude { lower, view } => [lower, lower + 1].map(|k| k * views + view),
            Gap::View { view } => [view, view + 1].map(|j| (altitudes - 1) * views + j),
        }
    }

    /// The ray at a share of the way from the first to the second.
    fn ray(self, mapping: &Elek2010, share: f64) -> Ray {
        match self {
            Gap::Altitude { lower, view } => {
                let altitude = mapping.altitude_between(lower, share);
                (altitude, mapping.mu(altitude, view))
            }
            Gap::View { view } => {
                let altitude = mapping.inner_altitude(mapping.size()[0] - 1);
                (altitude, mapping.mu_between(altitude, view, share))
            }
        }
    }
}

/// Texels of one group and ray, a pair each.
type Texels = Vec<[f32; 4]>;

/// Bridges the edges in `texels`, `[ray][group][pair]`, in the channels that `four` names first. `find` finds the texels of
/// a ray.
pub(super) fn bridge(
    texels: &mut [[f32; 4]],
    mapping: &Elek2010,
    [groups, pairs]: [usize; 2],
    four: &[(usize, usize)],
    find: impl Fn(Ray, &mut RayLight, &mut [[f32; 4]]) + Sync,
) {
    let channels = || four.iter().map(|&(k, _)| k);
    let is_dark = |texels: &[[f32; 4]]| texels.iter().all(|t| channels().all(|k| t[k] == 0.0));
    let found: &[[f32; 4]] = texels;
    let of = |ray: usize, group: usize| &found[(ray * groups + group) * pairs..][..pairs];
    let [altitudes, views, ..] = mapping.size();
    let mend = |light: &mut RayLight, gap: Gap, group: usize| -> Option<(usize, Texels)> {
        let ends = gap.ends([altitudes, views]);
        let dark = ends.map(|ray| is_dark(of(ray, group)));
        if dark[0] == dark[1] {
            return None;
        }
        let (lit, edge) = if dark[0] { (ends[1], ends[0]) } else { (ends[0], ends[1]) };
        for (part, power) in [(0.5f64, 2), (0.25, 4)] {
            let mut between = vec![[0.0; 4]; groups * pairs];
            find(gap.ray(mapping, if dark[0] { 1.0 - part } else { part }), light, &mut between);
            let between = &between[group * pairs..][..pairs];
            if !is_dark(between) {
                let texel = |(lit, at): (&[f32; 4], &[f32; 4])| continued(*lit, *at, power);
                return Some((
                    (edge * groups + group) * pairs,
                    of(lit, group).iter().zip(between).map(texel).collect(),
                ));
            }
        }
        None
    };
    let bridges = |light: &mut RayLight, gap: &Gap| -> Vec<(usize, Texels)> {
        (0..groups).filter_map(|group| mend(light, *gap, group)).collect()
    };
    let all: Vec<_> = gaps(mapping).par_iter().map_init(RayLight::default, bridges).collect();
    for (at, values) in all.into_iter().flatten() {
        for (texel, value) in texels[at..].iter_mut().zip(values) {
            // Of a gap with light at both sides, the brighter.
            channels().for_each(|k| texel[k] = texel[k].max(value[k]));
        }
    }
}

/// What a logarithm that falls from `lit` to `at` over 1 / `power` of the way falls to.
fn continued(lit: [f32; 4], at: [f32; 4], power: usize) -> [f32; 4] {
    std::array::from_fn(|k| {
        let step = if lit[k] > 0.0 { (at[k] / lit[k]).min(1.0) } else { 0.0 };
        (0..power).fold(lit[k], |value, _| value * step)
    })
}
