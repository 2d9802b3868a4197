//! Ranges of altitudes and suns as people write them, and sizes of tables that suit them.

use crate::error::Result;
use crate::layout::compact;
use crate::layout::compact::Kind;
use crate::layout::elek2010;
use crate::layout::settings::Settings;
use crate::mapping::{Elek2010, Views};
use crate::medium::Medium;
use crate::preset::{Metric, Tolerance};

/// `2m`, `0..200m`, `300m..12km`: metres; the first number has the unit of the last where it has none.
pub(crate) fn altitudes(text: &str) -> Result<[f64; 2]> {
    let form = || "expected a height or a range of heights, e.g. 2m, 0..12km".to_string();
    let (first, last) = text.split_once("..").unwrap_or((text, text));
    let split = |t: &str| -> Option<(f64, Option<f64>)> {
        let t = t.trim();
        let end = t.find(|c: char| c.is_ascii_alphabetic() && c != 'e').unwrap_or(t.len());
        let factor = match t[end..].trim() {
            "" => None,
            "m" => Some(1.0),
            "km" => Some(1e3),
            _ => return None,
        };
        Some((t[..end].trim().parse().ok()?, factor))
    };
    let ((low, its), (high, unit)) = (split(first).ok_or_else(form)?, split(last).ok_or_else(form)?);
    let unit = unit.unwrap_or(1.0);
    let ends = [low * its.unwrap_or(unit), high * unit];
    if !ends.iter().all(|a| (0.0..=1e13).contains(a)) {
        return Err("heights are 0 or more, and less than 1e13 m".into());
    }
    rising(ends)
}

/// `35`, `-6..60`: degrees.
pub(crate) fn suns(text: &str) -> Result<[f64; 2]> {
    let (first, last) = text.split_once("..").unwrap_or((text, text));
    let number = |t: &str| {
        t.trim()
            .parse::<f64>()
            .map_err(|_| "expected degrees or a range of them, e.g. 35, -6..60".to_string())
    };
    let ends = [number(first)?, number(last)?];
    if !ends.iter().all(|e| (-90.0..=90.0).contains(e)) {
        return Err("elevations lie between -90 and 90 degrees".into());
    }
    rising(ends)
}

/// `1%`, `1dE`: what 95 % of views keep within.
pub(crate) fn tolerance(text: &str) -> Result<Tolerance> {
    let form = || "expected an error of RGB in per cent or one in ΔE2000, e.g. 1% or 1dE".to_string();
    let number = |t: &str| t.trim().parse::<f64>().ok().filter(|v| (1e-9..=1000.0).contains(v));
    let (metric, most) = if let Some(t) = text.strip_suffix('%') {
        (Metric::Relative, number(t).ok_or_else(form)? / 100.0)
    } else {
        let t = text.strip_suffix("dE").ok_or_else(form)?;
        (Metric::DeltaE, number(t).ok_or_else(form)?)
    };
    Ok(Tolerance { metric, most, share: 0.95 })
}

fn rising(ends: [f64; 2]) -> Result<[f64; 2]> {
    if ends[0] <= ends[1] { Ok(ends) } else { Err("the first must not be greater than the second".into()) }
}

/// Which tables have a size that was asked for, and keep it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Sized {
    pub elek2010: bool,
    pub multiple: bool,
    pub single: bool,
    pub depth: bool,
}

/// Settings whose tables are as close in the window as they are without one; sizes that were asked for stay.
pub(crate) fn fitted(settings: &Settings, medium: &Medium, given: Sized) -> Settings {
    let (mut out, window) = (settings.clone(), &settings.window);
    let fit = |mapping: Option<Elek2010>, size: &mut [usize]| {
        let Some(mapping) = mapping else { return };
        let [altitude, sun] = mapping.spans();
        size[0] = altitude.texels(size[0]);
        size[1] = if window.views == Views::All { size[1] } else { size[1] / 2 };
        if let Some(suns) = size.get_mut(2) {
            *suns = sun.texels(*suns);
        }
    };
    let sizes = &mut out.compact.sizes;
    let any = [1, 2, 1, 1];
    if !given.single {
        fit(compact::mapping(medium, Kind::Single, any, window), &mut sizes.single);
    }
    if !given.multiple {
        fit(compact::mapping(medium, Kind::Multiple, any, window), &mut sizes.multiple);
    }
    if !given.depth {
        fit(compact::mapping(medium, Kind::Depth, any, window), &mut sizes.depth);
    }
    if !given.elek2010 {
        fit(elek2010::mapping(medium, any, window), &mut out.elek2010_size);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What people type, and what they should not.
    #[test]
    fn ranges_are_read() {
        assert_eq!(altitudes("2m").unwrap(), [2.0, 2.0]);
        assert_eq!(altitudes("0..12km").unwrap(), [0.0, 12e3]);
        assert_eq!(altitudes("300m..1.5km").unwrap(), [300.0, 1500.0]);
        assert_eq!(altitudes("10..1e3").unwrap(), [10.0, 1e3]);
        assert_eq!(suns("-6..60").unwrap(), [-6.0, 60.0]);
        assert_eq!(suns("35").unwrap(), [35.0, 35.0]);
        for text in ["", "2 miles", "3..2km", "-1..5", "nan", "0..inf"] {
            assert!(altitudes(text).is_err(), "{text}");
        }
        assert_eq!(tolerance("2%").unwrap().most, 0.02);
        assert_eq!(tolerance("0.5dE").unwrap().metric, Metric::DeltaE);
        assert!(["", "2", "-1%", "0dE", "x%", "5e-324%", "1e999%"].iter().all(|t| tolerance(t).is_err()));
        for text in ["", "60..-6", "-91", "high", "0..nan"] {
            assert!(suns(text).is_err(), "{text}");
        }
    }
}
