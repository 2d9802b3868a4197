//! The 4D parameterisation of Bruneton 2017, "Precomputed Atmospheric Scattering: a New Implementation", as the
//! package three-atmosphere reads it: altitude, view, sun and the angle between view and sun.
//!
//! Altitude and view are those of Elek & Kmoch 2010, who took them from the same source: U = Z1 / Z2, and the
//! distance along the ray in two halves; here the half of rays that hit the ground runs the other way, from the
//! horizon to the nadir. The sun's axis follows the distance to the top from the ground; ν replaces the
//! azimuth, which wastes texels: where the sun or the view is near the zenith most values of ν do not occur.

use crate::mapping::{AxisFormula, Elek2010};
use crate::mapping::{Texel, texel};

/// The mapping between (altitude, mu, mu_s, nu) and texels.
#[derive(Clone, Debug, PartialEq)]
pub struct Bruneton {
    shell: Elek2010,
    mu_s_min: f64,
    /// Distance to the top from the ground: straight up, and level.
    shortest: f64,
    longest: f64,
    /// a at the lower end of the sun axis.
    lowest: f64,
    nu_size: usize,
}

impl Bruneton {
    /// Altitude, view, sun, ν: what shaders of three-atmosphere have compiled in.
    pub const SIZE: [usize; 4] = [32, 128, 32, 8];

    /// A mapping for a shell between two radii (m), with the sun axis of [`Elek2010`] in length: down to the last
    /// light at the top. Sizes as for [`Elek2010::new`]; none where they or the shell are out of range.
    pub fn new(ground_radius: f64, top_radius: f64, size: [usize; 4]) -> Option<Self> {
        let shell = Elek2010::new(ground_radius, top_radius, size)?;
        let mu_s_min = shell.mu_s_min();
        let (shortest, longest) =
            (top_radius - ground_radius, shell.horizon_distance(top_radius - ground_radius));
        let mut mapping = Bruneton { shell, mu_s_min, shortest, longest, lowest: 1.0, nu_size: size[3] };
        mapping.lowest = mapping.steps(mu_s_min);
        Some(mapping)
    }

    /// The mapping of altitude and view, with its geometry; its sun and azimuth axes are not this mapping's.
    pub fn shell(&self) -> &Elek2010 {
        &self.shell
    }

    pub fn size(&self) -> [usize; 4] {
        self.shell.size()
    }

    /// Lowest cosine of the sun's zenith angle; there and below it is dark.
    pub fn mu_s_min(&self) -> f64 {
        self.mu_s_min
    }

    /// Cosine of the view's zenith angle, and whether the ray hits the ground, of view texel `j`: from the horizon (0)
    /// to the nadir (N/2 − 1), then from the zenith (N/2) to the horizon (N − 1).
    pub fn mu(&self, altitude: f64, j: usize) -> (f64, bool) {
        let half = self.shell.size()[1] / 2;
        self.shell.mu(altitude, if j < half { half - 1 - j } else { j })
    }

    /// Texels around a view, both in the half that `hits_ground` names.
    pub fn view_texel(&self, altitude: f64, mu: f64, hits_ground: bool) -> Texel {
        let half = self.shell.size()[1] / 2;
        let x = self.shell.view_coordinate(altitude, mu, hits_ground);
        match hits_ground {
            true => texel(1.0 - x, half),
            false => {
                let (index, fraction) = texel(x, half);
                (half + index, fraction)
            }
        }
    }

    /// a: how far the distance from the ground to the top, towards the sun, has come from the shortest to the level
    /// one; beyond 1 below the horizon, through the planet.
    fn steps(&self, mu_s: f64) -> f64 {
        (self.shell.distance(0.0, mu_s, false) - self.shortest) / (self.longest - self.shortest)
    }

    /// Coordinate 0..1 of the sun: (1 − a / a_lowest) / (1 + a), 0 at and below the lower end.
    pub fn sun_coordinate(&self, mu_s: f64) -> f64 {
        let a = self.steps(mu_s);
        (1.0 - a / self.lowest).max(0.0) / (1.0 + a)
    }

    /// Cosine of the sun's zenith angle of texel `k`: the lower end for the first, 1 for the last.
    pub fn mu_s(&self, k: usize) -> f64 {
        let last = self.shell.size()[2] - 1;
        if k == 0 || k == last {
            return if k == 0 { self.mu_s_min } else { 1.0 };
        }
        let x = k as f64 / last as f64;
        let a = self.lowest * (1.0 - x) / (1.0 + x * self.lowest);
        let d = self.shortest + a * (self.longest - self.shortest);
        let ground = self.shell.radii()[0];
        ((self.longest - d) * (self.longest + d) / (2.0 * ground * d)).clamp(self.mu_s_min, 1.0)
    }

    /// Cosine of the angle between view and sun of texel `l`: −1 for the first, 1 for the last.
    pub fn nu(&self, l: usize) -> f64 {
        2.0 * l as f64 / (self.nu_size - 1) as f64 - 1.0
    }

