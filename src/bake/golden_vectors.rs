//! Golden vectors: what the look-ups of a layout answer at some views, beside its tables, so that whoever ports the
//! look-ups to another language can hold the port against them.

use crate::files::points::COLUMNS;
use crate::geometry::Point;
use crate::layout::sky::{AerosolPhase, Channels, Component, Sky};
use crate::mapping::Window;
use crate::medium::Medium;
use crate::quality::{REGIONS, Scope, views};

/// Views a region, and number of the sequence that they are of: others than the report's.
const VIEWS: usize = 12;
const SEQUENCE: u32 = 2;

/// The views: of all regions, or of the window that the tables are for.
pub(super) fn points(medium: &Medium, window: &Window) -> Vec<Point> {
    let [ground, top] = [medium.ground_radius, medium.top_radius];
    if *window != Window::WHOLE {
        let scope = Scope::of_window(window, ground, top);
        return scope.views(REGIONS.len() * VIEWS, SEQUENCE, ground, top);
    }
    REGIONS.iter().flat_map(|region| views(region, VIEWS, u64::from(SEQUENCE), ground, top)).collect()
}

/// Path, description and content of a layout's file: a CSV with the columns of points and, for each channel (a
/// wavelength, or red, green and blue), the light that the air scatters into the view and that with the ground's, 1/sr.
pub(super) fn file(layout: &str, sky: &dyn Sky, points: &[Point]) -> (String, String, Vec<u8>) {
    let channels: Vec<String> = match sky.channels() {
        Channels::Wavelengths(nm) => nm.iter().map(|w| format!("{w}nm")).collect(),
        Channels::Rgb => ["red", "green", "blue"].map(String::from).to_vec(),
    };
    let parts = [("scattering", Component::Scattering), ("total", Component::Total)];
    let names = parts.iter().flat_map(|(part, _)| channels.iter().map(move |c| format!("{part}_{c}_per_sr")));
    let mut text = COLUMNS.map(String::from).into_iter().chain(names).collect::<Vec<_>>().join(",") + "\n";
    for p in points {
        text += &format!("{},{},{},{}", p.altitude, p.mu, p.mu_s, p.azimuth_deg);
        for (_, part) in parts {
            for value in sky.radiance(p, part, AerosolPhase::Preset) {
                text += &format!(",{value:.8e}");
            }
        }
        text += "\n";
    }
    let about = "what look-ups in this layout answer, to check a port of them";
    (format!("{layout}/vectors.csv"), about.into(), text.into_bytes())
}
