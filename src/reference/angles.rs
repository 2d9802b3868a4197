//! Sampling of directions: scattering angles after a phase function, the cosine law, and frames.

use crate::medium::PhaseFunction;
use glam::DVec3;
use std::f64::consts::PI;

/// Largest error of the sampled density, relative to the phase function.
const TOLERANCE: f64 = 2e-5;
/// Cut points of the search.
const CUTS: usize = 1024;

/// Draws the cosine of the scattering angle with the phase function's density: linear between nodes that
/// are as close as the tolerance needs, by inversion of its integral.
pub(super) struct ScatteringAngle {
    /// (cosine, probability up to it, density 2π p), rising.
    nodes: Vec<(f64, f64, f64)>,
    /// For each of `CUTS` equal parts of 0 … 1: the first piece that reaches into it.
    cuts: Vec<u32>,
}

impl ScatteringAngle {
    pub(super) fn new(phase: &PhaseFunction) -> Self {
        let mut cosines = vec![-1.0];
        let breaks = match phase {
            PhaseFunction::Tabulated { nodes } => nodes.iter().map(|n| n.0).collect(),
            _ => (0..=16).map(|k| -1.0 + f64::from(k) / 8.0).collect::<Vec<f64>>(),
        };
        for b in breaks.windows(2) {
            refine(phase, b[0], b[1], &mut cosines);
        }
        let mut nodes: Vec<(f64, f64, f64)> =
            cosines.into_iter().map(|nu| (nu, 0.0, 2.0 * PI * phase.value(nu))).collect();
        for k in 1..nodes.len() {
            let (a, b) = (nodes[k - 1], nodes[k]);
            nodes[k].1 = a.1 + 0.5 * (b.0 - a.0) * (a.2 + b.2);
        }
        let total = nodes[nodes.len() - 1].1;
        for n in &mut nodes {
            n.1 /= total;
            n.2 /= total;
        }
        let cuts = (0..CUTS)
            .map(|k| {
                let u = k as f64 / CUTS as f64;
                nodes.partition_point(|n| n.1 <= u).clamp(1, nodes.len() - 1) as u32 - 1
            })
            .collect();
        ScatteringAngle { nodes, cuts }
    }

    /// The cosine at which the probability below it is `u`.
    pub(super) fn sample(&self, u: f64) -> f64 {
        let mut k = self.cuts[((u * CUTS as f64) as usize).min(CUTS - 1)] as usize;
        while k + 2 < self.nodes.len() && self.nodes[k + 1].1 <= u {
            k += 1;
        }
        let (a, b) = (self.nodes[k], self.nodes[k + 1]);
        let slope = (b.2 - a.2) / (b.0 - a.0);
        // ½ slope t² + a.2 t = rest, in the form that does not cancel.
        let rest = (u - a.1).max(0.0);
        let root = (a.2 * a.2 + 2.0 * slope * rest).max(0.0).sqrt();
        let t = if rest > 0.0 { 2.0 * rest / (a.2 + root) } else { 0.0 };
        (a.0 + t).min(b.0)
    }
}

fn refine(phase: &PhaseFunction, a: f64, b: f64, cosines: &mut Vec<f64>) {
    let (pa, pb) = (phase.value(a), phase.value(b));
    let good = [0.25, 0.5, 0.75].into_iter().all(|t| {
        let exact = phase.value(a + t * (b - a));
        (pa + t * (pb - pa) - exact).abs() <= TOLERANCE * exact
    });
    if good || b - a < 1e-9 {
        cosines.push(b);
    } else {
        let middle = 0.5 * (a + b);
        refine(phase, a, middle, cosines);
        refine(phase, middle, b, cosines);
    }
}

/// The direction at a cosine from an axis, turned by 2π `turn` around it.
#[inline]
pub(super) fn around(axis: DVec3, cosine: f64, turn: f64) -> DVec3 {
    // Frame of Duff et al. 2017 (JCGT 6(1)), which has no branch to lose digits at.
    let sign = 1.0_f64.copysign(axis.z);
    let a = -1.0 / (sign + axis.z);
    let b = axis.x * axis.y * a;
    let e = DVec3::new(1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x);
    let f = DVec3::new(b, sign + axis.y * axis.y * a, -axis.y);
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let (s, c) = libm::sincos(2.0 * PI * turn);
    (axis * cosine + e * (sine * c) + f * (sine * s)).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Angles at even steps of probability have the moments that the phase function has, so the sampled
    /// density is the phase function; of a table with kinks and of a sharp peak too.
    #[test]
    fn sampled_angles_have_the_moments_of_the_phase_function() {
        const N: usize = 200_000;
        for phase in [
            PhaseFunction::Isotropic,
            PhaseFunction::Rayleigh { king_factor: 1.06 },
            PhaseFunction::HenyeyGreenstein { g: -0.4 },
            PhaseFunction::HenyeyGreenstein { g: 0.99 },
            PhaseFunction::CornetteShanks { g: 0.76 },
            PhaseFunction::DoubleHenyeyGreenstein { g1: 0.9, g2: -0.3, weight: 0.8 },
            PhaseFunction::tabulated(vec![(-1.0, 0.5), (0.2, 1.0), (0.9, 1.0), (1.0, 40.0)]),
        ] {
            let sampler = ScatteringAngle::new(&phase);
            let (mut first, mut second) = (0.0, 0.0);
            for k in 0..N {
                let nu = sampler.sample((k as f64 + 0.5) / N as f64);
                assert!((-1.0..=1.0).contains(&nu));
                first += nu / N as f64;
                second += 0.5 * (3.0 * nu * nu - 1.0) / N as f64;
            }
            let chi = phase.legendre(2);
            assert!((first - chi[1]).abs() < 2e-5, "{phase:?}: {first} {}", chi[1]);
            assert!((second - chi[2]).abs() < 2e-5, "{phase:?}: {second} {}", chi[2]);
        }
    }

    /// Turned around any axis, a direction keeps its cosine to it; also around the poles of the frame.
    #[test]
    fn directions_keep_their_angle_to_the_axis() {
        for axis in [DVec3::Z, -DVec3::Z, DVec3::X, DVec3::new(0.3, -0.7, 0.2).normalize()] {
            for k in 0..64 {
                let (cosine, turn) = (k as f64 / 32.0 - 1.0, (0.37 * k as f64).fract());
                let d = around(axis, cosine, turn);
                assert!((d.dot(axis) - cosine).abs() < 1e-12 && (d.length() - 1.0).abs() < 1e-12);
            }
        }
    }
}