    /// `nu` held to what view and sun allow, and the cosine of the azimuth between them (1 where either is at the
    /// zenith).
    pub fn possible(mu: f64, mu_s: f64, nu: f64) -> (f64, f64) {
        let sines = ((1.0 - mu * mu) * (1.0 - mu_s * mu_s)).max(0.0).sqrt();
        let nu = nu.clamp(mu * mu_s - sines, mu * mu_s + sines);
        (nu, if sines > 0.0 { ((nu - mu * mu_s) / sines).clamp(-1.0, 1.0) } else { 1.0 })
    }

    /// Texels around a place, in the order of [`Self::size`].
    pub fn locate(&self, altitude: f64, mu: f64, mu_s: f64, nu: f64, hits_ground: bool) -> [Texel; 4] {
        let size = self.shell.size();
        [
            texel(self.shell.altitude_coordinate(altitude), size[0]),
            self.view_texel(altitude, mu, hits_ground),
            texel(self.sun_coordinate(mu_s), size[2]),
            texel(0.5 * (1.0 + nu), size[3]),
        ]
    }

    /// The axes for a manifest, in the order of [`Self::size`]. Texel i of n has the coordinate i / (n − 1); on the
    /// view axis within each half.
    pub fn axes(&self) -> [AxisFormula; 4] {
        let [altitude, mut view, _, _] = self.shell.axes();
        view.coordinate = "t = (d - d_min) / (d_max - d_min). First half of the texels, rays that hit the ground: \
            V = 1 - t, d = -r mu - sqrt(r^2 mu^2 - Z1^2), d_min = r - r_ground, d_max = Z1. Second half, rays that do \
            not: V = t, d = -r mu + sqrt(r^2 mu^2 - Z1^2 + Z2^2), d_min = r_top - r, d_max = Z1 + Z2. Never filter \
            across the halves";
        view.inverse = "d = d_min + t (d_max - d_min). First half: mu = -(Z1^2 + d^2) / (2 r d). Second half: mu = \
            (Z2^2 - Z1^2 - d^2) / (2 r d)";
        let sun = AxisFormula {
            name: "sun",
            size: self.shell.size()[2],
            coordinate: "max(1 - a / a_lowest, 0) / (1 + a), a = (d - d_min) / (d_max - d_min), d the distance from \
                the ground to the top towards the sun",
            inverse: "a = a_lowest (1 - x) / (1 + x a_lowest), d = d_min + a (d_max - d_min), mu_s = (d_max^2 - d^2) \
                / (2 r_ground d)",
            constants: vec![
                ("a_lowest", self.lowest),
                ("d_min", self.shortest),
                ("d_max", self.longest),
                ("mu_s_min", self.mu_s_min),
            ],
        };
        let nu = AxisFormula {
            name: "nu",
            size: self.nu_size,
            coordinate: "(1 + nu) / 2, nu the cosine of the angle between view and sun",
            inverse: "nu = 2 x - 1",
            constants: Vec::new(),
        };
        [altitude, view, sun, nu]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn small_planet() -> Bruneton {
        Bruneton::new(400e3, 460e3, Bruneton::SIZE).expect("sizes are good")
    }

    /// Texel centres are their own places, on every axis, also the half that runs the other way.
    #[test]
    fn texels_map_to_themselves() {
        let m = small_planet();
        let at = |(index, fraction): Texel| index as f64 + fraction;
        for i in [1, 15, 30] {
            let altitude = m.shell().altitude(i);
            for j in [1, 40, 62, 65, 100, 126] {
                let (mu, hits_ground) = m.mu(altitude, j);
                assert_eq!(hits_ground, j < 64);
                assert!((at(m.view_texel(altitude, mu, hits_ground)) - j as f64).abs() < 1e-6, "{i} {j}");
            }
        }
        for k in 0..32 {
            assert!((m.sun_coordinate(m.mu_s(k)) * 31.0 - k as f64).abs() < 1e-9, "{k}");
        }
        assert_eq!([m.nu(0), m.nu(7)], [-1.0, 1.0]);
    }

    /// The half of the ground begins at the horizon, that of the sky at the zenith.
    #[test]
    fn ground_half_runs_from_the_horizon_to_the_nadir() {
        let m = small_planet();
        let altitude = 20e3;
        assert_eq!(m.mu(altitude, 63), (-1.0, true));
        assert_eq!(m.mu(altitude, 0), (m.shell().horizon_mu(altitude), true));
        assert_eq!(m.mu(altitude, 64), (1.0, false));
    }

    /// The sun axis of the published default (6360 and 6420 km, a sun at 102 degrees would be −0.2): a level sun has
    /// a = 1 by definition, so its coordinate is (1 − 1 / a_lowest) / 2.
    #[test]
    fn a_level_sun_has_a_equal_to_1() {
        let m = Bruneton::new(6360e3, 6420e3, Bruneton::SIZE).expect("sizes are good");
        let expected = (1.0 - 1.0 / m.lowest) / 2.0;
        assert!((m.sun_coordinate(0.0) - expected).abs() < 1e-12);
        assert_eq!(m.sun_coordinate(-0.9), 0.0);
    }

    /// With the sun at the zenith ν can only be mu.
    #[test]
    fn impossible_angles_are_held_to_possible_ones() {
        assert_eq!(Bruneton::possible(0.3, 1.0, -1.0), (0.3, 1.0));
        let (nu, cos_azimuth) = Bruneton::possible(0.0, 0.0, -0.5);
        assert_eq!((nu, cos_azimuth), (-0.5, -0.5));
    }
}
