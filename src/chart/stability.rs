//! Awkward planets and settings, and how each method bears them: whether what it answers is a number, is not negative,
//! and how far it is off.
//!
//! Views are awkward too: the ground and exactly the top, both sides of the horizon and the horizon itself, zenith and
//! nadir, suns from overhead to 18° below the horizon and at the end of the tables' sun axis, towards the sun, across
//! and away. Errors are told of lit views by day, where a number means something on every planet.

use crate::algorithm1::Gather;
use crate::bake::SolutionCache;
use crate::error::Result;
use crate::geometry::Point;
use crate::geometry::view::View;
use crate::layout::Layout;
use crate::layout::compact::CompactLayout;
use crate::layout::compact::Sizes;
use crate::layout::elek2010::Elek2010Layout;
use crate::layout::settings::{Settings, Solver};
use crate::layout::three_atmosphere::ThreeAtmosphereLayout;
use crate::medium::Role;
use crate::methods::{
    BakedTables, Elek2009, Family, Method, Nishita, OneilMarch, PreparedSky, Schafhitzel, Storage,
};
use crate::preset::{self, Coefficient, Optics, PhaseLaw, Planet, Substance};
use crate::quality::{Distribution, colour_error};
use crate::spectrum::{ColourSpace, Reconstruction, Spectrum, grid, multiply};
use crate::transport::solve::{Orders, Resolution, lowest_sun};
use rayon::prelude::*;
use std::sync::Arc;

/// A planet and settings that are hard on a method.
pub struct Case {
    pub name: &'static str,
    pub planet: Planet,
    /// For our layouts.
    pub settings: Settings,
    /// It is the settings that are awkward: nothing to older methods.
    pub ours_alone: bool,
    /// Takes long.
    pub heavy: bool,
    /// Of the truth: one batch, unless the case is to be quick.
    wavelengths: usize,
}

impl Case {
    /// Few wavelengths, the same for the tables as for the truth, so that the planet's light is solved once. Errors are
    /// then those of the tables alone. Cases of settings stay as they are.
    pub fn quick(mut self) -> Self {
        if !self.ours_alone {
            self.wavelengths = 8;
            self.settings.wavelengths_nm = grid(self.wavelengths);
        }
        self
    }
}

/// Sizes for quick runs: the coarsest that are meant to be used.
fn small() -> Settings {
    Settings {
        elek2010_size: [12, 48, 24, 6],
        compact: Sizes { single: [10, 20, 20, 4], multiple: [8, 20, 20, 6], ..Sizes::default() }.into(),
        ..Settings::default()
    }
}

const WAVELENGTHS: usize = 16;

fn earth(change: impl FnOnce(&mut Planet)) -> Result<Planet> {
    let mut planet = preset::load("earth-paper", &[])?;
    change(&mut planet);
    Ok(planet)
}

fn air(planet: &Planet) -> Substance {
    planet.constituents[0].clone()
}

/// The aerosol of `earth-paper`, changed.
fn haze(planet: &mut Planet, change: impl FnOnce(&mut Substance)) {
    if let Some(c) = planet.constituents.iter_mut().find(|c| c.role == Role::Aerosol) {
        change(c);
    }
}

/// Grey optics, 1/m.
fn grey(scattering: f64, absorption: f64) -> Optics {
    let table = |per_m| Coefficient::Table { spectrum_per_m: Spectrum::constant(per_m) };
    Optics::ScatteringAndAbsorption { scattering: table(scattering), absorption: table(absorption) }
}

