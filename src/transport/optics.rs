//! A medium's coefficients at the wavelengths of one batch, in single precision side by side.

use super::column::Shells;
use super::forward::{ForwardPeak, unscattered};
use crate::machine::lanes::{Lanes, WIDTH};
use crate::medium::{Medium, PhaseFunction};
use std::f64::consts::PI;

/// Coefficients of up to sixteen wavelengths.
#[derive(Clone, Debug)]
pub struct Optics {
    /// Wavelengths in use; the lanes past them are empty space over black ground.
    pub count: usize,
    /// Per constituent, where the density is 1, 1/m. `extinction` is without the share of forward peaks that
    /// counts as unscattered (see [`super::forward`]), `full_extinction` with it.
    pub extinction: Vec<Lanes>,
    pub full_extinction: Vec<Lanes>,
    pub scattering: Vec<Lanes>,
    pub albedo: Lanes,
    /// Phase function of each constituent.
    pub phase: Vec<PhaseLanes>,
    /// The same without what quadratures over directions cannot see, see [`Optics::new`].
    pub smooth_phase: Vec<PhaseLanes>,
    /// What the field misses of each constituent's forward peak.
    pub peaks: Vec<Option<ForwardPeak>>,
    /// `[constituent][degree]`: Legendre coefficients, less the share that counts as unscattered.
    pub legendre: Vec<Vec<Lanes>>,
}

impl Optics {
    /// Coefficients of a medium of at most sixteen wavelengths; Legendre coefficients up to `degree`, and phase
    /// functions cut off beyond degree `visible`: between the directions of a quadrature a narrower peak would be
    /// missed or counted twice, while its moments up to `degree` are those of the series. `orders`: how many of
    /// them are summed, none for all.
    pub fn new(medium: &Medium, degree: usize, visible: usize, orders: Option<usize>) -> Self {
        let count = medium.wavelengths_nm.len();
        assert!(count <= WIDTH, "a batch holds at most {WIDTH} wavelengths");
        let per = |f: &dyn Fn(&crate::medium::Constituent, usize) -> f64| -> Vec<Lanes> {
            let lanes = |c| Lanes::from_f64(&(0..count).map(|w| f(c, w)).collect::<Vec<_>>());
            medium.constituents.iter().map(lanes).collect()
        };
        let passed: Vec<Vec<f64>> =
            medium.constituents.iter().map(|c| unscattered(&c.phase, degree, orders)).collect();
        let legendre = (medium.constituents.iter().zip(&passed))
            .map(|(c, passed)| {
                let chi: Vec<Vec<f64>> = c.phase.iter().map(|p| p.legendre(degree)).collect();
                let at = |l: usize| chi.iter().zip(passed).map(|(chi, f)| chi[l] - f).collect::<Vec<_>>();
                (0..=degree).map(|l| Lanes::from_f64(&at(l))).collect()
            })
            .collect();
        let less = |(c, f): (&crate::medium::Constituent, &Vec<f64>)| {
            Lanes::from_f64(&(0..count).map(|w| c.extinction(w) - f[w] * c.scattering[w]).collect::<Vec<_>>())
        };
        Optics {
            count,
            extinction: medium.constituents.iter().zip(&passed).map(less).collect(),
            full_extinction: per(&|c, w| c.extinction(w)),
            scattering: per(&|c, w| c.scattering[w]),
            albedo: Lanes::from_f64(&medium.ground_albedo),
            phase: medium.constituents.iter().map(|c| PhaseLanes::new(&c.phase)).collect(),
            smooth_phase: (medium.constituents.iter().zip(&passed))
                .map(|(c, passed)| PhaseLanes::cut_off(&c.phase, passed, degree, visible))
                .collect(),
            peaks: medium.constituents.iter().map(|c| ForwardPeak::new(&c.phase, degree, orders)).collect(),
            legendre,
        }
    }

    /// Scattering of a constituent as a share of all extinction at each radius (0 in a vacuum).
    pub fn shares(&self, shells: &Shells, radii: &[f64], constituent: usize) -> Vec<Lanes> {
        radii
            .iter()
            .map(|&r| {
                let shell = shells.find(r);
                let density: Vec<f32> =
                    (0..shells.constituents).map(|c| shells.density(shell, c, r) as f32).collect();
                let mut total = Lanes::ZERO;
                for (d, e) in density.iter().zip(&self.extinction) {
                    total += *e * *d;
                }
                let mut share = self.scattering[constituent] * density[constituent];
                for w in 0..WIDTH {
                    share[w] = if total[w] > 0.0 { share[w] / total[w] } else { 0.0 };
                }
                share
            })
            .collect()
    }

    /// Scattering coefficients of a group, at density 1 of each, 0 for the constituents outside it.
    pub fn group_scattering(&self, group: &[usize]) -> Vec<Lanes> {
        (0..self.scattering.len())
            .map(|c| if group.contains(&c) { self.scattering[c] } else { Lanes::ZERO })
            .collect()
    }
}

