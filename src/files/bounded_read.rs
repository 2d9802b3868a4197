//! Files that strangers may have made, read with bounds: a device that never ends, a sparse file of a terabyte, a pipe
//! that nobody writes to end in a line of text and not in the machine's memory.

use crate::error::{Error, Result};
use crate::machine::memory;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Cursor, Read};
use std::path::{Component, Path, PathBuf};
use std::time::{Duration, Instant};

/// Bytes of a JSON file at most. In memory it takes some forty times as much where it is all short numbers; the largest
/// preset that is shipped has 30 kB.
pub const MOST_JSON: u64 = 16 << 20;
/// Bytes of a CSV file or list at most.
pub const MOST_CSV: u64 = 128 << 20;

const BYTE_ORDER_MARK: &str = "\u{feff}";

/// The text of a file that the user named: also a pipe, as shells make one of `<(…)`.
///
/// # Errors
/// `File` for a missing or too long one, or one that is no text.
pub fn text(path: &Path, most: u64) -> Result<String> {
    text_of(path, open(path)?, most)
}

/// A file that the user named, from its beginning: also a pipe, as soon as somebody writes to it.
///
/// # Errors
/// `File` for a missing one, and for a pipe that nobody opens to write to.
pub fn open(path: &Path) -> Result<impl Read> {
    begun(path).map_err(|e| Error::reading(path, e))
}

fn begun(path: &Path) -> io::Result<impl Read> {
    let mut file = system::at_once(File::options().read(true)).open(path)?;
    let first = if system::is_pipe(&file.metadata()?) { first_bytes(&mut file)? } else { Vec::new() };
    system::wait_again(&file)?;
    Ok(Cursor::new(first).chain(file))
}

/// How long a pipe may be without anybody at its other end: shells open it before they start a program.
const PATIENCE: Duration = Duration::from_secs(2);

/// The first bytes of a pipe, none where its writer has none yet.
fn first_bytes(pipe: &mut File) -> io::Result<Vec<u8>> {
    let start = Instant::now();
    let mut buffer = [0; 4096];
    while start.elapsed() < PATIENCE {
        match pipe.read(&mut buffer) {
            Ok(0) => std::thread::sleep(Duration::from_millis(10)),
            Ok(count) => return Ok(buffer[..count].to_vec()),
            Err(e) if e.kind() == io::ErrorKind::WouldBlock => return Ok(Vec::new()),
            Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
            Err(e) => return Err(e),
        }
    }
    Err(invalid("a pipe that nobody writes to"))
}

/// The same of a stream; `path` is for messages only.
///
/// # Errors
/// As [`text`].
pub fn text_of(path: &Path, stream: impl Read, most: u64) -> Result<String> {
    let mut bytes = Vec::new();
    // The byte after the last tells a file that ends there from one that goes on.
    stream.take(most + 1).read_to_end(&mut bytes).map_err(|e| Error::reading(path, e))?;
    if bytes.len() as u64 > most {
        return Err(Error::file(path, format!("longer than {most} bytes, which are the most")));
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(Error::file(path, "is UTF-16: save it as UTF-8"));
    }
    // Some editors mark UTF-8 by a character that is no part of the text.
    if bytes.starts_with(BYTE_ORDER_MARK.as_bytes()) {
        bytes.drain(..BYTE_ORDER_MARK.len());
    }
    String::from_utf8(bytes).map_err(|e| {
        let reason = format!("not UTF-8 at byte {}", e.utf8_error().valid_up_to() + 1);
        Error::file(path, reason)
    })
}

/// The text of a file that another file names: no pipe or device, on which a reader could wait for ever.
///
/// # Errors
/// As [`text`].
pub fn named_text(path: &Path, most: u64) -> Result<String> {
    let file = regular(path, File::options().read(true)).map_err(|e| Error::reading(path, e))?;
    text_of(path, file, most)
}

/// The text of a file inside a bake, by its path there.
///
/// # Errors
/// As [`text`], and for a link that leads out of the bake.
pub fn part_text(folder: &Path, file: &str, most: u64) -> Result<String> {
    let path = folder.join(file);
    let real = place(folder, file).map_err(|e| Error::reading(&path, e))?;
    let file = regular(&real, File::options().read(true)).map_err(|e| Error::reading(&path, e))?;
    text_of(&path, file, most)
}

