//! Baked tables against direct integration, through the bake's own report.

use serde_json::Value;
use tyndall::bake::bake;
use tyndall::bake::settings::Settings;
use tyndall::preset;
use tyndall::spectrum::grid;

/// 95th percentiles of relative radiance that the compact layout is made for, by region of the report: table steps
/// are a few per cent of a radiance, cubic nowhere, so an error of half a per cent by day is what the sizes were
/// chosen for, halves of logarithms (0.1 % to 0.4 %) included. A low sun has steeper gradients, and twilight fades
/// by a factor e per degree of the sun.
const COMPACT: [(&str, f64); 5] = [
    ("day", 0.006),
    ("low sun, 0 to 10 degrees", 0.013),
    ("twilight, 0 to -12 degrees", 0.08),
    ("horizon by day", 0.006),
    ("from space by day", 0.01),
];

/// The report of a bake of the paper's Earth at five wavelengths, all sizes as by default.
fn report() -> Value {
    let planet = preset::load("earth-paper", &[]).expect("a shipped preset");
    let settings = Settings { wavelengths_nm: grid(5), ..Settings::default() };
    bake(&planet, &settings, &mut |_| {}).expect("a bake").manifest.quality
}

#[test]
fn tables_of_the_papers_earth_are_close_to_direct_integration() {
    let quality = report();
    let compact = &quality["compact_against_direct_integration"];
    println!("{compact:#}");
    println!("{:#}", quality["elek2010_against_its_own_medium"]);
    println!("{:#} {:#}", quality["solver"], quality["paper_medium_solver"]);
    for (region, bound) in COMPACT {
        let p95 = compact[region]["per_wavelength"]["p95"].as_f64().expect(region);
        let count = compact[region]["per_wavelength"]["count"].as_u64().expect(region);
        assert!(count >= 100, "{region}: only {count} values");
        assert!(p95 <= bound, "{region}: {p95} is more than {bound}");
    }
    for solver in ["solver", "paper_medium_solver"] {
        let error = quality[solver]["energy_balance_error"].as_f64().expect(solver);
        assert!(error.abs() < 3e-3, "{solver}: {error}");
        assert!(quality[solver]["residual"].as_f64().expect(solver) < 1e-3);
    }
}
