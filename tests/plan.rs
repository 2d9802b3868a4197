//! The planner on a planet unlike Earth, and scenes that mean nothing.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::OnceLock;
use tyndall::internals::bake::bake;
use tyndall::internals::geometry::view::View;
use tyndall::internals::layout::settings::Settings;
use tyndall::internals::layout::sky::{self, Component, Sky};
use tyndall::internals::mapping::Views;
use tyndall::internals::plan::{Effort, Plan, plan};
use tyndall::internals::preset::{self, Budget, Metric, Planet, Scene, Tolerance};
use tyndall::internals::quality::{Scope, colour_error};
use tyndall::internals::spectrum::{ColourSpace, Reconstruction, multiply};
use tyndall::internals::transport::solve::{Orders, Resolution, Solution};

/// A tenth of Earth's radius under ten times its aerosol, which scatters evenly: another curvature, another mixture.
fn planet() -> Planet {
    let set = [
        "ground.radius_km=637",
        "constituents.aerosol.density_factor=10",
        "constituents.aerosol.phase={\"kind\":\"isotropic\"}",
    ];
    preset::load("earth-paper", &set.map(String::from)).unwrap()
}

/// Eyes up to a hill's height, the sun in the afternoon.
fn scene() -> Scene {
    let tolerance = Tolerance { metric: Metric::Relative, most: 0.02, share: 0.9 };
    Scene {
        name: "hill".into(),
        altitudes: [0.0, 500.0],
        suns: [20.0, 30.0],
        elevations: [0.0, 90.0],
        ..Scene::default_of("a planet of the test", 65e3, tolerance)
    }
}

/// Quick: the truth at the resolution of tables.
const QUICK: Effort = Effort { views: 300, truth: (Resolution::TABLES, 1e-4), seed: 5 };

fn planned() -> &'static Plan {
    static PLAN: OnceLock<Plan> = OnceLock::new();
    PLAN.get_or_init(|| plan(&planet(), &scene(), &QUICK, &mut |_| {}, &|| 0.0).unwrap())
}

