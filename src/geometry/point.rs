//! A point of view.

use super::view_sun_cosine;

/// An observer and a view, all angles at the observer, inside or outside the atmosphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Height over the ground, m.
    pub altitude: f64,
    /// Cosine of the zenith angle of the direction looked into, +1 up.
    pub mu: f64,
    /// Cosine of the zenith angle of the direction towards the sun.
    pub mu_s: f64,
    /// Azimuth between view and sun, degrees; 0 looks towards the sun.
    pub azimuth_deg: f64,
}

impl Point {
    /// Cosine of the angle between view and sun.
    pub fn nu(&self) -> f64 {
        view_sun_cosine(self.mu, self.mu_s, libm::cos(self.azimuth_deg.to_radians()))
    }
}
