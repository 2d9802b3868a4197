//! Whether a manifest's numbers make a sky: looked at once, before any of them is used as an index or a size.

use super::Source;
use crate::error::{Error, Result};
use crate::files::Atlas;
use crate::files::manifest::Table;
use crate::medium::check_shell;

impl Source<'_> {
    /// Errors: `File` with the key of the first number that no bake has.
    pub(in crate::internals::layout) fn check(&self) -> Result<()> {
        self.check_constants().map_err(|reason| self.refuse(format!("bake.json: {reason}")))?;
        for table in self.manifest.tables.iter().filter(|t| t.layout == self.layout) {
            let (_, atlas) = self.table(&table.name)?;
            check_table(table, atlas)
                .map_err(|reason| self.refuse(format!("bake.json: tables.{}.{reason}", table.name)))?;
        }
        self.check_phase_rows().map_err(|reason| self.refuse(format!("bake.json: {reason}")))
    }

    fn list(&self, name: &str) -> Result<&[f64]> {
        let found = self.manifest.constants.get(name);
        found.map(Vec::as_slice).ok_or_else(|| Error::Reason(format!("constants.{name} is missing")))
    }

    fn check_constants(&self) -> Result<()> {
        let nm = self.list("four_wavelengths_nm")?;
        if !(1..=4).contains(&nm.len()) {
            return Err(format!("constants.four_wavelengths_nm has {} numbers, not 1 to 4", nm.len()).into());
        }
        if let Some(w) = nm.iter().find(|w| !(w.is_finite() && **w > 0.0)) {
            return Err(format!("constants.four_wavelengths_nm = {w}: must be greater than 0").into());
        }
        let albedo = self.list("ground_albedo_at_four")?;
        if albedo.len() != nm.len() {
            let (n, wanted) = (albedo.len(), nm.len());
            return Err(
                format!("constants.ground_albedo_at_four has {n} numbers for {wanted} wavelengths").into()
            );
        }
        if let Some(a) = albedo.iter().find(|a| !(0.0..=1.0).contains(*a)) {
            return Err(format!("constants.ground_albedo_at_four = {a}: must be between 0 and 1").into());
        }
        match self.list("star_illuminance_lx")? {
            [lx] if *lx > 0.0 && lx.is_finite() => {}
            other => {
                return Err(format!(
                    "constants.star_illuminance_lx = {other:?}: must be one positive number"
                )
                .into());
            }
        }
        let rgb = self.manifest.colour.matrices.get("rgb_from_four");
        let rgb = rgb.ok_or("colour.matrices.rgb_from_four is missing")?;
        if rgb.len() != 3 || rgb.iter().any(|row| row.len() != nm.len()) {
            let wanted = nm.len();
            return Err(format!(
                "colour.matrices.rgb_from_four must be 3 rows of {wanted} numbers, one a wavelength"
            )
            .into());
        }
        Ok(())
    }

    /// Every row of the phase table that a look-up may ask for is there.
    fn check_phase_rows(&self) -> Result<()> {
        let of_layout = || self.manifest.tables.iter().filter(|t| t.layout == self.layout);
        let Some(phase) = of_layout().find(|t| t.name == "phase") else { return Ok(()) };
        let rows = phase.shape.get(1).copied().unwrap_or(1);
        let singles = of_layout().filter(|t| t.name.starts_with("single_")).count();
        if singles > rows {
            return Err(format!(
                "tables.phase.shape has {rows} rows for {singles} tables of single scattering"
            )
            .into());
        }
        if self.layout == "elek2010" {
            match self.list("elek2010_aerosol_phase_row")? {
                [row] if *row >= 0.0 && *row < rows as f64 && row.fract() == 0.0 => {}
                other => {
                    let of = format!("must be a row of tables.phase, which has {rows}");
                    return Err(format!("constants.elek2010_aerosol_phase_row = {other:?}: {of}").into());
                }
            }
        }
        Ok(())
    }
}

/// The shape is that of the file, before anything of that size is asked of the machine; the axes make a shell.
fn check_table(table: &Table, atlas: &Atlas) -> Result<()> {
    let texels = table.shape.iter().try_fold(1usize, |n, &side| n.checked_mul(side));
    if texels.is_none() || texels != atlas.slice_len().checked_mul(atlas.slices) {
        let held = [atlas.width, atlas.height, atlas.slices];
        return Err(format!("shape = {:?}: {} holds {held:?}", table.shape, table.file).into());
    }
    for axis in &table.axes {
        let constant = |name: &str| axis.constants.get(name).copied();
        if let (Some(ground), Some(top)) = (constant("r_ground"), constant("r_top")) {
            check_shell(ground, top)
                .map_err(|reason| format!("axes.{}: r_ground, r_top: {reason}", axis.name))?;
        }
        for name in ["view_power", "horizon_power", "width"] {
            if let Some(v) = constant(name).filter(|v| !(1e-3..=1e3).contains(v)) {
                return Err(format!("axes.{}.{name} = {v}: must be between 0.001 and 1000", axis.name).into());
            }
        }
        if let Some(v) = constant("altitude_bend").filter(|v| !(-0.99..=1e3).contains(v)) {
            return Err(
                format!("axes.{}.altitude_bend = {v}: must be between -0.99 and 1000", axis.name).into()
            );
        }
        check_layer(constant).map_err(|reason| format!("axes.{}.{reason}", axis.name))?;
        if let Some(v) = constant("shift").filter(|v| !(-1.0..=1.0).contains(v)) {
            return Err(format!("axes.{}.shift = {v}: must be between -1 and 1", axis.name).into());
        }
        if let Some(v) = constant("centre").filter(|v| !(0.0..=1.0).contains(v)) {
            return Err(format!("axes.{}.centre = {v}: must be between 0 and 1", axis.name).into());
        }
    }
    Ok(())
}

/// A layer lies in its shell, and comes with all that its formula wants.
fn check_layer(constant: impl Fn(&str) -> Option<f64>) -> Result<()> {
    const NAMES: [&str; 4] = ["layer_share", "layer_altitude", "layer_width", "altitude_power"];
    let found = NAMES.map(&constant);
    if found.iter().all(Option::is_none) {
        return Ok(());
    }
    let height = constant("r_top").unwrap_or(0.0) - constant("r_ground").unwrap_or(0.0);
    let bounds = [(0.0, 0.99), (0.0, height), (1e-6 * height, 10.0 * height), (1.0, 2.0)];
    for ((name, found), (low, high)) in NAMES.iter().zip(found).zip(bounds) {
        match found {
            Some(v) if (low..=high).contains(&v) => {}
            Some(v) => return Err(format!("{name} = {v}: must be between {low} and {high}").into()),
            None => return Err(format!("{name}: missing, beside others of a layer").into()),
        }
    }
    Ok(())
}
