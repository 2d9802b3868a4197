//! NumPy's NPY, version 1.0 (NEP 1): a line of text that says type and shape, then the numbers.

use crate::error::{Error, Result};
use half::f16;

/// The header is padded so that numbers begin at a multiple of it.
const ALIGNMENT: usize = 64;
const MAGIC: [u8; 8] = *b"\x93NUMPY\x01\x00";

/// The bytes of the file: an array in C order, its first index that of the table's last axis, its last that of the
/// channel. `shape` is that of the table, fastest first.
pub(super) fn file(channels: &[&[f16]], shape: &[usize]) -> Result<Vec<u8>> {
    let texels = channels.first().map_or(0, |c| c.len());
    if shape.iter().product::<usize>() != texels {
        return Err(Error::Argument(format!("NPY: {texels} texels are not a table of shape {shape:?}")));
    }
    let sizes: Vec<String> = shape.iter().rev().chain([&channels.len()]).map(usize::to_string).collect();
    let mut text = format!("{{'descr': '<f2', 'fortran_order': False, 'shape': ({},), }}", sizes.join(", "));
    let before = MAGIC.len() + 2;
    let padded = (before + text.len() + 1).next_multiple_of(ALIGNMENT) - before;
    text.extend(std::iter::repeat_n(' ', padded - text.len() - 1).chain(['\n']));
    let mut out = Vec::with_capacity(before + padded + texels * channels.len() * 2);
    out.extend(MAGIC);
    // Six sizes of twenty digits are far from the 65535 bytes that fit.
    out.extend((padded as u16).to_le_bytes());
    out.extend(text.as_bytes());
    for texel in 0..texels {
        channels.iter().for_each(|c| out.extend(c[texel].to_le_bytes()));
    }
    Ok(out)
}
