//! What cannot be mended is told.

use tyndall::internals::bake::bake;
use tyndall::internals::layout::compact::Sizes;
use tyndall::internals::layout::settings::Settings;
use tyndall::internals::preset;

fn warnings(settings: &Settings) -> Vec<String> {
    let planet = preset::load("earth-paper", &[]).unwrap();
    bake(&planet, settings, &mut |_| {}).unwrap().manifest.warnings
}

/// Two texels on the axis of the sun make a straight line of night and noon, two views one brightness of the sky: either
/// layout warns; and of one wavelength no colour can be made. Tables of the default size say nothing of the kind.
#[test]
fn tables_that_are_too_coarse_are_warned_of() {
    let coarse = Settings {
        elek2010_size: [12, 2, 24, 6],
        compact: Sizes { single: [10, 20, 2, 4], multiple: [8, 20, 2, 6], ..Sizes::default() }.into(),
        ..Settings::default()
    };
    let told = warnings(&coarse);
    for layout in ["layout compact:", "layout elek2010:"] {
        assert!(told.iter().any(|w| w.starts_with(layout)), "{told:?}");
    }
    let grey = warnings(&Settings { wavelengths_nm: vec![550.0], ..Settings::default() });
    assert!(grey.iter().any(|w| w.starts_with("1 wavelength:")), "{grey:?}");
    let default = warnings(&Settings::default());
    assert!(!default.iter().any(|w| w.starts_with("layout ") || w.contains("wavelength")), "{default:?}");
}

/// The dust of mars scatters forwards; as isotropic dust of (1 − g) as much it lights most of the sky by far too little,
/// which no table size mends: the bake of the paper's layout says so and names the one that does not do that.
#[test]
fn a_medium_that_the_paper_simplifies_too_far_is_warned_of() {
    let planet = preset::load("mars", &[]).unwrap();
    let settings = Settings {
        elek2010_size: [12, 48, 24, 6],
        compact: Sizes { single: [10, 20, 20, 4], multiple: [8, 20, 20, 6], ..Sizes::default() }.into(),
        ..Settings::default()
    };
    let told = bake(&planet, &settings, &mut |_| {}).unwrap().manifest.warnings;
    assert!(told.iter().any(|w| w.starts_with("layout elek2010: its isotropic haze")), "{told:?}");
}
