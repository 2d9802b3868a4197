//! Help in a terminal of eighty columns.

use super::run::*;

/// Every command, and the program itself.
fn commands() -> impl Iterator<Item = &'static str> {
    super::help::COMMANDS.into_iter().chain([""])
}

/// A help as a terminal of so many columns shows it.
fn help(command: &str, columns: &str) -> String {
    let words: Vec<&str> = command.split_whitespace().chain(["--help"]).collect();
    let done = ran(super::run::command().args(words).env("COLUMNS", columns).output().unwrap());
    assert_eq!(done.code, Some(0), "{}", done.err);
    done.out
}

/// A line of free text that was broken by hand and is longer than eighty columns is broken by the terminal again, and
/// leaves a stump: wherever a sentence goes on in the next line, the line is short.
#[test]
fn no_line_is_broken_twice() {
    for command in commands() {
        let text = help(command, "1000");
        let lines: Vec<&str> = text.lines().collect();
        for pair in lines.windows(2).filter(|pair| !pair.iter().any(|l| l.is_empty() || l.starts_with(' '))) {
            let goes_on = !pair[0].ends_with(['.', ':', ';', ')']);
            let long = pair[0].chars().count() > 80;
            assert!(!(long && goes_on), "{command}: {}", pair[0]);
        }
    }
}

/// No line is longer than the terminal is wide, but for a word that cannot be broken.
#[test]
fn lines_fit_the_terminal() {
    for command in commands() {
        for line in help(command, "80").lines() {
            let fits = line.chars().count() <= 80 || line.split_whitespace().count() < 3;
            assert!(fits, "{command}: {line}");
        }
    }
}

/// What is printed as the default of a list can be typed as it is printed: with commas.
#[test]
fn defaults_are_printed_as_they_are_accepted() {
    let mut lists = 0;
    for command in commands() {
        let text = help(command, "1000");
        for default in text.split("[default: ").skip(1).filter_map(|rest| rest.split(']').next()) {
            let words: Vec<&str> = default.split_whitespace().collect();
            let is_value = |word: &&str| word.contains(|c: char| c.is_ascii_digit());
            // Prose says what happens without the option; values stand alone or have commas between them.
            let apart = words.len() > 1 && words.iter().all(is_value);
            assert!(!apart, "{command}: {default}");
            lists += usize::from(words.len() == 1 && default.contains(','));
        }
    }
    assert!(lists >= 3, "{lists}");
    assert!(help("bake", "1000").contains("[default: elek2010,compact]"));
}
