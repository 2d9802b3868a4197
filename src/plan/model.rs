//! A model that the planner may choose: settings of a bake of the layout `compact`, and what it costs to keep and to
//! look up.

use crate::layout::compact::CompactLayout;
use crate::layout::compact::{CompactSettings, IRRADIANCE_SIZE, groups_to_fold};
use crate::layout::extinction::PHASE_SIZE;
use crate::layout::settings::{Settings, TOLERANCE, WAVELENGTHS};
use crate::mapping::{Views, Window};
use crate::medium::Medium;
use crate::spectrum::grid;
use crate::transport::solve::Orders;

/// Bytes of a texel: four halves.
const TEXEL: usize = 8;

/// What decides tables and light.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    pub design: CompactSettings,
    pub window: Window,
    pub orders: Orders,
    pub wavelengths: usize,
}

impl Default for Model {
    /// What a bake makes unless told otherwise.
    fn default() -> Self {
        Model {
            design: CompactSettings::default(),
            window: Window::WHOLE,
            orders: Orders::Converged { tolerance: TOLERANCE },
            wavelengths: WAVELENGTHS,
        }
    }
}

/// What a model costs, of which all is counted and nothing timed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Bytes of texels.
    pub bytes: usize,
    /// Texture fetches of a view of the sky, and of one that ends on the ground.
    pub sky_fetches: usize,
    pub fetches: usize,
}

impl Model {
    /// Settings of the bake; `base` has all that models do not decide.
    pub fn settings(&self, base: &Settings) -> Settings {
        Settings {
            layouts: vec![&CompactLayout],
            compact: self.design.clone(),
            window: self.window,
            orders: self.orders,
            wavelengths_nm: self.wavelengths_nm(),
            ..base.clone()
        }
    }

    pub fn wavelengths_nm(&self) -> Vec<f64> {
        grid(self.wavelengths)
    }

    pub fn cost(&self, medium: &Medium) -> Cost {
        let (groups, kept) = groups_to_fold(medium, &self.design.folded);
        let sizes = &self.design.sizes;
        let depths = if self.has_scatterers(medium) { 2 } else { 1 };
        let texels = kept * sizes.single.iter().product::<usize>()
            + sizes.multiple.iter().product::<usize>()
            + depths * sizes.depth.iter().product::<usize>()
            + IRRADIANCE_SIZE
            + PHASE_SIZE * groups.len();
        // Azimuth and sun share an axis of the texture: where both have texels, two fetches and a blend.
        let volume = |size: [usize; 4]| if size[2].min(size[3]) == 1 { 1 } else { 2 };
        // A phase function is two texels of its row.
        let sky = volume(sizes.multiple) + kept * (volume(sizes.single) + 2) + depths;
        let ground = if self.window.views == Views::Sky { 0 } else { 2 };
        Cost { bytes: TEXEL * texels, sky_fetches: sky, fetches: sky + ground }
    }

    fn has_scatterers(&self, medium: &Medium) -> bool {
        !self.design.without_scatterers && medium.constituents.iter().any(|c| !c.scatters())
    }

    /// The `tyndall bake` that makes it.
    pub fn command(&self, planet: &str) -> String {
        let mut out = format!("tyndall bake {planet} --layout compact");
        if let Some(ends) = self.window.altitudes {
            out += &format!(" --altitudes {}m", ranged(ends));
        }
        if let Some(ends) = self.window.suns {
            out += &format!(" --suns {}", ranged(ends));
        }
        if self.window.views == Views::Sky {
            out += " --views sky";
        }
        let sizes = &self.design.sizes;
        let joined = |size: &[usize]| size.iter().map(usize::to_string).collect::<Vec<_>>().join("x");
        out += &format!(" --size compact={}", joined(&sizes.multiple));
        out += &format!(" --size compact-single={}", joined(&sizes.single));
        out += &format!(" --size compact-transmittance={}", joined(&sizes.depth));
        if !self.design.folded.is_empty() {
            out += &format!(" --fold {}", self.design.folded.join(","));
        }
        if self.design.without_scatterers {
            out += " --without scatterers";
        }
        if let Orders::First(n) = self.orders {
            out += &format!(" --orders {n}");
        }
        if self.wavelengths != WAVELENGTHS {
            out += &format!(" --wavelengths {}", self.wavelengths);
        }
        out
    }
}

/// `2` or `0..200`.
fn ranged([low, high]: [f64; 2]) -> String {
    if low == high { format!("{low}") } else { format!("{low}..{high}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of a made-up model by hand: 60 texels with one group's table folded away, and a command line that says
    /// all of it.
    #[test]
    fn commands_say_what_models_are() {
        let mut model = Model { orders: Orders::First(3), ..Model::default() };
        model.design.folded = vec!["air".into()];
        model.design.sizes.depth = [2, 40];
        model.window = Window { altitudes: Some([2.0; 2]), suns: Some([-6.0, 60.5]), views: Views::Sky };
        assert_eq!(
            model.command("earth"),
            "tyndall bake earth --layout compact --altitudes 2m --suns -6..60.5 --views sky --size \
             compact=16x44x40x10 --size compact-single=24x44x40x8 --size compact-transmittance=2x40 --fold air \
             --orders 3"
        );
    }
}
