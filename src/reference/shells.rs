//! The air at one wavelength as thin shells, in each of which a coefficient is a cubic in the squared radius.
//!
//! On a straight ray r² = b² + x², with b its distance from the planet's centre and x the path from that
//! nearest point, so that a polynomial in r² is one in x and optical depths are closed forms: there is no
//! quadrature and no table of directions. Shells end where a profile or its slope jumps, and are halved until
//! each cubic is within [`TOLERANCE`] of the local extinction, so what remains of error is that of the fit.

use crate::medium::Medium;

/// Largest error of a fitted coefficient, relative to the extinction there.
const TOLERANCE: f64 = 2e-6;
/// Vertical optical depth of a shell, unless that needed more than `MOST_BY_DEPTH` shells: sampling treats a
/// shell as one piece.
const DEPTH: f64 = 0.5;
const MOST_BY_DEPTH: f64 = 200.0;
/// Least number of shells.
const LEAST: f64 = 16.0;
/// Thinnest shell, as a part of the atmosphere's height.
const THINNEST: f64 = 1e-7;

/// Coefficients of 1, u, u², u³, where u runs from 0 to 1 across a shell, linearly in r².
pub(super) type Cubic = [f64; 4];

#[inline(always)]
pub(super) fn value(c: &Cubic, u: f64) -> f64 {
    c[0] + u * (c[1] + u * (c[2] + u * c[3]))
}

pub(super) struct Shells {
    /// Squared radii of the boundaries, rising, one more than there are shells, m².
    pub edges2: Vec<f64>,
    /// 1 / (difference of the squared radii of a shell's boundaries), 1/m².
    inverse_width: Vec<f64>,
    /// Per shell, 1/m.
    extinction: Vec<Cubic>,
    /// Per shell and constituent that scatters, 1/m.
    scattering: Vec<Cubic>,
    /// Numbers, in the medium, of the constituents that scatter.
    pub scatterers: Vec<usize>,
}

impl Shells {
    pub(super) fn new(medium: &Medium, wavelength: usize) -> Self {
        let scatterers: Vec<usize> = (0..medium.constituents.len())
            .filter(|&i| medium.constituents[i].scattering[wavelength] > 0.0)
            .collect();
        let mut builder = Builder {
            medium,
            wavelength,
            depth: (medium.vertical_optical_depth()[wavelength] / MOST_BY_DEPTH).max(DEPTH),
            shells: Shells {
                edges2: vec![medium.ground_radius * medium.ground_radius],
                inverse_width: Vec::new(),
                extinction: Vec::new(),
                scattering: Vec::new(),
                scatterers,
            },
        };
        let height = medium.height();
        let mut edges = vec![0.0, height];
        for c in medium.constituents.iter().filter(|c| c.extinction(wavelength) > 0.0) {
            edges.extend(c.density.kinks().into_iter().filter(|&k| k > 0.0 && k < height));
        }
        edges.sort_by(f64::total_cmp);
        edges.dedup_by(|a, b| *a - *b < THINNEST * height);
        *edges.last_mut().expect("two edges at least") = height;
        for e in edges.windows(2) {
            builder.piece(e[0], e[1]);
        }
        builder.shells
    }

    pub(super) fn count(&self) -> usize {
        self.extinction.len()
    }

    pub(super) fn ground2(&self) -> f64 {
        self.edges2[0]
    }

    pub(super) fn top2(&self) -> f64 {
        self.edges2[self.count()]
    }

    /// The shell that holds a squared radius; the lowest or highest one outside the atmosphere.
    pub(super) fn find(&self, radius2: f64) -> usize {
        self.edges2.partition_point(|&e| e <= radius2).clamp(1, self.count()) - 1
    }

    /// Position across a shell, 0 … 1.
    #[inline(always)]
    pub(super) fn across(&self, shell: usize, radius2: f64) -> f64 {
        (radius2 - self.edges2[shell]) * self.inverse_width[shell]
    }

    /// Scattering coefficient of scatterer number `i`, 1/m.
    #[inline(always)]
    pub(super) fn scattering(&self, shell: usize, i: usize, u: f64) -> f64 {
        value(&self.scattering[shell * self.scatterers.len() + i], u).max(0.0)
    }

    /// Optical depth between x = `from` and x = `to` (0 ≤ from ≤ to), inside a shell, on a ray of squared
    /// distance `b2` from the centre: the cubic is moved to `from`, where u grows with y = x² − from², and
    /// the powers of y are integrated over x.
    #[inline(always)]
    pub(super) fn depth(&self, shell: usize, b2: f64, from: f64, to: f64) -> f64 {
        let c = &self.extinction[shell];
        let w = self.inverse_width[shell];
        let u = (from * from + b2 - self.edges2[shell]) * w;
        let (l, a) = (to - from, from);
        let c1 = (c[1] + u * (2.0 * c[2] + 3.0 * u * c[3])) * w;
        let c2 = (c[2] + 3.0 * u * c[3]) * w * w;
        let c3 = c[3] * w * w * w;
        let y1 = l * (a + l * (1.0 / 3.0));
        let y2 = l * l * (a * (a * (4.0 / 3.0) + l) + l * l * 0.2);
        let y3 = l * l * l * (a * (a * (2.0 * a + 2.4 * l) + l * l) + l * l * l * (1.0 / 7.0));
        l * (value(c, u) + c1 * y1 + c2 * y2 + c3 * y3)
    }

