//! Where the observer stands and looks, and where the star is.

use glam::{DVec3, dvec3};
use tyndall::internals::geometry::Point;

/// How the picture is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Kind {
    /// A perspective that looks along the horizon
    Ground,
    /// A perspective that looks down at the planet from afar
    Orbit,
    /// A half sphere in equal angles: the whole sky above, or about another --pitch
    Fisheye,
}

/// Altitude in m, angles in degrees. The star's azimuth is that of heading 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub kind: Kind,
    pub altitude: f64,
    /// Clockwise from the star's azimuth, seen from above.
    pub heading: f64,
    /// Above the horizontal.
    pub pitch: f64,
    /// Of view, from the lower to the upper edge.
    pub field: f64,
    pub sun_elevation: f64,
}

impl Camera {
    /// The usual place of a kind on a planet of these radii (m).
    pub fn usual(kind: Kind, [ground, top]: [f64; 2]) -> Camera {
        let (altitude, pitch) = match kind {
            Kind::Ground => (2.0, 18.0),
            Kind::Orbit => (2.0 * ground, -90.0),
            Kind::Fisheye => (2.0, 90.0),
        };
        let camera = Camera { kind, altitude, heading: 0.0, pitch, field: 60.0, sun_elevation: 30.0 };
        camera.framed([ground, top])
    }

    /// In orbit, the field of view that the whole planet fits into.
    pub fn framed(mut self, [ground, top]: [f64; 2]) -> Camera {
        if self.kind == Kind::Orbit {
            let sine = (top / (ground + self.altitude)).min(0.9);
            self.field = (2.2 * libm::asin(sine)).to_degrees();
        }
        self
    }

    /// Unit vectors to the right, up and forward; y is up at the observer, z the star's azimuth.
    pub fn axes(&self) -> [DVec3; 3] {
        let (sin_h, cos_h) = libm::sincos(self.heading.to_radians());
        let (sin_p, cos_p) = libm::sincos(self.pitch.to_radians());
        let level = dvec3(-sin_h, 0.0, cos_h);
        let forward = level * cos_p + DVec3::Y * sin_p;
        let up = DVec3::Y * cos_p - level * sin_p;
        // Of the sky above, the heading is at the top; of what lies ahead, the sky is.
        let up = if self.kind == Kind::Fisheye && self.pitch > 45.0 { -up } else { up };
        [forward.cross(up), up, forward]
    }

    /// Unit vector towards the star.
    pub fn sun(&self) -> DVec3 {
        let (sine, cosine) = libm::sincos(self.sun_elevation.to_radians());
        dvec3(0.0, sine, cosine)
    }

    /// The direction of a place in the picture, −1 to 1 to the right and up; none outside a fisheye's circle.
    pub fn direction(&self, x: f64, y: f64, aspect: f64) -> Option<DVec3> {
        let [right, up, forward] = self.axes();
        if self.kind != Kind::Fisheye {
            let tangent = libm::tan(0.5 * self.field.to_radians());
            return Some((forward + (right * (x * aspect) + up * y) * tangent).normalize());
        }
        let scale = aspect.min(1.0);
        let [x, y] = [x * aspect / scale, y / scale];
        let radius = (x * x + y * y).sqrt();
        let (sine, cosine) = libm::sincos(0.5 * std::f64::consts::PI * radius);
        (radius <= 1.0).then(|| forward * cosine + (right * x + up * y) * (sine / radius.max(1e-9)))
    }

    /// The view of a direction as the tables know it.
    pub fn point(&self, d: DVec3) -> Point {
        let sun = self.sun();
        let sines = ((1.0 - d.y * d.y) * (1.0 - sun.y * sun.y)).max(0.0).sqrt();
        let cosine = if sines > 0.0 { (d.dot(sun) - d.y * sun.y) / sines } else { 1.0 };
        let azimuth_deg = libm::acos(cosine.clamp(-1.0, 1.0)).to_degrees();
        Point { altitude: self.altitude, mu: d.y.clamp(-1.0, 1.0), mu_s: sun.y, azimuth_deg }
    }

    /// The angle of a pixel in the middle of a picture `height` pixels high, rad.
    pub fn pixel_angle(&self, width: u32, height: u32) -> f64 {
        match self.kind {
            Kind::Fisheye => std::f64::consts::PI / f64::from(width.min(height)),
            _ => 2.0 * libm::tan(0.5 * self.field.to_radians()) / f64::from(height),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Right, up and forward are a right-handed frame, and heading 90 has the star on the left.
    #[test]
    fn axes_are_orthonormal() {
        let mut camera = Camera::usual(Kind::Ground, [3e6, 3.1e6]);
        (camera.heading, camera.pitch) = (90.0, 20.0);
        let [right, up, forward] = camera.axes();
        assert!((right.cross(up) + forward).length() < 1e-12, "{right} {up} {forward}");
        assert!(right.dot(camera.sun()) < 0.0);
        assert!(up.y > 0.0 && (forward.y - libm::sin(20f64.to_radians())).abs() < 1e-12);
    }

    /// The fisheye's middle is the zenith and its edge the horizon; beyond it there is nothing.
    #[test]
    fn a_fisheye_spans_the_sky() {
        let camera = Camera::usual(Kind::Fisheye, [3e6, 3.1e6]);
        assert!((camera.direction(0.0, 0.0, 2.0).unwrap().y - 1.0).abs() < 1e-12);
        assert!(camera.direction(0.5, 0.0, 2.0).unwrap().y.abs() < 1e-9);
        assert_eq!(camera.direction(0.6, 0.0, 2.0), None);
        // The star's azimuth is at the top.
        assert!(camera.direction(0.0, 0.9, 2.0).unwrap().dot(camera.sun()) > 0.0);
        // Turned level, it has the sky at the top and what lies below at the bottom.
        let level = Camera { pitch: 0.0, ..camera };
        assert!(level.direction(0.0, 0.9, 2.0).unwrap().y > 0.9);
    }

    /// From two radii up, the planet's limb lies inside the picture and its disc fills most of it.
    #[test]
    fn the_planet_fits_the_orbit_picture() {
        let camera = Camera::usual(Kind::Orbit, [1e6, 1.05e6]);
        let limb = libm::asin(1.05 / 3.0).to_degrees();
        assert!(camera.field > 2.0 * limb && camera.field < 2.5 * limb);
    }
}
