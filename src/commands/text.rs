//! Numbers and lines of text output.

use crate::error::{Error, Result};
use std::io::Write;

/// A number to nine significant digits: plain where that is short, else with an exponent.
pub fn number(v: f64) -> String {
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

/// Writes a long answer to standard output bit by bit, so that it is never whole in memory; as [`print`].
pub fn stream(write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> Result<()> {
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    match write(&mut out).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(Error::machine("standard output", e)),
        _ => Ok(()),
    }
}

/// A line on standard error. Not eprintln, which panics where nobody reads it.
pub fn talk(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// Writes to standard output. A reader that has seen enough (`| head`) is no failure.
pub fn print(text: &str) -> Result<()> {
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(Error::machine("standard output", e)),
        _ => Ok(()),
    }
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
