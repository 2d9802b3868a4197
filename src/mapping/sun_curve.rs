//! How the texels of a table's sun axis are spread over the cosine of the sun's zenith angle.

/// A curve x(mu_s) in whose equal steps texels lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SunCurve {
    /// The exponential W of Elek & Kmoch 2010 §4.1.
    Paper,
    /// x = u / (|u| + width) with u = mu_s + shift: closest where the sun is a little below the horizon and light
    /// fades fastest, and still fine by day.
    Rational { shift: f64, width: f64 },
    /// The same quotient with u = centre − h, h = √((1 − mu_s) / 2) the sine of half the sun's zenith angle. The
    /// azimuth enters the angle between view and sun by s cos φ, s the sine of the sun's zenith angle. Near the
    /// zenith s is as good as linear in h; against mu_s it is a square root, which no linear filter follows.
    HalfAngle { centre: f64, width: f64 },
}

impl SunCurve {
    /// The same curve with its shift moved by less than a texel, so that one of `size` texels of an axis from one
    /// mu_s to another lies at mu_s = 0: there the planet's shadow meets the ground, and light scattered once ends at
    /// a step that no texel pair may straddle by day. Curves without a shift, and axes that do not cross 0, stay as
    /// they are.
    pub fn with_texel_at_horizon(self, [mu_s_min, mu_s_max]: [f64; 2], size: usize) -> Self {
        if !(mu_s_min < 0.0 && 0.0 < mu_s_max) {
            return self;
        }
        let SunCurve::Rational { shift, width } = self else { return self };
        let steps = size.saturating_sub(1) as f64;
        let place = |shift: f64| {
            let x = |mu: f64| (mu + shift) / ((mu + shift).abs() + width);
            steps * (x(0.0) - x(mu_s_min)) / (x(mu_s_max) - x(mu_s_min))
        };
        // The place of mu_s = 0 moves towards the end of the axis as the shift grows.
        let wanted = place(shift).round();
        let (mut low, mut high) = (-0.5 * width, shift + width);
        if !(place(low) < wanted && wanted < place(high)) {
            return self.with_texel_near_horizon(place, [low, high]);
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if place(middle) < wanted { low = middle } else { high = middle }
        }
        SunCurve::Rational { shift: high, width }
    }

    /// On a part of the axis the place of mu_s = 0 comes and goes with the shift: the nearest shift at which it is that of
    /// a texel; this curve where there is none.
    fn with_texel_near_horizon(self, place: impl Fn(f64) -> f64, [low, high]: [f64; 2]) -> Self {
        const STEPS: usize = 256;
        let SunCurve::Rational { shift, width } = self else { return self };
        let at = |k: usize| low + (high - low) * k as f64 / STEPS as f64;
        let mut best: Option<f64> = None;
        for k in 0..STEPS {
            let (mut a, mut b) = (at(k), at(k + 1));
            let wanted = place(a).max(place(b)).floor();
            let crosses = wanted >= 1.0 && wanted > place(a).min(place(b));
            let nearer = best.is_none_or(|best| (b - shift).abs() < (best - shift).abs());
            if !(crosses && nearer) {
                continue;
            }
            let rises = place(b) > place(a);
            for _ in 0..60 {
                let middle = 0.5 * (a + b);
                if (place(middle) < wanted) == rises { a = middle } else { b = middle }
            }
            best = Some(b);
        }
        best.map_or(self, |shift| SunCurve::Rational { shift, width })
    }

    /// x(mu_s), −1 to 1; none for the paper's curve, which is no quotient.
    #[inline]
    pub(super) fn quotient(self, mu_s: f64) -> Option<f64> {
        let (u, width) = match self {
            SunCurve::Paper => return None,
            SunCurve::Rational { shift, width } => (mu_s + shift, width),
            SunCurve::HalfAngle { centre, width } => (centre - half_sine(mu_s), width),
        };
        Some(u / (u.abs() + width))
    }

    /// The mu_s of which x is the quotient; none for the paper's curve.
    pub(super) fn mu_s(self, x: f64) -> Option<f64> {
        match self {
            SunCurve::Paper => None,
            SunCurve::Rational { shift, width } => Some(x * width / (1.0 - x.abs()) - shift),
            SunCurve::HalfAngle { centre, width } => {
                let h = centre - x * width / (1.0 - x.abs());
                Some(1.0 - 2.0 * h * h)
            }
        }
    }

