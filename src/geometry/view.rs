//! A view from anywhere, brought to where it enters the atmosphere.

use super::Point;
use crate::geometry::horizon_cosine;

/// A ray that starts inside the atmosphere or at its top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    pub r: f64,
    pub mu: f64,
    pub mu_s: f64,
    pub nu: f64,
    pub hits_ground: bool,
}

impl View {
    /// Moves an observer outside the atmosphere along the view ray to its top, keeping the angle between view
    /// and sun; none where the ray misses. An observer inside stays.
    pub fn enter(point: &Point, ground: f64, top: f64) -> Option<View> {
        let r = ground + point.altitude;
        let nu = point.nu().clamp(-1.0, 1.0);
        if r <= top {
            let hits_ground = point.mu < horizon_cosine(r, ground);
            return Some(View { r, mu: point.mu, mu_s: point.mu_s, nu, hits_ground });
        }
        let b2 = r * r * (1.0 - point.mu * point.mu);
        if point.mu >= 0.0 || b2 >= top * top {
            return None;
        }
        let at_top = -(top * top - b2).sqrt();
        let length = at_top - r * point.mu;
        let mu_s = ((r * point.mu_s + length * nu) / top).clamp(-1.0, 1.0);
        Some(View { r: top, mu: at_top / top, mu_s, nu, hits_ground: b2 <= ground * ground })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From far outside, straight down with the sun at the horizontal: the entry has the same angles.
    #[test]
    fn an_outside_observer_is_moved_to_the_top() {
        let down = Point { altitude: 500.0, mu: -1.0, mu_s: 0.0, azimuth_deg: 0.0 };
        let view = View::enter(&down, 1000.0, 1100.0).unwrap();
        assert!(view.r == 1100.0 && view.mu == -1.0 && view.hits_ground && view.mu_s.abs() < 1e-15);
        let miss = Point { altitude: 500.0, mu: -0.5, mu_s: 0.0, azimuth_deg: 0.0 };
        assert_eq!(View::enter(&miss, 1000.0, 1100.0), None);
    }
}
