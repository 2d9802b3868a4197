//! A table ready for a file: a volume whose slices lie side by side in one picture.

use super::manifest::Origin;
use crate::error::{Error, Result};
use half::f16;
use std::collections::BTreeMap;

/// A table of `width × height × slices` samples a channel, to be stored as one picture in which the slices lie
/// in a grid of `columns × rows`, row by row, slice 0 top left. One- and two-dimensional tables have one slice.
#[derive(Clone, Debug, PartialEq)]
pub struct Atlas {
    /// What messages call the table; not stored in the file.
    pub name: String,
    pub width: usize,
    pub height: usize,
    pub slices: usize,
    pub columns: usize,
    /// The corner where slice 0 and texel (0, 0) of each slice lie; bottom-left turns the whole picture upside down.
    pub origin: Origin,
    /// In any order; files list them alphabetically, as EXR demands.
    pub channels: Vec<Channel>,
    /// Further header attributes; the packing is added by the writer.
    pub attributes: BTreeMap<String, Attribute>,
}

/// One channel, its samples in the order `[slice][y][x]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    pub name: String,
    pub samples: Samples,
}

/// Samples in the precision that they have in the file.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    Half(Vec<f16>),
    Float(Vec<f32>),
}

/// An EXR header attribute of a type that every reader of the field knows.
#[derive(Clone, Debug, PartialEq)]
pub enum Attribute {
    Text(String),
    Int(i32),
    Float(f32),
}

/// The half nearest to `value` rounded to single precision. `f16::from_f64` is not used: it rounds twice on
/// CPUs that have F16C and once elsewhere, so its last bit depends on the machine.
pub fn half_from(value: f64) -> f16 {
    f16::from_f32(value as f32)
}

impl Samples {
    /// Half-precision samples of `values`, see [`half_from`].
    pub fn half(values: impl IntoIterator<Item = f64>) -> Self {
        Samples::Half(values.into_iter().map(half_from).collect())
    }

    /// Single-precision samples of `values`.
    pub fn float(values: impl IntoIterator<Item = f64>) -> Self {
        Samples::Float(values.into_iter().map(|v| v as f32).collect())
    }

