//! Same input, same bits.

use super::worlds::{COARSE, light, point};
use crate::common::oracle_medium;
use tyndall::internals::machine::isa::Isa;
use tyndall::internals::transport::solve::{Orders, Solution};

/// Every number of a solution and of some views, as bits.
fn bits(threads: usize, orders: Orders) -> Vec<u64> {
    let medium = oracle_medium("earth_clear");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let solution = pool.install(|| Solution::new(&medium, &COARSE, orders));
    let mut out: Vec<u64> = solution.report.residual.iter().map(|v| v.to_bits()).collect();
    for batch in &solution.batches {
        let lanes = batch.state.moments.iter().chain(&batch.state.ground);
        out.extend(lanes.flat_map(|l| l.0).map(|v| u64::from(v.to_bits())));
    }
    let views = [point(2.0, 0.02, 30.0, 10.0), point(5e3, -0.8, 70.0, 99.0), point(300e3, -0.4, -5.0, 60.0)];
    for p in &views {
        let light = light(&solution, &medium, p).expect("a view that meets the air");
        let values = light.scattering.into_iter().chain(light.ground).chain(light.transmittance);
        out.extend(values.map(f64::to_bits));
    }
    out.extend(solution.ground_irradiance(0.3).into_iter().map(f64::to_bits));
    out
}

/// Threads share out whole outputs and never a sum, and all instruction sets round each operation alike
/// (no fused multiply-add), so the bits are those of one thread without vector instructions.
#[test]
fn threads_and_instruction_sets_do_not_change_a_bit() {
    for orders in [Orders::First(3), Orders::Converged { tolerance: 1e-3 }] {
        assert!(Isa::Baseline.choose());
        let expected = bits(1, orders);
        assert!(expected.len() > 10_000 && expected.iter().any(|&b| b != 0));
        for isa in [Isa::Baseline, Isa::Avx2, Isa::Avx512].into_iter().filter(|i| i.choose()) {
            for threads in [1, 2] {
                assert!(bits(threads, orders) == expected, "{isa:?}, {threads} threads, {orders:?}");
            }
        }
    }
    Isa::detect().choose();
}
