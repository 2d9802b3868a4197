//! The bake from a planet to the bytes of every file.

use super::files::Files;
use super::product::{IN_MEMORY, Product};
use super::solution_cache::SolutionCache;
use super::warnings;
use super::{coarse, describe, golden_vectors, pictures, report};
use crate::colour::samples as skies;
use crate::colour::weights::ColourWeights;
use crate::error::{Error, Result};
use crate::files::manifest::Manifest;
use crate::layout::elek2010::spectral;
use crate::layout::judge::{self, Truth};
use crate::layout::settings::Settings;
use crate::layout::sky::{self, AerosolPhase, Sky};
use crate::layout::table_data::TableData;
use crate::layout::water::WaterTables;
use crate::layout::water::lookup::WaterSky;
use crate::layout::{self, Filled, Ingredients, Layout, MediumKind, compact, elek2010, shader, water};
use crate::medium::Medium;
use crate::preset::{Planet, Water};
use crate::spectrum::RANGE;
use crate::transport::solve::{Orders, Resolution, Solution, worst};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// Residual above which a chosen number of orders is called too small.
const RESIDUAL_WARNING: f64 = 0.01;
/// Error of the energy balance above which the bake warns.
const BALANCE_WARNING: f64 = 3e-3;
/// Bakes a planet. `stage` is called with the name of each stage as it begins. Errors: a medium without meaning,
/// wavelengths or sizes that do not fit together, tables that cannot be encoded.
pub fn bake(planet: &Planet, settings: &Settings, stage: &mut dyn FnMut(&str)) -> Result<Product> {
    bake_in(&SolutionCache::default(), planet, settings, stage)
}

/// The same, with the light of bakes before where it is the same. Errors: as [`bake`].
pub fn bake_in(
    lights: &SolutionCache,
    planet: &Planet,
    settings: &Settings,
    stage: &mut dyn FnMut(&str),
) -> Result<Product> {
    let solved = Solved::new(lights, planet, settings, stage)?;
    stage("colours");
    let sample = solved.sample();
    let palette = solved.palette(&sample)?;
    let filled = solved.fill(&palette, stage)?;

    stage("encode");
    let mut files = Files::encode(&filled.tables, &settings.storage)?;
    if let (true, Some(light)) = (settings.spectral, &solved.paper_light) {
        files.extra.extend(spectral::files(&solved.paper, light, planet, settings)?);
    }
    if settings.has(compact::LAYOUT) && sample.iter().any(|s| !s.transfers.is_empty()) {
        files.extra.push(skies::file(&sample, &settings.wavelengths_nm)?);
    }
    let mut manifest = describe::manifest(planet, settings, &palette, &solved.full, &files);
    manifest.constants.extend(filled.constants.clone());
    files.extra.extend(filled.files.iter().cloned());
    if let Some(waters) = &filled.waters {
        describe::add_waters(&mut manifest, &settings.waters.list, waters);
    }
    let skies = Skies::open(settings, &manifest, &files)?;

    stage("report");
    let quality = solved.quality(&palette, &filled, &skies, &files);
    let mut warnings = solved.warnings(&palette, &quality);

    let points = golden_vectors::points(&solved.full, &settings.window);
    files.extra.extend(skies.all().map(|(layout, sky)| golden_vectors::file(layout.name(), sky, &points)));
    for (layout, _) in skies.all() {
        files.extra.extend(shader::files(Path::new(IN_MEMORY), &manifest, layout.name())?);
    }

    stage("picture");
    let (picture, errors) =
        pictures::preview(skies.best(), planet, &settings.window, &skies.named(&settings.waters.list))?;
    if errors > 0 {
        warnings.push(format!("preview.png: {errors} pixels that no display can show (in magenta)"));
    }
    let about = "skies at several sun heights and the planet from space";
    files.extra.push((pictures::FILE.into(), about.into(), picture));

    manifest.files = files.others();
    manifest.quality = Value::Object(quality);
    manifest.warnings = warnings;
    manifest.seal()?;
    let text = manifest.to_json()?;
    let mut out = files.into_bytes();
    out.push(("bake.json".into(), text.into_bytes()));
    Ok(Product { files: out, manifest, light_cpu: solved.light_cpu })
}

