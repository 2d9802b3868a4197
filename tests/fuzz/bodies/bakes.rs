//! What stands in the folder of a bake: pictures, skies for recolouring, and `bake.json`, in front of every reader.

use super::edits::{Base, text};
use super::{file, one_line, refused};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Duration;
use tyndall::internals::bake::recolour::{Source, Wanted, recolour};
use tyndall::internals::bake::{self, Product, provenance};
use tyndall::internals::colour::samples;
use tyndall::internals::commands::{diff, verify};
use tyndall::internals::files::Atlas;
use tyndall::internals::files::exr::{from_exr_bytes, to_exr_bytes};
use tyndall::internals::files::manifest::Manifest;
use tyndall::internals::geometry::Point;
use tyndall::internals::layout::Layout;
use tyndall::internals::layout::compact::CompactLayout;
use tyndall::internals::layout::compact::Sizes;
use tyndall::internals::layout::elek2010::Elek2010Layout;
use tyndall::internals::layout::settings::Settings;
use tyndall::internals::layout::sky::{self, AerosolPhase, Component, Sky};
use tyndall::internals::layout::water::Waters;
use tyndall::internals::layout::water::lookup::{WaterSky, WaterView};
use tyndall::internals::preset::{self, Planet};
use tyndall::internals::spectrum::{ColourSpace, Rgb, StandardObserver};
use tyndall::internals::transport::solve::Orders;

/// A small bake with a water, in memory and on disk.
struct Baked {
    planet: Planet,
    settings: Settings,
    product: Product,
    /// By layout, by table.
    pictures: BTreeMap<String, BTreeMap<String, Atlas>>,
    /// A whole bake, and one whose manifest is that of the input.
    folders: [PathBuf; 2],
    base: [Base; 1],
    _dir: tempfile::TempDir,
}

fn baked() -> &'static Baked {
    static BAKED: OnceLock<Baked> = OnceLock::new();
    BAKED.get_or_init(|| {
        let planet = preset::load("earth-paper", &[]).expect("a shipped preset");
        let size = [3, 4, 3, 2];
        let mut waters = Waters { size: [2, 2, 2], underwater: true, ..Waters::default() };
        waters.list = vec![preset::load_water("clear-ocean", &[]).expect("a shipped water")];
        let settings = Settings {
            layouts: vec![&Elek2010Layout, &CompactLayout],
            elek2010_size: size,
            compact: Sizes { single: size, multiple: size, depth: [3, 4] }.into(),
            wavelengths_nm: vec![450.0, 550.0, 650.0],
            orders: Orders::First(2),
            waters,
            ..Settings::default()
        };
        let product = match std::env::var_os("TYNDALL_FUZZ_BAKE") {
            Some(folder) => read(Path::new(&folder)),
            None => bake::bake(&planet, &settings, &mut |_| {}).expect("a bake"),
        };
        let dir = tempfile::tempdir().expect("a folder");
        let folders = ["whole", "damaged"].map(|name| write(&dir.path().join(name), &product));
        let base = [Base::new(&product.manifest.to_json().expect("a manifest"))];
        Baked { pictures: pictures(&product), planet, settings, product, folders, base, _dir: dir }
    })
}

/// A bake that was made before, by a program without counters of coverage, which is ten times as fast.
pub fn read(folder: &Path) -> Product {
    let manifest = Manifest::read(folder).expect("a bake");
    let tables = manifest.tables.iter().map(|t| t.file.clone());
    let names = tables.chain(manifest.files.iter().map(|f| f.file.clone())).chain(["bake.json".into()]);
    let files = names.map(|name| (name.clone(), fs::read(folder.join(name)).expect("a file"))).collect();
    Product { manifest, files, light_cpu: Duration::ZERO }
}

fn write(folder: &Path, product: &Product) -> PathBuf {
    for (name, bytes) in &product.files {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().expect("inside the bake")).expect("a folder");
        fs::write(path, bytes).expect("a file");
    }
    folder.to_path_buf()
}

fn pictures(product: &Product) -> BTreeMap<String, BTreeMap<String, Atlas>> {
    let mut out: BTreeMap<String, BTreeMap<String, Atlas>> = BTreeMap::new();
    for table in &product.manifest.tables {
        let atlas = from_exr_bytes(file(), bytes_of(product, &table.file)).expect("our own file");
        out.entry(table.layout.clone()).or_default().insert(table.name.clone(), atlas);
    }
    out
}

/// The sky of a layout of a bake in memory.
pub fn opened(product: &Product, layout: &dyn Layout) -> Box<dyn Sky> {
    product.sky(layout.name()).expect("a layout of the bake")
}

fn bytes_of<'a>(product: &'a Product, name: &str) -> &'a [u8] {
    &product.files.iter().find(|f| f.0 == name).expect("a file of the bake").1
}

/// Any bytes as an EXR file: a table that is written and read as it is.
pub fn exr(bytes: &[u8]) {
    match from_exr_bytes(file(), bytes) {
        Err(error) => refused(&error),
        Ok(atlas) => {
            // What is not finite is refused, by name.
            if let Ok(again) = to_exr_bytes(&atlas) {
                assert!(from_exr_bytes(file(), &again).is_ok());
            }
        }
    }
}

