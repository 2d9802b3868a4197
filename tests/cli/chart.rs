//! `tyndall chart` as a process.

use std::process::{Command, Output};

/// The chart of a planet of gas alone: its truth is soon solved.
fn chart(folder: &std::path::Path, only: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tyndall"));
    command.arg("chart").arg(super::run::gas(folder.parent().unwrap()));
    command.args(["--views", "3", "--only", only, "--json", "--quiet"]);
    command.arg("--out").arg(folder).output().unwrap()
}

/// Three settings of one method: a row each in all five regions, with a header that names what it holds, and pictures of
/// the stated kinds; nothing else is left. Single scattering is too dark by day, so its errors are not 0.
#[test]
fn a_chart_is_csv_svg_and_png() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("charts");
    let out = chart(&folder, "Nishita");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let mut reader = csv::Reader::from_path(folder.join("gas.csv")).unwrap();
    let header = reader.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|h| h == name).unwrap();
    let (region, error) = (column("region"), column("radiance_median"));
    let rows: Vec<_> = reader.records().map(|r| r.unwrap()).collect();
    assert_eq!(rows.len(), 15);
    let by_day: Vec<f64> =
        rows.iter().filter(|r| &r[region] == "day").map(|r| r[error].parse().unwrap()).collect();
    assert!(by_day.len() == 3 && by_day.iter().all(|e| *e > 0.02 && *e < 1.0), "{by_day:?}");
    let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
    assert!(read("gas.svg").starts_with(b"<svg") && read("gas.png").starts_with(b"\x89PNG"));
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 4, "csv, checks, svg, png");
    let json: serde_json::Value = serde_json::from_slice(&out.stdout).unwrap();
    assert_eq!(json["fronts"].as_array().unwrap().len(), 15);
    assert_eq!(
        json["not_dominated"].as_array().unwrap().len(),
        9,
        "none of ours is there: 3 settings × 3 costs"
    );
}

/// A name that no method has is bad input, and says which.
#[test]
fn unknown_methods_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let out = chart(&dir.path().join("charts"), "Hosek");
    assert_eq!(out.status.code(), Some(2));
}
