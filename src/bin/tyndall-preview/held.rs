//! What of a picture the tables of a window do not hold. There the shaders draw the nearest that they do hold, so that a
//! frame has no hole; the user is told.

use crate::bake::Bake;
use crate::camera::Camera;
use crate::frame::View;
use tyndall::internals::geometry::Point;

/// Rows and columns of the directions that are looked at.
const ACROSS: u32 = 7;

/// The first direction of a picture that the tables do not hold, as the key (`mu_sun`) and a line for the user.
pub fn beyond(bake: &Bake, camera: &Camera, aspect: f64) -> Option<(&'static str, String)> {
    let place = |k: u32| 2.0 * f64::from(k) / f64::from(ACROSS - 1) - 1.0;
    let places = (0..ACROSS * ACROSS).map(|k| (place(k % ACROSS), place(k / ACROSS)));
    let mut points = places.filter_map(|(x, y)| camera.direction(x, y, aspect)).map(|d| camera.point(d));
    points.find_map(|point| line(bake, &point))
}

/// Warns where [`beyond`] finds something.
pub fn warn_of(bake: &Bake, view: &View) {
    let aspect = f64::from(view.size[0]) / f64::from(view.size[1]);
    if let Some((_, text)) = beyond(bake, &view.camera, aspect) {
        warn(&text);
    }
}

/// The first of some views that the tables do not hold.
pub fn beyond_points(bake: &Bake, points: &[Point]) -> Option<String> {
    let told = |(k, point): (usize, &Point)| Some(format!("view {}, {}", k + 1, line(bake, point)?.1));
    points.iter().enumerate().find_map(told)
}

fn line(bake: &Bake, point: &Point) -> Option<(&'static str, String)> {
    let (key, value, reason) = bake.sky.outside(point)?;
    Some((key, format!("{key} = {value:.6}: {reason}; the nearest that they hold is drawn")))
}

/// A warning on standard error.
pub fn warn(text: &str) {
    tyndall::internals::machine::output::say(&format!("warning: {text}"));
}
