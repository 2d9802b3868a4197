//! Jobs side by side, as many at once as memory and threads allow.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

/// What jobs share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// Bytes that the jobs at work may need together.
    pub memory: u64,
    /// Jobs at work at most.
    pub at_once: usize,
}

/// Stack of a job's thread: that of a program's first one.
const STACK: usize = 8 << 20;

/// Runs a job for each of `needs` (bytes of memory) and returns what they return, in the order given; `None` for
/// one that panicked. A job starts as soon as it fits beside those at work, an earlier one first; one that needs
/// more than the bound runs alone.
///
/// Each job has a thread of its own outside rayon's pool, which they share: a job that waits for the pool never
/// finds itself working on another one.
pub(super) fn run_all<T: Send>(
    needs: &[u64],
    bounds: Bounds,
    work: impl Fn(usize) -> T + Sync,
) -> Vec<Option<T>> {
    let gate = Gate::new(needs, bounds.memory);
    let answers: Mutex<Vec<Option<T>>> = Mutex::new(needs.iter().map(|_| None).collect());
    let drive = || {
        while let Some(job) = gate.enter() {
            let answer = catch_unwind(AssertUnwindSafe(|| work(job))).ok();
            answers.lock().unwrap_or_else(PoisonError::into_inner)[job] = answer;
            gate.leave(job);
        }
    };
    thread::scope(|scope| {
        let threads = bounds.at_once.clamp(1, needs.len().max(1));
        let started = (0..threads).filter(|k| {
            let thread = thread::Builder::new().name(format!("bake {k}")).stack_size(STACK);
            thread.spawn_scoped(scope, drive).is_ok()
        });
        // No thread to be had: this one does.
        if started.count() == 0 {
            drive();
        }
    });
    answers.into_inner().unwrap_or_else(PoisonError::into_inner)
}

/// Lets jobs in while they fit.
struct Gate<'a> {
    needs: &'a [u64],
    bound: u64,
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    waiting: Vec<usize>,
    at_work: usize,
    used: u64,
}

impl<'a> Gate<'a> {
    fn new(needs: &'a [u64], bound: u64) -> Self {
        let state = State { waiting: (0..needs.len()).collect(), at_work: 0, used: 0 };
        Gate { needs, bound, state: Mutex::new(state), changed: Condvar::new() }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next job that fits, once there is one; none where none is left.
    fn enter(&self) -> Option<usize> {
        let mut state = self.lock();
        loop {
            if state.waiting.is_empty() {
                return None;
            }
            let fits =
                |job: &usize| state.at_work == 0 || state.used.saturating_add(self.needs[*job]) <= self.bound;
            if let Some(place) = state.waiting.iter().position(fits) {
                let job = state.waiting.remove(place);
                state.at_work += 1;
                state.used = state.used.saturating_add(self.needs[job]);
                return Some(job);
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn leave(&self, job: usize) {
        let mut state = self.lock();
        state.at_work -= 1;
        state.used = if state.at_work == 0 { 0 } else { state.used.saturating_sub(self.needs[job]) };
        self.changed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering::SeqCst};
    use std::time::{Duration, Instant};

    /// Most memory and most jobs that were at work at once, and the answers. Jobs wait for as many as are wanted.
    fn watched(needs: &[u64], bounds: Bounds, wanted: usize) -> (u64, usize, Vec<Option<usize>>) {
        let (used, most_used) = (AtomicU64::new(0), AtomicU64::new(0));
        let (count, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let answers = run_all(needs, bounds, |job| {
            most_used.fetch_max(used.fetch_add(needs[job], SeqCst) + needs[job], SeqCst);
            most.fetch_max(count.fetch_add(1, SeqCst) + 1, SeqCst);
            let start = Instant::now();
            while most.load(SeqCst) < wanted && start.elapsed() < Duration::from_secs(60) {
                thread::sleep(Duration::from_millis(1));
            }
            // One too many would show.
            thread::sleep(Duration::from_millis(5));
            used.fetch_sub(needs[job], SeqCst);
            count.fetch_sub(1, SeqCst);
            job * 10
        });
        (most_used.into_inner(), most.into_inner(), answers)
    }

    /// Jobs of 3 bytes under a bound of 7 run two at a time however many threads there are; under one of 100 as
    /// many as threads. All run, and answers come in the order of the jobs.
    #[test]
    fn as_many_as_fit() {
        let all: Vec<Option<usize>> = (0..8).map(|k| Some(k * 10)).collect();
        assert_eq!(watched(&[3; 8], Bounds { memory: 7, at_once: 8 }, 2), (6, 2, all.clone()));
        assert_eq!(watched(&[3; 8], Bounds { memory: 100, at_once: 4 }, 4), (12, 4, all.clone()));
        assert_eq!(watched(&[3; 8], Bounds { memory: 100, at_once: 1 }, 1), (3, 1, all));
    }

    /// A job larger than the bound runs, and alone; so does one of all the memory there is.
    #[test]
    fn what_never_fits_runs_alone() {
        let (most, _, answers) = watched(&[1, 50, 1, u64::MAX / 2, 1], Bounds { memory: 10, at_once: 3 }, 1);
        assert_eq!(most, u64::MAX / 2);
        assert!(answers.iter().all(Option::is_some));
        assert_eq!(watched(&[], Bounds { memory: 0, at_once: 3 }, 1).2, []);
    }

    /// A job that panics takes no other with it, and its memory is given back.
    #[test]
    fn a_panic_is_one_jobs_own() {
        let answers = run_all(&[5, 5, 5], Bounds { memory: 5, at_once: 2 }, |job| {
            assert!(job != 1, "meant to fail");
            job
        });
        assert_eq!(answers, [Some(0), None, Some(2)]);
    }
}
