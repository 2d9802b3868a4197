//! Light in a slab of one depth: amplitudes from the boundary conditions, radiance along any direction.

use super::matrix::{Factors, Matrix};
use super::modes::Slab;
use super::orders::{Later, Sweeps};
use super::surface::Dome;
use std::f64::consts::PI;
use std::sync::OnceLock;

/// A direction of sight in the water, with what each mode scatters into it.
pub struct View {
    /// Cosine, positive.
    pub mu: f64,
    polynomials: [Vec<f64>; 2],
    /// Per decaying mode, light scattered upwards and downwards along the direction.
    modes: [Vec<f64>; 2],
}

/// A sunbeam in the water, of unit irradiance on a plane normal to it.
pub struct Beam {
    /// Cosine, positive.
    pub mu: f64,
    up: Vec<f64>,
    down: Vec<f64>,
    moments: Vec<f64>,
}

/// What a beam's own light brings into a direction per scaled optical depth: its exact first scattering and the
/// light that follows it. Upwards and downwards.
pub type Pair = [f64; 2];

/// Light in a slab from one source.
pub struct Field {
    decaying: Vec<f64>,
    growing: Vec<f64>,
    /// 1/mu and, along the streams, up and down, of a beam.
    beam: Option<(f64, Vec<f64>, Vec<f64>)>,
    /// The sky whose light it is.
    sky: Option<Dome>,
    /// Radiance of the bed.
    bed: f64,
    /// Later orders, where their number is given.
    later: Option<Later>,
}

/// A slab of one depth.
pub struct Layer<'a> {
    pub slab: &'a Slab,
    /// Scaled optical depth.
    pub depth: f64,
    factors: Factors,
    sweeps: OnceLock<Sweeps>,
}

/// How close 1/mu of a beam may come to the rate of a mode, relatively: closer, the beam is moved aside.
const RESONANCE: f64 = 1e-6;

impl View {
    /// Scattered light per scaled optical depth from moments, upwards (0) or downwards (1) along the view.
    pub(super) fn scattered(&self, slab: &Slab, side: usize, moments: &[f64]) -> f64 {
        slab.scattered(&self.polynomials[side], moments)
    }
}

impl Slab {
    pub fn view(&self, mu: f64) -> View {
        let polynomials = [self.polynomials_at(mu), self.polynomials_at(-mu)];
        let modes = [0, 1]
            .map(|side: usize| self.moments.iter().map(|m| self.scattered(&polynomials[side], m)).collect());
        View { mu, polynomials, modes }
    }

    pub fn beam(&self, mu: f64) -> Beam {
        let mut mu = mu;
        while self.rates.iter().any(|k| (mu * k - 1.0).abs() < RESONANCE) {
            mu *= 1.0 - 2.0 * RESONANCE;
        }
        let (up, down) = self.particular(mu);
        let moments = self.moments_of(|i| (up[i], down[i]));
        Beam { mu, up, down, moments }
    }

    /// The pair of a beam and a view; `phase_means` are the azimuth means of the exact phase function, 1/sr,
    /// from the beam upwards and downwards along the view.
    pub fn pair(&self, beam: &Beam, view: &View, phase_means: Pair) -> Pair {
        [0, 1].map(|side: usize| {
            self.once * phase_means[side] + self.scattered(&view.polynomials[side], &beam.moments)
        })
    }

    /// The same of light scattered once only.
    pub fn pair_once(&self, phase_means: Pair) -> Pair {
        phase_means.map(|p| self.once * p)
    }
}

impl<'a> Layer<'a> {
    /// A slab of a depth in metres.
    pub fn new(slab: &'a Slab, metres: f64) -> Self {
        let depth = slab.extinction * metres;
        let n = slab.nodes.len();
        let faded: Vec<f64> = slab.rates.iter().map(|k| libm::exp(-k * depth)).collect();
        let (up, down, r) = (&slab.up, &slab.down, &slab.reflects);
        let matrix = Matrix::of(2 * n, 2 * n, |row, column| {
            let (i, j) = (row % n, column % n);
            match (row < n, column < n) {
                (true, true) => down.at(i, j) - r[i] * up.at(i, j),
                (true, false) => faded[j] * (up.at(i, j) - r[i] * down.at(i, j)),
                (false, true) => faded[j] * up.at(i, j),
                (false, false) => down.at(i, j),
            }
        });
        Layer { slab, depth, factors: matrix.factorise(), sweeps: OnceLock::new() }
    }

