//! Bad arguments and bad input: exit code 2 and one line that says which, where and why.

use super::run::*;
use std::fs;

/// Panics unless the run ends with 2, says all of `reasons` on stderr, and nothing on stdout.
fn refused(line: &str, reasons: &[&str]) {
    let done = words(line);
    assert_eq!((done.code, done.out.as_str()), (Some(2), ""), "{line}: {}", done.err);
    assert!(done.err.starts_with("error: ") && !done.err.contains("panicked"), "{line}: {}", done.err);
    for reason in reasons {
        assert!(done.err.contains(reason), "{line}: `{reason}` is not in: {}", done.err);
    }
}

/// A slip in a name brings the nearest name there is; a wrong value its file, key and range.
#[test]
fn presets_and_values() {
    refused("bake erth", &["`erth`", "nearest is `earth`"]);
    refused("bake no-such.json", &["no-such.json", "No such file"]);
    refused("bake tests/cli", &["tests/cli: ", "directory"]);
    refused("reference earth --points x.csv", &["x.csv: No such file"]);
    let set =
        |assignment: &str, reasons: &[&str]| refused(&format!("bake earth --set {assignment}"), reasons);
    set("grond.albedo=0", &["grond.albedo=0", "nearest is `ground`", "presets/planets/earth.json"]);
    set("constituents.aerosl.density_factor=2", &["nearest is `aerosol`"]);
    set(
        "ground.albdo=0.2",
        &["presets/planets/earth.json: ground.albdo = 0.2", "nearest known one is `albedo`"],
    );
    set("ground.albedo=1.5", &["presets/planets/earth.json: ground.albedo = 1.5", "between 0 and 1"]);
    set("ground.radius_km=-3", &["presets/planets/earth.json: ground.radius_km = -3"]);
    set("top.height_km=1e6", &["presets/planets/earth.json: top", "ground radii high"]);
    set("ground.radius_km=1e9", &["presets/planets/earth.json: top", "1e10 m is the most"]);
    set(
        "constituents.aerosol.density_factor=1e9",
        &["earth.json: constituents", "vertical optical depth at", "1e5 is the most"],
    );
    set("ground.albedo=NaN", &["ground.albedo=NaN", "not a finite number"]);
    set("ground.albedo=1e999", &["ground.albedo=1e999", "not a finite number"]);
    set("ground.albedo", &["path.to.key=value"]);
}

/// Numbers of arguments out of range, by argument and value.
#[test]
fn arguments() {
    for (line, reasons) in [
        ("--size 4x8x6", &["--size 4x8x6", "four numbers"][..]),
        ("--size 4x8x6xq", &["`q` is not a number"]),
        ("--size 4x7x6x3", &["--size 4x7x6x3", "even"]),
        ("--size 1x8x6x3", &["at least 2"]),
        (
            "--size compat=4x8x6x3",
            &["compat is not one of elek2010, compact, compact-single, compact-transmittance or water"],
        ),
        ("--size 99999x99999x99999x99999", &["more than"]),
        ("--orders 0", &["'0'", "from 1 to 10000"]),
        ("--orders some", &["'some'", "`auto` or a number"]),
        ("--wavelengths 0", &["--wavelengths 0", "at least one"]),
        ("--wavelengths 680,440", &["must rise"]),
        ("--wavelengths 440,x", &["`x` is not a wavelength"]),
        ("--wavelengths 440,NaN", &["NaN nm is outside 100 to 10000 nm"]),
        ("--wavelengths 440,1e999", &["outside 100 to 10000 nm"]),
        ("--layout sphere", &["'sphere'", "compact, elek2010, three-atmosphere"]),
        ("--threads 0", &["--threads 0"]),
        ("--threads 100000", &["--threads 100000", "1024 are the most"]),
        ("--isa mmx", &["'mmx'", "baseline"]),
        ("--colour-space cmyk", &["srgb, rec2020, acescg"]),
        ("--solver literal", &["--solver literal", "--orders N"]),
        ("--solver literal --orders 2 --layout compact", &["--solver literal", "elek2010"]),
        ("--spectral --layout compact", &["--spectral", "elek2010"]),
        ("earth", &["both named earth"]),
    ] {
        refused(&format!("bake earth {line}"), reasons);
    }
    refused("bake", &["<PRESET>"]);
    refused("bake --all earth", &["--all", "cannot be used with"]);
    for amount in ["2lakes", "-1GB", "0"] {
        refused(&format!("bake earth --memory={amount}"), &[amount, "amount of memory"]);
    }
    refused("bkae earth", &["bkae"]);
    refused("verify no-such-folder", &["no-such-folder: no such bake"]);
    refused("sample no-such-folder --points x.csv", &["no-such-folder: no such bake"]);
    let earth = earth().display();
    refused(&format!("sample {earth} --points x.csv"), &["x.csv: No such file"]);
    refused(&format!("sample {earth} --points x.csv --wavelengths 550"), &["--exact"]);
    let dir = tempfile::tempdir().unwrap();
    let points = dir.path().join("views.csv");
    fs::write(&points, VIEWS).unwrap();
    let points = points.display();
    let threads = &["--threads 100000: 1024 are the most"][..];
    refused(&format!("sample {earth} --points {points} --threads 100000"), threads);
    refused(&format!("reference earth --points {points} --threads 100000"), threads);
    refused(&format!("reference earth --points {points} --threads 0"), &["--threads 0"]);
    for nm in ["1e-300", "99.9", "440,NaN", "1e5"] {
        let line = format!("reference earth --points {points} --wavelengths {nm}");
        refused(&line, &["--wavelengths: ", "outside 100 to 10000 nm"]);
    }
    let set = "--set constituents.aerosol.density_factor=1e9";
    refused(
        &format!("reference earth --points {points} {set}"),
        &["earth.json: constituents", "vertical optical depth at"],
    );
}

/// A missing comma is on line 2, column 9; a number too large for f64 on line 1.
#[test]
fn malformed_json_is_located() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("mine.json");
    for (text, reasons) in [
        ("{\n \"a\": 1 \"b\": 2}", ["mine.json: malformed JSON", "line 2 column 9"]),
        ("{\"name\": 1e999}", ["mine.json: malformed JSON", "line 1"]),
        ("", ["mine.json: malformed JSON", "line 1 column 0"]),
    ] {
        fs::write(&file, text).unwrap();
        refused(&format!("bake {}", file.display()), &reasons);
    }
}

/// Two presets of one name would share a folder, and the first bake would be lost in silence.
#[test]
fn one_folder_is_not_baked_twice() {
    let paper = concat!(env!("CARGO_MANIFEST_DIR"), "/presets/planets/earth-paper.json");
    let done = tyndall(&["bake", "earth-paper", paper]);
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("both named earth-paper"), "{}", done.err);
}
