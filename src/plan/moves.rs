//! What can be left out of a model, one step at a time.

use super::lab::Lab;
use super::model::Model;
use crate::error::Result;
use crate::layout::compact;
use crate::layout::compact::{Kind, Sizes, groups_to_fold};
use crate::mapping::{Views, Window};
use crate::medium::Medium;
use crate::preset::Scene;
use crate::transport::solve::Orders;

/// One thing to leave out.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Move {
    /// Altitudes and suns that the scene has not, and rays that meet the ground.
    Altitudes,
    Suns,
    Ground,
    /// The azimuth axis of a table, for its mean.
    Azimuth(Kind),
    /// The table of what a constituent scatters once.
    Fold(String),
    Scatterers,
    /// Some texels of an axis: 0 altitude, 1 view, 2 sun, 3 azimuth.
    Shrink(Kind, usize),
    /// All orders but the first so many.
    Orders(usize),
    /// All wavelengths but so many.
    Wavelengths(usize),
}

const AXES: [&str; 4] = ["altitude", "view", "sun", "azimuth"];

fn table(kind: Kind) -> &'static str {
    match kind {
        Kind::Single => "single scattering",
        Kind::Multiple => "multiple scattering",
        Kind::Depth => "transmittance",
    }
}

fn size_of(model: &Model, kind: Kind) -> Vec<usize> {
    let sizes = &model.design.sizes;
    match kind {
        Kind::Single => sizes.single.to_vec(),
        Kind::Multiple => sizes.multiple.to_vec(),
        Kind::Depth => sizes.depth.to_vec(),
    }
}

fn size_mut(model: &mut Model, kind: Kind) -> &mut [usize] {
    let sizes = &mut model.design.sizes;
    match kind {
        Kind::Single => &mut sizes.single,
        Kind::Multiple => &mut sizes.multiple,
        Kind::Depth => &mut sizes.depth,
    }
}

impl Move {
    /// The windows of a scene: what it cannot meet.
    pub(super) fn windows() -> [Move; 3] {
        [Move::Altitudes, Move::Suns, Move::Ground]
    }

    /// Whole parts, and texels of every axis.
    pub(super) fn parts(medium: &Medium) -> Vec<Move> {
        let (groups, _) = groups_to_fold(medium, &[]);
        let folds = groups.iter().map(|g| Move::Fold(medium.constituents[g[0]].name.clone()));
        let mut out: Vec<Move> = folds.collect();
        if medium.constituents.iter().any(|c| !c.scatters()) {
            out.push(Move::Scatterers);
        }
        out.extend([Move::Azimuth(Kind::Single), Move::Azimuth(Kind::Multiple)]);
        for kind in [Kind::Single, Kind::Multiple, Kind::Depth] {
            let axes = if kind == Kind::Depth { 2 } else { 4 };
            out.extend((0..axes).map(|axis| Move::Shrink(kind, axis)));
        }
        out
    }

    /// What is left out, in words.
    pub(super) fn text(&self, scene: &Scene) -> String {
        match self {
            Move::Altitudes => format!("altitudes but {}", heights(scene.altitudes)),
            Move::Suns => format!("suns but {}", degrees(scene.suns)),
            Move::Ground => "rays that meet the ground".into(),
            Move::Azimuth(kind) => format!("{}: azimuth axis, for the mean", table(*kind)),
            Move::Fold(name) => format!("table of what `{name}` scatters once"),
            Move::Scatterers => "table of optical depth without absorbers".into(),
            Move::Shrink(kind, axis) => format!("{}: {} texels", table(*kind), AXES[*axis]),
            Move::Orders(n) => format!("orders of scattering after {n}"),
            Move::Wavelengths(n) => format!("wavelengths but {n}"),
        }
    }

    /// From what to what a model changes, for axes.
    pub(super) fn sizes(&self, from: &Model, to: &Model) -> Option<[usize; 2]> {
        let of = |kind: Kind, axis: usize| [from, to].map(|m| size_of(m, kind)[axis]);
        match self {
            Move::Shrink(kind, axis) => Some(of(*kind, *axis)),
            Move::Azimuth(kind) => Some(of(*kind, 3)),
            _ => None,
        }
    }

