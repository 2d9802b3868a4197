//! Bakes with damaged, missing and foreign files: `verify` finds them (1), `sample` refuses them (2).

use super::run::*;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A file of the layout that `sample` reads.
const TABLE: &str = "compact/multiple.exr";

/// Damages a copy of the bake: `verify` must name `file` and say `what`.
fn found_by_verify(file: &str, what: &str, damage: impl Fn(&Path)) {
    let (_dir, bake) = earth_to_damage();
    damage(&bake);
    let done = verify(&bake);
    assert_eq!(done.code, Some(1), "{file}: {}{}", done.out, done.err);
    let says = |line: &str| line.contains(&format!("{file}: ")) && line.contains(what);
    assert!(done.out.lines().any(says), "{file}, {what}: {}", done.out);
}

/// The same damage to `TABLE`: `sample` must refuse it in one line.
fn refused_by_sample(damage: impl Fn(&Path)) {
    let (_dir, bake) = earth_to_damage();
    damage(&bake);
    let points = bake.join("views.csv");
    fs::write(&points, VIEWS).unwrap();
    let done = tyndall(&["sample".as_ref(), bake.as_os_str(), "--points".as_ref(), points.as_os_str()]);
    assert_eq!((done.code, done.out.as_str(), done.err.lines().count()), (Some(2), "", 1), "{}", done.err);
    assert!(done.err.contains(TABLE), "{}", done.err);
}

fn truncate(file: &Path, to: f64) {
    let bytes = fs::read(file).unwrap();
    fs::write(file, &bytes[..(bytes.len() as f64 * to) as usize]).unwrap();
}

/// Cut to nothing, in the header, in the middle, and by a byte.
#[test]
fn truncated_tables() {
    for to in [0.0, 0.01, 0.5, 0.9999] {
        let damage = |bake: &Path| truncate(&bake.join(TABLE), to);
        found_by_verify(TABLE, "another BLAKE3", damage);
        refused_by_sample(damage);
    }
    found_by_verify(TABLE, "truncated", |bake| truncate(&bake.join(TABLE), 0.9999));
}

/// A table of the right shape that belongs elsewhere: nothing in it is wrong but its bytes.
#[test]
fn a_table_of_the_same_shape_in_the_place_of_another() {
    let (_dir, bake) = earth_to_damage();
    let mut tables: Vec<_> = fs::read_dir(bake.join("compact")).unwrap().map(|e| e.unwrap().path()).collect();
    tables.retain(|p| p.file_name().unwrap().to_str().unwrap().starts_with("single_"));
    tables.sort();
    let [first, second, ..] = tables.as_slice() else { panic!("{tables:?}") };
    fs::copy(first, second).unwrap();
    let points = bake.join("views.csv");
    fs::write(&points, VIEWS).unwrap();
    let done = tyndall(&["sample".as_ref(), bake.as_os_str(), "--points".as_ref(), points.as_os_str()]);
    assert_eq!((done.code, done.out.as_str(), done.err.lines().count()), (Some(2), "", 1), "{}", done.err);
    assert!(done.err.contains("not the file that was baked"), "{}", done.err);
}

/// A picture from another program, a text with the name of a picture, a folder, nothing.
#[test]
fn files_of_another_kind() {
    let foreign = |bake: &Path| {
        let grey = |x: usize, y: usize| (x as f32, y as f32, 0.5);
        exr::prelude::write_rgb_file(bake.join(TABLE), 24, 24, grey).unwrap();
    };
    let text = |bake: &Path| fs::write(bake.join(TABLE), "a text\n".repeat(99)).unwrap();
    let missing = |bake: &Path| fs::remove_file(bake.join(TABLE)).unwrap();
    let folder = |bake: &Path| {
        fs::remove_file(bake.join(TABLE)).unwrap();
        fs::create_dir(bake.join(TABLE)).unwrap();
    };
    found_by_verify(TABLE, "not a file of this tool", foreign);
    refused_by_sample(foreign);
    found_by_verify(TABLE, "not an EXR file", text);
    refused_by_sample(text);
    found_by_verify(TABLE, "is missing", missing);
    refused_by_sample(missing);
    found_by_verify(TABLE, "cannot be read", folder);
    refused_by_sample(folder);
}

/// A table of this tool, but of another size than the manifest's, must not be read past its end.
#[test]
fn a_table_in_the_place_of_another() {
    let swap = |bake: &Path| assert!(fs::copy(bake.join("compact/irradiance.exr"), bake.join(TABLE)).is_ok());
    found_by_verify(TABLE, "slice width", swap);
    let (_dir, bake) = earth_to_damage();
    swap(&bake);
    let points = bake.join("views.csv");
    fs::write(&points, VIEWS).unwrap();
    let done = tyndall(&["sample".as_ref(), bake.as_os_str(), "--points".as_ref(), points.as_os_str()]);
    assert_eq!(done.code, Some(2), "{}", done.err);
}

/// One changed bit in any file of the bake is found and named.
#[test]
fn one_bit() {
    for file in files(earth()).into_keys().filter(|file| file != "bake.json") {
        found_by_verify(&file, "another BLAKE3", |bake| {
            let mut bytes = fs::read(bake.join(&file)).unwrap();
            let middle = bytes.len() / 2;
            bytes[middle] ^= 1;
            fs::write(bake.join(&file), bytes).unwrap();
        });
    }
}

