//! Where the altitude axis of thick air is finer: in the upper side of its cloud.

use crate::medium::Medium;
use crate::table::{Bends, Layer};

/// Vertical optical depth, the median over wavelengths, up to which axes are left alone.
const THIN: f64 = 4.0;
/// What a layer takes of the axis, of air without bound.
const SHARE: f64 = 0.5;
/// The layer follows ln(1 + k τ), τ the optical depth above: light in a cloud changes with the logarithm of its depth. On
/// `venus` in tables of 8 and 10 altitudes (the cases of [`crate::chart::stability`]) k = 30 leaves half of the error that
/// 10 does.
const CLOSENESS: f64 = 30.0;
/// How much finer the axis is near the ground besides, where its texels are spread by height.
const BEND: f64 = 4.5;

/// The bends of thin air as they are. In thick air half of a layer's texels lie between the altitudes above which a
/// quarter and three quarters of the logarithm of the depth are; the rest are spread more by height the thicker it is.
pub fn bent(bends: Bends, medium: &Medium) -> Bends {
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
    let width = 0.5 * (at(0.25) - at(0.75)).max(1e-4 * height);
    Bends {
        altitude_bend: bends.altitude_bend + BEND * thick,
        altitude_power: 1.0 + thick,
        layer: Layer { share: SHARE * thick, altitude: at(0.5), width },
        ..bends
    }
}

/// Vertical optical depth above an altitude (m), at the wavelength whose depth is the median: one that some band makes
/// opaque does not decide for the others.
fn depth_above(medium: &Medium) -> impl Fn(f64) -> f64 {
    let depths = medium.vertical_optical_depth();
    let mut order: Vec<usize> = (0..depths.len()).collect();
    order.sort_by(|&a, &b| depths[a].total_cmp(&depths[b]));
    let extinctions: Vec<f64> = match order.get(order.len() / 2) {
        Some(&w) => medium.constituents.iter().map(|c| c.extinction(w)).collect(),
        None => Vec::new(),
    };
    let height = medium.height();
    move |z| medium.constituents.iter().zip(&extinctions).map(|(c, e)| e * c.density.column(z, height)).sum()
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
    use crate::preset;

    const BENDS: Bends = Bends { altitude_bend: 1.5, ..Bends::PAPER };

    /// Thin air has the axis that it always had. The clouds of venus, whose tops at unit depth lie near 70 km (Crisp
    /// 1986), have a layer there, which ends above the clear air below 48 km.
    #[test]
    fn a_layer_lies_in_the_upper_clouds() {
        let of = |name| bent(BENDS, &preset::load(name, &[]).unwrap().medium(&[450.0, 550.0, 650.0]));
        for thin in ["earth", "earth-paper", "earth-sparse10", "mars"] {
            assert_eq!(of(thin), BENDS, "{thin}");
        }
        let Bends { layer, altitude_power, .. } = of("venus");
        assert!((65e3..75e3).contains(&layer.altitude) && layer.altitude - layer.width > 48e3, "{layer:?}");
        assert!(layer.share > 0.4 && altitude_power > 1.8, "{layer:?}");
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
