//! What a preset means, in numbers: for people as a table, for machines as JSON.

use crate::medium::{Constituent, DensityProfile, Medium};
use crate::preset::{Planet, Substance};
use serde_json::{Value, json};

/// Vertical optical depth of a constituent at each wavelength: scattering and absorption.
fn depths(c: &Constituent, height: f64) -> (Vec<f64>, Vec<f64>) {
    let column = c.density.column(0.0, height);
    let times = |v: &Vec<f64>| v.iter().map(|x| x * column).collect();
    (times(&c.scattering), times(&c.absorption))
}

/// The resolved preset, its hash and its physics at some wavelengths.
pub(super) fn as_json(planet: &Planet, wavelengths: &[f64]) -> String {
    let medium = planet.medium(wavelengths);
    let height = planet.height();
    let constituent = |c: &Constituent| -> Value {
        let (scattering, absorption) = depths(c, height);
        json!({
            "name": c.name,
            "column_m": c.density.column(0.0, height),
            "scale_height_m": scale_height(&c.density, height),
            "optical_depth_scattering": scattering,
            "optical_depth_absorption": absorption,
            "mean_cosine": c.phase.iter().map(|p| p.mean_cosine()).collect::<Vec<_>>(),
        })
    };
    let report = json!({
        "preset": planet.resolved(),
        "hash": planet.hash(),
        "physics": {
            "wavelengths_nm": wavelengths,
            "irradiance_w_m2_nm": planet.star.irradiance.at_all(wavelengths),
            "ground_albedo": medium.ground_albedo,
            "optical_depth": medium.vertical_optical_depth(),
            "constituents": medium.constituents.iter().map(constituent).collect::<Vec<_>>(),
        },
    });
    format!("{report:#}\n")
}

/// The same for reading.
pub(super) fn as_text(planet: &Planet, wavelengths: &[f64]) -> String {
    let medium = planet.medium(wavelengths);
    let mut out = format!("{}: {}\n", planet.name, planet.description);
    out.push_str(&format!(
        "ground {:.3} km, top {:.3} km over it; star {:.4e} m away, {:.4}° in radius; hash {}\n\n",
        planet.ground_radius / 1e3,
        planet.height() / 1e3,
        planet.star.distance,
        planet.star.angular_radius.to_degrees(),
        &planet.hash()[..16],
    ));
    out.push_str(&row("wavelength, nm", wavelengths.iter().map(|w| format!("{w}"))));
    out.push_str(&row("irradiance, W/(m² nm)", numbers(&planet.star.irradiance.at_all(wavelengths))));
    out.push_str(&row("ground albedo", numbers(&medium.ground_albedo)));
    for (substance, c) in planet.constituents.iter().zip(&medium.constituents) {
        out.push_str(&about(substance, c, planet.height()));
    }
    out.push_str(&total(&medium));
    planet.warnings.iter().for_each(|w| out.push_str(&format!("warning: {w}\n")));
    out
}

fn about(substance: &Substance, c: &Constituent, height: f64) -> String {
    let (scattering, absorption) = depths(c, height);
    let mut out = format!(
        "\n{} ({:?}, {}, density factor {})\n",
        c.name,
        c.role,
        profile(&substance.profile, height),
        substance.density_factor
    )
    .to_lowercase();
    out.push_str(&row("  vertical optical depth", sums(&scattering, &absorption)));
    if absorption.iter().any(|&a| a > 0.0) {
        let albedo = scattering.iter().zip(&absorption).map(|(s, a)| format!("{:.4}", s / (s + a)));
        out.push_str(&row("  single-scattering albedo", albedo));
    }
    if c.scatters() {
        let cosines: Vec<f64> = c.phase.iter().map(|p| p.mean_cosine()).collect();
        out.push_str(&row("  mean cosine", cosines.iter().map(|v| format!("{v:.4}"))));
    }
    out
}

fn total(medium: &Medium) -> String {
    format!("\n{}", row("total optical depth", numbers(&medium.vertical_optical_depth())))
}

fn profile(profile: &DensityProfile, height: f64) -> String {
    let km = |v: &f64| v / 1e3;
    let scale_height = scale_height(profile, height) / 1e3;
    match profile {
        DensityProfile::Exponential { scale_height } => format!("scale height {} km", km(scale_height)),
        DensityProfile::Tent { bottom, centre, top } => {
            format!("tent {}–{}–{} km", km(bottom), km(centre), km(top))
        }
        DensityProfile::Layer { bottom, top } => format!("layer {}–{} km", km(bottom), km(top)),
        DensityProfile::Linear { nodes } => {
            format!("table of {}, scale height {scale_height:.4} km", nodes.len())
        }
        DensityProfile::LogLinear { nodes } => {
            format!("log table of {}, scale height {scale_height:.4} km", nodes.len())
        }
    }
}

/// Scale height of an exponential profile, m; of others their column over their largest density, which is the same
/// thing where the top is far above.
fn scale_height(profile: &DensityProfile, height: f64) -> f64 {
    let largest = match profile {
        DensityProfile::Exponential { scale_height } => return *scale_height,
        DensityProfile::Tent { .. } | DensityProfile::Layer { .. } => 1.0,
        DensityProfile::Linear { nodes } | DensityProfile::LogLinear { nodes } => {
            nodes.iter().map(|n| n.1).fold(0.0, f64::max)
        }
    };
    if largest > 0.0 { profile.column(0.0, height) / largest } else { 0.0 }
}

fn sums(a: &[f64], b: &[f64]) -> impl Iterator<Item = String> {
    numbers(&a.iter().zip(b).map(|(a, b)| a + b).collect::<Vec<_>>()).collect::<Vec<_>>().into_iter()
}

fn numbers(values: &[f64]) -> impl Iterator<Item = String> + '_ {
    values.iter().map(|v| if *v == 0.0 || v.abs() >= 1e-3 { format!("{v:.5}") } else { format!("{v:.2e}") })
}

fn row(name: &str, cells: impl Iterator<Item = String>) -> String {
    let cells: String = cells.map(|c| format!(" {c:>10}")).collect();
    format!("{name:26}{cells}\n")
}
