//! A sample of a planet's own skies, on which colours are fitted and judged.

use crate::error::{Error, Result};
use crate::files::exr::{Spectral, from_exr_bytes, spectral_attributes, spectral_channel, to_exr_bytes};
use crate::files::{Atlas, Samples};
use crate::machine::lanes::Lanes;
use crate::mapping::{Views, Window};
use crate::medium::Medium;
use crate::transport::fill::{RayIntegrator, RayLight, SunPairs, Wanted};
use crate::transport::solve::{Batch, Solution, lowest_sun};
use std::path::Path;

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

/// Share of a sample's brightest light below which light is darkness.
const DARK: f64 = 1e-7;

/// Skies of a solved planet; `offset` 0 and 1 give two samples without a common view. Left out is what is dark at every
/// wavelength. They are those of a window where tables are for one.
pub fn sample(solution: &Solution, medium: &Medium, offset: f64, window: &Window) -> Skies {
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
    // Views come first, then sunlight, twice for each sun above the horizon.
    let views = all.len() - 2 * lattice.suns.iter().filter(|&&sun| sun > 0.0).count();
    let sunlight = all.split_off(views);
    Skies::of(all, sunlight)
}

fn largest(transfer: &[f64]) -> f64 {
    transfer.iter().fold(0.0, |a: f64, &b| a.max(b))
}

impl Skies {
    /// Views and sunlight, each with the sun's cosine, sunlight from low to high suns and in pairs, without what tells
    /// nothing of colours: what is dark beside the brightest, and what a solver got wrong. A black wavelength beside
    /// lit ones is a fact of a sky, and a colour to be met.
    ///
    /// Sunlight is left out besides where it ends in darkness that a higher sun does not have: it came through so much
    /// air that its blue is lost to single precision.
    fn of(views: Vec<(Vec<f64>, f64)>, sunlight: Vec<(Vec<f64>, f64)>) -> Skies {
        let finite = |t: &[f64]| t.iter().all(|v| v.is_finite());
        let all = views.iter().chain(&sunlight).filter(|(t, _)| finite(t));
        let brightest = all.fold(0.0, |a: f64, (t, _)| a.max(largest(t)));
        let black = |t: &[f64]| t.iter().map(|&v| v <= DARK * largest(t)).collect::<Vec<_>>();
        let always = sunlight.iter().rev().nth(1).map(|(highest, _)| black(highest)).unwrap_or_default();
        let fades = |t: &[f64]| black(t).iter().zip(&always).any(|(now, always)| *now && !always);
        let lit = |t: &[f64]| {
            let most = largest(t);
            finite(t) && most > DARK * brightest && t.iter().all(|&v| v >= -DARK * most)
        };
        let views = views.into_iter().filter(|(t, _)| lit(t));
        let sunlight = sunlight.into_iter().filter(|(t, _)| lit(t) && !fades(t));
        let positive = |(t, mu_s): (Vec<f64>, f64)| (t.into_iter().map(|v| v.max(0.0)).collect(), mu_s);
        let (transfers, mu_s) = views.chain(sunlight).map(positive).unzip();
        Skies { transfers, mu_s }
    }
}

/// Light of one batch of wavelengths, and the cosine of the sun, in the same order for every batch.
fn batch_sample(
    solution: &Solution,
    batch: &Batch,
    medium: &Medium,
    groups: &[Vec<usize>],
    lattice: &Lattice,
) -> Vec<(Lanes, f64)> {
    let painter = RayIntegrator::new(solution, batch, groups);
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
        // As a file of them keeps it.
        let sun = f64::from(sun as f32);
        out.push((through, sun));
        out.push((through * through, sun));
    }
    out
}

/// Where the samples of a bake are kept.
pub const FILE: &str = "compact/skies.exr";
/// Channels that are no spectra: the sample that a sky belongs to, and the cosine of the sun's zenith angle.
const SAMPLE: &str = "sample";
const MU_S: &str = "mu_s";

