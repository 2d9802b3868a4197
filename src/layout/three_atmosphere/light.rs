//! Light for the tables: along every ray of the mapping, and on level ground at sixteen heights.

use super::Bruneton;
use crate::colour::weights::ColourWeights;
use crate::geometry::directions;
use crate::layout::elek2010::sums;
use crate::machine::lanes::Lanes;
use crate::medium::{Medium, Role};
use crate::transport::Phase;
use crate::transport::fill::{RayIntegrator, RayLight, SunPairs, Wanted};
use crate::transport::solve::{Batch, Solution};
use rayon::prelude::*;
use std::f64::consts::PI;

/// RGB of a ray's light, cd/m², under one sun.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Light {
    /// Scattered once by gas.
    pub gas: [f32; 3],
    /// Scattered once by aerosols.
    pub aerosol: [f32; 3],
    /// Scattered more than once.
    pub multiple: [f32; 3],
}

/// Light of every texel, `[altitude][view][nu][sun]`.
pub(super) fn scattering(
    medium: &Medium,
    solution: &Solution,
    palette: &ColourWeights,
    mapping: &Bruneton,
) -> Vec<Light> {
    let [altitudes, views, suns, angles] = mapping.size();
    let mut texels = vec![Light::default(); altitudes * views * angles * suns];
    let each = angles * suns;
    let look = Look::new(medium);
    for batch in &solution.batches {
        let painter = RayIntegrator::new(solution, batch, &look.groups).together();
        let colours = Colours::new(palette, batch);
        texels.par_chunks_mut(each).enumerate().for_each_init(RayLight::default, |light, (ray, out)| {
            let altitude = mapping.shell().altitude(ray / views);
            let (mu, hits_ground) = mapping.mu(altitude, ray % views);
            let azimuths = (0..each).map(|n| {
                let mu_s = mapping.mu_s(n % suns);
                (mu_s, Bruneton::possible(mu, mu_s, mapping.nu(n / suns)).1)
            });
            let pairs = SunPairs::listed(azimuths);
            let r = mapping.shell().radii()[0] + altitude;
            painter.ray(r, mu, hits_ground, &pairs, Wanted::Both, light);
            look.add(&colours, light, batch, mu as f32, &pairs, out);
        });
    }
    texels
}

/// Who scatters last, each for itself.
struct Look {
    groups: Vec<Vec<usize>>,
    roles: Vec<Role>,
}

impl Look {
    fn new(medium: &Medium) -> Self {
        let scatterers = || (0..medium.constituents.len()).filter(|&c| medium.constituents[c].scatters());
        Look {
            groups: scatterers().map(|c| vec![c]).collect(),
            roles: scatterers().map(|c| medium.constituents[c].role).collect(),
        }
    }

    /// Adds one batch's light along a ray.
    fn add(
        &self,
        colours: &Colours,
        light: &RayLight,
        batch: &Batch,
        mu: f32,
        pairs: &SunPairs,
        out: &mut [Light],
    ) {
        let phases: Vec<&Phase> = self.groups.iter().map(|g| &batch.optics.phase[g[0]]).collect();
        let sine = (1.0 - mu * mu).max(0.0).sqrt();
        crate::machine::isa::run(
            #[inline(always)]
            || {
                for (p, texel) in out.iter_mut().enumerate() {
                    let nu = pairs.mu_s[p] * mu + pairs.across[p] * sine;
                    let (mut gas, mut aerosol, mut multiple) = (Lanes::ZERO, Lanes::ZERO, Lanes::ZERO);
                    for (g, phase) in phases.iter().enumerate() {
                        let at = g * pairs.len() + p;
                        let once = light.single[at] * phase.value(nu);
                        multiple += light.multiple[at];
                        match self.roles[g] {
                            Role::Gas => gas += once,
                            Role::Aerosol => aerosol += once,
                        }
                    }
                    colours.add(gas, &mut texel.gas);
                    colours.add(aerosol, &mut texel.aerosol);
                    colours.add(multiple, &mut texel.multiple);
                }
            },
        );
    }
}

