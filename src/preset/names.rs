//! Names that somebody typed and nobody knows: which known one was meant.

/// Letters of a word that are compared: more than any name has. The comparison takes memory as the product of lengths,
/// and the word may be a stranger's of megabytes.
const MOST_COMPARED: usize = 64;

/// The candidate with the fewest letters to change (Damerau–Levenshtein, upper and lower case alike), the first of
/// equals. None where more than a third of the letters of the longer word would change: then another thing was meant.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word: String = word.chars().take(MOST_COMPARED).flat_map(char::to_lowercase).collect();
    let length = word.chars().count();
    let changes = |candidate: &str| {
        // Each letter more or less is a change: most candidates are out without a comparison.
        let other = candidate.chars().count();
        if 3 * length.abs_diff(other) > length.max(other) {
            return None;
        }
        let changes = strsim::damerau_levenshtein(&word, &candidate.to_lowercase());
        (3 * changes <= length.max(other)).then_some(changes)
    };
    let near = candidates.into_iter().filter_map(|candidate| Some((changes(candidate)?, candidate)));
    near.min_by_key(|(changes, _)| *changes).map(|(_, candidate)| candidate)
}

/// What to say of an unknown word: the nearest known one, or all of them where none is near.
pub fn known<'a>(word: &str, all: impl IntoIterator<Item = &'a str> + Clone) -> String {
    match nearest(word, all.clone()) {
        Some(near) => format!("the nearest known one is `{near}`"),
        None => format!("known are {}", quoted(all)),
    }
}

/// Names in backquotes, with commas between.
pub fn quoted<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    names.into_iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// Whether a text is a number, with a point or a comma.
pub fn is_number(text: &str) -> bool {
    text.trim().replacen(',', ".", 1).parse::<f64>().is_ok_and(f64::is_finite)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One slip brings the word that was meant, two letters in each other's place count once, and case counts nothing. A
    /// word that has nothing to do with any of them brings none.
    #[test]
    fn only_near_names_are_offered() {
        let known = ["radius_m", "distance_au", "spectrum", "top"];
        assert_eq!(nearest("raduis_m", known), Some("radius_m"));
        assert_eq!(nearest("Spectrum", known), Some("spectrum"));
        assert_eq!(nearest("SPECTRM", known), Some("spectrum"));
        assert_eq!(nearest("tops", known), Some("top"));
        for far in ["irradiance", "raduis_kilometres", "x", "", "tip_top"] {
            assert_eq!(nearest(far, known), None, "{far}");
        }
        assert_eq!(nearest(&"k".repeat(8 << 20), known), None);
    }

    /// A third of six letters is two, not three.
    #[test]
    fn a_third_of_the_letters_is_the_limit() {
        assert_eq!(nearest("abxyef", ["abcdef"]), Some("abcdef"));
        assert_eq!(nearest("axyzef", ["abcdef"]), None);
    }

    /// What a German spreadsheet writes is a number too; a name with a number in it is none.
    #[test]
    fn numbers_as_text() {
        assert!(["0.76", " 5778 ", "0,76", "-1e3"].iter().all(|text| is_number(text)));
        assert!(["", "sun-5778", "1,2,3", "nan", "inf"].iter().all(|text| !is_number(text)));
    }
}
