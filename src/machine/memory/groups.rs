//! What control groups leave to a process: its own group and every one above it, as batch systems and containers nest them.

use super::read;
use std::path::{Component, Path, PathBuf};

/// Files of a group's memory: its bounds, what it uses, and lines of `memory.stat` that count caches, which the kernel
/// gives up before it lets anybody starve.
struct Names {
    bounds: &'static [&'static str],
    used: &'static str,
    caches: [&'static str; 2],
}

const FIRST: Names = Names {
    bounds: &["memory.limit_in_bytes"],
    used: "memory.usage_in_bytes",
    caches: ["total_inactive_file", "total_active_file"],
};
const SECOND: Names = Names {
    bounds: &["memory.max", "memory.high"],
    used: "memory.current",
    caches: ["inactive_file", "active_file"],
};

/// Bytes that the groups of this process leave it, the least of all; none where no group has a bound.
pub(super) fn left() -> Option<u64> {
    of(&read("/proc/self/cgroup")?, &read("/proc/self/mountinfo")?)
}

fn of(groups: &str, mounts: &str) -> Option<u64> {
    mounts.lines().filter_map(|line| of_mount(groups, line)).min()
}

/// The same of the groups under one mount; none where that has no memory groups.
fn of_mount(groups: &str, mount: &str) -> Option<u64> {
    let (place, kind) = mount.split_once(" - ")?;
    let mut place = place.split(' ').skip(3).map(unescaped);
    let (root, point) = (PathBuf::from(place.next()?), PathBuf::from(place.next()?));
    let names = match kind.split(' ').next()? {
        "cgroup2" => &SECOND,
        "cgroup" if kind.split([' ', ',']).any(|option| option == "memory") => &FIRST,
        _ => return None,
    };
    let own = groups.lines().find_map(|line| {
        let (controllers, path) = line.split_once(':')?.1.split_once(':')?;
        let wanted = match kind.starts_with("cgroup2") {
            true => controllers.is_empty(),
            false => controllers.split(',').any(|c| c == "memory"),
        };
        wanted.then_some(path)
    })?;
    let inside = below(Path::new(own), &root);
    let chain: Vec<PathBuf> = inside.ancestors().map(|part| point.join(part)).collect();
    chain.iter().filter_map(|folder| in_group(folder, names)).min()
}

/// The path of a group under a mount that shows the hierarchy from `root`; the mount itself for a group outside it.
fn below(own: &Path, root: &Path) -> PathBuf {
    match own.strip_prefix(root) {
        Ok(inside) if inside.components().all(|c| matches!(c, Component::Normal(_))) => inside.into(),
        _ => PathBuf::new(),
    }
}

fn in_group(folder: &Path, names: &Names) -> Option<u64> {
    let bound = |name: &&str| read(folder.join(name))?.trim().parse::<u64>().ok();
    let most = names.bounds.iter().filter_map(bound).min()?;
    let used = read(folder.join(names.used))?.trim().parse::<u64>().ok()?;
    let stat = read(folder.join("memory.stat")).unwrap_or_default();
    let count = |line: &str| {
        let (name, count) = line.split_once(' ')?;
        names.caches.contains(&name).then(|| count.trim().parse::<u64>().ok())?
    };
    let caches: u64 = stat.lines().filter_map(count).sum();
    Some(most.saturating_sub(used.saturating_sub(caches)))
}

/// A path of `mountinfo`, in which blanks are three octal digits.
fn unescaped(text: &str) -> String {
    ["\\040 ", "\\011\t", "\\012\n", "\\134\\"]
        .iter()
        .fold(text.to_string(), |text, rule| text.replace(&rule[..4], &rule[4..]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn group(folder: &Path, files: &[(&str, &str)]) {
        fs::create_dir_all(folder).unwrap();
        files.iter().for_each(|(name, text)| fs::write(folder.join(name), text).unwrap());
    }

    /// A job's group has no bound, the one above it has, as Slurm nests them, and the root has none at all: the bound
    /// counts, less what is used, and caches are not used. In both versions; a mount of another kind says nothing.
    #[test]
    fn the_tightest_of_nested_groups() {
        let dir = tempfile::tempdir().unwrap();
        let point = dir.path().join("a mount");
        let bound = [("memory.max", "1000\n"), ("memory.high", "max\n"), ("memory.current", "700\n")];
        group(&point.join("slurm/job_7"), &bound);
        group(&point.join("slurm/job_7"), &[("memory.stat", "anon 9\ninactive_file 40\nactive_file 60\n")]);
        let free = [("memory.max", "max"), ("memory.high", "max"), ("memory.current", "650")];
        group(&point.join("slurm/job_7/step_0/task_0"), &free);
        let mount = |kind: &str, root: &str| {
            let point = point.to_str().unwrap().replace(' ', "\\040");
            format!("30 24 0:27 / /proc rw - proc proc rw\n31 23 0:28 {root} {point} rw,nosuid - {kind}\n")
        };
        let (second, first) = ("cgroup2 cgroup2 rw,nsdelegate", "cgroup cgroup rw,memory");
        let own = "5:cpu,cpuacct:/x\n4:memory:/slurm/job_7/step_0/task_0\n0::/slurm/job_7/step_0/task_0\n";
        assert_eq!(of(own, &mount(second, "/")), Some(400));
        assert_eq!(of(own, &mount(first, "/")), None);
        group(&point.join("slurm/job_7"), &[("memory.high", "900\n")]);
        assert_eq!(of(own, &mount(second, "/")), Some(300));
        // A mount that begins at the job, and a group outside it: what is mounted is what counts.
        assert_eq!(
            of("0::/slurm/job_7\n", &mount(second, "/slurm").replace("mount ", "mount/slurm ")),
            Some(300)
        );
        assert_eq!(of("0::/../x\n", &mount(second, "/").replace("mount ", "mount/slurm/job_7 ")), Some(300));
        let bound = [("memory.limit_in_bytes", "500"), ("memory.usage_in_bytes", "200")];
        group(&point.join("slurm"), &bound);
        group(&point, &[("memory.limit_in_bytes", "9223372036854771712"), ("memory.usage_in_bytes", "200")]);
        assert_eq!(of(own, &mount(first, "/")), Some(300));
        assert_eq!(of(own, "nonsense\n - \n"), None);
        assert_eq!(of("", &mount(second, "/")), None);
    }

    /// What is used beyond a bound leaves nothing.
    #[test]
    fn nothing_is_left() {
        let dir = tempfile::tempdir().unwrap();
        group(dir.path(), &[("memory.max", "10"), ("memory.current", "40")]);
        assert_eq!(in_group(dir.path(), &SECOND), Some(0));
    }
}
