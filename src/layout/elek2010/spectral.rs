//! Spectral files of the paper's layout, after Fichet et al. 2021: a channel for each wavelength.

use super::mapping;
use crate::error::Result;
use crate::files::exr::{Spectral, spectral_attributes, spectral_channel, to_exr_bytes};
use crate::files::{Atlas, Samples};
use crate::layout::settings::Settings;
use crate::mapping::Elek2010;
use crate::medium::{Medium, Role};
use crate::preset::Planet;
use crate::transport::fill::{RayIntegrator, RayLight, SunPairs, Wanted};
use crate::transport::solve::Solution;
use rayon::prelude::*;

/// Path, description and content of every spectral file: radiance of light last scattered by gas and by
/// aerosol (the latter isotropic, as the paper's medium has it) in W/(m² sr nm) for the preset's star.
pub fn files(
    medium: &Medium,
    solution: &Solution,
    planet: &Planet,
    settings: &Settings,
) -> Result<Vec<(String, String, Vec<u8>)>> {
    let mapping = mapping(medium, settings.elek2010_size, &settings.window)
        .expect("sizes are checked with the arguments");
    let irradiance = planet.star.irradiance.at_all(&medium.wavelengths_nm);
    let mut out = Vec::new();
    for (role, name) in [(Role::Gas, "gas"), (Role::Aerosol, "aerosol")] {
        let members: Vec<usize> = (0..medium.constituents.len())
            .filter(|&c| medium.constituents[c].scatters() && medium.constituents[c].role == role)
            .collect();
        if members.is_empty() {
            continue;
        }
        let atlas = radiance(medium, solution, &mapping, &members, name, &irradiance);
        let about = format!(
            "spectral radiance of light last scattered by {name}, elek2010 axes, slices as in elek2010/scattering.exr"
        );
        out.push((format!("spectral/scattering_{name}.exr"), about, to_exr_bytes(&atlas)?));
    }
    Ok(out)
}

fn radiance(
    medium: &Medium,
    solution: &Solution,
    mapping: &Elek2010,
    members: &[usize],
    name: &str,
    irradiance: &[f64],
) -> Atlas {
    let [altitudes, views, suns, azimuths] = mapping.size();
    let mu_s: Vec<f64> = (0..suns).map(|k| mapping.mu_s(k)).collect();
    let cosines: Vec<f64> = (0..azimuths).map(|l| mapping.cos_azimuth(l)).collect();
    let pairs = SunPairs::new(&mu_s, &cosines);
    let count = medium.wavelengths_nm.len();
    let groups: Vec<Vec<usize>> = members.iter().map(|&c| vec![c]).collect();
    let mut rays = vec![0.0f32; altitudes * views * pairs.len() * count];
    for batch in &solution.batches {
        let painter = RayIntegrator::new(solution, batch, &groups);
        rays.par_chunks_mut(pairs.len() * count).enumerate().for_each_init(
            RayLight::default,
            |light, (ray, out)| {
                let (mu, hits_ground) = mapping.mu(mapping.altitude(ray / views), ray % views);
                painter.ray(mapping.radius(ray / views), mu, hits_ground, &pairs, Wanted::Both, light);
                let sine = (1.0 - mu * mu).max(0.0).sqrt() as f32;
                for p in 0..pairs.len() {
                    let nu = pairs.mu_s[p] * mu as f32 + pairs.across[p] * sine;
                    for (g, &c) in members.iter().enumerate() {
                        let at = g * pairs.len() + p;
                        let value = light.single[at] * batch.optics.phase[c].value(nu) + light.multiple[at];
                        for w in 0..batch.optics.count {
                            let star = irradiance[batch.first + w] as f32;
                            out[p * count + batch.first + w] += value[w].max(0.0) * star;
                        }
                    }
                }
            },
        );
    }
    let mut atlas = Atlas::new(format!("spectral/{name}"), [altitudes, views, suns * azimuths]);
    atlas.attributes = spectral_attributes();
    for (w, nm) in medium.wavelengths_nm.iter().enumerate() {
        let mut samples = Vec::with_capacity(altitudes * views * pairs.len());
        for slice in 0..suns * azimuths {
            let pair = slice % suns * azimuths + slice / suns;
            for view in 0..views {
                for altitude in 0..altitudes {
                    samples.push(rays[((altitude * views + view) * pairs.len() + pair) * count + w]);
                }
            }
        }
        atlas = atlas.with(spectral_channel(Spectral::Radiance, *nm), Samples::Float(samples));
    }
    atlas
}