/// RGB weights of a batch's wavelengths, a vector a component.
struct Colours([Lanes; 3]);

impl Colours {
    fn new(palette: &ColourWeights, batch: &Batch) -> Self {
        let rgb = palette.rgb_weights();
        let range = || batch.first..batch.first + batch.optics.count;
        Colours(std::array::from_fn(|c| Lanes::from_f64(&range().map(|w| rgb[w][c]).collect::<Vec<_>>())))
    }

    #[inline(always)]
    fn add(&self, light: Lanes, out: &mut [f32; 3]) {
        let [r, g, b] = self.0;
        let sums = sums([r * light, g * light, b * light, Lanes::ZERO]);
        out.iter_mut().zip(sums).for_each(|(o, s)| *o += s);
    }
}

/// Texels of the irradiance table (its reader's): sun, altitude.
pub(super) const IRRADIANCE_SIZE: [usize; 2] = [64, 16];
/// Directions of the sky over which its light is summed: heights above the horizontal, and azimuths.
const HEIGHTS: usize = 16;
const AZIMUTHS: usize = 24;

/// Zenith cosine of the sun at texel `k` of the irradiance table.
pub(super) fn irradiance_mu_s(k: usize) -> f64 {
    2.0 * k as f64 / (IRRADIANCE_SIZE[0] - 1) as f64 - 1.0
}

/// Irradiance of a level surface by the sky alone, RGB in lx, `[altitude][sun]`; heights are even from the ground to
/// the top, where there is none.
pub(super) fn irradiance(solution: &Solution, palette: &ColourWeights, medium: &Medium) -> Vec<[f64; 3]> {
    let [suns, altitudes] = IRRADIANCE_SIZE;
    let mu_s: Vec<f64> = (0..suns).map(irradiance_mu_s).collect();
    let pairs = SunPairs::new(&mu_s, &crate::transport::azimuth::midpoint_azimuths(AZIMUTHS));
    let look = Look::new(medium);
    let height = |i: usize| medium.height() * i as f64 / (altitudes - 1) as f64;
    let mut out: Vec<[f64; 3]> = vec![[0.0; 3]; suns * altitudes];
    let rgb = palette.rgb_weights();
    out.par_chunks_mut(suns).enumerate().for_each(|(i, row)| {
        if i == 0 {
            let on_ground = |mu_s: &f64| crate::spectrum::weighted(&rgb, &solution.ground_irradiance(*mu_s));
            row.iter_mut().zip(&mu_s).for_each(|(texel, mu_s)| *texel = on_ground(mu_s));
        } else if i + 1 < altitudes {
            let r = medium.ground_radius + height(i);
            add_sky(solution, palette, &look, r, medium, &pairs, row);
        }
    });
    out
}

fn add_sky(
    solution: &Solution,
    palette: &ColourWeights,
    look: &Look,
    r: f64,
    medium: &Medium,
    pairs: &SunPairs,
    row: &mut [[f64; 3]],
) {
    let mut light = RayLight::default();
    let mut sky = vec![Light::default(); pairs.len()];
    for batch in &solution.batches {
        let painter = RayIntegrator::new(solution, batch, &look.groups).together();
        let colours = Colours::new(palette, batch);
        for d in directions(r, medium.ground_radius, medium.top_radius, HEIGHTS).iter().filter(|d| d.mu > 0.0)
        {
            painter.ray(r, d.mu, false, pairs, Wanted::Both, &mut light);
            sky.fill(Light::default());
            look.add(&colours, &light, batch, d.mu as f32, pairs, &mut sky);
            let weight = 2.0 * PI * d.mu * d.weight / AZIMUTHS as f64;
            for (texel, lights) in row.iter_mut().zip(sky.chunks(AZIMUTHS)) {
                for l in lights {
                    (0..3).for_each(|c| {
                        texel[c] += weight * f64::from(l.gas[c] + l.aerosol[c] + l.multiple[c])
                    });
                }
            }
        }
    }
}
