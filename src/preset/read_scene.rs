//! A scene file → [`Scene`].

use super::bounds::{Bounds, NOT_NEGATIVE, POSITIVE};
use super::raw::{MOST_METRES, Raw};
use super::read_planet::{SCHEMA_KEY, name, schema_key};
use super::scene::{Budget, Metric, Scene, SceneWater, Tolerance};
use crate::error::Result;

const DEGREES: Bounds = Bounds::within(-90.0, 90.0, "between -90 and 90");
const AZIMUTH: Bounds = Bounds::within(0.0, 180.0, "between 0 and 180");
const SHARE_PERCENT: Bounds = Bounds::within(50.0, 99.9, "between 50 and 99.9");
// Below the least, a share of it would be none.
const PERCENT: Bounds = Bounds::within(1e-9, 1000.0, "between 1e-9 and 1000");
const DELTA_E: Bounds = Bounds::within(1e-9, 100.0, "between 1e-9 and 100");

/// Key that tells a scene from other presets.
pub(super) const MARK: &str = "tolerance";

/// The whole scene.
pub(super) fn scene(raw: &Raw) -> Result<Scene> {
    raw.only(&[
        SCHEMA_KEY,
        "name",
        "description",
        "planet",
        "observer",
        "sun",
        "view",
        "waters",
        MARK,
        "budget",
    ])?;
    schema_key(raw)?;
    let sun = raw.need("sun")?;
    sun.only(&["elevation_deg", "twilight_matters"])?;
    let suns = range(&sun.need("elevation_deg")?, DEGREES)?;
    let twilight_matters = flag(&sun, "twilight_matters")?;
    if !twilight_matters && suns[1] <= 0.0 {
        let key = sun.need("twilight_matters")?;
        return Err(
            key.refuse("no sun of this scene is above the horizontal: then twilight is all that matters")
        );
    }
    let view = raw.get("view")?;
    let of_view = |key: &str, bounds: Bounds, without: [f64; 2]| match &view {
        Some(view) => view.get(key)?.map_or(Ok(without), |ends| range(&ends, bounds)),
        None => Ok(without),
    };
    if let Some(view) = &view {
        view.only(&["elevation_deg", "azimuth_deg", "azimuth_matters"])?;
    }
    Ok(Scene {
        name: name(raw)?,
        description: raw.need("description")?.text()?.to_string(),
        planet: raw.need("planet")?.text()?.to_string(),
        altitudes: altitudes(&raw.need("observer")?)?,
        suns,
        twilight_matters,
        elevations: of_view("elevation_deg", DEGREES, [-90.0, 90.0])?,
        azimuths: of_view("azimuth_deg", AZIMUTH, [0.0, 180.0])?,
        azimuth_matters: view.as_ref().map_or(Ok(true), |view| flag(view, "azimuth_matters"))?,
        waters: raw.get("waters")?.map_or(Ok(Vec::new()), |list| waters(&list))?,
        tolerance: tolerance(&raw.need(MARK)?)?,
        budget: raw.get("budget")?.map_or(Ok(Budget::default()), |budget| self::budget(&budget))?,
    })
}

/// A number, or a list of the lowest and the highest.
fn range(raw: &Raw, bounds: Bounds) -> Result<[f64; 2]> {
    if raw.is_number() {
        return Ok([raw.number_in(bounds)?; 2]);
    }
    let ends = raw.numbers_in(bounds)?;
    match ends[..] {
        [low, high] if low <= high => Ok([low, high]),
        _ => Err(raw.refuse("must be a number, or [lowest, highest]")),
    }
}

/// True unless it says otherwise.
fn flag(raw: &Raw, key: &str) -> Result<bool> {
    raw.get(key)?.map_or(Ok(true), |value| value.flag())
}

fn altitudes(raw: &Raw) -> Result<[f64; 2]> {
    raw.only(&["altitude_m", "altitude_km"])?;
    let (unit, ends) = raw.one_of(&["altitude_km", "altitude_m"])?;
    let metres = range(&ends, NOT_NEGATIVE)?.map(|a| a * [1e3, 1.0][unit]);
    if metres[1] > MOST_METRES {
        return Err(ends.refuse("must be less than 1e13 m"));
    }
    Ok(metres)
}

fn waters(raw: &Raw) -> Result<Vec<SceneWater>> {
    let one = |item: &Raw| {
        item.only(&["water", "depth_m"])?;
        let water = item.need("water")?.text()?.to_string();
        Ok(SceneWater { water, depths: range(&item.need("depth_m")?, NOT_NEGATIVE)? })
    };
    raw.items()?.iter().map(one).collect()
}

fn tolerance(raw: &Raw) -> Result<Tolerance> {
    raw.only(&["relative_percent", "delta_e_2000", "share_percent"])?;
    let (which, value) = raw.one_of(&["relative_percent", "delta_e_2000"])?;
    let (metric, most) = match which {
        0 => (Metric::Relative, value.number_in(PERCENT)? / 100.0),
        _ => (Metric::DeltaE, value.number_in(DELTA_E)?),
    };
    let share = raw.need("share_percent")?.number_in(SHARE_PERCENT)? / 100.0;
    Ok(Tolerance { metric, most, share })
}

fn budget(raw: &Raw) -> Result<Budget> {
    raw.only(&["megabytes", "bake_cpu_s", "fetches"])?;
    let of = |key: &str, factor: f64| -> Result<Option<f64>> {
        raw.get(key)?.map(|value| Ok(value.number_in(POSITIVE)? * factor)).transpose()
    };
    Ok(Budget { bytes: of("megabytes", 1e6)?, bake_s: of("bake_cpu_s", 1.0)?, fetches: of("fetches", 1.0)? })
}
