//! Arguments about the machine and the run, shared by commands: threads, instruction set, wavelengths, orders.

use crate::error::{Error, Result};
use crate::machine::isa::Isa;
use crate::transport::slab::WaterOrders;
use crate::transport::solve::Orders;
use std::error::Error as _;

/// Which instruction set the hot loops use; the bytes are the same for all.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum IsaChoice {
    Auto,
    Baseline,
    Avx2,
    Avx512,
}

impl IsaChoice {
    pub(super) fn apply(self) -> Result<()> {
        let isa = match self {
            IsaChoice::Auto => Isa::detect(),
            IsaChoice::Baseline => Isa::Baseline,
            IsaChoice::Avx2 => Isa::Avx2,
            IsaChoice::Avx512 => Isa::Avx512,
        };
        if isa.choose() {
            return Ok(());
        }
        Err(Error::Argument(format!("--isa {isa:?}: this machine has {:?} at most", Isa::detect())))
    }
}

/// Threads that can be asked for: more than any machine has, fewer than any system gives.
const MOST_THREADS: usize = 1024;

/// Runs with a number of threads, all of the machine's where none is given.
pub(super) fn with_threads<R: Send>(threads: Option<usize>, work: impl FnOnce() -> R + Send) -> Result<R> {
    match check_threads(threads)? {
        None => share_threads(None).map(|()| work()),
        Some(n) => {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build();
            Ok(pool.map_err(|e| Error::Argument(format!("--threads {n}: {e}")))?.install(work))
        }
    }
}

/// Gives this process so many threads for all work to come, all of the machine's where none is given; to be called
/// once, before any parallel work.
pub fn share_threads(threads: Option<usize>) -> Result<()> {
    match check_threads(threads)? {
        Some(n) => {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build_global();
            pool.map_err(|e| Error::Argument(format!("--threads {n}: {e}")))
        }
        // Made here, where it can fail, and not at its first use, where it would panic.
        None => match rayon::ThreadPoolBuilder::new().build_global() {
            // Without a source: they are there already.
            Err(e) if e.source().is_some() => Err(Error::machine("threads", std::io::Error::other(e))),
            _ => Ok(()),
        },
    }
}

fn check_threads(threads: Option<usize>) -> Result<Option<usize>> {
    match threads {
        Some(0) => Err(Error::Argument("--threads 0: at least one is needed".into())),
        Some(n) if n > MOST_THREADS => {
            Err(Error::Argument(format!("--threads {n}: {MOST_THREADS} are the most")))
        }
        other => Ok(other),
    }
}

/// `auto`, a number of even samples, or a list of nm.
pub(super) fn wavelengths(text: &str) -> Result<Vec<f64>> {
    if text == "auto" {
        return Ok(crate::spectrum::grid(crate::layout::settings::WAVELENGTHS));
    }
    if let Ok(n) = text.parse::<usize>()
        && n < 100
    {
        return if n == 0 {
            Err("at least one wavelength is needed".into())
        } else {
            Ok(crate::spectrum::grid(n))
        };
    }
    let list: Vec<f64> = text
        .split(',')
        .map(|t| t.trim().parse::<f64>().map_err(|_| format!("`{t}` is not a wavelength in nm")))
        .collect::<std::result::Result<_, _>>()?;
    in_range(&list)?;
    if list.windows(2).any(|w| w[0] >= w[1]) {
        return Err("wavelengths must rise".into());
    }
    Ok(list)
}

/// Wavelengths of a run at most.
const MOST_WAVELENGTHS: usize = 500;

/// Whether wavelengths (nm), in any order, are ones that a run may have.
pub(super) fn in_range(list: &[f64]) -> Result<()> {
    if list.is_empty() {
        return Err("at least one wavelength is needed".into());
    }
    if let Some(w) = list.iter().find(|w| !(100.0..=10_000.0).contains(*w)) {
        return Err(format!("{w} nm is outside 100 to 10000 nm").into());
    }
    if list.len() > MOST_WAVELENGTHS {
        return Err(format!("more than {MOST_WAVELENGTHS} wavelengths").into());
    }
    Ok(())
}

/// Orders of scattering that can be asked for.
pub(super) const MOST_ORDERS: usize = 10_000;

/// `auto` or a number of orders; `tolerance` is what `auto` converges to.
pub(super) fn orders(text: &str, tolerance: f64) -> Result<Orders> {
    if text == "auto" {
        return Ok(Orders::Converged { tolerance });
    }
    match text.parse::<usize>() {
        Ok(n) if (1..=MOST_ORDERS).contains(&n) => Ok(Orders::First(n)),
        _ => Err("expected `auto` or a number from 1 to 10000".into()),
    }
}

/// `auto` or a number of orders of scattering in water.
pub(super) fn water_orders(text: &str) -> Result<WaterOrders> {
    match text.parse::<usize>() {
        _ if text == "auto" => Ok(WaterOrders::All),
        Ok(n) if (1..=MOST_WATER_ORDERS).contains(&n) => Ok(WaterOrders::First(n)),
        _ => Err(format!("expected `auto` or a number from 1 to {MOST_WATER_ORDERS}").into()),
    }
}

/// Orders in water that can be asked for: a scattering albedo of 0.99 leaves 1e-4 of the light after as many.
pub(super) const MOST_WATER_ORDERS: usize = 1000;
