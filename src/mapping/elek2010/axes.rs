//! The axes of the mapping in words, for a manifest.

use super::Elek2010;
use crate::mapping::layer::Layer;
use crate::mapping::window::{Span, Views};

/// Names of the constants that say which part of an axis a table holds: the coordinates of its ends, and, where it is 1,
/// that the view axis has its second half alone.
pub const WINDOW: [&str; 2] = ["window_low", "window_high"];
pub const HALVES: &str = "halves";

/// One axis in words, for a manifest: the coordinate 0..1 from the physical quantity, the inverse, and the
/// constants that both use.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisFormula {
    pub name: &'static str,
    pub size: usize,
    pub coordinate: &'static str,
    pub inverse: &'static str,
    pub constants: Vec<(&'static str, f64)>,
}

impl Elek2010 {
    /// The axes for a manifest. Texel i of n has the coordinate i / (n − 1); for the view axis that holds
    /// within each half of n / 2 texels. Of an axis of which the table holds a part, the constants `window_low` and
    /// `window_high` are the coordinates of its ends.
    pub fn axes(&self) -> [AxisFormula; 4] {
        let mut axes = self.whole_axes();
        for (axis, span) in [(0, self.spans[0]), (2, self.spans[1])] {
            if span != Span::WHOLE {
                axes[axis].constants.extend([(WINDOW[0], span.low), (WINDOW[1], span.high)]);
            }
        }
        if self.views == Views::Sky {
            axes[1].constants.push((HALVES, 1.0));
        }
        axes
    }

    fn whole_axes(&self) -> [AxisFormula; 4] {
        let z2 = self.horizon_distance(self.height);
        let radii =
            vec![("r_ground", self.ground_radius), ("r_top", self.ground_radius + self.height), ("Z2", z2)];
        [
            self.altitude_axis(&radii),
            AxisFormula {
                name: "view",
                size: self.size[1],
                coordinate: "V = 1 - (1 - t^(1 / view_power))^(1 / horizon_power), t = (d - d_min) / (d_max - d_min). First \
                    half of the texels, rays that hit the ground: d = -r mu - sqrt(r^2 mu^2 - Z1^2), d_min = r - \
                    r_ground, d_max = Z1, horizon_power = 1. Second half, rays that do not: d = -r mu + sqrt(r^2 \
                    mu^2 - Z1^2 + Z2^2), d_min = r_top - r, d_max = Z1 + Z2. Never filter across the halves",
                inverse: "t = (1 - (1 - V)^horizon_power)^view_power, d = d_min + t (d_max - d_min). First half: \
                    horizon_power = 1, mu = -(Z1^2 + d^2) / (2 r d). Second half: mu = (Z2^2 - Z1^2 - d^2) / (2 r d)",
                constants: [
                    radii,
                    vec![("view_power", self.bends.view_power), ("horizon_power", self.bends.horizon_power)],
                ]
                .concat(),
            },
            self.sun_axis(),
            AxisFormula {
                name: "azimuth",
                size: self.size[3],
                coordinate: "R = (1 + cos(phi)) / 2",
                inverse: "cos(phi) = 2 R - 1",
                constants: Vec::new(),
            },
        ]
    }

    fn altitude_axis(&self, radii: &[(&'static str, f64)]) -> AxisFormula {
        let layer = self.bends.layer;
        let mut constants = radii.to_vec();
        constants.push(("altitude_bend", self.bends.altitude_bend));
        let (coordinate, inverse) = if layer == Layer::NONE && self.bends.altitude_power == 1.0 {
            (
                "U = (1 + altitude_bend) u / (1 + altitude_bend u), u = Z1 / Z2, Z1 = sqrt(r^2 - r_ground^2)",
                "u = U / (1 + altitude_bend (1 - U)); r = sqrt(r_ground^2 + (u Z2)^2)",
            )
        } else {
            constants.extend([
                ("altitude_power", self.bends.altitude_power),
                ("layer_share", layer.share),
                ("layer_altitude", layer.altitude),
                ("layer_width", layer.width),
            ]);
            (
                "U = (1 - layer_share) X + layer_share (Q(r - r_ground) - Q(0)) / (Q(r_top - r_ground) - Q(0)), \
                    X = (1 + altitude_bend) u / (1 + altitude_bend u), u = (Z1 / Z2)^altitude_power, Z1 = sqrt(r^2 - \
                    r_ground^2), Q(z) = v / (1 + |v|), v = (z - layer_altitude) / layer_width",
                "none in closed form; U rises with r",
            )
        };
        AxisFormula { name: "altitude", size: self.size[0], coordinate, inverse, constants }
    }

    fn sun_axis(&self) -> AxisFormula {
        let low = ("mu_s_min", self.mu_s_min);
        let (coordinate, inverse, constants) = match self.curve.words() {
            Some((coordinate, inverse, [a, b])) => (coordinate, inverse, vec![a, b, low]),
            None => (
                "W = (1 - exp(-a (mu_s - mu_s_min))) / (1 - exp(-3.6)), a = 3.6 / (1 - mu_s_min); the table is \
                    0 for mu_s < mu_s_min",
                "mu_s = mu_s_min - ln(1 - W (1 - exp(-3.6))) / a",
                vec![("a", self.sun_steepness), low],
            ),
        };
        AxisFormula { name: "sun", size: self.size[2], coordinate, inverse, constants }
    }
}
