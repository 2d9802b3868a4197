//! Any text as the `bake.json` beside the tables of a real bake: refused in one line, or a sky that answers.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::OnceLock;
use tyndall::bake::bake;
use tyndall::bake::compact::Sizes;
use tyndall::bake::settings::{Layout, Settings};
use tyndall::export::Atlas;
use tyndall::export::exr::from_exr_bytes;
use tyndall::export::manifest::Manifest;
use tyndall::points::Point;
use tyndall::preset;
use tyndall::sky::{AerosolPhase, Component, Sky};

const LAYOUTS: [&str; 2] = ["compact", "elek2010"];

/// The pictures of a small bake, by layout.
fn pictures() -> &'static Vec<BTreeMap<String, Atlas>> {
    static PICTURES: OnceLock<Vec<BTreeMap<String, Atlas>>> = OnceLock::new();
    PICTURES.get_or_init(|| {
        let planet = preset::load("earth-paper", &[]).expect("a shipped preset");
        let size = [4, 6, 5, 3];
        let settings = Settings {
            layouts: vec![Layout::Elek2010, Layout::Compact],
            elek2010_size: size,
            compact_sizes: Sizes { single: size, multiple: size },
            wavelengths_nm: vec![450.0, 550.0, 650.0],
            ..Settings::default()
        };
        let product = bake(&planet, &settings, &mut |_| {}).expect("a bake");
        let of = |layout: &&str| {
            let tables = product.manifest.tables.iter().filter(|t| t.layout == **layout);
            let picture = |t: &tyndall::export::manifest::Table| {
                let bytes = &product.files.iter().find(|f| f.0 == t.file).expect("a file a table").1;
                (t.name.clone(), from_exr_bytes(Path::new("fuzz.exr"), bytes).expect("our own file"))
            };
            tables.map(picture).collect()
        };
        LAYOUTS.iter().map(of).collect()
    })
}

fuzz_target!(|text: &str| {
    let path = Path::new("bake.json");
    let manifest = match Manifest::parse(path, text) {
        Err(error) => return assert!(!error.to_string().contains('\n'), "{error}"),
        Ok(manifest) => manifest,
    };
    for (layout, pictures) in LAYOUTS.iter().zip(pictures()) {
        match Sky::new(path, &manifest, layout, pictures) {
            Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
            Ok(sky) => {
                for (altitude, mu, mu_s) in [(0.0, 0.5, 0.2), (1e4, -0.3, -0.1), (1e9, -1.0, 1.0)] {
                    let point = Point { altitude, mu, mu_s, azimuth_deg: 30.0 };
                    sky.radiance(&point, Component::Total, AerosolPhase::Preset);
                }
            }
        }
    }
});
