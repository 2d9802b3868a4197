//! Points of view as CSV, the form that the oracles share (columns found by name), and answers to them.

use super::bounded_read;
use crate::error::{Error, Result};
use crate::geometry::Point;
use std::io::{Read, Write};
use std::path::Path;

/// Columns of a point in a CSV file.
pub const COLUMNS: [&str; 4] = ["altitude_m", "mu_view", "mu_sun", "azimuth_deg"];

/// Views of a file at most; in memory, with their answers at four wavelengths, they take a gigabyte.
pub const MOST_POINTS: usize = 10_000_000;
/// Bytes of a file of views at most.
const MOST_BYTES: u64 = 2 << 30;

/// By how much a cosine may lie beyond 1 and is taken for 1.
const COSINE_ROUNDING: f64 = 1e-6;

/// Reads points from a CSV file. Errors name the file, line, column and value.
pub fn read_points(path: &Path) -> Result<Vec<Point>> {
    parse_points(path, std::io::BufReader::new(bounded_read::open(path)?))
}

/// [`read_points`] of any stream; `path` is for messages only.
pub fn parse_points(path: &Path, stream: impl std::io::Read) -> Result<Vec<Point>> {
    let rows = Rows { stream, length: 0, left: MOST_BYTES };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(rows);
    let header = reader.headers().map_err(|e| unreadable(path, e))?.clone();
    let mut index = [0; 4];
    for (slot, name) in index.iter_mut().zip(COLUMNS) {
        *slot = header
            .iter()
            .position(|h| h == name)
            .ok_or_else(|| Error::file(path, format!("column {name} is missing (needed: {COLUMNS:?})")))?;
    }
    let mut points = Vec::new();
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record).map_err(|e| unreadable(path, e))? {
        if points.len() == MOST_POINTS {
            return Err(Error::file(path, format!("more than {MOST_POINTS} views: split it")));
        }
        let line = record.position().map_or(0, |p| p.line());
        let mut v = [0.0; 4];
        for (k, slot) in v.iter_mut().enumerate() {
            *slot = number(path, line, COLUMNS[k], record.get(index[k]).unwrap_or(""))?;
        }
        points.push(Point { altitude: v[0], mu: v[1], mu_s: v[2], azimuth_deg: v[3] });
    }
    Ok(points)
}

/// Bytes of a row at most.
const MOST_ROW: usize = 1 << 16;

/// A stream that fails at a row that does not end, as that of a device of zeros, which would be kept whole.
struct Rows<R> {
    stream: R,
    /// Bytes since the last end of a row.
    length: usize,
    /// Bytes that may still come.
    left: u64,
}

impl<R: Read> Read for Rows<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.stream.read(buffer)?;
        self.length = match buffer[..count].iter().rposition(|&b| matches!(b, b'\n' | b'\r')) {
            Some(end) => count - end - 1,
            None => self.length + count,
        };
        let refuse = |reason: String| Err(std::io::Error::new(std::io::ErrorKind::InvalidData, reason));
        if self.length > MOST_ROW {
            return refuse(format!("a row of more than {MOST_ROW} bytes"));
        }
        match self.left.checked_sub(count as u64) {
            Some(left) => self.left = left,
            None => return refuse(format!("more than {MOST_BYTES} bytes: split it")),
        }
        Ok(count)
    }
}

/// A row with too few or too many fields (a decimal comma makes two of one) in our words, the rest in csv's.
fn unreadable(path: &Path, error: csv::Error) -> Error {
    match error.kind() {
        csv::ErrorKind::UnequalLengths { pos: Some(pos), expected_len, len } => Error::file(
            path,
            format!("line {}: {len} fields, not {expected_len} as in the header", pos.line()),
        ),
        csv::ErrorKind::Io(e) => Error::file(path, e),
        _ => Error::file(path, error),
    }
}

fn number(path: &Path, line: u64, column: &str, text: &str) -> Result<f64> {
    let refuse = |reason: &str| Error::Value {
        file: path.display().to_string(),
        key: format!("line {line}, {column}"),
        value: text.to_string(),
        reason: reason.to_string(),
    };
    let value: f64 = text.parse().map_err(|_| refuse("not a number"))?;
    if !value.is_finite() {
        return Err(refuse("not a finite number"));
    }
    match column {
        "altitude_m" if value < 0.0 => Err(refuse("below the ground")),
        // A cosine that was rounded to f32 on its way lies beyond 1 by 1.2e-7.
        "mu_view" | "mu_sun" if value.abs() <= 1.0 + COSINE_ROUNDING => Ok(value.clamp(-1.0, 1.0)),
        "mu_view" | "mu_sun" => Err(refuse("a cosine is between -1 and 1")),
        _ => Ok(value),
    }
}

/// One value of an answer: the channel (a wavelength in nm), radiance and standard error, both 1/sr.
pub struct Answer {
    pub wavelength_nm: f64,
    pub radiance: f64,
    pub stderr: Option<f64>,
}

/// Writes answers as CSV: the four columns of the point, then wavelength, radiance and standard error.
pub fn write_answers(
    out: &mut dyn Write,
    rows: impl Iterator<Item = (Point, Answer)>,
) -> std::io::Result<()> {
    writeln!(out, "{},wavelength_nm,radiance_per_sr,stderr_per_sr", COLUMNS.join(","))?;
    for (p, a) in rows {
        let stderr = a.stderr.map(|s| format!("{s:.3e}")).unwrap_or_default();
        writeln!(
            out,
            "{},{},{},{},{},{:.8e},{}",
            p.altitude, p.mu, p.mu_s, p.azimuth_deg, a.wavelength_nm, a.radiance, stderr
        )?;
    }
    Ok(())
}
