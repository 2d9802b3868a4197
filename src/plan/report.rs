//! A plan as a table, as JSON, and as a command line.

use super::{Measured, Omission, Plan};
use crate::quality::digits;
use crate::transport::slab::WaterOrders;
use serde_json::{Value, json};

/// An amount of memory for people.
pub(super) fn bytes(n: usize) -> String {
    match n {
        n if n >= 1_000_000 => format!("{:.1} MB", n as f64 / 1e6),
        n if n >= 10_000 => format!("{} kB", n / 1000),
        n => format!("{:.1} kB", n as f64 / 1e3),
    }
}

impl Plan {
    /// The `tyndall bake` that makes the model.
    pub fn command(&self) -> String {
        let mut out = self.planned.model.command(&self.scene.planet);
        if let Some(waters) = &self.waters {
            let list: Vec<&str> = waters.waters.iter().map(|w| w.0.as_str()).collect();
            let depths: Vec<String> = waters.waters.iter().map(|w| w.1.to_string()).collect();
            let [depth, view, sun] = waters.size;
            out += &format!(" --waters {} --water-depths {}", list.join(","), depths.join(","));
            out += &format!(" --size water={depth}x{view}x{sun}");
            if let WaterOrders::First(n) = waters.orders {
                out += &format!(" --water-orders {n}");
            }
        }
        out
    }

    /// Two lines about the waters, and their errors.
    fn of_waters(&self) -> String {
        let (Some(waters), tolerance) = (&self.waters, &self.scene.tolerance) else { return String::new() };
        let two =
            |what: &str, of: &dyn Fn(usize) -> String| format!("  {what:34} {:>14} {:>14}\n", of(0), of(1));
        two("waters: texels", &|k| bytes(waters.bytes[k]))
            + &two("waters: error, median", &|k| tolerance.text(waters.errors[k].at(0.5)))
            + &two(&format!("waters: error, {:.1} % within", 100.0 * tolerance.share), &|k| {
                tolerance.text(waters.errors[k].at(tolerance.share))
            })
            + &two("waters: share within tolerance", &|k| {
                format!("{:.1} %", 100.0 * waters.errors[k].share_within(tolerance.most))
            })
    }

    fn all_omissions(&self) -> impl Iterator<Item = &Omission> {
        self.omissions.iter().chain(self.waters.iter().flat_map(|w| &w.omissions))
    }

    /// For people: costs, error, and a line for each omission. Times are of this machine.
    pub fn text(&self) -> String {
        let (scene, tolerance) = (&self.scene, &self.scene.tolerance);
        let mut out = format!(
            "{}: {}\n  tolerance: {} on {:.1} % of views\n\n",
            scene.name,
            scene.description,
            tolerance.text(tolerance.most),
            100.0 * tolerance.share
        );
        out += &format!("  {:34} {:>14} {:>14}\n", "", "whole tables", "planned");
        let columns = |what: &str, of: &dyn Fn(&Measured) -> String| {
            format!("  {what:34} {:>14} {:>14}\n", of(&self.full), of(&self.planned))
        };
        out += &columns("texels", &|m| bytes(m.cost.bytes));
        out += &columns("fetches, sky / with ground", &|m| {
            format!("{} / {}", m.cost.sky_fetches, m.cost.fetches)
        });
        out += &columns("processor time, light + tables", &|m| {
            format!("{:.2} + {:.2} s", m.seconds[0], m.seconds[1])
        });
        out += &columns("error, median of fresh views", &|m| tolerance.text(m.errors.at(0.5)));
        let promised = format!("error, {:.1} % of them within", 100.0 * tolerance.share);
        out += &columns(&promised, &|m| tolerance.text(m.errors.at(tolerance.share)));
        out += &columns("error, worst", &|m| tolerance.text(m.errors.at(1.0)));
        out += &columns("share within tolerance", &|m| {
            format!("{:.1} %", 100.0 * m.errors.share_within(tolerance.most))
        });
        out += &self.of_waters();
        out += &format!(
            "\n  left out ({} models measured; error: that of {:.1} % of the planner's views)\n",
            self.measured + self.waters.as_ref().map_or(0, |w| w.measured),
            100.0 * self.share
        );
        out += &self.lines(true);
        out += "\n  kept\n";
        out += &self.lines(false);
        if !self.unmet.is_empty() {
            out += "\n  the least that was tried (texels, fetches, error)\n";
            for tried in &self.front {
                let (cost, error) = (&tried.cost, tolerance.text(tried.error));
                out += &format!("  {:>10} {:>3} {error:>12}\n", bytes(cost.bytes), cost.fetches);
            }
        }
        out += &format!("\n{}\n", self.command());
        out
    }

