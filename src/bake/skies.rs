//! A sample of a planet's own skies, on which colours are fitted and judged.

use crate::lanes::Lanes;
use crate::medium::Medium;
use crate::transport::fill::{Painter, RayLight, SunPairs, Wanted};
use crate::transport::solve::{Batch, Solution, lowest_sun};

/// Spectra of radiance over solar irradiance, one value a wavelength.
pub type Transfers = Vec<Vec<f64>>;

/// A lattice of views: the two halves of a sample take the two `offset`s.
struct Lattice {
    altitudes: [f64; 3],
    views: [f64; 5],
    suns: [f64; 9],
    azimuths: [f64; 2],
}

fn lattice(medium: &Medium, offset: f64) -> Lattice {
    let low = 0.75 * lowest_sun(medium);
    let sun =
        |k: usize| low + (1.0 - low) * ((k as f64 + 0.3 + 0.4 * offset) / 9.0) * ((k as f64 + 1.0) / 9.0);
    Lattice {
        altitudes: [0.0, 0.12 + 0.1 * offset, 1.0],
        views: [-0.9, -0.35, 0.04, 0.3, 0.85].map(|mu: f64| (mu + 0.1 * offset).min(1.0)),
        suns: std::array::from_fn(sun),
        azimuths: [-0.8 + 0.3 * offset, 0.9 - 0.4 * offset],
    }
}

/// Skies, sunlit ground and sunlight of a solved planet; `offset` 0 and 1 give two samples without a common
/// view. Dark spectra are left out.
pub fn sample(solution: &Solution, medium: &Medium, offset: f64) -> Transfers {
    let scatterers: Vec<Vec<usize>> = (0..medium.constituents.len())
        .filter(|&c| medium.constituents[c].scatters())
        .map(|c| vec![c])
        .collect();
    let count = medium.wavelengths_nm.len();
    let mut out: Transfers = Vec::new();
    for batch in &solution.batches {
        let part = batch_sample(solution, batch, medium, &scatterers, &lattice(medium, offset));
        if out.is_empty() {
            out = vec![Vec::with_capacity(count); part.len()];
        }
        for (all, lanes) in out.iter_mut().zip(&part) {
            all.extend(lanes.0[..batch.optics.count].iter().map(|&v| f64::from(v)));
        }
    }
    let brightest = out.iter().flatten().fold(0.0, |a: f64, &b| a.max(b));
    out.retain(|t| t.iter().all(|v| v.is_finite()) && t.iter().any(|&v| v > 1e-7 * brightest));
    out
}

fn batch_sample(
    solution: &Solution,
    batch: &Batch,
    medium: &Medium,
    groups: &[Vec<usize>],
    lattice: &Lattice,
) -> Vec<Lanes> {
    let painter = Painter::new(solution, batch, groups);
    let pairs = SunPairs::new(&lattice.suns, &lattice.azimuths);
    let mut light = RayLight::default();
    let mut out = Vec::new();
    for altitude in lattice.altitudes {
        let r = medium.ground_radius + altitude * medium.height();
        let horizon = -((r - medium.ground_radius) * (r + medium.ground_radius)).max(0.0).sqrt() / r;
        for mu in lattice.views.into_iter().filter(|&mu| !(altitude == 1.0 && mu > 0.0)) {
            painter.ray(r, mu, mu < horizon, &pairs, Wanted::Both, &mut light);
            let sine = (1.0 - mu * mu).sqrt() as f32;
            for p in 0..pairs.len() {
                let nu = (pairs.mu_s[p] * mu as f32 + pairs.across[p] * sine).clamp(-1.0, 1.0);
                let mut sum = Lanes::ZERO;
                for (g, group) in groups.iter().enumerate() {
                    let at = g * pairs.len() + p;
                    sum += light.single[at] * batch.optics.phase[group[0]].value(nu) + light.multiple[at];
                }
                out.push(sum);
            }
        }
    }
    for sun in lattice.suns.into_iter().filter(|&s| s > 0.0) {
        let through = batch.sunlight.at(0, sun as f32);
        out.push(through);
        out.push(through * through);
    }
    out
}
