//! Views on which tables are judged.

use crate::geometry::Point;

/// A kind of view, told apart because tables err differently there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    pub name: &'static str,
    /// Elevation of the sun at the observer, degrees.
    sun: [f64; 2],
    /// Share of views close to the horizon.
    horizon: f64,
    place: Place,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    /// Half on the ground, the rest spread over the shell, low altitudes more often.
    Inside,
    /// Up to three shell heights above the top.
    Outside,
}

/// The regions of the report. Elevations are those of the sun at the observer.
pub const REGIONS: [Region; 5] = [
    Region { name: "day", sun: [10.0, 90.0], horizon: 0.3, place: Place::Inside },
    Region { name: "low sun, 0 to 10 degrees", sun: [0.0, 10.0], horizon: 0.4, place: Place::Inside },
    Region { name: "twilight, 0 to -12 degrees", sun: [-12.0, 0.0], horizon: 0.4, place: Place::Inside },
    Region { name: "horizon by day", sun: [10.0, 90.0], horizon: 1.0, place: Place::Inside },
    Region { name: "from space by day", sun: [10.0, 90.0], horizon: 0.0, place: Place::Outside },
];

/// `count` views of a region for a shell from `ground` to `top` (radii, m), spread evenly by an additive
/// recurrence (Roberts 2018); other `seed`s give other views.
pub fn views(region: &Region, count: usize, seed: u64, ground: f64, top: f64) -> Vec<Point> {
    // Powers of the root of x^6 = x + 1: the best known steps in five dimensions.
    const ROOT: f64 = 1.134_724_138_401_519_5;
    let mut steps = [0.0; 5];
    let mut power = 1.0;
    for step in &mut steps {
        power /= ROOT;
        *step = power;
    }
    let start = (seed as f64 * 0.618_033_988_749_894_9).fract();
    (0..count)
        .map(|k| {
            point(region, std::array::from_fn(|d| (start + (k as f64 + 1.0) * steps[d]).fract()), ground, top)
        })
        .collect()
}

fn point(region: &Region, u: [f64; 5], ground: f64, top: f64) -> Point {
    let height = top - ground;
    let altitude = match region.place {
        Place::Inside if u[0] < 0.5 => 2.0,
        Place::Inside => height * (2.0 * u[0] - 1.0) * (2.0 * u[0] - 1.0) * (2.0 * u[0] - 1.0),
        Place::Outside => height * (1.0 + 3.0 * u[0]),
    };
    let elevation = region.sun[0] + (region.sun[1] - region.sun[0]) * u[1];
    let r = ground + altitude;
    let horizon = -((r - ground) * (r + ground)).max(0.0).sqrt() / r;
    let mu = match region.place {
        // From outside: anywhere on the disc of the shell, even in area.
        Place::Outside => -(1.0 - u[2] * 0.998 * (top / r) * (top / r)).sqrt(),
        Place::Inside if u[3] < region.horizon => {
            let degrees = libm::asin(horizon).to_degrees() + 10.0 * (u[2] - 0.5);
            libm::sin(degrees.clamp(-89.9, 89.9).to_radians())
        }
        Place::Inside => 1.0 - 2.0 * u[2],
    };
    Point { altitude, mu, mu_s: libm::sin(elevation.to_radians()), azimuth_deg: 180.0 * u[4] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every view of a region has its sun, and a view from outside meets the shell.
    #[test]
    fn views_lie_in_their_region() {
        for region in &REGIONS {
            for p in views(region, 500, 7, 1000e3, 1100e3) {
                let elevation = libm::asin(p.mu_s).to_degrees();
                assert!(elevation >= region.sun[0] - 1e-9 && elevation <= region.sun[1] + 1e-9);
                if region.place == Place::Outside {
                    let r = 1000e3 + p.altitude;
                    assert!(p.mu < 0.0 && r * r * (1.0 - p.mu * p.mu) < 1100e3 * 1100e3);
                }
            }
        }
    }
}