/// Manifests that no longer say what was baked, or that a later tool wrote.
#[test]
fn manifests() {
    let change = |bake: &Path, change: &dyn Fn(&mut Value)| {
        let mut value = manifest(bake);
        change(&mut value);
        fs::write(bake.join("bake.json"), value.to_string()).unwrap();
    };
    found_by_verify("preset.hash", "resolved preset", |bake| {
        change(bake, &|m| m["preset"]["resolved"]["ground_radius_m"] = 1e6.into())
    });
    found_by_verify("tool.version", "baked by tyndall 0.0.1", |bake| {
        change(bake, &|m| m["tool"]["version"] = "0.0.1".into())
    });
    type Damage = fn(&mut Value);
    let refusals: [(Damage, &str); 3] = [
        (|m| m["schema_version"] = 99.into(), "schema_version 99 is newer than this tool"),
        (|m| drop(m.as_object_mut().unwrap().remove("tables")), "missing field `tables`"),
        (|m| m["tables"] = "none".into(), "invalid type"),
    ];
    for (damage, reason) in refusals {
        let (_dir, bake) = earth_to_damage();
        change(&bake, &damage);
        fs::write(bake.join("views.csv"), VIEWS).unwrap();
        let bake = bake.to_str().unwrap();
        for line in [format!("verify {bake}"), format!("sample {bake} --points {bake}/views.csv")] {
            let done = words(&line);
            assert_eq!((done.code, done.err.lines().count()), (Some(2), 1), "{line}: {}", done.err);
            assert!(done.err.contains("bake.json: ") && done.err.contains(reason), "{line}: {}", done.err);
        }
    }
}

/// A damage to a manifest, the options of `sample` that meet it, and what must be said of it.
type Case = (fn(&mut Value), &'static str, &'static str);

/// Numbers in `bake.json` that are indices, sizes, divisors or physics: each is refused in one line that names the
/// key, before it is used.
#[test]
fn numbers_of_the_manifest() {
    let cases: [Case; 16] = [
        (
            |m| m["constants"]["four_wavelengths_nm"] = vec![500.0; 5].into(),
            "",
            "constants.four_wavelengths_nm has 5",
        ),
        (
            |m| m["constants"]["four_wavelengths_nm"] = vec![0.0; 4].into(),
            "",
            "constants.four_wavelengths_nm = 0",
        ),
        (
            |m| m["constants"]["ground_albedo_at_four"] = vec![0.1; 5].into(),
            "",
            "ground_albedo_at_four has 5",
        ),
        (|m| m["constants"]["ground_albedo_at_four"] = vec![2.0; 4].into(), "", "ground_albedo_at_four = 2"),
        (
            |m| m["colour"]["matrices"]["rgb_from_four"][1] = vec![1.0; 9].into(),
            "",
            "colour.matrices.rgb_from_four",
        ),
        (|m| m["constants"]["star_illuminance_lx"] = vec![0.0].into(), "", "constants.star_illuminance_lx"),
        (|m| m["constants"]["star_illuminance_lx"] = vec![-3.0].into(), "", "constants.star_illuminance_lx"),
        (
            |m| table(m, "multiple")["shape"][0] = 1_000_000_000_000_000_u64.into(),
            "",
            "tables.multiple.shape",
        ),
        (
            |m| table(m, "multiple")["shape"] = vec![u64::from(u32::MAX); 4].into(),
            "",
            "tables.multiple.shape",
        ),
        (
            |m| table(m, "multiple")["axes"][0]["constants"]["r_top"] = 1e300.into(),
            "",
            "tables.multiple.axes.altitude: r_ground, r_top",
        ),
        (
            |m| m["constants"]["elek2010_aerosol_phase_row"] = vec![7.0].into(),
            "--layout elek2010",
            "constants.elek2010_aerosol_phase_row",
        ),
        (
            |m| m["preset"]["resolved"]["top_radius_m"] = 1e300.into(),
            "--exact",
            "ground_radius_m, top_radius_m",
        ),
        (
            |m| m["preset"]["resolved"]["ground_albedo"]["values"][0] = 7.0.into(),
            "--exact",
            "ground albedo at 380 nm = 7",
        ),
        (
            |m| m["preset"]["resolved"]["constituents"][0]["density_factor"] = 1e300.into(),
            "--exact",
            "e299: 1e5 is the most",
        ),
        (
            |m| m["settings"]["orders"]["first"] = 1_000_000_000_000_u64.into(),
            "--exact",
            "settings.orders.first",
        ),
        (|m| m["wavelengths"]["nm"] = vec![0.0].into(), "--exact --layout elek2010", "wavelengths.nm: 0 nm"),
    ];
    for (damage, options, reason) in cases {
        let (_dir, bake) = earth_to_damage();
        let mut value = manifest(&bake);
        damage(&mut value);
        fs::write(bake.join("bake.json"), value.to_string()).unwrap();
        fs::write(bake.join("views.csv"), VIEWS).unwrap();
        let bake = bake.display();
        let done = words(&format!("sample {bake} --points {bake}/views.csv {options}"));
        assert_eq!((done.code, done.err.lines().count()), (Some(2), 1), "{reason}: {}", done.err);
        assert!(done.out.is_empty() && done.err.contains(reason), "{reason}: {}", done.err);
    }
}

/// The entry of a table of the compact layout.
fn table<'a>(manifest: &'a mut Value, name: &str) -> &'a mut Value {
    let tables = manifest["tables"].as_array_mut().unwrap();
    tables.iter_mut().find(|t| t["layout"] == "compact" && t["name"] == name).unwrap()
}
