//! What a planet's top loses of its air, in words.

use super::raw::Raw;
use super::read_coefficient::{AMOUNTS, UNITS};
use crate::error::Result;
use crate::medium::{Constituent, Cut, DensityProfile, Medium};

/// Share of a shell that holds nothing from which on it is told. Air of 8 km under tops of 80, 200 and 300 km (0.74 empty)
/// came out of usual tables alike; at 400, 600 and 800 km 5 % of views in twilight were off by 1.7, 3.6 and 8.4 times as much.
const EMPTY: f64 = 0.75;
/// Keys of a constituent that hold its coefficients.
const COEFFICIENTS: [&str; 3] = ["scattering", "absorption", "extinction"];

/// Warnings where the top cuts off air that is seen, and where most of the shell is empty; `top` and `constituents` are
/// the file's.
pub(super) fn lost(medium: &Medium, top: &Raw, constituents: &[Raw]) -> Result<Vec<String>> {
    let (_, height) = top.one_of(&["height_km", "height_m"])?;
    let at = format!("{} = {}", height.path(), height.number()?);
    let mut out = Vec::new();
    for cut in medium.cuts() {
        let stated = constituents.get(cut.constituent).map_or(Ok(false), states_column)?;
        out.push(told(&at, &medium.constituents[cut.constituent], &cut, stated));
    }
    let height = medium.height();
    // One look where the limit is spares most planets the search for the altitude.
    if !medium.is_filled((1.0 - EMPTY) * height)
        && let Some(above) = medium.empty_above().filter(|above| 1.0 - above / height > EMPTY)
    {
        let (share, km) = (digits(100.0 * (1.0 - above / height)), digits(above / 1e3));
        out.push(format!(
            "{at}: {share} % of the shell, all above {km} km, is empty, and tables spend texels of every axis on it; a top \
             of {km} km loses nothing"
        ));
    }
    Ok(out)
}

/// Whether the file gives the constituent's amount by a column or an optical depth of the whole shell.
fn states_column(item: &Raw) -> Result<bool> {
    let keys = || [UNITS[2]].into_iter().chain(AMOUNTS[1..].iter().copied());
    for part in COEFFICIENTS {
        if let Some(coefficient) = item.get(part)?
            && keys().any(|key| matches!(coefficient.get(key), Ok(Some(_))))
        {
            return Ok(true);
        }
    }
    Ok(false)
}

fn told(at: &str, c: &Constituent, cut: &Cut, stated: bool) -> String {
    let profile = format!("constituents.{}.profile ({})", c.name, shape(&c.density));
    let percent = digits(100.0 * cut.share);
    let (depth, nm) = (digits(cut.depth), cut.nm);
    let largest = if cut.over_ground { "that at the ground" } else { "the largest" };
    let at_top = format!("{} of {largest}", digits(cut.at_top));
    if cut.share == 0.0 {
        return format!("{at}: {profile} ends there in a step: at the top the density is {at_top}");
    }
    if cut.share > 1.0 - 1e-9 {
        return format!(
            "{at}: all of {profile} lies above it, and its optical depth of {depth} at {nm} nm is lost"
        );
    }
    let cost = match stated {
        true => "the column that is stated is pressed into the rest".to_string(),
        false => format!("an optical depth of {depth} at {nm} nm"),
    };
    format!(
        "{at}: it cuts off {percent} % of the column of {profile}, {cost}; at the top the density is {at_top}"
    )
}

/// A profile in few words.
fn shape(density: &DensityProfile) -> String {
    let km = |z: f64| digits(z / 1e3);
    match density {
        DensityProfile::Exponential { scale_height } => format!("scale height {} km", km(*scale_height)),
        DensityProfile::Tent { bottom, top, .. } | DensityProfile::Layer { bottom, top } => {
            format!("{} to {} km", km(*bottom), km(*top))
        }
        DensityProfile::Linear { nodes } | DensityProfile::LogLinear { nodes } => {
            let ends = [nodes.first(), nodes.last()].map(|n| n.map_or(0.0, |n| km(n.0)));
            format!("{} to {} km", ends[0], ends[1])
        }
    }
}

/// Three significant digits, written out.
fn digits(v: f64) -> f64 {
    format!("{v:.2e}").parse().unwrap_or(v)
}

#[cfg(test)]
mod tests {
    use crate::preset;

    /// Warnings of earth-paper with changes.
    fn told(set: &[&str]) -> Vec<String> {
        let set: Vec<String> = set.iter().map(|s| s.to_string()).collect();
        preset::load("earth-paper", &set).unwrap().warnings
    }

    /// Exactly one warning, which holds all of the parts.
    fn one(set: &[&str], parts: &[&str]) {
        let told = told(set);
        assert!(told.len() == 1 && parts.iter().all(|p| told[0].contains(p)), "{set:?} {parts:?}: {told:?}");
    }

    /// Every loss is told with key, value and cost: e^(−10/8) of the gas, all of a layer, half of one.
    #[test]
    fn what_the_top_loses_is_told() {
        one(
            &["top.height_km=10"],
            &["top.height_km = 10:", "28.7 %", "constituents.air.profile", "0.287 of that at the ground"],
        );
        let layer = |ends: &str| format!("constituents.aerosol.profile={{\"kind\":\"layer\",{ends}}}");
        one(
            &[&layer("\"bottom_km\":82,\"top_km\":84")],
            &["all of constituents.aerosol.profile (82 to 84 km)"],
        );
        one(
            &[&layer("\"bottom_km\":64.9,\"top_km\":65.1")],
            &["50 % of the column of constituents.aerosol.profile"],
        );
        assert_eq!(told(&[&layer("\"bottom_km\":64.8,\"top_km\":65")]), Vec::<String>::new());
    }

    /// A column that the file states for the whole shell stays, in less room.
    #[test]
    fn a_stated_column_is_pressed_into_the_rest() {
        let depth = "constituents.aerosol.scattering={\"kind\":\"constant\",\"optical_depth\":0.1}";
        let profile = "constituents.aerosol.profile.scale_height_km=20";
        one(&[depth, profile], &["3.88 %", "the column that is stated is pressed into the rest"]);
    }

    /// A tall empty shell is told of with what would do; a shell twice as high as its air is not.
    #[test]
    fn an_empty_shell_is_told_of() {
        one(&["top.height_km=800"], &["top.height_km = 800:", "% of the shell", "is empty"]);
        assert_eq!(told(&["top.height_km=130"]), Vec::<String>::new());
    }
}
