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
