//! `--depfile`: which files a bake depends on, in the syntax that make and ninja read.

use super::Args;
use crate::error::Result;
use crate::files::manifest::MANIFEST;
use crate::files::whole;
use crate::preset::{self, Planet};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Writes a rule for each planet that was read: its `bake.json`, which is written with all the rest, depends on the
/// preset's file, the spectra and waters that it reads, the list of planets, and this program, which holds what is
/// shipped.
pub(super) fn write(args: &Args, asked: &[String], planets: &[Option<String>]) -> Result<()> {
    let Some(file) = &args.depfile else { return Ok(()) };
    let mut common = Vec::new();
    for water in args.waters.iter().filter(|w| *w != "none") {
        common.extend(preset::water_files(water)?);
    }
    common.extend(args.list.clone());
    common.extend(std::env::current_exe().ok());
    let mut text = String::new();
    for (asked, name) in asked.iter().zip(planets) {
        let Some(name) = name else { continue };
        let mut needs = preset::planet_files(asked, &args.set)?;
        needs.extend(common.iter().cloned());
        let bake = args.out.join(name).join(MANIFEST);
        text.push_str(&rule(&bake, &needs));
        freshen(&bake);
    }
    whole::write(file, text.as_bytes())
}

/// A bake that was left alone is as good as a new one, and make shall see it newer than this program. Where that cannot
/// be noted, make asks again next time, and no more.
fn freshen(bake: &Path) {
    let file = std::fs::File::options().append(true).open(bake);
    let _ = file.and_then(|file| file.set_modified(std::time::SystemTime::now()));
}

/// Names of the planets that could be read.
pub(super) fn names(planets: &[Result<Planet>]) -> Vec<Option<String>> {
    planets.iter().map(|p| p.as_ref().ok().map(|planet| planet.name.clone())).collect()
}

fn rule(target: &Path, needs: &[PathBuf]) -> String {
    let mut seen: Vec<&PathBuf> = Vec::new();
    let mut text = format!("{}:", escaped(target));
    for need in needs {
        if !seen.contains(&need) {
            seen.push(need);
            let _ = write!(text, " \\\n  {}", escaped(need));
        }
    }
    text + "\n"
}

/// Blanks and `#` after a backslash, `$` twice, as compilers write them.
fn escaped(path: &Path) -> String {
    let mut out = String::new();
    for c in path.to_string_lossy().chars() {
        match c {
            ' ' | '#' => out.extend(['\\', c]),
            '$' => out.push_str("$$"),
            other => out.push(other),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file is named once; what make would take for syntax is escaped.
    #[test]
    fn rules_are_escaped() {
        let needs = ["my planets/a#1.json", "cost$.csv", "cost$.csv"].map(PathBuf::from);
        let expected = "out/a\\ b/bake.json: \\\n  my\\ planets/a\\#1.json \\\n  cost$$.csv\n";
        assert_eq!(rule(Path::new("out/a b/bake.json"), &needs), expected);
    }
}
