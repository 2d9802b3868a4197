//! The library's one error type: what went wrong, where, and which exit code the command line gives it.

use std::fmt::{self, Display, Write};
use std::path::{Path, PathBuf};

/// A text on one line, whatever is in it: names and values of files that strangers made may hold line breaks, or what
/// a terminal takes for commands. Control characters are shown as escapes, and what is longer than any path is cut.
pub struct Line<T>(pub T);

/// Characters of a [`Line`] at most.
const MOST_SHOWN: usize = 4096;

impl<T: Display> Display for Line<T> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        for (n, c) in self.0.to_string().chars().enumerate() {
            if n == MOST_SHOWN {
                return f.write_char('…');
            }
            match c {
                // Line and paragraph separators, and what turns the direction of writing.
                '\u{2028}' | '\u{2029}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {
                    write!(f, "{}", c.escape_unicode())?
                }
                c if c.is_control() => write!(f, "{}", c.escape_debug())?,
                c => f.write_char(c)?,
            }
        }
        Ok(())
    }
}

/// Every failure that a user can meet, as one line.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A value in an input file: file, key, value, reason.
    #[error("{}: {} = {}: {}", Line(.file), Line(.key), Line(.value), Line(.reason))]
    Value { file: String, key: String, value: String, reason: String },
    /// An input file that cannot be used as a whole (missing, malformed, truncated, foreign).
    #[error("{}: {}", Line(.file.display()), Line(.reason))]
    File { file: PathBuf, reason: String },
    /// A wrong argument or combination of arguments.
    #[error("{}", Line(.0))]
    Argument(String),
    /// Why a value cannot be used, where only a caller knows its file and key.
    #[error("{}", Line(.0))]
    Reason(String),
    /// A check that the user asked for did not hold.
    #[error("{}", Line(.0))]
    Check(String),
    /// The machine failed: disk, memory, permissions.
    #[error("{}: {source}", Line(.path.display()))]
    Machine { path: PathBuf, source: std::io::Error },
    /// A number that must be finite is not: names the table and the place in it.
    #[error("{table}: not a finite number at {place}; nothing was written")]
    NotFinite { table: String, place: String },
    /// Of several pieces of work some failed, each of which has been told; `code` is the highest of theirs.
    #[error("{failed} of {of} failed")]
    Several { failed: usize, of: usize, code: u8 },
    /// The user stopped the run.
    #[error("interrupted; what stood in the output folder before is untouched")]
    Interrupted,
}

/// Shorthand used throughout the library.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// 1: a check did not hold; 2: bad arguments or input; 3: the machine failed (or the run was stopped).
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Check(_) => 1,
            Error::Several { code, .. } => *code,
            Error::Value { .. } | Error::File { .. } | Error::Argument(_) | Error::Reason(_) => 2,
            Error::Machine { .. } | Error::NotFinite { .. } | Error::Interrupted => 3,
        }
    }

    pub fn file(file: impl AsRef<Path>, reason: impl ToString) -> Self {
        Error::File { file: file.as_ref().to_path_buf(), reason: reason.to_string() }
    }

    pub fn machine(path: impl AsRef<Path>, source: std::io::Error) -> Self {
        Error::Machine { path: path.as_ref().to_path_buf(), source }
    }

    /// Reading failed: a missing or unreadable input is the user's to mend (2), the rest is the machine's (3).
    pub fn reading(path: impl AsRef<Path>, source: std::io::Error) -> Self {
        use std::io::ErrorKind::*;
        match source.kind() {
            // The last two: a NUL in a name, and one that is too long.
            NotFound | PermissionDenied | InvalidData | IsADirectory | NotADirectory | InvalidInput
            | InvalidFilename => Error::file(path, source),
            _ if leads_round(&source) => Error::file(path, source),
            _ => Error::machine(path, source),
        }
    }
}

impl From<String> for Error {
    fn from(reason: String) -> Self {
        Error::Reason(reason)
    }
}

impl From<&str> for Error {
    fn from(reason: &str) -> Self {
        Error::Reason(reason.to_owned())
    }
}

/// Whether links lead from one to the other and never to a file.
#[cfg(unix)]
fn leads_round(e: &std::io::Error) -> bool {
    e.raw_os_error() == Some(rustix::io::Errno::LOOP.raw_os_error())
}

#[cfg(not(unix))]
fn leads_round(_: &std::io::Error) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A name with a line break and one with a terminal's command for red stay on one line, unlike letters and accents.
    #[test]
    fn one_line() {
        let error = Error::file("a\nb.json", "key `\u{1b}[31m\u{2028}` — größer");
        assert_eq!(error.to_string(), "a\\nb.json: key `\\u{1b}[31m\\u{2028}` — größer");
        assert_eq!(Error::Argument("n".repeat(1 << 20)).to_string().chars().count(), MOST_SHOWN + 1);
        let error = Error::Argument("--set a\r\n=1\t".into());
        assert_eq!(error.to_string(), "--set a\\r\\n=1\\t");
    }
}
