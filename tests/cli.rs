//! `tyndall` as a process: what a user types, what comes back, what stands on the disk afterwards.

#[path = "common/mounted.rs"]
mod mounted;

mod cli {
    mod damaged;
    mod disk;
    mod help;
    mod many;
    mod media;
    mod options;
    mod places;
    mod points;
    mod refused;
    mod round_trip;
    mod run;
    mod same_bytes;
    mod stopped;
    mod windows;
}
