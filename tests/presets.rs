//! Presets as a user meets them: what is shipped, what is refused, and what comes out at the other side.

use serde_json::{Value, json};
use tyndall::internals::medium::{PhaseFunction, Role};
use tyndall::internals::preset::{self, Planet};

/// A small red planet of a dwarf star with every kind of form, nothing like the Earth.
fn red_planet() -> Value {
    json!({
        "name": "red-1",
        "description": "test planet",
        "ground": {"radius_km": 1200, "albedo": {"wavelengths_nm": [400, 800], "values": [0.1, 0.5], "source": "x"},
                   "source": "x"},
        "top": {"height_m": 45000, "source": "x"},
        "star": {"black_body_k": 3100, "angular_radius_deg": 0.4, "distance_au": 0.05, "source": "x"},
        "constituents": [
            {"name": "gas", "role": "gas",
             "profile": {"kind": "exponential", "scale_height_km": 5, "source": "x"},
             "scattering": {"kind": "power_law", "per_km": 0.02, "at_nm": 500, "angstrom_exponent": 4, "source": "x"},
             "phase": {"kind": "rayleigh", "king_factor": 1.1, "source": "x"}},
            {"name": "dust", "role": "aerosol", "density_factor": 3, "source": "x",
             "profile": {"kind": "layer", "bottom_km": 0, "top_km": 10, "source": "x"},
             "extinction": {"kind": "constant", "optical_depth": 0.5, "source": "x"},
             "single_scattering_albedo": 0.8,
             "phase": {"kind": "henyey_greenstein", "g": 0.6, "source": "x"}}
        ]
    })
}

fn read(value: &Value) -> tyndall::Result<Planet> {
    preset::read("red.json", &value.to_string(), &[])
}

/// The error of the red planet with one value changed (by JSON pointer).
fn refused(pointer: &str, value: Value) -> String {
    let mut planet = red_planet();
    *planet.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer}")) = value;
    match read(&planet) {
        Ok(_) => panic!("{pointer} was not refused"),
        Err(e) => {
            assert_eq!(e.exit_code(), 2);
            e.to_string()
        }
    }
}

/// Every form is brought to SI: 0.02/km is 2e-5/m; an optical depth of 0.5 over a layer of 10 km is 5e-5/m, and
/// the density factor 3 triples it; an albedo halfway between two nodes is their mean.
#[test]
fn units_and_forms_become_si() {
    let planet = read(&red_planet()).unwrap();
    assert_eq!((planet.ground_radius, planet.top_radius), (1.2e6, 1.245e6));
    let medium = planet.medium(&[500.0, 600.0]);
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
    close(medium.ground_albedo[1], 0.3);
    close(medium.constituents[0].scattering[0], 2e-5);
    close(medium.constituents[0].scattering[1], 2e-5 * (5.0_f64 / 6.0).powi_4());
    let dust = &medium.constituents[1];
    close(dust.extinction(0), 3.0 * 5e-5);
    close(dust.scattering[0], 0.8 * 3.0 * 5e-5);
    assert_eq!((dust.role, dust.similarity_g[0]), (Role::Aerosol, 0.6));
    assert_eq!(medium.constituents[0].phase[0], PhaseFunction::Rayleigh { king_factor: 1.1 });
    // A disc of angular radius α of radiance B lights a plane with π B sin² α.
    let sine = libm::sin(0.4_f64.to_radians());
    let b = tyndall::internals::spectrum::planck_law(600.0, 3100.0) * 1e-9;
    close(planet.star.irradiance.at(600.0), std::f64::consts::PI * sine * sine * b);
}

trait FourthPower {
    fn powi_4(self) -> f64;
}

impl FourthPower for f64 {
    fn powi_4(self) -> f64 {
        self * self * self * self
    }
}

/// The resolved planet is all there is: text and back gives the same planet, bit for bit, and the same hash.
#[test]
fn resolved_planets_round_trip() {
    let planets = preset::shipped_names().map(|n| preset::load(n, &[]).unwrap());
    for planet in planets.chain([read(&red_planet()).unwrap()]) {
        let text = planet.resolved().to_string();
        let back = Planet::from_resolved(&serde_json::from_str(&text).unwrap()).unwrap();
        assert_eq!(back, planet);
        assert_eq!(back.resolved().to_string(), text);
        assert_eq!(back.hash(), planet.hash());
        let grid = tyndall::internals::spectrum::grid(15);
        let (a, b) = (planet.medium(&grid), back.medium(&grid));
        assert_eq!(a.vertical_optical_depth(), b.vertical_optical_depth());
    }
    assert!(Planet::from_resolved(&json!({"name": "x"})).is_err());
}

