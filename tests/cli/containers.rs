//! Tables in several containers; that others can read them is for `scripts/validate-containers`.

use super::run::*;
use serde_json::Value;
use std::fs;

fn tables(manifest: &Value) -> &Vec<Value> {
    manifest["tables"].as_array().unwrap()
}

/// Each table is there in each container, once, EXR too, and all are part of the bake: lost, changed or foreign ones are
/// found. EXR files and everything that is read from them are the same as without.
#[test]
fn every_table_in_every_container() {
    let dir = tempfile::tempdir().unwrap();
    let bake = bake("earth", dir.path(), &["--formats", "npy,ktx2,dds,npy"]);
    sound(&bake);
    let told = manifest(&bake);
    assert_eq!(told["settings"]["formats"], serde_json::json!(["exr", "ktx2", "dds", "npy"]));
    let (held, plain) = (files(&bake), files(earth()));
    for table in tables(&told) {
        let exr = table["file"].as_str().unwrap();
        assert!(held[exr] == plain[exr], "{exr}");
        let formats: Vec<&str> =
            table["containers"].as_array().unwrap().iter().map(|c| c["format"].as_str().unwrap()).collect();
        assert_eq!(formats, ["ktx2", "dds", "npy"]);
    }
    assert_eq!(held.len(), plain.len() + 3 * tables(&told).len());
    let scattering = tables(&told).iter().find(|t| t["file"] == "elek2010/scattering.exr").unwrap();
    assert_eq!(scattering["packing"]["slice_index"], "azimuth * 6 + sun");
    assert_eq!(scattering["containers"][0]["shape"], serde_json::json!([4, 8, 18]));
    assert_eq!(scattering["containers"][2]["shape"], serde_json::json!([3, 6, 8, 4, 4]));

    fs::write(bake.join("compact/multiple.dds"), "x").unwrap();
    fs::remove_file(bake.join("compact/phase.npy")).unwrap();
    let found = verify(&bake);
    assert_eq!((found.code, found.out.lines().count()), (Some(1), 2), "{}", found.out);
    assert!(found.out.contains("compact/multiple.dds: its bytes"), "{}", found.out);
    assert!(found.out.contains("compact/phase.npy: is missing"), "{}", found.out);
}

/// Engines go by sizes: tables of one or two axes (`irradiance` has one) are 2D with rows, those of more are 3D with
/// slices, also in a window of one sun without azimuths.
#[test]
fn engines_find_the_dimensions_that_shaders_bind() {
    let volume = |table: &Value| table["axes"].as_array().unwrap().len() > 2;
    let word = |file: &[u8], at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap());
    let dir = tempfile::tempdir().unwrap();
    let sizes =
        ["--size", "elek2010=4x8x1x1", "--size", "compact=4x8x1x1", "--size", "compact-single=4x8x1x1"];
    let common = [
        "--formats",
        "ktx2,dds",
        "--suns",
        "35",
        "--altitudes",
        "0m",
        "--wavelengths",
        "3",
        "--orders",
        "1",
        "--quiet",
    ];
    let mut command = command();
    command.args(["bake", "earth", "--out"]).arg(dir.path()).args(sizes).args(common);
    let done = ran(command.output().unwrap());
    assert_eq!(done.code, Some(0), "{}", done.err);
    let bake = dir.path().join("earth");
    let held = files(&bake);
    for table in tables(&manifest(&bake)) {
        let file = table["file"].as_str().unwrap().strip_suffix(".exr").unwrap();
        let (ktx2, dds) = (&held[&format!("{file}.ktx2")], &held[&format!("{file}.dds")]);
        assert!(word(ktx2, 20) == word(dds, 16) && (volume(table) || word(dds, 16) >= 2), "{file}");
        // Height and depth; of DDS also the resource's dimension, which is 3 for 2D.
        let found = [word(ktx2, 24), word(ktx2, 28), word(dds, 12), word(dds, 24), word(dds, 132)];
        let volume = volume(table);
        let right = match found {
            [height, 0, other, 0 | 1, 3] => !volume && height == other && height >= 2,
            [_, depth, _, other, 4] => volume && depth == other && depth >= 2,
            _ => false,
        };
        assert!(right, "{file}: {found:?}");
    }
}

/// In a column the slices lie one below the other; what the tables answer is the same, bit for bit.
#[test]
fn slices_in_a_column() {
    let dir = tempfile::tempdir().unwrap();
    let bake = bake("earth", dir.path(), &["--exr-atlas", "column"]);
    sound(&bake);
    for table in tables(&manifest(&bake)) {
        let packing = &table["packing"];
        assert_eq!((&packing["columns"], &packing["rows"]), (&1.into(), &packing["slices"]), "{table}");
    }
    for layout in ["compact", "elek2010"] {
        assert_eq!(sample(&bake, &["--layout", layout]), sample(earth(), &["--layout", layout]));
    }
}

/// A container that there is not is refused with those that there are.
#[test]
fn unknown_containers() {
    let done = words("bake earth --formats exr,tga");
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("tga") && done.err.contains("ktx2"), "{}", done.err);
}
