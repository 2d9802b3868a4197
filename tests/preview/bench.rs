//! What `--bench` says.

use super::run::*;

/// Min, median, max and memory of a method's line.
fn row(line: &str) -> [f64; 4] {
    let numbers: Vec<f64> = line[22..].split_whitespace().map(|w| w.parse().unwrap()).collect();
    numbers.try_into().unwrap()
}

/// The number behind a text.
fn after(text: &str, words: &str) -> f64 {
    let rest = text.split(words).nth(1).unwrap_or_else(|| panic!("no {words} in {text}"));
    rest.split_whitespace().next().unwrap().parse().unwrap()
}

/// Three methods in the order, each with times that are in order and more memory than its textures alone take;
/// the ratios are those of the medians that are printed. Frames of marches hold less light and take longer.
#[test]
fn times_memory_and_ratios_are_told() {
    if !gpu() {
        return;
    }
    let done = preview(&[earth_once(), "--bench", "--frames", "3", "--size", "64x36"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    let text = &done.out;
    assert!(text.lines().next().unwrap().contains("compact, 64x36, 3 frames"), "{text}");
    // Half floats of four channels: 9 x 20 x 18 x 5 texels, two groups of 10 x 24 x 20 x 6, and planes.
    let textures = after(text, "the bake's textures are ");
    let volumes = 8e-6 * f64::from(9 * 20 * 18 * 5 + 2 * 10 * 24 * 20 * 6);
    assert!(textures > volumes && textures < volumes + 1.0, "{textures} MB, {volumes} of volumes");
    let (mut mins, mut medians) = (Vec::new(), Vec::new());
    let lines: Vec<&str> = text.lines().collect();
    for (line, name) in lines[2..5].iter().zip(["table ", "march ", "march "]) {
        assert!(line.starts_with(name), "{text}");
        let [min, median, max, memory] = row(line);
        assert!(0.0 < min && min <= median && median <= max, "{text}");
        assert!(memory > textures && memory < textures + 10.0, "{text}");
        mins.push(min);
        medians.push(median);
    }
    assert!(lines[4].contains(", 2D table"), "{text}");
    let near = |said: f64, is: f64| (said - is).abs() <= 0.006 + 0.002 * is;
    let march = after(text, "table : march : march with 2D table = 1 : ");
    assert!(near(march, medians[1] / medians[0]), "{text}");
    assert!(
        (after(text, "march over march with 2D table: ") - medians[1] / medians[2]).abs() < 0.06,
        "{text}"
    );
    // The quickest frames: what else the machine does only makes frames longer.
    assert!(mins[1] > mins[0] && mins[1] > mins[2], "{text}");
}

/// One method alone where one is asked for, and 200 frames where nothing is said; the paper's layout cannot march.
#[test]
fn one_method_alone() {
    if !gpu() {
        return;
    }
    let done = preview(&[earth(), "--bench", "--method", "march2d", "--steps", "5x1", "--size", "8x8"]);
    assert!(done.out.contains("200 frames") && done.out.contains("march 5, 2D table"), "{done:?}");
    assert!(!done.out.contains("ratio") && !done.out.contains("\ntable"), "{done:?}");
    let done = preview(&[earth(), "--bench", "--layout", "elek2010", "--frames", "1", "--size", "8x8"]);
    assert!(done.code == Some(0) && done.out.contains("no march"), "{done:?}");
}
