//! Tables of two bakes, texel by texel.

use super::{Bake, TableDifference, Texels};
use crate::error::Result;
use crate::files::Atlas;
use crate::files::manifest::Table;
use crate::layout::sky::picture;
use crate::quality::Distribution;
use rayon::prelude::*;

/// Share of a table's largest value below which a value counts as that: differences in the dark are not seen.
const DARK: f64 = 1e-4;

/// Every table of either bake, in the order of the first, what only the second has last.
pub(super) fn compare(a: &Bake, b: &Bake) -> Result<Vec<TableDifference>> {
    let name = |t: &Table| format!("{}/{}", t.layout, t.name);
    let of = |bake: &Bake, wanted: &str| bake.manifest.tables.iter().find(|t| name(t) == wanted).cloned();
    let only = |which: &str| Texels::Apart(format!("is in {which} only"));
    let mut out = Vec::new();
    for one in &a.manifest.tables {
        let what = match of(b, &name(one)) {
            Some(other) => texels((a, one), (b, &other))?,
            None => only("A"),
        };
        out.push(TableDifference { table: name(one), what });
    }
    let new = b.manifest.tables.iter().filter(|t| of(a, &name(t)).is_none());
    out.extend(new.map(|t| TableDifference { table: name(t), what: only("B") }));
    Ok(out)
}

fn texels(a: (&Bake, &Table), b: (&Bake, &Table)) -> Result<Texels> {
    let (one, other) = (a.1, b.1);
    // Read even where the hashes agree: the files on disk might not be what was baked.
    let (left, right) = (picture(&a.0.folder, one)?, picture(&b.0.folder, other)?);
    let decoded_alike = one.encoding == other.encoding && one.axes == other.axes;
    if one.blake3 == other.blake3 && decoded_alike {
        return Ok(Texels::Same);
    }
    if one.shape != other.shape {
        return Ok(Texels::Apart(format!("has shape {:?} in A, {:?} in B", one.shape, other.shape)));
    }
    let names = |t: &Table| t.channels.iter().map(|c| c.name.clone()).collect::<Vec<_>>();
    if names(one) != names(other) {
        return Ok(Texels::Apart(format!("has channels {:?} in A, {:?} in B", names(one), names(other))));
    }
    let channels = (0..one.channels.len()).into_par_iter();
    let parts: Vec<Vec<f64>> =
        channels.map(|k| differences(&values(one, &left, k), &values(other, &right, k))).collect();
    if left.slice_len() * left.slices != right.slice_len() * right.slices {
        return Ok(Texels::Apart("has files of different sizes".into()));
    }
    let all = parts.concat();
    Ok(if all.iter().all(|&d| d == 0.0) { Texels::Same } else { Texels::Differ(Distribution::of(all)) })
}

/// The quantities that a channel holds.
fn values(table: &Table, atlas: &Atlas, channel: usize) -> Vec<f64> {
    let info = &table.channels[channel];
    let encoding = info.encoding.as_ref().unwrap_or(&table.encoding);
    let Some(stored) = atlas.channel(&info.name) else { return Vec::new() };
    (0..stored.samples.len()).map(|n| encoding.decode(f64::from(stored.samples.get(n)))).collect()
}

fn differences(a: &[f64], b: &[f64]) -> Vec<f64> {
    let largest = a.iter().chain(b).fold(0.0, |most: f64, v| most.max(v.abs()));
    let relative = |(a, b): (&f64, &f64)| super::views::difference(*a, *b, DARK * largest);
    a.iter().zip(b).map(relative).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half of a bright value is 0.5; the same step where it is dark counts little, and 0 for 0 not at all.
    #[test]
    fn the_dark_counts_little() {
        let found = differences(&[1e4, 1e-6, 0.0, 3.0], &[5e3, 2e-6, 0.0, 3.0]);
        assert_eq!((found[0], found[2], found[3]), (0.5, 0.0, 0.0));
        assert!((found[1] - 1e-6).abs() < 1e-9, "{found:?}");
    }
}
