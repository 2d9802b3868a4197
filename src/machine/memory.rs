//! Memory: how much the machine has left, and amounts as people write them.

mod allocator;
mod groups;
mod limits;

pub use allocator::{Allocator, clean_up_at_the_end_of_memory};

use crate::error::Result;
use std::path::Path;

/// Bytes that can still be had without swapping: of the machine, of the control groups or of the limits of this process
/// where that is less. None where the system does not say.
pub fn available() -> Option<u64> {
    [machine(), groups::left(), limits::left()].into_iter().flatten().min()
}

fn machine() -> Option<u64> {
    of_meminfo(&read("/proc/meminfo")?)
}

fn read(path: impl AsRef<Path>) -> Option<String> {
    std::fs::read_to_string(path).ok()
}

/// The kernel's own estimate, in kilobytes.
fn of_meminfo(text: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

const UNITS: [(&str, f64); 8] = [
    ("B", 1.0),
    ("kB", 1e3),
    ("MB", 1e6),
    ("GB", 1e9),
    ("KiB", 1024.0),
    ("MiB", 1_048_576.0),
    ("GiB", 1_073_741_824.0),
    ("TiB", 1_099_511_627_776.0),
];

/// An amount of memory as a text: a number and a unit (`2GiB`, `500 MB`), without a unit bytes.
pub fn parse(text: &str) -> Result<u64> {
    let end = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
    let (number, unit) = (text[..end].trim(), text[end..].trim());
    let factor = UNITS.iter().find(|u| u.0.eq_ignore_ascii_case(unit)).map(|u| u.1);
    match (number.parse::<f64>(), factor.or(unit.is_empty().then_some(1.0))) {
        (Ok(n), Some(factor)) if n > 0.0 && n * factor <= 1e18 => Ok((n * factor) as u64),
        _ => Err("expected an amount of memory, e.g. 2GiB or 500MB".into()),
    }
}

/// An amount for people.
pub fn shown(bytes: u64) -> String {
    match bytes as f64 {
        b if b >= 1e9 => format!("{:.1} GB", b / 1e9),
        b => format!("{:.0} MB", b / 1e6),
    }
}

/// What a program may take without asking, bytes: any machine has as much.
const SMALL: u64 = 256 << 20;
/// The same of a control group, which swaps or is killed.
const TRIFLE: u64 = 16 << 20;

/// Whether so many bytes can be had now; the reason why not. Asked before anything of a size is made that a stranger's
/// file or a slip of the pen decides.
pub fn check(need: u64) -> Result<()> {
    // A limit of the process lets nothing through.
    let bounds = [(machine(), SMALL), (groups::left(), TRIFLE), (limits::left(), 0)];
    let too_little = |(left, least): &(Option<u64>, u64)| left.filter(|&left| need > left.max(*least));
    match bounds.iter().filter_map(too_little).min() {
        Some(free) => {
            Err(format!("takes some {} of memory, and {} are free", shown(need), shown(free)).into())
        }
        None => Ok(()),
    }
}

/// Largest resident size of this process so far, bytes.
pub fn peak() -> Option<u64> {
    let status = read("/proc/self/status")?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Binary and decimal units, with and without a space; nothing else.
    #[test]
    fn amounts_are_read() {
        assert_eq!(parse("2GiB").unwrap(), 2 << 30);
        assert_eq!(parse("1.5 GB").unwrap(), 1_500_000_000);
        assert_eq!(parse("750mb").unwrap(), 750_000_000);
        assert_eq!(parse("4096").unwrap(), 4096);
        for bad in ["", "GiB", "-1GB", "0", "2 lakes", "NaN", "inf", "1e30GB", "2GiB2"] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }

    /// More than any machine has is refused, a megabyte is not.
    #[test]
    fn more_than_there_is() {
        check(1 << 20).unwrap();
        if available().is_some() {
            let reason = check(1 << 60).unwrap_err().to_string();
            assert!(reason.starts_with("takes some 1152921504.6 GB of memory, and "), "{reason}");
        }
    }

    /// The lines of Linux as they are written.
    #[test]
    fn what_linux_says() {
        let text = "MemTotal:       24684020 kB\nMemFree:  1 kB\nMemAvailable:   23473568 kB\n";
        assert_eq!(of_meminfo(text), Some(23_473_568 * 1024));
        assert_eq!(of_meminfo("MemTotal: 3 kB\n"), None);
    }
}
