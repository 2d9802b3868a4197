//! `tyndall` as a process: what a user types, what comes back, what stands on the disk afterwards.

#[path = "common/mounted.rs"]
mod mounted;

mod cli {
    mod bytes;
    mod chart;
    mod colour_pipe;
    mod committed;
    mod containers;
    mod damaged;
    mod differ;
    mod disk;
    mod farm;
    mod giants;
    mod help;
    mod help_width;
    mod hostile;
    mod kept;
    mod limits;
    mod losses;
    mod many;
    mod media;
    mod names;
    mod opened;
    mod options;
    mod places;
    mod points;
    mod recolour;
    mod refused;
    mod reused;
    mod round_trip;
    mod run;
    mod same_bytes;
    mod slips;
    mod spoken;
    mod stopped;
    mod windows;
}
