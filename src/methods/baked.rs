//! Tables of a bake, read as an engine reads them: this project's layouts, and others' tables that its baker fills.

use super::{Family, Method, Prepared, PreparedSky};
use crate::bake::{IN_MEMORY, Product, SolutionCache, bake_in};
use crate::error::{Error, Result};
use crate::files::manifest::{Encoding, EncodingKind, Manifest, Table};
use crate::files::{Atlas, Samples};
use crate::geometry::Point;
use crate::geometry::view::View;
use crate::layout::Layout;
use crate::layout::settings::Settings;
use crate::layout::sky::{self, Component, Sky};
use crate::layout::three_atmosphere::lookup::ThreeAtmosphere;
use crate::machine::cpu_time::cpu_time;
use crate::preset::Planet;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// A layout with settings.
pub struct BakedTables {
    pub family: Family,
    pub setting: String,
    pub layout: &'static dyn Layout,
    pub settings: Settings,
    pub storage: Storage,
    /// Shared with others that may want the same light.
    pub lights: Arc<SolutionCache>,
}

/// How the samples of tables over four axes are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// As the baker does.
    AsBaked,
    /// Values, not their logarithms, in halves.
    LinearHalves,
    /// 256 even steps of what is stored.
    EightBits,
    /// Light scattered once by aerosols is not stored but for its red (Bruneton's RGB and A).
    RedOfMie,
}

/// Stages of a bake that no sky waits for.
const APART: [&str; 3] = ["encode", "report", "picture"];
/// How the names of stages begin whose light other methods may share: each pays for it as if it were alone.
const SHARED: &str = "solve";

impl Method for BakedTables {
    fn family(&self) -> Family {
        self.family
    }

    fn setting(&self) -> String {
        self.setting.clone()
    }

    fn prepare(&self, planet: &Planet) -> Result<Prepared> {
        let mut watch = Watch::default();
        let settings = Settings { layouts: vec![self.layout], ..self.settings.clone() };
        let product = bake_in(&self.lights, planet, &settings, &mut |stage| watch.stage(stage))?;
        // To the literal algorithm the solver's light serves for colours alone.
        let solver = if self.family == Family::Algorithm1 { Duration::ZERO } else { product.light_cpu };
        let cpu = watch.own() + solver;
        let warnings = product.manifest.warnings.clone();
        let tables = Tables::open(product, self.layout.name(), self.storage)?;
        Ok(Prepared { sky: Box::new(tables), cpu, warnings })
    }
}

/// Processor time of the stages that belong to the method, but for its light.
#[derive(Default)]
struct Watch {
    current: Option<(bool, Duration)>,
    own: Duration,
}

impl Watch {
    fn stage(&mut self, name: &str) {
        self.close();
        self.current = Some((!APART.contains(&name) && !name.starts_with(SHARED), cpu_time()));
    }

    fn close(&mut self) {
        if let Some((true, start)) = self.current.take() {
            self.own += cpu_time().saturating_sub(start);
        }
    }

    fn own(mut self) -> Duration {
        self.close();
        self.own
    }
}

struct Tables {
    sky: Box<dyn Sky>,
    bytes: usize,
    sky_fetches: usize,
    ground_fetches: usize,
    /// Ground and top, m.
    radii: [f64; 2],
}

impl Tables {
    fn open(product: Product, layout: &str, storage: Storage) -> Result<Self> {
        let mut manifest = product.manifest.clone();
        let mut pictures = product.pictures(layout)?;
        for table in manifest.tables.iter_mut().filter(|t| t.layout == layout) {
            let atlas = pictures.get_mut(&table.name).expect("a picture for each table");
            store(table, atlas, storage);
        }
        let bake = Path::new(IN_MEMORY);
        let sky: Box<dyn Sky> = match storage {
            Storage::RedOfMie => {
                let ratio = mie_over_rayleigh(&product)?;
                Box::new(ThreeAtmosphere::with_red_alone(bake, &manifest, &pictures, ratio)?)
            }
            _ => sky::of_pictures(bake, &manifest, layout, &pictures)?,
        };
        let (sky_fetches, ground_fetches) = fetches(&manifest, layout, storage);
        let constant = |name: &str| manifest.constants[name][0];
        Ok(Tables {
            sky,
            bytes: bytes(&manifest, layout, storage),
            sky_fetches,
            ground_fetches,
            radii: [constant("ground_radius_m"), constant("top_radius_m")],
        })
    }
}

