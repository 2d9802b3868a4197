//! What the preview says of pictures that it cannot write or that its tables do not hold.

use super::run::*;
use std::path::Path;

/// A picture is PNG; a name that promises another kind is refused before anything is drawn or written.
#[test]
fn only_png_is_written() {
    let dir = tempfile::tempdir().unwrap();
    for name in ["x.exr", "x.jpg", "x.hdr", "x.png.tiff"] {
        let out = dir.path().join(name);
        let done = preview(&[earth(), "--headless", "--out", out.to_str().unwrap()]);
        assert_eq!(done.code, Some(2), "{name}: {}", done.err);
        assert!(
            done.err.contains("only PNG can be written") && done.err.contains("x."),
            "{name}: {}",
            done.err
        );
        assert!(!out.exists());
    }
}

/// Without a display the line says what is missing and what needs none, and no path of another's source text.
#[test]
#[cfg(target_os = "linux")]
fn without_a_display_the_line_says_so() {
    let mut command = preview_command();
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    let done = command.arg(earth()).output().unwrap();
    let err = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(3), "{err}");
    assert!(err.contains("display: no window: ") && err.contains("--headless"), "{err}");
    assert!(!err.contains(".rs") && !err.contains("registry"), "{err}");
}

/// Tables of a window of suns are drawn with the nearest sun that they hold, and the picture comes with a warning; one
/// inside the window comes without.
#[test]
fn a_sun_that_is_not_held_is_told() {
    if !gpu() {
        return;
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("preview-told");
    let line = "bake earth --quiet --layout compact --wavelengths 5 --orders 2 --size compact=4x16x7x5 \
                --size compact-single=5x16x8x4 --suns -5..10 --altitudes 0..3km --out";
    let mut words: Vec<&str> = line.split_whitespace().collect();
    words.push(folder.to_str().unwrap());
    assert_eq!(tyndall(&words).code, Some(0));
    let bake = folder.join("earth");
    let draw = |more: &[&str]| {
        let out = folder.join("x.png");
        let mut words =
            vec![bake.to_str().unwrap(), "--headless", "--size", "64x36", "--out", out.to_str().unwrap()];
        words.extend(more);
        let done = preview(&words);
        assert_eq!(done.code, Some(0), "{}", done.err);
        done.err
    };
    let err = draw(&[]);
    assert!(err.contains("warning: mu_sun = 0.5") && err.contains("these tables hold suns from"), "{err}");
    assert!(draw(&["--sun", "5", "--altitude", "9000"]).contains("warning: altitude_m = 9000"));
    assert_eq!(draw(&["--sun", "5"]), "");
    let points = write_points(&folder, &[[2.0, 0.5, 0.05, 0.0], [2.0, 0.5, 0.9, 0.0]]);
    let done = preview(&[bake.to_str().unwrap(), "--points", &points]);
    assert!(done.code == Some(0) && done.err.contains("warning: view 2, mu_sun = 0.9"), "{}", done.err);
}
