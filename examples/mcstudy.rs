#[path = "../tests/common/mod.rs"]
mod common;
use std::time::Instant;
use tyndall::points::Point;
use tyndall::reference::{Settings, Tracer};
fn main() {
    let what = std::env::args().nth(1).unwrap_or_default();
    let n: u64 = std::env::args().nth(2).and_then(|s| s.parse().ok()).unwrap_or(1 << 16);
    rayon::ThreadPoolBuilder::new().num_threads(2).build_global().unwrap();
    if what == "chi" {
        for name in ["earth_clear", "mars_thin"] {
            let m = common::oracle_medium(name);
            let rows = common::oracle_rows(name);
            let t = Instant::now();
            let tr: Vec<Tracer> = (0..3).map(|w| Tracer::new(&m, w)).collect();
            println!("built {:.2} s", t.elapsed().as_secs_f64());
            let t = Instant::now();
            let a: Vec<_> = rows
                .iter()
                .map(|r| tr[r.wavelength].estimate(&r.point, &Settings { paths: n, ..Default::default() }))
                .map(|e| (e.radiance, e.stderr))
                .collect();
            println!(
                "{name} chi2/n {:.3} in {:.1} s",
                common::chi_square(&rows, &a),
                t.elapsed().as_secs_f64()
            );
            for (lo, hi) in [(0.2, 1.1), (0.03, 0.2), (-0.03, 0.03), (-0.1, -0.03)] {
                let sel: Vec<usize> = (0..rows.len())
                    .filter(|&i| rows[i].point.mu_s > lo && rows[i].point.mu_s <= hi)
                    .collect();
                let rr: Vec<_> = sel.iter().map(|&i| rows[i]).collect();
                let aa: Vec<_> = sel.iter().map(|&i| a[i]).collect();
                let rel = sel.iter().map(|&i| a[i].1 / a[i].0).fold(0.0, f64::max);
                let mut sum: Vec<f64> = sel.iter().map(|&i| a[i].0 / rows[i].radiance - 1.0).collect();
                sum.sort_by(f64::total_cmp);
                println!(
                    "  mu_s {lo}..{hi}: n {} chi2/n {:.3} own max rel {:.4}% median diff {:.2}%",
                    sel.len(),
                    common::chi_square(&rr, &aa),
                    100.0 * rel,
                    100.0 * sum[sum.len() / 2]
                );
            }
        }
        return;
    }
    let s6 = -(6f64.to_radians()).sin();
    for (name, w) in [("earth_clear", 0), ("earth_clear", 2), ("mars_thin", 1)] {
        let m = common::oracle_medium(name);
        let t = Instant::now();
        let tr = Tracer::new(&m, w);
        println!("{name} {} nm: built in {:.2} s", m.wavelengths_nm[w], t.elapsed().as_secs_f64());
        for (label, p) in [
            ("zenith, sun 45", Point { altitude: 0.0, mu: 1.0, mu_s: 0.7071, azimuth_deg: 0.0 }),
            ("horizon, sun 45, az 90", Point { altitude: 0.0, mu: 0.01, mu_s: 0.7071, azimuth_deg: 90.0 }),
            ("near sun 15 deg, 10 off", Point { altitude: 0.0, mu: 0.4226, mu_s: 0.2588, azimuth_deg: 0.0 }),
            ("space nadir, sun 45", Point { altitude: 4e5, mu: -1.0, mu_s: 0.7071, azimuth_deg: 0.0 }),
            ("8 km down, sun 15", Point { altitude: 8e3, mu: -0.17, mu_s: 0.2588, azimuth_deg: 90.0 }),
            (
                "limb from space",
                Point {
                    altitude: 4e5,
                    mu: if w == 1 { -0.4391 } else { -0.33265 },
                    mu_s: 0.2588,
                    azimuth_deg: 60.0,
                },
            ),
            ("sun 0, zenith", Point { altitude: 0.0, mu: 1.0, mu_s: 0.0, azimuth_deg: 0.0 }),
            ("sun -6, zenith", Point { altitude: 0.0, mu: 1.0, mu_s: s6, azimuth_deg: 0.0 }),
            ("sun -6, horizon to sun", Point { altitude: 0.0, mu: 0.05, mu_s: s6, azimuth_deg: 0.0 }),
            ("sun -6, horizon away", Point { altitude: 0.0, mu: 0.05, mu_s: s6, azimuth_deg: 180.0 }),
        ] {
            let t = Instant::now();
            let e = tr.estimate(&p, &Settings { paths: n, ..Default::default() });
            let s = t.elapsed().as_secs_f64() * 2.0;
            let rel = e.stderr / e.radiance;
            println!(
                "  {label:26} {:.6e} rel {:.4}%  {:.2} us/path  1 CPU s: {:.4}%  orders {:?}",
                e.radiance,
                100.0 * rel,
                1e6 * s / e.paths as f64,
                100.0 * rel * s.sqrt(),
                e.per_order
                    .iter()
                    .take(6)
                    .map(|o| format!("{:.4}±{:.4}%", o.0 / e.radiance, 100.0 * o.1 / e.radiance))
                    .collect::<Vec<_>>()
            );
        }
    }
}
