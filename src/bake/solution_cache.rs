//! Light that several bakes share, where they differ in their tables alone: solving it is most of the work.

use crate::machine::cpu_time::cpu_time;
use crate::medium::Medium;
use crate::transport::solve::{LevelCounts, Orders, Resolution, Solution};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Solutions of the bakes before, the last `MOST`.
#[derive(Default)]
pub struct SolutionCache {
    kept: Mutex<Vec<Kept>>,
    coarse: bool,
}

#[derive(Clone)]
struct Kept {
    /// Medium, resolution and orders, as text.
    made_of: String,
    solved: Solved,
}

/// A solution, and the processor time, all threads, that it took: now, or in the bake before that it comes from.
#[derive(Clone)]
pub struct Solved {
    pub light: Arc<Solution>,
    pub cpu: Duration,
}

/// Of a planet with many wavelengths each has some hundreds of megabytes.
const MOST: usize = 2;

impl SolutionCache {
    /// Light solved as coarsely as can be: for tests of everything but its accuracy.
    pub fn coarse() -> Self {
        SolutionCache { coarse: true, ..SolutionCache::default() }
    }

    /// The light in a medium: that of a bake before, or solved now.
    pub fn of(&self, medium: &Medium, resolution: &Resolution, orders: Orders) -> Solved {
        let resolution = &if self.coarse { coarse(resolution) } else { *resolution };
        // Numbers are written so that no two are alike.
        let made_of = format!("{medium:?} {resolution:?} {orders:?}");
        let found = self.take(&made_of);
        // Nothing is locked meanwhile: threads that wait may be wanted by the solver.
        let kept = found.unwrap_or_else(|| {
            let start = cpu_time();
            let light = Arc::new(Solution::new(medium, resolution, orders));
            Kept { made_of, solved: Solved { light, cpu: cpu_time().saturating_sub(start) } }
        });
        let solved = kept.solved.clone();
        self.lock().push(kept);
        solved
    }

    /// What is kept under a name, taken out; where there is nothing, room is made for it.
    fn take(&self, made_of: &str) -> Option<Kept> {
        let mut kept = self.lock();
        let found = kept.iter().position(|k| k.made_of == made_of).map(|at| kept.remove(at));
        if found.is_none() {
            let surplus = (kept.len() + 1).saturating_sub(MOST);
            kept.drain(..surplus);
        }
        found
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Kept>> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn coarse(resolution: &Resolution) -> Resolution {
    let levels = LevelCounts { coarse: 8, ..resolution.levels };
    let [zeniths, first_azimuths, azimuths, sun_nodes, sunlight_nodes] = [6, 4, 2, 12, 24];
    Resolution { levels, zeniths, first_azimuths, azimuths, sun_nodes, sunlight_nodes, ..*resolution }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preset;

    /// The same medium again is not solved again; another one, other orders and another resolution are. What was asked for
    /// longest ago is forgotten.
    #[test]
    fn light_is_shared_where_it_is_the_same() {
        let planet = preset::load("earth-paper", &[]).unwrap();
        let (one, other) = (planet.medium(&[550.0]), planet.medium(&[551.0]));
        let small = Resolution { sun_nodes: 8, zeniths: 4, sunlight_nodes: 16, ..Resolution::PAPER };
        let finer = Resolution { sun_nodes: 9, ..small };
        let lights = SolutionCache::default();
        let solve = |medium: &Medium, resolution: &Resolution, orders: usize| {
            lights.of(medium, resolution, Orders::First(orders)).light
        };
        let first = solve(&one, &small, 1);
        assert!(Arc::ptr_eq(&first, &solve(&one, &small, 1)));
        assert!(!Arc::ptr_eq(&first, &solve(&one, &small, 2)));
        assert!(Arc::ptr_eq(&first, &solve(&one, &small, 1)));
        let second = solve(&other, &small, 1);
        assert!(!Arc::ptr_eq(&first, &second));
        assert!(!Arc::ptr_eq(&first, &solve(&one, &finer, 1)));
        assert!(!Arc::ptr_eq(&first, &solve(&one, &small, 1)), "two are kept");
    }
}
