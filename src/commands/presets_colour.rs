//! The colours that a preset implies: of the zenith, by a quick solve, and of deep water.

use crate::error::Result;
use crate::geometry::Point;
use crate::geometry::view::View;
use crate::preset::{self, Planet, Water};
use crate::spectrum::{ColourSpace, chromaticity, grid, hat_weights, multiply, srgb_encode, weighted};
use crate::transport::slab::{Layer, Light, Slab, Streams, Surface, WaterOrders, leaving};
use crate::transport::solve::{LevelCounts, Orders, Resolution, Solution, worst};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::f64::consts::PI;

/// Heights of the sun over the horizon under which the zenith is looked at, degrees.
const ELEVATIONS: [f64; 2] = [60.0, 5.0];
/// Even wavelengths: one pass of the solver.
const WAVELENGTHS: usize = 15;
/// A quarter of the tables' work and less; colours move in the third digit.
const QUICK: Resolution = Resolution {
    levels: LevelCounts { coarse: 20, refinement: 1, cuts: 3 },
    zeniths: 10,
    first_azimuths: 8,
    azimuths: 4,
    sun_nodes: 32,
    sunlight_nodes: 96,
    degree: 4,
};
/// Share of the light that one more order may still change.
const TOLERANCE: f64 = 0.01;

/// A colour as numbers and as a screen would show it.
struct Colour {
    /// What it is the colour of.
    name: String,
    /// XYZ, Y in the unit of the list that the colour stands in.
    xyz: [f64; 3],
}

impl Colour {
    /// Linear sRGB over its largest component; all 0 where there is no light.
    fn linear(&self) -> [f64; 3] {
        let rgb = multiply(&ColourSpace::Srgb.from_xyz(), self.xyz);
        let largest = rgb.iter().fold(0.0, |a: f64, &b| a.max(b));
        if largest > 0.0 { rgb.map(|v| v / largest) } else { [0.0; 3] }
    }

    /// The same encoded, what is outside the gamut clipped: `#rrggbb`.
    fn hex(&self) -> String {
        let byte = |v: f64| (255.0 * srgb_encode(v)).round() as u8;
        let [r, g, b] = self.linear().map(byte);
        format!("#{r:02x}{g:02x}{b:02x}")
    }

    fn json(&self, of: &str, quantity: &str) -> Value {
        json!({ of: self.name, quantity: self.xyz[1], "xyz": self.xyz, "xy": chromaticity(self.xyz),
            "linear_srgb": self.linear(), "srgb": self.hex() })
    }

    fn line(&self) -> String {
        let [x, y] = chromaticity(self.xyz);
        let [r, g, b] = self.linear();
        let name = &self.name;
        let luminance = super::text::number(self.xyz[1]);
        format!(
            "  {name:24} {luminance:>12} {x:>7.4} {y:>7.4}   {r:>7.4} {g:>7.4} {b:>7.4}   {}\n",
            self.hex()
        )
    }
}

/// Colours under a title, for people and for machines.
pub(super) struct Colours {
    pub key: &'static str,
    pub json: Value,
    pub text: String,
}

fn head(title: &str, quantity: &str) -> String {
    format!("\n{title:26} {quantity:>12} {:>7} {:>7}   {:^23}   sRGB\n", "x", "y", "linear sRGB (largest 1)")
}

/// Colour of the zenith from the ground with the sun at some heights: light of all orders, without the sun's disc.
pub(super) fn zenith(planet: &Planet) -> Colours {
    let nm = grid(WAVELENGTHS);
    let medium = planet.medium(&nm);
    let solution = Solution::new(&medium, &QUICK, Orders::Converged { tolerance: TOLERANCE });
    let weights = hat_weights(&nm, &planet.star.irradiance);
    let all: Vec<usize> = (0..medium.constituents.len()).collect();
    let colour = |elevation: &f64| {
        let mu_s = libm::sin(elevation.to_radians());
        let up = Point { altitude: 0.0, mu: 1.0, mu_s, azimuth_deg: 0.0 };
        let view = View::enter(&up, medium.ground_radius, medium.top_radius);
        let light = view.map(|view| solution.radiance(&view, &all).scattering);
        let xyz = light.map_or([0.0; 3], |light| weighted(&weights, &light));
        Colour { name: format!("sun at {elevation}°"), xyz }
    };
    let colours: Vec<Colour> = ELEVATIONS.iter().map(colour).collect();
    let residual = worst(&solution.report.residual);
    let entries = colours.iter().zip(ELEVATIONS).map(|(c, elevation)| {
        let mut entry = c.json("view", "luminance_cd_m2");
        entry["view"] = json!("zenith from the ground");
        entry["sun_elevation_deg"] = json!(elevation);
        entry
    });
    let json = json!({
        "colours": entries.collect::<Vec<_>>(),
        "orders": "all",
        "wavelengths": WAVELENGTHS,
        "residual": residual,
    });
    let mut text = head("zenith from the ground", "cd/m²");
    colours.iter().for_each(|c| text.push_str(&c.line()));
    text.push_str(&format!(
        "  (a quick solve at {WAVELENGTHS} wavelengths: all orders of scattering, of which one more would change \
         {:.2} % at most)\n",
        100.0 * residual
    ));
    Colours { key: "zenith", json, text }
}

/// Colour of water without a bottom, straight from above, in the light of the shipped sun 30° from the zenith and
/// without a sky: Y is that of a white Lambertian surface in the same light times what is given.
pub(super) fn deep_water(water: &Water) -> Result<Colours> {
    const MU_S: f64 = 0.866_025_403_784_438_6;
    /// Deep enough for the clearest water, m.
    const DEEP: f64 = 1e5;
    let nm = grid(WAVELENGTHS);
    let medium = water.medium(&nm);
    let weights = hat_weights(&nm, &preset::load("earth", &[])?.star.irradiance);
    let of = |w: usize| {
        let slab = Slab::new(&medium, w, Surface { n: medium.refractive_index[w] }, Streams::TABLES);
        let light = Light::sun(MU_S, 1.0);
        PI * leaving(&medium, w, &Layer::new(&slab, DEEP), 1.0, light, WaterOrders::All)[0]
    };
    let reflectance: Vec<f64> = (0..nm.len()).into_par_iter().map(of).collect();
    let white = weighted(&weights, &vec![1.0; nm.len()])[1];
    let xyz = weighted(&weights, &reflectance).map(|v| v / white);
    let colour = Colour { name: "straight down".into(), xyz };
    let mut json = colour.json("view", "reflectance");
    json["light"] = json!("the sun of earth without air, 30 degrees from the zenith");
    json["wavelengths"] = json!(WAVELENGTHS);
    let mut text = head("deep water in the sun", "reflectance");
    text.push_str(&colour.line());
    Ok(Colours { key: "deep_water", json, text })
}