    /// The model without it; none where there is nothing to leave out.
    pub(super) fn applied(&self, model: &Model, scene: &Scene, lab: &mut Lab) -> Result<Option<Model>> {
        let mut out = model.clone();
        let full = Model::default();
        match self {
            Move::Altitudes => out.window.altitudes = Some(scene.altitudes),
            Move::Suns => out.window.suns = Some(scene.suns),
            Move::Ground if scene.elevations[0] < 0.0 || model.window.views == Views::Sky => return Ok(None),
            Move::Ground => out.window.views = Views::Sky,
            Move::Azimuth(kind) => size_mut(&mut out, *kind)[3] = 1,
            Move::Fold(name) => out.design.folded.push(name.clone()),
            Move::Scatterers => out.design.without_scatterers = true,
            Move::Shrink(kind, axis) => {
                let fewer = fewer(size_of(model, *kind)[*axis], least(*kind, *axis, &model.window));
                size_mut(&mut out, *kind)[*axis] =
                    if *axis == 1 { even(fewer, &model.window) } else { fewer };
            }
            Move::Orders(n) => out.orders = Orders::First(*n),
            Move::Wavelengths(n) => out.wavelengths = *n,
        }
        if matches!(self, Move::Altitudes | Move::Suns | Move::Ground) {
            fit(&mut out, &full.design.sizes, lab.medium(&full)?);
            // A window that saves no texel is none.
            if out.design.sizes == model.design.sizes {
                return Ok(None);
            }
        }
        let twice = matches!(self, Move::Fold(name) if model.design.folded.contains(name));
        Ok((out != *model && !twice).then_some(out))
    }
}

/// Least number of texels of an axis: one stands for a window, not for the whole.
fn least(kind: Kind, axis: usize, window: &Window) -> usize {
    match axis {
        0 if window.altitudes.is_some() => 1,
        1 => 4,
        2 if window.suns.is_some() && kind != Kind::Depth => 1,
        _ => 2,
    }
}

/// About four fifths.
fn fewer(n: usize, least: usize) -> usize {
    n.saturating_sub((n as f64 / 5.0).round().max(1.0) as usize).max(least.min(n))
}

fn even(n: usize, window: &Window) -> usize {
    if window.views == Views::All { n & !1 } else { n }
}

/// Sizes as close in the window as without one.
fn fit(model: &mut Model, full: &Sizes, medium: &Medium) {
    let window = model.window;
    let whole = Model { design: compact::Design { sizes: *full, ..Default::default() }, ..Model::default() };
    for kind in [Kind::Single, Kind::Multiple, Kind::Depth] {
        let Some(mapping) = compact::mapping(medium, kind, [1, 2, 1, 1], &window) else { continue };
        let [altitude, sun] = mapping.spans();
        let (from, to) = (size_of(&whole, kind), size_mut(model, kind));
        to[0] = altitude.texels(from[0]);
        to[1] = if window.views == Views::All { from[1] } else { from[1] / 2 };
        if let Some(suns) = to.get_mut(2) {
            *suns = sun.texels(from[2]);
        }
    }
}

fn heights([low, high]: [f64; 2]) -> String {
    let one = |a: f64| if a >= 1e4 { format!("{} km", a / 1e3) } else { format!("{a} m") };
    if low == high { one(low) } else { format!("{} to {}", one(low), one(high)) }
}

fn degrees([low, high]: [f64; 2]) -> String {
    if low == high { format!("{low}°") } else { format!("{low} to {high}°") }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of a fifth, one at least, that end at the least; views in pairs where there are two halves.
    #[test]
    fn steps_end() {
        let mut n = 44;
        let mut steps = Vec::new();
        while fewer(n, 2) < n {
            n = fewer(n, 2);
            steps.push(n);
        }
        assert_eq!(steps, [35, 28, 22, 18, 14, 11, 9, 7, 6, 5, 4, 3, 2]);
        assert_eq!((fewer(2, 1), fewer(1, 1), fewer(2, 2)), (1, 1, 2));
        let sky = Window { views: Views::Sky, ..Window::WHOLE };
        assert_eq!((even(35, &Window::WHOLE), even(35, &sky)), (34, 35));
    }
}