    /// Light of a beam over a black bed.
    pub fn sun(&self, beam: &Beam) -> Field {
        let n = self.slab.nodes.len();
        let end = libm::exp(-self.depth / beam.mu);
        let mut right = vec![0.0; 2 * n];
        for i in 0..n {
            right[i] = self.slab.reflects[i] * beam.up[i] - beam.down[i];
            right[n + i] = -beam.up[i] * end;
        }
        let mut field = self.solve(&right);
        field.beam = Some((1.0 / beam.mu, beam.up.clone(), beam.down.clone()));
        field
    }

    /// Light of a sky of unit irradiance over a black bed.
    pub fn sky(&self, dome: Dome) -> Field {
        let n = self.slab.nodes.len();
        let mut right = vec![0.0; 2 * n];
        for (i, &(mu, _)) in self.slab.nodes.iter().enumerate() {
            right[i] = self.slab.surface.sky_in_water(dome, mu);
        }
        Field { sky: Some(dome), ..self.solve(&right) }
    }

    /// Light of a bed that sends out a radiance of 1 everywhere, and reflects nothing.
    pub fn bed(&self) -> Field {
        let n = self.slab.nodes.len();
        let mut right = vec![0.0; 2 * n];
        right[n..].fill(1.0);
        Field { bed: 1.0, ..self.solve(&right) }
    }

    /// A beam's light of its first `orders` orders: scattered as often at most where it is seen, and once less
    /// where it meets the bed, whose reflection counts as one. Forward peaks that are scaled away are none.
    pub fn sun_first(&self, beam: &Beam, orders: usize) -> Field {
        let n = self.slab.nodes.len();
        let none = vec![0.0; n];
        let later = (orders > 1 && self.depth > 0.0).then(|| {
            let sweeps = self.sweeps.get_or_init(|| Sweeps::new(self.slab, self.depth));
            sweeps.orders_below(self.slab, beam, orders)
        });
        let beam = Some((1.0 / beam.mu, none.clone(), none.clone()));
        Field { decaying: none.clone(), growing: none, beam, sky: None, bed: 0.0, later }
    }

    fn solve(&self, right: &[f64]) -> Field {
        let mut x = self.factors.solve(right);
        let growing = x.split_off(right.len() / 2);
        Field { decaying: x, growing, beam: None, sky: None, bed: 0.0, later: None }
    }

    /// Radiance on its way up along a view at scaled optical depth `t` below the surface.
    pub fn up(&self, field: &Field, view: &View, pair: Pair, t: f64) -> f64 {
        let (steep, left) = (1.0 / view.mu, self.depth - t);
        let mut sum = field.bed * libm::exp(-left * steep);
        for (j, &k) in self.slab.rates.iter().enumerate() {
            sum += field.decaying[j] * view.modes[0][j] * libm::exp(-k * t) * against(k, view.mu, left);
            sum += field.growing[j] * view.modes[1][j] * along(k, steep, left) * steep;
        }
        if let Some((a, ..)) = &field.beam {
            sum += pair[0] * libm::exp(-a * t) * against(*a, view.mu, left);
        }
        if let Some(later) = &field.later {
            sum += later.up(self.slab, view, t);
        }
        sum
    }

    /// Radiance on its way down along a view at scaled optical depth `t`, the beam itself left out, the sky's
    /// unscattered light included.
    pub fn down(&self, field: &Field, view: &View, pair: Pair, t: f64) -> f64 {
        let steep = 1.0 / view.mu;
        let surface = &self.slab.surface;
        let mirrored = surface.reflects_down(view.mu);
        let mut top = field.sky.map_or(0.0, |dome| surface.sky_in_water(dome, view.mu));
        if mirrored > 0.0 {
            top += mirrored * self.up(field, view, pair, 0.0);
        }
        let mut sum = top * libm::exp(-t * steep);
        for (j, &k) in self.slab.rates.iter().enumerate() {
            sum += field.decaying[j] * view.modes[1][j] * along(k, steep, t) * steep;
            let faded = libm::exp(-k * (self.depth - t));
            sum += field.growing[j] * view.modes[0][j] * faded * against(k, view.mu, t);
        }
        if let Some((a, ..)) = &field.beam {
            sum += pair[1] * along(*a, steep, t) * steep;
        }
        if let Some(later) = &field.later {
            sum += later.down(self.slab, view, t);
        }
        sum
    }

