//! `tyndall verify`: do the files of a bake match their manifest, its preset, and this tool?

use super::text;
use crate::bake::versions;
use crate::error::{Error, Line, Result};
use crate::files::atlas::{Atlas, Samples};
use crate::files::bounded_read;
use crate::files::exr::from_exr_bytes;
use crate::files::foreign::foreign;
use crate::files::manifest::{MANIFEST, Manifest, Precision, Table, hash_of};
use crate::preset;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// Arguments of `tyndall verify`.
#[derive(Debug, clap::Args)]
#[command(
    about = "Check that the files of a bake match their manifest, its preset and this tool",
    before_help = "Example: tyndall verify out/earth",
    after_help = "Exit code 0: all holds; 1: something differs, a line for each on stdout; 2: no bake to check.\n\
                  Files that are not of the bake, such as those that engines write beside assets, are listed as foreign; \
                  a bake that takes the place of this one keeps them."
)]
pub struct Args {
    /// The folder of a bake (the one with bake.json in it)
    pub bake: PathBuf,
    /// Answer in JSON: {"bake", "holds", "differences": [{"place", "what"}], "foreign": [file]}
    #[arg(long)]
    pub json: bool,
}

/// One thing that does not hold.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Difference {
    /// A file inside the bake, or a key of its manifest.
    pub place: String,
    pub what: String,
}

/// Prints what differs, on stdout.
///
/// # Errors
/// `Check` if anything differs, `File` if there is no bake to check.
pub fn run(args: &Args) -> Result<()> {
    let differences = differences(&args.bake, shipped_hash)?;
    let foreign = foreign(folder_of(&args.bake));
    text::print(&told(args, &differences, &foreign))?;
    match differences.len() {
        0 => Ok(()),
        1 => Err(Error::Check(format!("{}: 1 difference", args.bake.display()))),
        n => Err(Error::Check(format!("{}: {n} differences", args.bake.display()))),
    }
}

/// The hash of the preset of this name inside the binary, if there is one.
fn shipped_hash(name: &str) -> Option<String> {
    preset::is_shipped(name).then(|| preset::load(name, &[]).ok().map(|planet| planet.hash()))?
}

/// What differs and which files are not the bake's own, which is no difference.
fn told(args: &Args, differences: &[Difference], foreign: &[PathBuf]) -> String {
    let bake = args.bake.display();
    if args.json {
        let holds = differences.is_empty();
        let foreign: Vec<String> = foreign.iter().map(|file| file.to_string_lossy().into_owned()).collect();
        let answer = serde_json::json!({
            "bake": bake.to_string(), "holds": holds, "differences": differences, "foreign": foreign
        });
        return format!("{answer:#}\n");
    }
    let line =
        |place: &dyn Display, what: &str| format!("{}: {}: {}\n", Line(&bake), Line(place), Line(what));
    let of_others = foreign.iter().map(|file| line(&file.display(), "foreign: not of this bake, and kept"));
    let told: String = differences.iter().map(|d| line(&d.place, &d.what)).chain(of_others).collect();
    if differences.is_empty() {
        return format!("{told}{bake}: every file matches its manifest\n");
    }
    told
}

fn folder_of(bake: &Path) -> &Path {
    let parent = || bake.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if bake.is_dir() { bake } else { parent() }
}

/// What differs in the bake at `bake`. `shipped` gives the hash of the preset of a name that this tool ships; it
/// counts only for a bake of a shipped preset as it was, not for one changed by --set or read from a file, whose
/// name may be the same by intent.
pub fn differences(bake: &Path, shipped: impl Fn(&str) -> Option<String>) -> Result<Vec<Difference>> {
    let manifest = Manifest::read(bake)?;
    let folder = folder_of(bake);
    let mut found = about_the_manifest(&manifest, shipped);
    for table in &manifest.tables {
        let whats = check_file(folder, &table.file, &table.blake3, |bytes| check_table(table, bytes));
        found.extend(whats.into_iter().map(|what| difference(&table.file, what)));
        for (file, hash) in table.files().skip(1) {
            let whats = check_file(folder, file, hash, |_| Vec::new());
            found.extend(whats.into_iter().map(|what| difference(file, what)));
        }
    }
    for other in &manifest.files {
        let whats = check_file(folder, &other.file, &other.blake3, |_| Vec::new());
        found.extend(whats.into_iter().map(|what| difference(&other.file, what)));
    }
    Ok(found)
}

/// Files of the bake that are missing or whose bytes are not those of the manifest; what is in them is not looked at.
pub fn lost_or_changed(folder: &Path, manifest: &Manifest) -> Vec<Difference> {
    let tables = manifest.tables.iter().flat_map(|t| t.files());
    let others = manifest.files.iter().map(|f| (&f.file, &f.blake3));
    let check = |(file, hash): (&String, &String)| {
        let whats = check_file(folder, file, hash, |_| Vec::new());
        whats.into_iter().map(|what| difference(file, what)).collect::<Vec<_>>()
    };
    tables.chain(others).flat_map(check).collect()
}

fn difference(place: &str, what: impl Into<String>) -> Difference {
    Difference { place: place.to_string(), what: what.into() }
}

