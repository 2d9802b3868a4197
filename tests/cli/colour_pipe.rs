//! Spectra that `tyndall colour` once took for nothing: answers of `tyndall sample`, lines between whole nanometres, and
//! black bodies far brighter than white.

use super::run::*;
use std::fs;
use std::io::Write;
use std::process::Stdio;

/// `tyndall colour` with a text on its standard input.
fn colour(arguments: &[&str], input: &str) -> Ran {
    let mut command = command();
    command.arg("colour").args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    // A command that refuses its arguments may end before it reads.
    let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
    ran(child.wait_with_output().unwrap())
}

/// Name, and the eleven numbers X Y Z x y R G B L* a* b* of each line.
fn rows(done: &Ran) -> Vec<(String, Vec<f64>)> {
    assert_eq!(done.code, Some(0), "{}", done.err);
    let row = |line: &str| {
        let (name, values) = line.split_once(',').unwrap();
        (name.to_string(), values.split(',').map(|v| v.parse().unwrap()).collect())
    };
    done.out.lines().skip(1).map(row).collect()
}

fn near(found: f64, wanted: f64, share: f64) {
    assert!((found - wanted).abs() <= share * wanted.abs(), "{found} is not {wanted}");
}

/// What `sample` answers, of tables or exact, is a colour a view, named by the view: the sky of noon is blue and darker
/// than white paper in the sun, and a view past the planet is black. What the values were taken for is said.
#[test]
fn answers_of_sample_have_colours() {
    let dir = tempfile::tempdir().unwrap();
    let points = dir.path().join("v.csv");
    fs::write(&points, VIEWS).unwrap();
    let line = format!("sample {} --points {}", earth().display(), points.display());
    for more in ["", " --exact --wavelengths 380,430,480,530,580,630,680,730,780"] {
        let answers = words(&format!("{line}{more}"));
        assert_eq!(answers.code, Some(0), "{}", answers.err);
        let done = colour(&[], &answers.out);
        let found = rows(&done);
        assert_eq!(found.len(), VIEWS.lines().count() - 1, "{}", done.out);
        let (name, zenith) = &found[ZENITH];
        assert_eq!(name, "altitude_m=0 mu_view=1 mu_sun=0.5 azimuth_deg=0");
        assert!(zenith[1] > 1.0 && zenith[1] < 60.0, "{zenith:?}");
        assert!(zenith[3] < 0.29 && zenith[4] < 0.31, "{zenith:?}");
        assert!(zenith[7] > zenith[5] && zenith[8] < 100.0, "{zenith:?}");
        assert!(found[MISSES].1.iter().all(|v| *v == 0.0), "{:?}", found[MISSES]);
        assert!(done.err.contains("sunlight at 1 au") && done.err.contains("wavelengths, "), "{}", done.err);
        assert_eq!(done.err.lines().count(), 2, "{}", done.err);
    }
    let colours = words(&format!("{line} --layout elek2010"));
    let done = colour(&[], &colours.out);
    assert!(
        done.code == Some(2) && done.err.contains("linear RGB, which are colours already"),
        "{}",
        done.err
    );
}

