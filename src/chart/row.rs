//! A chart as rows: what the CSV holds, and all that fronts and pictures are made of.

use super::{Chart, Errors};
use crate::error::{Error, Result};
use crate::files::bounded_read;
use crate::files::bounded_read::MOST_CSV;
use crate::methods::Family;
use crate::quality::{Distribution, REGIONS, digits};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A method in a region. Times are those of one run and differ from run to run; errors do not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    pub preset: String,
    /// Its title.
    pub family: String,
    pub setting: String,
    /// 1 for this project's own.
    pub ours: u8,
    pub region: String,
    /// Lit views that were compared; 0 where the method does not answer.
    pub views: usize,
    pub delta_e_median: Option<f64>,
    pub delta_e_p95: Option<f64>,
    pub delta_e_worst: Option<f64>,
    /// Length of the difference of linear RGB over the length of the true one.
    pub radiance_median: Option<f64>,
    pub radiance_p95: Option<f64>,
    pub radiance_worst: Option<f64>,
    pub not_finite: Option<usize>,
    pub negative: Option<usize>,
    pub preparation_cpu_s: f64,
    pub table_bytes: f64,
    pub fetches: f64,
    pub look_up_ns: f64,
    /// On the front of ΔE2000 (95 % below) against each cost.
    pub front_preparation: u8,
    pub front_bytes: u8,
    pub front_look_up: u8,
    pub failure: String,
}

impl Row {
    pub fn family(&self) -> Option<Family> {
        Family::ALL.into_iter().find(|f| f.title() == self.family)
    }

    /// Family and setting.
    pub fn name(&self) -> String {
        format!("{}: {}", self.family, self.setting)
    }
}

/// All rows of a chart, region by region, the fronts not yet marked.
pub fn rows(chart: &Chart) -> Vec<Row> {
    let of_region = |region: usize| {
        chart.methods.iter().map(move |m| {
            let errors = m.errors(&chart.truth, region);
            let [of_delta_e, of_radiance] = [
                errors.as_ref().map_or([None; 3], |e| shown(&e.delta_e)),
                errors.as_ref().map_or([None; 3], |e| shown(&e.radiance)),
            ];
            let count = |f: &dyn Fn(&Errors) -> usize| errors.as_ref().map(f);
            Row {
                preset: chart.planet.clone(),
                family: m.family.title().into(),
                setting: m.setting.clone(),
                ours: u8::from(m.family.is_ours()),
                region: REGIONS[region].name.into(),
                views: errors.as_ref().map_or(0, |e| e.delta_e.count),
                delta_e_median: of_delta_e[0],
                delta_e_p95: of_delta_e[1],
                delta_e_worst: of_delta_e[2],
                radiance_median: of_radiance[0],
                radiance_p95: of_radiance[1],
                radiance_worst: of_radiance[2],
                not_finite: count(&|e| e.not_finite),
                negative: count(&|e| e.negative),
                preparation_cpu_s: digits(m.preparation),
                table_bytes: m.bytes as f64,
                fetches: digits(m.fetches),
                look_up_ns: libm::round(m.nanoseconds),
                front_preparation: 0,
                front_bytes: 0,
                front_look_up: 0,
                failure: m.failure.clone().unwrap_or_default(),
            }
        })
    };
    (0..REGIONS.len()).flat_map(of_region).collect()
}

fn shown(d: &Distribution) -> [Option<f64>; 3] {
    [d.median, d.p95, d.max].map(|v| Some(if v.is_finite() { digits(v) } else { f64::INFINITY }))
}

/// The rows as CSV.
///
/// # Errors
/// None but what the machine lacks.
pub fn to_csv(rows: &[Row]) -> Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let failed = |e: csv::Error| Error::machine("the chart as CSV", std::io::Error::other(e));
    rows.iter().try_for_each(|row| writer.serialize(row)).map_err(failed)?;
    writer.into_inner().map_err(|e| Error::machine("the chart as CSV", e.into_error()))
}

/// The rows of a chart that was made before.
///
/// # Errors
/// `File` for what is no chart.
pub fn read_csv(path: &Path) -> Result<Vec<Row>> {
    parse_csv(path, bounded_read::text(path, MOST_CSV)?.as_bytes())
}

/// The same of a text; `path` is for messages only.
///
/// # Errors
/// As [`read_csv`].
pub fn parse_csv(path: &Path, text: &[u8]) -> Result<Vec<Row>> {
    let mut reader = csv::Reader::from_reader(text);
    reader.deserialize().collect::<std::result::Result<_, _>>().map_err(|e| Error::file(path, e))
}

/// The points at which Monte Carlo checked the truth, as CSV.
pub fn checks_csv(chart: &Chart) -> String {
    let mut out = String::from(
        "preset,region,altitude_m,mu_view,mu_sun,azimuth_deg,wavelength_nm,truth_per_sr,monte_carlo_per_sr,stderr_per_sr\n",
    );
    for c in &chart.checks {
        let view = c.view.map(|v| v.to_string()).join(",");
        let (name, region) = (&chart.planet, REGIONS[c.region].name);
        out.push_str(&format!(
            "{name},\"{region}\",{view},550,{:.6e},{:.6e},{:.2e}\n",
            c.truth, c.monte_carlo, c.stderr
        ));
    }
    out
}
