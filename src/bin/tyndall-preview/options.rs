//! The command line.

use crate::bake::{Bake, Layout};
use crate::camera::{Camera, Kind};
use crate::exposure::{Exposure, factor};
use crate::frame::{ToneMapping, View};
use crate::painter::Look;
use crate::resources::Method;
use crate::sea::USUAL_DEPTH;
use std::path::PathBuf;
use tyndall::{Error, Result};

/// Draws a bake: in a window, or with --headless to a PNG.
#[derive(clap::Parser)]
#[command(name = "tyndall-preview", version)]
#[command(
    before_help = "Example: tyndall bake earth && tyndall-preview out/earth --headless --out sky.png --sun 5"
)]
#[command(after_help = crate::controls::HELP)]
pub struct Options {
    /// Folder of a bake, or its bake.json
    pub bake: PathBuf,
    /// Layout of the tables; compact where the bake has it
    #[arg(long)]
    pub layout: Option<Layout>,
    /// Draw one picture without a window
    #[arg(long)]
    pub headless: bool,
    /// Picture to write, PNG
    #[arg(long, value_name = "PNG", requires = "headless", value_parser = picture)]
    pub out: Option<PathBuf>,
    #[arg(long, default_value = "ground")]
    pub camera: Kind,
    /// Height of the observer over the ground, m
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = altitude)]
    pub altitude: Option<f64>,
    /// Elevation of the star at the observer, degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 30.0, allow_hyphen_values = true, value_parser = angle)]
    pub sun: f64,
    /// Heading of the camera, degrees clockwise from the star's azimuth
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, allow_hyphen_values = true, value_parser = heading)]
    pub azimuth: f64,
    /// The camera's angle above the horizontal, degrees
    #[arg(long, value_name = "DEGREES", allow_hyphen_values = true, value_parser = angle)]
    pub pitch: Option<f64>,
    /// Field of view from the lower to the upper edge, degrees
    #[arg(long, value_name = "DEGREES", value_parser = field)]
    pub field: Option<f64>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size)]
    pub size: [u32; 2],
    /// auto, auto+STOPS, auto-STOPS, or an exposure value at ISO 100
    #[arg(long, default_value = "auto")]
    pub exposure: Exposure,
    #[arg(long, default_value = "neutral")]
    pub tone_mapping: ToneMapping,
    /// g of Cornette and Shanks for the aerosol of layout elek2010, in place of the table's phase function
    #[arg(long, value_name = "G", allow_hyphen_values = true, value_parser = asymmetry)]
    pub g: Option<f64>,
    /// A water of the bake, by its name, where the ground is
    #[arg(long, value_name = "NAME")]
    pub water: Option<String>,
    /// Depth of the water, m [default: 10, or its tables' largest]
    #[arg(long, value_name = "M", requires = "water", allow_hyphen_values = true)]
    pub depth: Option<f64>,
    /// Terrain around the observer, seen through the air
    #[arg(long)]
    pub relief: bool,
    /// Show terrain by the plain difference of two look-ups, whose weakness near the horizon is else mended
    #[arg(long, requires = "relief")]
    pub bare_difference: bool,
    /// Where the light comes from; table unless said otherwise, with --bench all in turn
    #[arg(long)]
    pub method: Option<MethodName>,
    /// Steps of a march along the view and towards the sun
    #[arg(long, value_name = "VIEWxSUN", default_value = "64x16", value_parser = size)]
    pub steps: [u32; 2],
    /// Print times and memory of a frame, by tables and by marches, and their ratio
    #[arg(long, conflicts_with = "points")]
    pub bench: bool,
    /// Frames that --bench takes times of
    #[arg(long, default_value_t = 200, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub frames: u32,
    /// Print what the shaders answer to the views of a CSV file, as tyndall sample does
    #[arg(long, value_name = "CSV", conflicts_with = "headless")]
    pub points: Option<PathBuf>,
    /// Weigh texels in the shader, to the last digit, and not in the texture units
    #[arg(long)]
    pub hand_filtered: bool,
    /// For tests: the device is lost before the first picture, or after the first frame of a window
    #[arg(long, hide = true)]
    pub lose_device: bool,
}

/// Where the light of a frame comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum MethodName {
    /// The tables of the bake, all orders of scattering
    Table,
    /// The march of Nishita et al. 1993: light scattered once, marched towards the sun from every step
    March,
    /// The same with a 2D table of optical depth towards the sun (O'Neil 2004)
    March2d,
}

