//! Measures models: the light is solved once, tables are filled when a model has others than those before it.

use super::model::{Cost, Model};
use super::validation_views::{Errors, ValidationViews};
use crate::bake::describe;
use crate::bake::files::Files;
use crate::colour::samples as skies;
use crate::colour::weights::ColourWeights;
use crate::error::{Error, Result};
use crate::layout::compact;
use crate::layout::compact::CompactBuilder;
use crate::layout::settings::Settings;
use crate::layout::sky::{self, Sky};
use crate::layout::table_data::TableData;
use crate::mapping::Window;
use crate::medium::Medium;
use crate::preset::Planet;
use crate::transport::solve::{Orders, Resolution, Solution};
use std::path::Path;
use std::rc::Rc;

/// Tables kept at a time: those of a model and of a few that were tried in its place.
const KEPT: usize = 16;

/// Light of a planet by one choice of orders and wavelengths.
struct Light {
    orders: Orders,
    medium: Medium,
    solution: Solution,
    /// Colours that suit a window.
    palettes: Vec<(Window, Rc<ColourWeights>)>,
}

/// Where models are measured.
pub(super) struct Evaluator<'a> {
    planet: &'a Planet,
    base: Settings,
    lights: Vec<Light>,
    /// By all that they depend on, the newest last.
    tables: Vec<(String, Rc<Vec<TableData>>)>,
    pub measured: usize,
}

impl<'a> Evaluator<'a> {
    pub(super) fn new(planet: &'a Planet) -> Self {
        Evaluator { planet, base: Settings::default(), lights: Vec::new(), tables: Vec::new(), measured: 0 }
    }

    fn light(&mut self, model: &Model) -> Result<usize> {
        let nm = model.wavelengths_nm();
        let same = |l: &Light| l.orders == model.orders && l.medium.wavelengths_nm == nm;
        if let Some(k) = self.lights.iter().position(same) {
            return Ok(k);
        }
        let medium = self.planet.medium(&nm);
        medium.check().map_err(|reason| Error::Argument(format!("{}: {reason}", self.planet.name)))?;
        let solution = Solution::new(&medium, &Resolution::TABLES, model.orders);
        self.lights.push(Light { orders: model.orders, medium, solution, palettes: Vec::new() });
        Ok(self.lights.len() - 1)
    }

    /// Times that the operator of the orders was applied for a model, which is what its solution costs.
    pub(super) fn applications(&mut self, model: &Model) -> Result<usize> {
        let light = self.light(model)?;
        Ok(self.lights[light].solution.report.applications)
    }

    /// What a model costs to keep and to look up.
    pub(super) fn cost(&mut self, model: &Model) -> Result<Cost> {
        let light = self.light(model)?;
        Ok(model.cost(&self.lights[light].medium))
    }

    pub(super) fn medium(&mut self, model: &Model) -> Result<&Medium> {
        let light = self.light(model)?;
        Ok(&self.lights[light].medium)
    }

    /// The light of a model, and the colours that suit its window.
    pub(super) fn lit(&mut self, model: &Model) -> Result<(&Medium, &Solution, Rc<ColourWeights>)> {
        let light = self.light(model)?;
        let palette = self.palette(light, &model.window)?;
        let Light { medium, solution, .. } = &self.lights[light];
        Ok((medium, solution, palette))
    }

    fn palette(&mut self, light: usize, window: &Window) -> Result<Rc<ColourWeights>> {
        if let Some((_, palette)) = self.lights[light].palettes.iter().find(|p| p.0 == *window) {
            return Ok(palette.clone());
        }
        let Light { medium, solution, .. } = &self.lights[light];
        let sample = [0.0, 1.0].map(|half| skies::sample(solution, medium, half, window));
        let (irradiance, rgb) = (&self.planet.star.irradiance, &self.base.rgb);
        let palette = Rc::new(ColourWeights::fit(&medium.wavelengths_nm, irradiance, rgb, &sample)?);
        self.lights[light].palettes.push((*window, palette.clone()));
        Ok(palette)
    }

    /// Some tables of a model, filled or remembered. `key` says which, with all that they depend on.
    fn tables(&mut self, key: String, make: impl FnOnce() -> Vec<TableData>) -> Rc<Vec<TableData>> {
        if let Some(k) = self.tables.iter().position(|t| t.0 == key) {
            let found = self.tables.remove(k);
            self.tables.push(found);
        } else {
            self.tables.push((key, Rc::new(make())));
            if self.tables.len() > KEPT {
                self.tables.remove(0);
            }
        }
        self.tables.last().expect("one was pushed").1.clone()
    }

    /// The sky that a model's bake would answer with.
    pub(super) fn sky(&mut self, model: &Model) -> Result<Box<dyn Sky>> {
        self.measured += 1;
        let light = self.light(model)?;
        let palette = self.palette(light, &model.window)?;
        let (design, window) = (&model.design, &model.window);
        let sizes = &design.sizes;
        // Lent out for the time that tables are made from it.
        let Light { orders, medium, solution, palettes } = self.lights.swap_remove(light);
        let maker =
            CompactBuilder { medium: &medium, solution: &solution, palette: &palette, design, window };
        let of = format!("{orders:?} {} {window:?} {}", model.wavelengths, design.without_scatterers);
        let parts = [
            self.tables(format!("single {:?} {:?} {of}", sizes.single, design.folded), || maker.singles()),
            self.tables(format!("multiple {:?} {:?} {of}", sizes.multiple, design.folded), || {
                vec![maker.multiple().0]
            }),
            self.tables(format!("depth {:?} {of}", sizes.depth), || maker.depths()),
            self.tables(format!("irradiance {of}"), || vec![maker.irradiance()]),
            self.tables(format!("phase {:?} {of}", design.folded), || maker.phase().into_iter().collect()),
        ];
        let files = Files::unencoded(parts.iter().flat_map(|p| p.iter()));
        let settings = model.settings(&self.base);
        let manifest = describe::manifest(self.planet, &settings, &palette, &medium, &files);
        self.lights.push(Light { orders, medium, solution, palettes });
        let name = compact::LAYOUT;
        sky::of_pictures(Path::new("the model"), &manifest, name, &files.named(name))
    }

    /// How a model does on some views.
    pub(super) fn measure(&mut self, model: &Model, judge: &ValidationViews) -> Result<Errors> {
        Ok(judge.errors(self.sky(model)?.as_ref()))
    }

    /// Forgets tables, so that filling them again can be timed.
    pub(super) fn forget(&mut self) {
        self.tables.clear();
        self.lights.clear();
    }
}
