//! What a bake is asked for, apart from the planet: everything that decides its bytes.

use super::compact::{Design, Sizes};
use super::water::Waters;
use crate::spectrum::ColourSpace;
use crate::table::{Elek2010, Views, Window};
use crate::transport::slab::WaterOrders;
use crate::transport::solve::Orders;
use serde_json::{Value, json};

/// A way to store a sky.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum)]
pub enum Layout {
    Elek2010,
    Compact,
}

impl Layout {
    pub fn name(self) -> &'static str {
        match self {
            Layout::Elek2010 => super::elek2010::LAYOUT,
            Layout::Compact => super::compact::LAYOUT,
        }
    }
}

/// Who sums the orders for the paper's layout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solver {
    /// Angular moments of the radiance.
    Moments,
    /// Algorithm 1 as it is written, with this many samples an integral.
    Literal { samples: usize },
}

/// Settings of a bake.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    pub layouts: Vec<Layout>,
    pub elek2010_size: [usize; 4],
    pub compact: Design,
    /// The part of altitudes, suns and views that the tables hold, of both layouts.
    pub window: Window,
    pub orders: Orders,
    pub wavelengths_nm: Vec<f64>,
    pub space: ColourSpace,
    pub solver: Solver,
    pub spectral: bool,
    pub waters: Waters,
    /// The planet is a shipped preset as it is, so that `verify` may tell when a later tool ships another.
    pub shipped_preset: bool,
}

/// Relative change that a converged solution may still make: well below what tables lose.
pub const TOLERANCE: f64 = 1e-3;
/// Wavelengths of a bake unless others are asked for, as in the paper.
pub const WAVELENGTHS: usize = 15;

impl Default for Settings {
    fn default() -> Self {
        Settings {
            layouts: vec![Layout::Elek2010, Layout::Compact],
            elek2010_size: Elek2010::PAPER_SIZE,
            compact: Design::default(),
            window: Window::WHOLE,
            orders: Orders::Converged { tolerance: TOLERANCE },
            wavelengths_nm: crate::spectrum::grid(WAVELENGTHS),
            space: ColourSpace::Srgb,
            solver: Solver::Moments,
            spectral: false,
            waters: Waters::default(),
            shipped_preset: false,
        }
    }
}

impl Settings {
    /// For the manifest.
    pub fn json(&self) -> Value {
        let orders = match self.orders {
            Orders::Converged { tolerance } => json!({ "converged_to": tolerance }),
            Orders::First(n) => json!({ "first": n }),
        };
        let solver = match self.solver {
            Solver::Moments => json!("moments"),
            Solver::Literal { samples } => json!({ "literal": { "samples": samples } }),
        };
        let mut out = json!({
            "layouts": self.layouts.iter().map(|l| l.name()).collect::<Vec<_>>(),
            "elek2010_size": self.elek2010_size,
            "compact_single_size": self.compact.sizes.single,
            "compact_multiple_size": self.compact.sizes.multiple,
            "orders": orders,
            "solver": solver,
            "spectral": self.spectral,
            "waters": self.waters.list.iter().map(|w| w.name.as_str()).collect::<Vec<_>>(),
            "water_size": self.waters.size,
            "water_orders": match self.waters.orders {
                WaterOrders::All => json!("all"),
                WaterOrders::First(n) => json!({ "first": n }),
            },
            "underwater": self.waters.underwater,
            "shipped_preset": self.shipped_preset,
        });
        // What leaves something out stands there only where something is left out.
        let design = &self.compact;
        let window = &self.window;
        let mut add = |key: &str, value: Value| out[key] = value;
        if design.sizes.depth != Sizes::default().depth {
            add("compact_transmittance_size", json!(design.sizes.depth));
        }
        if let Some(ends) = window.altitudes {
            add("altitudes_m", json!(ends));
        }
        if let Some(ends) = window.suns {
            add("suns_deg", json!(ends));
        }
        if window.views == Views::Sky {
            add("views", json!("sky"));
        }
        if !design.folded.is_empty() {
            add("folded", json!(design.folded));
        }
        if design.without_scatterers {
            add("without", json!(["scatterers"]));
        }
        out
    }
}
