//! A layer of the air, a cloud above all, that the altitude axis is finer in.

/// Where the layer lies and how much of the axis belongs to it. Over the whole height H its coordinate is
///   C(z) = (q((z − a) / w) − q(−a / w)) / (q((H − a) / w) − q(−a / w)),   q(v) = v / (1 + |v|),
/// and with a share s of the axis, X its coordinate without, the coordinate is (1 − s) X + s C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// s, from 0 (no layer) to below 1.
    pub share: f64,
    /// a, m: the altitude at which the axis is finest.
    pub altitude: f64,
    /// w, m: half of the axis' layer lies within this of `altitude`.
    pub width: f64,
}

impl Layer {
    pub const NONE: Layer = Layer { share: 0.0, altitude: 0.0, width: 1.0 };

    /// Coordinate of an altitude (m) in a shell of this height, of which the axis' other part has `rest`.
    #[inline]
    pub(super) fn coordinate(&self, altitude: f64, height: f64, rest: f64) -> f64 {
        if self.share == 0.0 {
            return rest;
        }
        let q = |z: f64| {
            let v = (z - self.altitude) / self.width;
            v / (1.0 + v.abs())
        };
        let (low, high) = (q(0.0), q(height));
        (1.0 - self.share) * rest + self.share * (q(altitude) - low) / (high - low)
    }
}
