//! Water tables (Elek & Kmoch 2010, §4.3): light that comes up to the surface, for any depth, view and sun.
//!
//! Tables hold what the water does to light and leave out what the surface and the air do, so that they are
//! smooth and that an engine may tilt the surface: radiance just below it over n², per unit of what enters. With
//! F Fresnel's reflectance, E_sun the irradiance of the surface by the sun and E_i those by two parts of the sky, one
//! as bright as the cosine of the zenith angle and one as the square of what that lacks of 1, A the albedo of the bed,
//!   L = (1 − F(mu)) [ (1 − e^{−κD}) ((1 − F(mu_s)) E_sun W(D, mu, mu_s) + Σ E_i S_i(D, mu))
//!                     + U(D, mu) A B / (π − A r(D)) ]
//!   B = (1 − F(mu_s)) E_sun W_b(D, mu_s) + Σ E_i B_i(D)
//! is what leaves the water: the water's own light, and that of the bed with every bounce between bed, water and
//! surface. W is `<name>`, S_i `<name>_sky`, U `<name>_seabed`, W_b `<name>_seabed_sun`; B_i and r are the rows of
//! `<name>_seabed_depth`, E_sun and E_i those of `irradiance`; F is in `fresnel`; κ is the constant
//! `water_<name>_kappa_per_m`, which takes the steep rise of shallow water out of W and S.

mod axes;
pub(crate) mod colour;
pub(crate) mod fill;
pub mod lookup;
mod report;
pub(crate) mod shared;
mod skylight;
mod underwater;
mod within;

use super::settings::Settings;
use super::table_data::TableData;
use crate::colour::weights::ColourWeights;
use crate::error::Result;
use crate::medium::{Medium, WaterMedium};
use crate::preset::{Planet, Water};
use crate::transport::slab::{Slab, Streams, Surface};
use crate::transport::solve::Solution;
use rayon::prelude::*;
use std::collections::BTreeMap;

pub use axes::{EvenCosine, WaterAxes};
pub use colour::spectra;
pub use report::report;
pub use shared::{LAZANYI, REFLECTED, TRANSMITTED, UNDERSIDE};
pub use skylight::{FINE, Skylight, Split};

/// Name of the layout and of its folder.
pub const LAYOUT: &str = "water";
/// Raised when the bytes of waters change (see [`crate::bake::versions`]).
pub const ALGORITHM_VERSION: u32 = 1;
/// The paper's size: depth, view, sun.
pub const SIZE: [usize; 3] = [32, 64, 64];

/// What is asked of waters.
#[derive(Clone, Debug, PartialEq)]
pub struct Waters {
    pub list: Vec<Water>,
    /// Texels of depth, view and sun.
    pub size: [usize; 3],
    /// Tables for observers under water too.
    pub underwater: bool,
    pub orders: crate::transport::slab::WaterOrders,
}

impl Default for Waters {
    fn default() -> Self {
        let orders = crate::transport::slab::WaterOrders::All;
        Waters { list: Vec::new(), size: SIZE, underwater: false, orders }
    }
}

/// Tables of all waters, and what the manifest has to say beside them.
pub struct WaterTables {
    pub tables: Vec<TableData>,
    pub matrices: BTreeMap<String, Vec<Vec<f64>>>,
    pub constants: BTreeMap<String, Vec<f64>>,
    /// ΔE2000 of the colours of four wavelengths, by water: with the weights of the sky, and with its own.
    pub colours: BTreeMap<String, [crate::colour::weights::ColourError; 2]>,
    /// How the sky's light falls.
    pub split: Split,
}

/// Bytes of texels of some waters' tables, for observers above them.
pub fn bytes(waters: usize, [depths, views, suns]: [usize; 3]) -> usize {
    // The water itself; the sky in two parts and the bed; the bed under the sun; what the bed returns.
    let each = depths * views * suns + fill::DEPTHS * (3 * views + suns + 3);
    let all = shared::SUNS * 3 + shared::ANGLES * 4 * waters;
    8 * (each * waters + all)
}

/// The slabs of a medium, one a wavelength.
pub fn slabs(medium: &WaterMedium) -> Vec<Slab> {
    let one = |w: usize| Slab::new(medium, w, Surface { n: medium.refractive_index[w] }, Streams::TABLES);
    (0..medium.wavelengths_nm.len()).into_par_iter().map(one).collect()
}

/// Fills the tables of all waters of a bake for a solved planet.
pub fn tables(
    planet: &Planet,
    settings: &Settings,
    medium: &Medium,
    solution: &Solution,
    palette: &ColourWeights,
) -> Result<WaterTables> {
    let (nm, waters) = (palette.four_nm(), &settings.waters);
    let split = Split::new(medium, solution);
    let mut out = WaterTables {
        tables: shared::tables(&waters.list, medium, solution, palette, &split),
        matrices: BTreeMap::new(),
        constants: BTreeMap::new(),
        colours: BTreeMap::new(),
        split,
    };
    for water in &waters.list {
        let media = water.medium(&nm);
        let slabs = slabs(&media);
        out.tables.extend(fill::tables(water, &media, &slabs, waters));
        if waters.underwater {
            out.tables.extend(underwater::tables(water, &media, &slabs, waters.orders));
        }
        let (matrix, error) = colour::fit(planet, water, medium, solution, &out.split, palette)?;
        out.describe(water, (&media, &slabs), matrix, error);
    }
    Ok(out)
}

impl WaterTables {
    /// Adds what the manifest has to say of a water.
    pub(crate) fn describe(
        &mut self,
        water: &Water,
        (media, slabs): (&WaterMedium, &[Slab]),
        matrix: Vec<Vec<f64>>,
        error: [crate::colour::weights::ColourError; 2],
    ) {
        let key = |what: &str| format!("water_{}_{what}", water.name);
        self.matrices.insert(key("rgb_from_four"), matrix);
        self.colours.insert(water.name.clone(), error);
        self.constants.insert(key("seabed_albedo_at_four"), media.seabed_albedo.clone());
        self.constants.insert(key("refractive_index_at_four"), media.refractive_index.clone());
        self.constants.insert(key("kappa_per_m"), slabs.iter().map(fill::rise).collect());
        self.constants.insert(key("largest_depth_m"), vec![water.largest_depth]);
    }
}
