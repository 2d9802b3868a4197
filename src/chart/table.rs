//! A chart as CSV.

use super::{Chart, Cost, front};
use crate::quality::{Distribution, REGIONS, digits};

/// A row for each method and region. Times are of this run and differ from run to run; errors do not.
pub fn csv(chart: &Chart) -> String {
    let mut out = String::from(
        "preset,family,setting,ours,region,views,delta_e_median,delta_e_p95,delta_e_worst,radiance_median,radiance_p95,\
         radiance_worst,not_finite,negative,preparation_cpu_s,table_bytes,fetches,look_up_ns,front_preparation,\
         front_bytes,front_look_up,failure\n",
    );
    for (region, named) in REGIONS.iter().enumerate() {
        let fronts = Cost::ALL.map(|cost| front(chart, region, cost));
        for (n, m) in chart.methods.iter().enumerate() {
            let head = [&chart.planet, m.family.title(), &m.setting].map(quoted).join(",");
            let costs = format!("{},{},{},{:.0}", digits(m.preparation), m.bytes, digits(m.fetches), m.nanoseconds);
            let on = fronts.each_ref().map(|f| u8::from(f.contains(&n)).to_string()).join(",");
            let failure = quoted(m.failure.as_deref().unwrap_or(""));
            let errors = match m.errors(&chart.truth, region) {
                Some(e) => {
                    let (a, b) = (shown(&e.delta_e), shown(&e.radiance));
                    format!("{},{a},{b},{},{}", e.delta_e.count, e.not_finite, e.negative)
                }
                None => "0,,,,,,,,".into(),
            };
            let (ours, region) = (u8::from(m.family.is_ours()), quoted(named.name));
            out.push_str(&format!("{head},{ours},{region},{errors},{costs},{on},{failure}\n"));
        }
    }
    out
}

fn shown(d: &Distribution) -> String {
    let one = |v: f64| if v.is_finite() { digits(v).to_string() } else { "inf".into() };
    [d.median, d.p95, d.max].map(one).join(",")
}

/// A field of a CSV file.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_string() }
}

/// The points at which Monte Carlo checked the truth.
pub fn checks_csv(chart: &Chart) -> String {
    let mut out = String::from(
        "preset,region,altitude_m,mu_view,mu_sun,azimuth_deg,wavelength_nm,truth_per_sr,monte_carlo_per_sr,stderr_per_sr\n",
    );
    for c in &chart.checks {
        let view = c.view.map(|v| v.to_string()).join(",");
        let (name, region) = (quoted(&chart.planet), quoted(REGIONS[c.region].name));
        out.push_str(&format!(
            "{name},{region},{view},550,{:.6e},{:.6e},{:.2e}\n",
            c.truth, c.monte_carlo, c.stderr
        ));
    }
    out
}
