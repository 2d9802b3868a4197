//! Which methods no other beats in both cost and error.

use super::Row;

/// What a method costs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    Preparation,
    Bytes,
    LookUp,
}

impl Cost {
    pub const ALL: [Cost; 3] = [Cost::Preparation, Cost::Bytes, Cost::LookUp];

    /// In s, MB and µs.
    pub fn of(self, row: &Row) -> f64 {
        match self {
            Cost::Preparation => row.preparation_cpu_s,
            Cost::Bytes => 1e-6 * row.table_bytes,
            Cost::LookUp => 1e-3 * row.look_up_ns,
        }
    }

    /// For axes.
    pub fn label(self) -> &'static str {
        match self {
            Cost::Preparation => "preparation, CPU s",
            Cost::Bytes => "tables, MB",
            Cost::LookUp => "look-up, CPU µs",
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Cost::Preparation => "preparation",
            Cost::Bytes => "bytes",
            Cost::LookUp => "look-up",
        }
    }
}

/// Which error is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Quantity {
    DeltaE,
    Radiance,
}

/// Of how it is distributed over views.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Statistic {
    Median,
    P95,
    Worst,
}

/// An error of a row: ΔE2000, or relative RGB in per cent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measure(pub Quantity, pub Statistic);

impl Measure {
    /// The one that fronts are told of by default.
    pub const DEFAULT: Measure = Measure(Quantity::DeltaE, Statistic::P95);

    /// None where the method does not answer, or answers what is no number.
    pub fn of(self, row: &Row) -> Option<f64> {
        let [median, p95, worst] = match self.0 {
            Quantity::DeltaE => [row.delta_e_median, row.delta_e_p95, row.delta_e_worst],
            Quantity::Radiance => [row.radiance_median, row.radiance_p95, row.radiance_worst],
        };
        let value = match self.1 {
            Statistic::Median => median,
            Statistic::P95 => p95,
            Statistic::Worst => worst,
        };
        let unit = if self.0 == Quantity::Radiance { 100.0 } else { 1.0 };
        value.map(|v| unit * v).filter(|v| v.is_finite())
    }
}

/// Rows on the front of a region, from the cheapest: each is more accurate than all that cost no more.
pub fn front<'a>(rows: &'a [Row], region: &str, cost: Cost, measure: Measure) -> Vec<&'a Row> {
    let mut points: Vec<(f64, f64, &Row)> = (rows.iter().filter(|r| r.region == region))
        .filter_map(|r| Some((cost.of(r), measure.of(r)?, r)))
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut best = f64::INFINITY;
    let mut out = Vec::new();
    for (_, error, row) in points {
        if error < best {
            best = error;
            out.push(row);
        }
    }
    out
}

/// Marks the rows on the fronts of the default measure.
pub fn mark(rows: &mut [Row]) {
    let all = rows.to_vec();
    for row in rows {
        let on = |cost| {
            let front = front(&all, &row.region, cost, Measure::DEFAULT);
            u8::from(front.iter().any(|r| r.name() == row.name()))
        };
        [row.front_preparation, row.front_bytes, row.front_look_up] = Cost::ALL.map(on);
    }
}

/// Costs this much apart are alike: what times of one run differ by from those of the next.
const ALIKE: f64 = 1.15;

/// Rows of others that none of ours beats or equals in both cost and error.
pub fn exceptions<'a>(rows: &'a [Row], region: &str, cost: Cost) -> Vec<&'a Row> {
    let here: Vec<&Row> = rows.iter().filter(|r| r.region == region).collect();
    let beaten = |r: &Row, error: f64| {
        let better = |o: &&&Row| {
            let enough = Measure::DEFAULT.of(o).is_some_and(|e| e <= error);
            o.ours == 1 && cost.of(o) <= ALIKE * cost.of(r) && enough
        };
        here.iter().find(better).is_some()
    };
    here.iter()
        .copied()
        .filter(|r| r.ours == 0 && Measure::DEFAULT.of(r).is_some_and(|e| !beaten(r, e)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(setting: &str, ours: u8, cost: f64, error: Option<f64>) -> Row {
        Row {
            preset: "p".into(),
            family: "f".into(),
            setting: setting.into(),
            ours,
            region: "r".into(),
            views: 1,
            delta_e_median: error,
            delta_e_p95: error,
            delta_e_worst: error,
            radiance_median: error,
            radiance_p95: error,
            radiance_worst: error,
            not_finite: Some(0),
            negative: Some(0),
            preparation_cpu_s: cost,
            table_bytes: 1.0,
            fetches: 1.0,
            look_up_ns: 1.0,
            front_preparation: 0,
            front_bytes: 0,
            front_look_up: 0,
            failure: String::new(),
        }
    }

    /// Cheap and rough, dear and fine lie on the front; what is dearer and no finer does not, nor what does not answer
    /// or answers no number.
    #[test]
    fn a_front_is_what_nothing_beats() {
        let rows = [
            row("fine", 1, 9.0, Some(0.5)),
            row("rough", 0, 1.0, Some(4.0)),
            row("beaten", 0, 2.0, Some(4.0)),
            row("silent", 0, 0.1, None),
            row("no number", 0, 0.2, Some(f64::INFINITY)),
        ];
        let names: Vec<_> = front(&rows, "r", Cost::Preparation, Measure::DEFAULT)
            .iter()
            .map(|r| r.setting.clone())
            .collect();
        assert_eq!(names, ["rough", "fine"]);
        assert!(front(&rows, "elsewhere", Cost::Bytes, Measure::DEFAULT).is_empty());
    }

    /// Of the others only the cheaper ones are exceptions: ours costs 9 and errs by 0.5, so what costs 10 and errs by 1 is
    /// dominated, and so is what costs 8.5, which a clock cannot tell from 9.
    #[test]
    fn exceptions_are_what_ours_does_not_beat() {
        let rows = [
            row("ours", 1, 9.0, Some(0.5)),
            row("cheap", 0, 1.0, Some(4.0)),
            row("dear", 0, 10.0, Some(1.0)),
            row("alike", 0, 8.5, Some(1.0)),
            row("finer", 0, 90.0, Some(0.1)),
        ];
        let names: Vec<_> =
            exceptions(&rows, "r", Cost::Preparation).iter().map(|r| r.setting.clone()).collect();
        assert_eq!(names, ["cheap", "finer"]);
    }

    /// What is written is read back, infinities and gaps included.
    #[test]
    fn rows_survive_their_csv() {
        let mut rows = vec![
            row("a, b", 1, 0.25, Some(f64::INFINITY)),
            Row { failure: "why: \"so\"".into(), ..row("c", 0, 1.0, None) },
        ];
        mark(&mut rows);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.csv");
        std::fs::write(&path, super::super::to_csv(&rows).unwrap()).unwrap();
        assert_eq!(super::super::read_csv(&path).unwrap(), rows);
    }
}
