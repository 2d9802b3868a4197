//! The machine: vector lanes and instruction sets, processor time, memory, standard output.

pub mod cpu_time;
pub mod isa;
pub mod lanes;
pub mod memory;
pub mod output;
