//! What a planet or its tables lose is told: in bake.json and on stderr, with key, value and cost.

use super::run::{bake, manifest, ran, small_bake};
use serde_json::Value;

fn warnings(manifest: &Value) -> Vec<String> {
    let list = manifest["warnings"].as_array().unwrap();
    list.iter().map(|w| w.as_str().unwrap().to_string()).collect()
}

/// A top that cuts off air and a cloud thinner than the tables' altitudes are apart: a line each, in the manifest and on
/// stderr alike.
#[test]
fn a_bake_tells_what_it_loses() {
    let dir = tempfile::tempdir().unwrap();
    let cloud = r#"constituents.aerosol.profile={"kind":"layer","bottom_km":5,"top_km":5.2}"#;
    let set = ["--set", "top.height_km=10", "--set", cloud];
    let mut command = small_bake("earth-paper", dir.path(), &set);
    let arguments: Vec<_> = command.get_args().filter(|a| *a != "--quiet").map(|a| a.to_owned()).collect();
    command = super::run::command();
    let done = ran(command.args(arguments).output().unwrap());
    assert_eq!(done.code, Some(0), "{}", done.err);
    let told = warnings(&manifest(&dir.path().join("earth-paper")));
    for parts in [
        ["top.height_km = 10: it cuts off 28.7 %", "constituents.air.profile"],
        ["200 m thick", "layout compact"],
    ] {
        let lines: Vec<&String> = told.iter().filter(|w| parts.iter().all(|p| w.contains(p))).collect();
        assert_eq!(lines.len(), 1, "{parts:?}: {told:?}");
        assert!(done.err.contains(&format!("warning: earth-paper: {}", lines[0])), "{}", done.err);
    }
}

/// The report judges the tables for observers under a turbid water and says where they are worst; the bake warns of them.
/// Without those tables there is nothing to judge.
#[test]
fn tables_under_turbid_water_are_judged() {
    let dir = tempfile::tempdir().unwrap();
    let one = |folder: &str, more: &[&str]| manifest(&bake("earth-paper", &dir.path().join(folder), more));
    let found = one("under", &["--layout", "elek2010", "--waters", "muddy", "--underwater"]);
    let judged = &found["quality"]["water"]["muddy"]["underwater_tables_against_solver"];
    let [median, p95, max] = ["median", "p95", "max"].map(|key| judged[key].as_f64().unwrap());
    assert!(median <= p95 && 0.3 < p95 && p95 <= max && judged["count"].as_u64().unwrap() > 100, "{judged}");
    let worst = &judged["worst"];
    let off = worst["tables"].as_f64().unwrap() / worst["solver"].as_f64().unwrap() - 1.0;
    assert!((off.abs() / max - 1.0).abs() < 0.02, "{judged}");
    assert!(worst["observer_depth_m"].as_f64() <= worst["depth_m"].as_f64(), "{judged}");
    let told = warnings(&found);
    assert_eq!(told.iter().filter(|w| w.starts_with("muddy: tables --underwater")).count(), 1, "{told:?}");
    let without = one("above", &["--layout", "elek2010", "--waters", "muddy"]);
    assert!(without["quality"]["water"]["muddy"]["underwater_tables_against_solver"].is_null());
    assert!(!without["warnings"].to_string().contains("--underwater"));
}
