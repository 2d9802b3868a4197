//! What a bake is asked for, apart from the planet: everything that decides its bytes.

use super::compact::{self, CompactLayout, CompactSettings, Sizes};
use super::elek2010::{self, Elek2010Layout};
use super::water::Waters;
use super::{Layout, MediumKind};
use crate::algorithm1::Gather;
use crate::files::container::Container;
use crate::mapping::{Elek2010, Views, Window};
use crate::spectrum::{ColourSpace, Rgb, White};
use crate::transport::slab::WaterOrders;
use crate::transport::solve::Orders;
use serde_json::{Value, json};

/// Who sums the orders for the paper's layout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solver {
    /// Angular moments of the radiance.
    Moments,
    /// Algorithm 1 as it is written, with this many samples an integral.
    Literal { samples: usize, gather: Gather },
}

/// In which files tables are stored.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Storage {
    /// Besides EXR.
    pub containers: Vec<Container>,
    /// Slices of EXR files lie in one column and not in a grid.
    pub column: bool,
}

impl Storage {
    fn formats(&self) -> Vec<&str> {
        [Container::Exr].iter().chain(&self.containers).map(|c| c.name()).collect()
    }
}

/// Settings of a bake.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    pub layouts: Vec<&'static dyn Layout>,
    pub elek2010_size: [usize; 4],
    pub compact: CompactSettings,
    /// The part of altitudes, suns and views that the tables hold, of both layouts.
    pub window: Window,
    pub orders: Orders,
    pub wavelengths_nm: Vec<f64>,
    pub rgb: Rgb,
    pub solver: Solver,
    pub spectral: bool,
    pub storage: Storage,
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
            layouts: vec![&Elek2010Layout, &CompactLayout],
            elek2010_size: Elek2010::PAPER_SIZE,
            compact: CompactSettings::default(),
            window: Window::WHOLE,
            orders: Orders::Converged { tolerance: TOLERANCE },
            wavelengths_nm: crate::spectrum::grid(WAVELENGTHS),
            rgb: Rgb { space: ColourSpace::Srgb, white: None },
            solver: Solver::Moments,
            spectral: false,
            storage: Storage::default(),
            waters: Waters::default(),
            shipped_preset: false,
        }
    }
}

impl Settings {
    /// Whether a layout is to be written.
    pub fn has(&self, layout: &str) -> bool {
        self.layouts.iter().any(|l| l.name() == layout)
    }

    /// The layouts whose tables hold the light of a medium.
    pub fn layouts_of(&self, medium: MediumKind) -> impl Iterator<Item = &'static dyn Layout> {
        self.layouts.iter().copied().filter(move |l| l.medium() == medium)
    }

    /// For the manifest.
    pub fn json(&self) -> Value {
        let orders = match self.orders {
            Orders::Converged { tolerance } => json!({ "converged_to": tolerance }),
            Orders::First(n) => json!({ "first": n }),
        };
        let solver = match self.solver {
            Solver::Moments => json!("moments"),
            Solver::Literal { samples, gather: Gather::PerPoint } => {
                json!({ "literal": { "samples": samples } })
            }
            Solver::Literal { samples, gather } => {
                json!({ "literal": { "samples": samples, "gather": format!("{gather:?}") } })
            }
        };
        let mut out = json!({
            "layouts": self.layouts.iter().map(|l| l.name()).collect::<Vec<_>>(),
            "orders": orders,
            "solver": solver,
            "white": white(&self.rgb),
            "spectral": self.spectral,
            "formats": self.storage.formats(),
            "exr_atlas": if self.storage.column { "column" } else { "grid" },
            "waters": self.waters.list.iter().map(|w| w.name.as_str()).collect::<Vec<_>>(),
            "water_size": self.waters.size,
            "water_orders": match self.waters.orders {
                WaterOrders::All => json!("all"),
                WaterOrders::First(n) => json!({ "first": n }),
            },
            "underwater": self.waters.underwater,
            "shipped_preset": self.shipped_preset,
        });
        // Sizes of layouts that are not baked decide nothing; what leaves something out stands there only where
        // something is left out.
        let design = &self.compact;
        let window = &self.window;
        let mut add = |key: &str, value: Value| out[key] = value;
        if self.has(elek2010::LAYOUT) {
            add("elek2010_size", json!(self.elek2010_size));
        }
        if self.has(compact::LAYOUT) {
            add("compact_single_size", json!(design.sizes.single));
            add("compact_multiple_size", json!(design.sizes.multiple));
        }
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

/// For the manifest: what is adapted to the white of the colour space, and how; null if nothing is.
pub fn white(rgb: &Rgb) -> Value {
    let Some((white, by)) = rgb.white else { return Value::Null };
    let from = match white {
        White::Star => json!("star"),
        White::Xy(xy) => json!(xy),
    };
    json!({ "from": from, "by": by })
}

/// The window in the settings of a manifest.
pub fn window(settings: &Value) -> Window {
    let ends = |key: &str| {
        let list = settings[key].as_array()?;
        Some([list.first()?.as_f64()?, list.get(1)?.as_f64()?])
    };
    let views = if settings["views"] == "sky" { Views::Sky } else { Views::All };
    Window { altitudes: ends("altitudes_m"), suns: ends("suns_deg"), views }
}
