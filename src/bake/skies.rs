//! A sample of a planet's own skies, on which colours are fitted and judged.

use crate::lanes::Lanes;
use crate::medium::Medium;
use crate::table::{Views, Window};
use crate::transport::fill::{Painter, RayLight, SunPairs, Wanted};
use crate::transport::solve::{Batch, Solution, lowest_sun};

/// Skies, sunlit ground and sunlight of a planet, a sky an entry.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skies {
    /// `[sky][wavelength]`: spectra of radiance over solar irradiance, 1/sr; of sunlight, its transmittance.
    pub transfers: Vec<Vec<f64>>,
    /// `[sky]`: cosine of the sun's zenith angle at the observer.
    pub mu_s: Vec<f64>,
}

impl Skies {
    /// The same skies at some of their wavelengths.
    pub fn at(&self, wavelengths: &[usize]) -> Vec<Vec<f64>> {
        self.transfers.iter().map(|t| wavelengths.iter().map(|&w| t[w]).collect()).collect()
    }
}

/// A lattice of views: the two halves of a sample take the two `offset`s.
struct Lattice {
    /// Shares of the shell's height. Eyes are mostly near the ground; the top stands for all of space.
    altitudes: Vec<f64>,
    /// Cosines of the view below the top, closest at the horizon, where spectra change fastest.
    views: [f64; 7],
    /// Whether views that meet the ground count.
    ground: bool,
    /// Cosines of the view at the top, downwards.
    from_space: [f64; 4],
    suns: [f64; 12],
    azimuths: [f64; 3],
}

/// Least range of suns, degrees: skies of one sun alone are too much alike to fit colours on.
const LEAST_SUNS: f64 = 6.0;

fn lattice(medium: &Medium, offset: f64, window: &Window) -> Lattice {
    let least = 0.75 * lowest_sun(medium);
    let [low, high] = suns(medium, window).map_or([least, 1.0], |ends| ends.map(|mu_s| mu_s.max(least)));
    let sun =
        |k: usize| low + (high - low) * ((k as f64 + 0.3 + 0.4 * offset) / 12.0) * ((k as f64 + 1.0) / 12.0);
    let shares = [0.0, 0.002 + 0.002 * offset, 0.04 + 0.02 * offset, 0.2 + 0.1 * offset, 1.0];
    let ends = window.altitudes_in(medium.height()).map(|a| a / medium.height());
    let mut altitudes: Vec<f64> = shares.iter().map(|share| share.clamp(ends[0], ends[1])).collect();
    altitudes.dedup();
    let from_space = [-0.97, -0.75, -0.5, -0.22];
    Lattice {
        altitudes,
        ground: window.views == Views::All,
        views: [-0.9, -0.35, -0.04, 0.04, 0.13, 0.35, 0.85].map(|mu: f64| mu + 0.05 * offset),
        from_space: from_space.map(|mu| mu + 0.08 * offset),
        suns: std::array::from_fn(sun),
        azimuths: [-0.85 + 0.2 * offset, 0.15 + 0.2 * offset, 0.93 - 0.2 * offset],
    }
}

/// Cosines of the lowest and the highest sun of a window that has them, widened where it is narrow.
fn suns(medium: &Medium, window: &Window) -> Option<[f64; 2]> {
    let [low, high] = window.suns?;
    let more = (0.5 * (LEAST_SUNS - (high - low))).max(0.0);
    let wide = Window { suns: Some([low - more, high + more]), ..*window };
    wide.suns_in(medium.ground_radius, medium.top_radius)
}

impl Lattice {
    fn views_at(&self, altitude: f64) -> &[f64] {
        if altitude < 1.0 { &self.views } else { &self.from_space }
    }
}

/// Skies of a solved planet; `offset` 0 and 1 give two samples without a common view. Left out are dark spectra
/// and those that end in darkness (sunlight through so much air that its blue is lost to single precision). They are
/// those of a window where tables are for one.
pub fn sample(solution: &Solution, medium: &Medium, offset: f64, window: &Window) -> Skies {
    const DARK: f64 = 1e-7;
    let lattice = lattice(medium, offset, window);
    let scatterers: Vec<Vec<usize>> = (0..medium.constituents.len())
        .filter(|&c| medium.constituents[c].scatters())
        .map(|c| vec![c])
        .collect();
    let count = medium.wavelengths_nm.len();
    let mut all: Vec<(Vec<f64>, f64)> = Vec::new();
    for batch in &solution.batches {
        let part = batch_sample(solution, batch, medium, &scatterers, &lattice);
        all.resize_with(part.len(), || (Vec::with_capacity(count), 0.0));
        for ((transfer, sun), (lanes, mu_s)) in all.iter_mut().zip(&part) {
            transfer.extend(lanes.0[..batch.optics.count].iter().map(|&v| f64::from(v)));
            *sun = *mu_s;
        }
    }
    let largest = |t: &[f64]| t.iter().fold(0.0, |a: f64, &b| a.max(b));
    let brightest = all.iter().fold(0.0, |a: f64, (t, _)| a.max(largest(t)));
    let lit = |t: &[f64]| largest(t) > DARK * brightest && t.iter().all(|&v| v > DARK * largest(t));
    let (transfers, mu_s) =
        all.into_iter().filter(|(t, _)| t.iter().all(|v| v.is_finite()) && lit(t)).unzip();
    Skies { transfers, mu_s }
}

/// Light of one batch of wavelengths, and the cosine of the sun, in the same order for every batch.
fn batch_sample(
    solution: &Solution,
    batch: &Batch,
    medium: &Medium,
    groups: &[Vec<usize>],
    lattice: &Lattice,
) -> Vec<(Lanes, f64)> {
    let painter = Painter::new(solution, batch, groups);
    let pairs = SunPairs::new(&lattice.suns, &lattice.azimuths);
    let mut light = RayLight::default();
    let mut out = Vec::new();
    for &altitude in &lattice.altitudes {
        let r = medium.ground_radius + altitude * medium.height();
        let horizon = -((r - medium.ground_radius) * (r + medium.ground_radius)).max(0.0).sqrt() / r;
        for &mu in lattice.views_at(altitude) {
            let hits_ground = mu < horizon;
            if hits_ground && !lattice.ground {
                continue;
            }
            painter.ray(r, mu, hits_ground, &pairs, Wanted::Both, &mut light);
            let sine = (1.0 - mu * mu).sqrt() as f32;
            for p in 0..pairs.len() {
                let nu = (pairs.mu_s[p] * mu as f32 + pairs.across[p] * sine).clamp(-1.0, 1.0);
                let mu_s = f64::from(pairs.mu_s[p]);
                let mut sum = Lanes::ZERO;
                if hits_ground {
                    sum = solution.ground_light(batch, r, mu, mu_s, f64::from(nu), light.depth);
                }
                for (g, group) in groups.iter().enumerate() {
                    let at = g * pairs.len() + p;
                    sum += light.single[at] * batch.optics.phase[group[0]].value(nu) + light.multiple[at];
                }
                out.push((sum, mu_s));
            }
        }
    }
    for sun in lattice.suns.into_iter().filter(|&s| s > 0.0) {
        let through = solution.sun_transmittance_of(batch, medium.ground_radius, sun);
        out.push((through, sun));
        out.push((through * through, sun));
    }
    out
}
