//! A water whose tables are filled at one size after the other and held against the slab solver.

use crate::bake::describe;
use crate::bake::files::Files;
use crate::colour::weights::ColourWeights;
use crate::error::Result;
use crate::layout::settings::Settings;
use crate::layout::sky::Component;
use crate::layout::water::lookup::{WaterSky, WaterView};
use crate::layout::water::{LAYOUT, Split, WaterTables, Waters, colour, fill, shared, slabs};
use crate::medium::{Medium, WaterMedium};
use crate::preset::{Planet, Water};
use crate::transport::slab::{Layer, Light, Slab, WaterOrders, leaving};
use crate::transport::solve::Solution;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;

/// A planet and its light, over the water.
#[derive(Clone, Copy)]
pub(super) struct Under<'a> {
    pub planet: &'a Planet,
    pub medium: &'a Medium,
    pub solution: &'a Solution,
    pub palette: &'a ColourWeights,
    pub split: &'a Split,
}

/// A water under a planet's sky.
pub(super) struct Trial<'a> {
    under: Under<'a>,
    water: Water,
    media: WaterMedium,
    slabs: Vec<Slab>,
    about: WaterTables,
}

impl<'a> Trial<'a> {
    /// Errors: colours that cannot be fitted.
    pub(super) fn new(under: Under<'a>, water: &Water) -> Result<Self> {
        let Under { planet, medium, solution, palette, split } = under;
        let media = water.medium(&palette.four_nm());
        let slabs = slabs(&media);
        let mut about = WaterTables {
            tables: shared::tables(std::slice::from_ref(water), medium, solution, palette, split),
            matrices: BTreeMap::new(),
            constants: BTreeMap::new(),
            colours: BTreeMap::new(),
            split: split.clone(),
        };
        let (matrix, error) = colour::fit(planet, water, medium, solution, split, palette)?;
        about.describe(water, (&media, &slabs), matrix, error);
        Ok(Trial { under, water: water.clone(), media, slabs, about })
    }

    /// What leaves the water, RGB over the star's illuminance, by the slab solver; of `sky`, its colours alone are used.
    pub(super) fn truth(&self, views: &[WaterView], sky: &WaterSky) -> Vec<[f64; 3]> {
        let Under { medium, solution, palette, split, .. } = self.under;
        let one = |v: &WaterView| {
            let direct = solution.sun_transmittance(medium.ground_radius, v.mu_s);
            let diffuse = solution.ground_irradiance(v.mu_s);
            let at = |(k, slab): (usize, &Slab)| {
                let w = palette.four[k];
                let parts = split.parts(v.mu_s, w, diffuse[w]);
                let light = Light { sky: parts, ..Light::sun(v.mu_s, direct[w] * v.mu_s.max(0.0)) };
                let layer = Layer::new(slab, v.depth);
                leaving(&self.media, k, &layer, v.mu, light, WaterOrders::All).iter().sum()
            };
            sky.rgb(&self.slabs.iter().enumerate().map(at).collect::<Vec<f64>>())
        };
        views.par_iter().map(one).collect()
    }

    /// The water's tables at a size, by some orders of scattering, as a reader of the bake has them.
    pub(super) fn sky(&self, size: [usize; 3], orders: WaterOrders) -> Result<WaterSky> {
        let waters = Waters { list: vec![self.water.clone()], size, orders, underwater: false };
        let tables = fill::tables(&self.water, &self.media, &self.slabs, &waters);
        let files = Files::unencoded(self.about.tables.iter().chain(&tables));
        let Under { planet, medium, palette, .. } = self.under;
        let mut manifest = describe::manifest(planet, &Settings::default(), palette, medium, &files);
        describe::add_waters(&mut manifest, std::slice::from_ref(&self.water), &self.about);
        WaterSky::new(Path::new("the model"), &manifest, &self.water.name, &files.named(LAYOUT))
    }

    /// What the tables answer, as [`Trial::truth`].
    pub(super) fn found(&self, views: &[WaterView], sky: &WaterSky) -> Vec<[f64; 3]> {
        views.par_iter().map(|v| sky.rgb(&sky.leaving(v, Component::Total))).collect()
    }
}
