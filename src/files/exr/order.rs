//! The attributes of a written header, in the order of their names.

use std::ops::Range;

/// Magic number and version.
const PREAMBLE: usize = 8;

/// `file`, a single-part EXR file, with the attributes of its header ordered by name. They keep their bytes
/// and the header its length, so that the table of tile offsets stays valid.
pub(super) fn by_name(mut file: Vec<u8>) -> Vec<u8> {
    let mut places = Vec::new();
    let mut at = PREAMBLE;
    while file[at] != 0 {
        let end = attribute_end(&file, at);
        places.push(at..end);
        at = end;
    }
    // A name ends in 0, which no name holds: the order of whole attributes is that of their names.
    places.sort_by_key(|place| &file[place.clone()]);
    let sorted: Vec<u8> = places.into_iter().flat_map(|place: Range<usize>| &file[place]).copied().collect();
    file[PREAMBLE..at].copy_from_slice(&sorted);
    file
}

/// Where the attribute that begins at `start` ends: after name, 0, type, 0, size in 32 bits, value.
fn attribute_end(file: &[u8], start: usize) -> usize {
    let after_text = |at: usize| at + file[at..].iter().take_while(|&&b| b != 0).count() + 1;
    let size = after_text(after_text(start));
    let value = size + 4;
    value + u32::from_le_bytes([file[size], file[size + 1], file[size + 2], file[size + 3]]) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::atlas::{Atlas, Attribute, Samples};
    use crate::files::exr::header::header;
    use exr::meta::MetaData;
    use std::io::Cursor;

    /// As the crate writes it: the order of the eight custom attributes is its hash map's.
    fn unordered() -> Vec<u8> {
        let mut atlas = Atlas::new("t", [2, 1, 3]).with("R", Samples::half([0.5; 6]));
        for (k, name) in ["zeta", "alpha", "Beta"].into_iter().enumerate() {
            atlas.attributes.insert(name.into(), Attribute::Text(name.repeat(k)));
        }
        let mut file = Cursor::new(Vec::new());
        exr::block::write(&mut file, [header(&atlas)].into_iter().collect(), true, |meta, writer| {
            use exr::block::writer::ChunksWriter;
            let tile = |index| exr::block::UncompressedBlock { index, data: vec![7; 4] };
            for (k, index) in meta.enumerate_ordered_header_block_indices() {
                writer.write_chunk(k, tile(index).compress_to_chunk(&meta.headers)?)?;
            }
            Ok(())
        })
        .unwrap();
        file.into_inner()
    }

    /// The crate, which looks attributes up by name, reads the same header from both files; the bytes after
    /// the header, with the offsets of tiles, are not touched.
    #[test]
    fn ordered_attributes_have_the_same_values_for_another_reader() {
        let before = unordered();
        let after = by_name(before.clone());
        let read = |bytes: &[u8]| MetaData::read_from_buffered(Cursor::new(bytes), true).unwrap();
        assert_eq!(read(&after), read(&before));
        let header: usize = PREAMBLE + names(&after).iter().map(|(_, size)| size).sum::<usize>();
        assert_eq!(after[header..], before[header..]);
    }

    /// Two writings of one header, whose hash maps have different seeds, become the same bytes; by the bytes
    /// of names, capitals come first.
    #[test]
    fn any_order_becomes_that_of_names() {
        let ordered = by_name(unordered());
        assert_eq!(by_name(unordered()), ordered);
        let names: Vec<String> = names(&ordered).into_iter().map(|(name, _)| name).collect();
        assert!(names.is_sorted() && names[0] == "Beta" && names.contains(&"zeta".into()), "{names:?}");
        assert_eq!(names.len(), 3 + 5 + 11);
    }

    /// Name and size in bytes of each attribute in turn.
    fn names(file: &[u8]) -> Vec<(String, usize)> {
        let mut found = Vec::new();
        let mut at = PREAMBLE;
        while file[at] != 0 {
            let end = attribute_end(file, at);
            let name = file[at..end].split(|&b| b == 0).next().unwrap();
            found.push((String::from_utf8(name.to_vec()).unwrap(), end - at));
            at = end;
        }
        found
    }
}
