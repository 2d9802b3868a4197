//! `tyndall chart` as a process.

use std::process::{Command, Output};

fn chart(folder: &std::path::Path, only: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tyndall"));
    command.args(["chart", "earth-blog", "--views", "3", "--only", only, "--json", "--quiet"]);
    command.arg("--out").arg(folder).output().unwrap()
}

/// Three settings of one method: a row each in all five regions, with a header that names what it holds, and pictures of
/// the stated kinds; nothing else is left. Single scattering is too dark by day, so its errors are not 0.
#[test]
fn a_chart_is_csv_svg_and_png() {
    let folder = tempfile::tempdir().unwrap();
    let out = chart(folder.path(), "Nishita");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let mut reader = csv::Reader::from_path(folder.path().join("earth-blog.csv")).unwrap();
    let header = reader.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|h| h == name).unwrap();
    let (region, error) = (column("region"), column("radiance_median"));
    let rows: Vec<_> = reader.records().map(|r| r.unwrap()).collect();
    assert_eq!(rows.len(), 15);
    let by_day: Vec<f64> =
        rows.iter().filter(|r| &r[region] == "day").map(|r| r[error].parse().unwrap()).collect();
    assert!(by_day.len() == 3 && by_day.iter().all(|e| *e > 0.02 && *e < 1.0), "{by_day:?}");
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert!(read("earth-blog.svg").starts_with(b"<svg") && read("earth-blog.png").starts_with(b"\x89PNG"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 4, "csv, checks, svg, png");
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
    let folder = tempfile::tempdir().unwrap();
    let out = chart(folder.path(), "Hosek");
    assert_eq!(out.status.code(), Some(2));
}