    fn lines(&self, left_out: bool) -> String {
        let of = |o: &&Omission| o.left_out == left_out;
        let line = |o: &Omission| {
            let sizes = o.sizes.map_or(String::new(), |[from, to]| format!(" {from} to {to}"));
            let fetches = match o.saves_fetches {
                0 => String::new(),
                1 => "1 fetch".into(),
                n => format!("{n} fetches"),
            };
            let saves = if o.saves_bytes == 0 { String::new() } else { signed(o.saves_bytes) };
            let error = o.error.map(|e| self.scene.tolerance.text(e)).join(" to ");
            let what = format!("{}{sizes}", o.what);
            let worst = if o.worst_views { ", the worst views too far off" } else { "" };
            format!("  {what:58} {saves:>9} {fetches:>9}   {error}{worst}\n")
        };
        self.all_omissions().filter(of).map(line).collect()
    }

    /// For machines: the same for the same scene, tool and planet, without times.
    pub fn json(&self) -> Value {
        let tolerance = &self.scene.tolerance;
        let of = |m: &Measured| {
            let error = |share: f64| digits(m.errors.at(share));
            json!({
                "bytes": m.cost.bytes,
                "fetches_sky": m.cost.sky_fetches,
                "fetches": m.cost.fetches,
                "views": m.errors.count(),
                "error_median": error(0.5),
                "error_promised_share": error(tolerance.share),
                "error_worst": error(1.0),
                "share_within_tolerance": digits(m.errors.share_within(tolerance.most)),
            })
        };
        let tried = |t: &super::Tried| json!({ "bytes": t.cost.bytes, "fetches": t.cost.fetches, "error": digits(t.error) });
        let timeless = |text: &&String| !text.contains("processor time");
        let unmet: Vec<&String> = self.unmet.iter().filter(timeless).collect();
        let waters = self.waters.as_ref().map(|w| {
            let error = |k: usize, share: f64| digits(w.errors[k].at(share));
            let of = |k: usize| {
                json!({
                    "bytes": w.bytes[k],
                    "views": w.errors[k].count(),
                    "error_median": error(k, 0.5),
                    "error_promised_share": error(k, tolerance.share),
                    "error_worst": error(k, 1.0),
                    "share_within_tolerance": digits(w.errors[k].share_within(tolerance.most)),
                })
            };
            json!({ "whole": of(0), "planned": of(1) })
        });
        json!({
            "scene": self.scene.name,
            "planet": self.scene.planet,
            "tolerance": tolerance.text(tolerance.most),
            "share": tolerance.share,
            "holds": unmet.is_empty(),
            "unmet": unmet,
            "bake": self.command(),
            "whole": of(&self.full),
            "planned": of(&self.planned),
            "waters": waters,
            "omissions": self.all_omissions().map(Omission::json).collect::<Vec<_>>(),
            "front": self.front.iter().map(tried).collect::<Vec<_>>(),
            "models_measured": self.measured,
        })
    }
}

fn signed(saved: i64) -> String {
    let amount = bytes(saved.unsigned_abs() as usize);
    if saved < 0 { format!("-{amount}") } else { amount }
}
