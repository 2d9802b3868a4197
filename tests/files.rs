//! Files as another program meets them: EXR bytes, and folders that are replaced whole or not at all.

#[path = "common/mounted.rs"]
mod mounted;

mod files {
    mod disk;
    mod exr;
    mod staging;
    mod verify;
}