    pub fn len(&self) -> usize {
        match self {
            Samples::Half(v) => v.len(),
            Samples::Float(v) => v.len(),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes a sample: 2 or 4.
    pub fn bytes(&self) -> usize {
        match self {
            Samples::Half(_) => 2,
            Samples::Float(_) => 4,
        }
    }

    /// Sample `index`, widened (exact).
    pub fn get(&self, index: usize) -> f32 {
        match self {
            Samples::Half(v) => v[index].to_f32(),
            Samples::Float(v) => v[index],
        }
    }

    /// The index of the first sample that is infinite or not a number.
    pub fn first_not_finite(&self) -> Option<usize> {
        match self {
            Samples::Half(v) => v.iter().position(|x| !x.is_finite()),
            Samples::Float(v) => v.iter().position(|x| !x.is_finite()),
        }
    }

    /// The smallest and largest sample (0, 0 of none); a not-a-number is passed over.
    pub fn range(&self) -> [f64; 2] {
        let fold = |[low, high]: [f64; 2], v: f32| [low.min(f64::from(v)), high.max(f64::from(v))];
        let start = [f64::INFINITY, f64::NEG_INFINITY];
        let range = match self {
            Samples::Half(v) => v.iter().map(|x| x.to_f32()).fold(start, fold),
            Samples::Float(v) => v.iter().copied().fold(start, fold),
        };
        if range[0] > range[1] { [0.0, 0.0] } else { range }
    }
}

impl Atlas {
    /// An atlas with no channels yet; the slices lie in a grid that is as square as whole columns allow.
    pub fn new(name: impl Into<String>, [width, height, slices]: [usize; 3]) -> Self {
        Atlas {
            name: name.into(),
            width,
            height,
            slices,
            columns: (1..=slices.max(1)).find(|c| c * c >= slices).unwrap_or(1),
            origin: Origin::TopLeft,
            channels: Vec::new(),
            attributes: BTreeMap::new(),
        }
    }

    /// The same with all slices in one column and the whole picture upside down.
    pub fn in_a_strip_from_the_bottom(self) -> Self {
        Atlas { columns: 1, origin: Origin::BottomLeft, ..self }
    }

    /// Adds a channel; its samples are ordered `[slice][y][x]`.
    pub fn with(mut self, name: impl Into<String>, samples: Samples) -> Self {
        self.channels.push(Channel { name: name.into(), samples });
        self
    }

    /// Rows of the grid of slices; the last may be partly empty (zeros in the file).
    pub fn rows(&self) -> usize {
        self.slices.div_ceil(self.columns.max(1))
    }

    /// The slice that lies at a place of the grid, counted row by row from the top left; none of the table's where it
    /// is no less than `slices`.
    pub fn slice_at(&self, place: usize) -> usize {
        let (column, row) = (place % self.columns, place / self.columns);
        match self.origin {
            Origin::TopLeft => place,
            Origin::BottomLeft => (self.rows() - 1 - row) * self.columns + column,
        }
    }

    /// The y of a tile's line, counted from its top.
    pub fn y_of_line(&self, line: usize) -> usize {
        match self.origin {
            Origin::TopLeft => line,
            Origin::BottomLeft => self.height - 1 - line,
        }
    }

    /// Samples in one slice of one channel.
    pub fn slice_len(&self) -> usize {
        self.width * self.height
    }

    /// The channel called `name`.
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        self.channels.iter().find(|c| c.name == name)
    }

    /// The channels in the order in which a file lists them: by the bytes of their names.
    pub fn sorted_channels(&self) -> Vec<&Channel> {
        let mut sorted: Vec<&Channel> = self.channels.iter().collect();
        sorted.sort_by(|a, b| a.name.cmp(&b.name));
        sorted
    }

    /// Whether a file can hold this atlas: sizes agree, names are usable and distinct, every sample is finite.
    /// Errors name table, channel and texel.
    pub fn check(&self) -> Result<()> {
        self.check_sizes()?;
        self.check_names()?;
        self.channels.iter().try_for_each(|c| match c.samples.first_not_finite() {
            None => Ok(()),
            Some(index) => {
                let (x, rest) = (index % self.width, index / self.width);
                let (y, slice) = (rest % self.height, rest / self.height);
                let place = format!("channel {}, x {x}, y {y}, slice {slice}", c.name);
                Err(Error::NotFinite { table: self.name.clone(), place })
            }
        })
    }

    fn check_sizes(&self) -> Result<()> {
        let refuse = |reason: String| Err(Error::Argument(format!("{}: {reason}", self.name)));
        let sides = [self.width, self.height, self.slices, self.columns];
        if sides.contains(&0) || self.columns > self.slices {
            return refuse(format!("width, height, slices, columns = {sides:?} make no atlas"));
        }
        // Readers hold coordinates in 32 bits, signed.
        let fits = |a: usize, b: usize| a.checked_mul(b).is_some_and(|n| n < 1 << 30);
        if !fits(self.width, self.columns) || !fits(self.height, self.rows()) {
            return refuse(format!("width, height, slices, columns = {sides:?} make too large a picture"));
        }
        match self
            .channels
            .iter()
            .find(|c| Some(c.samples.len()) != self.slice_len().checked_mul(self.slices))
        {
            Some(c) => refuse(format!("channel {} has {} samples", c.name, c.samples.len())),
            None if self.channels.is_empty() => refuse("there is no channel".into()),
            None => Ok(()),
        }
    }

    fn check_names(&self) -> Result<()> {
        let refuse = |reason: String| Err(Error::Argument(format!("{}: {reason}", self.name)));
        let channels = self.sorted_channels();
        if let Some(pair) = channels.windows(2).find(|pair| pair[0].name == pair[1].name) {
            return refuse(format!("two channels are called {}", pair[0].name));
        }
        let names = channels.iter().map(|c| &c.name).chain(self.attributes.keys());
        match names.into_iter().find(|n| n.is_empty() || n.len() > 255 || n.contains('\0')) {
            Some(name) => refuse(format!("{name:?} cannot be a name in an EXR file")),
            None => Ok(()),
        }
    }
}
