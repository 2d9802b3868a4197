//! Bake, verify, sample: the tables say what was baked into them.

use super::run::*;
use serde_json::Value;
use std::fs;

/// Both layouts answer with light from the files alone. At the nadir from the top of the shell, where a table has
/// a texel for the view itself, they agree with direct integration within the rounding of halves and the
/// colours of five wavelengths.
#[test]
fn both_layouts_answer_from_their_files() {
    let bake = earth();
    sound(bake);
    let (table, truth) = (sample(bake, &[]), sample(bake, &["--exact"]));
    assert_eq!(table[NADIR].len(), 4);
    for (t, x) in table[NADIR].iter().zip(&truth[NADIR]) {
        assert!((t / x - 1.0).abs() < 0.02, "{t} for {x}");
    }
    let green = sample(bake, &["--layout", "elek2010"])[NADIR][1];
    let mean = truth[NADIR].iter().sum::<f64>() / 4.0;
    assert!((green / mean - 1.0).abs() < 0.2, "{green} for {mean}");
}

/// The golden vectors beside a layout's tables are what `sample` answers from the files of the bake, at views by day
/// and night, from the ground and from space.
#[test]
fn golden_vectors_are_what_sample_answers() {
    for (layout, channels) in [("compact", 4), ("elek2010", 3)] {
        let file = earth().join(layout).join("vectors.csv");
        let text = fs::read_to_string(&file).unwrap();
        let rows: Vec<Vec<f64>> =
            text.lines().skip(1).map(|l| l.split(',').map(|v| v.parse().unwrap()).collect()).collect();
        assert!(rows.len() == 60 && rows.iter().any(|r| r[0] > 1e5) && rows.iter().any(|r| r[2] < 0.0));
        for (component, at) in [("scattering", 4), ("total", 4 + channels)] {
            let words = ["--layout", layout, "--component", component];
            let done = ran(command()
                .arg("sample")
                .arg(earth())
                .arg("--points")
                .arg(&file)
                .args(words)
                .output()
                .unwrap());
            let answers: Vec<f64> = match layout {
                // A row a wavelength, the radiance in its sixth column.
                "compact" => lines(&done).map(|l| l[5]).collect(),
                _ => lines(&done).flat_map(|l| l[4..7].to_vec()).collect(),
            };
            let wanted = rows.iter().flat_map(|r| &r[at..at + channels]);
            assert_eq!(answers.len(), rows.len() * channels);
            assert!(
                answers.iter().zip(wanted).all(|(a, w)| (a - w).abs() <= 1e-7 * w.abs()),
                "{layout} {component}"
            );
            assert!(answers.iter().filter(|a| **a > 0.0).count() > 100);
        }
    }
}

/// Look-ups stand beside each layout in three languages, with all tables of the layout to bind, in the order of the
/// bindings, and functions that can be called; `sound` has held them against the hashes of the manifest.
#[test]
fn look_ups_name_the_tables_of_their_layout() {
    let manifest = manifest(earth());
    let files: Vec<&str> =
        manifest["files"].as_array().unwrap().iter().map(|f| f["file"].as_str().unwrap()).collect();
    for layout in ["compact", "elek2010"] {
        let tables = manifest["tables"].as_array().unwrap().iter().filter(|t| t["layout"] == layout);
        let mut tables: Vec<&str> = tables.map(|t| t["file"].as_str().unwrap()).collect();
        tables.sort_unstable();
        for (language, call) in
            [("wgsl", "fn sky_total("), ("glsl", "vec3 sky_total("), ("hlsl", "float3 sky_total(")]
        {
            let file = format!("{layout}/lookup.{language}");
            assert!(files.contains(&file.as_str()), "{file}");
            let text = fs::read_to_string(earth().join(&file)).unwrap();
            let head = text.lines().take_while(|l| l.starts_with("//"));
            let mut bound: Vec<&str> =
                head.filter_map(|l| l.split(' ').find(|w| w.ends_with(".exr"))).collect();
            assert!(bound[0].ends_with(if layout == "compact" { "multiple.exr" } else { "scattering.exr" }));
            bound.sort_unstable();
            assert_eq!(bound, tables, "{file}");
            assert!(text.contains(call) && text.lines().all(|l| l.chars().count() <= 140), "{file}");
        }
    }
}

/// Rows of a CSV on standard output, without its header; what is empty is 0.
fn lines(done: &Ran) -> impl Iterator<Item = Vec<f64>> + '_ {
    done.out.lines().skip(1).map(|l| l.split(',').map(|v| v.parse().unwrap_or(0.0)).collect())
}