/// A phase function at several wavelengths at once.
#[derive(Clone, Debug)]
pub enum PhaseLanes {
    /// a + b ν²: isotropic and Rayleigh.
    Quadratic { a: Lanes, b: Lanes },
    /// norm (1 + bend ν²) / (1 + g² − 2gν)^{3/2}: Henyey–Greenstein (bend 0) and Cornette–Shanks (bend 1).
    Peaked { norm: Lanes, bend: Lanes, square: Lanes, twice: Lanes },
    /// Even nodes over √((1 − ν)/2), linear between.
    Table(Vec<Lanes>),
    /// Anything else, evaluated one by one.
    Other(Vec<PhaseFunction>),
}

/// Nodes of a tabulated phase function, cut off at degree 19 or less: more than a hundred for each of its waves.
const TABLE_NODES: usize = 1024;

impl PhaseLanes {
    pub fn new(phase: &[PhaseFunction]) -> Self {
        let gather = |f: &dyn Fn(&PhaseFunction) -> Option<[f64; 4]>| -> Option<[Lanes; 4]> {
            let rows: Option<Vec<[f64; 4]>> = phase.iter().map(f).collect();
            let rows = rows?;
            Some([0, 1, 2, 3].map(|k| Lanes::from_f64(&rows.iter().map(|r| r[k]).collect::<Vec<_>>())))
        };
        if let Some([a, b, ..]) = gather(&quadratic) {
            return PhaseLanes::Quadratic { a, b };
        }
        if let Some([norm, bend, square, twice]) = gather(&peaked) {
            // Lanes past the last wavelength must not divide by zero.
            let square = square.map(|v| if v == 0.0 { 1.0 } else { v });
            return PhaseLanes::Peaked { norm, bend, square, twice };
        }
        PhaseLanes::Other(phase.to_vec())
    }

    /// The Legendre series of phase functions up to degree `visible`, or up to `degree` where a share of them,
    /// `passed`, counts as unscattered and is left out; the functions themselves where they end before.
    fn cut_off(phase: &[PhaseFunction], passed: &[f64], degree: usize, visible: usize) -> Self {
        let mut chi: Vec<Vec<f64>> = phase.iter().map(|p| p.legendre(visible + 1)).collect();
        if chi.iter().all(|chi| chi[3..].iter().all(|c| c.abs() < 1e-9)) {
            return PhaseLanes::new(phase);
        }
        for (chi, &f) in chi.iter_mut().zip(passed).filter(|(_, f)| **f > 0.0) {
            chi.truncate(degree + 1);
            chi.iter_mut().for_each(|c| *c -= f);
        }
        let value = |k: usize| {
            let x = k as f64 / (TABLE_NODES - 1) as f64;
            let nu = 1.0 - 2.0 * x * x;
            Lanes::from_f64(
                &chi.iter().map(|chi| series(&chi[..chi.len().min(visible + 1)], nu)).collect::<Vec<_>>(),
            )
        };
        PhaseLanes::Table((0..TABLE_NODES).map(value).collect())
    }

    /// Values at the cosine of a scattering angle, 1/sr.
    #[inline(always)]
    pub fn value(&self, nu: f32) -> Lanes {
        match self {
            PhaseLanes::Quadratic { a, b } => *a + *b * (nu * nu),
            PhaseLanes::Peaked { norm, bend, square, twice } => {
                let mut out = Lanes::ZERO;
                for w in 0..WIDTH {
                    let d = square[w] - twice[w] * nu;
                    out[w] = norm[w] * (1.0 + bend[w] * nu * nu) / (d * d.sqrt());
                }
                out
            }
            PhaseLanes::Table(nodes) => {
                let half = 0.5 * (1.0 - nu);
                let x = (if half > 0.0 { half } else { 0.0 }).sqrt() * (TABLE_NODES - 1) as f32;
                let (node, t) = super::azimuth::node_and_place(x, TABLE_NODES);
                let two = &nodes[node as usize..][..2];
                two[0] * (1.0 - t) + two[1] * t
            }
            PhaseLanes::Other(phase) => {
                let mut out = Lanes::ZERO;
                for (o, p) in out.0.iter_mut().zip(phase) {
                    *o = p.value(f64::from(nu)) as f32;
                }
                out
            }
        }
    }
}

/// Σ (2l+1)/4π χ_l P_l(ν)
fn series(chi: &[f64], nu: f64) -> f64 {
    let (mut before, mut now, mut sum) = (0.0, 1.0, 0.0);
    for (l, c) in chi.iter().enumerate() {
        let l = l as f64;
        sum += (2.0 * l + 1.0) / (4.0 * PI) * c * now;
        (before, now) = (now, ((2.0 * l + 1.0) * nu * now - l * before) / (l + 1.0));
    }
    sum
}

fn quadratic(p: &PhaseFunction) -> Option<[f64; 4]> {
    match p {
        PhaseFunction::Isotropic | PhaseFunction::Rayleigh { .. } => {
            Some([p.value(0.0), p.value(1.0) - p.value(0.0), 0.0, 0.0])
        }
        _ => None,
    }
}

fn peaked(p: &PhaseFunction) -> Option<[f64; 4]> {
    let (g, bend, norm) = match p {
        PhaseFunction::HenyeyGreenstein { g } => (*g, 0.0, 1.0),
        PhaseFunction::CornetteShanks { g } => (*g, 1.0, 1.5 / (2.0 + g * g)),
        _ => return None,
    };
    Some([norm * (1.0 - g * g) / (4.0 * PI), bend, 1.0 + g * g, 2.0 * g])
}
