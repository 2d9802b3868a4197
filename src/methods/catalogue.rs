//! The methods and settings that a chart compares.

use super::{BakedTables, Elek2009, Family, Method, Nishita, OneilMarch, Schafhitzel, Storage};
use crate::algorithm1::Gather;
use crate::bake::SolutionCache;
use crate::layout::compact::CompactLayout;
use crate::layout::compact::Sizes;
use crate::layout::elek2010::Elek2010Layout;
use crate::layout::settings::{Settings, Solver};
use crate::layout::three_atmosphere::ThreeAtmosphereLayout;
use crate::spectrum::grid;
use crate::transport::solve::Orders;
use std::sync::Arc;

/// All methods of a chart, in its order: those that share their light one after another.
pub fn all() -> Vec<Box<dyn Method>> {
    let mut out: Vec<Box<dyn Method>> = Vec::new();
    out.extend(older());
    let lights = Arc::default();
    let baked = [algorithm_1(&lights), elek2010(&lights), bruneton(&lights), compact(&lights)];
    out.extend(baked.into_iter().flatten().map(boxed));
    out
}

fn boxed(method: BakedTables) -> Box<dyn Method> {
    Box::new(method)
}

/// Methods with three wavelengths.
fn older() -> Vec<Box<dyn Method>> {
    vec![
        Box::new(Nishita { steps: 10, sun_steps: 5 }),
        Box::new(Nishita { steps: 40, sun_steps: 20 }),
        Box::new(Nishita { steps: 160, sun_steps: 80 }),
        Box::new(OneilMarch { steps: 40, size: [64, 64] }),
        Box::new(OneilMarch { steps: 40, size: [256, 256] }),
        Box::new(OneilMarch { steps: 160, size: [512, 512] }),
        Box::new(Schafhitzel { size: [32; 3] }),
        Box::new(Schafhitzel { size: [128; 3] }),
        Box::new(Elek2009 { size: [16, 64, 32] }),
        Box::new(Elek2009 { size: [32, 128, 32] }),
        Box::new(Elek2009 { size: [64, 128, 64] }),
    ]
}

fn size_of(size: [usize; 4]) -> String {
    size.map(|n| n.to_string()).join("×")
}

fn algorithm_1(lights: &Arc<SolutionCache>) -> Vec<BakedTables> {
    let of = |size: [usize; 4], samples, orders, gather, about: &str| BakedTables {
        family: Family::Algorithm1,
        setting: format!("{}, {samples} samples, {orders} orders, {about}", size_of(size)),
        layout: &Elek2010Layout,
        settings: Settings {
            elek2010_size: size,
            orders: Orders::First(orders),
            solver: Solver::Literal { samples, gather },
            ..Settings::default()
        },
        storage: Storage::AsBaked,
        lights: lights.clone(),
    };
    vec![
        of([32, 128, 32, 8], 30, 6, Gather::PerPoint, "4D gather table"),
        of([32, 128, 32, 8], 30, 6, Gather::Mean, "2D gather table"),
        of([16, 64, 16, 4], 15, 4, Gather::PerPoint, "4D gather table"),
        of([16, 64, 16, 4], 15, 4, Gather::Mean, "2D gather table"),
        of([8, 32, 12, 4], 10, 3, Gather::PerPoint, "4D gather table"),
        of([8, 32, 12, 4], 10, 3, Gather::Mean, "2D gather table"),
        of([8, 32, 12, 4], 10, 3, Gather::AtSample, "no gather table"),
    ]
}

fn bruneton(lights: &Arc<SolutionCache>) -> Vec<BakedTables> {
    let of = |setting: &str, storage| BakedTables {
        family: Family::Bruneton2017,
        setting: setting.into(),
        layout: &ThreeAtmosphereLayout,
        settings: Settings::default(),
        storage,
        lights: lights.clone(),
    };
    vec![
        of("256×128×32, RGB and red of Mie", Storage::RedOfMie),
        of("256×128×32, RGB and Mie apart", Storage::AsBaked),
    ]
}

fn elek2010(lights: &Arc<SolutionCache>) -> Vec<BakedTables> {
    let of = |size: [usize; 4], orders: Orders, wavelengths: usize, about: &str| BakedTables {
        family: Family::Elek2010,
        setting: format!("{}{about}", size_of(size)),
        layout: &Elek2010Layout,
        settings: Settings {
            elek2010_size: size,
            orders,
            wavelengths_nm: grid(wavelengths),
            ..Settings::default()
        },
        storage: Storage::AsBaked,
        lights: lights.clone(),
    };
    let all = Settings::default().orders;
    vec![
        of([8, 32, 16, 4], all, 15, ""),
        of([16, 64, 32, 6], all, 15, ""),
        of([32, 128, 32, 8], all, 15, ""),
        of([48, 192, 64, 12], all, 15, ""),
        of([32, 128, 32, 8], Orders::First(4), 15, ", 4 orders"),
        of([32, 128, 32, 8], all, 8, ", 8 wavelengths"),
    ]
}

/// Settings with a size of single and of multiple scattering.
fn compact_settings(single: [usize; 4], multiple: [usize; 4]) -> Settings {
    Settings { compact: Sizes { single, multiple, ..Sizes::default() }.into(), ..Settings::default() }
}

fn compact(lights: &Arc<SolutionCache>) -> Vec<BakedTables> {
    let of = |settings: Settings, about: &str, storage| BakedTables {
        family: Family::Compact,
        setting: format!(
            "{} + {}{about}",
            size_of(settings.compact.sizes.single),
            size_of(settings.compact.sizes.multiple)
        ),
        layout: &CompactLayout,
        settings,
        storage,
        lights: lights.clone(),
    };
    let sized = |single, multiple| of(compact_settings(single, multiple), "", Storage::AsBaked);
    let changed = |change: &dyn Fn(&mut Settings), about: &str| {
        let mut settings = Settings::default();
        change(&mut settings);
        of(settings, about, Storage::AsBaked)
    };
    vec![
        sized([4, 8, 8, 2], [4, 8, 8, 2]),
        sized([6, 12, 12, 2], [5, 12, 12, 3]),
        sized([8, 16, 16, 3], [6, 16, 16, 4]),
        sized([12, 24, 24, 4], [8, 24, 24, 5]),
        sized([16, 32, 32, 6], [12, 32, 32, 8]),
        sized(Sizes::default().single, Sizes::default().multiple),
        sized([40, 64, 56, 10], [28, 64, 56, 14]),
        of(Settings::default(), ", linear halves", Storage::LinearHalves),
        of(Settings::default(), ", 8 bits", Storage::EightBits),
        changed(&|s| s.orders = Orders::First(1), ", 1 order"),
        changed(&|s| s.orders = Orders::First(2), ", 2 orders"),
        changed(&|s| s.orders = Orders::First(4), ", 4 orders"),
        changed(&|s| s.wavelengths_nm = vec![440.0, 510.0, 570.0, 635.0], ", 4 wavelengths"),
        changed(&|s| s.wavelengths_nm = grid(8), ", 8 wavelengths"),
        changed(&|s| s.wavelengths_nm = grid(31), ", 31 wavelengths"),
    ]
}