/// The hash sees physics and not provenance: another source keeps it, another radius does not.
#[test]
fn hash_depends_on_physics() {
    let base = read(&red_planet()).unwrap().hash();
    let mut other = red_planet();
    other["top"]["source"] = json!("somewhere else");
    assert_eq!(read(&other).unwrap().hash(), base);
    other["top"]["height_m"] = json!(45001);
    assert_ne!(read(&other).unwrap().hash(), base);
}

/// Every bad value is one line with file, path, value and reason.
#[test]
fn bad_values_are_refused_in_one_line() {
    let phase = |v: Value| refused("/constituents/1/phase/g", v);
    assert_eq!(
        phase(json!(1.2)),
        "red.json: constituents[1].phase.g = 1.2: must be greater than -1 and less than 1"
    );
    assert!(phase(json!("wide")).contains("no shipped spectrum"));
    let cases = [
        ("/ground/radius_km", json!(0), "ground.radius_km = 0: must be greater than 0"),
        ("/ground/radius_km", json!(true), "ground.radius_km = true: must be a finite number"),
        ("/ground/radius_km", json!("6371"), "ground.radius_km = \"6371\": must be a finite number"),
        ("/top/height_m", json!(-1), "top.height_m = -1"),
        ("/ground/albedo/values/1", json!(1.5), "ground.albedo.values[1] = 1.5: must be between 0 and 1"),
        ("/ground/albedo/values", json!([0.5]), "1 values for 2 wavelengths"),
        ("/ground/albedo/wavelengths_nm/1", json!(300), "ground.albedo.wavelengths_nm[1] = 300"),
        ("/constituents/1/name", json!("gas"), "constituents[1].name = \"gas\": another constituent"),
        ("/constituents/1/density_factor", json!(-1), "density_factor = -1: must be 0 or more"),
        ("/constituents/1/single_scattering_albedo", json!(1.01), "between 0 and 1"),
        ("/constituents/0/profile/scale_height_km", json!(0), "scale_height_km = 0"),
        ("/constituents/0/profile/kind", json!("exponental"), "nearest known one is `exponential`"),
        ("/constituents/0/role", json!("vapour"), "known are `gas`, `aerosol`"),
        ("/constituents/0/scattering/per_km", json!(-0.1), "per_km = -0.1: must be 0 or more"),
        ("/name", json!("../escape"), "lower-case letters"),
        ("/constituents", json!({}), "constituents = {}: must be a list"),
        ("/star/black_body_k", json!(0), "star.black_body_k = 0"),
    ];
    for (pointer, value, expected) in cases {
        let error = refused(pointer, value);
        assert!(error.starts_with("red.json: ") && error.contains(expected), "{pointer}: {error}");
        assert!(!error.contains('\n'), "{error}");
    }
}

/// A slip in a key is caught wherever it is, and the key that was meant is named.
#[test]
fn unknown_keys_name_the_nearest() {
    for (pointer, slip, meant) in [
        ("", "constituent", "constituents"),
        ("/ground", "albdeo", "albedo"),
        ("/star", "limb_darkning", "limb_darkening"),
        ("/constituents/1", "densty_factor", "density_factor"),
        ("/constituents/1/phase", "mean_cosin", "mean_cosine"),
        ("/constituents/0/scattering", "angstrom", "angstrom_exponent"),
    ] {
        let mut planet = red_planet();
        planet.pointer_mut(pointer).unwrap()[slip] = json!("x");
        let error = read(&planet).unwrap_err().to_string();
        assert!(error.contains(slip) && error.contains(&format!("`{meant}`")), "{error}");
    }
}

