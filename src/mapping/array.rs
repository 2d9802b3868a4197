//! A dense array of any number of axes, filled in parallel and read with multilinear interpolation.

use crate::machine::lanes::{Lanes, WIDTH};
use rayon::prelude::*;

/// A place between two neighbouring texels of one axis: index of the lower one and the fraction of the way
/// (0..1) to the next.
pub type Texel = (usize, f64);

/// Place of a coordinate 0..1 (clamped) on an axis whose first and last texel centres are at 0 and 1.
/// The index is at most size − 2, so that its neighbour exists; on an axis of one texel it is (0, 0).
#[inline(always)]
pub fn texel(coordinate: f64, size: usize) -> Texel {
    if size < 2 {
        return (0, 0.0);
    }
    let position = coordinate.clamp(0.0, 1.0) * (size - 1) as f64;
    let index = (position as usize).min(size - 2);
    (index, position - index as f64)
}

/// What an array can hold: anything with a weighted sum.
pub trait Element: Copy + Send + Sync {
    const ZERO: Self;
    /// self ← self + weight · value
    fn add_scaled(&mut self, value: &Self, weight: f64);
}

impl Element for f64 {
    const ZERO: Self = 0.0;
    #[inline(always)]
    fn add_scaled(&mut self, value: &Self, weight: f64) {
        *self += value * weight;
    }
}

impl Element for f32 {
    const ZERO: Self = 0.0;
    #[inline(always)]
    fn add_scaled(&mut self, value: &Self, weight: f64) {
        *self += value * weight as f32;
    }
}

impl Element for Lanes {
    const ZERO: Self = Lanes::ZERO;
    #[inline(always)]
    fn add_scaled(&mut self, value: &Self, weight: f64) {
        let weight = weight as f32;
        for i in 0..WIDTH {
            self.0[i] += value.0[i] * weight;
        }
    }
}

impl<T: Element, const N: usize> Element for [T; N] {
    const ZERO: Self = [T::ZERO; N];
    #[inline(always)]
    fn add_scaled(&mut self, value: &Self, weight: f64) {
        for (s, v) in self.iter_mut().zip(value) {
            s.add_scaled(v, weight);
        }
    }
}

/// An array of `D` axes, the last one contiguous in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Array<T, const D: usize> {
    shape: [usize; D],
    values: Vec<T>,
}

impl<T: Element, const D: usize> Array<T, D> {
    /// All zero.
    pub fn zero(shape: [usize; D]) -> Self {
        Array { shape, values: vec![T::ZERO; shape.iter().product()] }
    }

    /// Every value from its index; the first axis is shared out over threads.
    pub fn fill(shape: [usize; D], value: impl Fn([usize; D]) -> T + Sync) -> Self {
        let mut array = Self::zero(shape);
        array.for_each_slab(|first, slab| {
            for (k, v) in slab.iter_mut().enumerate() {
                let mut index = unravel(shape, k);
                index[0] = first;
                *v = value(index);
            }
        });
        array
    }

    /// Hands each slab (all values of one index of the first axis, and that index) to `work`, in parallel.
    pub fn for_each_slab(&mut self, work: impl Fn(usize, &mut [T]) + Sync) {
        let slab = self.values.len() / self.shape[0].max(1);
        self.values.par_chunks_mut(slab.max(1)).enumerate().for_each(|(first, values)| work(first, values));
    }

    pub fn shape(&self) -> [usize; D] {
        self.shape
    }

    /// All values, last axis fastest.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// Position of an index in [`Array::values`].
    #[inline(always)]
    pub fn offset(&self, index: [usize; D]) -> usize {
        index.iter().zip(&self.shape).fold(0, |offset, (i, n)| offset * n + i)
    }

    #[inline(always)]
    pub fn get(&self, index: [usize; D]) -> &T {
        &self.values[self.offset(index)]
    }