/// Light is that of the air and that of the ground, and nothing else.
#[test]
fn components_add_up() {
    for layout in ["compact", "elek2010"] {
        let of = |component: &str| sample(earth(), &["--layout", layout, "--component", component]);
        let (total, air, ground) = (of("total"), of("scattering"), of("ground"));
        assert!(air[ZENITH][0] > 0.0 && ground[NADIR][0] > 0.0 && ground[ZENITH][0] == 0.0);
        for (t, (a, g)) in total.iter().flatten().zip(air.iter().flatten().zip(ground.iter().flatten())) {
            assert!((t - a - g).abs() <= 1e-7 * t, "{layout}: {t} is not {a} + {g}");
        }
    }
}

/// `--absolute` multiplies by the star that the manifest states: irradiance of a wavelength, illuminance of RGB.
#[test]
fn absolute_answers_are_those_of_the_star() {
    let manifest = manifest(earth());
    let constants = &manifest["constants"];
    let position =
        |nm: &Value| manifest["wavelengths"]["nm"].as_array().unwrap().iter().position(|w| w == nm);
    let star = &constants["star_irradiance_at_wavelengths_w_m2_nm"];
    let four: Vec<f64> = constants["four_wavelengths_nm"]
        .as_array()
        .unwrap()
        .iter()
        .map(|nm| star[position(nm).unwrap()].as_f64().unwrap())
        .collect();
    let lux = constants["star_illuminance_lx"][0].as_f64().unwrap();
    for (layout, factors) in [("compact", four), ("elek2010", vec![lux; 3])] {
        let (relative, absolute) =
            (sample(earth(), &["--layout", layout]), sample(earth(), &["--layout", layout, "--absolute"]));
        for ((r, a), factor) in relative[ZENITH].iter().zip(&absolute[ZENITH]).zip(factors) {
            assert!((a / (r * factor) - 1.0).abs() < 1e-6, "{layout}: {a} is not {r} x {factor}");
        }
    }
}

/// What a machine asks for is JSON, and says what the plain text says.
#[test]
fn json_answers_parse() {
    let dir = tempfile::tempdir().unwrap();
    let done =
        ran(small_bake("earth-paper", dir.path(), &["--json", "--layout", "compact"]).output().unwrap());
    let answer: Value = serde_json::from_str(&done.out).unwrap();
    let folder = dir.path().join("earth-paper");
    assert_eq!(
        (answer["preset"].as_str(), answer["folder"].as_str()),
        (Some("earth-paper"), folder.to_str())
    );
    let bytes: usize = files(&folder).values().map(Vec::len).sum();
    assert_eq!(answer["bytes"].as_u64(), Some(bytes as u64));
    assert_eq!(answer["warnings"], manifest(&folder)["warnings"]);
    let verified =
        || serde_json::from_str::<Value>(&tyndall(&["verify", folder.to_str().unwrap(), "--json"]).out);
    assert_eq!(verified().unwrap()["holds"], true);
    fs::write(folder.join("notes.txt"), "mine").unwrap();
    assert_eq!(verified().unwrap()["foreign"][0], "notes.txt");
    fs::write(folder.join("preview.png"), "mine").unwrap();
    assert_eq!(verified().unwrap()["differences"][0]["place"], "preview.png");
    for line in ["presets list --json", "presets show earth --json", "colour --blackbody 5778 --json"] {
        assert!(serde_json::from_str::<Value>(&words(line).out).is_ok(), "{line}");
    }
}

/// `verify` tells that the tool ships another preset by now only where the bake was of the shipped one: changed
/// by --set or read from a file, a preset differs by intent.
#[test]
fn a_bake_is_stale_only_if_it_was_of_the_shipped_preset() {
    let dir = tempfile::tempdir().unwrap();
    assert_eq!(manifest(earth())["settings"]["shipped_preset"], true);
    let changed = bake("earth", dir.path(), &["--layout", "compact", "--set", "ground.albedo=0.1"]);
    holds(&changed);
    assert_eq!(manifest(&changed)["settings"]["shipped_preset"], false);
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/presets/planets/earth.json");
    let own = dir.path().join("earth.json");
    fs::write(&own, fs::read_to_string(file).unwrap().replace("\"albedo\": 0.294", "\"albedo\": 0.3"))
        .unwrap();
    let copied = bake(own.to_str().unwrap(), dir.path(), &["--layout", "compact"]);
    holds(&copied);
    // The same bake, had it been of the preset that was shipped then.
    let text = fs::read_to_string(copied.join("bake.json")).unwrap();
    let shipped = text.replace("\"shipped_preset\": false", "\"shipped_preset\": true");
    fs::write(copied.join("bake.json"), shipped).unwrap();
    let done = verify(&copied);
    assert!(
        done.code == Some(1) && done.out.contains("preset \"earth\" that this tool ships has changed"),
        "{}",
        done.out
    );
}