/// Choices that exclude each other, and ones that are missing, are said to be so.
#[test]
fn alternatives_are_exclusive() {
    let with = |pointer: &str, key: &str, value: Value| {
        let mut planet = red_planet();
        planet.pointer_mut(pointer).unwrap()[key] = value;
        read(&planet).unwrap_err().to_string()
    };
    assert!(with("/constituents/1/phase", "mean_cosine", json!(0.5)).contains("only one of"));
    assert!(with("/top", "height_km", json!(45)).contains("only one of"));
    assert!(with("/star", "spectrum", json!("sun-tsis1-hsrs")).contains("only one of"));
    let scattering = json!({"kind": "constant", "per_m": 1e-5, "source": "x"});
    assert!(with("/constituents/1", "scattering", scattering).contains("or else"));
    let mut planet = red_planet();
    planet["constituents"][1].as_object_mut().unwrap().shift_remove("phase");
    assert!(read(&planet).unwrap_err().to_string().contains("`phase` is missing"));
}

/// Each object that holds a number in the red planet needs its source, lists included.
#[test]
fn a_number_without_a_source_is_refused() {
    for pointer in ["/top", "/star", "/ground/albedo", "/constituents/1", "/constituents/1/extinction"] {
        let mut planet = red_planet();
        planet.pointer_mut(pointer).unwrap().as_object_mut().unwrap().shift_remove("source");
        let error = read(&planet).unwrap_err().to_string();
        assert!(error.contains("without a source"), "{pointer}: {error}");
    }
}

/// Overrides change the physics they name, and a vacuum is a planet too.
#[test]
fn overrides_reach_the_medium() {
    let load = |set: &[&str]| {
        let set: Vec<String> = set.iter().map(|s| s.to_string()).collect();
        preset::load("earth-paper", &set)
    };
    let base = load(&[]).unwrap().medium(&[550.0]);
    let dense = load(&["constituents.air.density_factor=10"]).unwrap().medium(&[550.0]);
    assert_eq!(dense.constituents[0].scattering[0], 10.0 * base.constituents[0].scattering[0]);
    assert_eq!(dense.constituents[1].scattering, base.constituents[1].scattering);
    let vacuum = load(&["constituents=[]"]).unwrap().medium(&[550.0]);
    assert!(vacuum.constituents.is_empty() && vacuum.vertical_optical_depth() == [0.0]);
    let mean =
        load(&["constituents.aerosol.phase.g=null", "constituents.aerosol.phase.mean_cosine=0.5"]).unwrap();
    assert!((mean.medium(&[550.0]).constituents[1].phase[0].mean_cosine() - 0.5).abs() < 1e-12);
    let error = load(&["constituents.aerosol.densty_factor=10"]).unwrap_err().to_string();
    assert!(
        error.contains("constituents[1].densty_factor = 10") && error.contains("`density_factor`"),
        "{error}"
    );
    let error = load(&["constituents.aerosol.phase.g=2"]).unwrap_err().to_string();
    assert!(error.contains("earth-paper.json: constituents[1].phase.g = 2"), "{error}");
}

/// Names of presets: an unknown one brings the nearest, a path to a file works, a missing file is an input error.
#[test]
fn presets_are_found_by_name_or_path() {
    assert!(preset::load("earht", &[]).unwrap_err().to_string().contains("the nearest is `earth`"));
    let error = preset::load("no/such/planet.json", &[]).unwrap_err();
    assert!(error.exit_code() == 2 && error.to_string().starts_with("no/such/planet.json: "));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("red.json");
    std::fs::write(&path, red_planet().to_string()).unwrap();
    assert_eq!(preset::load(path.to_str().unwrap(), &[]).unwrap(), read(&red_planet()).unwrap());
    std::fs::write(&path, "{\n  \"name\": red\n}").unwrap();
    let error = preset::load(path.to_str().unwrap(), &[]).unwrap_err().to_string();
    assert!(error.contains("line 2 column"), "{error}");
}

/// An optical depth is met however thin the layer is against the shell: 10 m of haze under a top of 45 km.
#[test]
fn optical_depths_are_met_by_thin_layers() {
    let mut planet = red_planet();
    let dust = &mut planet["constituents"][1];
    dust["density_factor"] = json!(1);
    dust["profile"] = json!({"kind": "exponential", "scale_height_m": 10, "source": "x"});
    let planet = read(&planet).unwrap();
    let dust = &planet.medium(&[500.0]).constituents[1];
    assert!((dust.density.column(0.0, planet.height()) * dust.extinction(0) - 0.5).abs() < 1e-12);
    assert!((dust.extinction(0) - 0.05).abs() < 1e-12);
}

