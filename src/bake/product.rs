//! A finished bake in memory: its files, to be written or looked up in.

use crate::error::{Error, Result};
use crate::files::manifest::Manifest;
use crate::files::staging::Staging;
use crate::files::{Atlas, exr};
use crate::layout::sky::{self, Sky};
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

/// What messages call a bake that is in no folder yet.
pub(crate) const IN_MEMORY: &str = "the bake in memory";

/// A finished bake in memory: every file of it, `bake.json` included, and the manifest as a value.
pub struct Product {
    /// Path inside the bake, and content.
    pub files: Vec<(String, Vec<u8>)>,
    /// What `bake.json` holds.
    pub manifest: Manifest,
    /// Processor time of all threads that the solver took, now or in an earlier bake that solved the same light.
    pub light_cpu: Duration,
}

impl Product {
    /// Writes the bake into a folder. An older bake there is replaced whole, and only when the new one is complete.
    ///
    /// # Errors
    /// `Machine` where the disk refuses, `File` where the folder holds something that is no bake.
    pub fn write(&self, folder: &Path) -> Result<()> {
        self.write_into(Staging::begin(folder)?)
    }

    /// Like [`Product::write`], into a folder that is already claimed.
    pub(crate) fn write_into(&self, staging: Staging) -> Result<()> {
        for (file, bytes) in &self.files {
            staging.write(file, bytes)?;
        }
        staging.commit()
    }

    /// Opens the tables of a layout for look-ups, by its name in `bake.json` (`compact`, `elek2010`, …).
    ///
    /// # Errors
    /// `Argument` for a layout that was not baked.
    pub fn sky(&self, layout: &str) -> Result<Box<dyn Sky>> {
        let pictures = self.pictures(layout)?;
        if pictures.is_empty() {
            return Err(Error::Argument(format!("layout {layout}: not in this bake")));
        }
        sky::of_pictures(Path::new(IN_MEMORY), &self.manifest, layout, &pictures)
    }

    /// The decoded tables of a layout, by name; none where it was not baked.
    ///
    /// # Errors
    /// `File` for a table that `files` has not, or not as EXR.
    pub fn pictures(&self, layout: &str) -> Result<BTreeMap<String, Atlas>> {
        let files: BTreeMap<&str, &[u8]> =
            self.files.iter().map(|(file, bytes)| (file.as_str(), bytes.as_slice())).collect();
        let tables = self.manifest.tables.iter().filter(|t| t.layout == layout);
        tables
            .map(|table| {
                let path = Path::new(&table.file);
                let bytes =
                    files.get(table.file.as_str()).ok_or_else(|| Error::file(path, "not in this bake"))?;
                Ok((table.name.clone(), exr::from_exr_bytes(path, bytes)?))
            })
            .collect()
    }
}
