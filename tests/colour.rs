//! `tyndall colour` as a process. Expected values come from colour-science 0.4.7, which scripts/validate-colour
//! compares at length.

use std::io::Write;
use std::process::{Command, Output, Stdio};

fn tyndall(arguments: &[&str], input: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_tyndall"))
        .arg("colour")
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A command that refuses its arguments may end before it reads.
    let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
    child.wait_with_output().unwrap()
}

fn json(arguments: &[&str], input: &str) -> serde_json::Value {
    let output = tyndall(&[arguments, &["--json"]].concat(), input);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn numbers(value: &serde_json::Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

fn close(got: &[f64], want: &[f64], relative: f64) {
    assert_eq!(got.len(), want.len());
    let largest = want.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    assert!(got.iter().zip(want).all(|(a, b)| (a - b).abs() < relative * largest), "{got:?} {want:?}");
}

const SPECTRUM: &str = "wavelength_nm,lamp\n400,0.2\n500,1\n620,0.3\n700,0.8\n";

/// A spectrum of four samples, linear between them and held outside: what colour-science makes of the same.
#[test]
fn a_spectrum_has_the_colour_of_an_independent_implementation() {
    let answer = json(&[], SPECTRUM);
    let lamp = &answer["colours"][0];
    assert_eq!(lamp["name"], "lamp");
    close(&numbers(&lamp["xyz"]), &[50.702367386953, 64.7788473683, 62.444920869555], 1e-9);
    close(&numbers(&lamp["lab"]), &[84.369646511563, -27.117300532589, 6.896630900642], 1e-9);
    close(&numbers(&lamp["rgb"]), &[0.335992290069, 0.749749677854, 0.556096870203], 1e-9);
}

/// The sun as a black body: chromaticity (.326432, .335725); and what it prints as CSV is what it prints as JSON.
#[test]
fn black_bodies() {
    let answer = json(&["--blackbody", "5778"], "");
    let xy = numbers(&answer["colours"][0]["xy"]);
    close(&xy, &[0.326_432, 0.335_725], 2e-6);
    let csv = String::from_utf8(tyndall(&["--blackbody", "5778"], "").stdout).unwrap();
    let (header, row) = csv.trim_end().split_once('\n').unwrap();
    assert_eq!(header, "name,X,Y,Z,x,y,R,G,B,L*,a*,b*");
    let row: Vec<f64> = row.split(',').skip(1).map(|v| v.parse().unwrap()).collect();
    close(&row[3..5], &xy, 1e-8);
    close(&row[..3], &numbers(&answer["colours"][0]["xyz"]), 1e-8);
}

/// Photometric XYZ are relative ones times 683 Σȳ / 100, and with RGB in the same unit white is 1 at Y = 1.
#[test]
fn scales_differ_by_their_k() {
    let relative = json(&[], SPECTRUM);
    let photometric = json(&["--scale", "photometric"], SPECTRUM);
    let k = 683.0 * 106.856_917 / 100.0;
    let scaled: Vec<f64> = numbers(&relative["colours"][0]["xyz"]).iter().map(|v| v * k).collect();
    close(&numbers(&photometric["colours"][0]["xyz"]), &scaled, 1e-8);
    let rgb: Vec<f64> = numbers(&relative["colours"][0]["rgb"]).iter().map(|v| v * k * 100.0).collect();
    close(&numbers(&photometric["colours"][0]["rgb"]), &rgb, 1e-8);
}

/// Twice the light is the same colour by the project's rule but for its luminance: the difference of a spectrum
/// from itself is 0, and of one twice as bright that of L* 49.5 from 66.
#[test]
fn differences_are_taken_from_the_first() {
    let answer = json(&["--difference"], "wavelength_nm,a,b,c\n400,1,1,2\n700,1,1,2\n");
    let d: Vec<f64> = (0..3).map(|k| answer["colours"][k]["delta_e_2000"].as_f64().unwrap()).collect();
    assert!(d[0] == 0.0 && d[1] == 0.0 && (d[2] - 15.0).abs() < 3.0, "{d:?}");
}

/// The spectra that are summed can be seen: the ends are held, and a warning says so.
#[test]
fn held_ends_are_told() {
    let output = tyndall(&["--spectra"], SPECTRUM);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(text.lines().count(), 472);
    assert!(text.contains("\n360,0.2\n") && text.contains("\n475,0.8\n") && text.ends_with("\n830,0.8\n"));
    assert!(String::from_utf8_lossy(&output.stderr).contains("warning: lamp covers 400–700 nm"));
}

/// Bad input and bad arguments leave with exit code 2, nothing on standard output and one line that says why.
#[test]
fn bad_input_is_refused() {
    for (arguments, input, reason) in [
        (&[][..], "nm,a\n1,2\n", "wavelength_nm is missing"),
        (&[], "wavelength_nm,a\n400,1\n500,x\n", "line 3, a = `x`: not a finite number"),
        (&["no-such-file.csv"], "", "no-such-file.csv"),
        (&["spectra.csv", "--blackbody", "5778"], "", "not both"),
        (&["--blackbody", "5"], "", "between 100 and 1000000"),
        (&["--white-y", "0"], SPECTRUM, "greater than 0"),
        (&["--colour-space", "cmyk"], SPECTRUM, "cmyk"),
    ] {
        let output = tyndall(arguments, input);
        let talk = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?} {talk}");
        assert!(output.stdout.is_empty() && talk.contains(reason), "{arguments:?} {talk}");
    }
}

/// Matrices are printed for other tools: sRGB's derived one, whose product with its inverse is the identity.
#[test]
fn matrices_are_printed() {
    let answer = json(&["--matrix"], "");
    let rows = |key: &str| -> Vec<Vec<f64>> { answer[key].as_array().unwrap().iter().map(numbers).collect() };
    let (from, to) = (rows("from_xyz"), rows("to_xyz"));
    assert!((from[0][0] - 3.240_969_94).abs() < 1e-8);
    for r in 0..3 {
        for c in 0..3 {
            let product: f64 = (0..3).map(|k| from[r][k] * to[k][c]).sum();
            assert!((product - f64::from(u8::from(r == c))).abs() < 1e-12);
        }
    }
}