/// All cases. Errors: none but a shipped preset that cannot be read.
pub fn cases() -> Result<Vec<Case>> {
    let mut out = Vec::new();
    let dense = earth(|p| p.constituents.iter_mut().for_each(|c| c.density_factor *= 100.0))?;
    let thick = [("100 times denser", dense), ("venus", preset::load("venus", &[])?)];
    out.extend(thick.map(|(name, planet)| Case {
        name,
        planet,
        settings: small(),
        ours_alone: false,
        heavy: true,
        wavelengths: WAVELENGTHS,
    }));
    let mut planet = |name, planet: Result<Planet>| -> Result<()> {
        out.push(Case {
            name,
            planet: planet?,
            settings: small(),
            ours_alone: false,
            heavy: false,
            wavelengths: WAVELENGTHS,
        });
        Ok(())
    };
    planet("10 times denser", preset::load("earth-dense10", &[]))?;
    planet("mars", preset::load("mars", &[]))?;
    planet("no air", earth(|p| p.constituents.clear()))?;
    planet("gas alone", earth(|p| p.constituents.truncate(1)))?;
    planet("aerosol alone", earth(|p| drop(p.constituents.remove(0))))?;
    planet(
        "absorber alone",
        earth(|p| p.constituents = vec![Substance { optics: grey(0.0, 2e-5), ..air(p) }]),
    )?;
    planet("earth without ozone", without_ozone())?;
    planet("400 km planet, 60 km of air", earth(|p| (p.ground_radius, p.top_radius) = (400e3, 460e3)))?;
    planet("planet of ten Jupiters", earth(|p| (p.ground_radius, p.top_radius) = (7e8, 7e8 + 60e3)))?;
    planet("visibility of 3 km", earth(|p| haze(p, |c| c.density_factor = 3.912 / (3000.0 * 2.1e-5))))?;
    planet("nothing absorbs, ground albedo 1", earth(lossless))?;
    planet("g = 0.99", earth(|p| haze(p, |c| c.phase = henyey_greenstein(0.99))))?;
    // From here on one air, whose light is solved once.
    planet("earth-paper", earth(|_| {}))?;
    planet("star a millionth as bright", earth(|p| p.star.irradiance = p.star.irradiance.scaled(1e-6)))?;
    planet("star a million times as bright", earth(|p| p.star.irradiance = p.star.irradiance.scaled(1e6)))?;
    let mut setting = |name, change: &dyn Fn(&mut Settings)| -> Result<()> {
        let mut settings = small();
        change(&mut settings);
        let planet = earth(|_| {})?;
        out.push(Case { name, planet, settings, ours_alone: true, heavy: false, wavelengths: WAVELENGTHS });
        Ok(())
    };
    let with = |axis: usize| {
        move |s: &mut Settings| {
            for size in [&mut s.elek2010_size, &mut s.compact.sizes.single, &mut s.compact.sizes.multiple] {
                size[axis] = 2;
            }
        }
    };
    setting("2 altitudes", &with(0))?;
    setting("2 views", &with(1))?;
    setting("2 suns", &with(2))?;
    setting("2 azimuths", &with(3))?;
    setting("1 wavelength", &|s| s.wavelengths_nm = grid(1))?;
    setting("81 wavelengths", &|s| s.wavelengths_nm = grid(81))?;
    Ok(out)
}

fn without_ozone() -> Result<Planet> {
    let mut planet = preset::load("earth", &[])?;
    planet.constituents.retain(|c| !c.name.contains("ozone"));
    Ok(planet)
}

fn lossless(planet: &mut Planet) {
    planet.ground_albedo = Spectrum::constant(1.0);
    haze(planet, |c| c.optics = grey(2.1e-5, 0.0));
}

fn henyey_greenstein(g: f64) -> PhaseLaw {
    PhaseLaw::HenyeyGreenstein { g: Spectrum::constant(g) }
}

/// Light that cases share, of our tables and of the truth.
pub type Shared = Arc<SolutionCache>;

/// One of each family, small.
fn methods(settings: &Settings, lights: &Arc<SolutionCache>) -> Vec<Box<dyn Method>> {
    let baked = |family, layout: &'static dyn Layout, settings: Settings, storage| -> Box<dyn Method> {
        Box::new(BakedTables {
            family,
            setting: String::new(),
            layout,
            settings,
            storage,
            lights: lights.clone(),
        })
    };
    let literal = Settings {
        elek2010_size: [8, 32, 12, 4],
        orders: Orders::First(3),
        solver: Solver::Literal { samples: 10, gather: Gather::PerPoint },
        ..Settings::default()
    };
    vec![
        Box::new(Nishita { steps: 40, sun_steps: 20 }),
        Box::new(OneilMarch { steps: 40, size: [128, 128] }),
        Box::new(Schafhitzel { size: [64; 3] }),
        Box::new(Elek2009 { size: [16, 48, 24] }),
        baked(Family::Algorithm1, &Elek2010Layout, literal, Storage::AsBaked),
        baked(Family::Bruneton2017, &ThreeAtmosphereLayout, Settings::default(), Storage::RedOfMie),
        baked(Family::Elek2010, &Elek2010Layout, settings.clone(), Storage::AsBaked),
        baked(Family::Compact, &CompactLayout, settings.clone(), Storage::AsBaked),
    ]
}

