//! `bake.json` and `tyndall verify`: what is written reads back, and each kind of difference is named.

use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::{TempDir, tempdir};
use tyndall::internals::commands::verify::{Args, differences, run};
use tyndall::internals::files::exr::to_exr_bytes;
use tyndall::internals::files::manifest::*;
use tyndall::internals::files::staging::Staging;
use tyndall::internals::files::{Atlas, Samples};

/// A table of 3 × 2 × 4 texels, in the file `phobos/scattering.exr` of `staging`.
fn table(staging: &Staging) -> Table {
    let values = (0..24).map(|k| f64::from(k) * 0.25 - 1.0);
    let atlas = Atlas::new("scattering", [3, 2, 4]).with("R", Samples::half(values));
    let axis = |name: &str, size| Axis {
        name: name.into(),
        size,
        formula: "u = (r - bottom) / (top - bottom)".into(),
        constants: BTreeMap::from([("bottom".into(), 11_266.7), ("top".into(), 0.1 + 0.2)]),
        unit: "m".into(),
    };
    Table {
        layout: "phobos".into(),
        name: "scattering".into(),
        file: "phobos/scattering.exr".into(),
        blake3: staging.write("phobos/scattering.exr", &to_exr_bytes(&atlas).unwrap()).unwrap(),
        shape: vec![3, 2, 2, 2],
        axes: vec![axis("r", 3), axis("mu", 2), axis("mu_s", 2), axis("azimuth", 2)],
        packing: Packing {
            slice_width: 3,
            slice_height: 2,
            slices: 4,
            columns: 2,
            rows: 2,
            slice_order: "row-major".into(),
            slice_index: "azimuth * 2 + mu_s".into(),
            origin: Origin::TopLeft,
        },
        encoding: Encoding::log(1.0 / 16384.0, 4.5, -17.0),
        channels: vec![ChannelInfo {
            name: "R".into(),
            quantity: "radiance".into(),
            unit: "1/sr".into(),
            sample: Precision::Half,
            range: atlas.channels[0].samples.range(),
            encoding: None,
        }],
        containers: Vec::new(),
    }
}

fn manifest(staging: &Staging) -> Manifest {
    let resolved = json!({"radius_m": 11266.7, "constituents": [{"g": 0.1 + 0.2, "z": 1e-300}], "a": 1.0});
    Manifest {
        schema_version: SCHEMA_VERSION,
        tool: Tool::this(tyndall::internals::bake::versions::all()),
        preset: Preset { name: "phobos".into(), hash: hash_of(&resolved), resolved },
        settings: json!({"orders": "auto", "shipped_preset": true}),
        wavelengths: Wavelengths { kind: GridKind::Points, nm: vec![440.0, 1.0 / 3.0, f64::MIN_POSITIVE] },
        colour: Colour {
            space: "srgb".into(),
            observer: "CIE 1931 2 degrees".into(),
            white: [0.3127, 0.329],
            adaptation: None,
            matrices: BTreeMap::from([("xyz_to_rgb".into(), vec![vec![3.2404542, -1.5371385, -0.4985314]])]),
        },
        constants: BTreeMap::from([("ground_radius_m".into(), vec![11_266.7])]),
        waters: Vec::new(),
        tables: vec![table(staging)],
        files: vec![OtherFile {
            file: "preview.png".into(),
            blake3: staging.write("preview.png", b"picture").unwrap(),
            about: "what the tables look like".into(),
        }],
        quality: json!({"orders": 12}),
        warnings: vec!["a spectrum ends at 700 nm".into()],
        manifest_blake3: String::new(),
    }
}

/// A whole bake in `<temporary folder>/phobos`.
fn bake() -> TempDir {
    let dir = tempdir().unwrap();
    let staging = Staging::begin(&dir.path().join("phobos")).unwrap();
    let mut manifest = manifest(&staging);
    manifest.seal().unwrap();
    let text = manifest.to_json().unwrap();
    staging.write(MANIFEST, text.as_bytes()).unwrap();
    staging.commit().unwrap();
    dir
}

/// Changes the manifest on disk through its JSON.
fn edit(bake: &Path, change: impl Fn(&mut Value)) {
    let path = bake.join(MANIFEST);
    let mut value = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
    change(&mut value);
    fs::write(path, value.to_string()).unwrap();
}

