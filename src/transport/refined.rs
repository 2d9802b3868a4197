//! A sun axis with more nodes than fields are stored on.

use super::azimuth::SunAxis;
use super::kernels::Field;
use crate::machine::lanes::Lanes;

/// Refined fields of so few terms stay in the processor's caches.
const FEW_TERMS: usize = 8;

/// Cubic interpolation from the nodes of a sun axis to finer ones, between which a straight line will do:
/// twilight fades by a factor e per degree, too fast for straight lines between the nodes themselves.
pub struct RefinedAxis {
    pub fine: SunAxis,
    /// Intervals for each of the coarse axis.
    factor: usize,
    /// True where whole fields are refined once, false where it is done at every look.
    pub beforehand: bool,
    /// Per place inside an interval, the weights in the first interval, in those inside, and in the last one;
    /// each with the number of nodes before the interval that it begins with.
    weights: Vec<[(usize, Vec<f32>); 3]>,
}

impl RefinedAxis {
    /// `factor` intervals for each of the axis, for fields of at most `terms` terms.
    pub fn new(axis: &SunAxis, factor: usize, terms: usize) -> Self {
        let reach = usize::from(axis.len() > 2);
        let inside = reach * usize::from(axis.len() > 3);
        let weights = (1..factor)
            .map(|k| {
                let x = k as f64 / factor as f64;
                let row = |before: usize, after: usize| (before, lagrange(before, 1 + after, x));
                [row(0, reach), row(inside, inside), row(reach, 0)]
            })
            .collect();
        RefinedAxis { fine: axis.refined(factor), factor, beforehand: terms <= FEW_TERMS, weights }
    }

    /// A field ready to be looked at.
    pub fn prepare(&self, field: Field) -> Field {
        if !self.beforehand {
            return field;
        }
        let fine = self.fine.len();
        let mut values = vec![Lanes::ZERO; field.values.len() / field.suns * fine];
        for (row, out) in field.values.chunks_exact(field.suns).zip(values.chunks_exact_mut(fine)) {
            self.refine(row, 1, out);
        }
        Field { terms: field.terms, suns: fine, values }
    }

    /// Values at all fine nodes from those at the coarse ones; `stride` values a node.
    #[inline(always)]
    pub fn refine(&self, coarse: &[Lanes], stride: usize, out: &mut [Lanes]) {
        let intervals = coarse.len() / stride - 1;
        for i in 0..intervals {
            let out = &mut out[i * self.factor * stride..][..self.factor * stride];
            out[..stride].copy_from_slice(&coarse[i * stride..][..stride]);
            for ([first, inside, last], out) in
                self.weights.iter().zip(out[stride..].chunks_exact_mut(stride))
            {
                let (before, weights) = match i {
                    0 => first,
                    _ if i + 1 < intervals => inside,
                    _ => last,
                };
                let nodes = &coarse[(i - before) * stride..];
                match weights.as_slice() {
                    [a, b, c, d] => {
                        for (m, out) in out.iter_mut().enumerate() {
                            let (two, more) = (nodes[m] * *a + nodes[stride + m] * *b, 2 * stride + m);
                            *out = two + nodes[more] * *c + nodes[more + stride] * *d;
                        }
                    }
                    weights => {
                        for (m, out) in out.iter_mut().enumerate() {
                            let nodes = nodes[m..].iter().step_by(stride);
                            *out = nodes.zip(weights).fold(Lanes::ZERO, |sum, (v, w)| sum + *v * *w);
                        }
                    }
                }
            }
        }
        out[intervals * self.factor * stride..].copy_from_slice(&coarse[intervals * stride..]);
    }
}

/// Weights at place `x` of an interval of the polynomial through even nodes, from `before` ones before the
/// interval's first to `after` ones after it.
pub(super) fn lagrange(before: usize, after: usize, x: f64) -> Vec<f32> {
    let nodes = || (0..=before + after).map(|j| j as f64 - before as f64);
    nodes().map(|k| nodes().filter(|j| *j != k).fold(1.0, |w, j| w * (x - j) / (k - j)) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A parabola over the node number is met at every fine node, at the ends too: cubics hold it.
    #[test]
    fn parabolas_are_kept() {
        for suns in [3, 4, 5, 9] {
            let axis = SunAxis::new(suns, -0.3);
            let refined = RefinedAxis::new(&axis, 3, 1);
            let value = |x: f32| 1.0 + 0.5 * x - 0.25 * x * x;
            let row: Vec<Lanes> = (0..suns).map(|k| Lanes::splat(value(k as f32))).collect();
            let mut out = vec![Lanes::ZERO; refined.fine.len() * 2];
            refined.refine(&row.iter().flat_map(|v| [*v, Lanes::ZERO]).collect::<Vec<_>>(), 2, &mut out);
            for k in 0..refined.fine.len() {
                let expected = value(k as f32 / 3.0);
                assert!((out[2 * k][5] - expected).abs() < 2e-5, "{suns} nodes, {k}: {}", out[2 * k][5]);
            }
        }
    }

    /// On two nodes the values lie on the straight line between.
    #[test]
    fn a_line_joins_two_nodes() {
        let refined = RefinedAxis::new(&SunAxis::new(2, -0.3), 4, 1);
        let mut out = vec![Lanes::ZERO; 5];
        refined.refine(&[Lanes::splat(1.0), Lanes::splat(3.0)], 1, &mut out);
        let values: Vec<f32> = out.iter().map(|v| v[0]).collect();
        assert_eq!(values, [1.0, 1.5, 2.0, 2.5, 3.0]);
    }
}