/// How a method bore a case.
#[derive(Clone, Debug)]
pub struct Outcome {
    pub family: Family,
    /// Why there is no sky.
    pub refused: Option<String>,
    pub views: usize,
    pub not_finite: usize,
    /// Luminance below zero by more than what rounding leaves.
    pub negative: usize,
    /// Relative RGB on lit views by day.
    pub error: Distribution,
    /// What the method says of itself.
    pub warnings: Vec<String>,
}

/// Sun's zenith cosine from which it is day.
const DAY: f64 = 0.17;
/// Radiance over irradiance, 1/sr, below which a view is dark.
const DARK: f64 = 1e-11;

/// All methods on a case; `ours` leaves out the older ones, as does a case that is none to them.
pub fn run(case: &Case, ours: bool, shared: &Shared) -> Vec<Outcome> {
    let ours = ours || case.ours_alone;
    let views = awkward_views(&case.planet);
    let truth = truth(case, &views, shared);
    let methods = methods(&case.settings, shared);
    let chosen = methods.iter().filter(|m| !ours || m.family().is_ours());
    chosen.map(|m| outcome(m.as_ref(), &case.planet, &views, &truth)).collect()
}

fn outcome(method: &dyn Method, planet: &Planet, views: &[Point], truth: &[[f64; 3]]) -> Outcome {
    let family = method.family();
    let mut out = Outcome {
        family,
        refused: None,
        views: views.len(),
        not_finite: 0,
        negative: 0,
        error: Distribution::default(),
        warnings: Vec::new(),
    };
    match method.prepare(planet) {
        Err(error) => out.refused = Some(error.to_string()),
        Ok(prepared) => {
            out.look(prepared.sky.as_ref(), views, truth);
            out.warnings = prepared.warnings;
        }
    }
    out
}

impl Outcome {
    /// Whether the bake itself says that its tables of this layout miss their own day, or that its colours are none.
    pub fn is_warned(&self) -> bool {
        let layout = match self.family {
            Family::Elek2010 => "layout elek2010:",
            Family::Compact => "layout compact:",
            _ => return false,
        };
        self.warnings.iter().any(|w| w.starts_with(layout) || w.contains("colours need three"))
    }

    fn look(&mut self, sky: &dyn PreparedSky, views: &[Point], truth: &[[f64; 3]]) {
        let luminance = ColourSpace::Srgb.to_xyz()[1];
        let answers: Vec<[f64; 3]> = views.par_iter().map(|p| sky.radiance(p)).collect();
        let mut errors = Vec::new();
        for ((view, rgb), truth) in views.iter().zip(&answers).zip(truth) {
            let y: f64 = (0..3).map(|c| luminance[c] * rgb[c]).sum();
            self.not_finite += usize::from(rgb.iter().any(|v| !v.is_finite()));
            self.negative += usize::from(y < 0.0);
            if view.mu_s >= DAY && (0..3).map(|c| luminance[c] * truth[c]).sum::<f64>() > DARK {
                errors.push(colour_error(*rgb, *truth));
            }
        }
        self.error = Distribution::of(errors);
    }
}