/// Every number keeps its last bit, every field its place.
#[test]
fn a_manifest_reads_back_exactly_and_keeps_its_order() {
    let dir = tempdir().unwrap();
    let staging = Staging::begin(&dir.path().join("phobos")).unwrap();
    let manifest = manifest(&staging);
    let text = manifest.to_json().unwrap();
    assert_eq!(Manifest::parse(Path::new("bake.json"), &text).unwrap(), manifest);
    assert_eq!(manifest.to_json().unwrap(), text);
    let order = ["schema_version", "\"tool\"", "\"preset\"", "\"tables\"", "\"warnings\""];
    let places: Vec<usize> = order.iter().map(|key| text.find(key).unwrap()).collect();
    assert!(places.is_sorted(), "{places:?}");
}

/// JSON has no infinity: better no bake than one whose manifest cannot be read.
#[test]
fn a_manifest_with_a_number_that_json_lacks_is_not_written() {
    let dir = tempdir().unwrap();
    let staging = Staging::begin(&dir.path().join("phobos")).unwrap();
    let mut manifest = manifest(&staging);
    manifest.tables[0].channels[0].range[1] = f64::INFINITY;
    assert_eq!(manifest.to_json().unwrap_err().exit_code(), 3);
}

/// The log encoding undoes itself: ln(x / scale) - offset is what is stored for x; the floor means 0.
#[test]
fn encodings_decode_what_they_describe() {
    let log = Encoding::log(0.25, 4.5, -17.0);
    let stored = libm::log(3.0 / 0.25) - 4.5;
    assert!((log.decode(stored) - 3.0).abs() < 1e-14);
    assert_eq!(log.decode(-17.0), 0.0);
    assert_eq!(Encoding::linear(0.25).decode(8.0), 2.0);
}

#[test]
fn malformed_manifests_are_one_line_with_the_place() {
    let dir = bake();
    let bake = dir.path().join("phobos");
    let path = bake.join(MANIFEST);
    let whole = fs::read_to_string(&path).unwrap();
    for (text, reason) in [
        (whole[..whole.len() / 2].to_string(), "column"),
        (whole.replacen("\"tool\"", "\"tol\"", 1), "line 3, column 7: unknown field `tol`"),
        (whole.replacen("\"schema_version\": 1", "\"schema_version\": 2", 1), "newer than this tool"),
        (
            whole.replacen("\"schema_version\": 1", "\"schema_version\": \"x\"", 1),
            "schema_version \"x\" is unknown",
        ),
        ("{}".into(), "not the manifest of a bake"),
        ("[1,\n 2,, 3]".into(), "line 2, column 4"),
        (String::new(), "line 1, column 0"),
    ] {
        fs::write(&path, text).unwrap();
        let error = Manifest::read(&bake).unwrap_err();
        let said = error.to_string();
        assert!(said.contains(reason) && said.contains("bake.json") && !said.contains('\n'), "{said}");
        assert_eq!(error.exit_code(), 2);
    }
    fs::remove_file(&path).unwrap();
    for missing in [&bake, &dir.path().join("deimos"), &path] {
        let error = Manifest::read(missing).unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains("bake"), "{error}");
    }
}

/// Both by the folder and by its bake.json.
#[test]
fn a_whole_bake_holds() {
    let dir = bake();
    for place in ["phobos", "phobos/bake.json"] {
        let bake = dir.path().join(place);
        assert_eq!(differences(&bake, |_| None).unwrap(), []);
        for json in [false, true] {
            run(&Args { bake: bake.clone(), json }).unwrap();
        }
    }
}

/// Each change to a bake, and the words by which its difference is known.
#[test]
fn every_kind_of_difference_is_named() {
    type Change = fn(&Path);
    let changes: Vec<(&str, &str, Change)> = vec![
        ("phobos/scattering.exr", "is missing", |b| {
            fs::remove_file(b.join("phobos/scattering.exr")).unwrap()
        }),
        ("phobos/scattering.exr", "another BLAKE3", |b| truncate(&b.join("phobos/scattering.exr"))),
        ("phobos/scattering.exr", "truncated", |b| truncate(&b.join("phobos/scattering.exr"))),
        ("preview.png", "another BLAKE3", |b| fs::write(b.join("preview.png"), "paint").unwrap()),
        ("bake.json", "no manifest_blake3", |b| {
            edit(b, |m| drop(m.as_object_mut().unwrap().remove("manifest_blake3")))
        }),
        ("preset.hash", "resolved preset", |b| edit(b, |m| m["preset"]["resolved"]["radius_m"] = json!(1.0))),
        ("tool.version", "0.0.0", |b| edit(b, |m| m["tool"]["version"] = json!("0.0.0"))),
        ("phobos/scattering.exr", "not [9, 2", |b| {
            edit(b, |m| m["tables"][0]["packing"]["slice_width"] = json!(9))
        }),
        ("phobos/scattering.exr", "shape", |b| edit(b, |m| m["tables"][0]["shape"][0] = json!(4))),
        ("phobos/scattering.exr", "axes", |b| edit(b, |m| m["tables"][0]["axes"][1]["size"] = json!(4))),
        ("phobos/scattering.exr", "channels", |b| {
            edit(b, |m| m["tables"][0]["channels"][0]["name"] = json!("G"))
        }),
        ("phobos/scattering.exr", "Half", |b| {
            edit(b, |m| m["tables"][0]["channels"][0]["sample"] = json!("float"))
        }),
        ("phobos/scattering.exr", "ranges", |b| {
            edit(b, |m| m["tables"][0]["channels"][0]["range"][0] = json!(0.0))
        }),
        ("../secret", "outside", |b| edit(b, |m| m["files"][0]["file"] = json!("../secret"))),
    ];
    for (place, what, change) in changes {
        let dir = bake();
        let bake = dir.path().join("phobos");
        change(&bake);
        let found = differences(&bake, |_| None).unwrap();
        assert!(found.iter().any(|d| d.place == place && d.what.contains(what)), "{what}: {found:?}");
        assert_eq!(run(&Args { bake, json: true }).unwrap_err().exit_code(), 1);
    }
}

