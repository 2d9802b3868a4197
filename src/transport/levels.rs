//! The radii at which the radiance field is held, and the finer ones at which rays are sampled.

use super::refined::lagrange;
use crate::medium::Medium;

/// Radii from ground to top, m, rising: three lists, each of which holds the next.
#[derive(Clone, Debug)]
pub struct Levels {
    /// All sampling radii, at which sunlight is tabulated.
    pub fine: Vec<f64>,
    /// Radii at which rays look up fields of light scattered more often.
    pub field: Vec<f64>,
    /// Radii that hold the state of the solver.
    pub coarse: Vec<f64>,
    /// For each radius of the field, its number in the fine list.
    pub field_index: Vec<usize>,
    /// For each radius of the field, the first of the state's that it lies between, and their weights: cubic in
    /// the levels' number, in which the state is smoother than in height.
    pub between: Vec<(usize, Vec<f32>)>,
}

/// Numbers of levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelCounts {
    /// That hold the state.
    pub coarse: usize,
    /// Intervals of the field between two of them.
    pub refinement: usize,
    /// Shells, at least, between two levels of the field.
    pub cuts: usize,
}

/// Heights at which the spacing function is tabulated.
const STEPS: usize = 4096;
/// A fine shell has at most this optical depth, so that what varies inside it is nearly linear.
const SHELL_DEPTH: f64 = 0.25;
/// Fine shells at most, unless the kinks of profiles alone make more.
const MOST_SHELLS: usize = 300;

impl Levels {
    /// Further shells end at every kink of a profile. Levels follow a blend of height, of each scatterer's column
    /// and of the largest optical depth, so that a thin layer of haze and a thick lower atmosphere are both
    /// resolved.
    pub fn new(medium: &Medium, counts: LevelCounts) -> Self {
        let cumulative = spacing(medium);
        let (cuts, refinement) = (counts.cuts.max(1), counts.refinement.max(1));
        let intervals = (counts.coarse.max(2) - 1) * refinement * cuts;
        let mut fine: Vec<f64> = (0..=intervals)
            .map(|k| {
                medium.ground_radius + altitude_at(&cumulative, medium.height(), k as f64 / intervals as f64)
            })
            .collect();
        fine[0] = medium.ground_radius;
        fine[intervals] = medium.top_radius;
        let field: Vec<f64> = fine.iter().copied().step_by(cuts).collect();
        let coarse: Vec<f64> = field.iter().copied().step_by(refinement).collect();
        insert_kinks(&mut fine, medium);
        let field_index = field.iter().map(|c| fine.partition_point(|f| f < c)).collect();
        let between = (0..field.len()).map(|k| between(k, refinement, coarse.len())).collect();
        Levels { fine, field, coarse, field_index, between }
    }
}

impl Levels {
    /// True in thick air, where the field is looked up on more levels than hold the state.
    pub fn is_refined(&self) -> bool {
        self.field.len() > self.coarse.len()
    }
}

/// Weights of the state's levels at a level of the field, with the number of the first of them.
fn between(level: usize, refinement: usize, count: usize) -> (usize, Vec<f32>) {
    let (below, part) = (level / refinement, level % refinement);
    if part == 0 {
        return (below, vec![1.0]);
    }
    let first = below.saturating_sub(1);
    let last = (below + 2).min(count - 1);
    (first, lagrange(below - first, last - below, part as f64 / refinement as f64))
}

/// The interval of a rising list that holds `r`, and the place of `r` in it.
pub(super) fn locate(radii: &[f64], r: f64) -> (usize, f64) {
    let after = radii.partition_point(|&x| x <= r).clamp(1, radii.len() - 1);
    let (a, b) = (radii[after - 1], radii[after]);
    (after - 1, ((r - a) / (b - a)).clamp(0.0, 1.0))
}

/// A rising function of height on an even grid, whose equal parts are the intervals between levels.
fn spacing(medium: &Medium) -> Vec<f64> {
    let dz = medium.height() / STEPS as f64;
    let middle = |k: usize| (k as f64 + 0.5) * dz;
    let mut weight = vec![0.3 / STEPS as f64; STEPS];
    let scatterers: Vec<_> = medium.constituents.iter().filter(|c| c.scatters()).collect();
    for c in &scatterers {
        let density: Vec<f64> = (0..STEPS).map(|k| c.density.at(middle(k))).collect();
        let total: f64 = density.iter().sum();
        if total > 0.0 {
            for (w, d) in weight.iter_mut().zip(&density) {
                *w += 0.5 / scatterers.len() as f64 * d / total;
            }
        }
    }
    let Depths { shares: depth, skin, largest } = depths(medium, middle, dz);
    // In thick air the levels follow optical depth: a share that grows with it, up to nine tenths.
    let share = 0.2 + 0.7 * largest / (largest + 10.0);
    let skin_share = SKIN * ((largest - THIN) / THIN).clamp(0.0, 1.0);
    let sum: f64 = weight.iter().sum();
    let mut cumulative = vec![0.0; STEPS + 1];
    for k in 0..STEPS {
        let step = (1.0 - share) * weight[k] / sum + share * depth[k];
        cumulative[k + 1] = cumulative[k] + step + skin_share * skin[k];
    }
    let end = cumulative[STEPS];
    cumulative.iter().map(|c| c / end).collect()
}

