//! Any options and any planet: bytes are choices of both. A bake is refused in one line, or all of its tables are finite
//! and its skies answer. Tables are the smallest that there are.

use super::bakes::{ask, opened};
use super::choices::Choices;
use super::{good, presets, refused};
use clap::{Args as _, Command, FromArgMatches};
use serde_json::{Value, json};
use tyndall::Error;
use tyndall::internals::bake::{Product, SolutionCache, bake_in};
use tyndall::internals::commands::bake::{Args, settings_of};
use tyndall::internals::geometry::Point;
use tyndall::internals::layout::Layout;
use tyndall::internals::layout::sky::{AerosolPhase, Channels, Component, Sky};
use tyndall::internals::preset;
use tyndall::internals::spectrum::ColourSpace;

pub fn any_bake(bytes: &[u8]) {
    let mut choices = Choices::new(bytes);
    choices.heavy = choices.one_in(if is_fine() { 4 } else { 64 });
    let shell = shell(&mut choices);
    let text = planet(&mut choices, shell).to_string();
    let words = options(&mut choices, shell[1]);
    // Where a run tells what it is at, a bake that never ends is known.
    let tells = std::env::var_os("TYNDALL_FUZZ_TELL").is_some();
    if tells {
        eprintln!("{text}\n{}", words.join(" "));
    }
    let ended = bake(&text, &words, shell[1]);
    if tells {
        eprintln!("{}", ended.map_or_else(|error| error.to_string(), |()| "baked".into()));
    }
}

/// Whether light is solved as users have it, and what takes long comes often.
fn is_fine() -> bool {
    std::env::var_os("TYNDALL_FUZZ_FINE").is_some()
}

/// What became of a planet and options: nothing but a sound bake or a refusal.
fn bake(text: &str, words: &[String], height: f64) -> Result<(), Error> {
    let refused = |error: Error| {
        refused(&error);
        error
    };
    let planet = preset::read("fuzzed.json", text, &[]).map_err(refused)?;
    presets::sound(&planet);
    let words = ["bake", "fuzzed.json", "--quiet"].into_iter().chain(words.iter().map(String::as_str));
    // What can be chosen here is well-formed: only what it means may be refused.
    let found = Args::augment_args(Command::new("bake")).try_get_matches_from(words).expect("known options");
    let args = Args::from_arg_matches(&found).expect("what the parser took");
    let settings = settings_of(&args, &planet).map_err(refused)?;
    let lights = if is_fine() { SolutionCache::default() } else { SolutionCache::coarse() };
    let product = bake_in(&lights, &planet, &settings, &mut |_| {}).map_err(refused)?;
    settings.layouts.iter().for_each(|layout| sound(&product, height, *layout));
    Ok(())
}

/// Radius and height of the shell, m.
fn shell(choices: &mut Choices) -> [f64; 2] {
    let radius = choices.power(1.0, 1e9);
    [radius, radius * choices.power(1e-5, 1.0)]
}

/// A planet: mostly one that can be solved.
fn planet(choices: &mut Choices, [radius, height]: [f64; 2]) -> Value {
    let albedo = choices.of(&[0.3, 0.0, 1.0]);
    let constituents: Vec<Value> =
        (0..choices.of(&[1, 2, 3, 0])).map(|n| constituent(choices, n, height)).collect();
    json!({
        "name": "fuzzed",
        "description": "x",
        "ground": { "radius_m": radius, "albedo": albedo, "source": "x" },
        "top": { "height_m": height, "source": "x" },
        "star": {
            "black_body_k": choices.power(800.0, 5e4),
            "radius_km": choices.power(1e4, 1e6),
            "distance_au": choices.power(0.05, 100.0),
            "source": "x",
        },
        "constituents": constituents,
    })
}

fn constituent(choices: &mut Choices, n: usize, height: f64) -> Value {
    let mut out = json!({ "name": format!("c{n}"), "role": choices.of(&["gas", "aerosol"]), "source": "x" });
    out["profile"] = profile(choices, height);
    match choices.of(&["scattering", "both", "absorption", "extinction"]) {
        "scattering" => out["scattering"] = coefficient(choices),
        "absorption" => out["absorption"] = coefficient(choices),
        "extinction" => {
            out["extinction"] = coefficient(choices);
            out["single_scattering_albedo"] = choices.of(&[0.9, 0.0, 1.0, 1e-6]).into();
        }
        _ => {
            out["scattering"] = coefficient(choices);
            out["absorption"] = coefficient(choices);
        }
    }
    out["phase"] = phase(choices);
    out
}

