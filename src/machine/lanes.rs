//! Sixteen wavelengths side by side: the f32 vector that the hot loops work on.
//!
//! Plain arrays, which the compiler turns into SSE, AVX2 or AVX-512 code with the same bits (see [`super::isa`]).

use std::ops::{Add, AddAssign, Index, IndexMut, Mul, Sub};

/// Wavelengths in one [`Lanes`].
pub const WIDTH: usize = 16;

/// One f32 for each of up to sixteen wavelengths.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes(pub [f32; WIDTH]);

impl Lanes {
    pub const ZERO: Lanes = Lanes([0.0; WIDTH]);

    #[inline(always)]
    pub fn splat(v: f32) -> Self {
        Lanes([v; WIDTH])
    }

    /// The first values of a slice, rounded to f32; lanes past its end are 0.
    pub fn from_f64(values: &[f64]) -> Self {
        let mut lanes = Lanes::ZERO;
        for (l, v) in lanes.0.iter_mut().zip(values) {
            *l = *v as f32;
        }
        lanes
    }

    #[inline(always)]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        let mut out = self;
        for v in &mut out.0 {
            *v = f(*v);
        }
        out
    }

    /// e^x lane by lane, see [`exp`].
    #[inline(always)]
    pub fn exp(self) -> Self {
        self.map(exp)
    }
}

/// e^x to 3e-7 relative, 0 below −87 and capped at e^88. Range reduction to |r| ≤ ½ ln 2 with
/// ln 2 in two parts, then the Taylor polynomial of degree 6 (its remainder there is 1.2e-7 · ½ relative).
#[inline(always)]
pub fn exp(x: f32) -> f32 {
    const ROUND: f32 = 12_582_912.0; // 1.5 · 2^23: adding and subtracting it rounds to an integer
    let clamped = if x > 88.0 { 88.0 } else { x };
    let clamped = if clamped < -87.0 { -87.0 } else { clamped };
    let shifted = clamped * std::f32::consts::LOG2_E + ROUND;
    let n = shifted - ROUND;
    let r = clamped - n * 0.693_359_4;
    let r = r - n * -2.121_944_4e-4;
    let p = 1.0 / 720.0;
    let p = p * r + 1.0 / 120.0;
    let p = p * r + 1.0 / 24.0;
    let p = p * r + 1.0 / 6.0;
    let p = p * r + 0.5;
    let p = p * r + 1.0;
    let p = p * r + 1.0;
    // The integer stands in the low bits of `shifted`; a conversion would saturate, and not vectorise.
    let scale = f32::from_bits((shifted.to_bits() << 23).wrapping_add(127 << 23));
    if x < -87.0 { 0.0 } else { p * scale }
}

impl Default for Lanes {
    fn default() -> Self {
        Lanes::ZERO
    }
}

impl Index<usize> for Lanes {
    type Output = f32;
    #[inline(always)]
    fn index(&self, i: usize) -> &f32 {
        &self.0[i]
    }
}

impl IndexMut<usize> for Lanes {
    #[inline(always)]
    fn index_mut(&mut self, i: usize) -> &mut f32 {
        &mut self.0[i]
    }
}

macro_rules! lane_by_lane {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for Lanes {
            type Output = Lanes;
            #[inline(always)]
            fn $method(self, other: Lanes) -> Lanes {
                let mut out = self;
                for i in 0..WIDTH {
                    out.0[i] = self.0[i] $op other.0[i];
                }
                out
            }
        }
    };
}
lane_by_lane!(Add, add, +);
lane_by_lane!(Sub, sub, -);
lane_by_lane!(Mul, mul, *);

impl Mul<f32> for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn mul(self, factor: f32) -> Lanes {
        self.map(|v| v * factor)
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Lanes) {
        for i in 0..WIDTH {
            self.0[i] += other.0[i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the double-precision exponential of libm, over the whole range that does not underflow.
    #[test]
    fn exp_is_exact_to_single_precision() {
        for k in 0..200_000 {
            let x = -86.9 + 174.0 * k as f32 / 200_000.0;
            let exact = libm::exp(f64::from(x));
            let error = (f64::from(exp(x)) / exact - 1.0).abs();
            assert!(error < 3e-7, "exp({x}): {error:e}");
        }
        assert_eq!(exp(0.0), 1.0);
        assert_eq!(exp(-100.0), 0.0);
        assert!(exp(1000.0).is_finite());
    }

    /// Same bits over instruction sets, which the reproducibility of every table rests on.
    #[test]
    fn instruction_sets_agree_to_the_bit() {
        use crate::machine::isa;
        use crate::machine::isa::Isa;
        let work = |scale: f32| {
            let mut sum = Lanes::ZERO;
            for k in 0..1000 {
                let x = Lanes::splat(-0.01 * k as f32) * scale;
                sum += x.exp() * (k as f32) + x;
            }
            sum
        };
        let results: Vec<Lanes> = [Isa::Baseline, Isa::Avx2, Isa::Avx512]
            .into_iter()
            .filter(|i| i.choose())
            .map(|_| isa::run(|| work(1.3)))
            .collect();
        Isa::detect().choose();
        assert!(results.windows(2).all(|r| r[0] == r[1]));
    }
}
