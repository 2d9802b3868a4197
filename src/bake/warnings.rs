//! What the quality report says that a user must hear: tables or a medium that miss the planet's own day, and colours
//! that miss its own.

use crate::colour::weights::{ColourError, ColourWeights};
use crate::layout::{self, Layout};
use serde_json::{Map, Value};

/// Error of a layout's tables on 95 % of the views by day, or of those near the horizon by day, above which the bake
/// warns: five times that of the paper's.
const TABLES_WARNING: f64 = 0.3;
/// Median error by day of the paper's layout against the preset's own medium above which the bake warns.
const MEDIUM_WARNING: f64 = 0.25;
/// The regions of the report that are day.
const DAY: [&str; 2] = ["day", "horizon by day"];

/// Between these, nm, there is neither blue nor red: wavelengths that span what eyes see lie on both sides.
const GREEN: [f64; 2] = [500.0, 580.0];
/// ΔE2000 on one held-out sky in twenty above which the bake warns: 1 is just visible, shipped planets have 1.3.
const COLOUR_WARNING: f64 = 3.0;

/// A warning where the wavelengths, or the four that tables keep of them, do not span what eyes see, or where the four
/// give other colours than all.
pub(super) fn colours(palette: &ColourWeights) -> Option<String> {
    let four = palette.four_nm();
    if four.len() < 3 {
        return None; // Too few for any colour, of which the bake warns.
    }
    if !spans(&palette.wavelengths_nm) {
        let [low, high] = ends(&palette.wavelengths_nm);
        return Some(format!(
            "wavelengths from {low} to {high} nm do not span what eyes see: colours need one below {} nm and one above \
             {} nm, and those of this bake are guessed",
            GREEN[0], GREEN[1]
        ));
    }
    let list = four.iter().map(|nm| format!("{nm:.0}")).collect::<Vec<_>>().join(", ");
    let which = format!("the four wavelengths of the tables ({list} nm)");
    let (of_four, of_all) = (&palette.four_error, &palette.error);
    if !spans(&four) {
        return Some(format!("{which} do not span what eyes see: {}", felt(of_four)));
    }
    let which = if of_four.p95 >= of_all.p95 { which } else { "the wavelengths".to_string() };
    let worse = if of_four.p95 >= of_all.p95 { of_four } else { of_all };
    (worse.p95 > COLOUR_WARNING)
        .then(|| format!("{which} do not hold all colours of this planet: {}", felt(worse)))
}

fn felt(error: &ColourError) -> String {
    if error.median.is_nan() {
        return "no sky of this planet tells by how much colours are off".to_string();
    }
    format!(
        "colours are off by a ΔE2000 of {:.1} in the median and of {:.1} on one sky in twenty (1 is just visible)",
        error.median, error.p95
    )
}

fn ends(nm: &[f64]) -> [f64; 2] {
    [nm.iter().copied().fold(f64::INFINITY, f64::min), nm.iter().copied().fold(0.0, f64::max)]
}

fn spans(nm: &[f64]) -> bool {
    let ([low, high], [blue, red]) = (ends(nm), GREEN);
    low < blue && high > red
}

/// Warnings where the tables of a layout are so coarse that they miss the light of their own medium by day, and where the
/// medium of the paper is not the planet's.
pub(super) fn tables(quality: &Map<String, Value>) -> Vec<String> {
    let warning = |layout: &dyn Layout| {
        let of = |region: &str| {
            let found = quality.get(layout.report_key())?.get(region)?;
            found.get("rgb").unwrap_or(found)["p95"].as_f64()
        };
        let worst = DAY.into_iter().filter_map(of).fold(0.0, f64::max);
        (worst > TABLES_WARNING).then(|| coarse(layout, worst))
    };
    let mut out: Vec<String> = layout::ALL.into_iter().filter_map(warning).collect();
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
pub(super) fn underwater(quality: &Map<String, Value>) -> Vec<String> {
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

fn coarse(layout: &dyn Layout, error: f64) -> String {
    let percent = if error < 100.0 { format!("{:.0} %", 100.0 * error) } else { "any measure".into() };
    let remedy = layout.remedy();
    let name = layout.name();
    format!("layout {name}: one in twenty views by day is off by more than {percent}; {remedy}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// A layout whose tables miss the day is warned of by its name, whichever it is; a good one is not.
    #[test]
    fn every_layout_is_judged() {
        for layout in layout::ALL {
            let report = |p95: f64| {
                let error = json!({ "p95": p95 });
                let regions = if layout.name() == "compact" {
                    json!({ "day": { "rgb": error } })
                } else {
                    json!({ "day": error })
                };
                let mut quality = Map::new();
                quality.insert(layout.report_key().into(), regions);
                tables(&quality)
            };
            let told = report(0.5);
            assert!(told.len() == 1 && told[0].contains(&format!("layout {}: ", layout.name())), "{told:?}");
            assert!(told[0].contains("more than 50 %"), "{told:?}");
            assert!(report(0.1).is_empty());
        }
    }
}
