//! Colours as textures of halves hold them.

use super::air::Rgb;
use crate::files::atlas::half_from;
use crate::mapping::Array;

/// The largest half that a scaled table may reach.
const BRIGHTEST: f64 = 32768.0;

/// Rounds every colour to halves of one power of two that brings the brightest close below the largest half.
pub(super) fn to_halves<const D: usize>(texels: &mut Array<Rgb, D>) {
    let brightest = texels.values().iter().flatten().fold(0.0, |a: f64, &v| if v > a { v } else { a });
    if brightest <= 0.0 {
        return;
    }
    let scale = libm::exp2(libm::floor(libm::log2(BRIGHTEST / brightest)));
    for v in texels.values_mut().iter_mut().flatten() {
        *v = f64::from(half_from(*v * scale).to_f32()) / scale;
    }
}

/// Bytes of a texel of four halves.
pub(super) const TEXEL: usize = 8;