/// Places and directions where formulas divide by nothing, tables end or halves meet.
pub fn awkward_views(planet: &Planet) -> Vec<Point> {
    let height = planet.height();
    let end = lowest_sun(&planet.medium(&[550.0]));
    let suns = [-18.0, -6.0, -0.5, 0.0, 0.5, 10.0, 30.0, 50.0, 90.0].map(|e: f64| libm::sin(e.to_radians()));
    let suns: Vec<f64> = suns.into_iter().chain([end - 1e-9, end + 1e-9]).collect();
    let mut out = Vec::new();
    for altitude in [0.0, 1.0, 0.1 * height, 0.7 * height, height, 3.0 * height] {
        let r = planet.ground_radius + altitude;
        let horizon = -libm::acos((planet.ground_radius / r).min(1.0)).to_degrees();
        for elevation in [-90.0, horizon - 0.1, horizon, horizon + 0.1, 0.0, 35.0, 90.0] {
            let mu = libm::sin(f64::max(elevation, -90.0).to_radians());
            for &mu_s in &suns {
                let azimuths = [0.0, 90.0, 180.0];
                out.extend(azimuths.map(|azimuth_deg| Point { altitude, mu, mu_s, azimuth_deg }));
            }
        }
    }
    out
}

/// Linear RGB over the star's illuminance.
fn truth(case: &Case, views: &[Point], lights: &SolutionCache) -> Vec<[f64; 3]> {
    let (planet, nm) = (&case.planet, grid(case.wavelengths));
    let medium = planet.medium(&nm);
    let tolerance = crate::layout::settings::TOLERANCE;
    let solution = lights.of(&medium, &Resolution::TABLES, Orders::Converged { tolerance }).light;
    let reconstruction = Reconstruction::new(&nm, &planet.star.irradiance);
    let illuminance = reconstruction.sum(|_| 1.0)[1];
    let last: Vec<usize> = (0..medium.constituents.len()).collect();
    let light = |p: &Point| {
        let Some(view) = View::enter(p, medium.ground_radius, medium.top_radius) else { return [0.0; 3] };
        let found = solution.radiance(&view, &last);
        let sum: Vec<f64> = found.scattering.iter().zip(&found.ground).map(|(s, g)| s + g).collect();
        multiply(&ColourSpace::Srgb.from_xyz(), reconstruction.xyz(&sum)).map(|v| v / illuminance)
    };
    views.par_iter().map(|p| if p.mu_s >= DAY { light(p) } else { [0.0; 3] }).collect()
}

/// The outcomes as a table in Markdown, a row a case.
pub fn markdown(outcomes: &[(&'static str, Vec<Outcome>)]) -> String {
    let families = |f: &dyn Fn(Family) -> String| Family::ALL.map(f).join(" | ");
    let mut out =
        format!("| case | {} |\n|---|{}\n", families(&|f| short(f).into()), "---|".repeat(Family::ALL.len()));
    for (name, list) in outcomes {
        let cell = |f: Family| list.iter().find(|o| o.family == f).map_or("–".into(), told);
        out.push_str(&format!("| {name} | {} |\n", families(&cell)));
    }
    out
}

fn short(family: Family) -> &'static str {
    match family {
        Family::Nishita1993 => "Nishita",
        Family::Oneil2004 => "O'Neil",
        Family::Schafhitzel2007 => "Schafhitzel",
        Family::Elek2009 => "Elek 2009",
        Family::Algorithm1 => "Algorithm 1",
        Family::Bruneton2017 => "Bruneton",
        Family::Elek2010 => "elek2010",
        Family::Compact => "compact",
    }
}

/// Errors in per cent, and what is worse than an error.
fn told(o: &Outcome) -> String {
    if let Some(reason) = &o.refused {
        return format!("refused: {}", reason.split(':').next_back().unwrap_or(reason).trim());
    }
    let mut out = format!("{} / {}", percent(o.error.median), percent(o.error.p95));
    for (count, what) in [(o.not_finite, "NaN"), (o.negative, "negative")] {
        if count > 0 {
            out.push_str(&format!(", **{what} in {} %**", percent(count as f64 / o.views as f64)));
        }
    }
    if o.is_warned() {
        out.push_str(", warned of");
    }
    out
}

fn percent(v: f64) -> String {
    match 100.0 * v {
        v if !v.is_finite() => "∞".into(),
        v if v < 9.95 => format!("{v:.1}"),
        v => format!("{v:.0}"),
    }
}
