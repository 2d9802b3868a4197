//! How the texels of a table's altitude and view axes are spread over the paper's coordinates.

use super::layer::Layer;

/// How the axes of Elek & Kmoch 2010 §4.1 are warped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Warp {
    /// Above 0, the altitude axis is finer near the ground by the factor 1 + bend, and coarser near the top by
    /// the same.
    pub altitude_bend: f64,
    /// 1: the paper's, in which the lowest altitudes are spread by the square root of their height, as the horizon
    /// recedes. 2: by their height, where the air is too thick for the horizon to be seen.
    pub altitude_power: f64,
    /// Above 1, the view axis is finer near zenith and nadir.
    pub view_power: f64,
    /// Above 1, rays that do not hit the ground are finer near the horizon. Seen from a height, rays that pass
    /// close over the ground and rays that pass above the haze differ little in length: a kilometre of lowest
    /// altitude is 14 km of 1800 seen from the top of Earth's air. Rays that do hit the ground need no bend: there
    /// the length goes as the square root of the angle below the horizon.
    pub horizon_power: f64,
    /// Where the altitude axis is finer besides.
    pub layer: Layer,
}

impl Warp {
    /// The paper's axes.
    pub const PAPER: Warp = Warp {
        altitude_bend: 0.0,
        altitude_power: 1.0,
        view_power: 1.0,
        horizon_power: 1.0,
        layer: Layer::NONE,
    };

    /// Coordinate of the paper's U.
    #[inline]
    pub(super) fn altitude_coordinate(&self, u: f64) -> f64 {
        let u = power(u, self.altitude_power);
        (1.0 + self.altitude_bend) * u / (1.0 + self.altitude_bend * u)
    }

    /// The paper's U at a coordinate.
    pub(super) fn altitude(&self, x: f64) -> f64 {
        power(x / (1.0 + self.altitude_bend * (1.0 - x)), 1.0 / self.altitude_power)
    }

    /// Coordinate in a half of the view axis of the paper's V, 0 nadir or zenith, 1 the horizon.
    #[inline]
    pub(super) fn view_coordinate(&self, v: f64, hits_ground: bool) -> f64 {
        let x = power(v, 1.0 / self.view_power);
        if hits_ground { x } else { from_the_end(x, 1.0 / self.horizon_power) }
    }

    /// The paper's V at a coordinate in a half of the view axis.
    pub(super) fn view(&self, x: f64, hits_ground: bool) -> f64 {
        let x = if hits_ground { x } else { from_the_end(x, self.horizon_power) };
        power(x, self.view_power)
    }
}

/// x to a power; to the first it is x to the bit.
#[inline]
fn power(x: f64, exponent: f64) -> f64 {
    if exponent == 1.0 { x } else { libm::pow(x.max(0.0), exponent) }
}

/// 1 − (1 − x) to a power; to the first it is x to the bit.
#[inline]
fn from_the_end(x: f64, exponent: f64) -> f64 {
    if exponent == 1.0 { x } else { 1.0 - power(1.0 - x, exponent) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mapping::{Elek2010, SunCurve};

    const BENT: Warp = Warp {
        altitude_bend: 1.5,
        altitude_power: 1.0,
        view_power: 1.4,
        horizon_power: 2.5,
        layer: Layer::NONE,
    };

    const CLOUD: Layer = Layer { share: 0.5, altitude: 120e3, width: 9e3 };

    /// Texel centres have the coordinates i / (n − 1), ends included, on a shell a third as thick as its planet,
    /// by the paper's axes, by bent ones and by those that are finer in a layer.
    #[test]
    fn coordinates_and_texels_are_inverse() {
        for bends in [Warp::PAPER, BENT, Warp { layer: CLOUD, ..BENT }] {
            let map =
                Elek2010::new(600e3, 800e3, [13, 24, 5, 9]).unwrap().with_curves(SunCurve::Paper, bends);
            for i in 0..13 {
                let altitude = map.altitude(i);
                let x = map.altitude_coordinate(altitude);
                assert!((x - i as f64 / 12.0).abs() < 1e-12, "{bends:?} altitude {i}: {x}");
                // On the ground all rays down have no length.
                for j in if i == 0 { 12..24 } else { 0..24 } {
                    let (mu, hits_ground) = map.mu(altitude, j);
                    let x = map.view_coordinate(altitude, mu, hits_ground);
                    // Horizon distances lose half their digits in the cosine, a power above 1 more.
                    assert!((x - (j % 12) as f64 / 11.0).abs() < 1e-4, "{bends:?} view {i} {j}: {x}");
                }
            }
        }
    }

    /// What each bend is for: seen from the top, a ray that passes a fiftieth of the shell's height above the ground
    /// is more than two of 24 view texels from the one that grazes it, not half a texel; half of the altitudes, not a
    /// third, lie in the lowest tenth.
    #[test]
    fn bent_axes_are_finer_where_they_should_be() {
        let place = |bends: Warp| {
            let map =
                Elek2010::new(6000e3, 6080e3, [13, 48, 5, 9]).unwrap().with_curves(SunCurve::Paper, bends);
            let lowest = 6000e3 + 80e3 / 50.0;
            let mu = -libm::sqrt(1.0 - (lowest / 6080e3) * (lowest / 6080e3));
            let view = 23.0 * (1.0 - map.view_coordinate(80e3, mu, false));
            [view, map.altitude_coordinate(8e3)]
        };
        let (paper, bent) = (place(Warp::PAPER), place(BENT));
        assert!(paper[0] < 0.5 && bent[0] > 2.0, "{paper:?} {bent:?}");
        assert!(paper[1] < 0.35 && bent[1] > 0.5, "{paper:?} {bent:?}");
    }

    /// Half of a layer's texels lie within its width: of 81 altitudes, half of them the layer's, 20 lie within 9 km of
    /// 120 km but for those that the ends of the shell cut off, beside the 3 that lie there without it.
    #[test]
    fn a_layer_has_its_share_of_the_altitudes() {
        let within = |layer: Layer| {
            let bends = Warp { layer, ..BENT };
            let map =
                Elek2010::new(600e3, 800e3, [81, 24, 5, 9]).unwrap().with_curves(SunCurve::Paper, bends);
            (0..81).filter(|&i| (map.altitude(i) - 120e3).abs() < 9e3).count()
        };
        let (without, with) = (within(Layer::NONE), within(CLOUD));
        assert!((2..=5).contains(&without) && (20..=26).contains(&with), "{without} {with}");
    }
}