fn profile(choices: &mut Choices, height: f64) -> Value {
    let mut ends = [0; 3].map(|_| height * choices.share() * 1.2);
    ends.sort_by(f64::total_cmp);
    let [bottom, centre, top] = ends;
    match choices.below(5) {
        0 | 1 => {
            let scale = height * choices.power(1e-3, 10.0);
            json!({ "kind": "exponential", "scale_height_m": scale, "source": "x" })
        }
        2 => json!({ "kind": "tent", "bottom_m": bottom, "centre_m": centre, "top_m": top, "source": "x" }),
        3 => json!({ "kind": "layer", "bottom_m": bottom, "top_m": top, "source": "x" }),
        _ => {
            let densities = [1.0, choices.power(1e-6, 10.0), choices.power(1e-9, 1.0)];
            let kind = choices.of(&["linear", "log_linear"]);
            json!({ "kind": kind, "altitudes_m": ends, "densities": densities, "source": "x" })
        }
    }
}

fn coefficient(choices: &mut Choices) -> Value {
    let thick = if choices.heavy { 9.9e4 } else { 3.0 };
    let depths = [choices.power(1e-3, 10.0), choices.power(1e-9, thick), 0.0];
    let depth = choices.of(&depths);
    match choices.below(3) {
        0 => json!({ "kind": "constant", "optical_depth": depth, "source": "x" }),
        1 => {
            let exponent = 20.0 * choices.share() - 10.0;
            let at = choices.of(&[550.0, 400.0, 780.0]);
            json!({ "kind": "power_law", "optical_depth": depth, "at_nm": at, "angstrom_exponent": exponent, "source": "x" })
        }
        _ => {
            let depths = [depth, depth * choices.share(), 0.0, depth * choices.power(1e-6, 1.0)];
            json!({ "kind": "table", "wavelengths_nm": [380, 500, 600, 780], "optical_depth": depths, "source": "x" })
        }
    }
}

fn phase(choices: &mut Choices) -> Value {
    let mut g = || 1.998 * choices.share() - 0.999;
    let [one, two] = [g(), g()];
    match choices.below(6) {
        0 => json!({ "kind": "isotropic" }),
        1 => json!({ "kind": "rayleigh" }),
        2 => json!({ "kind": "henyey_greenstein", "g": one, "source": "x" }),
        3 => json!({ "kind": "cornette_shanks", "g": one, "source": "x" }),
        4 => {
            let weight = choices.share();
            json!({ "kind": "double_henyey_greenstein", "g1": one, "g2": two, "weight": weight, "source": "x" })
        }
        _ => {
            let values = [choices.power(1.0, 1e6), 1.0, 0.0, choices.share()];
            json!({ "kind": "tabulated", "angles_deg": [0, 10.0, 90.0, 180], "values": values, "source": "x" })
        }
    }
}

