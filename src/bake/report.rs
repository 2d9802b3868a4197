//! The quality report of a bake, its tables apart: what the solver says of itself, and colours.

use crate::colour::weights::ColourWeights;
use crate::layout::judge::{Truth, rgb_of};
use crate::medium::Medium;
use crate::quality::{DARK, Distribution, colour_error, digits};
use crate::spectrum::delta_e_2000_scaled;
use crate::transport::balance::balance;
use crate::transport::solve::{Orders, Solution, worst};
use serde_json::{Map, Value, json};

/// What the solver says of one medium: orders, residual, energy balance, and the spherical albedo per wavelength.
pub fn solver(medium: &Medium, solution: &Solution) -> Value {
    let residual = worst(&solution.report.residual);
    let mut out = Map::new();
    match solution.orders {
        Orders::Converged { .. } => {
            out.insert("orders".into(), json!("converged"));
            out.insert("applications".into(), json!(solution.report.applications));
            let balances = balance(solution, medium);
            let errors = balances.iter().map(|b| b.error());
            let worst = errors.fold(0.0, |a: f64, e| if e.abs() > a.abs() { e } else { a });
            out.insert("energy_balance_error".into(), json!(digits(worst)));
            let albedo: Vec<f64> = balances.iter().map(|b| digits(b.spherical_albedo())).collect();
            out.insert("spherical_albedo".into(), json!(albedo));
        }
        Orders::First(n) => {
            out.insert("orders".into(), json!(n));
        }
    }
    out.insert("residual".into(), json!(digits(residual)));
    Value::Object(out)
}

/// Colours of the weights: ΔE2000 on skies held out of their fits, and, where there is a truth to look at, what
/// four wavelengths lose in each region.
pub fn colours(palette: &ColourWeights, truths: Option<&[Truth]>) -> Value {
    let mut out = json!({
        "all_wavelengths_delta_e_2000": palette.error.json(),
        "four_wavelengths_delta_e_2000": palette.four_error.json(),
    });
    if let Some(truths) = truths {
        out["four_wavelengths_by_region"] = four_wavelengths(palette, truths);
    }
    out
}

/// What colour loses to the choice of four wavelengths, tables apart, by region of a medium's truth: relative
/// RGB and ΔE2000, against all wavelengths of the bake.
fn four_wavelengths(palette: &ColourWeights, truths: &[Truth]) -> Value {
    let mut out = Map::new();
    for truth in truths {
        let (mut relative, mut felt) = (Vec::new(), Vec::new());
        for (_, light) in truth.views.iter().filter(|(_, light)| light.iter().any(|&v| v > DARK)) {
            let (found, wanted) = (palette.xyz_of_four(light), palette.xyz(light));
            relative.push(colour_error(rgb_of(palette, found), rgb_of(palette, wanted)));
            felt.push(delta_e_2000_scaled(wanted, found));
        }
        let pair = json!({
            "rgb": Distribution::of(relative).json(),
            "delta_e_2000": Distribution::of(felt).json(),
        });
        out.insert(truth.region.to_string(), pair);
    }
    Value::Object(out)
}
