//! The table says where older methods fail.

use tyndall::internals::chart::stability::{Shared, cases, markdown, run};
use tyndall::internals::methods::Family;

/// Without gas, Bruneton's guess of green and blue from the red of aerosols divides by the gas's coefficient, 0: no
/// number comes out wherever the sky is lit, and the table says NaN. The marches and ours do not mind.
#[test]
fn aerosol_without_gas_is_no_number_in_brunetons_colours() {
    let case = cases().unwrap().into_iter().find(|c| c.name == "aerosol alone").unwrap();
    let outcomes = run(&case, false, &Shared::default());
    let of = |family| outcomes.iter().find(|o| o.family == family).unwrap();
    assert!(of(Family::Bruneton2017).not_finite > 0);
    assert!(of(Family::Nishita1993).not_finite == 0 && of(Family::Compact).not_finite == 0);
    let table = markdown(&[(case.name, outcomes)]);
    let row = table.lines().find(|l| l.contains("aerosol alone")).unwrap();
    assert_eq!(row.matches("NaN").count(), 1, "{table}");
}