/// Path, description and content of a file with both samples, a pixel a sky, every bit kept.
pub fn file(samples: &[Skies; 2], wavelengths_nm: &[f64]) -> Result<(String, String, Vec<u8>)> {
    let all = || samples.iter().flat_map(|s| &s.transfers);
    let mut atlas = Atlas::new(FILE, [all().count(), 1, 1]);
    atlas.attributes = spectral_attributes();
    for (w, nm) in wavelengths_nm.iter().enumerate() {
        let values = Samples::float(all().map(|t| t[w]));
        atlas = atlas.with(spectral_channel(Spectral::Ratio, *nm), values);
    }
    let numbers = samples.iter().enumerate().flat_map(|(n, s)| s.transfers.iter().map(move |_| n as f64));
    atlas = atlas.with(SAMPLE, Samples::float(numbers));
    atlas = atlas.with(MU_S, Samples::float(samples.iter().flat_map(|s| s.mu_s.iter().copied())));
    let about = "skies of this planet, radiance over the star's irradiance, 1/sr, at all wavelengths: sample 0, on \
                 which the matrices were fitted, and sample 1, on which they were judged";
    Ok((FILE.into(), about.into(), to_exr_bytes(&atlas)?))
}

/// Both samples from the bytes of that file; `path` is for messages.
///
/// # Errors
/// `File` for a file that is damaged, or of other wavelengths.
pub fn from_file(path: &Path, bytes: &[u8], wavelengths_nm: &[f64]) -> Result<[Skies; 2]> {
    let atlas = from_exr_bytes(path, bytes)?;
    let channel = |name: &str| {
        let found = atlas.channel(name);
        found.ok_or_else(|| Error::file(path, format!("it has no channel {name}")))
    };
    let spectra = wavelengths_nm.iter().map(|nm| channel(&spectral_channel(Spectral::Ratio, *nm)));
    let spectra = spectra.collect::<Result<Vec<_>>>()?;
    let (numbers, suns) = (channel(SAMPLE)?, channel(MU_S)?);
    if let Some(odd) = atlas.channels.iter().find(|c| c.samples.first_not_finite().is_some()) {
        return Err(Error::file(path, format!("channel {} has a number that is not finite", odd.name)));
    }
    let mut samples: [Skies; 2] = Default::default();
    for k in 0..atlas.width {
        let sample = &mut samples[usize::from(numbers.samples.get(k) > 0.5)];
        sample.transfers.push(spectra.iter().map(|c| f64::from(c.samples.get(k))).collect());
        sample.mu_s.push(f64::from(suns.samples.get(k)));
    }
    Ok(samples)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sky that is black at a wavelength counts as any other, and so does sunlight where that wavelength never arrives;
    /// dark skies, sunlight that lost its blue on a long way, and what is no light do not.
    #[test]
    fn a_black_wavelength_is_no_reason_to_leave_a_sky_out() {
        let sky = |t: [f64; 3]| (t.to_vec(), 0.5);
        let views = vec![
            sky([0.2, 0.1, 0.0]),
            sky([0.0, 0.0, 0.3]),
            sky([0.1, 0.1, -1e-12]),
            sky([1e-9, 1e-9, 1e-9]),
            sky([0.2, 0.1, -0.1]),
            sky([f64::INFINITY, 0.1, 0.1]),
        ];
        let sun = [[0.0, 0.1, 0.0], [0.0, 0.01, 0.0], [0.5, 0.6, 0.0], [0.25, 0.36, 0.0]].map(sky);
        let found = Skies::of(views, sun.to_vec()).transfers;
        let expected =
            [[0.2, 0.1, 0.0], [0.0, 0.0, 0.3], [0.1, 0.1, 0.0], [0.5, 0.6, 0.0], [0.25, 0.36, 0.0]];
        assert_eq!(found, expected.map(|t| t.to_vec()));
    }

    /// What was sampled comes back bit for bit, in its sample and order.
    #[test]
    fn samples_come_back() {
        let sky = |v: f32| vec![f64::from(v), f64::from(v * 1e-7), 0.0];
        let of = |v: &[f32]| Skies {
            transfers: v.iter().map(|&v| sky(v)).collect(),
            mu_s: v.iter().map(|&v| f64::from(-v)).collect(),
        };
        let samples = [of(&[0.1, 0.2, 0.3]), of(&[0.7])];
        let nm = [380.0, 412.345_678, 780.0];
        let (_, _, bytes) = file(&samples, &nm).unwrap();
        assert_eq!(from_file(Path::new(FILE), &bytes, &nm).unwrap(), samples);
        assert!(from_file(Path::new(FILE), &bytes, &[500.0]).is_err());
    }
}
