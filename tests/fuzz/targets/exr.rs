//! Any bytes as an EXR file: refused in one line, or a table that is written and read as it is.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::path::Path;
use tyndall::export::exr::{from_exr_bytes, to_exr_bytes};

fuzz_target!(|bytes: &[u8]| match from_exr_bytes(Path::new("fuzz.exr"), bytes) {
    Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
    Ok(atlas) => {
        // What is not finite is refused, by name.
        if let Ok(again) = to_exr_bytes(&atlas) {
            assert!(from_exr_bytes(Path::new("fuzz.exr"), &again).is_ok());
        }
    }
});
