//! The paper's layout from Algorithm 1 taken literally, in place of the solver's.

use super::{Oddities, finish, mapping};
use crate::algorithm1;
use crate::colour::weights::ColourWeights;
use crate::error::{Error, Result};
use crate::layout::settings::{Settings, Solver};
use crate::layout::table_data::TableData;
use crate::machine::lanes::{Lanes, WIDTH};
use crate::mapping::Window;
use crate::medium::Medium;
use crate::transport::solve::{Orders, Solution};

/// The layout's tables. `solution` supplies direct sunlight and optical depth only.
pub fn tables(
    medium: &Medium,
    solution: &Solution,
    palette: &ColourWeights,
    settings: &Settings,
) -> Result<(Vec<TableData>, Oddities)> {
    let Solver::Literal { samples, gather } = settings.solver else {
        return Err(Error::Argument("these settings ask for no literal solver".into()));
    };
    let Orders::First(orders) = settings.orders else {
        return Err(Error::Argument("--solver literal sums orders one by one: give --orders N".into()));
    };
    let size = settings.elek2010_size;
    let mapping = mapping(medium, size, &Window::WHOLE).expect("sizes are checked with the arguments");
    let mut texels = vec![[0.0f32; 4]; size.iter().product()];
    let mut ambient = vec![[0.0f64; 3]; size[2]];
    let rgb = palette.rgb_weights();
    for first in (0..medium.wavelengths_nm.len()).step_by(WIDTH) {
        let range: Vec<usize> = (first..medium.wavelengths_nm.len().min(first + WIDTH)).collect();
        let algorithm = algorithm1::Settings { size, orders, samples, gather, ..Default::default() };
        let part = algorithm1::bake(&medium.at_wavelengths(&range), &algorithm, &|_, _| {})?;
        let dot = |light: Lanes, weight: &dyn Fn(usize) -> f64| -> f64 {
            range.iter().enumerate().map(|(k, &w)| f64::from(light[k]) * weight(w)).sum()
        };
        for (texel, [gas, aerosol]) in texels.iter_mut().zip(part.scattering.values()) {
            for c in 0..3 {
                texel[c] += dot(*gas, &|w| rgb[w][c]) as f32;
            }
            texel[3] += dot(*aerosol, &|w| palette.weights[w][1]) as f32;
        }
        for (sum, light) in ambient.iter_mut().zip(&part.ambient) {
            for c in 0..3 {
                sum[c] += dot(*light, &|w| rgb[w][c]);
            }
        }
    }
    Ok(finish(medium, solution, palette, (&mapping, &Window::WHOLE), texels, ambient))
}
