//! Bakes kept in a repository: baked, committed, outdated by a change of one number, found out, baked again,
//! explained; by the commands of the example workflow.

use super::run::*;
use std::fs;
use std::path::Path;
use std::process::Command;

/// What `scripts/ci/github-actions.yml` runs in the step whose name has this word in it.
fn step(word: &str) -> String {
    let workflow = include_str!("../../scripts/ci/github-actions.yml");
    let after = workflow.split("- name: ").find(|step| step.lines().next().unwrap().contains(word)).unwrap();
    let lines = after.split("run: |\n").nth(1).unwrap().lines();
    lines.take_while(|line| line.starts_with("          ")).map(|line| format!("{}\n", line.trim())).collect()
}

/// Runs a script in the repository, with this program and small tables, as the workflow would.
fn bash(repository: &Path, script: &str) -> Ran {
    let program = Path::new(env!("CARGO_BIN_EXE_tyndall")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let mut bash = Command::new("bash");
    bash.args(["-eo", "pipefail", "-c", script]).current_dir(repository).env("PATH", path);
    bash.env("OPTIONS", format!("--quiet --layout compact {}", SMALL[2..].join(" ")));
    ran(bash.env("RUNNER_TEMP", repository.join(".runner")).output().unwrap())
}

fn git(repository: &Path, arguments: &str) -> String {
    let mut git = Command::new("git");
    git.args(["-c", "user.name=nobody", "-c", "user.email=nobody@example.org", "-c", "commit.gpgsign=false"]);
    let done = ran(git.args(arguments.split(' ')).current_dir(repository).output().unwrap());
    assert_eq!(done.code, Some(0), "git {arguments}: {}", done.err);
    done.out
}

const BAKE: &str = "tyndall bake planets/*.json --out skies $OPTIONS";

/// The albedo of the ground from 0.45 to 0.46 makes `--check` fail with that key and both numbers and nothing else,
/// in files as a clone has them; a new bake passes, changes files, and `diff` gives the same reason and how large the
/// difference is. More light comes from the ground by 1/45 of it, and from nowhere less or by more.
#[test]
fn a_number_is_changed() {
    let dir = tempfile::tempdir().unwrap();
    let (origin, clone) = (&dir.path().join("origin"), &dir.path().join("clone"));
    fs::create_dir_all(origin.join("planets")).unwrap();
    let preset = include_str!("../../presets/planets/earth-paper.json").replace("earth-paper", "mine");
    fs::write(origin.join("planets/mine.json"), &preset).unwrap();
    git(origin, "init --quiet --initial-branch=main");
    assert_eq!(bash(origin, BAKE).code, Some(0));
    git(origin, "add planets skies");
    git(origin, "commit --quiet --message=sky");
    git(origin, &format!("clone --quiet . {}", clone.display()));

    let current = bash(clone, &step("those of its presets"));
    assert_eq!((current.code, current.out.as_str()), (Some(0), "skies/mine: current\n"), "{}", current.err);
    let same = bash(clone, &step("By how much"));
    assert_eq!(same.code, Some(0), "{}{}", same.out, same.err);
    assert!(same.out.contains("no difference"), "{}", same.out);

    let changed = preset.replace("\"albedo\": 0.45", "\"albedo\": 0.46");
    assert_ne!(changed, preset);
    fs::write(clone.join("planets/mine.json"), changed).unwrap();
    let stale = bash(clone, &step("those of its presets"));
    assert_eq!(stale.code, Some(1), "{}", stale.err);
    assert!(stale.out.starts_with("skies/mine: preset.ground_albedo") && stale.out.contains("0.45"));
    assert!(stale.out.contains("0.46") && stale.out.lines().count() == 1, "{}", stale.out);
    assert!(stale.err.contains("skies/mine: the bake is stale"), "{}", stale.err);
    assert_eq!(git(clone, "status --porcelain -- skies"), "");
    let differs = bash(clone, &step("By how much"));
    assert_eq!(differs.code, Some(1), "{}", differs.out);
    assert!(differs.out.contains("preset.ground_albedo"), "{}", differs.out);

    assert_eq!(bash(clone, BAKE).code, Some(0));
    assert_eq!(bash(clone, &step("those of its presets")).code, Some(0));
    assert!(git(clone, "status --porcelain -- skies").contains("M skies/mine/bake.json"));
    let explained = bash(clone, &format!("tyndall diff {}/skies/mine skies/mine --json", origin.display()));
    assert_eq!(explained.code, Some(0), "{}", explained.err);
    let told: serde_json::Value = serde_json::from_str(&explained.out).unwrap();
    let changes = told["changes"].as_array().unwrap();
    assert_eq!(changes.len(), 1, "{changes:?}");
    assert!(changes[0]["key"].as_str().unwrap().starts_with("preset.ground_albedo"), "{changes:?}");
    let worst = told["views"].as_array().unwrap().iter().map(|v| v["radiance"]["max"].as_f64().unwrap());
    let worst = worst.fold(0.0, f64::max);
    assert!((0.002..1.0 / 45.0 + 0.003).contains(&worst), "{worst}");
}