/// Stores the tables over four axes in another way.
fn store(table: &mut Table, atlas: &mut Atlas, storage: Storage) {
    if table.axes.len() < 4 {
        return;
    }
    match storage {
        Storage::AsBaked | Storage::RedOfMie => {}
        Storage::EightBits => {
            for channel in &mut atlas.channels {
                let [low, high] = channel.samples.range();
                let step = (high - low).max(1e-30) / 255.0;
                let values = (0..channel.samples.len()).map(|n| f64::from(channel.samples.get(n)));
                let rounded = values.map(|v| low + step * libm::round((v - low) / step));
                channel.samples = Samples::float(rounded.collect::<Vec<_>>());
            }
        }
        Storage::LinearHalves if table.encoding.kind == EncodingKind::Log => {
            let log = table.encoding.clone();
            let largest = atlas.channels.iter().map(|c| log.decode(c.samples.range()[1])).fold(0.0, f64::max);
            let scale =
                if largest > 0.0 { libm::exp2(libm::floor(libm::log2(32768.0 / largest))) } else { 1.0 };
            for channel in &mut atlas.channels {
                let values = (0..channel.samples.len()).map(|n| f64::from(channel.samples.get(n)));
                channel.samples = Samples::half(values.map(|v| scale * log.decode(v)).collect::<Vec<_>>());
            }
            table.encoding = Encoding::linear(1.0 / scale);
        }
        Storage::LinearHalves => {}
    }
}

/// Tables that look-ups read.
fn is_read(table: &Table, layout: &str, storage: Storage) -> bool {
    table.layout == layout
        && table.name != "higher_order_scattering"
        && !(storage == Storage::RedOfMie && table.name == "single_mie_scattering")
}

fn bytes(manifest: &Manifest, layout: &str, storage: Storage) -> usize {
    let of = |t: &Table| {
        let sample = if storage == Storage::EightBits && t.axes.len() == 4 { 1 } else { 2 };
        t.shape.iter().product::<usize>() * t.channels.len() * sample
    };
    manifest.tables.iter().filter(|t| is_read(t, layout, storage)).map(of).sum()
}

/// Reads of a look-up in the sky, and those that the ground adds: sunlight there, light of the sky, and, where the
/// depth of the view is not read anyway, that.
fn fetches(manifest: &Manifest, layout: &str, storage: Storage) -> (usize, usize) {
    let read = || manifest.tables.iter().filter(|t| is_read(t, layout, storage));
    let volumes = read().filter(|t| t.axes.len() == 4).count();
    let phases = read().filter(|t| t.name.starts_with("single_")).count();
    let depths = read().filter(|t| matches!(t.name.as_str(), "transmittance" | "scatterers")).count();
    match layout {
        "compact" => (2 * volumes + phases + depths, 2),
        "elek2010" => (2 * volumes + 2, 3),
        _ => (2 * volumes, 4),
    }
}

/// Scattering of aerosols over that of gas at red, green and blue, from what the layout three-atmosphere tells shaders.
fn mie_over_rayleigh(product: &Product) -> Result<[f64; 3]> {
    let refuse = |reason: String| Error::Argument(format!("parameters.json: {reason}"));
    let file = product.files.iter().find(|(f, _)| f.ends_with("parameters.json"));
    let (_, text) = file.ok_or_else(|| refuse("missing".into()))?;
    let json: serde_json::Value = serde_json::from_slice(text).map_err(|e| refuse(e.to_string()))?;
    let read = |key: &str| ["x", "y", "z"].map(|axis| json[key][axis].as_f64().unwrap_or(0.0));
    let (mie, rayleigh) = (read("mieScattering"), read("rayleighScattering"));
    Ok(std::array::from_fn(|c| mie[c] / rayleigh[c]))
}

impl PreparedSky for Tables {
    fn radiance(&self, view: &Point) -> [f64; 3] {
        self.sky.rgb(view, Component::Total)
    }

    fn bytes(&self) -> usize {
        self.bytes
    }

    fn fetches(&self, view: &Point) -> usize {
        match View::enter(view, self.radii[0], self.radii[1]) {
            Some(v) => self.sky_fetches + if v.hits_ground { self.ground_fetches } else { 0 },
            None => 0,
        }
    }
}
