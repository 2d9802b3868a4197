//! The chart as a picture: a row a region, a column a cost, logarithms on all axes.
//!
//! Families differ by marker and colour (Okabe & Ito's, which the colour-blind tell apart); the front is a line.

use super::front::{Quantity, Statistic};
use super::{Cost, Measure, Row, front};
use crate::error::{Error, Result};
use crate::methods::Family;
use crate::quality::REGIONS;
use kuva::backend::{png::PngBackend, svg::SvgBackend};
use kuva::plot::scatter::MarkerShape;
use kuva::plot::{LinePlot, ScatterPlot};
use kuva::render::figure::Figure;
use kuva::render::layout::{Layout, TickFormat};
use kuva::render::plots::Plot;
use kuva::render::render::Scene;
use std::sync::Arc;

/// Marker and colour of a family.
fn style(family: Family) -> (MarkerShape, &'static str) {
    match family {
        Family::Nishita1993 => (MarkerShape::Cross, "#000000"),
        Family::Oneil2004 => (MarkerShape::Plus, "#000000"),
        Family::Schafhitzel2007 => (MarkerShape::TriangleDown, "#E69F00"),
        Family::Elek2009 => (MarkerShape::Triangle, "#CC79A7"),
        Family::Algorithm1 => (MarkerShape::Square, "#D55E00"),
        Family::Bruneton2017 => (MarkerShape::Star, "#009E73"),
        Family::Elek2010 => (MarkerShape::Diamond, "#56B4E9"),
        Family::Compact => (MarkerShape::Circle, "#0072B2"),
    }
}

/// Errors that the axis shows at least and at most; what lies beyond stands at its end.
const ERRORS: (f64, f64) = (0.01, 100.0);

/// How far inside its panel a marker stands that would lie beyond: half its width.
const INSIDE: f64 = 1.2;

/// Costs below this stand with what costs nothing: 10 ms, 10 kB, 10 ns.
const LEAST_COST: f64 = 0.01;

/// SVG text and PNG bytes of a chart's rows.
///
/// # Errors
/// `Argument` for rows that cannot be drawn.
pub fn pictures(rows: &[Row], measure: Measure) -> Result<(String, Vec<u8>)> {
    let svg = SvgBackend::new().render_scene(&scene(rows, measure));
    let png = PngBackend::new().with_scale(1.25).render_scene(&scene(rows, measure));
    let png = png.map_err(|reason| Error::Argument(format!("the chart as PNG: {reason}")))?;
    Ok((svg, png))
}

fn scene(rows: &[Row], measure: Measure) -> Scene {
    let panels =
        REGIONS.iter().flat_map(|r| Cost::ALL.map(|cost| Panel { rows, region: r.name, cost, measure }));
    let (plots, layouts) = panels.map(|p| (p.plots(), p.layout())).unzip();
    let planet = rows.first().map_or("", |r| &r.preset);
    Figure::new(REGIONS.len(), Cost::ALL.len())
        .with_title(format!(
            "{planet}: error against cost; the line is the front, what costs nothing is at the left"
        ))
        .with_title_size(18)
        .with_plots(plots)
        .with_layouts(layouts)
        .with_cell_size(430.0, 290.0)
        .with_shared_legend_bottom()
        .render()
}

struct Panel<'a> {
    rows: &'a [Row],
    region: &'static str,
    cost: Cost,
    measure: Measure,
}

impl Panel<'_> {
    /// Powers of ten around the costs of all regions; what costs nothing stands at the lower end.
    fn costs(&self) -> (f64, f64) {
        let costs =
            self.rows.iter().filter(|r| r.failure.is_empty()).map(|r| self.cost.of(r).max(LEAST_COST));
        let ends = |(low, high): (f64, f64), c: f64| (low.min(c), high.max(c));
        let (low, high) = costs.fold((f64::INFINITY, LEAST_COST), ends);
        let decade = |v: f64| libm::exp10(v);
        let low = decade(libm::floor(libm::log10(low.min(high))));
        (low, decade(libm::ceil(libm::log10(high))).max(10.0 * low))
    }

    fn at(&self, row: &Row) -> Option<(f64, f64)> {
        let error = self.measure.of(row)?.clamp(ERRORS.0 * INSIDE, ERRORS.1 / INSIDE);
        Some((self.cost.of(row).max(self.costs().0 * INSIDE), error))
    }

    fn plots(&self) -> Vec<Plot> {
        let front = front(self.rows, self.region, self.cost, self.measure);
        let line: Vec<(f64, f64)> = front.into_iter().filter_map(|r| self.at(r)).collect();
        let line = LinePlot::new().with_data(line).with_color("#888888").with_stroke_width(1.5);
        let here = || self.rows.iter().filter(|r| r.region == self.region);
        let family = |family: Family| {
            let points = here().filter(|r| r.family() == Some(family)).filter_map(|r| self.at(r));
            let (marker, colour) = style(family);
            let plot = ScatterPlot::new().with_data(points.collect::<Vec<_>>()).with_marker(marker);
            Plot::from(plot.with_color(colour).with_size(5.0).with_legend(family.title()))
        };
        std::iter::once(Plot::from(line)).chain(Family::ALL.map(family)).collect()
    }

    fn layout(&self) -> Layout {
        let statistic = match self.measure.1 {
            Statistic::Median => "median",
            Statistic::P95 => "95 % below",
            Statistic::Worst => "worst",
        };
        let quantity = match self.measure.0 {
            Quantity::DeltaE => "ΔE2000",
            Quantity::Radiance => "RGB, %",
        };
        // Shortest digits: 0.01, 1, 10000.
        let plain = TickFormat::Custom(Arc::new(|v: f64| format!("{}", (v * 1e6).round() / 1e6)));
        Layout::new(self.costs(), ERRORS)
            .with_log_scale()
            .with_title(self.region)
            .with_x_label(self.cost.label())
            .with_y_label(format!("{quantity}, {statistic}"))
            .with_tick_format(plain)
            .with_title_size(14)
            .with_label_size(13)
            .with_tick_size(11)
    }
}
