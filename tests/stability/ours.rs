//! Our layouts: a number everywhere, never negative, and near the truth.

use tyndall::internals::chart::stability::{Case, Outcome, Shared, cases, run};
use tyndall::internals::methods::Family;

/// Largest median and 95th percentile of the relative error of RGB by day, of tables a thirtieth as large as the
/// baker's own, on views that lie where tables are worst; and whether the bake has to warn of the layout, because more
/// cannot be had.
fn bounds(case: &str, family: Family) -> (f64, f64, bool) {
    let is_ours = family == Family::Compact;
    match case {
        // One wavelength has no colour; a straight line from night to noon is no day, and with two views a sky has one
        // brightness.
        "1 wavelength" => (0.2, 1.0, true),
        "2 suns" => (1.0, 1.0, is_ours),
        "2 views" if !is_ours => (1.0, 1.1, true),
        "2 altitudes" | "2 views" | "2 azimuths" if is_ours => (0.05, 0.5, false),
        // Between ground and space there is no more than a line in the paper's layout.
        "2 altitudes" => (0.1, 30.0, true),
        // Light that was scattered many times has the colour and the phase function of direct sunlight put on it.
        "100 times denser" if !is_ours => (0.1, 1.1, true),
        _ if is_ours => (0.01, 0.1, false),
        // The paper's medium, in which haze is isotropic (and a third as bright on mars), costs what it costs.
        _ => (0.7, 1.0, false),
    }
}

fn complaints(case: &Case, outcome: &Outcome) -> Vec<String> {
    let mut out = Vec::new();
    let mut complain = |what: String| out.push(format!("{}, {:?}: {what}", case.name, outcome.family));
    if let Some(reason) = &outcome.refused {
        complain(reason.clone());
    }
    if outcome.not_finite + outcome.negative > 0 {
        complain(format!("{} not finite, {} negative", outcome.not_finite, outcome.negative));
    }
    let (median, p95, warned) = bounds(case.name, outcome.family);
    if !(outcome.error.median <= median && outcome.error.p95 <= p95) {
        complain(format!("median {:.3}, 95 % {:.3}", outcome.error.median, outcome.error.p95));
    }
    if warned && !outcome.is_warned() {
        complain("the bake does not warn of it".into());
    }
    out
}

/// Cases that take long and are like others: left to `scripts/study`.
const LONG: [&str; 5] = ["venus", "mars", "earth without ozone", "10 times denser", "81 wavelengths"];

fn check(long: bool) {
    let (mut all, shared) = (Vec::new(), Shared::default());
    for case in cases().unwrap().into_iter().filter(|c| LONG.contains(&c.name) == long) {
        let case = if case.heavy { case } else { case.quick() };
        let outcomes = run(&case, true, &shared);
        assert_eq!(outcomes.len(), 2, "both layouts");
        for o in &outcomes {
            println!(
                "{}, {:?}: {:.4} {:.4} of {}",
                case.name, o.family, o.error.median, o.error.p95, o.error.count
            );
            all.extend(complaints(&case, o));
        }
    }
    assert!(all.is_empty(), "{}", all.join("\n"));
}

/// Radiance is a sum of products of what is not negative, so whatever the tables' size it is a number and at least 0;
/// errors stay within the bounds above.
#[test]
fn our_layouts_stand_every_case() {
    check(false);
}

#[test]
#[ignore = "long: scripts/study"]
fn our_layouts_stand_long_cases_at_length() {
    check(true);
}

/// Every long case is one: a name that nothing has would leave nothing out.
#[test]
fn long_cases_exist() {
    let cases = cases().unwrap();
    assert!(LONG.iter().all(|name| cases.iter().any(|c| c.name == *name)));
}