/// The planet's media and the light in those that the layouts need: at least one of the two.
struct Solved<'a> {
    planet: &'a Planet,
    settings: &'a Settings,
    full: Medium,
    paper: Medium,
    full_light: Option<Arc<Solution>>,
    paper_light: Option<Arc<Solution>>,
    light_cpu: Duration,
}

/// Tables of all layouts, and what goes with them.
#[derive(Default)]
struct All {
    tables: Vec<TableData>,
    counts: Map<String, Value>,
    constants: BTreeMap<String, Vec<f64>>,
    files: Vec<(String, String, Vec<u8>)>,
    waters: Option<WaterTables>,
}

impl All {
    fn add(&mut self, filled: Filled) {
        self.tables.extend(filled.tables);
        self.counts.extend(filled.counts);
        self.constants.extend(filled.constants);
        self.files.extend(filled.files);
    }
}

impl<'a> Solved<'a> {
    fn new(
        lights: &SolutionCache,
        planet: &'a Planet,
        settings: &'a Settings,
        stage: &mut dyn FnMut(&str),
    ) -> Result<Self> {
        stage("media");
        let full = planet.medium(&settings.wavelengths_nm);
        full.check().map_err(|reason| Error::Argument(format!("{}: {reason}", planet.name)))?;
        for name in &settings.compact.folded {
            check_folded(&full, name)?;
        }
        let paper = full.similarity();
        let wants = |kind| settings.layouts_of(kind).next().is_some();
        stage("solve");
        let full_light =
            wants(MediumKind::Full).then(|| lights.of(&full, &Resolution::TABLES, settings.orders));
        stage("solve paper's medium");
        let paper_light = (wants(MediumKind::Paper) || full_light.is_none())
            .then(|| lights.of(&paper, &Resolution::PAPER, settings.orders));
        let light_cpu = full_light.iter().chain(&paper_light).map(|l| l.cpu).sum();
        let [full_light, paper_light] = [full_light, paper_light].map(|l| l.map(|l| l.light));
        Ok(Solved { planet, settings, full, paper, full_light, paper_light, light_cpu })
    }

    /// The medium nearest to the preset's that was solved, and its light.
    fn best(&self) -> (&Medium, &Solution) {
        match (&self.full_light, &self.paper_light) {
            (Some(light), _) => (&self.full, light.as_ref()),
            (None, Some(light)) => (&self.paper, light.as_ref()),
            (None, None) => unreachable!("one of the two was solved"),
        }
    }

    /// Two samples of the planet's skies, on which colours are fitted and judged.
    fn sample(&self) -> [skies::Skies; 2] {
        let (medium, light) = self.best();
        [0.0, 1.0].map(|half| skies::sample(light, medium, half, &self.settings.window))
    }

    fn palette(&self, sample: &[skies::Skies; 2]) -> Result<ColourWeights> {
        let irradiance = &self.planet.star.irradiance;
        ColourWeights::fit(&self.settings.wavelengths_nm, irradiance, &self.settings.rgb, sample)
    }

    /// The light in a medium, where it was solved.
    fn light(&self, kind: MediumKind) -> Option<&Solution> {
        match kind {
            MediumKind::Full => self.full_light.as_deref(),
            MediumKind::Paper => self.paper_light.as_deref(),
        }
    }

