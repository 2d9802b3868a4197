//! Cosines of angles between a view, the sun and the ground's edge.

/// Cosine of the zenith angle of the ground's edge seen from radius `r`; 0 on the ground.
pub fn horizon_cosine(r: f64, ground: f64) -> f64 {
    let (a, b) = (((r - ground) * (r + ground)).max(0.0), r * r);
    -(a / b).sqrt()
}

/// Cosine of the angle between view and sun (nu), from the cosines of their zenith angles and of the azimuth between
/// them.
pub fn view_sun_cosine(mu: f64, mu_s: f64, cos_azimuth: f64) -> f64 {
    let sines = ((1.0 - mu * mu) * (1.0 - mu_s * mu_s)).max(0.0).sqrt();
    mu * mu_s + sines * cos_azimuth
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a planet of radius 3 the ground's edge is seen from radius 5 at a sine of 3/5, below the horizontal.
    #[test]
    fn the_horizon_of_a_triangle_with_whole_sides() {
        assert!((horizon_cosine(5.0, 3.0) + 0.8).abs() < 1e-15);
        assert_eq!(horizon_cosine(3.0, 3.0), 0.0);
    }

    /// With the sun in the same azimuth and both 60 degrees from the zenith the angle is 0, opposite 120 degrees.
    #[test]
    fn angles_add_up_in_one_plane() {
        assert!((view_sun_cosine(0.5, 0.5, 1.0) - 1.0).abs() < 1e-15);
        assert!((view_sun_cosine(0.5, 0.5, -1.0) + 0.5).abs() < 1e-15);
    }
}