fn number(text: &str, low: f64, high: f64) -> Result<f64> {
    match text.parse() {
        Ok(v) if (low..=high).contains(&v) => Ok(v),
        _ => Err(format!("must be a number between {low} and {high}").into()),
    }
}

/// A name of a picture that can be written: one that ends in .png, or in nothing.
fn picture(text: &str) -> Result<PathBuf> {
    let path = PathBuf::from(text);
    match path.extension() {
        Some(kind) if !kind.eq_ignore_ascii_case("png") => {
            let better = path.with_extension("png");
            Err(format!("only PNG can be written: name it {}", better.display()).into())
        }
        _ => Ok(path),
    }
}

fn altitude(text: &str) -> Result<f64> {
    number(text, 0.0, 1e12)
}

fn angle(text: &str) -> Result<f64> {
    number(text, -90.0, 90.0)
}

fn heading(text: &str) -> Result<f64> {
    number(text, -360.0, 360.0)
}

fn field(text: &str) -> Result<f64> {
    number(text, 0.01, 170.0)
}

fn asymmetry(text: &str) -> Result<f64> {
    number(text, -0.99, 0.99)
}

fn size(text: &str) -> std::result::Result<[u32; 2], String> {
    let side = |text: &str| text.parse::<u32>().ok().filter(|n| (1..=1 << 15).contains(n));
    match text.split_once('x').map(|(w, h)| (side(w), side(h))) {
        Some((Some(width), Some(height))) => Ok([width, height]),
        _ => Err("must be WIDTHxHEIGHT, each from 1 to 32768".into()),
    }
}

impl Options {
    /// # Errors
    /// `Argument` for a march in a layout that does not hold what it needs.
    pub fn method(&self, bake: &Bake) -> Result<Method> {
        let method = self.method.unwrap_or(MethodName::Table);
        if method != MethodName::Table && bake.layout != Layout::Compact {
            return Err(Error::Argument("--method: a march needs layout compact".into()));
        }
        let [view, sun] = self.steps;
        Ok(match method {
            MethodName::Table => Method::Table,
            MethodName::March => Method::March { view, sun },
            MethodName::March2d => Method::March { view, sun: 0 },
        })
    }

    /// What draws the frame.
    pub fn look(&self, bake: &Bake, format: wgpu::TextureFormat) -> Result<Look> {
        let relief = self.relief.then_some(self.size);
        if relief.is_some() && self.camera != Kind::Ground {
            return Err(Error::Argument("--relief: wants --camera ground".into()));
        }
        Ok(Look { method: self.method(bake)?, hand_filtered: self.hand_filtered, format, relief })
    }

    /// Depth of the water, m.
    ///
    /// # Errors
    /// `Argument` for one that the water's tables do not hold.
    pub fn depth(&self, bake: &Bake) -> Result<f64> {
        let Some(water) = &bake.water else { return Ok(USUAL_DEPTH) };
        let most = water.sky.largest_depth;
        let depth = self.depth.unwrap_or(USUAL_DEPTH.min(most));
        if (0.0..=most).contains(&depth) {
            return Ok(depth);
        }
        Err(Error::Argument(format!("--depth {depth}: the tables of {} hold 0 to {most} m", water.name)))
    }

    /// The frame that the options ask for.
    pub fn view(&self, bake: &Bake) -> Result<View> {
        if self.g.is_some() && bake.layout != Layout::Elek2010 {
            return Err(Error::Argument("--g: only layout elek2010 has the phase function apart".into()));
        }
        let radii = bake.radii();
        let mut camera = Camera::usual(self.camera, radii);
        camera.altitude = self.altitude.unwrap_or(camera.altitude);
        camera = camera.framed(radii);
        camera.heading = self.azimuth;
        camera.sun_elevation = self.sun;
        camera.pitch = self.pitch.unwrap_or(camera.pitch);
        camera.field = self.field.unwrap_or(camera.field);
        let aspect = f64::from(self.size[0]) / f64::from(self.size[1]);
        let water_depth = self.depth(bake)?;
        let exposure = factor(self.exposure, bake, &camera, aspect, water_depth);
        let horizon_mended = !self.bare_difference;
        Ok(View {
            camera,
            size: self.size,
            exposure,
            tone_mapping: self.tone_mapping,
            horizon_mended,
            g: self.g,
            water_depth,
        })
    }
}