/// Files of others are told of, in whichever way the bake is named, and are no difference.
#[test]
fn files_of_others_are_no_difference() {
    let dir = bake();
    let bake = dir.path().join("phobos");
    fs::create_dir(bake.join(".godot")).unwrap();
    for file in ["phobos/scattering.exr.meta", ".godot/uid_cache.bin", "notes.txt"] {
        fs::write(bake.join(file), "mine").unwrap();
    }
    assert_eq!(differences(&bake, |_| None).unwrap(), []);
    let told = tyndall::internals::files::foreign::foreign(&bake);
    assert_eq!(told, [".godot/uid_cache.bin", "notes.txt", "phobos/scattering.exr.meta"].map(PathBuf::from));
    run(&Args { bake: bake.join(MANIFEST), json: true }).unwrap();
}

/// A reader that comes in the moment in which the old bake is moved aside and the new one not yet in its place waits for
/// it; one that comes where there is no bake does not.
#[test]
fn a_reader_between_two_bakes() {
    let dir = bake();
    let bake = dir.path().join("phobos");
    let theirs = dir.path().join(".phobos.tmp-0123456789abcdef");
    fs::create_dir(&theirs).unwrap();
    fs::write(theirs.join(".tyndall"), "").unwrap();
    std::thread::scope(|scope| {
        let baker = scope.spawn(|| {
            for _ in 0..20 {
                fs::rename(&bake, theirs.join("old")).unwrap();
                std::thread::sleep(std::time::Duration::from_millis(5));
                fs::rename(theirs.join("old"), &bake).unwrap();
                std::thread::sleep(std::time::Duration::from_millis(1));
            }
        });
        while !baker.is_finished() {
            Manifest::read(&bake).unwrap();
            Manifest::read(&bake.join(MANIFEST)).unwrap();
        }
    });
    fs::remove_dir_all(&bake).unwrap();
    let start = std::time::Instant::now();
    assert_eq!(Manifest::read(&bake).unwrap_err().exit_code(), 2);
    assert!(start.elapsed() < std::time::Duration::from_millis(900));
}

fn truncate(file: &Path) {
    let bytes = fs::read(file).unwrap();
    fs::write(file, &bytes[..bytes.len() - 1]).unwrap();
}

/// The preset of that name that the tool ships may have moved on since the bake.
#[test]
fn a_shipped_preset_that_has_changed_is_told() {
    let dir = bake();
    let bake = dir.path().join("phobos");
    let hash = Manifest::read(&bake).unwrap().preset.hash;
    assert_eq!(differences(&bake, |_| Some(hash.clone())).unwrap(), []);
    let found = differences(&bake, |name| (name == "phobos").then(|| "other".into())).unwrap();
    assert_eq!(found.len(), 1);
    assert!(found[0].what.contains("changed since"), "{found:?}");
    edit(&bake, |m| m["settings"]["shipped_preset"] = json!(false));
    let found = differences(&bake, |_| Some("other".into())).unwrap();
    assert!(found.len() == 1 && found[0].place == MANIFEST, "a preset of the user's own: {found:?}");
}

#[test]
fn no_bake_is_exit_2_and_help_opens_with_an_example() {
    let dir = tempdir().unwrap();
    let error = run(&Args { bake: dir.path().into(), json: false }).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    let help =
        <Args as clap::Args>::augment_args(clap::Command::new("verify")).render_long_help().to_string();
    assert!(help.starts_with("Example: tyndall verify out/earth"), "{help}");
}
