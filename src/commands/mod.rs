//! One short file a command.
pub mod verify;