/// Spectra that end inside 380–780 nm are held and reported; the shipped ones leave nothing open.
#[test]
fn held_spectra_are_reported() {
    let planet = read(&red_planet()).unwrap();
    assert_eq!(planet.warnings.len(), 1);
    assert!(planet.warnings[0].contains("ground albedo is given over 400–800 nm"), "{:?}", planet.warnings);
    for name in preset::shipped_names() {
        assert_eq!(preset::load(name, &[]).unwrap().warnings, Vec::<String>::new(), "{name}");
    }
}

/// A spectrum in a CSV file beside the preset is found there, and its irradiance is brought to the planet's
/// distance: twice as far, a quarter of the light.
#[test]
fn spectra_beside_the_preset() {
    let folder = tempfile::tempdir().unwrap();
    let table = "# source: a lamp\nwavelength_nm,irradiance_w_m2_nm\n380,2\n780,4\n";
    std::fs::write(folder.path().join("lamp.csv"), table).unwrap();
    let mut planet = red_planet();
    planet["star"] = json!({"spectrum": "lamp.csv", "spectrum_at_au": 1, "distance_au": 2,
                            "angular_radius_deg": 0.1, "source": "x"});
    let path = folder.path().join("red.json");
    std::fs::write(&path, planet.to_string()).unwrap();
    let star = preset::load(path.to_str().unwrap(), &[]).unwrap().star;
    assert_eq!([star.irradiance.at(380.0), star.irradiance.at(580.0)], [0.5, 0.75]);
}

/// Vertical optical depths of the air at 400, 550 and 700 nm: Bodhaine et al. 1999, Table 3 (sea level, 45°:
/// 0.3602, 0.0971 and 0.0364 to the precision of the column). Ozone of 300 DU takes 0.0356 at 600 nm by its cross-section of 4.86e-25 m².
#[test]
fn earth_has_its_measured_optical_depths() {
    let planet = preset::load("earth", &[]).unwrap();
    let medium = planet.medium(&[400.0, 550.0, 600.0, 700.0]);
    let depth = |c: usize, w: usize| {
        let c = &medium.constituents[c];
        c.density.column(0.0, planet.height()) * c.extinction(w)
    };
    for (w, expected) in [(0, 0.3602), (1, 0.0971), (3, 0.0364)] {
        assert!((depth(0, w) / expected - 1.0).abs() < 2e-3, "{w}: {}", depth(0, w));
    }
    let ozone = 300.0 * 2.6868e20 * 4.86e-25;
    assert!((depth(1, 2) / ozone - 1.0).abs() < 1e-4, "{} {ozone}", depth(1, 2));
    assert!((depth(2, 1) / 0.122 - 1.0).abs() < 1e-6);
    assert!((medium.constituents[2].phase[1].mean_cosine() - 0.702).abs() < 1e-12);
    assert!((planet.star.angular_radius - 0.004_652).abs() < 2e-6);
}

/// The paper's constants at 550 nm: 8π³(n²−1)²/(3Nλ⁴) = 1.276e-5 1/m, and the disc of its sun lights with
/// π B sin² α = 1.886 W/(m² nm).
#[test]
fn earth_paper_has_the_papers_constants() {
    let planet = preset::load("earth-paper", &[]).unwrap();
    let medium = planet.medium(&[440.0, 550.0]);
    assert_eq!((medium.ground_radius, medium.top_radius), (6.371e6, 6.436e6));
    assert!((medium.constituents[0].scattering[1] / 1.276e-5 - 1.0).abs() < 1e-4);
    assert_eq!(medium.constituents[1].scattering, [2.1e-5, 2.1e-5]);
    assert_eq!(medium.constituents[1].phase[0], PhaseFunction::CornetteShanks { g: 0.76 });
    assert_eq!(medium.constituents[1].similarity_g, [0.76, 0.76]);
    assert_eq!(medium.ground_albedo, [0.45, 0.45]);
    assert!(medium.constituents.iter().all(|c| c.absorption == [0.0, 0.0]));
    assert!((planet.star.irradiance.at(380.0) / 1.458_451_4 - 1.0).abs() < 2e-4);
}