    /// Coordinate, inverse and constants in words, for a manifest; none for the paper's curve.
    pub(super) fn words(self) -> Option<Words> {
        match self {
            SunCurve::Paper => None,
            SunCurve::Rational { shift, width } => Some((
                "x(mu_s) = u / (|u| + width), u = mu_s + shift; W = (x(mu_s) - x(mu_s_min)) / (x(1) - \
                    x(mu_s_min)); the table is 0 for mu_s < mu_s_min",
                "x = x(mu_s_min) + W (x(1) - x(mu_s_min)); mu_s = x width / (1 - |x|) - shift",
                [("shift", shift), ("width", width)],
            )),
            SunCurve::HalfAngle { centre, width } => Some((
                "x(mu_s) = u / (|u| + width), u = centre - sqrt((1 - mu_s) / 2); W = (x(mu_s) - x(mu_s_min)) / \
                    (x(1) - x(mu_s_min)); the table is 0 for mu_s < mu_s_min",
                "x = x(mu_s_min) + W (x(1) - x(mu_s_min)); mu_s = 1 - 2 (centre - x width / (1 - |x|))^2",
                [("centre", centre), ("width", width)],
            )),
        }
    }
}

/// Coordinate, inverse and constants of a curve in words.
pub(super) type Words = (&'static str, &'static str, [(&'static str, f64); 2]);

/// Sine of half the zenith angle.
#[inline]
fn half_sine(mu_s: f64) -> f64 {
    (0.5 * (1.0 - mu_s)).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mapping::{Elek2010, Warp};

    const CURVES: [SunCurve; 3] = [
        SunCurve::Paper,
        SunCurve::Rational { shift: 0.1, width: 0.3 },
        SunCurve::HalfAngle { centre: 0.7, width: 0.2 },
    ];

    /// Texel k of n has the coordinate k / (n − 1), ends included, on a shell so thick that the axis ends far
    /// below the paper's.
    #[test]
    fn coordinates_and_texels_are_inverse() {
        for curve in CURVES {
            let mapping = Elek2010::new(500e3, 700e3, [4, 6, 33, 3]).unwrap().with_curves(curve, Warp::PAPER);
            for k in 0..33 {
                let x = mapping.sun_coordinate(mapping.mu_s(k).clamp(mapping.mu_s_min(), 1.0)).unwrap();
                assert!((x - k as f64 / 32.0).abs() < 1e-12, "{curve:?} {k}: {x}");
            }
            assert_eq!(mapping.mu_s(32), 1.0);
        }
    }

    /// One of the texels of a curve so shifted lies at mu_s = 0, on a thin shell, a thick one and for many and few
    /// texels, and the shift moved by less than one of the texels is wide there.
    #[test]
    fn a_texel_lies_at_the_horizon() {
        let width = 0.13;
        for (mu_s_min, size) in [(-0.2857, 38), (-0.2857, 41), (-0.8, 20), (-0.3, 97)] {
            let curve =
                SunCurve::Rational { shift: 0.05, width }.with_texel_at_horizon([mu_s_min, 1.0], size);
            let x = |mu: f64| curve.quotient(mu).unwrap();
            let at = (size - 1) as f64 * (x(0.0) - x(mu_s_min)) / (x(1.0) - x(mu_s_min));
            assert!((at - at.round()).abs() < 1e-9, "{mu_s_min} {size}: {at}");
            let SunCurve::Rational { shift, .. } = curve else { panic!("still rational") };
            assert!((shift - 0.05).abs() < 1.0 / size as f64, "{mu_s_min} {size}: {shift}");
        }
    }

    /// By the half angle, s cos φ is followed to 2 % of its range between any two texels by day; by the cosine,
    /// the last step before the zenith is off by more than 5 %.
    #[test]
    fn half_angle_is_fine_near_the_zenith() {
        let worst = |curve| {
            let mapping =
                Elek2010::new(6000e3, 6080e3, [4, 6, 36, 3]).unwrap().with_curves(curve, Warp::PAPER);
            let sine = |mu: f64| (1.0 - mu * mu).sqrt();
            let by_day = (0..35).map(|k| [mapping.mu_s(k), mapping.mu_s(k + 1)]).filter(|m| m[0] > 0.2);
            let errors = by_day.flat_map(|m| {
                [0.1, 0.3, 0.5, 0.7, 0.9].map(|t| {
                    let x = [0, 1].map(|i| mapping.sun_coordinate(m[i]).unwrap());
                    let wanted = x[0] + t * (x[1] - x[0]);
                    // The place between the texels, by bisection.
                    let (mut low, mut high) = (m[0], m[1]);
                    for _ in 0..60 {
                        let middle = 0.5 * (low + high);
                        match mapping.sun_coordinate(middle).unwrap() < wanted {
                            true => low = middle,
                            false => high = middle,
                        }
                    }
                    (sine(low) - (1.0 - t) * sine(m[0]) - t * sine(m[1])).abs()
                })
            });
            errors.fold(0.0, f64::max)
        };
        let half = worst(SunCurve::HalfAngle { centre: 0.728, width: 0.13 });
        let cosine = worst(SunCurve::Rational { shift: 0.06, width: 0.25 });
        assert!(half < 0.02 && cosine > 0.05, "{half} {cosine}");
    }
}
