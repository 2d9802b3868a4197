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
