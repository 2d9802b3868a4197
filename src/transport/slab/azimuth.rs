//! Sunlight that leaves water at given azimuths: what tables of its mean leave out.

use super::{Layer, Slab, Streams, Surface};
use crate::medium::WaterMedium;

/// One wavelength of a water by Fourier modes in azimuth. Light scattered once has its exact phase function, so that
/// the modes only hold what is scattered more often, which is smooth.
pub struct Azimuths {
    modes: Vec<Slab>,
}

/// Modes 0 … 7. More change the range over azimuth of shipped waters by less than 1 %.
const MODES: usize = 8;
/// Azimuths of a range, half a turn.
const STEPS: u32 = 18;

impl Azimuths {
    pub fn new(medium: &WaterMedium, w: usize, surface: Surface) -> Azimuths {
        let one = |m| Slab::of_mode(medium, w, surface, Streams::TABLES, m);
        Azimuths { modes: (0..MODES).map(one).collect() }
    }

    /// The same water at a depth (m), ready for any view.
    pub fn layers(&self, metres: f64) -> Vec<Layer<'_>> {
        self.modes.iter().map(|slab| Layer::new(slab, metres)).collect()
    }
}

/// Radiance of the water's own light of a sun of cosine `mu_s` in the air that lights the surface with `direct`,
/// where it leaves along `mu` in the air at azimuths between view and sun (rad). `layers` as of [`Azimuths::layers`].
pub fn leaving_at(
    medium: &WaterMedium,
    w: usize,
    layers: &[Layer],
    mu: f64,
    (mu_s, direct): (f64, f64),
    azimuths: &[f64],
) -> Vec<f64> {
    let first = layers[0].slab;
    let surface = first.surface;
    let (view, sun) = (surface.cosine_in_water(mu), surface.cosine_in_water(mu_s.max(0.0)));
    let modes: Vec<f64> = layers
        .iter()
        .map(|layer| {
            let (view, beam) = (layer.slab.view(view), layer.slab.beam(sun));
            let pair = layer.slab.pair(&beam, &view, [0.0; 2]);
            layer.up(&layer.sun(&beam), &view, pair, 0.0)
        })
        .collect();
    let (inside, beam) = (first.view(view), first.beam(sun));
    let once = layers[0].sun_first(&beam, 1);
    let entered = (1.0 - super::fresnel(mu_s.max(0.0), surface.n)) * direct / sun * surface.leaves(mu);
    let sines = ((1.0 - view * view) * (1.0 - sun * sun)).max(0.0).sqrt();
    azimuths
        .iter()
        .map(|&azimuth| {
            // Looking towards the sun, light is turned the least.
            let phase = medium.phase(w, -view * sun + sines * libm::cos(azimuth));
            let more: f64 = modes
                .iter()
                .enumerate()
                .map(|(m, light)| match m {
                    0 => *light,
                    _ => 2.0 * light * libm::cos(m as f64 * azimuth),
                })
                .sum();
            entered * (layers[0].up(&once, &inside, first.pair_once([phase, 0.0]), 0.0) + more)
        })
        .collect()
}

/// Half the range over azimuth of [`leaving_at`].
pub fn azimuth_half_spread(
    medium: &WaterMedium,
    w: usize,
    layers: &[Layer],
    mu: f64,
    sun: (f64, f64),
) -> f64 {
    let step = std::f64::consts::PI / f64::from(STEPS);
    let azimuths: Vec<f64> = (0..=STEPS).map(|k| f64::from(k) * step).collect();
    let light = leaving_at(medium, w, layers, mu, sun, &azimuths);
    let (low, high) = light.iter().fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(*v), b.max(*v)));
    0.5 * (high - low)
}
