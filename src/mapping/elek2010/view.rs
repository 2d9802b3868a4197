//! The view axis: V, two halves, linear in the distance to where the ray ends.

use super::Elek2010;
use crate::mapping::array::{Texel, texel};
use crate::mapping::window::Views;

impl Elek2010 {
    /// Texels of a half of the view axis.
    fn half(&self) -> usize {
        if self.views == Views::All { self.size[1] / 2 } else { self.size[1] }
    }

    /// Cosine of the zenith angle of the horizon.
    pub fn horizon_mu(&self, altitude: f64) -> f64 {
        -self.horizon_distance(altitude) / (self.ground_radius + altitude)
    }

    /// True where a ray hits the ground: cos ϑ < 0 and Z3 > 0 in the paper.
    #[inline]
    pub fn hits_ground(&self, altitude: f64, mu: f64) -> bool {
        mu < self.horizon_mu(altitude)
    }

    /// Distance along a ray to the ground or to the top, m. `hits_ground` decides which; at the horizon itself
    /// rounding may not.
    #[inline]
    pub fn distance(&self, altitude: f64, mu: f64, hits_ground: bool) -> f64 {
        let z1 = self.horizon_distance(altitude);
        let along = (self.ground_radius + altitude) * mu;
        if hits_ground {
            let root = ((-along - z1) * (z1 - along)).max(0.0).sqrt();
            return if z1 == 0.0 { 0.0 } else { z1 * z1 / (root - along) };
        }
        let to_top = self.z2_squared_minus_z1_squared(altitude);
        let root = (along * along + to_top).sqrt();
        match along > 0.0 {
            true => to_top / (along + root),
            false => root - along,
        }
    }

    #[inline]
    fn z2_squared_minus_z1_squared(&self, altitude: f64) -> f64 {
        (self.height - altitude) * (2.0 * self.ground_radius + self.height + altitude)
    }

    /// Shortest (nadir, zenith) and longest (horizon) distance of a half.
    #[inline]
    fn distances(&self, altitude: f64, hits_ground: bool) -> (f64, f64) {
        let z1 = self.horizon_distance(altitude);
        match hits_ground {
            true => (altitude, z1),
            false => (self.height - altitude, z1 + self.horizon_distance(self.height)),
        }
    }

    /// Coordinate 0..1 inside a half of the view axis: 0 nadir or zenith, 1 the horizon. On the ground, where
    /// all distances to it are 0, the limit from above: 0, and 1 for the horizontal ray.
    #[inline]
    pub fn view_coordinate(&self, altitude: f64, mu: f64, hits_ground: bool) -> f64 {
        let (shortest, longest) = self.distances(altitude, hits_ground);
        if longest <= shortest {
            return f64::from(u8::from(mu >= 0.0));
        }
        let distance = self.distance(altitude, mu, hits_ground);
        let paper = ((distance - shortest) / (longest - shortest)).clamp(0.0, 1.0);
        self.bends.view_coordinate(paper, hits_ground)
    }

    /// Cosine of the view zenith angle, and whether the ray hits the ground, of view texel `j` at an altitude.
    /// Texels 0 … N/2−1 go from nadir to the horizon, N/2 … N−1 from zenith to the horizon. On the ground the
    /// first half is the limit from above: nadir, then the horizon for all the rest. Of the sky alone the first half
    /// is not there.
    pub fn mu(&self, altitude: f64, j: usize) -> (f64, bool) {
        let half = self.half();
        let (hits_ground, step) = (j < half && self.views == Views::All, j % half);
        (self.mu_along(altitude, step as f64, hits_ground), hits_ground)
    }

    /// Cosine of the view zenith angle at a share, in the axis' coordinate, of the way from view texel `j` to the next of
    /// its half, and whether the ray hits the ground.
    pub fn mu_between(&self, altitude: f64, j: usize, share: f64) -> (f64, bool) {
        let half = self.half();
        let (hits_ground, step) = (j < half && self.views == Views::All, j % half);
        (self.mu_along(altitude, step as f64 + share, hits_ground), hits_ground)
    }

    /// The same at a place counted in texels of a half.
    fn mu_along(&self, altitude: f64, step: f64, hits_ground: bool) -> f64 {
        let last = (self.half() - 1) as f64;
        if step == 0.0 {
            return if hits_ground { -1.0 } else { 1.0 };
        }
        let horizon = self.horizon_mu(altitude);
        let (shortest, longest) = self.distances(altitude, hits_ground);
        let x = self.bends.view(step / last, hits_ground);
        let distance = shortest + x * (longest - shortest);
        if step == last || distance == 0.0 {
            return horizon;
        }
        let (z1, radius) = (self.horizon_distance(altitude), self.ground_radius + altitude);
        let above_horizon = match hits_ground {
            true => -(z1 - distance) * (z1 - distance) / (2.0 * radius * distance),
            false => {
                let z2 = self.horizon_distance(self.height);
                let z2_minus_z1 = self.z2_squared_minus_z1_squared(altitude) / (z2 + z1);
                (longest - distance) * (z2_minus_z1 + distance) / (2.0 * radius * distance)
            }
        };
        (horizon + above_horizon).clamp(-1.0, 1.0)
    }

    /// Texels around a view direction, both in the half that `hits_ground` names; of the sky alone the horizon's, where
    /// the ray meets the ground.
    #[inline]
    pub fn view_texel(&self, altitude: f64, mu: f64, hits_ground: bool) -> Texel {
        let half = self.half();
        if self.views == Views::Sky {
            let x = if hits_ground { 1.0 } else { self.view_coordinate(altitude, mu, false) };
            return texel(x, half);
        }
        let (index, fraction) = texel(self.view_coordinate(altitude, mu, hits_ground), half);
        (if hits_ground { index } else { half + index }, fraction)
    }
}
