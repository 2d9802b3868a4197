//! The light that leaves a body of water, part by part: what tables hold and exact answers add up.

use super::{Beam, Dome, Field, Layer, Pair, Slab, View, phase_mean, seabed_radiance};
use crate::medium::WaterMedium;

/// Which light of the sun is counted; sky and seabed light always is whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaterOrders {
    /// Scattered any number of times.
    All,
    /// The first so many orders, see [`Layer::sun_first`]; 1 is the paper's shortcut.
    First(usize),
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
                    WaterOrders::First(_) => slab.pair_once(means),
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
            WaterOrders::First(n) => layer.sun_first(&self.beams[beam], n),
        }
    }
}

/// Light from above on a water surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light<'a> {
    /// Cosine of the sun's zenith angle in the air.
    pub mu_s: f64,
    /// Irradiance of the surface by the sun itself, on the horizontal.
    pub direct: f64,
    /// Irradiance of the surface by the sky, in the two parts of [`Dome::PARTS`].
    pub sky: [f64; 2],
    /// Light of a sky from cosines of the zenith angle (in the air): irradiance of the surface by each. Beams of
    /// any azimuth, since the mean over it is all that is asked for.
    pub beams: &'a [(f64, f64)],
}

impl Light<'_> {
    /// The sun alone.
    pub fn sun(mu_s: f64, direct: f64) -> Self {
        Light { mu_s, direct, sky: [0.0; 2], beams: &[] }
    }
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
    let look = |field: &Field, view: &View, pair: Pair| layer.up(field, view, pair, 0.0);
    seen(medium, w, layer, inside, light, orders, false, look).map(|l| l * surface.leaves(mu))
}

/// Radiance in the water, the sun's disc left out, at `observer` (0 at the surface, 1 at the bed) into the
/// direction of zenith cosine `mu` in the water, below 0 downwards; parts and unit as of [`leaving`]. Of beams, no
/// unscattered light is seen.
pub fn within(
    medium: &WaterMedium,
    w: usize,
    layer: &Layer,
    (mu, observer): (f64, f64),
    light: Light,
    orders: WaterOrders,
) -> [f64; 2] {
    let t = layer.depth * observer;
    let look = |field: &Field, view: &View, pair: Pair| match mu < 0.0 {
        true => layer.up(field, view, pair, t),
        false => layer.down(field, view, pair, t),
    };
    // A level ray gets nowhere.
    seen(medium, w, layer, mu.abs().max(1e-4), light, orders, true, look)
}

/// Light of water and bed as `look` sees it.
fn seen(
    medium: &WaterMedium,
    w: usize,
    layer: &Layer,
    inside: f64,
    light: Light,
    orders: WaterOrders,
    downwards: bool,
    look: impl Fn(&Field, &View, Pair) -> f64,
) -> [f64; 2] {
    let surface = layer.slab.surface;
    let angles = |orders, suns: &[f64]| {
        let suns: Vec<f64> = suns.iter().map(|&s| surface.cosine_in_water(s.max(0.0))).collect();
        Angles::new(medium, w, layer.slab, &[inside], &suns, orders, downwards)
    };
    let mut lit = [0.0; 2];
    let mut add = |angles: &Angles, k: usize, mu: f64, irradiance: f64| {
        if mu > 0.0 && irradiance > 0.0 {
            let entered = (1.0 - super::fresnel(mu, surface.n)) * irradiance / angles.beams[k].mu;
            let field = angles.sun(layer, k);
            lit[0] += entered * look(&field, &angles.views[0], angles.pair(0, k));
            lit[1] += entered * layer.bed_irradiance(&field);
        }
    };
    let sun = angles(orders, &[light.mu_s]);
    add(&sun, 0, light.mu_s, light.direct);
    if !light.beams.is_empty() {
        let mus: Vec<f64> = light.beams.iter().map(|b| b.0).collect();
        let beams = angles(WaterOrders::All, &mus);
        light.beams.iter().enumerate().for_each(|(k, &(mu, irradiance))| add(&beams, k, mu, irradiance));
    }
    let view = &sun.views[0];
    for (dome, irradiance) in Dome::PARTS.into_iter().zip(light.sky) {
        if irradiance > 0.0 {
            let field = layer.sky(dome);
            lit[0] += irradiance * look(&field, view, [0.0; 2]);
            lit[1] += irradiance * layer.bed_irradiance(&field);
        }
    }
    let bed = layer.bed();
    let radiance = seabed_radiance(medium.seabed_albedo[w], lit[1], layer.bed_irradiance(&bed));
    [lit[0], radiance * look(&bed, view, [0.0; 2])]
}