    /// Multilinear interpolation between the 2^D texels around a place, D ≤ 4. Neighbours of weight 0 are not
    /// read, so a texel centre answers its own value to the bit.
    #[inline(always)]
    pub fn interpolate(&self, place: &[Texel; D]) -> T {
        const { assert!(D <= 4) }
        // As many axes as there can be; those that are not there have one texel.
        let (mut sides, mut base, mut stride) = ([[(0, 1.0), (0, 0.0)]; 4], 0, 1);
        for axis in (0..D).rev() {
            let (index, fraction) = place[axis];
            base += index * stride;
            sides[axis] = [(0, 1.0 - fraction), (stride, fraction)];
            stride *= self.shape[axis];
        }
        let mut sum = T::ZERO;
        for (offset_0, weight_0) in sides[0] {
            for (offset_1, weight_1) in sides[1] {
                let (offset, weight) = (base + offset_0 + offset_1, weight_0 * weight_1);
                if weight == 0.0 {
                    continue;
                }
                for (offset_2, weight_2) in sides[2] {
                    for (offset_3, weight_3) in sides[3] {
                        let weight = weight * (weight_2 * weight_3);
                        if weight != 0.0 {
                            sum.add_scaled(&self.values[offset + offset_2 + offset_3], weight);
                        }
                    }
                }
            }
        }
        sum
    }
}

/// Index of the k-th value of a slab, its first component left 0.
fn unravel<const D: usize>(shape: [usize; D], mut k: usize) -> [usize; D] {
    let mut index = [0; D];
    for axis in (1..D).rev() {
        index[axis] = k % shape[axis];
        k /= shape[axis];
    }
    index
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Multilinear interpolation is exact for a function linear in each index.
    #[test]
    fn a_multilinear_function_is_interpolated_exactly() {
        let f = |a: f64, b: f64, c: f64| 2.0 + a - 3.0 * b * c + 0.5 * a * b * c;
        let array = Array::fill([4, 3, 5], |[i, j, k]| f(i as f64, j as f64, k as f64));
        for place in [[(0, 0.0), (1, 1.0), (3, 0.25)], [(2, 1.0), (0, 0.5), (1, 0.75)]] {
            let x = place.map(|(i, fraction): Texel| i as f64 + fraction);
            assert!((array.interpolate(&place) - f(x[0], x[1], x[2])).abs() < 1e-12);
        }
    }

    /// The last axis is contiguous, and `fill`, `get` and `values` agree on that.
    #[test]
    fn order_in_memory() {
        let array = Array::fill([2, 3, 4], |[i, j, k]| (100 * i + 10 * j + k) as f32);
        assert_eq!(array.values()[0..5], [0.0, 1.0, 2.0, 3.0, 10.0]);
        assert_eq!(array.values()[12], 100.0);
        assert_eq!(*array.get([1, 2, 3]), 123.0);
    }

    /// A neighbour of weight 0 must not leak: 0 · NaN would be NaN, and on the last texel or on an axis of one
    /// texel there is no neighbour at all.
    #[test]
    fn texel_centres_answer_their_own_value() {
        let mut array: Array<[f32; 2], 2> = Array::fill([1, 3], |[_, j]| [j as f32, 7.0]);
        array.values_mut()[1] = [f32::NAN; 2];
        assert_eq!(array.interpolate(&[texel(0.3, 1), texel(0.0, 3)]), [0.0, 7.0]);
        assert_eq!(array.interpolate(&[texel(0.3, 1), texel(1.0, 3)]), [2.0, 7.0]);
    }

    /// Coordinates 0 and 1 are texel centres; what lies outside is held at the ends.
    #[test]
    fn ends_are_texel_centres() {
        assert_eq!(texel(0.0, 5), (0, 0.0));
        assert_eq!(texel(1.0, 5), (3, 1.0));
        assert_eq!(texel(0.375, 5), (1, 0.5));
        assert_eq!(texel(-3.0, 5), (0, 0.0));
        assert_eq!(texel(9.0, 5), (3, 1.0));
    }
}