/// Options of `bake`, mostly ones that go together.
fn options(choices: &mut Choices, height: f64) -> Vec<String> {
    // The fixed tables of three-atmosphere take as long as fifty bakes of the others.
    let layouts = ["elek2010", "compact", "elek2010", "elek2010,compact", "three-atmosphere"];
    let layout = choices.of(&layouts[..if choices.heavy { 5 } else { 4 }]);
    let mut out = window(choices, height);
    let has = |out: &[String], start: &str| out.iter().any(|option| option.starts_with(start));
    let alone = |window: bool| if window { 1 } else { 2 };
    let (altitudes, suns) = (alone(has(&out, "--altitudes")), alone(has(&out, "--suns")));
    let odd = if has(&out, "--views") { 3 } else { 2 };
    for name in ["elek2010", "compact", "compact-single"] {
        let size = [[altitudes, 3], [odd, 4], [suns, 3], [1, 2]].map(|sizes| choices.of(&sizes).to_string());
        out.push(format!("--size={name}={}", size.join("x")));
    }
    out.push(format!(
        "--size=compact-transmittance={}x{}",
        choices.of(&[altitudes, 3]),
        choices.of(&[odd, 4])
    ));
    let waves = ["550", "2", "3", "4", "450,550,650", "200,550,2000", "500,500.0001", "380,390,400,410"];
    out.push(format!("--wavelengths={}", choices.of(&waves)));
    out.push(format!("--orders={}", if choices.heavy { "auto" } else { choices.of(&["1", "2"]) }));
    // Options that go with the others, but for once in a while.
    let any = choices.one_in(32);
    let (paper, compact) = (any || layout.contains("elek2010"), any || layout.contains("compact"));
    let whole = any || !["--altitudes", "--suns", "--views"].iter().any(|start| has(&out, start));
    out.insert(0, format!("--layout={layout}"));
    let rare = [
        ("--solver=literal", 8, paper && whole),
        ("--spectral", 6, paper && whole),
        ("--fold=c0", 6, compact),
        ("--without=scatterers", 6, compact),
        ("--exr-atlas=column", 6, true),
        ("--formats=ktx2,dds,npy", 4, true),
        ("--colour-space=acescg", 8, true),
        (choices.of(&["--white=star", "--white=0.3,0.3"]), 5, true),
    ];
    out.extend(rare.into_iter().filter(|r| choices.one_in(r.1) && r.2).map(|r| r.0.into()));
    if choices.heavy && choices.one_in(3) {
        out.extend(["--waters=muddy", "--size=water=2x2x2"].map(String::from));
        out.extend(choices.one_in(2).then(|| "--underwater".into()));
        out.push(format!("--water-orders={}", choices.of(&["1", "2"])));
        let depth = choices.power(1e-6, 100.0);
        out.extend(choices.one_in(2).then(|| format!("--water-depths={depth}")));
    }
    out
}

/// Options of a window, or none.
fn window(choices: &mut Choices, height: f64) -> Vec<String> {
    let mut out = Vec::new();
    let mut range = |choices: &mut Choices, option: &str, ends: [f64; 2]| {
        if choices.one_in(3) {
            out.push(format!("{option}={}..{}", ends[0].min(ends[1]), ends[0].max(ends[1])));
        }
    };
    let shares = [0.0, 0.5, 1.0, 1.0 + 1e-9, 1e-6, 3.0, 1e4, 0.999_999];
    let altitudes = [0; 2].map(|_| height * choices.of(&shares));
    range(choices, "--altitudes", altitudes);
    let suns = [0; 2].map(|_| choices.of(&[20.0, -5.0, 0.0, 90.0, -90.0, 1e-9, -60.0, 89.999_999]));
    range(choices, "--suns", suns);
    out.extend(choices.one_in(3).then(|| "--views=sky".into()));
    out
}

/// Every number of the tables is finite, or they would not have been encoded; the layout can be opened, and its answers
/// are light.
fn sound(product: &Product, height: f64, layout: &'static dyn Layout) {
    let sky = opened(product, layout);
    ask(sky.as_ref());
    for (share, mu, mu_s) in
        [(0.0, 0.5, 0.4), (0.3, -0.2, -0.1), (1.0, -1.0, 0.9), (2.0, -0.9, 0.2), (0.0, 0.0, 1.0)]
    {
        let point = Point { altitude: share * height, mu, mu_s, azimuth_deg: 20.0 };
        let light = sky.radiance(&point, Component::Total, AerosolPhase::Preset);
        assert!(is_light(&light, sky.as_ref(), product), "{layout:?} {point:?}: {light:?}");
    }
}

/// Rounding of halves, relative to the parts of a sum: a step is 2^-10, and two tables are added.
const ROUNDING: f64 = 2e-3;

/// Whether an answer is light: no wavelength is negative. A colour may lie outside the gamut of its space, where a
/// channel is negative; its X, Y and Z are integrals of light over functions that are nowhere negative.
fn is_light(light: &[f64], sky: &dyn Sky, product: &Product) -> bool {
    match sky.channels() {
        Channels::Wavelengths(_) => light.iter().copied().all(good),
        Channels::Rgb => {
            let name = &product.manifest.colour.space;
            let space =
                ColourSpace::ALL.into_iter().find(|space| space.name() == name).expect("a colour space");
            let is_positive = |row: [f64; 3]| {
                let parts: Vec<f64> = row.iter().zip(light).map(|(weight, v)| weight * v).collect();
                let size: f64 = parts.iter().map(|part| part.abs()).sum();
                size.is_finite() && parts.iter().sum::<f64>() >= -ROUNDING * size
            };
            light.len() == 3 && space.to_xyz().into_iter().all(is_positive)
        }
    }
}
