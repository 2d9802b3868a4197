//! The files of a bake: tables encoded and hashed, and counts of what halves cannot hold well.

use crate::error::Result;
use crate::files::manifest::{Encoding, EncodingKind, InContainer, OtherFile, Table};
use crate::files::{Atlas, Samples, exr};
use crate::layout::settings::Storage;
use crate::layout::table_data::TableData;
use half::f16;
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::path::Path;

/// BLAKE3 as in the manifest.
fn hash(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().to_string()
}

/// Encoded tables, and files that are none.
pub(crate) struct Files {
    pub tables: Vec<TableFile>,
    /// Path, what it is, content.
    pub extra: Vec<(String, String, Vec<u8>)>,
}

pub(crate) struct TableFile {
    atlas: Atlas,
    pub entry: Table,
    bytes: Vec<u8>,
    /// Path and content of the same in other containers.
    others: Vec<(String, Vec<u8>)>,
}

impl Files {
    /// Encodes tables, in their order.
    pub(crate) fn encode(baked: &[TableData], storage: &Storage) -> Result<Files> {
        let encode = |b: &TableData| -> Result<TableFile> {
            let mut atlas = b.atlas();
            if storage.column {
                atlas.columns = 1;
            }
            let bytes = exr::to_exr_bytes(&atlas)?;
            let mut entry = b.entry(&atlas, hash(&bytes));
            let mut others = Vec::new();
            for container in &storage.containers {
                let bytes = container.file(&atlas, &entry.shape)?;
                let file = Path::new(&entry.file).with_extension(container.name()).display().to_string();
                entry.containers.push(InContainer {
                    format: container.name().into(),
                    file: file.clone(),
                    blake3: hash(&bytes),
                    shape: container.shape(&atlas, &entry.shape),
                    about: container.about().into(),
                });
                others.push((file, bytes));
            }
            Ok(TableFile { atlas, entry, bytes, others })
        };
        Ok(Files { tables: baked.par_iter().map(encode).collect::<Result<_>>()?, extra: Vec::new() })
    }

    /// Tables as they would be in files, without those: for readers in memory.
    pub(crate) fn unencoded<'a>(baked: impl Iterator<Item = &'a TableData>) -> Files {
        let one = |b: &TableData| {
            let atlas = b.atlas();
            TableFile { entry: b.entry(&atlas, String::new()), atlas, bytes: Vec::new(), others: Vec::new() }
        };
        Files { tables: baked.map(one).collect(), extra: Vec::new() }
    }

    /// Tables of a layout by name, as a reader finds them.
    pub(crate) fn named(&self, layout: &str) -> BTreeMap<String, Atlas> {
        let of_layout = self.tables.iter().filter(|t| t.entry.layout == layout);
        of_layout.map(|t| (t.entry.name.clone(), t.atlas.clone())).collect()
    }

    /// Counts of halves of each table that hold less than they seem to, see [`OddHalves`].
    pub(crate) fn odd_halves(&self) -> Value {
        let mut out = Map::new();
        for t in &self.tables {
            let halves = t.atlas.channels.iter().filter_map(|c| match &c.samples {
                Samples::Half(values) => Some(values),
                Samples::Float(_) => None,
            });
            let odd = OddHalves::of(halves.flatten().copied());
            out.insert(format!("{}/{}", t.entry.layout, t.entry.name), odd.json(&t.entry.encoding));
        }
        Value::Object(out)
    }

    /// Entries of the manifest for the files that are no tables.
    pub(crate) fn others(&self) -> Vec<OtherFile> {
        self.extra.iter().map(entry).collect()
    }

    /// Path and content of every file, tables first.
    pub(crate) fn into_bytes(self) -> Vec<(String, Vec<u8>)> {
        let tables =
            self.tables.into_iter().flat_map(|f| [(f.entry.file, f.bytes)].into_iter().chain(f.others));
        tables.chain(self.extra.into_iter().map(|(file, _, bytes)| (file, bytes))).collect()
    }
}

/// Path inside a bake, and content.
pub(crate) type Content = (String, Vec<u8>);

/// What the manifest says of a file that is no table: of its path, what it is, and its content.
pub(crate) fn entry((file, about, bytes): &(String, String, Vec<u8>)) -> OtherFile {
    OtherFile { file: file.clone(), blake3: hash(bytes), about: about.clone() }
}

/// Halves that lost something of their value, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct OddHalves {
    values: usize,
    zero: usize,
    /// Smaller than 6.1e-5, with less than 11 bits.
    subnormal: usize,
    negative: usize,
    /// ±65504, the largest, to which values are clipped, and what is not finite.
    largest: usize,
}

impl OddHalves {
    fn of(halves: impl Iterator<Item = f16>) -> Self {
        const SIGN: u16 = 0x8000;
        const SMALLEST_NORMAL: u16 = 0x0400;
        let mut odd = OddHalves::default();
        for half in halves {
            let size = half.to_bits() & !SIGN;
            odd.values += 1;
            odd.zero += usize::from(size == 0);
            odd.subnormal += usize::from((1..SMALLEST_NORMAL).contains(&size));
            odd.negative += usize::from(size > 0 && half.to_bits() & SIGN != 0);
            odd.largest += usize::from(size >= f16::MAX.to_bits());
        }
        odd
    }

    /// For the manifest. Logarithms may be negative; nothing else that is stored is.
    fn json(&self, encoding: &Encoding) -> Value {
        let mut out = json!({
            "values": self.values,
            "zero": self.zero,
            "subnormal": self.subnormal,
            "largest": self.largest,
        });
        if encoding.kind == EncodingKind::Linear {
            out["negative"] = json!(self.negative);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One of each kind beside a plain value; 1e5 is clipped to infinity, -0 is zero and not negative.
    #[test]
    fn odd_halves_are_told_apart() {
        let halves = [1.0, 0.0, -0.0, 3e-6, -2.0, 65504.0, 1e5].map(f16::from_f32);
        let odd = OddHalves::of(halves.into_iter());
        assert_eq!(odd, OddHalves { values: 7, zero: 2, subnormal: 1, negative: 1, largest: 2 });
        assert_eq!(odd.json(&Encoding::linear(1.0))["negative"], 1);
        assert!(odd.json(&Encoding::log(1.0, 0.0, -24.0)).get("negative").is_none());
    }
}
