//! Presets of waters: shipped ones hold, bad ones are refused with file, key, value and reason.

use super::media::{leaving, leaving_of_sky};
use tyndall::internals::medium::WaterMedium;
use tyndall::internals::preset::{Water, is_water, load_water, shipped_water_names};
use tyndall::internals::reference::water::{Look, Source, WaterTracer};

/// Every shipped water reads, and its resolved form gives the same bits back.
#[test]
fn shipped_waters_hold() {
    assert!(shipped_water_names().count() >= 14);
    for name in shipped_water_names() {
        let water = load_water(name, &[]).unwrap();
        assert_eq!(water.name, name);
        assert!(is_water(name));
        assert_eq!(Water::from_resolved(&water.resolved()).unwrap(), water);
    }
}

fn refused(change: &str) -> String {
    load_water("muddy", &[change.to_string()]).unwrap_err().to_string()
}

/// Numbers that no water has, keys that are none, numbers without a source.
#[test]
fn bad_waters_are_refused() {
    for (change, meant) in [
        ("largest_depth_m=-1", "largest_depth_m = -1"),
        ("refractive_index=3", "between 1 and 2.5"),
        ("seabed.albedo=1.5", "seabed.albedo = 1.5"),
        ("seabed.albedo=seabed-must", "seabed-mud"),
        ("constituents[0].concentration=-2", "concentration = -2"),
        ("constituents[0].phase.backscatter_fraction=0.4", "backscatter_fraction = 0.4"),
        ("constituents[0].phase=null", "`phase` is missing"),
        ("constituents[1].absorption.slope_per_nm=1", "slope_per_nm = 1"),
        ("constituents[1].name=mineral sediment", "another constituent"),
        ("constituents[0].scatering={\"kind\":\"constant\",\"per_m\":1}", "`scattering`"),
        ("pure_water.absorption={\"kind\":\"constant\",\"optical_depth\":1}", "column"),
        ("constituents[0].concentration=1e300", "coefficient of"),
    ] {
        let found = refused(change);
        assert!(found.contains(meant), "{change}: {found}");
    }
}

/// The reflectance of clear ocean straight up follows Gordon et al. 1988 with the surface of Lee et al. 2002,
/// r = 0.0949 u + 0.0794 u², R = 0.52 r / (1 − 1.7 r), u = b_b / (a + b_b): published for the open ocean and said to
/// hold to about 10 %. Measured there (443 nm, 0.05 to 0.1 mg/m³ of chlorophyll) are 0.008 to 0.012 1/sr.
#[test]
fn remote_sensing_reflectance_of_clear_ocean() {
    let nm = [412.0, 443.0, 490.0, 555.0];
    let medium = load_water("clear-ocean", &[]).unwrap().medium(&nm);
    for (w, nm) in nm.into_iter().enumerate() {
        let one = only(&medium, w);
        // Sun at 30°; no sky. Deep enough that no bed is seen.
        let sun = 0.866;
        let found = leaving(&one, 1e4, 1.0, sun)[0] / sun;
        let backwards: f64 = (0..4000)
            .map(|k| 2.0 * std::f64::consts::PI * one.phase(0, -(k as f64 + 0.5) / 4000.0) / 4000.0)
            .sum();
        let bb = one.scattering(0) * backwards;
        let u = bb / (one.absorption[0] + bb);
        let r = 0.0949 * u + 0.0794 * u * u;
        let expected = 0.52 * r / (1.0 - 1.7 * r);
        assert!((found / expected - 1.0).abs() < 0.1, "{nm} nm: {found} is not {expected}");
        if nm == 443.0 {
            assert!((0.008..0.012).contains(&found), "{found}");
        }
    }
}

fn only(medium: &WaterMedium, w: usize) -> WaterMedium {
    let mut one = medium.clone();
    one.wavelengths_nm = vec![medium.wavelengths_nm[w]];
    for list in [&mut one.refractive_index, &mut one.absorption, &mut one.seabed_albedo] {
        *list = vec![list[w]];
    }
    for s in &mut one.scatterers {
        s.scattering = vec![s.scattering[w]];
        s.phase = vec![s.phase[w].clone()];
    }
    one
}

/// Shipped waters, with their sharply peaked particles, surface and bed, under an even sky (which Monte Carlo
/// meets without the noise of a peak that hits the sun): within 1 % and the noise of 20 000 paths.
#[test]
fn shipped_waters_against_monte_carlo() {
    for (name, depth) in [("tropical", 8.0), ("phytoplankton", 3.0), ("muddy", 0.4)] {
        let medium = load_water(name, &[]).unwrap().medium(&[490.0]);
        let tracer = WaterTracer::new(&medium, 0, depth);
        for view in [0.95, 0.4] {
            let truth = tracer.leaving(Look { mu: view, azimuth: None }, Source::Sky, 20_000, 3);
            let found = leaving_of_sky(&medium, depth, view);
            for (what, found, (mean, noise)) in
                [("water", found[0], truth.water), ("seabed", found[1], truth.seabed)]
            {
                let whole = truth.water.0 + truth.seabed.0;
                assert!(noise < 0.04 * whole, "{name}: the reference is too noisy, {mean} ± {noise}");
                let off = (found - mean).abs();
                assert!(off < 0.01 * whole + 3.5 * noise, "{name} {what}: {found} is not {mean} ± {noise}");
            }
        }
    }
}
