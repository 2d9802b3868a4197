//! Numbers as text, and where text goes.

pub(super) use crate::machine::output::{print, say, stream, watched};

/// A number to nine significant digits: plain where that is short, else with an exponent.
pub(super) fn number(v: f64) -> String {
    let size = v.abs();
    if v == 0.0 || !v.is_finite() {
        return format!("{v}");
    }
    if !(1e-4..1e7).contains(&size) {
        return format!("{v:.8e}");
    }
    let before_point = libm::floor(libm::log10(size)) as i32 + 1;
    format!("{v:.*}", (9 - before_point).max(0) as usize)
}

#[cfg(test)]
mod tests {
    use super::number;

    /// Nine digits in every size of number, so that 1e-6 relative is told from the printed text.
    #[test]
    fn nine_digits() {
        assert_eq!(number(95.047), "95.0470000");
        assert_eq!(number(-0.012_345_678_912), "-0.0123456789");
        assert_eq!(number(1.5e-7), "1.50000000e-7");
        assert_eq!(number(2.637353833e13), "2.63735383e13");
        assert_eq!(number(0.0), "0");
    }
}