    /// Optical depth from a point (squared radius, its shell) to the top along a ray whose signed path from
    /// the point nearest the centre is `x` there; None where the ground is in the way.
    pub(super) fn depth_to_space(&self, radius2: f64, shell: usize, x: f64) -> Option<f64> {
        let b2 = (radius2 - x * x).max(0.0);
        let mut depth = 0.0;
        let mut k = shell;
        let mut from = x;
        if x < 0.0 {
            if b2 < self.ground2() {
                return None;
            }
            let mut high = -x;
            while self.edges2[k] > b2 {
                let low = (self.edges2[k] - b2).sqrt();
                if low < high {
                    depth += self.depth(k, b2, low, high);
                    high = low;
                }
                if k == 0 {
                    break;
                }
                k -= 1;
            }
            depth += self.depth(k, b2, 0.0, high);
            from = 0.0;
        }
        for k in k..self.count() {
            let to = (self.edges2[k + 1] - b2).max(0.0).sqrt();
            if to > from {
                depth += self.depth(k, b2, from, to);
                from = to;
            }
        }
        Some(depth.max(0.0))
    }
}

struct Builder<'a> {
    medium: &'a Medium,
    wavelength: usize,
    depth: f64,
    shells: Shells,
}

impl Builder<'_> {
    /// Adds the shells between two altitudes where the profiles are smooth.
    fn piece(&mut self, bottom: f64, top: f64) {
        let height = self.medium.height();
        let too_thick = (top - bottom) * LEAST > height * (1.0 + 1e-9);
        if !too_thick && self.add_shell(bottom, top, (top - bottom) < THINNEST * height) {
            return;
        }
        let middle = 0.5 * (bottom + top);
        self.piece(bottom, middle);
        self.piece(middle, top);
    }

    fn extinction(&self, altitude: f64) -> f64 {
        let w = self.wavelength;
        self.medium.constituents.iter().map(|c| c.extinction(w) * at(c, altitude, c.extinction(w))).sum()
    }

    /// Adds one shell if it is fine enough (or must be).
    fn add_shell(&mut self, bottom: f64, top: f64, whatever: bool) -> bool {
        let ground = self.medium.ground_radius;
        let low2 = (ground + bottom) * (ground + bottom);
        let width2 = (top - bottom) * (2.0 * ground + top + bottom);
        let altitude = |u: f64| {
            let rise = bottom * (2.0 * ground + bottom) + u * width2; // r² − ground²
            rise / ((ground * ground + rise).sqrt() + ground)
        };
        let w = self.wavelength;
        let total = |z: f64| self.extinction(z);
        let extinction = cubic(|u| total(altitude(u)));
        let mut species = Vec::new();
        let mut good = fits(&extinction, |u| total(altitude(u)), |u| total(altitude(u)));
        good &= value(&extinction, 0.5) * (top - bottom) <= self.depth;
        for &i in &self.shells.scatterers {
            let c = &self.medium.constituents[i];
            let exact = |u: f64| c.scattering[w] * c.density.at(altitude(u));
            let fit = cubic(exact);
            good &= fits(&fit, exact, |u| total(altitude(u)));
            species.push(fit);
        }
        if good || whatever {
            self.shells.edges2.push(low2 + width2);
            self.shells.inverse_width.push(1.0 / width2);
            self.shells.extinction.push(extinction);
            self.shells.scattering.extend(species);
        }
        good || whatever
    }
}

/// Density, not asked where it does not matter.
fn at(c: &crate::medium::Constituent, altitude: f64, coefficient: f64) -> f64 {
    if coefficient > 0.0 { c.density.at(altitude) } else { 0.0 }
}

/// The cubic through the four Chebyshev points of 0 … 1, which keep away from the ends, where densities jump.
fn cubic(f: impl Fn(f64) -> f64) -> Cubic {
    let (s, l) = (0.5 * 0.382_683_432_365_089_8, 0.5 * 0.923_879_532_511_286_7); // ½ sin π/8, ½ cos π/8
    let u = [0.5 - l, 0.5 - s, 0.5 + s, 0.5 + l];
    let mut d = u.map(&f);
    for order in 1..4 {
        for k in (order..4).rev() {
            d[k] = (d[k] - d[k - 1]) / (u[k] - u[k - order]);
        }
    }
    let mut c = [d[3], 0.0, 0.0, 0.0];
    for k in (0..3).rev() {
        // c ← c · (u − u_k) + d_k
        for j in (1..4).rev() {
            c[j] = c[j - 1] - u[k] * c[j];
        }
        c[0] = d[k] - u[k] * c[0];
    }
    c
}

fn fits(c: &Cubic, exact: impl Fn(f64) -> f64, scale: impl Fn(f64) -> f64) -> bool {
    // Extremes of the interpolation error lie near these places between the Chebyshev points.
    [1e-6, 0.146, 0.5, 0.854, 1.0 - 1e-6]
        .into_iter()
        .all(|u| (value(c, u) - exact(u)).abs() <= TOLERANCE * scale(u) + f64::MIN_POSITIVE)
}
