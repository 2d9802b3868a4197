//! All that this program says, on standard output and standard error. Nothing here panics where nobody reads it, as
//! `println!` does: a reader that has seen enough (`| head`) is no failure, a full disk is one of the machine.

use crate::error::{Error, Result};
use std::fmt;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};

/// Writes a long answer to standard output bit by bit, so that it is never whole in memory; as [`print`].
pub fn stream(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    let mut out = io::BufWriter::new(io::stdout().lock());
    written(write(&mut out).and_then(|()| out.flush()))
}

/// Writes to standard output. A reader that has seen enough (`| head`) is no failure.
pub fn print(text: &str) -> Result<()> {
    stream(|out| out.write_all(text.as_bytes()))
}

/// Tells of arguments that are none of a command, and ends the program; of `--help` and `--version`, which are answers,
/// it says whether they could be written.
///
/// # Errors
/// As [`print`].
#[cfg(feature = "cli")]
pub fn refused(error: &clap::Error) -> Result<()> {
    if error.use_stderr() {
        error.exit();
    }
    written(error.print().and_then(|()| io::stdout().flush()))
}

fn written(outcome: io::Result<()>) -> Result<()> {
    match outcome {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Error::machine("standard output", e)),
        _ => Ok(()),
    }
}

/// Whether a line of talk was lost on the way to standard error.
static LOST: AtomicBool = AtomicBool::new(false);

/// Talk: a line on standard error. A command goes on where it cannot be written, so that no work is lost with it;
/// [`heard`] tells of it at the end.
pub fn say(line: &str) {
    if let Err(e) = io::stderr().write_all(format!("{line}\n").as_bytes())
        && e.kind() != ErrorKind::BrokenPipe
        && !hung_up(&e)
    {
        LOST.store(true, Ordering::Relaxed);
    }
}

/// Whether it was a terminal that is gone.
#[cfg(unix)]
fn hung_up(e: &io::Error) -> bool {
    use rustix::fs::{FileType, fstat};
    let is_device = |mode| FileType::from_raw_mode(mode) == FileType::CharacterDevice;
    e.raw_os_error() == Some(rustix::io::Errno::IO.raw_os_error())
        && fstat(io::stderr()).is_ok_and(|found| is_device(found.st_mode))
}

#[cfg(not(unix))]
fn hung_up(_: &io::Error) -> bool {
    false
}

/// As [`say`], for where there is no memory left: takes none, and cuts what is longer than a line of a terminal.
pub fn say_without_memory(line: fmt::Arguments) {
    let mut buffer = io::Cursor::new([0; 160]);
    let _ = buffer.write_fmt(line);
    let end = (buffer.position() as usize).min(159);
    let mut text = buffer.into_inner();
    text[end] = b'\n';
    let _ = io::stderr().write_all(&text[..=end]);
}

/// Whether somebody watches standard error as it comes.
pub fn watched() -> bool {
    io::stderr().is_terminal()
}

/// Whether all that was said could be written. A reader that has gone away is no failure.
///
/// # Errors
/// `Machine` if standard error took a line not.
pub fn heard() -> Result<()> {
    match LOST.load(Ordering::Relaxed) {
        true => Err(Error::machine("standard error", io::Error::other("could not be written"))),
        false => Ok(()),
    }
}
