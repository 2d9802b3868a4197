//! What a frame depends on, and its uniform.

use crate::bake::Bake;
use crate::camera::{Camera, Kind};
use crate::exposure::display_matrix;
use bytemuck::{Pod, Zeroable};
use glam::{DMat3, DVec3};

/// From light to what the display shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum ToneMapping {
    /// 1 − exp(−x) (O'Neil 2005), the paper's
    Paper,
    /// Khronos PBR neutral
    Neutral,
}

/// All that a frame depends on besides the bake.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    pub camera: Camera,
    pub size: [u32; 2],
    /// What 1 cd/m² becomes.
    pub exposure: f64,
    pub tone_mapping: ToneMapping,
    /// Whether terrain seen through air is mended near the horizon, see `aerial.wgsl`.
    pub horizon_mended: bool,
    /// Of the aerosol's phase function in `elek2010`; none: that of the table.
    pub g: Option<f64>,
    /// m; of the bake's water, where it has one.
    pub water_depth: f64,
}

/// `Frame` of `frame.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct FrameUniform {
    right: [f32; 4],
    up: [f32; 4],
    forward: [f32; 4],
    sun: [f32; 4],
    observer: [f32; 4],
    picture: [f32; 4],
    display: [[f32; 4]; 3],
    water: [f32; 4],
}

fn with(v: DVec3, w: f64) -> [f32; 4] {
    [v.x, v.y, v.z, w].map(|x| x as f32)
}

impl FrameUniform {
    pub fn altitude(&self) -> f32 {
        self.observer[0]
    }

    /// Cosine of the star's zenith angle.
    pub fn mu_s(&self) -> f32 {
        self.sun[1]
    }

    /// Upper rows of the picture in which a perspective from inside the shell shows sky alone, on a planet of these radii
    /// (m).
    pub fn rows_of_sky(&self, [ground, _]: [f64; 2]) -> u32 {
        let [width, height] = [self.picture[0], self.picture[1]].map(f64::from);
        if self.right[3] > 0.5 {
            return 0;
        }
        let altitude = f64::from(self.altitude());
        let horizon = -(altitude * (2.0 * ground + altitude)).sqrt() / (ground + altitude);
        let [right, up, forward] =
            [self.right, self.up, self.forward].map(|v| DVec3::new(v[0].into(), v[1].into(), v[2].into()));
        let tangent = f64::from(self.up[3]);
        // Within a row the height of a view rises or falls from the middle to both sides.
        let above = |row: &u32| {
            let y = 1.0 - (2.0 * f64::from(*row) + 1.0) / height;
            let view = |x: f64| (forward + (right * (x * width / height) + up * y) * tangent).normalize();
            [-1.0, 0.0, 1.0].iter().all(|x| view(*x).y > horizon + 1e-4)
        };
        (0..height as u32).take_while(above).count() as u32
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.picture[0] as u32, self.picture[1] as u32]
    }

    pub fn new(bake: &Bake, view: &View) -> Self {
        let camera = &view.camera;
        let [right, up, forward] = camera.axes();
        let [width, height] = view.size;
        let fisheye = f64::from(u8::from(camera.kind == Kind::Fisheye));
        let star = &bake.manifest.preset.resolved["star"];
        let radius = bake.constant("star_angular_radius_rad").unwrap_or(0.0);
        let limb = star["limb_darkening"].as_f64().unwrap_or(0.6);
        let tone = f64::from(u8::from(view.tone_mapping == ToneMapping::Neutral));
        let display: DMat3 = display_matrix(bake);
        FrameUniform {
            right: with(right, fisheye),
            up: with(up, libm::tan(0.5 * camera.field.to_radians())),
            forward: with(forward, view.g.unwrap_or(-2.0)),
            sun: with(camera.sun(), radius),
            observer: [camera.altitude, view.exposure, tone, limb].map(|v| v as f32),
            picture: [width.into(), height.into(), camera.pixel_angle(width, height), 0.0]
                .map(|v: f64| v as f32),
            display: [0, 1, 2].map(|k| with(display.row(k), f64::from(u8::from(view.horizon_mended)))),
            water: [view.water_depth as f32, 0.0, 0.0, 0.0],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A level camera on the ground has its horizon just below the middle row; one that looks down has no row of sky, one
    /// that looks up nothing else; a fisheye is not split.
    #[test]
    fn rows_of_sky_end_at_the_horizon() {
        let radii = [3e6, 3.1e6];
        let rows = |kind: Kind, pitch: f64, altitude: f64| {
            let camera = Camera { pitch, altitude, ..Camera::usual(kind, radii) };
            let [right, up, forward] = camera.axes();
            let mut frame = FrameUniform::zeroed();
            frame.right = with(right, f64::from(u8::from(kind == Kind::Fisheye)));
            frame.up = with(up, libm::tan(0.5 * camera.field.to_radians()));
            frame.forward = with(forward, 0.0);
            frame.observer[0] = altitude as f32;
            frame.picture = [400.0, 200.0, 0.0, 0.0];
            frame.rows_of_sky(radii)
        };
        assert_eq!(rows(Kind::Ground, 0.0, 0.0), 100);
        assert_eq!([rows(Kind::Ground, -60.0, 0.0), rows(Kind::Ground, 60.0, 0.0)], [0, 200]);
        assert_eq!(rows(Kind::Fisheye, 90.0, 0.0), 0);
        // From 30 km the horizon lies 8.05 degrees down: tan(8.05) / tan(30) of the half height, higher at the sides.
        let lower = rows(Kind::Ground, 0.0, 3e4);
        assert!((122..=125).contains(&lower), "{lower}");
    }
}
