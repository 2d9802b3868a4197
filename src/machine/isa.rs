//! Runs a kernel compiled for one of several x86-64 instruction sets, chosen at run time.
//!
//! All variants come from the same source without fused multiply-adds, so they give the same bits: wider
//! registers only do more lanes at a time. On other processors everything is `Baseline`.

use std::sync::atomic::{AtomicU8, Ordering};

/// An instruction set that the hot loops are compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Isa {
    Baseline,
    Avx2,
    Avx512,
}

static CHOSEN: AtomicU8 = AtomicU8::new(u8::MAX);

impl Isa {
    /// The widest set that this machine has.
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl") {
                return Isa::Avx512;
            }
            if is_x86_feature_detected!("avx2") {
                return Isa::Avx2;
            }
        }
        Isa::Baseline
    }

    /// Makes [`run`] use this set from now on; false where the machine lacks it (nothing is changed then).
    pub fn choose(self) -> bool {
        let available = self <= Isa::detect();
        if available {
            CHOSEN.store(self as u8, Ordering::Relaxed);
        }
        available
    }

    /// The set in use.
    pub fn current() -> Self {
        match CHOSEN.load(Ordering::Relaxed) {
            0 => Isa::Baseline,
            1 => Isa::Avx2,
            2 => Isa::Avx512,
            _ => {
                let isa = Isa::detect();
                CHOSEN.store(isa as u8, Ordering::Relaxed);
                isa
            }
        }
    }
}

/// Calls `kernel` inside a function compiled for the current instruction set. What the kernel calls must be
/// `#[inline(always)]` to be compiled for it too, and so must a large closure be itself.
#[inline]
pub fn run<R>(kernel: impl FnOnce() -> R) -> R {
    #[cfg(target_arch = "x86_64")]
    match Isa::current() {
        // SAFETY: `choose` and `current` only store a set that `detect` found on this machine.
        Isa::Avx512 => return unsafe { run_avx512(kernel) },
        Isa::Avx2 => return unsafe { run_avx2(kernel) },
        Isa::Baseline => {}
    }
    kernel()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2")]
fn run_avx512<R>(kernel: impl FnOnce() -> R) -> R {
    kernel()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn run_avx2<R>(kernel: impl FnOnce() -> R) -> R {
    kernel()
}
