//! The light that leaves a body of water, part by part: what tables hold and exact answers add up.

use super::{Beam, Field, Layer, Pair, Slab, View, phase_mean, seabed_radiance};
use crate::medium::WaterMedium;

/// Which light of the sun is counted; sky and seabed light always is whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaterOrders {
    /// Scattered any number of times.
    All,
    /// Scattered once in the water, or not at all on its way to the bed and back: the paper's shortcut.
    Single,
}

/// Directions and beams of a slab with what passes between them: everything that does not depend on depth.
pub struct Angles {
    pub views: Vec<View>,
    pub beams: Vec<Beam>,
    /// `[view][beam]`
    pairs: Vec<Pair>,
    orders: WaterOrders,
}

impl Angles {
    /// For wavelength number `w` of the medium of `slab`; cosines in the water. Pairs downwards are left out
    /// (0) unless `downwards`, since only underwater views need them.
    pub fn new(
        medium: &WaterMedium,
        w: usize,
        slab: &Slab,
        views: &[f64],
        beams: &[f64],
        orders: WaterOrders,
        downwards: bool,
    ) -> Angles {
        let views: Vec<View> = views.iter().map(|&mu| slab.view(mu)).collect();
        let beams: Vec<Beam> = beams.iter().map(|&mu| slab.beam(mu)).collect();
        let mean = |a: f64, b: f64| phase_mean(|nu| medium.phase(w, nu), a, -b);
        let mut pairs = Vec::with_capacity(views.len() * beams.len());
        for v in &views {
            for b in &beams {
                let means = [mean(v.mu, b.mu), if downwards { mean(-v.mu, b.mu) } else { 0.0 }];
                pairs.push(match orders {
                    WaterOrders::All => slab.pair(b, v, means),
                    WaterOrders::Single => slab.pair_once(means),
                });
            }
        }
        Angles { views, beams, pairs, orders }
    }

    pub fn pair(&self, view: usize, beam: usize) -> Pair {
        self.pairs[view * self.beams.len() + beam]
    }

    /// The light of a beam in a layer.
    pub fn sun(&self, layer: &Layer, beam: usize) -> Field {
        match self.orders {
            WaterOrders::All => layer.sun(&self.beams[beam]),
            WaterOrders::Single => layer.sun_once(&self.beams[beam]),
        }
    }
}

/// Light from above on a water surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Cosine of the sun's zenith angle in the air.
    pub mu_s: f64,
    /// Irradiance of the surface by the sun itself, on the horizontal.
    pub direct: f64,
    /// Irradiance of the surface by the sky, taken to be evenly bright.
    pub diffuse: f64,
}

/// Radiance that leaves the water along `mu` (cosine in the air), of the water over a black bed and of the bed
/// with all its bounces, in the unit of the light over sr.
pub fn leaving(
    medium: &WaterMedium,
    w: usize,
    layer: &Layer,
    mu: f64,
    light: Light,
    orders: WaterOrders,
) -> [f64; 2] {
    let surface = layer.slab.surface;
    let inside = surface.cosine_in_water(mu);
    let sun = surface.cosine_in_water(light.mu_s.max(0.0));
    let angles = Angles::new(medium, w, layer.slab, &[inside], &[sun], orders, false);
    let entered = if light.mu_s > 0.0 {
        (1.0 - super::fresnel(light.mu_s, surface.n)) * light.direct / sun
    } else {
        0.0
    };
    let view = &angles.views[0];
    let (sunlit, sky, bed) = (angles.sun(layer, 0), layer.sky(), layer.bed());
    let water = entered * layer.up(&sunlit, view, angles.pair(0, 0), 0.0)
        + light.diffuse * layer.up(&sky, view, [0.0; 2], 0.0);
    let lit = entered * layer.bed_irradiance(&sunlit) + light.diffuse * layer.bed_irradiance(&sky);
    let radiance = seabed_radiance(medium.seabed_albedo[w], lit, layer.bed_irradiance(&bed));
    let seen = radiance * layer.up(&bed, view, [0.0; 2], 0.0);
    [water, seen].map(|l| l * surface.leaves(mu))
}
