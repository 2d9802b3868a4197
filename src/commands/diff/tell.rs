//! Differences as text and as JSON.

use super::{Args, Found, Texels, ViewDifference};
use serde_json::{Value, json};
use std::fmt::Write;

/// The whole answer; `holds`: nothing lies beyond a tolerance.
pub(super) fn told(args: &Args, found: &Found, holds: bool) -> String {
    if args.json { format!("{:#}\n", as_json(args, found, holds)) } else { as_text(args, found) }
}

fn as_json(args: &Args, found: &Found, holds: bool) -> Value {
    let table = |t: &super::TableDifference| match &t.what {
        Texels::Same => json!({ "table": t.table, "same": true }),
        Texels::Differ(d) => json!({ "table": t.table, "same": false, "difference": d.json() }),
        Texels::Apart(why) => json!({ "table": t.table, "same": false, "reason": why }),
    };
    let view = |v: &ViewDifference| {
        json!({ "layout": v.layout, "region": v.region, "quantity": v.quantity,
            "radiance": v.radiance.json(), "delta_e_2000": v.delta_e.json() })
    };
    json!({
        "a": args.a.to_string_lossy(),
        "b": args.b.to_string_lossy(),
        "same": found.nothing() && found.changes.is_empty(),
        "holds": holds,
        "changes": found.changes,
        "tables": found.tables.iter().map(table).collect::<Vec<_>>(),
        "views": found.views.iter().map(view).collect::<Vec<_>>(),
    })
}

fn as_text(args: &Args, found: &Found) -> String {
    let mut out = format!("A: {}\nB: {}\n", args.a.display(), args.b.display());
    if found.nothing() && found.changes.is_empty() {
        return out + "no difference\n";
    }
    if !found.changes.is_empty() {
        out.push_str("\nwhat they were made from, A → B\n");
        found.changes.iter().for_each(|change| out.push_str(&format!("  {change}\n")));
    }
    out.push_str(&tables(found));
    out.push_str(&views(found));
    out
}

fn tables(found: &Found) -> String {
    let same = found.tables.iter().filter(|t| matches!(t.what, Texels::Same)).count();
    let mut out = format!("\ntables: {same} of {} are the same\n", found.tables.len());
    if same < found.tables.len() {
        let _ = writeln!(out, "  {:36} {:>9} {:>9} {:>9}", "relative", "median", "95 %", "largest");
    }
    for t in &found.tables {
        match &t.what {
            Texels::Same => {}
            Texels::Differ(d) => {
                let _ = writeln!(
                    out,
                    "  {:36} {:>9} {:>9} {:>9}",
                    t.table,
                    percent(d.median),
                    percent(d.p95),
                    percent(d.max)
                );
            }
            Texels::Apart(why) => drop(writeln!(out, "  {:36} {why}", t.table)),
        }
    }
    out
}

fn views(found: &Found) -> String {
    if found.views.is_empty() {
        return "\nviews: no layout of both can be looked up\n".into();
    }
    let mut out = String::new();
    for (k, v) in found.views.iter().enumerate() {
        if k == 0 || found.views[k - 1].layout != v.layout {
            let head = format!("\n{}, {}", v.layout, v.quantity);
            let _ = writeln!(
                out,
                "{head:39} {:>9} {:>9} {:>9}  ΔE2000: {:>7} {:>7} {:>7}",
                "median", "95 %", "largest", "median", "95 %", "largest"
            );
        }
        let (r, e) = (&v.radiance, &v.delta_e);
        let _ = writeln!(
            out,
            "  {:36} {:>9} {:>9} {:>9}  {:>15.3} {:>7.3} {:>7.3}",
            v.region,
            percent(r.median),
            percent(r.p95),
            percent(r.max),
            e.median,
            e.p95,
            e.max
        );
    }
    out
}

/// A share in per cent to three digits.
pub(super) fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0 %".into(),
        p if p < 0.001 => format!("{p:.0e} %"),
        p if p < 10.0 => format!("{p:.3} %"),
        p => format!("{p:.1} %"),
    }
}
