//! The methods of the field behind one trait, for the chart of accuracy against cost: what each prepares for a planet,
//! what it then answers at a view, and what both cost.
//!
//! The older methods know three wavelengths and take radiance there for red, green and blue (`air`); they are held
//! against the same medium as ours, absorption included, which their authors left out. Where a method was published
//! with a solver of its own that ours stands in for, its file says so: then its error is that of its tables alone.

mod air;
mod baked;
pub mod catalogue;
mod columns;
mod elek2009;
mod march;
mod oneil;
mod schafhitzel;
mod texture;

pub use baked::{BakedTables, Storage};
pub use elek2009::Elek2009;
pub use march::{Nishita, OneilMarch};
pub use schafhitzel::Schafhitzel;

use crate::error::Result;
use crate::geometry::Point;
use crate::preset::Planet;
use std::time::Duration;

/// Who thought of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub enum Family {
    Nishita1993,
    Oneil2004,
    Schafhitzel2007,
    Elek2009,
    Algorithm1,
    Bruneton2017,
    Elek2010,
    Compact,
}

impl Family {
    pub const ALL: [Family; 8] = [
        Family::Nishita1993,
        Family::Oneil2004,
        Family::Schafhitzel2007,
        Family::Elek2009,
        Family::Algorithm1,
        Family::Bruneton2017,
        Family::Elek2010,
        Family::Compact,
    ];

    /// For legends.
    pub fn title(self) -> &'static str {
        match self {
            Family::Nishita1993 => "Nishita 1993, marched",
            Family::Oneil2004 => "O'Neil 2004, marched with a 2D table",
            Family::Schafhitzel2007 => "Schafhitzel 2007, 3D table",
            Family::Elek2009 => "Elek 2009, 3D table",
            Family::Algorithm1 => "Elek & Kmoch 2010, Algorithm 1",
            Family::Bruneton2017 => "Bruneton 2017, mapping",
            Family::Elek2010 => "tyndall, layout elek2010",
            Family::Compact => "tyndall, layout compact",
        }
    }

    /// Tables and solver of this project, and no one else's.
    pub fn is_ours(self) -> bool {
        matches!(self, Family::Elek2010 | Family::Compact)
    }
}

/// A way to draw a sky.
pub trait Method: Sync {
    fn family(&self) -> Family;

    /// What tells it from others of its family: sizes, steps, orders.
    fn setting(&self) -> String;

    /// Everything that can be done before a view is known. Errors: a planet or setting that the method has no place for.
    fn prepare(&self, planet: &Planet) -> Result<Prepared>;
}

/// A prepared sky, and what it took.
pub struct Prepared {
    pub sky: Box<dyn PreparedSky>,
    /// Processor time, all threads.
    pub cpu: Duration,
    /// What the method itself leaves in doubt.
    pub warnings: Vec<String>,
}

impl Prepared {
    /// Prepares and takes the time of it.
    fn timed<S: PreparedSky + 'static>(prepare: impl FnOnce() -> S) -> Prepared {
        let start = crate::machine::cpu_time::cpu_time();
        let sky = Box::new(prepare());
        Prepared {
            sky,
            cpu: crate::machine::cpu_time::cpu_time().saturating_sub(start),
            warnings: Vec::new(),
        }
    }
}

/// A sky that answers.
pub trait PreparedSky: Sync {
    /// Light that arrives at a view, that of the ground included: linear sRGB over the star's illuminance, 1/sr.
    fn radiance(&self, view: &Point) -> [f64; 3];

    /// Bytes of all tables that look-ups read.
    fn bytes(&self) -> usize;

    /// Filtered texture reads of this view's look-up, of up to four channels and three axes each; a fourth axis doubles
    /// them.
    fn fetches(&self, view: &Point) -> usize;
}
