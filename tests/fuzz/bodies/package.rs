//! The `bake.json` beside tables of the layout three-atmosphere, which are as large as that package's shaders want them.

use super::edits::{Base, text};
use super::{bakes, file, refused};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::OnceLock;
use tyndall::internals::bake::{self, Product};
use tyndall::internals::files::Atlas;
use tyndall::internals::files::exr::from_exr_bytes;
use tyndall::internals::files::manifest::Manifest;
use tyndall::internals::layout::settings::Settings;
use tyndall::internals::layout::sky;
use tyndall::internals::layout::three_atmosphere::{LAYOUT, ThreeAtmosphereLayout};
use tyndall::internals::preset;
use tyndall::internals::transport::solve::Orders;

struct Baked {
    tables: BTreeMap<String, Atlas>,
    base: [Base; 1],
}

fn baked() -> &'static Baked {
    static BAKED: OnceLock<Baked> = OnceLock::new();
    BAKED.get_or_init(|| {
        let product = match std::env::var_os("TYNDALL_FUZZ_PACKAGE") {
            Some(folder) => bakes::read(Path::new(&folder)),
            None => made(),
        };
        let atlas = |name: &str| {
            let bytes = &product.files.iter().find(|f| f.0 == name).expect("a file of the bake").1;
            from_exr_bytes(file(), bytes).expect("our own file")
        };
        let tables = product.manifest.tables.iter().map(|t| (t.name.clone(), atlas(&t.file))).collect();
        Baked { tables, base: [Base::new(&product.manifest.to_json().expect("a manifest"))] }
    })
}

fn made() -> Product {
    let planet = preset::load("earth-paper", &[]).expect("a shipped preset");
    let settings = Settings {
        layouts: vec![&ThreeAtmosphereLayout],
        wavelengths_nm: vec![450.0, 550.0, 650.0],
        orders: Orders::First(1),
        ..Settings::default()
    };
    bake::bake(&planet, &settings, &mut |_| {}).expect("a bake")
}

/// Any text as that manifest: a sky that answers.
pub fn tables(bytes: &[u8]) {
    let baked = baked();
    let Some(text) = text(bytes, &baked.base) else { return };
    let Ok(manifest) = Manifest::parse(file(), &text) else { return };
    match sky::of_pictures(file(), &manifest, LAYOUT, &baked.tables) {
        Err(error) => refused(&error),
        Ok(sky) => bakes::ask(sky.as_ref()),
    }
}
