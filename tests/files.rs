//! Files as another program meets them: EXR bytes, and folders that are replaced whole or not at all.

mod files {
    mod exr;
    mod staging;
    mod verify;
}