/// Vertical optical depth above which air is thick.
pub(super) const THIN: f64 = 4.0;
/// Levels that thick air has besides at its upper side and over the ground, as a share of the others: there the field
/// bends over a fraction of a unit of optical depth. Found on a layer of depth 30: without those above, its energy
/// balance was 5 % short; without those below, light on the ground was 1.1 % off in the median, and 0.08 % with them.
const SKIN: f64 = 0.3;

/// Optical depths of the steps of height.
struct Depths {
    /// Each step's share of the whole, in the mean over wavelengths, so that a cloud counts that is thin beside the
    /// gas at one wavelength and thick at another.
    shares: Vec<f64>,
    /// Each step's share of what light straight down loses, and of what light straight up does, likewise.
    skin: Vec<f64>,
    /// The largest whole.
    largest: f64,
}

fn depths(medium: &Medium, middle: impl Fn(usize) -> f64, dz: f64) -> Depths {
    let mut out = Depths { shares: vec![0.0; STEPS], skin: vec![0.0; STEPS], largest: 0.0 };
    let count = medium.wavelengths_nm.len();
    for w in 0..count {
        let extinction =
            |z: f64| medium.constituents.iter().map(|c| c.extinction(w) * c.density.at(z)).sum::<f64>();
        let depth: Vec<f64> = (0..STEPS).map(|k| extinction(middle(k)) * dz).collect();
        let whole: f64 = depth.iter().sum();
        out.largest = out.largest.max(whole);
        if whole > 0.0 {
            out.shares.iter_mut().zip(&depth).for_each(|(m, d)| *m += d / whole / count as f64);
        }
        let mut bends = |steps: &mut dyn Iterator<Item = usize>| {
            let mut left = 1.0;
            for k in steps {
                let through = left * libm::exp(-depth[k]);
                out.skin[k] += (left - through) / count as f64;
                left = through;
            }
        };
        bends(&mut (0..STEPS).rev());
        bends(&mut (0..STEPS));
    }
    out
}

fn largest_extinction(medium: &Medium, altitude: f64) -> f64 {
    (0..medium.wavelengths_nm.len())
        .map(|w| medium.constituents.iter().map(|c| c.extinction(w) * c.density.at(altitude)).sum())
        .fold(0.0, f64::max)
}

fn altitude_at(cumulative: &[f64], height: f64, share: f64) -> f64 {
    let after = cumulative.partition_point(|&c| c < share).clamp(1, STEPS);
    let (a, b) = (cumulative[after - 1], cumulative[after]);
    let t = if b > a { (share - a) / (b - a) } else { 0.0 };
    (after as f64 - 1.0 + t) * height / STEPS as f64
}

/// Adds a fine radius at every kink that is not there yet (closer than a ten-thousandth of the height).
fn insert_kinks(fine: &mut Vec<f64>, medium: &Medium) {
    let near = 1e-4 * medium.height();
    for kink in medium.constituents.iter().flat_map(|c| c.density.kinks()) {
        let r = medium.ground_radius + kink;
        if r > medium.ground_radius && r < medium.top_radius && fine.iter().all(|f| (f - r).abs() > near) {
            fine.push(r);
        }
    }
    fine.sort_by(f64::total_cmp);
    cut_thick_shells(fine, medium);
}

fn cut_thick_shells(fine: &mut Vec<f64>, medium: &Medium) {
    let depth = |pair: &[f64]| {
        let middle = 0.5 * (pair[0] + pair[1]) - medium.ground_radius;
        largest_extinction(medium, middle) * (pair[1] - pair[0])
    };
    let depths: Vec<f64> = fine.windows(2).map(depth).collect();
    let mut out = vec![fine[0]];
    for (pair, parts) in fine.windows(2).zip(parts(&depths)) {
        out.extend((1..=parts).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / parts as f64));
        // The last one is the shell's own end, to the bit.
        *out.last_mut().expect("not empty") = pair[1];
    }
    *fine = out;
}

/// Into how many parts each shell is cut, of what is at most [`SHELL_DEPTH`] deep, or more where the parts would
/// be more than [`MOST_SHELLS`]: work grows with their square.
fn parts(depths: &[f64]) -> Vec<usize> {
    let cut = |most: f64| -> Vec<usize> {
        depths.iter().map(|d| (d / most).ceil().clamp(1.0, 64.0) as usize).collect()
    };
    let mut most = SHELL_DEPTH;
    let mut parts = cut(most);
    while parts.iter().sum::<usize>() > MOST_SHELLS.max(depths.len()) {
        most *= 1.25;
        parts = cut(most);
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Thin shells are left whole, thick ones cut to the depth wanted; of a shell a million deep there are no
    /// more parts than can be worked through, and the sum stays bounded however many there are.
    #[test]
    fn thick_air_is_cut_into_a_bounded_number_of_shells() {
        assert_eq!(parts(&[0.1, 1.0, 0.25]), [1, 4, 1]);
        assert_eq!(parts(&[1e6, 0.0]), [64, 1]);
        let many = parts(&[1e4; 90]);
        assert!((90..=MOST_SHELLS).contains(&many.iter().sum()));
        assert_eq!(parts(&vec![1e9; 2 * MOST_SHELLS]), vec![1; 2 * MOST_SHELLS]);
    }
}
