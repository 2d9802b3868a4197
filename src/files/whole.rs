//! One file, written beside its place and moved there whole: who reads it, or stops the program, never meets half of it,
//! and a full disk leaves nothing but what was there.

use super::bounded_read::system;
use super::interrupt::undisturbed;
use crate::error::{Error, Result};
use std::fs;
use std::io::{self, Write};
use std::path::Path;

/// Writes a file. A link is followed; what is no file, such as `/dev/stdout` or a pipe, is written to as it is.
///
/// # Errors
/// `Machine` with the file's name, and `Interrupted`.
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let found = fs::metadata(path).ok();
    // What the system lends a name for, also where a shell has led it to a file.
    let lent = ["/dev", "/proc"].iter().any(|folder| path.starts_with(folder));
    let written = || match &found {
        Some(found) if lent || !found.is_file() => write_to(path, bytes),
        _ => beside(&fs::canonicalize(path).unwrap_or(path.into()), bytes, found.map(|f| f.permissions())),
    };
    undisturbed(|| written().map_err(|e| Error::machine(path, plain(e))))
}

/// Without the name of the file beside, which is no business of the user.
fn plain(e: io::Error) -> io::Error {
    match e.to_string().split_once(" at path ") {
        Some((reason, _)) => io::Error::new(e.kind(), reason),
        None => e,
    }
}

fn beside(path: &Path, bytes: &[u8], permissions: Option<fs::Permissions>) -> io::Result<()> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // It goes with its value where the rest fails.
    let mut file = allowed(tempfile::Builder::new().prefix(".tyndall-")).tempfile_in(folder)?;
    file.write_all(bytes)?;
    permissions.map_or(Ok(()), |as_before| file.as_file().set_permissions(as_before))?;
    file.persist(path).map(drop).map_err(|e| e.error)
}

/// With the permissions of any new file, not those of a secret one.
#[cfg(unix)]
fn allowed<'a, 'b>(builder: &'a mut tempfile::Builder<'b, 'b>) -> &'a mut tempfile::Builder<'b, 'b> {
    use std::os::unix::fs::PermissionsExt;
    builder.permissions(fs::Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn allowed<'a, 'b>(builder: &'a mut tempfile::Builder<'b, 'b>) -> &'a mut tempfile::Builder<'b, 'b> {
    builder
}

/// Fails where nobody reads a pipe.
fn write_to(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = system::at_once(fs::File::options().write(true)).open(path)?;
    system::wait_again(&file)?;
    file.write_all(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// New files and old ones, behind a link too, whose place stays a link; a folder that is full or missing is left as
    /// it was.
    #[cfg(unix)]
    #[test]
    fn whole_or_not_at_all() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let dir = tempfile::tempdir().unwrap();
        let [file, link] = ["file", "link"].map(|name| dir.path().join(name));
        symlink("file", &link).unwrap();
        for (path, text) in [(&file, "one"), (&file, "two"), (&link, "three")] {
            write(path, text.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(&file).unwrap(), text);
        }
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        write(&file, b"four").unwrap();
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
        // Who has it open reads what it was.
        let mut open = fs::File::open(&file).unwrap();
        write(&file, b"five").unwrap();
        assert_eq!(io::read_to_string(&mut open).unwrap(), "four");
        assert_eq!(write(&dir.path().join("none/file"), b"").unwrap_err().exit_code(), 3);
        assert_eq!(write(&dir.path().join("file/file"), b"").unwrap_err().exit_code(), 3);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 2);
        write(Path::new("/dev/null"), b"six").unwrap();
    }
}
