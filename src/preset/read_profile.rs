//! `profile` of a constituent → [`DensityProfile`].

use super::bounds::{Bounds, NOT_NEGATIVE, POSITIVE};
use super::raw::{MOST_METRES, Raw};
use crate::error::Result;
use crate::medium::{DensityProfile, MOST_NODES};

pub(super) const KINDS: [&str; 5] = ["exponential", "tent", "layer", "linear", "log_linear"];

/// The density profile, altitudes in m over the ground.
pub(super) fn profile(raw: &Raw) -> Result<DensityProfile> {
    match raw.need("kind")?.choice(&KINDS)? {
        0 => {
            raw.only(&["kind", "scale_height_km", "scale_height_m"])?;
            let scale_height = raw.length("scale_height", POSITIVE)?;
            Ok(DensityProfile::Exponential { scale_height })
        }
        1 => {
            raw.only(&["kind", "bottom_km", "bottom_m", "centre_km", "centre_m", "top_km", "top_m"])?;
            let (bottom, centre, top) =
                (altitude(raw, "bottom")?, altitude(raw, "centre")?, altitude(raw, "top")?);
            if !(bottom < centre && centre < top) {
                return Err(raw.refuse("must have bottom < centre < top"));
            }
            Ok(DensityProfile::Tent { bottom, centre, top })
        }
        2 => {
            raw.only(&["kind", "bottom_km", "bottom_m", "top_km", "top_m"])?;
            let (bottom, top) = (altitude(raw, "bottom")?, altitude(raw, "top")?);
            if bottom >= top {
                return Err(raw.refuse("must have bottom < top"));
            }
            Ok(DensityProfile::Layer { bottom, top })
        }
        3 => Ok(DensityProfile::Linear { nodes: nodes(raw, NOT_NEGATIVE)? }),
        _ => Ok(DensityProfile::LogLinear { nodes: nodes(raw, POSITIVE)? }),
    }
}

fn altitude(raw: &Raw, stem: &str) -> Result<f64> {
    raw.length(stem, NOT_NEGATIVE)
}

fn nodes(raw: &Raw, bounds: Bounds) -> Result<Vec<(f64, f64)>> {
    raw.only(&["kind", "altitudes_km", "altitudes_m", "densities"])?;
    let (unit, altitudes) = raw.one_of(&["altitudes_km", "altitudes_m"])?;
    let densities = raw.need("densities")?;
    let count = altitudes.items()?.len();
    if count > MOST_NODES {
        return Err(altitudes.refuse(format!("{count} altitudes: {MOST_NODES} are the most")));
    }
    let (z, d) = (altitudes.rising(2)?, densities.numbers_in(bounds)?);
    if z[0] < 0.0 {
        return Err(altitudes.refuse("altitudes must be 0 or more"));
    }
    if z[z.len() - 1] * [1e3, 1.0][unit] > MOST_METRES {
        return Err(altitudes.refuse("altitudes must be less than 1e13 m"));
    }
    if z.len() != d.len() {
        return Err(densities.refuse(format!("{} densities for {} altitudes", d.len(), z.len())));
    }
    Ok(z.into_iter().map(|z| z * [1e3, 1.0][unit]).zip(d).collect())
}

/// A warning where a tabulated profile begins above the ground or ends below the top: nothing is there.
pub(super) fn absent(name: &str, profile: &DensityProfile, height: f64) -> Option<String> {
    let (DensityProfile::Linear { nodes } | DensityProfile::LogLinear { nodes }) = profile else {
        return None;
    };
    let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
    let cut = (first.0 > 0.0 && first.1 > 0.0) || (last.0 < height && last.1 > 0.0);
    cut.then(|| {
        let (from, to) = (first.0 / 1e3, last.0 / 1e3);
        format!("the profile of {name} is given over {from}–{to} km only; it is absent elsewhere")
    })
}
