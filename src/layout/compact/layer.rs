//! Where the altitude axis of thick air is finer: in the upper side of its cloud.

use crate::mapping::{Elek2010, Layer, SunCurve, Warp, Window};
use crate::medium::Medium;

/// Vertical optical depth, the median over wavelengths, up to which axes are left alone.
const THIN: f64 = 4.0;
// SHARE, CLOSENESS, WIDTH, BEND and POWER were chosen out of some forty sets, by errors of `venus` and of air 100 times
// denser in tables of usual and of small size.

/// What a layer takes of the axis, of air without bound.
const SHARE: f64 = 0.5;
/// The layer follows ln(1 + k τ), τ the optical depth above: light in a cloud changes with the logarithm of its depth.
const CLOSENESS: f64 = 10.0;
/// A layer's width, of the distance between the altitudes above which a quarter and three quarters of that logarithm are.
const WIDTH: f64 = 0.7;
/// How much finer the axis is near the ground besides.
const BEND: f64 = 4.5;
/// The axis' power above 1, by which texels are spread more by height.
const POWER: f64 = 0.7;

/// The bends of thin air as they are. Thick air has a layer of finer altitudes in the upper side of its cloud, and the rest
/// are spread more by height, the thicker the more.
pub(super) fn bent(bends: Warp, medium: &Medium) -> Warp {
    let depth = depth_above(medium);
    let whole = depth(0.0);
    if !(whole > THIN && whole.is_finite()) {
        return bends;
    }
    let height = medium.height();
    let at = |share: f64| {
        let wanted = share * libm::log1p(CLOSENESS * whole);
        last(height, |z| libm::log1p(CLOSENESS * depth(z)) > wanted)
    };
    let thick = 1.0 - THIN / whole;
    let width = WIDTH * (at(0.25) - at(0.75)).max(1e-4 * height);
    Warp {
        altitude_bend: bends.altitude_bend + BEND * thick,
        altitude_power: 1.0 + POWER * thick,
        layer: Layer { share: SHARE * thick, altitude: at(0.5), width },
        ..bends
    }
}

/// The bends of thick air with another altitude bend, so that the nearest of `size` altitudes of a window lies where the
/// extinction jumps most, mostly the base of a cloud: light has a kink there, which no pair of texels may straddle. Where
/// nothing jumps, or no bend does it, as they are.
pub(super) fn with_texel_at_edge(bends: Warp, medium: &Medium, size: usize, window: &Window) -> Warp {
    if bends.layer == Layer::NONE || size < 3 {
        return bends;
    }
    let Some(edge) = strongest_edge(medium) else { return bends };
    let radii = [medium.ground_radius, medium.top_radius];
    let altitudes = Window { altitudes: window.altitudes, ..Window::WHOLE };
    let place = |altitude_bend: f64| -> Option<f64> {
        let bends = Warp { altitude_bend, ..bends };
        let mapping = Elek2010::windowed(radii, [size, 2, 2, 2], SunCurve::Paper, bends, &altitudes)?;
        let (index, fraction) = mapping.altitude_texel(edge);
        Some(index as f64 + fraction)
    };
    let Some(wanted) = place(bends.altitude_bend).map(f64::round) else { return bends };
    let (mut low, mut high) = (0.0, 4.0 * bends.altitude_bend);
    let within = wanted >= 1.0 && wanted <= (size - 2) as f64;
    if !(within && place(low) < Some(wanted) && Some(wanted) < place(high)) {
        return bends;
    }
    // A place moves up as the bend grows.
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if place(middle) < Some(wanted) { low = middle } else { high = middle }
    }
    Warp { altitude_bend: high, ..bends }
}

/// The altitude (m) about which the extinction changes most, by half at least, within a 400th of the height.
fn strongest_edge(medium: &Medium) -> Option<f64> {
    const STEPS: usize = 4000;
    const WITHIN: usize = STEPS / 400;
    let extinction = extinction_at(medium);
    let step = medium.height() / STEPS as f64;
    let values: Vec<f64> = (0..=STEPS).map(|k| extinction(k as f64 * step)).collect();
    let jump = |k: usize| {
        let [below, above] = [values[k], values[k + WITHIN]];
        let jump = (above - below).abs();
        if jump > 0.5 * below.max(above) { jump } else { 0.0 }
    };
    let ends = 0..=STEPS - WITHIN;
    let largest = ends.clone().max_by(|&a, &b| jump(a).total_cmp(&jump(b))).filter(|&k| jump(k) > 0.0)?;
    // An edge that is narrower lies in the middle of all that span it.
    let alike = |k: &usize| jump(*k) > 0.99 * jump(largest);
    let first = (0..=largest).rev().take_while(alike).last()?;
    let last = (largest..=*ends.end()).take_while(alike).last()?;
    Some(0.5 * (first + last + WITHIN) as f64 * step)
}

/// Extinction at an altitude, 1/m, at the wavelength that [`depth_above`] takes.
fn extinction_at(medium: &Medium) -> impl Fn(f64) -> f64 {
    let extinctions = median_extinctions(medium);
    move |z| medium.constituents.iter().zip(&extinctions).map(|(c, e)| e * c.density.at(z)).sum()
}

/// Vertical optical depth above an altitude (m), at the wavelength whose depth is the median: one that some band makes
/// opaque does not decide for the others.
fn depth_above(medium: &Medium) -> impl Fn(f64) -> f64 {
    let (extinctions, height) = (median_extinctions(medium), medium.height());
    move |z| medium.constituents.iter().zip(&extinctions).map(|(c, e)| e * c.density.column(z, height)).sum()
}

