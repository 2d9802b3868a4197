//! Processor time, which other work on the machine lengthens less than it does the time of day.

use std::time::Duration;

/// Processor time of this process so far, all threads; zero where the system does not tell.
pub fn cpu_time() -> Duration {
    #[cfg(target_os = "linux")]
    return time_of(rustix::time::ClockId::ProcessCPUTime);
    #[cfg(not(target_os = "linux"))]
    Duration::ZERO
}

/// Processor time of the calling thread so far; time since the first call where the system does not tell.
pub fn thread_time() -> Duration {
    #[cfg(target_os = "linux")]
    return time_of(rustix::time::ClockId::ThreadCPUTime);
    #[cfg(not(target_os = "linux"))]
    {
        static START: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
        START.get_or_init(std::time::Instant::now).elapsed()
    }
}

#[cfg(target_os = "linux")]
fn time_of(clock: rustix::time::ClockId) -> Duration {
    let time = rustix::time::clock_gettime(clock);
    Duration::new(time.tv_sec.max(0) as u64, time.tv_nsec.max(0) as u32)
}
