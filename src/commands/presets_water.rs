//! What a preset of water means, in numbers.

use crate::preset::Water;
use crate::transport::slab::{Layer, Light, Slab, Streams, Surface, WaterOrders, leaving};
use serde_json::{Value, json};
use std::f64::consts::PI;

/// Physics of a water at wavelengths.
struct Physics {
    absorption: Vec<f64>,
    scattering: Vec<f64>,
    backscattering: Vec<f64>,
    /// Radiance straight up over irradiance, both just above the surface, of water without end, sun at 30° from
    /// the zenith and no sky, 1/sr.
    reflectance: Vec<f64>,
}

fn physics(water: &Water, wavelengths: &[f64]) -> Physics {
    const MU_S: f64 = 0.866_025_403_784_438_6;
    let medium = water.medium(wavelengths);
    let all = |f: &dyn Fn(usize) -> f64| (0..wavelengths.len()).map(f).collect::<Vec<f64>>();
    Physics {
        absorption: medium.absorption.clone(),
        scattering: all(&|w| medium.scattering(w)),
        backscattering: all(&|w| medium.scattering(w) * backwards(|nu| medium.phase(w, nu))),
        reflectance: all(&|w| {
            let slab = Slab::new(&medium, w, Surface { n: medium.refractive_index[w] }, Streams::TABLES);
            let layer = Layer::new(&slab, 1e5);
            leaving(&medium, w, &layer, 1.0, Light::sun(MU_S, 1.0), WaterOrders::All)[0]
        }),
    }
}

/// Share of light that a phase function sends backwards (midpoints).
fn backwards(phase: impl Fn(f64) -> f64) -> f64 {
    const STEPS: usize = 2000;
    (0..STEPS).map(|k| 2.0 * PI * phase(-(k as f64 + 0.5) / STEPS as f64) / STEPS as f64).sum()
}

/// The resolved preset, its hash and its physics at some wavelengths.
pub(super) fn as_json(water: &Water, wavelengths: &[f64]) -> String {
    let p = physics(water, wavelengths);
    let constituent = |s: &crate::preset::WaterSubstance| -> Value {
        json!({
            "name": s.name,
            "absorption_per_m": wavelengths.iter().map(|&w| s.absorption.at(w)).collect::<Vec<_>>(),
            "scattering_per_m": wavelengths.iter().map(|&w| s.scattering.at(w)).collect::<Vec<_>>(),
            "mean_cosine": wavelengths.iter().map(|&w| s.phase.at(w).mean_cosine()).collect::<Vec<_>>(),
        })
    };
    let report = json!({
        "preset": water.resolved(),
        "hash": water.hash(),
        "physics": {
            "wavelengths_nm": wavelengths,
            "refractive_index": water.refractive_index.at_all(wavelengths),
            "absorption_per_m": p.absorption,
            "scattering_per_m": p.scattering,
            "backscattering_per_m": p.backscattering,
            "seabed_albedo": water.seabed_albedo.at_all(wavelengths),
            "remote_sensing_reflectance_per_sr": p.reflectance,
            "constituents": water.substances.iter().map(constituent).collect::<Vec<_>>(),
        },
    });
    format!("{report:#}\n")
}

/// The same for reading.
pub(super) fn as_text(water: &Water, wavelengths: &[f64]) -> String {
    let p = physics(water, wavelengths);
    let row = |name: &str, cells: &[f64]| {
        let cells: String = cells
            .iter()
            .map(|v| match v.abs() {
                a if a == 0.0 || (1e-3..1e5).contains(&a) => format!(" {v:>10.5}"),
                _ => format!(" {v:>10.2e}"),
            })
            .collect();
        format!("{name:30}{cells}\n")
    };
    let mut out = format!("{}: {}\n", water.name, water.description);
    out.push_str(&format!("tables to {} m; hash {}\n\n", water.largest_depth, &water.hash()[..16]));
    out.push_str(&row("wavelength, nm", wavelengths));
    out.push_str(&row("refractive index", &water.refractive_index.at_all(wavelengths)));
    out.push_str(&row("absorption, 1/m", &p.absorption));
    out.push_str(&row("scattering, 1/m", &p.scattering));
    out.push_str(&row("backscattering, 1/m", &p.backscattering));
    out.push_str(&row("seabed albedo", &water.seabed_albedo.at_all(wavelengths)));
    out.push_str(&row("reflectance of deep water, 1/sr", &p.reflectance));
    for s in &water.substances {
        let at = |f: &dyn Fn(f64) -> f64| wavelengths.iter().map(|&w| f(w)).collect::<Vec<_>>();
        out.push_str(&format!("\n{}\n", s.name));
        out.push_str(&row("  absorption, 1/m", &at(&|w| s.absorption.at(w))));
        out.push_str(&row("  scattering, 1/m", &at(&|w| s.scattering.at(w))));
        if wavelengths.iter().any(|&w| s.scattering.at(w) > 0.0) {
            out.push_str(&row("  mean cosine", &at(&|w| s.phase.at(w).mean_cosine())));
        }
    }
    water.warnings.iter().for_each(|w| out.push_str(&format!("warning: {w}\n")));
    out
}
