//! The chart as a picture: a row a region, a column a cost, logarithms on all axes.
//!
//! Families differ by marker and colour (Okabe & Ito's, which the colour-blind tell apart); the front is a line.

use super::{Chart, Cost, front};
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

/// Which error is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Quantity {
    DeltaE,
    Radiance,
}

/// Of how it is distributed over views.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Statistic {
    Median,
    P95,
    Worst,
}

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

/// Errors that the axis shows at most and at least.
const MOST: f64 = 200.0;

/// SVG text and PNG bytes.
pub fn pictures(chart: &Chart, quantity: Quantity, statistic: Statistic) -> Result<(String, Vec<u8>)> {
    let svg = SvgBackend::new().render_scene(&scene(chart, quantity, statistic));
    let png = PngBackend::new().with_scale(1.25).render_scene(&scene(chart, quantity, statistic));
    let png = png.map_err(|reason| Error::Argument(format!("the chart as PNG: {reason}")))?;
    Ok((svg, png))
}

fn scene(chart: &Chart, quantity: Quantity, statistic: Statistic) -> Scene {
    let (mut plots, mut layouts) = (Vec::new(), Vec::new());
    for region in 0..REGIONS.len() {
        for cost in Cost::ALL {
            let panel = Panel { chart, region, cost, quantity, statistic };
            let drawn = panel.plots();
            layouts.push(panel.layout());
            plots.push(drawn);
        }
    }
    Figure::new(REGIONS.len(), Cost::ALL.len())
        .with_title(format!("{}: error against cost; the line is the front", chart.planet))
        .with_plots(plots)
        .with_layouts(layouts)
        .with_cell_size(430.0, 300.0)
        .with_shared_legend_bottom()
        .render()
}

struct Panel<'a> {
    chart: &'a Chart,
    region: usize,
    cost: Cost,
    quantity: Quantity,
    statistic: Statistic,
}

impl Panel<'_> {
    /// Error of a method; none where it does not answer.
    fn error(&self, n: usize) -> Option<f64> {
        let errors = self.chart.methods[n].errors(&self.chart.truth, self.region)?;
        let (of, unit) = match self.quantity {
            Quantity::DeltaE => (errors.delta_e, 1.0),
            Quantity::Radiance => (errors.radiance, 100.0),
        };
        let v = match self.statistic {
            Statistic::Median => of.median,
            Statistic::P95 => of.p95,
            Statistic::Worst => of.max,
        };
        Some((unit * v).clamp(self.least_error(), MOST))
    }

    fn least_error(&self) -> f64 {
        0.01
    }

    /// What costs nothing stands at the left edge.
    fn costs(&self) -> (f64, f64) {
        let costs = self.chart.methods.iter().filter(|m| m.failure.is_none()).map(|m| self.cost.of(m));
        let (low, high) = costs
            .filter(|c| *c > 0.0)
            .fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), c| (low.min(c), high.max(c)));
        if low > high { (1.0, 10.0) } else { (0.5 * low.max(1e-3), 2.0 * high) }
    }

    fn at(&self, n: usize) -> Option<(f64, f64)> {
        let cost = self.cost.of(&self.chart.methods[n]).max(self.costs().0);
        self.error(n).map(|e| (cost, e))
    }

    fn plots(&self) -> Vec<Plot> {
        let line: Vec<(f64, f64)> =
            front(self.chart, self.region, self.cost).into_iter().filter_map(|n| self.at(n)).collect();
        let mut out: Vec<Plot> =
            vec![LinePlot::new().with_data(line).with_color("#999999").with_stroke_width(1.5).into()];
        for family in Family::ALL {
            let methods = self.chart.methods.iter().enumerate().filter(|(_, m)| m.family == family);
            let points: Vec<(f64, f64)> = methods.filter_map(|(n, _)| self.at(n)).collect();
            let (marker, colour) = style(family);
            let plot = ScatterPlot::new().with_data(points).with_marker(marker).with_color(colour).with_size(4.5);
            out.push(plot.with_legend(family.title()).into());
        }
        out
    }

    fn layout(&self) -> Layout {
        let statistic = match self.statistic {
            Statistic::Median => "median",
            Statistic::P95 => "95 % below",
            Statistic::Worst => "worst",
        };
        let quantity = match self.quantity {
            Quantity::DeltaE => "ΔE2000",
            Quantity::Radiance => "RGB, %",
        };
        Layout::new(self.costs(), (self.least_error(), MOST))
            .with_log_scale()
            .with_title(REGIONS[self.region].name)
            .with_x_label(self.cost.label())
            .with_y_label(format!("{quantity}, {statistic}"))
            .with_tick_format(TickFormat::Auto)
            .with_title_size(13)
            .with_label_size(12)
            .with_tick_size(10)
    }
}
