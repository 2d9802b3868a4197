//! Panels side by side in one PNG, each under its label.

use super::font::{ADVANCE, LINE, glyph};
use crate::error::{Error, Result};

/// A picture of a sky, with what its label says.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    pub label: String,
    /// What radiance was multiplied with.
    pub exposure: f64,
    /// Width and height, pixels.
    pub size: [usize; 2],
    /// Three bytes a pixel, row by row from the top.
    pub rgb: Vec<u8>,
    /// Pixels that could not be shown and are magenta.
    pub errors: usize,
}

const GAP: usize = 4;
const BACKGROUND: u8 = 32;
const INK: u8 = 224;

/// A PNG of all `panels` in a grid of `columns`, labels above them; the same bytes every time.
///
/// # Errors
/// `Argument` if there is no panel or column.
pub fn contact_sheet(panels: &[Panel], columns: usize) -> Result<Vec<u8>> {
    if panels.is_empty() || columns == 0 {
        return Err(Error::Argument("a contact sheet needs a panel and a column".into()));
    }
    let largest = |side: usize| panels.iter().map(|p| p.size[side]).max().unwrap_or(0);
    let lines = panels.iter().map(|p| wrapped(&p.label, largest(0)).len()).max().unwrap_or(0);
    let cell = [largest(0) + GAP, largest(1) + GAP + lines * LINE];
    let columns = columns.min(panels.len());
    let rows = panels.len().div_ceil(columns);
    let mut sheet = Canvas::new([columns * cell[0] + GAP, rows * cell[1] + GAP]);
    for (index, panel) in panels.iter().enumerate() {
        let corner = [GAP + index % columns * cell[0], GAP + index / columns * cell[1]];
        for (k, line) in wrapped(&panel.label, largest(0)).iter().enumerate() {
            sheet.text([corner[0], corner[1] + k * LINE], line);
        }
        sheet.blit([corner[0], corner[1] + lines * LINE], panel);
    }
    sheet.png()
}

/// A label in lines that fit `width` pixels, broken between words where words fit.
fn wrapped(label: &str, width: usize) -> Vec<Vec<char>> {
    let room = (width / ADVANCE).max(1);
    let mut lines: Vec<Vec<char>> = Vec::new();
    for word in label.split(' ') {
        match lines.last_mut() {
            Some(line) if line.len() + 1 + word.chars().count() <= room => {
                line.push(' ');
                line.extend(word.chars());
            }
            _ => lines.extend(word.chars().collect::<Vec<_>>().chunks(room).map(<[char]>::to_vec)),
        }
    }
    lines
}

struct Canvas {
    size: [usize; 2],
    rgb: Vec<u8>,
}

impl Canvas {
    fn new(size: [usize; 2]) -> Self {
        Canvas { size, rgb: vec![BACKGROUND; 3 * size[0] * size[1]] }
    }

    fn text(&mut self, [left, top]: [usize; 2], characters: &[char]) {
        for (k, &character) in characters.iter().enumerate() {
            for (y, row) in glyph(character).iter().enumerate() {
                for x in (0..5).filter(|x| row >> (4 - x) & 1 == 1) {
                    let at = 3 * ((top + y) * self.size[0] + left + k * ADVANCE + x);
                    self.rgb[at..at + 3].fill(INK);
                }
            }
        }
    }

    fn blit(&mut self, [left, top]: [usize; 2], panel: &Panel) {
        let width = 3 * panel.size[0];
        for (y, row) in panel.rgb.chunks_exact(width.max(1)).enumerate() {
            let at = 3 * ((top + y) * self.size[0] + left);
            self.rgb[at..at + width].copy_from_slice(row);
        }
    }

    fn png(&self) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.size[0] as u32, self.size[1] as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
        encoder.set_compression(png::Compression::Fast);
        let mut writer = encoder.write_header().map_err(failed)?;
        writer.write_image_data(&self.rgb).map_err(failed)?;
        writer.finish().map_err(failed)?;
        Ok(bytes)
    }
}

fn failed(e: png::EncodingError) -> Error {
    Error::Argument(format!("contact sheet: {e}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(label: &str, side: usize, value: u8) -> Panel {
        Panel {
            label: label.into(),
            exposure: 1.0,
            size: [side, side],
            rgb: vec![value; 3 * side * side],
            errors: 0,
        }
    }

    /// Two columns of three panels 40 wide; six characters fit, so "SUN AT DUSK" takes two lines.
    #[test]
    fn a_sheet_holds_its_panels_and_their_labels() {
        let panels = [plain("I", 40, 90), plain("Sun at dusk", 40, 120), plain("", 40, 150)];
        let bytes = contact_sheet(&panels, 2).unwrap();
        assert_eq!(bytes, contact_sheet(&panels, 2).unwrap());
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut rgb).unwrap();
        assert_eq!([info.width, info.height], [2 * 44 + 4, 2 * 64 + 4]);
        let at = |x: usize, y: usize| rgb[3 * (y * 92 + x)];
        assert_eq!([at(4, 24), at(48, 24), at(4, 88), at(48, 88)], [90, 120, 150, BACKGROUND]);
        // The letter I: a stem of one pixel in the middle of its five, from the second to the sixth row.
        for y in 5..10 {
            assert_eq!([at(5, y), at(6, y), at(7, y)], [BACKGROUND, INK, BACKGROUND]);
        }
        assert!(contact_sheet(&[], 2).is_err() && contact_sheet(&panels, 0).is_err());
    }

    /// Lines end between words; a word too long for one is cut.
    #[test]
    fn labels_are_broken_between_words() {
        let lines = |label| -> Vec<String> {
            wrapped(label, 6 * ADVANCE).into_iter().map(|line| line.into_iter().collect()).collect()
        };
        assert_eq!(lines("Sun at dusk"), ["Sun at", "dusk"]);
        assert_eq!(lines("phytoplankton 2 m"), ["phytop", "lankto", "n 2 m"]);
    }

    /// Every sign that labels use can be told from a blank and from each other.
    #[test]
    fn characters_are_distinct() {
        let signs: Vec<char> = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ.,:=-+/%()°_".chars().collect();
        for (k, &a) in signs.iter().enumerate() {
            assert_ne!(glyph(a), [0; 7], "{a}");
            assert!(signs[..k].iter().all(|&b| glyph(a) != glyph(b)), "{a}");
        }
        assert_eq!(glyph('m'), glyph('M'));
    }
}
