//! Spectra for `tyndall colour`: columns of a CSV file, views of `tyndall sample`, or black bodies.

use super::colour_views::{are_views, views};
use crate::error::{Error, Result};
use crate::files::bounded_read;
use crate::files::bounded_read::MOST_CSV;
use crate::spectrum::{OBSERVER_RANGE, Spectrum, planck_law};
use std::path::{Path, PathBuf};

/// A spectrum with the name of its column.
pub struct Named {
    pub name: String,
    pub spectrum: Spectrum,
}

/// What was read.
pub struct Input {
    pub spectra: Vec<Named>,
    /// Their values are radiance over a star's irradiance, 1/sr.
    pub are_views: bool,
}

/// Spectra of a CSV file, or of standard input for None or `-`: a column `wavelength_nm`, rising, and one column
/// a spectrum, or the columns of `tyndall sample`; lines that start with # are comments. Errors name file, line, column and value.
pub fn read(path: Option<&Path>) -> Result<Input> {
    match path {
        Some(path) if path != Path::new("-") => parse(path, &bounded_read::text(path, MOST_CSV)?),
        _ => {
            let label = PathBuf::from("(standard input)");
            parse(&label, &bounded_read::text_of(&label, std::io::stdin(), MOST_CSV)?)
        }
    }
}

/// [`read`] of a text; `file` is for messages only.
pub fn parse(file: &Path, text: &str) -> Result<Input> {
    let mut reader =
        csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(text.as_bytes());
    let header = reader.headers().map_err(|e| Error::file(file, e))?.clone();
    let at =
        header.iter().position(|h| h == "wavelength_nm").ok_or_else(|| without_wavelengths(file, &header))?;
    if are_views(&header) {
        return Ok(Input { spectra: views(file, reader)?, are_views: true });
    }
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); header.len()];
    for record in reader.records() {
        let record = record.map_err(|e| Error::file(file, e))?;
        let line = record.position().map_or(0, |p| p.line());
        for (k, column) in columns.iter_mut().enumerate() {
            column.push(number(file, line, &header[k], &record[k])?);
        }
    }
    let wavelengths = columns[at].clone();
    let spectra = header.iter().zip(columns).filter(|(h, _)| *h != "wavelength_nm");
    let list: Result<Vec<Named>> = spectra
        .map(|(name, values)| {
            let spectrum = Spectrum::new(wavelengths.clone(), values).map_err(|e| Error::file(file, e))?;
            Ok(Named { name: name.to_string(), spectrum })
        })
        .collect();
    match list {
        Ok(list) if list.is_empty() => Err(Error::file(file, "no column of values beside wavelength_nm")),
        Ok(spectra) => Ok(Input { spectra, are_views: false }),
        Err(error) => Err(error),
    }
}

fn without_wavelengths(file: &Path, header: &csv::StringRecord) -> Error {
    if header.iter().any(|h| h.starts_with("red_")) {
        let mend = "sample a layout of wavelengths, as compact, or with --exact";
        return Error::file(file, format!("linear RGB, which are colours already: {mend}"));
    }
    Error::file(file, "column wavelength_nm is missing")
}

/// The only spectrum of a CSV file.
///
/// # Errors
/// As [`read`], and where there are more.
pub fn one_spectrum(path: &Path) -> Result<Spectrum> {
    let mut input = read(Some(path))?;
    if input.are_views || input.spectra.len() != 1 {
        return Err(Error::file(path, "wants the column wavelength_nm and one beside it"));
    }
    Ok(input.spectra.remove(0).spectrum)
}

pub fn number(file: &Path, line: u64, column: &str, text: &str) -> Result<f64> {
    match text.parse::<f64>() {
        Ok(v) if v.is_finite() => Ok(v),
        _ => Err(Error::Value {
            file: file.display().to_string(),
            key: format!("line {line}, {column}"),
            value: format!("`{text}`"),
            reason: "not a finite number".into(),
        }),
    }
}

/// Radiance of a black body at 1 nm over the observer's range, W/(m² sr nm).
pub fn black_body(temperature: f64) -> Result<Named> {
    if !(100.0..=1e6).contains(&temperature) {
        return Err(Error::Argument(format!("--blackbody {temperature}: must be between 100 and 1000000 K")));
    }
    let grid = (OBSERVER_RANGE.0..=OBSERVER_RANGE.1).map(|w| w as f64).collect();
    let spectrum = Spectrum::sampled(grid, |w| planck_law(w, temperature) * 1e-9)?;
    Ok(Named { name: format!("blackbody-{temperature}K"), spectrum })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        match parse(Path::new("s.csv"), text) {
            Ok(_) => panic!("not refused: {text}"),
            Err(e) => e.to_string(),
        }
    }

    /// Columns are found by name, in any order; comments are skipped.
    #[test]
    fn columns_by_name() {
        let list =
            parse(Path::new("s.csv"), "# a lamp\na,wavelength_nm,b\n1,400,5\n3,500,7\n").unwrap().spectra;
        assert_eq!(list.iter().map(|n| n.name.as_str()).collect::<Vec<_>>(), ["a", "b"]);
        assert_eq!((list[0].spectrum.at(450.0), list[1].spectrum.at(450.0)), (2.0, 6.0));
    }

    /// What is not a spectrum is refused with its place.
    #[test]
    fn bad_input_is_located() {
        assert!(refused("nm,a\n1,2\n").contains("wavelength_nm is missing"));
        assert!(refused("wavelength_nm\n400\n").contains("no column of values"));
        assert!(refused("wavelength_nm,a\n400,1\n500,x\n").contains("line 3, a = `x`"));
        assert!(refused("wavelength_nm,a\n400,1\n500,inf\n").contains("not a finite number"));
        assert!(refused("wavelength_nm,a\n500,1\n400,1\n").contains("must rise"));
        assert!(refused("wavelength_nm,a\n").contains("no values"));
        assert!(refused("wavelength_nm,a\n400\n").contains("s.csv"));
    }
}