/// Views at 1/π are a white surface: Y = 100, with the colour of the light, whichever it is.
#[test]
fn views_are_taken_under_a_light() {
    let value = 1.0 / std::f64::consts::PI;
    let head = "altitude_m,mu_view,mu_sun,azimuth_deg,wavelength_nm,radiance_per_sr,stderr_per_sr\n";
    let view = format!("{head}2,1,0.5,0,400,{value},\n2,1,0.5,0,700,{value},1e-3\n");
    let under = |more: &[&str]| rows(&colour(more, &view)).remove(0).1;
    let sun = under(&[]);
    near(sun[1], 100.0, 1e-8);
    near(sun[3], 0.322, 0.01);
    assert_eq!(under(&["--illuminant", "sun"]), sun);
    let equal = under(&["--illuminant", "e"]);
    near(equal[1], 100.0, 1e-8);
    near(equal[3], 1.0 / 3.0, 1e-3);
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("star.csv");
    fs::write(&file, "wavelength_nm,e\n380,1\n780,3\n").unwrap();
    let star = under(&["--illuminant", file.to_str().unwrap()]);
    near(star[1], 100.0, 1e-8);
    assert!(star[3] > equal[3] + 0.02, "{star:?}");
    // As radiance the values are what they are: Y = 100 is 1 in every nanometre.
    near(under(&["--illuminant", "none"])[1], 100.0 * value, 1e-8);
    let photometric = under(&["--illuminant", "e", "--scale", "photometric"]);
    near(photometric[1], 683.0 * 106.856_917 * value, 1e-8);
    let json = colour(&["--json"], &view).out;
    assert!(json.contains("\"illuminant\": \"sunlight at 1 au (TSIS-1 HSRS)\""), "{json}");
    for (more, input, reason) in [
        (&["--illuminant", "e"][..], "wavelength_nm,a\n400,1\n", "--illuminant: is of views"),
        (&["--illuminant", "lamp"], &view, "expected sun, e, none"),
        (&["--illuminant", "no-such.csv"], &view, "no-such.csv"),
        (&[], head, "no views"),
        (&[], &format!("{head}2,1,0.5,0,400,x,\n"), "line 2, radiance_per_sr = `x`: not a finite number"),
    ] {
        let done = colour(more, input);
        assert!(done.code == Some(2) && done.err.contains(reason), "{more:?}: {}", done.err);
    }
}

/// A line a fifth of a nanometre wide between two whole ones has its area times the observer there; where it lies between
/// them changes nothing. What is printed as the spectrum that is summed has the same sum.
#[test]
fn a_narrow_line_is_integrated() {
    let line = |centre: f64| {
        let [a, b] = [centre - 0.1, centre + 0.1];
        format!("wavelength_nm,s\n360,0\n{a},0\n{centre},1000\n{b},0\n830,0\n")
    };
    // 100 / Σȳ · 100 · (x̄, ȳ, z̄) at 532.3 nm, the observer linear between 532 and 533.
    let wanted = [0.192_75, 0.888_12, 0.036_19].map(|v| 1e4 / 106.856_917 * v);
    for (found, wanted) in rows(&colour(&[], &line(532.3)))[0].1.iter().zip(wanted) {
        near(*found, wanted, 0.02);
    }
    for centre in [531.5, 532.0, 532.1, 532.9, 533.0] {
        near(rows(&colour(&[], &line(centre)))[0].1[1], wanted[1], 0.02);
    }
    let spectra = colour(&["--spectra"], &line(532.3)).out;
    let sum: f64 =
        spectra.lines().skip(1).map(|l| l.split(',').nth(1).unwrap().parse::<f64>().unwrap()).sum();
    near(sum, 100.0, 1e-9);
}

/// A black body is as bright as white unless its radiance is asked for; then, as for any spectrum far beyond white, a
/// line says so.
#[test]
fn black_bodies_have_sensible_lightness() {
    let done = colour(&["--blackbody", "5778", "--blackbody", "2000"], "");
    for (name, values) in rows(&done) {
        near(values[1], 100.0, 1e-8);
        near(values[8], 100.0, 1e-8);
        assert!(values[5..8].iter().all(|v| *v > -1.0 && *v < 4.0), "{name}: {values:?}");
    }
    assert!(!done.err.contains("white"), "{}", done.err);
    let absolute = colour(&["--blackbody", "5778", "--white-y", "100"], "");
    assert!(rows(&absolute)[0].1[1] > 1e4);
    for done in [absolute, colour(&["--blackbody", "5778", "--scale", "photometric"], "")] {
        assert!(done.err.contains("but white is Y = "), "{}", done.err);
    }
    let bright = colour(&[], "wavelength_nm,lamp\n400,500\n700,500\n");
    assert!(bright.err.contains("warning: lamp: Y = 50000.0000, but white is Y = 100"), "{}", bright.err);
}