fn about_the_manifest(manifest: &Manifest, shipped: impl Fn(&str) -> Option<String>) -> Vec<Difference> {
    let mut found = Vec::new();
    if manifest.manifest_blake3.is_empty() {
        found.push(difference(
            MANIFEST,
            "has no manifest_blake3: nothing tells whether a value in it was changed",
        ));
    } else if !manifest.seal_holds() {
        found.push(difference(MANIFEST, "a value in it was changed since it was baked (another BLAKE3)"));
    }
    let preset = &manifest.preset;
    if hash_of(&preset.resolved) != preset.hash {
        found.push(difference("preset.hash", "is not that of the resolved preset beside it"));
    }
    for (k, water) in manifest.waters.iter().enumerate() {
        if hash_of(&water.resolved) != water.hash {
            found.push(difference(
                &format!("waters[{k}].hash"),
                "is not that of the resolved water beside it",
            ));
        }
    }
    let unchanged = manifest.settings["shipped_preset"] == true;
    if unchanged && shipped(&preset.name).is_some_and(|hash| hash != preset.hash) {
        let what = format!("the preset {:?} that this tool ships has changed since", preset.name);
        found.push(difference("preset", what));
    }
    let this = env!("CARGO_PKG_VERSION");
    if manifest.tool.version != this {
        let what = format!("baked by {} {}, this is {this}", manifest.tool.name, manifest.tool.version);
        found.push(difference("tool.version", what));
    }
    found.extend(about_algorithms(&manifest.tool.algorithms));
    found
}

/// Algorithms that would write other bytes today.
fn about_algorithms(recorded: &BTreeMap<String, u32>) -> Vec<Difference> {
    if recorded.is_empty() {
        let what =
            "are not recorded: the bake is of an earlier tool and may hold other bytes than this one writes";
        return vec![difference("tool.algorithms", what)];
    }
    let current = versions::all();
    let changed = recorded.iter().filter(|(name, version)| current.get(*name) != Some(*version));
    let told = |(name, version): (&String, &u32)| {
        let now = current.get(name).map_or("has none".into(), |now| format!("has version {now}"));
        difference(&format!("tool.algorithms.{name}"), format!("baked by version {version}, this tool {now}"))
    };
    changed.map(told).collect()
}

/// A file's presence and hash, then what `content` finds in it.
fn check_file(folder: &Path, file: &str, hash: &str, content: impl Fn(&[u8]) -> Vec<String>) -> Vec<String> {
    if !bounded_read::is_inside(file) {
        return vec!["the manifest points outside the bake".into()];
    }
    match bounded_read::part(folder, file) {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => vec!["is missing".into()],
        Err(e) => vec![format!("cannot be read: {e}")],
        Ok(bytes) => {
            let same = blake3::hash(&bytes).to_hex().as_str() == hash;
            let mut whats = content(&bytes);
            if !same {
                whats.insert(0, "its bytes are not those that were baked (another BLAKE3)".into());
            }
            whats
        }
    }
}

/// Whether an EXR file holds the table that the manifest describes.
fn check_table(table: &Table, bytes: &[u8]) -> Vec<String> {
    if Path::new(&table.file).extension().is_none_or(|e| e != "exr") {
        return Vec::new();
    }
    let atlas = match from_exr_bytes(Path::new(&table.file), bytes) {
        Ok(atlas) => atlas,
        Err(Error::File { reason, .. }) => return vec![reason],
        Err(other) => return vec![other.to_string()],
    };
    [check_shape(table, &atlas), check_channels(table, &atlas)].concat()
}

fn check_shape(table: &Table, atlas: &Atlas) -> Vec<String> {
    let mut whats = Vec::new();
    let p = &table.packing;
    let told = [p.slice_width, p.slice_height, p.slices, p.columns, p.rows];
    let held = [atlas.width, atlas.height, atlas.slices, atlas.columns, atlas.rows()];
    if told != held {
        whats.push(format!("slice width, height, slices, columns, rows are {held:?}, not {told:?}"));
    }
    if texels(&table.shape) != texels(&held[..3]) {
        whats.push(format!("shape {:?} is not that of {:?} texels", table.shape, &held[..3]));
    }
    let axes: Vec<usize> = table.axes.iter().map(|axis| axis.size).collect();
    if axes != table.shape {
        whats.push(format!("axes of sizes {axes:?} do not make the shape {:?}", table.shape));
    }
    whats
}

fn texels(sizes: &[usize]) -> Option<usize> {
    sizes.iter().try_fold(1usize, |n, &size| n.checked_mul(size))
}

fn check_channels(table: &Table, atlas: &Atlas) -> Vec<String> {
    let mut whats = Vec::new();
    let told: BTreeSet<&str> = table.channels.iter().map(|c| c.name.as_str()).collect();
    let held: BTreeSet<&str> = atlas.channels.iter().map(|c| c.name.as_str()).collect();
    if told != held {
        whats.push(format!("its channels are {held:?}, not {told:?}"));
    }
    for info in &table.channels {
        let Some(channel) = atlas.channel(&info.name) else { continue };
        let precision = match channel.samples {
            Samples::Half(_) => Precision::Half,
            Samples::Float(_) => Precision::Float,
        };
        if precision != info.sample {
            whats.push(format!("channel {:?} is {precision:?}, not {:?}", info.name, info.sample));
        }
        let range = channel.samples.range();
        if range != info.range {
            whats.push(format!("channel {:?} ranges over {range:?}, not {:?}", info.name, info.range));
        }
        if let Some(texel) = channel.samples.first_not_finite() {
            whats.push(format!("channel {:?}: not a finite number at texel {texel}", info.name));
        }
    }
    whats
}
