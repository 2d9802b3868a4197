//! By which version of each algorithm a bake is made. A version is raised when bytes that a bake holds change, and only
//! then (`tests/cli/bytes.rs` holds both), so that a bake of another build is stale when, and only when, its bytes are.

use crate::files::manifest::Tool;
use crate::layout::settings::Settings;
use crate::layout::{self, water};
use crate::transport;
use std::collections::BTreeMap;

/// The versions of all that this program can bake: `solver` (with all that every bake shares: spectra, colours, report,
/// pictures), a layout, `water`.
pub fn all() -> BTreeMap<String, u32> {
    let layouts = layout::ALL.map(|layout| (layout.name(), layout.version()));
    let rest = [(SOLVER, transport::ALGORITHM_VERSION), (water::LAYOUT, water::ALGORITHM_VERSION)];
    layouts.into_iter().chain(rest).map(|(name, version)| (name.to_string(), version)).collect()
}

/// The tool as a bake of these settings records it: with the versions that decide its bytes.
pub fn tool(settings: &Settings) -> Tool {
    let layouts = settings.layouts.iter().map(|l| l.name());
    let waters = (!settings.waters.list.is_empty()).then_some(water::LAYOUT);
    let used: Vec<&str> = layouts.chain(waters).chain([SOLVER]).collect();
    let mut algorithms = all();
    algorithms.retain(|name, _| used.contains(&name.as_str()));
    Tool::this(algorithms)
}

/// What is solved before any layout is filled.
pub const SOLVER: &str = "solver";
