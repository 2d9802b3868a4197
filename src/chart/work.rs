//! Finished parts of a chart on disk, by content: what they were made of, and by which program.

use super::Effort;
use crate::error::{Error, Result};
use crate::preset::Planet;
use serde::{Serialize, de::DeserializeOwned};
use std::path::{Path, PathBuf};

/// A folder of parts. A part is found again only by the program that made it, for the same planet and effort.
pub struct Work {
    folder: PathBuf,
    made_of: String,
}

impl Work {
    /// Errors: a folder that cannot be made.
    pub fn begin(folder: &Path, planet: &Planet, effort: Effort) -> Result<Work> {
        std::fs::create_dir_all(folder).map_err(|e| Error::machine(folder, e))?;
        let program = std::env::current_exe().and_then(std::fs::read);
        let program = program.map_err(|e| Error::machine("this program", e))?;
        let made_of = format!("{} {} {effort:?}", blake3::hash(&program).to_hex(), planet.hash());
        Ok(Work { folder: folder.to_path_buf(), made_of })
    }

    /// The part of that name: from the folder where it is there whole, made and kept otherwise.
    pub fn part<T: Serialize + DeserializeOwned>(
        &self,
        name: &str,
        make: impl FnOnce() -> Result<T>,
    ) -> Result<T> {
        let address = blake3::hash(format!("{} {name}", self.made_of).as_bytes()).to_hex();
        let path = self.folder.join(format!("{address}.json"));
        let kept = std::fs::read(&path).ok().and_then(|text| serde_json::from_slice(&text).ok());
        if let Some(part) = kept {
            return Ok(part);
        }
        let part = make()?;
        let text = serde_json::to_vec(&part).map_err(|e| Error::machine(&path, e.into()))?;
        // Beside, then renamed: a part is there whole or not at all.
        let beside = path.with_extension("tmp");
        std::fs::write(&beside, text).map_err(|e| Error::machine(&beside, e))?;
        std::fs::rename(&beside, &path).map_err(|e| Error::machine(&path, e))?;
        Ok(part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A part that stands there is not made again, not even by an answer that would differ; one of another effort or a
    /// damaged one is.
    #[test]
    fn parts_are_kept_by_what_they_are_made_of() {
        let folder = tempfile::tempdir().unwrap();
        let planet = crate::preset::load("mars", &[]).unwrap();
        let begin = |effort| Work::begin(folder.path(), &planet, effort).unwrap();
        let work = begin(Effort::default());
        assert_eq!(work.part("a", || Ok(1)).unwrap(), 1);
        assert_eq!(begin(Effort::default()).part("a", || Ok(2)).unwrap(), 1);
        assert_eq!(begin(Effort { views: 3, ..Effort::default() }).part("a", || Ok(3)).unwrap(), 3);
        for file in std::fs::read_dir(folder.path()).unwrap() {
            std::fs::write(file.unwrap().path(), "{").unwrap();
        }
        assert_eq!(work.part("a", || Ok(4)).unwrap(), 4);
    }
}