/// Any bytes as the skies that `recolour` reads; an input that begins with a control character changes numbers of a
/// real file's, which is compressed.
pub fn skies(bytes: &[u8]) {
    let nm = [450.0, 550.0, 650.0];
    let real = || from_exr_bytes(file(), bytes_of(&baked().product, samples::FILE)).expect("our own file");
    let found = match bytes.split_first() {
        Some((0..9, changes)) => {
            let mut atlas = real();
            for change in changes.chunks_exact(7) {
                let at = usize::from(change[1]) | usize::from(change[2]) << 8;
                let channels = atlas.channels.len();
                if let tyndall::internals::files::Samples::Float(v) =
                    &mut atlas.channels[usize::from(change[0]) % channels].samples
                {
                    let n = v.len();
                    v[at % n] = f32::from_le_bytes([change[3], change[4], change[5], change[6]]);
                }
            }
            match to_exr_bytes(&atlas) {
                Ok(bytes) => samples::from_file(file(), &bytes, &nm),
                Err(_) => return,
            }
        }
        _ => samples::from_file(file(), bytes, &nm),
    };
    match found {
        Err(error) => refused(&error),
        Ok(samples) => {
            let numbers = || samples.iter().flat_map(|s| s.transfers.iter().flatten().chain(&s.mu_s));
            assert!(numbers().all(|v| v.is_finite()));
        }
    }
}

const LAYOUTS: [&str; 2] = ["compact", "elek2010"];

/// Any text as the `bake.json` beside the tables of a real bake: skies and waters that answer.
pub fn manifest(bytes: &[u8]) {
    let baked = baked();
    let Some(text) = text(bytes, &baked.base) else { return };
    let manifest = match Manifest::parse(file(), &text) {
        Err(error) => return refused(&error),
        Ok(manifest) => manifest,
    };
    let empty = BTreeMap::new();
    let of = |layout: &str| baked.pictures.get(layout).unwrap_or(&empty);
    for layout in LAYOUTS {
        match sky::of_pictures(file(), &manifest, layout, of(layout)) {
            Err(error) => refused(&error),
            Ok(sky) => ask(sky.as_ref()),
        }
    }
    for water in &manifest.waters {
        match WaterSky::new(file(), &manifest, &water.name, of("water")) {
            Err(error) => refused(&error),
            Ok(sky) => {
                for (depth, mu, mu_s) in [(0.0, 0.5, 0.2), (3.0, 1.0, -0.1), (1e3, 0.01, 1.0)] {
                    let view = WaterView { depth, mu, mu_s };
                    sky.rgb(&sky.leaving(&view, Component::Total));
                    sky.within(&view, depth / 2.0, Component::Total);
                    sky.mirrored(mu);
                }
            }
        }
    }
}

/// Asks a sky for everything that can be asked.
pub fn ask(sky: &dyn Sky) {
    for (altitude, mu, mu_s) in [(0.0, 0.5, 0.2), (1e4, -0.3, -0.1), (1e9, -1.0, 1.0)] {
        let point = Point { altitude, mu, mu_s, azimuth_deg: 30.0 };
        sky.radiance(&point, Component::Total, AerosolPhase::Preset);
        sky.rgb(&point, Component::Ground);
        sky.sunlight(altitude, mu_s);
        sky.outside(&point);
    }
}

/// The same in a folder, in front of `verify`, `bake --check` and `diff`.
pub fn folder(bytes: &[u8]) {
    let baked = baked();
    let Some(text) = text(bytes, &baked.base) else { return };
    let [whole, damaged] = &baked.folders;
    fs::write(damaged.join("bake.json"), &text).expect("a manifest");
    match verify::differences(damaged, |_| None) {
        Err(error) => return refused(&error),
        Ok(found) => found.iter().for_each(|d| {
            one_line(&format!(
                "{}: {}",
                tyndall::internals::error::Line(&d.place),
                tyndall::internals::error::Line(&d.what)
            ))
        }),
    }
    let manifest = Manifest::read(damaged).expect("what verify has read");
    verify::lost_or_changed(damaged, &manifest);
    let asked = provenance::asked(&baked.planet, &baked.settings);
    for change in provenance::differences(&provenance::recorded(&manifest), &asked) {
        one_line(&tyndall::internals::error::Line(change).to_string());
    }
    if let Err(error) = diff::compare(whole, damaged, 2) {
        refused(&error);
    }
}

/// The same in front of `recolour`.
pub fn recoloured(bytes: &[u8]) {
    let baked = baked();
    let Some(text) = text(bytes, &baked.base) else { return };
    let Ok(manifest) = Manifest::parse(file(), &text) else { return };
    let source = Source {
        folder: file(),
        manifest: &manifest,
        tables: &baked.pictures["compact"],
        skies: bytes_of(&baked.product, samples::FILE),
    };
    let wanted = Wanted {
        star_k: Some(4000.0),
        beholder: StandardObserver::default(),
        rgb: Rgb { space: ColourSpace::Srgb, white: None },
    };
    match recolour(&source, &wanted) {
        Err(error) => refused(&error),
        Ok((manifest, _)) => assert!(manifest.to_json().is_ok()),
    }
}
