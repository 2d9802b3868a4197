//! What the quality report says that a user must hear: tables or a medium that miss the planet's own day.

use serde_json::{Map, Value};

/// Error of the tables of a layout on 95 % of views by day, or of those near the horizon by day, above which the bake warns: five times that of the paper's.
const TABLES_WARNING: f64 = 0.3;
/// Median error by day of the paper's layout against the preset's own medium above which the bake warns.
const MEDIUM_WARNING: f64 = 0.25;
/// The regions of the report that are day.
const DAY: [&str; 2] = ["day", "horizon by day"];

/// Warnings where the tables of a layout are so coarse that they miss the light of their own medium by day, and where the
/// medium of the paper is not the planet's.
pub fn tables(quality: &Map<String, Value>) -> Vec<String> {
    let own = [
        ("compact", "compact_against_direct_integration", Some("rgb")),
        ("elek2010", "elek2010_against_its_own_medium", None),
    ];
    let warning = |(layout, key, part): (&str, &str, Option<&str>)| {
        let of = |region: &str| {
            let found = quality.get(key)?.get(region)?;
            part.map_or(Some(found), |part| found.get(part))?["p95"].as_f64()
        };
        let worst = DAY.into_iter().filter_map(of).fold(0.0, f64::max);
        (worst > TABLES_WARNING).then(|| coarse(layout, worst))
    };
    let mut out: Vec<String> = own.into_iter().filter_map(warning).collect();
    let simplified =
        quality.get("elek2010_against_the_full_medium").and_then(|q| q["day"]["median"].as_f64());
    if let Some(error) = simplified.filter(|e| *e > MEDIUM_WARNING) {
        out.push(format!(
            "layout elek2010: its isotropic haze is not this planet's: half of the views by day are off by more than \
             {:.0} %; layout compact holds the medium as it is",
            100.0 * error
        ));
    }
    out
}

/// Warnings where the tables for observers under a water miss the water's own light.
pub fn underwater(quality: &Map<String, Value>) -> Vec<String> {
    let waters = quality.get("water").and_then(Value::as_object);
    let warning = |(name, found): (&String, &Value)| {
        let found = &found["underwater_tables_against_solver"];
        let [median, p95] = ["median", "p95"].map(|key| found[key].as_f64().unwrap_or(0.0));
        (p95 > TABLES_WARNING).then(|| {
            let worst = &found["worst"];
            format!(
                "{name}: tables --underwater: half of the views are off by more than {}, one in twenty by more than {}; most, \
                 by {}, at a depth of {} m of {} m and {} nm; `sample --exact` is right",
                percent(median),
                percent(p95),
                percent(found["max"].as_f64().unwrap_or(0.0)),
                worst["observer_depth_m"],
                worst["depth_m"],
                worst["nm"],
            )
        })
    };
    waters.into_iter().flatten().filter_map(warning).collect()
}

fn percent(error: f64) -> String {
    if error < 10.0 { format!("{:.0} %", 100.0 * error) } else { format!("{error:.0} times") }
}

fn coarse(layout: &str, error: f64) -> String {
    let percent = if error < 100.0 { format!("{:.0} %", 100.0 * error) } else { "any measure".into() };
    let besides = if layout == "elek2010" { ", and layout compact errs less" } else { "" };
    format!(
        "layout {layout}: one in twenty views by day is off by more than {percent}; --size takes larger tables{besides}"
    )
}
