//! Finished parts of a chart on disk, by content: what they were made of, and by which program.

use super::Effort;
use crate::error::{Error, Result};
use crate::files::bounded_read;
use crate::files::whole;
use crate::preset::Planet;
use serde::{Serialize, de::DeserializeOwned};
use std::path::{Path, PathBuf};

/// A folder of parts. A part is found again only by the program that made it, for the same planet and effort.
pub(super) struct Work {
    folder: PathBuf,
    made_of: String,
}

impl Work {
    /// Errors: a folder that cannot be made.
    pub(super) fn begin(folder: &Path, planet: &Planet, effort: Effort) -> Result<Work> {
        std::fs::create_dir_all(folder).map_err(|e| Error::machine(folder, e))?;
        let program = std::env::current_exe().and_then(std::fs::read);
        let program = program.map_err(|e| Error::machine("this program", e))?;
        let made_of = format!("{} {} {effort:?}", blake3::hash(&program).to_hex(), planet.hash());
        Ok(Work { folder: folder.to_path_buf(), made_of })
    }

    /// The part of that name: from the folder where it is there whole, made and kept otherwise.
    pub(super) fn part<T: Serialize + DeserializeOwned>(
        &self,
        name: &str,
        make: impl FnOnce() -> Result<T>,
    ) -> Result<T> {
        let address = blake3::hash(format!("{} {name}", self.made_of).as_bytes()).to_hex();
        let path = self.folder.join(format!("{address}.json"));
        let kept = bounded_read::named_text(&path, u64::MAX - 1)
            .ok()
            .and_then(|text| serde_json::from_str(&text).ok());
        if let Some(part) = kept {
            return Ok(part);
        }
        let part = make()?;
        let text = serde_json::to_vec(&part).map_err(|e| Error::machine(&path, e.into()))?;
        whole::write(&path, &text)?;
        Ok(part)
    }
}

/// Removes the parts in a folder of them, and the folder where nothing else is in it.
///
/// # Errors
/// `Machine` for a part that cannot be removed.
pub fn forget(folder: &Path) -> Result<()> {
    let is_part = |path: &PathBuf| {
        let address = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        path.extension().is_some_and(|e| e == "json")
            && address.len() == 64
            && address.bytes().all(|b| b.is_ascii_hexdigit())
    };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    for path in entries.map(|entry| entry.path()).filter(is_part) {
        std::fs::remove_file(&path).map_err(|e| Error::machine(&path, e))?;
    }
    // What else is in it is somebody's own.
    let _ = std::fs::remove_dir(folder);
    Ok(())
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
        std::fs::write(folder.path().join("notes.json"), "mine").unwrap();
        forget(folder.path()).unwrap();
        let left: Vec<_> =
            std::fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
        assert_eq!(left, ["notes.json"]);
        std::fs::remove_file(folder.path().join("notes.json")).unwrap();
        forget(folder.path()).unwrap();
        assert!(!folder.path().exists());
    }
}