/// Extinction of each constituent at density 1, 1/m, at the wavelength of the median depth.
fn median_extinctions(medium: &Medium) -> Vec<f64> {
    let depths = medium.vertical_optical_depth();
    let mut order: Vec<usize> = (0..depths.len()).collect();
    order.sort_by(|&a, &b| depths[a].total_cmp(&depths[b]));
    let median = order.get(order.len() / 2);
    median.map_or(Vec::new(), |&w| medium.constituents.iter().map(|c| c.extinction(w)).collect())
}

/// The altitude up to which something holds that holds below and not above, by halving.
fn last(height: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, height);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        match holds(middle) {
            true => low = middle,
            false => high = middle,
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::medium::DensityProfile;
    use crate::preset;

    const BENDS: Warp = Warp { altitude_bend: 1.5, ..Warp::PAPER };

    /// Thin air has the axis that it always had. The clouds of venus, whose tops at unit depth lie near 70 km (Crisp
    /// 1986), have a layer there, which ends above the clear air below 48 km.
    #[test]
    fn a_layer_lies_in_the_upper_clouds() {
        let of = |name| bent(BENDS, &preset::load(name, &[]).unwrap().medium(&[450.0, 550.0, 650.0]));
        for thin in ["earth", "earth-paper", "earth-sparse10", "mars"] {
            assert_eq!(of(thin), BENDS, "{thin}");
        }
        let Warp { layer, altitude_power, .. } = of("venus");
        assert!((65e3..75e3).contains(&layer.altitude) && layer.altitude - layer.width > 48e3, "{layer:?}");
        assert!(layer.share > 0.35 && altitude_power > 1.5, "{layer:?}");
    }

    /// How far the texel of a table that is nearest to an altitude lies from it, m; the axis is changed.
    fn off(medium: &Medium, size: usize, window: &Window, altitude: f64) -> f64 {
        let bends = bent(BENDS, medium);
        let moved = with_texel_at_edge(bends, medium, size, window);
        assert_ne!(bends, moved, "{size} {window:?}");
        let radii = [medium.ground_radius, medium.top_radius];
        let mapping = Elek2010::windowed(radii, [size, 2, 2, 2], SunCurve::Paper, moved, window).unwrap();
        (0..size).map(|i| (mapping.altitude(i) - altitude).abs()).fold(f64::MAX, f64::min)
    }

    /// In tables of venus, whole ones and those of a window from the ground up, an altitude lies at the base of the
    /// clouds, where Crisp's lower layer begins (47.69 to 47.89 km).
    #[test]
    fn a_texel_lies_at_the_base_of_the_clouds() {
        let venus = preset::load("venus", &[]).unwrap().medium(&[450.0, 550.0, 650.0]);
        for size in [8, 10, 16, 24, 48] {
            let off = off(&venus, size, &Window::WHOLE, 47.79e3);
            assert!(off < 0.05e3, "{size}: {off} m");
        }
        for altitudes in [[0.0, 110e3], [0.0, 90e3]] {
            let window = Window { altitudes: Some(altitudes), ..Window::WHOLE };
            let off = off(&venus, 16, &window, 47.79e3);
            assert!(off < 0.05e3, "{altitudes:?}: {off} m");
        }
    }

    /// So it does at a step without any width, here the top of a layer at 22 km. Air that thins by an eighth in a
    /// kilometre has no such place, and keeps its axis.
    #[test]
    fn a_step_is_found_where_it_is() {
        let mut planet = preset::load("earth-paper", &[]).unwrap();
        planet.constituents.iter_mut().for_each(|c| c.density_factor = 100.0);
        planet.constituents.truncate(2);
        let mut medium = planet.medium(&[550.0]);
        let bends = bent(BENDS, &medium);
        assert!(bends.layer != Layer::NONE);
        assert_eq!(with_texel_at_edge(bends, &medium, 24, &Window::WHOLE), bends);
        medium.constituents[1].density = DensityProfile::Layer { bottom: 20e3, top: 22e3 };
        let off = off(&medium, 24, &Window::WHOLE, 22e3);
        assert!(off < medium.height() / 4000.0, "{off} m");
    }

    /// A band that is opaque at one wavelength of three leaves clear air the axis that it has.
    #[test]
    fn one_opaque_wavelength_does_not_decide() {
        let mut medium = preset::load("earth-paper", &[]).unwrap().medium(&[450.0, 550.0, 650.0]);
        medium.constituents[0].absorption[1] = 0.1;
        assert!(medium.vertical_optical_depth()[1] > 100.0);
        assert_eq!(bent(BENDS, &medium), BENDS);
    }

    /// No air, no axis of its own; air without bound, one that is a number.
    #[test]
    fn any_depth_has_an_axis() {
        let mut planet = preset::load("earth-paper", &[]).unwrap();
        let mut of = |factor: f64| {
            planet.constituents.iter_mut().for_each(|c| c.density_factor = factor);
            bent(BENDS, &planet.medium(&[550.0]))
        };
        assert_eq!(of(0.0), BENDS);
        let Layer { share, altitude, width } = of(1e9).layer;
        assert!(share <= SHARE && altitude > 0.0 && width > 0.0, "{share} {altitude} {width}");
    }
}
