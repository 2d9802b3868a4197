//! All targets in one program, which is built once: `TYNDALL_FUZZ` names the one to run.
#![no_main]

#[path = "../bodies/mod.rs"]
mod bodies;

use std::sync::OnceLock;

fn name() -> &'static str {
    static NAME: OnceLock<String> = OnceLock::new();
    NAME.get_or_init(|| std::env::var("TYNDALL_FUZZ").expect("TYNDALL_FUZZ names a target, see scripts/fuzz"))
}

// The bake that some targets work on takes longer than any input may.
libfuzzer_sys::fuzz_target!(init: bodies::run(name(), b""), |bytes: &[u8]| bodies::run(name(), bytes));
