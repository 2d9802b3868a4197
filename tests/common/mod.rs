//! Atmospheres and radiances of another maker: Monte Carlo with the Mitsuba kernel of eradiate-mitsuba 0.5.0
//! (integrator `volpath`, double precision), 66 points of view × 3 wavelengths for each of two atmospheres.

use serde_json::Value;
use std::path::PathBuf;
use tyndall::internals::geometry::Point;
use tyndall::internals::medium::{Constituent, DensityProfile, Medium, PhaseFunction, Role};

/// One radiance of the oracle: view, wavelength number in the medium, radiance and standard error, 1/sr.
#[derive(Clone, Copy, Debug)]
pub struct OracleRow {
    pub point: Point,
    pub wavelength: usize,
    pub radiance: f64,
    pub stderr: f64,
}

fn data(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

fn list(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|v| v.as_f64().expect("a number")).collect()
}

/// The atmosphere of the oracle `earth_clear` or `mars_thin`.
pub fn oracle_medium(name: &str) -> Medium {
    let text = std::fs::read_to_string(data(&format!("{name}.json"))).expect("test data");
    let json: Value = serde_json::from_str(&text).expect("JSON");
    let number = |v: &Value| v.as_f64().expect("a number");
    let wavelengths_nm = list(&json["wavelengths_nm"]);
    let n = wavelengths_nm.len();
    let ground_radius = number(&json["planet_radius_m"]);
    let g = number(&json["mie_phase"]["g"]);
    let exponential = |key: &str| DensityProfile::Exponential {
        scale_height: number(&json[format!("{key}_scale_height_m")]),
    };
    let mut constituents = vec![
        Constituent {
            name: "gas".into(),
            role: Role::Gas,
            density: exponential("rayleigh"),
            scattering: list(&json["rayleigh_scattering_per_m"]),
            absorption: vec![0.0; n],
            phase: vec![PhaseFunction::Rayleigh { king_factor: 1.0 }; n],
            similarity_g: vec![0.0; n],
        },
        Constituent {
            name: "aerosol".into(),
            role: Role::Aerosol,
            density: exponential("mie"),
            scattering: list(&json["mie_scattering_per_m"]),
            absorption: list(&json["mie_absorption_per_m"]),
            phase: vec![PhaseFunction::CornetteShanks { g }; n],
            similarity_g: vec![g; n],
        },
    ];
    if let Some(ozone) = json.get("ozone") {
        let (centre, half) = (number(&ozone["centre_m"]), number(&ozone["half_width_m"]));
        constituents.push(Constituent {
            name: "ozone".into(),
            role: Role::Gas,
            density: DensityProfile::Tent { bottom: centre - half, centre, top: centre + half },
            scattering: vec![0.0; n],
            absorption: list(&ozone["absorption_per_m"]),
            phase: vec![PhaseFunction::Isotropic; n],
            similarity_g: vec![0.0; n],
        });
    }
    let albedo = &json["albedo"];
    Medium {
        ground_radius,
        top_radius: ground_radius + number(&json["top_height_m"]),
        wavelengths_nm,
        ground_albedo: albedo.as_f64().map_or_else(|| list(albedo), |a| vec![a; n]),
        constituents,
    }
}

/// The oracle's radiances in the atmosphere of the same name.
pub fn oracle_rows(name: &str) -> Vec<OracleRow> {
    let wavelengths = oracle_medium(name).wavelengths_nm;
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .from_path(data(&format!("{name}_mitsuba.csv")))
        .expect("test data");
    let rows = reader.records().map(|r| {
        let record = r.expect("a CSV row");
        let v: Vec<f64> = record.iter().map(|f| f.parse().expect("a number")).collect();
        OracleRow {
            point: Point { altitude: v[0], mu: v[1], mu_s: v[2], azimuth_deg: v[3] },
            wavelength: wavelengths.iter().position(|w| *w == v[4]).expect("a wavelength of the medium"),
            radiance: v[5],
            stderr: v[6],
        }
    });
    rows.collect()
}

/// χ² per value of answers (radiance, standard error) against the oracle's rows. Rows with the sun at the
/// oracle's own noise floor carry their error bars, so they weigh what they should.
pub fn chi_square(rows: &[OracleRow], answers: &[(f64, f64)]) -> f64 {
    let sum: f64 = rows
        .iter()
        .zip(answers)
        .map(|(r, (radiance, stderr))| {
            let difference = radiance - r.radiance;
            difference * difference / (r.stderr * r.stderr + stderr * stderr)
        })
        .sum();
    sum / rows.len() as f64
}
