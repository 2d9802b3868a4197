//! Light that several bakes share, where they differ in their tables alone: solving it is most of the work.

use crate::clock::cpu_time;
use crate::medium::Medium;
use crate::transport::solve::{Orders, Resolution, Solution};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Solutions of the bakes before, the last [`MOST`].
#[derive(Default)]
pub struct Lights {
    kept: Mutex<Vec<Kept>>,
}

struct Kept {
    /// Medium, resolution and orders, as text.
    made_of: String,
    light: Arc<Solution>,
    cpu: Duration,
}

/// Of a planet with many wavelengths each has some hundreds of megabytes.
const MOST: usize = 2;

impl Lights {
    /// The light in a medium: that of a bake before, or solved now.
    pub(super) fn of(&self, medium: &Medium, resolution: &Resolution, orders: Orders) -> Arc<Solution> {
        // Numbers are written so that no two are alike.
        let made_of = format!("{medium:?} {resolution:?} {orders:?}");
        let mut kept = self.kept.lock().expect("no holder has panicked");
        let found = kept.iter().position(|k| k.made_of == made_of).map(|at| kept.remove(at));
        let last = found.unwrap_or_else(|| {
            let surplus = (kept.len() + 1).saturating_sub(MOST);
            kept.drain(..surplus);
            let start = cpu_time();
            let light = Arc::new(Solution::new(medium, resolution, orders));
            Kept { made_of, light, cpu: cpu_time().saturating_sub(start) }
        });
        let light = last.light.clone();
        kept.push(last);
        light
    }

    /// Processor time, all threads, that the light took that was asked for last: now, or when it was solved.
    pub fn cpu(&self) -> Duration {
        self.kept.lock().expect("no holder has panicked").last().map_or(Duration::ZERO, |k| k.cpu)
    }
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
        let lights = Lights::default();
        let first = lights.of(&one, &small, Orders::First(1));
        assert!(Arc::ptr_eq(&first, &lights.of(&one, &small, Orders::First(1))));
        assert!(!Arc::ptr_eq(&first, &lights.of(&one, &small, Orders::First(2))));
        assert!(Arc::ptr_eq(&first, &lights.of(&one, &small, Orders::First(1))));
        let second = lights.of(&other, &small, Orders::First(1));
        assert!(!Arc::ptr_eq(&first, &second));
        assert!(!Arc::ptr_eq(&first, &lights.of(&one, &finer, Orders::First(1))));
        assert!(!Arc::ptr_eq(&first, &lights.of(&one, &small, Orders::First(1))), "two are kept");
    }
}
