//! Filesystems that can be filled or made read-only.

use std::path::Path;
use std::process::Command;
use tempfile::{TempDir, tempdir};

/// A small filesystem of its own; `None`, with the reason printed, where this user may not mount one.
pub struct Mounted(TempDir);

impl Mounted {
    pub fn new(options: &str) -> Option<Self> {
        let dir = tempdir().unwrap();
        let mount =
            Command::new("mount").args(["-t", "tmpfs", "-o", options, "tmpfs"]).arg(dir.path()).output();
        let reason = match mount {
            Ok(output) if output.status.success() => return Some(Mounted(dir)),
            Ok(output) => String::from_utf8_lossy(&output.stderr).trim().to_string(),
            Err(e) => e.to_string(),
        };
        eprintln!("skipped: a small filesystem cannot be mounted here: {reason}");
        None
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }
}

impl Drop for Mounted {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.0.path()).status();
    }
}
