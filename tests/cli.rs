//! `tyndall` as a process: what a user types, what comes back, what stands on the disk afterwards.

#[path = "common/mounted.rs"]
mod mounted;

mod cli {
    mod chart;
    mod committed;
    mod containers;
    mod damaged;
    mod differ;
    mod disk;
    mod farm;
    mod help;
    mod hostile;
    mod losses;
    mod many;
    mod media;
    mod options;
    mod places;
    mod points;
    mod recolour;
    mod refused;
    mod reused;
    mod round_trip;
    mod run;
    mod same_bytes;
    mod stopped;
    mod windows;
}
