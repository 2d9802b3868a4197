//! `--list` and `--shard`: which of many planets this process bakes.

use super::Args;
use super::progress::Progress;
use crate::error::{Error, Result};
use crate::files::bounded_read;
use crate::files::bounded_read::MOST_CSV;
use crate::preset::{self, Planet};
use std::path::Path;

/// A part of a list: every `of`th planet from the `number`th, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    pub number: usize,
    pub of: usize,
}

/// `K/N`, K from 1 to N.
pub fn shard(text: &str) -> Result<Shard> {
    let numbers = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
    match numbers {
        Some((number, of)) if (1..=of).contains(&number) => Ok(Shard { number, of }),
        _ => Err("expected K/N with K from 1 to N, e.g. 3/8".into()),
    }
}

/// Presets that the arguments ask for, by name or path.
///
/// # Errors
/// `File` for a list that cannot be read or names nothing.
pub fn asked(args: &Args) -> Result<Vec<String>> {
    let all = match &args.list {
        Some(file) => read(file)?,
        None if args.all => preset::shipped_names().map(str::to_string).collect(),
        None => args.presets.clone(),
    };
    let Some(Shard { number, of }) = args.shard else { return Ok(all) };
    Ok(all.into_iter().skip(number - 1).step_by(of).collect())
}

/// Names that nobody knows, paths at which nothing is, and keys of --set that lead nowhere are slips of who typed them:
/// nothing is written then. A file with something wrong in it stops no other.
pub fn refuse_unknown(asked: &[String], planets: &[Result<Planet>], progress: &Progress) -> Result<()> {
    let slip = |(planet, asked): (&Result<Planet>, &String)| match planet {
        Err(error @ Error::Argument(_)) => Some(error.to_string()),
        Err(error) if error.exit_code() == 2 && preset::check_known(asked).is_err() => {
            Some(error.to_string())
        }
        _ => None,
    };
    let slips: Vec<String> = planets.iter().zip(asked).filter_map(slip).collect();
    match slips.as_slice() {
        [] => Ok(()),
        [one] if asked.len() == 1 => Err(Error::Argument(one.clone())),
        several => {
            several.iter().for_each(|slip| progress.always(&format!("error: {slip}")));
            let (bad, of) = (several.len(), asked.len());
            Err(Error::Argument(format!("{bad} of {of} presets were refused; nothing was baked")))
        }
    }
}

fn read(file: &Path) -> Result<Vec<String>> {
    parse(file, &bounded_read::text(file, MOST_CSV)?)
}

/// The presets that the text of a list names, a line each; `#` begins a comment. A path is from the folder of the list
/// where such a file is there, or else from the current folder, as those of spectra are.
///
/// # Errors
/// `File` for a list that names nothing.
pub fn parse(file: &Path, text: &str) -> Result<Vec<String>> {
    let lines = text.lines().map(|line| line.split('#').next().unwrap_or_default().trim());
    let folder = file.parent().unwrap_or(Path::new(""));
    let found: Vec<String> = lines
        .filter(|line| !line.is_empty())
        .map(|line| match folder.join(line) {
            beside if !preset::is_shipped(line) && beside.is_file() => beside.to_string_lossy().into_owned(),
            _ => line.to_string(),
        })
        .collect();
    if found.is_empty() { Err(Error::file(file, "names no planet")) } else { Ok(found) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shards share nothing and leave nothing out, whatever the length of the list.
    #[test]
    fn shards_are_a_partition() {
        let list: Vec<usize> = (0..17).collect();
        for of in [1, 3, 17, 20] {
            let part = |number: usize| list.iter().copied().skip(number - 1).step_by(of);
            let mut all: Vec<usize> = (1..=of).flat_map(part).collect();
            all.sort_unstable();
            assert_eq!(all, list, "{of}");
        }
        assert_eq!(shard("3/8").unwrap(), Shard { number: 3, of: 8 });
        for bad in ["0/8", "9/8", "1", "1/0", "-1/2", "1/2/3"] {
            assert!(shard(bad).is_err(), "{bad}");
        }
    }
}
