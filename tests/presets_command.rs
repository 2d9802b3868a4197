//! `tyndall presets` as a process.

use std::process::{Command, Output};

fn tyndall(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tyndall")).arg("presets").args(arguments).output().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// The list has every shipped preset with its description, and it is what comes without a word.
#[test]
fn list_names_what_is_shipped() {
    let text = stdout(&tyndall(&["list"]));
    assert_eq!(text, stdout(&tyndall(&[])));
    for (name, description) in tyndall::internals::preset::shipped() {
        assert!(description.len() > 20 && text.contains(name) && text.contains(&description), "{text}");
    }
    let json: serde_json::Value = serde_json::from_str(&stdout(&tyndall(&["list", "--json"]))).unwrap();
    assert_eq!(json[0]["name"], "earth");
}

/// `show --json` holds a preset that is the preset: it can be read back, and the hash is its own. The optical
/// depths shown are those of the medium.
#[test]
fn show_tells_the_whole_preset() {
    let output = tyndall(&["show", "earth-paper", "--json", "--wavelengths", "440,550"]);
    let report: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    let planet = tyndall::internals::preset::Planet::from_resolved(&report["preset"]).unwrap();
    assert_eq!(report["hash"], planet.hash());
    let depth = planet.medium(&[440.0, 550.0]).vertical_optical_depth();
    assert_eq!(report["physics"]["optical_depth"], serde_json::json!(depth));
    let denser = tyndall(&["show", "earth-paper", "--set", "constituents.aerosol.density_factor=10"]);
    let text = stdout(&denser);
    assert!(text.contains("density factor 10") && text.contains("0.25200"), "{text}");
}

/// `check` says one line a file, goes on after a bad one and leaves with 2.
#[test]
fn check_counts_bad_files() {
    let folder = tempfile::tempdir().unwrap();
    let good = include_str!("../presets/planets/earth-paper.json");
    std::fs::write(folder.path().join("a.json"), good.replace("0.76,", "1.76,")).unwrap();
    std::fs::write(folder.path().join("b.json"), good).unwrap();
    std::fs::write(folder.path().join("c.json"), "{").unwrap();
    let output = tyndall(&["check", folder.path().to_str().unwrap()]);
    let text = stdout(&output);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(output.status.code(), Some(2));
    assert!(lines.len() == 3 && lines[1].starts_with("ok "), "{text}");
    assert!(
        lines[0].starts_with("bad ") && lines[0].contains("a.json: constituents[1].phase.g = 1.76"),
        "{text}"
    );
    assert!(lines[2].contains("c.json: malformed JSON") && lines[2].contains("line 1 column 1"), "{text}");
    assert!(String::from_utf8_lossy(&output.stderr).contains("2 of 3"));
    assert!(tyndall(&["check"]).status.success());
}

/// Wrong names and wrong paths are input errors that name what was meant.
#[test]
fn slips_are_named() {
    for (arguments, meant) in [
        (&["show", "erth"][..], "`earth`"),
        (&["show", "earth", "--set", "grond.albedo=0"], "`ground`"),
        (&["show", "earth", "--set", "ground.albdo=0"], "`albedo`"),
        (&["show", "earth", "--wavelengths", "0"], "between 200 and 4000"),
        (&["check", "no-such-file.json"], "1 of 1"),
    ] {
        let output = tyndall(arguments);
        let talk = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(talk.contains(meant), "{arguments:?}: {talk}");
    }
}

/// The colour of the zenith is that of the solver at its finest, with light of all orders, within a few thousandths
/// in x and y and 2 % in luminance; without air there is no light and no colour.
#[test]
fn show_tells_the_colour_of_the_zenith() {
    use tyndall::internals::geometry::Point;
    use tyndall::internals::geometry::view::View;
    use tyndall::internals::spectrum::{chromaticity, grid, hat_weights, weighted};
    use tyndall::internals::transport::solve::{Orders, Resolution, Solution};
    let report: serde_json::Value =
        serde_json::from_str(&stdout(&tyndall(&["show", "earth-paper", "--json"]))).unwrap();
    let planet = tyndall::internals::preset::load("earth-paper", &[]).unwrap();
    let medium = planet.medium(&grid(9));
    let solution = Solution::new(&medium, &Resolution::EXACT, Orders::Converged { tolerance: 1e-3 });
    for (entry, elevation) in
        report["physics"]["zenith"]["colours"].as_array().unwrap().iter().zip([60.0, 5.0])
    {
        assert_eq!(entry["sun_elevation_deg"], elevation);
        let mu_s = libm::sin(f64::to_radians(elevation));
        let up = Point { altitude: 0.0, mu: 1.0, mu_s, azimuth_deg: 0.0 };
        let view = View::enter(&up, medium.ground_radius, medium.top_radius).unwrap();
        let light = solution.radiance(&view, &[0, 1]).scattering;
        let xyz = weighted(&hat_weights(&medium.wavelengths_nm, &planet.star.irradiance), &light);
        let found = |key: &str, k: usize| entry[key][k].as_f64().unwrap();
        for (k, expected) in chromaticity(xyz).into_iter().enumerate() {
            assert!((found("xy", k) - expected).abs() < 0.003, "{elevation}: {entry} {expected}");
        }
        assert!((found("xyz", 1) / xyz[1] - 1.0).abs() < 0.02, "{elevation}: {entry} {xyz:?}");
        // Blue: its largest component is 1, encoded ff.
        assert!(entry["linear_srgb"][2] == 1.0 && entry["srgb"].as_str().unwrap().ends_with("ff"), "{entry}");
    }
    let vacuum = tyndall(&["show", "earth-paper", "--set", "constituents=[]"]);
    assert_eq!(stdout(&vacuum).matches("#000000").count(), 2, "{}", stdout(&vacuum));
    assert!(!stdout(&tyndall(&["show", "earth-paper", "--no-colour"])).contains("zenith"));
}

/// Deep water that absorbs red is blue; the number is the reflectance that is told at single wavelengths, seen by
/// the eye, so that it lies between their smallest and largest times π.
#[test]
fn show_tells_the_colour_of_deep_water() {
    let ask = ["show", "clear-ocean", "--json", "--wavelengths", "400,450,500,550,600,650,700"];
    let report: serde_json::Value = serde_json::from_str(&stdout(&tyndall(&ask))).unwrap();
    let physics = &report["physics"];
    let single = physics["remote_sensing_reflectance_per_sr"].as_array().unwrap();
    let single: Vec<f64> = single.iter().map(|v| std::f64::consts::PI * v.as_f64().unwrap()).collect();
    let found = physics["deep_water"]["reflectance"].as_f64().unwrap();
    let [least, most] = [f64::min, f64::max].map(|f| single.iter().copied().reduce(f).unwrap());
    assert!(least < found && found < most, "{least} {found} {most}");
    assert_eq!(physics["deep_water"]["linear_srgb"][2], 1.0);
    assert!(physics["deep_water"]["xy"][0].as_f64().unwrap() < 0.2, "{}", physics["deep_water"]);
}

/// `check` says of which preset it speaks also where a spectrum beside it is missing, and takes the key by which an
/// editor finds the schema.
#[test]
fn check_names_the_preset() {
    let folder = tempfile::tempdir().unwrap();
    let good = include_str!("../presets/planets/earth-paper.json");
    let lost = good.replace("\"albedo\": 0.45", "\"albedo\": \"lost.csv\"");
    assert_ne!(lost, good);
    std::fs::write(folder.path().join("a.json"), lost).unwrap();
    std::fs::write(
        folder.path().join("b.json"),
        good.replacen('{', "{ \"$schema\": \"planet.schema.json\",", 1),
    )
    .unwrap();
    std::fs::write(folder.path().join("c.json"), good.replacen('{', "{ \"$schema\": true,", 1)).unwrap();
    let text = stdout(&tyndall(&["check", folder.path().to_str().unwrap()]));
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].contains("a.json: ") && lines[0].contains("lost.csv: No such file"), "{text}");
    assert!(lines[1].starts_with("ok ") && lines[2].contains("$schema = true: must be a text"), "{text}");
}

/// The schema is one of the draft that it names, and differs by what is asked for.
#[test]
fn schema_is_printed() {
    let one = |kind: &[&str]| -> serde_json::Value {
        serde_json::from_str(&stdout(&tyndall(&[&["schema"], kind].concat()))).unwrap()
    };
    let (planet, water, either) = (one(&["planet"]), one(&["water"]), one(&[]));
    for schema in [&planet, &water, &either] {
        assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    }
    assert!(planet["$defs"].get("water").is_none() && water["$defs"].get("planet").is_none());
    assert!(either["$defs"].get("planet").is_some() && either["$defs"].get("water").is_some());
    let radius = &planet["$defs"]["planet"]["properties"]["ground"]["properties"]["radius_km"];
    assert_eq!((&radius["exclusiveMinimum"], &radius["type"]), (&0.0.into(), &"number".into()));
}