    fn fill(&self, palette: &ColourWeights, stage: &mut dyn FnMut(&str)) -> Result<All> {
        let (planet, settings, full, paper) = (self.planet, self.settings, &self.full, &self.paper);
        let mut all = All::default();
        for kind in [MediumKind::Paper, MediumKind::Full] {
            let Some(solution) = self.light(kind) else { continue };
            for layout in settings.layouts_of(kind) {
                stage(&format!("{} tables", layout.name()));
                all.add(layout.fill(&Ingredients { planet, settings, full, paper, solution, palette })?);
            }
        }
        if !settings.waters.list.is_empty() {
            stage("water tables");
            let (medium, light) = self.best();
            let mut waters = water::tables(planet, settings, medium, light, palette)?;
            all.tables.append(&mut waters.tables);
            all.waters = Some(waters);
        }
        Ok(all)
    }

    /// The quality report: each layout read back, against direct integration of the media.
    fn quality(
        &self,
        palette: &ColourWeights,
        filled: &All,
        skies: &Skies,
        files: &Files,
    ) -> Map<String, Value> {
        let mut out = Map::new();
        let truth = |medium, light: &Solution| judge::truths(medium, light, &self.settings.window);
        let full = self.full_light.as_ref().map(|light| truth(&self.full, light));
        out.insert("colour".into(), report::colours(palette, full.as_deref()));
        if let (Some(light), Some(truth)) = (&self.full_light, &full) {
            out.insert("solver".into(), report::solver(&self.full, light));
            skies.judge(MediumKind::Full, palette, truth, &mut out);
        }
        if let (Some(light), Some(sky)) = (&self.paper_light, skies.of(elek2010::LAYOUT)) {
            out.insert("paper_medium_solver".into(), report::solver(&self.paper, light));
            skies.judge(MediumKind::Paper, palette, &truth(&self.paper, light), &mut out);
            if let Some(truth) = &full {
                let full = judge::in_rgb(sky, palette, truth, AerosolPhase::Preset);
                out.insert("elek2010_against_the_full_medium".into(), full);
            }
        }
        if let Some(tables) = &filled.waters {
            let (medium, light) = self.best();
            let waters = &self.settings.waters.list;
            let orders = self.settings.waters.orders;
            let found = water::report(waters, medium, light, palette, tables, &skies.waters, orders);
            out.insert("water".into(), found);
        }
        let mut counts = filled.counts.clone();
        counts.insert("stored halves".into(), files.odd_halves());
        out.insert("counts".into(), Value::Object(counts));
        out
    }

    /// What the preset, the settings and the solver leave in doubt.
    fn warnings(&self, palette: &ColourWeights, quality: &Map<String, Value>) -> Vec<String> {
        let mut out = self.planet.warnings.clone();
        out.extend(outside_vision(&self.settings.wavelengths_nm));
        out.extend(few_wavelengths(&self.settings.wavelengths_nm));
        out.extend(warnings::colours(palette));
        out.extend(coarse::sheets(&self.full, self.settings));
        let waters = &self.settings.waters.list;
        out.extend(waters.iter().flat_map(|w| w.warnings.iter().map(|t| format!("{}: {t}", w.name))));
        for (name, light) in [("full", &self.full_light), ("paper's", &self.paper_light)] {
            out.extend(light.iter().flat_map(|l| solver_warnings(name, l, self.settings)));
        }
        for key in ["solver", "paper_medium_solver"] {
            let error = quality.get(key).and_then(|s| s["energy_balance_error"].as_f64());
            if let Some(error) = error.filter(|e| e.abs() > BALANCE_WARNING) {
                out.push(format!("energy balance of the {key}: {:+.2} % of the light", 100.0 * error));
            }
        }
        out.extend(warnings::tables(quality));
        out.extend(warnings::underwater(quality));
        out
    }
}

