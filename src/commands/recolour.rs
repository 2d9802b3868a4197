//! `tyndall recolour`: a bake under another star, for another observer or in another colour space, without a solve.

use super::bake::space;
use super::text::print;
use crate::bake::recolour::{Source, Wanted, recolour};
use crate::colour::samples as skies;
use crate::error::{Error, Result};
use crate::files::bounded_read;
use crate::files::manifest::{MANIFEST, Manifest};
use crate::files::staging::Staging;
use crate::layout::compact;
use crate::layout::sky::pictures;
use crate::spectrum::{Adaptation, ColourSpace, Rgb, StandardObserver, White};
use std::path::PathBuf;

/// A bake under another star, for another observer or in another colour space, without solving anything
#[derive(clap::Args, Debug)]
#[command(
    before_help = "Example: tyndall recolour out/earth --star 4000 --out out/recoloured",
    after_help = "The layout compact stays as it is, bit for bit: it holds radiance over the star's irradiance at four \
                  wavelengths. Its matrices are fitted anew on the skies that the bake keeps in compact/skies.exr, at \
                  all wavelengths of the bake, as `tyndall bake` would, but for the choice of the four wavelengths, \
                  which stays. The layouts and waters whose tables hold colours (elek2010, water) are left out: bake \
                  them."
)]
pub struct Args {
    /// Folder of a bake with the layout compact
    pub bake: PathBuf,
    /// Folder that gets a folder with the planet's name
    #[arg(long, value_name = "FOLDER")]
    pub out: PathBuf,
    /// Temperature of the new star in K: a black body of the old one's size and distance [default: the old star]
    #[arg(long, value_name = "KELVIN", value_parser = kelvin)]
    pub star: Option<f64>,
    /// Whose colours are meant
    #[arg(long, value_enum, default_value = "cie1931-2deg")]
    pub observer: StandardObserver,
    /// Linear RGB space [default: that of the bake]
    #[arg(long, value_parser = space)]
    pub colour_space: Option<ColourSpace>,
    /// What becomes the white of the colour space, as for `tyndall bake` [default: nothing is adapted]
    #[arg(long, value_name = "WHITE", value_parser = White::parse)]
    pub white: Option<White>,
    /// How --white is adapted
    #[arg(long, value_enum, default_value = "bradford", requires = "white")]
    pub adaptation: Adaptation,
}

fn kelvin(text: &str) -> Result<f64> {
    match text.parse::<f64>() {
        Ok(k) if (100.0..=1e6).contains(&k) => Ok(k),
        _ => Err("expected a temperature from 100 to 1000000 K".into()),
    }
}

/// Writes the recoloured bake and says where and how well its colours fit.
///
/// # Errors
/// `Argument` where it would replace its source or there is nothing to recolour; `File` for a damaged source.
pub fn run(args: &Args) -> Result<()> {
    let manifest = Manifest::read(&args.bake)?;
    let folder =
        if args.bake.is_dir() { args.bake.clone() } else { args.bake.parent().unwrap_or(&args.bake).into() };
    let wanted = wanted(args, &manifest)?;
    let skies = checked(&folder, &manifest, skies::FILE)?;
    let tables = pictures(&folder, &manifest, compact::LAYOUT)?;
    let source = Source { folder: &folder, manifest: &manifest, tables: &tables, skies: &skies };
    let (new, made) = recolour(&source, &wanted)?;
    let target = args.out.join(&new.preset.name);
    let same = |a: &std::path::Path| std::fs::canonicalize(a).ok();
    if same(&target).is_some() && same(&target) == same(&folder) {
        let reason = format!("--out {}: the bake would replace itself", args.out.display());
        return Err(Error::Argument(reason));
    }
    let staging = Staging::begin(&target)?;
    let tables = new.tables.iter().flat_map(|t| t.files().map(|f| f.0));
    let others = new.files.iter().map(|f| &f.file).filter(|file| made.iter().all(|m| m.0 != **file));
    for file in tables.chain(others) {
        staging.write(file, &checked(&folder, &manifest, file)?)?;
    }
    for (file, bytes) in &made {
        staging.write(file, bytes)?;
    }
    staging.write(MANIFEST, new.to_json()?.as_bytes())?;
    staging.commit()?;
    let error = &new.quality["colour"]["four_wavelengths_delta_e_2000"];
    let felt = match error["median"].as_f64() {
        Some(median) => format!("median {median}, 95 % below {}", error["p95"]),
        None => "no sky to tell it by".to_string(),
    };
    print(&format!("{}: ΔE2000 of the four wavelengths: {felt}\n", target.display()))
}

fn wanted(args: &Args, manifest: &Manifest) -> Result<Wanted> {
    if !manifest.tables.iter().any(|t| t.layout == compact::LAYOUT) {
        return Err(Error::Argument(format!(
            "{}: no layout compact in it, and the others hold colours: bake it anew",
            args.bake.display()
        )));
    }
    let held = |reason: Error| Error::file(&args.bake, format!("bake.json: colour.space: {reason}"));
    let space = match args.colour_space {
        Some(space) => space,
        None => space(&manifest.colour.space).map_err(held)?,
    };
    let white = args.white.map(|white| (white, args.adaptation));
    Ok(Wanted { star_k: args.star, beholder: args.observer, rgb: Rgb { space, white } })
}

/// The bytes of a file of the bake, which are those that were baked.
fn checked(folder: &std::path::Path, manifest: &Manifest, file: &str) -> Result<Vec<u8>> {
    let path = folder.join(file);
    let tables = manifest.tables.iter().flat_map(|t| t.files());
    let others = manifest.files.iter().map(|f| (&f.file, &f.blake3));
    let Some((_, hash)) = tables.chain(others).find(|f| f.0 == file) else {
        return Err(Error::file(&path, "not in this bake, which is of an older tyndall: bake it anew"));
    };
    let bytes = bounded_read::part(folder, file).map_err(|e| Error::reading(&path, e))?;
    if blake3::hash(&bytes).to_hex().as_str() != hash {
        return Err(Error::file(&path, "not the file that was baked (bake.json has another BLAKE3)"));
    }
    Ok(bytes)
}
