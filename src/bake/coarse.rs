//! Sheets of the air that the altitudes of a bake's tables are too far apart for.

use crate::layout::settings::Settings;
use crate::mapping::Elek2010;
use crate::medium::{Medium, Sheet};

/// A warning for each sheet that is thinner than the distance of the altitudes about it in a layout that is baked.
pub(super) fn sheets(medium: &Medium, settings: &Settings) -> Vec<String> {
    let found = medium.sheets();
    if found.is_empty() {
        return Vec::new();
    }
    let layouts: Vec<(&str, Vec<Elek2010>)> =
        settings.layouts.iter().map(|layout| (layout.name(), layout.mappings(medium, settings))).collect();
    found.iter().filter_map(|sheet| warning(medium, sheet, &layouts)).collect()
}

fn warning(medium: &Medium, sheet: &Sheet, layouts: &[(&str, Vec<Elek2010>)]) -> Option<String> {
    // Of a layout's tables, the coarsest.
    let spacing = |tables: &[Elek2010]| tables.iter().map(|t| step(t, sheet.altitudes)).fold(0.0, f64::max);
    let coarse: Vec<String> = layouts
        .iter()
        .map(|(layout, tables)| (*layout, spacing(tables)))
        .filter(|(_, step)| *step > sheet.thickness())
        .map(|(name, step)| format!("{step:.0} m (layout {name})"))
        .collect();
    if coarse.is_empty() {
        return None;
    }
    let [bottom, top] = sheet.altitudes.map(|z| digits(z / 1e3));
    let (name, thickness) = (&medium.constituents[sheet.constituent].name, digits(sheet.thickness()));
    Some(format!(
        "constituents.{name}.profile: its layer from {bottom} to {top} km (optical depth {}) is {thickness} m thick, and the \
         altitudes of the tables lie {} apart there: near it they blur it; --altitudes and --size bring them closer",
        digits(sheet.depth),
        coarse.join(" and ")
    ))
}

/// Three significant digits, written out.
fn digits(v: f64) -> f64 {
    format!("{v:.2e}").parse().unwrap_or(v)
}

/// Distance of the two altitudes of a table about the middle of what it holds of a stretch, m; 0 where it holds none.
fn step(table: &Elek2010, [bottom, top]: [f64; 2]) -> f64 {
    let size = table.size()[0];
    let mut altitudes: Vec<f64> = (0..size).map(|i| table.altitude(i)).collect();
    if size == 1 {
        altitudes = table.altitudes().to_vec();
    }
    let [lowest, highest] = table.altitudes();
    let (low, high) = (bottom.max(lowest), top.min(highest));
    let middle = 0.5 * (low + high);
    let about = |pair: &&[f64]| (pair[0]..=pair[1]).contains(&middle);
    if low < high { altitudes.windows(2).find(about).map_or(0.0, |pair| pair[1] - pair[0]) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::elek2010::Elek2010Layout;
    use crate::mapping::Window;
    use crate::medium::DensityProfile;
    use crate::preset;
    use crate::spectrum::grid;

    /// Warnings of the preset earth-paper with its aerosol in a layer, m.
    fn told(bottom: f64, top: f64, settings: &Settings) -> Vec<String> {
        let mut medium = preset::load("earth-paper", &[]).unwrap().medium(&grid(5));
        medium.constituents[1].density = DensityProfile::Layer { bottom, top };
        sheets(&medium, settings)
    }

    fn windowed(altitudes: [f64; 2]) -> Settings {
        Settings { window: Window { altitudes: Some(altitudes), ..Window::WHOLE }, ..Settings::default() }
    }

    /// Layers of 200 m and of 1 km at 10 km are thinner than the altitudes of usual tables are apart, one of 6 km is not,
    /// but is of small tables; each layout is named with its distance.
    #[test]
    fn thin_layers_are_told_of() {
        let usual = Settings::default();
        let one = told(10e3, 10.2e3, &usual);
        assert_eq!(one.len(), 1, "{one:?}");
        for part in [
            "constituents.aerosol.profile",
            "10 to 10.2 km",
            "200 m thick",
            "m (layout elek2010)",
            "m (layout compact)",
        ] {
            assert!(one[0].contains(part), "{part}: {one:?}");
        }
        assert_eq!((told(10e3, 11e3, &usual).len(), told(10e3, 16e3, &usual)), (1, vec![]));
        assert_eq!(told(64.8e3, 65.3e3, &usual).len(), 1, "one that the top cuts");
        let mut small = usual.clone();
        small.layouts = vec![&Elek2010Layout];
        small.elek2010_size = [4, 8, 8, 4];
        let told = told(10e3, 16e3, &small);
        assert!(told.len() == 1 && !told[0].contains("compact"), "{told:?}");
    }

    /// A window in which the altitudes are close, or that has none of the layer, loses nothing.
    #[test]
    fn windows_are_heeded() {
        assert_eq!(told(10e3, 10.2e3, &windowed([9.9e3, 10.3e3])), Vec::<String>::new());
        assert_eq!(told(10e3, 10.2e3, &windowed([0.0, 2e3])), Vec::<String>::new());
        assert_eq!(told(10e3, 10.2e3, &windowed([0.0, 30e3])).len(), 1);
    }

    /// No shipped planet has such a layer in tables of usual size.
    #[test]
    fn shipped_planets_have_none() {
        for name in preset::shipped_names() {
            let medium = preset::load(name, &[]).unwrap().medium(&grid(15));
            assert_eq!(sheets(&medium, &Settings::default()), Vec::<String>::new(), "{name}");
        }
    }
}
