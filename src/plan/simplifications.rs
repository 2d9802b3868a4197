//! What can be left out of a model, one step at a time.

use super::evaluator::Evaluator;
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
pub(super) enum Simplification {
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

impl Simplification {
    /// The windows of a scene: what it cannot meet.
    pub(super) fn windows() -> [Simplification; 3] {
        [Simplification::Altitudes, Simplification::Suns, Simplification::Ground]
    }

    /// Whole parts, and texels of every axis.
    pub(super) fn parts(medium: &Medium) -> Vec<Simplification> {
        let (groups, _) = groups_to_fold(medium, &[]);
        let folds = groups.iter().map(|g| Simplification::Fold(medium.constituents[g[0]].name.clone()));
        let mut out: Vec<Simplification> = folds.collect();
        if medium.constituents.iter().any(|c| !c.scatters()) {
            out.push(Simplification::Scatterers);
        }
        out.extend([Simplification::Azimuth(Kind::Single), Simplification::Azimuth(Kind::Multiple)]);
        for kind in [Kind::Single, Kind::Multiple, Kind::Depth] {
            let axes = if kind == Kind::Depth { 2 } else { 4 };
            out.extend((0..axes).map(|axis| Simplification::Shrink(kind, axis)));
        }
        out
    }

    /// What is left out, in words.
    pub(super) fn text(&self, scene: &Scene) -> String {
        match self {
            Simplification::Altitudes => format!("altitudes but {}", heights(scene.altitudes)),
            Simplification::Suns => format!("suns but {}", degrees(scene.suns)),
            Simplification::Ground => "rays that meet the ground".into(),
            Simplification::Azimuth(kind) => format!("{}: azimuth axis, for the mean", table(*kind)),
            Simplification::Fold(name) => format!("table of what `{name}` scatters once"),
            Simplification::Scatterers => "table of optical depth without absorbers".into(),
            Simplification::Shrink(kind, axis) => format!("{}: {} texels", table(*kind), AXES[*axis]),
            Simplification::Orders(n) => format!("orders of scattering after {n}"),
            Simplification::Wavelengths(n) => format!("wavelengths but {n}"),
        }
    }

    /// From what to what a model changes, for axes.
    pub(super) fn sizes(&self, from: &Model, to: &Model) -> Option<[usize; 2]> {
        let of = |kind: Kind, axis: usize| [from, to].map(|m| size_of(m, kind)[axis]);
        match self {
            Simplification::Shrink(kind, axis) => Some(of(*kind, *axis)),
            Simplification::Azimuth(kind) => Some(of(*kind, 3)),
            _ => None,
        }
    }

    /// The model without it; none where there is nothing to leave out.
    pub(super) fn applied(
        &self,
        model: &Model,
        scene: &Scene,
        evaluator: &mut Evaluator,
    ) -> Result<Option<Model>> {
        let mut out = model.clone();
        let full = Model::default();
        match self {
            Simplification::Altitudes => out.window.altitudes = Some(scene.altitudes),
            Simplification::Suns => out.window.suns = Some(scene.suns),
            Simplification::Ground if scene.elevations[0] < 0.0 || model.window.views == Views::Sky => {
                return Ok(None);
            }
            Simplification::Ground => out.window.views = Views::Sky,
            Simplification::Azimuth(kind) => size_mut(&mut out, *kind)[3] = 1,
            Simplification::Fold(name) => out.design.folded.push(name.clone()),
            Simplification::Scatterers => out.design.without_scatterers = true,
            Simplification::Shrink(kind, axis) => {
                let fewer = fewer(size_of(model, *kind)[*axis], least(*kind, *axis, &model.window));
                size_mut(&mut out, *kind)[*axis] =
                    if *axis == 1 { even(fewer, &model.window) } else { fewer };
            }
            Simplification::Orders(n) => out.orders = Orders::First(*n),
            Simplification::Wavelengths(n) => out.wavelengths = *n,
        }
        if matches!(self, Simplification::Altitudes | Simplification::Suns | Simplification::Ground) {
            fit(&mut out, &full.design.sizes, evaluator.medium(&full)?);
            // A window that saves no texel is none.
            if out.design.sizes == model.design.sizes {
                return Ok(None);
            }
        }
        let twice = matches!(self, Simplification::Fold(name) if model.design.folded.contains(name));
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
    let whole =
        Model { design: compact::CompactSettings { sizes: *full, ..Default::default() }, ..Model::default() };
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