    /// Light along stream number `i` at scaled optical depth `t`, the beam itself left out: up, down.
    fn stream(&self, field: &Field, i: usize, t: f64) -> (f64, f64) {
        let (mut up, mut down) = (0.0, 0.0);
        for (j, &k) in self.slab.rates.iter().enumerate() {
            let from_top = field.decaying[j] * libm::exp(-k * t);
            let from_bed = field.growing[j] * libm::exp(-k * (self.depth - t));
            up += from_top * self.slab.up.at(i, j) + from_bed * self.slab.down.at(i, j);
            down += from_top * self.slab.down.at(i, j) + from_bed * self.slab.up.at(i, j);
        }
        if let Some((a, beam_up, beam_down)) = &field.beam {
            let faded = libm::exp(-a * t);
            up += beam_up[i] * faded;
            down += beam_down[i] * faded;
        }
        (up, down)
    }

    /// Irradiance of the plane at scaled optical depth `t`: from below, and from above with the beam.
    pub fn irradiance(&self, field: &Field, t: f64) -> (f64, f64) {
        let (mut up, mut down) = (0.0, 0.0);
        for (i, &(mu, w)) in self.slab.nodes.iter().enumerate() {
            let (u, d) = self.stream(field, i, t);
            up += 2.0 * PI * mu * w * u;
            down += 2.0 * PI * mu * w * d;
        }
        if let Some((a, ..)) = &field.beam {
            down += libm::exp(-a * t) / a;
        }
        if let Some(later) = &field.later {
            let [from_below, from_above] = later.irradiance(t);
            up += from_below;
            down += from_above;
        }
        (up, down)
    }

    /// Irradiance of the bed.
    pub fn bed_irradiance(&self, field: &Field) -> f64 {
        self.irradiance(field, self.depth).1
    }
}

/// Radiance of a Lambertian bed of an albedo: `lit` is its irradiance while black, `returned` that which comes
/// back to it per unit of its own radiance. All bounces between bed, water and surface.
pub fn seabed_radiance(albedo: f64, lit: f64, returned: f64) -> f64 {
    albedo * lit / (PI - albedo * returned)
}

/// ∫₀ˣ e^{−k s} e^{−s/mu} ds / mu
pub(super) fn against(k: f64, mu: f64, x: f64) -> f64 {
    -libm::expm1(-(k + 1.0 / mu) * x) / (1.0 + k * mu)
}

/// ∫₀ˣ e^{−k s} e^{−b (x − s)} ds, without cancellation where k is close to b.
pub(super) fn along(k: f64, b: f64, x: f64) -> f64 {
    let (least, apart) = (k.min(b), (k - b).abs() * x);
    let mean = if apart < 1e-8 { 1.0 } else { -libm::expm1(-apart) / apart };
    libm::exp(-least * x) * x * mean
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both integrals against their closed forms, and the limit where the two rates meet.
    #[test]
    fn integrals_along_a_ray() {
        let expected = (1.0 - libm::exp(-(0.5 + 1.0 / 0.4) * 2.0)) / (1.0 + 0.5 * 0.4);
        assert!((against(0.5, 0.4, 2.0) - expected).abs() < 1e-15);
        let expected = (libm::exp(-0.6) - libm::exp(-1.4)) / (0.7 - 0.3);
        assert!((along(0.3, 0.7, 2.0) - expected).abs() < 1e-15);
        assert!((along(0.7, 0.7, 2.0) - 2.0 * libm::exp(-1.4)).abs() < 1e-15);
        assert!((along(0.7, 0.7 + 1e-9, 2.0) - 2.0 * libm::exp(-1.4)).abs() < 1e-8);
    }
}
