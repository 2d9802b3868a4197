//! Tables of views with slips in them.

use super::run::*;
use std::fs;

/// Each slip is named by file, line, column and value, and nothing is answered.
#[test]
fn slips_are_located() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("views.csv");
    let head = "altitude_m,mu_view,mu_sun,azimuth_deg";
    for (text, reasons) in [
        ("altitude_m,mu_view,azimuth_deg\n0,1,0\n".to_string(), &["column mu_sun is missing"][..]),
        (format!("{head}\n0,1,0.5,0\n0,up,0.5,0\n"), &["line 3, mu_view = up: not a number"]),
        (format!("{head}\n0,1,NaN,0\n"), &["line 2, mu_sun = NaN: not a finite number"]),
        (format!("{head}\n0,1,0.5,1e999\n"), &["line 2, azimuth_deg = 1e999: not a finite number"]),
        (format!("{head}\n0,1,0.5,0\n-1,1,0.5,0\n"), &["line 3, altitude_m = -1: below the ground"]),
        (format!("{head}\n0,1.01,0.5,0\n"), &["line 2, mu_view = 1.01", "between -1 and 1"]),
        (format!("{head}\n0,1,-2,0\n"), &["line 2, mu_sun = -2", "between -1 and 1"]),
        (format!("{head}\n0,1,0.5\n"), &["line 2: 3 fields, not 4"]),
        (format!("{head}\n0,0,5,1,0\n"), &["line 2: 5 fields, not 4"]),
        (String::new(), &["column altitude_m is missing"]),
    ] {
        fs::write(&file, &text).unwrap();
        for command in ["sample", "reference"] {
            let of = if command == "sample" { earth().to_str().unwrap() } else { "earth" };
            let done = tyndall(&[command, of, "--points", file.to_str().unwrap()]);
            assert_eq!((done.code, done.out.as_str()), (Some(2), ""), "{command} {text:?}: {}", done.err);
            assert!(done.err.contains("views.csv: "), "{}", done.err);
            for reason in reasons {
                assert!(done.err.contains(reason), "`{reason}` is not in: {}", done.err);
            }
        }
    }
}

/// Columns are found by name: another order and a column more give the same numbers.
#[test]
fn columns_are_found_by_name() {
    let dir = tempfile::tempdir().unwrap();
    let answer = |text: &str| {
        let file = dir.path().join("views.csv");
        fs::write(&file, text).unwrap();
        let done = tyndall(&["sample", earth().to_str().unwrap(), "--points", file.to_str().unwrap()]);
        assert_eq!(done.code, Some(0), "{}", done.err);
        done.out
    };
    let plain = answer("altitude_m,mu_view,mu_sun,azimuth_deg\n10,0.5,0.25,30\n");
    assert_eq!(plain.lines().count(), 1 + 4, "a line for each wavelength");
    assert_eq!(answer("name, mu_sun,azimuth_deg,mu_view ,altitude_m\na,0.25,30,0.5,10\n"), plain);
}