/// The bytes of a file inside a bake, by its path there.
///
/// # Errors
/// Of kind `InvalidData` for a path or link that leads out of the bake, and for what is no file or does not fit into
/// memory.
pub fn part(folder: &Path, file: &str) -> io::Result<Vec<u8>> {
    let mut from = regular(&place(folder, file)?, File::options().read(true))?;
    let length = from.metadata()?.len();
    memory::check(length).map_err(|reason| invalid(&reason.to_string()))?;
    let mut bytes = Vec::with_capacity(length as usize);
    from.by_ref().take(length).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Whether a path of a manifest stays in its folder.
pub fn is_inside(file: &str) -> bool {
    !file.is_empty() && Path::new(file).components().all(|c| matches!(c, Component::Normal(_)))
}

/// Where a file of a bake really is, links on the way followed.
fn place(folder: &Path, file: &str) -> io::Result<PathBuf> {
    if !is_inside(file) {
        return Err(invalid("the manifest points outside the bake"));
    }
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let (root, real) = (fs::canonicalize(folder)?, fs::canonicalize(folder.join(file))?);
    if real.starts_with(root) { Ok(real) } else { Err(invalid("a link that leads out of the bake")) }
}

/// A file that is no pipe, device or folder, opened with `options`: never waits for somebody at the other end.
pub fn regular(path: &Path, options: &mut OpenOptions) -> io::Result<File> {
    refuse_others(&fs::metadata(path)?)?;
    // Something else may have come into its place since.
    let file = system::at_once(options).open(path)?;
    refuse_others(&file.metadata()?)?;
    Ok(file)
}

fn refuse_others(found: &Metadata) -> io::Result<()> {
    match found.is_file() {
        true => Ok(()),
        false if found.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        false => Err(invalid("not a file but a device, pipe or socket")),
    }
}

#[cfg(unix)]
pub(crate) mod system {
    use super::{File, Metadata, OpenOptions, io};
    use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
    use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};

    pub(crate) fn is_pipe(found: &Metadata) -> bool {
        found.file_type().is_fifo()
    }

    /// Opens without waiting for the other end of a pipe.
    pub(crate) fn at_once(options: &mut OpenOptions) -> &mut OpenOptions {
        options.custom_flags(OFlags::NONBLOCK.bits() as i32)
    }

    /// From here on reads wait for bytes.
    pub(crate) fn wait_again(file: &File) -> io::Result<()> {
        Ok(fcntl_setfl(file, fcntl_getfl(file)? - OFlags::NONBLOCK)?)
    }
}

#[cfg(not(unix))]
pub(crate) mod system {
    use super::{File, Metadata, OpenOptions, io};

    pub fn is_pipe(_: &Metadata) -> bool {
        false
    }

    pub fn at_once(options: &mut OpenOptions) -> &mut OpenOptions {
        options
    }

    pub fn wait_again(_: &File) -> io::Result<()> {
        Ok(())
    }
}

fn invalid(reason: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A text as long as allowed is read, one byte more is refused, whatever it is; so are devices that other files name.
    #[test]
    fn bounds_hold() {
        let text = |bytes: &[u8]| text_of(Path::new("a"), bytes, 3).map_err(|e| e.to_string());
        assert_eq!(text(b"abc"), Ok("abc".into()));
        assert_eq!(text(b"abcd"), Err("a: longer than 3 bytes, which are the most".into()));
        assert!(text(b"a\xff").is_err());
        #[cfg(target_os = "linux")]
        {
            let zero = super::text(Path::new("/dev/zero"), 1000).unwrap_err().to_string();
            assert!(zero.contains("longer than 1000 bytes"), "{zero}");
            let zero = named_text(Path::new("/dev/zero"), 1000).unwrap_err().to_string();
            assert!(zero.contains("not a file but a device"), "{zero}");
        }
    }

    /// The mark that some editors put first is no part of a text, here as everywhere; in UTF-16 the whole is another text.
    #[test]
    fn byte_order_marks_are_left_out() {
        let text = |bytes: &[u8]| text_of(Path::new("a"), bytes, 99).map_err(|e| e.to_string());
        assert_eq!(text("\u{feff}{}".as_bytes()), Ok("{}".into()));
        assert_eq!(text("{}\u{feff}".as_bytes()), Ok("{}\u{feff}".into()));
        assert_eq!(text(&[0xff, 0xfe, b'{', 0]), Err("a: is UTF-16: save it as UTF-8".into()));
        assert_eq!(text(b"ab\xff"), Err("a: not UTF-8 at byte 3".into()));
    }

    /// Paths out of the bake are refused before anything is opened, and a file of a terabyte, of which nothing is on the
    /// disk, before anything is allocated.
    #[test]
    fn parts_of_a_bake() {
        let dir = tempfile::tempdir().unwrap();
        for path in ["", "/dev/zero", "../bake.json", "a/../../b", "/"] {
            assert!(part(dir.path(), path).unwrap_err().to_string().contains("outside the bake"), "{path}");
        }
        fs::write(dir.path().join("a"), "text").unwrap();
        assert_eq!(part(dir.path(), "a").unwrap(), b"text");
        File::create(dir.path().join("b")).unwrap().set_len(1 << 40).unwrap();
        let reason = part(dir.path(), "b").unwrap_err().to_string();
        assert!(reason.contains("takes some 1099.5 GB of memory"), "{reason}");
    }
}