/// The bake as its readers will see it.
struct Skies {
    /// The most exact first.
    air: Vec<(&'static dyn Layout, Box<dyn Sky>)>,
    waters: Vec<WaterSky>,
}

impl Skies {
    fn open(settings: &Settings, manifest: &Manifest, files: &Files) -> Result<Self> {
        let bake = Path::new(IN_MEMORY);
        let open = |layout: &'static dyn Layout| {
            let name = layout.name();
            Ok((layout, sky::of_pictures(bake, manifest, name, &files.named(name))?))
        };
        let water = |w: &Water| WaterSky::new(bake, manifest, &w.name, &files.named(water::LAYOUT));
        let baked = layout::ALL.into_iter().filter(|layout| settings.has(layout.name()));
        Ok(Skies {
            waters: settings.waters.list.iter().map(water).collect::<Result<_>>()?,
            air: baked.map(open).collect::<Result<_>>()?,
        })
    }

    fn all(&self) -> impl Iterator<Item = (&'static dyn Layout, &dyn Sky)> {
        self.air.iter().map(|(layout, sky)| (*layout, sky.as_ref()))
    }

    fn of(&self, layout: &str) -> Option<&dyn Sky> {
        self.all().find(|(l, _)| l.name() == layout).map(|(_, sky)| sky)
    }

    fn best(&self) -> &dyn Sky {
        self.air[0].1.as_ref()
    }

    /// Adds the errors of the layouts of a medium to a quality report.
    fn judge(
        &self,
        kind: MediumKind,
        palette: &ColourWeights,
        truths: &[Truth],
        out: &mut Map<String, Value>,
    ) {
        for (layout, sky) in self.all().filter(|(layout, _)| layout.medium() == kind) {
            out.insert(layout.report_key().into(), layout.judge(sky, palette, truths));
        }
    }

    fn named<'a>(&'a self, waters: &'a [Water]) -> Vec<(&'a str, &'a WaterSky)> {
        waters.iter().map(|w| w.name.as_str()).zip(&self.waters).collect()
    }
}

/// What is folded must be there and scatter.
pub fn check_folded(medium: &Medium, name: &str) -> Result<()> {
    let scatterers = medium.constituents.iter().filter(|c| c.scatters()).map(|c| c.name.as_str());
    let scatterers: Vec<&str> = scatterers.collect();
    if scatterers.contains(&name) {
        return Ok(());
    }
    let near = crate::preset::names::nearest(name, scatterers.iter().copied());
    let known = match near {
        Some(near) => format!("the nearest is `{near}`"),
        None => format!("there is {}", scatterers.join(", ")),
    };
    Err(Error::Argument(format!("--fold {name}: nothing of that name scatters here; {known}")))
}

/// A warning where wavelengths lie outside those that colours are made of.
fn outside_vision(nm: &[f64]) -> Option<String> {
    let (from, to) = RANGE;
    let outside = nm.iter().filter(|w| !(from..=to).contains(*w)).count();
    (outside > 0).then(|| {
        format!(
            "{outside} of {} wavelengths lie outside {from} to {to} nm, which is all that colours see; spectra \
             of the preset are held at their ends where they are not given",
            nm.len()
        )
    })
}

/// A warning where there are fewer wavelengths than colours have dimensions.
fn few_wavelengths(nm: &[f64]) -> Option<String> {
    (nm.len() < 3).then(|| {
        let (n, s) = (nm.len(), if nm.len() == 1 { "" } else { "s" });
        format!("{n} wavelength{s}: colours need three, those of this bake are of one kind of sky; radiance is exact")
    })
}

fn solver_warnings(name: &str, solution: &Solution, settings: &Settings) -> Vec<String> {
    let worst = worst(&solution.report.residual);
    match settings.orders {
        Orders::Converged { tolerance } if worst > 10.0 * tolerance => vec![format!(
            "{name} medium: not converged after {} applications, residual {worst:.2e}",
            solution.report.applications
        )],
        Orders::First(n) if worst > RESIDUAL_WARNING => vec![format!(
            "{name} medium: {n} orders leave {:.1} % of the light for the next one at some place; --orders auto sums all",
            100.0 * worst
        )],
        _ => Vec::new(),
    }
}