/// The sky of a bake, opened from its files as any reader would.
fn baked(settings: &Settings, folder: &Path) -> Box<dyn Sky> {
    let product = bake(&planet(), settings, &mut |_| {}).unwrap();
    for (file, bytes) in &product.files {
        let path = folder.join(file);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    sky::open(folder, &product.manifest, "compact").unwrap()
}

/// Baked to files with the settings that the plan gives, the model keeps its promise on views that the planner never
/// drew, by this test's own comparison; and it has a quarter of the texels of the whole tables at most.
#[test]
fn the_promise_holds_on_fresh_views() {
    let (plan, planet, scene) = (planned(), planet(), scene());
    assert!(plan.unmet.is_empty(), "{:?}", plan.unmet);
    assert!(4 * plan.planned.cost.bytes <= plan.full.cost.bytes, "{:?}", plan.planned.cost);
    assert!(plan.planned.cost.fetches < plan.full.cost.fetches);
    let model = &plan.planned.model;
    assert_eq!((model.window.altitudes, model.window.views), (Some([0.0, 500.0]), Views::Sky));

    let dir = tempfile::tempdir().unwrap();
    let sky = baked(&model.settings(&Settings::default()), dir.path());
    let medium = planet.medium(&tyndall::internals::spectrum::grid(15));
    let solution = Solution::new(&medium, &Resolution::TABLES, Orders::Converged { tolerance: 1e-4 });
    let reconstruction = Reconstruction::new(&medium.wavelengths_nm, &planet.star.irradiance);
    let illuminance = reconstruction.sum(|_| 1.0)[1];
    let scope = Scope {
        altitudes: scene.altitudes,
        suns: scene.suns,
        elevations: scene.elevations,
        azimuths: [0.0, 180.0],
        sky_only: true,
    };
    let views = scope.views(500, 4711, medium.ground_radius, medium.top_radius);
    let all: Vec<usize> = (0..medium.constituents.len()).collect();
    let held = views.iter().filter(|p| {
        assert_eq!(sky.outside(p), None, "{p:?}");
        let view = View::enter(p, medium.ground_radius, medium.top_radius).unwrap();
        let xyz = reconstruction.xyz(&solution.radiance(&view, &all).scattering).map(|v| v / illuminance);
        let truth = multiply(&ColourSpace::Srgb.from_xyz(), xyz);
        colour_error(sky.rgb(p, Component::Total), truth) <= scene.tolerance.most
    });
    let share = held.count() as f64 / views.len() as f64;
    assert!(share >= 0.99 * scene.tolerance.share, "{share}");
}

/// What was left out adds up: bytes saved line by line are those between the whole tables and the planned ones, every
/// line that was kept would have broken the tolerance or saved nothing, and there is one of either kind.
#[test]
fn every_omission_is_measured() {
    let plan = planned();
    let (left, kept): (Vec<_>, Vec<_>) = plan.omissions.iter().partition(|o| o.left_out);
    let saved: i64 = left.iter().map(|o| o.saves_bytes).sum();
    let between = plan.full.cost.bytes as i64 - plan.planned.cost.bytes as i64;
    // Steps back, where the second set of views was not kept, save less than the lines say.
    assert!(saved >= between && saved < between + 50_000, "{saved} {between}");
    let most = scene().tolerance.most;
    assert!(
        !kept.is_empty() && kept.iter().all(|o| o.error[1] > most || o.worst_views || o.saves_bytes <= 0),
        "{kept:?}"
    );
    assert!(left.iter().any(|o| o.what.starts_with("altitudes but")), "{left:?}");
    assert!(left.iter().all(|o| o.error[1] <= most), "{left:?}");
}

/// The same scene gives the same answer to the byte; its command line names window and sizes.
#[test]
fn plans_are_the_same_every_time() {
    let again = plan(&planet(), &scene(), &QUICK, &mut |_| {}, &|| 7.0).unwrap();
    assert_eq!(planned().json().to_string(), again.json().to_string());
    let command = planned().command();
    let parts =
        ["--altitudes 0..500m", "--suns 20..30", "--views sky", "--size compact=", "--size compact-single="];
    assert!(parts.iter().all(|part| command.contains(part)), "{command}");
    assert!(planned().text().contains(&command));
}

/// A budget that nothing meets is said, with what was tried: of its models none is beaten by another in all three.
#[test]
fn an_impossible_budget_shows_the_front() {
    let budget = Budget { fetches: Some(2.0), bytes: Some(100.0), ..Budget::default() };
    let effort = Effort { views: 60, ..QUICK };
    let plan = plan(&planet(), &Scene { budget, ..scene() }, &effort, &mut |_| {}, &|| 0.0).unwrap();
    assert!(plan.unmet.iter().any(|u| u.contains("fetches a view, over 2")), "{:?}", plan.unmet);
    assert_eq!(plan.json()["holds"], false);
    assert!(plan.front.len() > 3 && plan.text().contains("the least that was tried"));
    for (a, b) in plan.front.iter().zip(&plan.front[1..]) {
        assert!(a.cost.bytes <= b.cost.bytes);
        assert!(a.error > b.error || a.cost.fetches > b.cost.fetches, "{a:?} {b:?}");
    }
    // Past the tolerance there are models that cost less than the one that keeps it.
    assert!(plan.front[0].cost.bytes < plan.planned.cost.bytes);
}

/// A tolerance below what halves can hold is kept by no table, however large.
#[test]
fn an_impossible_tolerance_is_said() {
    let tolerance = Tolerance { most: 1e-6, ..scene().tolerance };
    let effort = Effort { views: 40, ..QUICK };
    let plan = plan(&planet(), &Scene { tolerance, ..scene() }, &effort, &mut |_| {}, &|| 0.0).unwrap();
    assert!(plan.unmet.iter().any(|u| u.contains("of views within")), "{:?}", plan.unmet);
}

fn refused(text: &str) -> String {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("scene.json");
    std::fs::write(&path, text).unwrap();
    let error = preset::load_scene(path.to_str().unwrap()).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    let error = error.to_string();
    assert_eq!(error.lines().count(), 1, "{error}");
    error
}

/// A bad scene is refused in one line with key, value and reason, an unknown key with the nearest known one.
#[test]
fn bad_scenes_are_refused() {
    let good = r#"{"name": "x", "description": "", "planet": "earth", "observer": {"altitude_m": 2},
        "sun": {"elevation_deg": [1, 2]}, "tolerance": {"delta_e_2000": 1, "share_percent": 95}}"#;
    let cases = BTreeMap::from([
        (
            r#""observer""#,
            (
                r#""obsrver""#,
                "obsrver = {\"altitude_m\":2}: unknown key; the nearest known one is `observer`",
            ),
        ),
        ("[1, 2]", ("[2, 1]", "sun.elevation_deg = [2,1]: must be a number, or [lowest, highest]")),
        ("[1, 2]}", ("[-9, -2], \"twilight_matters\": false}", "twilight is all that matters")),
        (r#""altitude_m": 2"#, (r#""altitude_m": -2"#, "observer.altitude_m = -2: must be 0 or more")),
        (r#""altitude_m""#, (r#""altitude_feet""#, "nearest known one is `altitude_")),
        (r#""share_percent": 95"#, (r#""share_percent": 100"#, "between 50 and 99.9")),
        (r#""delta_e_2000": 1"#, (r#""delta_e_2000": 1, "relative_percent": 1"#, "give only one of")),
        (r#", "planet": "earth""#, ("", "`planet` is missing")),
    ]);
    for (old, (new, reason)) in cases {
        assert!(good.contains(old), "{old}");
        let error = refused(&good.replace(old, new));
        assert!(error.contains(reason), "{old}: {error}");
    }
    assert!(refused("{").contains("malformed JSON"));
    let error = preset::load_scene("wlak").unwrap_err().to_string();
    assert!(error.contains("nearest is `walk`"), "{error}");
}

/// Every shipped scene reads, and its planet and waters are there.
#[test]
fn shipped_scenes_hold() {
    let scenes = preset::shipped_scenes();
    assert_eq!(scenes.len(), 5);
    for (name, description) in scenes {
        let scene = preset::load_scene(name).unwrap();
        assert!(scene.name == name && description.len() > 20, "{name}");
        preset::load(&scene.planet, &[]).unwrap();
        assert_eq!(tyndall::internals::plan::load_waters(&scene).unwrap().len(), scene.waters.len());
    }
}
