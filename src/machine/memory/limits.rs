//! What the limits of a process (`ulimit -v`, `ulimit -d`) leave it.

use super::read;

/// Bytes of address space and data that this process may still take, the less of the two; none without a limit, or
/// where the system does not say.
pub(super) fn left() -> Option<u64> {
    of(&read("/proc/self/limits")?, &read("/proc/self/status")?)
}

fn of(limits: &str, status: &str) -> Option<u64> {
    let one = |(limit, used): (&str, &str)| {
        let rest = limits.lines().find_map(|line| line.strip_prefix(limit))?;
        let most: u64 = rest.split_whitespace().next()?.parse().ok()?;
        let used = status.lines().find_map(|line| line.strip_prefix(used))?;
        Some(most.saturating_sub(used.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? * 1024))
    };
    [("Max address space", "VmSize:"), ("Max data size", "VmData:")].into_iter().filter_map(one).min()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lines of Linux as they are written: the soft limit counts, and what is in use already.
    #[test]
    fn what_limits_leave() {
        let status = "Name:\ttyndall\nVmSize:\t    1000 kB\nVmData:\t     100 kB\n";
        let limits = |data: &str, space: &str| {
            format!(
                "Limit                     Soft Limit           Hard Limit           Units     \n\
                 Max data size             {data:<20} unlimited            bytes     \n\
                 Max address space         {space:<20} unlimited            bytes     \n"
            )
        };
        assert_eq!(of(&limits("unlimited", "unlimited"), status), None);
        assert_eq!(of(&limits("unlimited", "2048000"), status), Some(1_024_000));
        assert_eq!(of(&limits("204800", "2048000"), status), Some(102_400));
        assert_eq!(of(&limits("unlimited", "3"), status), Some(0));
        assert_eq!(of("", status), None);
    }
}
