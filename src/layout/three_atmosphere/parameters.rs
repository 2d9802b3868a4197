//! `parameters.json`: what the package has to know besides the tables, by the names of its own
//! `AtmosphereParameters`, whose constructor takes the parsed object as it is.

use super::Bruneton;
use super::LUMINANCE_UNIT;
use crate::colour::weights::ColourWeights;
use crate::error::{Error, Result};
use crate::medium::{Medium, Role};
use crate::preset::Planet;
use crate::spectrum::{multiply, weighted};
use serde_json::{Value, json};

/// Spectra as the package sees them: weighted by the star's light for each component of RGB.
pub(super) struct Colours {
    weights: Vec<[f64; 3]>,
    /// What the weights make of a spectrum of 1.
    one: [f64; 3],
    /// The star's light, RGB in lx.
    pub star_lx: [f64; 3],
    pub ground_albedo: [f64; 3],
}

impl Colours {
    pub(super) fn new(medium: &Medium, palette: &ColourWeights) -> Self {
        let weights = palette.rgb_weights();
        let one = weighted(&weights, &vec![1.0; weights.len()]);
        let star_lx = multiply(&palette.rgb.from_xyz, palette.star_xyz);
        let mut colours = Colours { weights, one, star_lx, ground_albedo: [0.0; 3] };
        colours.ground_albedo = colours.mean(&medium.ground_albedo);
        colours
    }

    fn mean(&self, values: &[f64]) -> [f64; 3] {
        let sum = weighted(&self.weights, values);
        std::array::from_fn(|c| (sum[c] / self.one[c]).max(0.0))
    }
}

/// The text of the file. Coefficients are those at the ground, weighted by the star's light as each component of RGB
/// sees it: the package uses their ratios alone, and only without `single_mie_scattering.exr`.
pub(super) fn text(
    planet: &Planet,
    medium: &Medium,
    palette: &ColourWeights,
    mapping: &Bruneton,
    g: f64,
    scale: f64,
) -> Result<String> {
    let colours = Colours::new(medium, palette);
    let at_ground = |role: Role, value: &dyn Fn(usize, usize) -> f64| {
        let of = |w: usize| {
            let those = (0..medium.constituents.len()).filter(|&c| medium.constituents[c].role == role);
            those.map(|c| value(c, w) * medium.constituents[c].density.at(0.0)).sum::<f64>()
        };
        // Per km, the package's own unit of length.
        colours.mean(&(0..palette.weights.len()).map(of).collect::<Vec<_>>()).map(|v| 1e3 * v)
    };
    let scattering = |c: usize, w: usize| medium.constituents[c].scattering[w];
    let extinction = |c: usize, w: usize| medium.constituents[c].extinction(w);
    let albedo = colours.ground_albedo;
    let sky = 1.0 / (scale * LUMINANCE_UNIT);
    let [bottom, top] = mapping.shell().radii();
    let parameters = json!({
        "bottomRadius": bottom,
        "topRadius": top,
        "sunAngularRadius": planet.star.angular_radius,
        "solarIrradiance": vector(colours.star_lx.map(|v| v / LUMINANCE_UNIT)),
        "rayleighScattering": vector(at_ground(Role::Gas, &scattering)),
        "mieScattering": vector(at_ground(Role::Aerosol, &scattering)),
        "mieExtinction": vector(at_ground(Role::Aerosol, &extinction)),
        "miePhaseFunctionG": g,
        "groundAlbedo": { "r": albedo[0], "g": albedo[1], "b": albedo[2] },
        "muSMin": mapping.mu_s_min(),
        "sunRadianceToLuminance": vector([1.0; 3]),
        "skyRadianceToLuminance": vector([sky; 3]),
    });
    let text = serde_json::to_string_pretty(&parameters)
        .map_err(|e| Error::Argument(format!("{}: parameters.json: {e}", planet.name)))?;
    Ok(text + "\n")
}

fn vector([x, y, z]: [f64; 3]) -> Value {
    json!({ "x": x, "y": y, "z": z })
}
