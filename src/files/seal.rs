//! A manifest's hash of itself, by which a changed constant or matrix is noticed as a changed table is.

use super::manifest::{Manifest, Tool};
use crate::error::Result;
use std::collections::BTreeMap;

impl Tool {
    /// The program that is running, with the algorithms that it used.
    pub fn this(algorithms: BTreeMap<String, u32>) -> Self {
        Tool {
            name: "tyndall".into(),
            version: env!("CARGO_PKG_VERSION").into(),
            algorithms,
            source: String::new(),
        }
    }
}

impl Manifest {
    /// BLAKE3, 64 hexadecimal digits, of the manifest's text with `manifest_blake3` left out.
    ///
    /// # Errors
    /// As [`Manifest::to_json`].
    pub fn own_hash(&self) -> Result<String> {
        let bare = Manifest { manifest_blake3: String::new(), ..self.clone() };
        Ok(blake3::hash(bare.to_json()?.as_bytes()).to_hex().to_string())
    }

    /// Notes the manifest's own hash in it; the last thing to be done to it.
    pub fn seal(&mut self) -> Result<()> {
        self.manifest_blake3 = self.own_hash()?;
        Ok(())
    }

    /// Whether no value was changed since the seal (line ends and blanks may have been); true of one without a seal,
    /// of which nothing is known.
    pub fn seal_holds(&self) -> bool {
        self.manifest_blake3.is_empty() || self.own_hash().is_ok_and(|hash| hash == self.manifest_blake3)
    }
}
