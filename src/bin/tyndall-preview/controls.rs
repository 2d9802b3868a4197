//! What keys do to the view.

use crate::camera::Kind;
use crate::exposure::Exposure;
use crate::frame::ToneMapping;
use crate::resources::Method;
use std::collections::BTreeSet;
use winit::keyboard::KeyCode;

/// For `--help`; the title bar holds the short form.
pub const HELP: &str = "Keys of the window:
  arrows              look around
  Page Up, Page Down  climb and sink, from the ground to orbit
  , and .             lower and raise the star
  Space               let the day run
  - and =             darker and brighter; A: find the exposure again
  Tab                 layout elek2010 or compact
  M                   tables, march, march with a 2D table (layout compact)
  T                   tone mapping
  W                   water: the next of the bake, and land again
  [ and ]             shallower and deeper water
  G, Shift+G          g of the aerosol's phase function up, down (layout elek2010)
  C                   camera: ground, orbit, fisheye
  P                   screenshot, a PNG in the current folder
  Escape              quit
A folder dropped on the window is loaded; a bake that is written anew is loaded again.";

pub const TITLE_KEYS: &str = "arrows PgUp PgDn , . Space - = A Tab M T W [ ] G C P Esc";

/// What a key press asks of the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Request {
    Nothing,
    /// Tables or method changed: pipelines have to be made again.
    SwitchLayout,
    SwitchWater,
    Rebuild,
    Screenshot,
    Quit,
}

/// The state that keys change.
#[derive(Clone, Debug, PartialEq)]
pub struct Controls {
    pub camera: crate::camera::Camera,
    pub exposure: Exposure,
    pub tone_mapping: ToneMapping,
    pub method: Method,
    pub steps: [u32; 2],
    pub g: Option<f64>,
    /// Seconds into the running day.
    pub day: Option<f64>,
    pub radii: [f64; 2],
    /// Of the water that is shown, m, and the deepest that its tables hold.
    pub depth: f64,
    pub deepest: f64,
    held: BTreeSet<KeyCode>,
}

/// A whole day of the animation, s.
const DAY: f64 = 24.0;
/// The star's highest elevation in it, degrees.
const NOON: f64 = 70.0;

impl Controls {
    pub fn new(
        view: &crate::frame::View,
        exposure: Exposure,
        method: Method,
        steps: [u32; 2],
        radii: [f64; 2],
    ) -> Self {
        Controls {
            camera: view.camera,
            exposure,
            tone_mapping: view.tone_mapping,
            method,
            steps,
            g: view.g,
            day: None,
            radii,
            depth: view.water_depth,
            deepest: 0.0,
            held: BTreeSet::new(),
        }
    }

    pub fn release(&mut self, key: KeyCode) {
        self.held.remove(&key);
    }

    /// A key goes down; `again` where it repeats.
    pub fn press(&mut self, key: KeyCode, again: bool) -> Request {
        self.held.insert(key);
        match key {
            KeyCode::Escape => return Request::Quit,
            KeyCode::KeyG => self.turn_g(),
            _ if again => {}
            KeyCode::Tab => return Request::SwitchLayout,
            KeyCode::KeyW => return Request::SwitchWater,
            KeyCode::KeyP => return Request::Screenshot,
            KeyCode::KeyM => {
                self.method = self.next_method();
                return Request::Rebuild;
            }
            KeyCode::Space => self.day = if self.day.is_some() { None } else { Some(self.time_of_day()) },
            KeyCode::KeyA => self.exposure = Exposure::Auto(0.0),
            KeyCode::KeyC => {
                self.next_camera();
                return Request::Rebuild;
            }
            KeyCode::KeyT => {
                self.tone_mapping = match self.tone_mapping {
                    ToneMapping::Paper => ToneMapping::Neutral,
                    ToneMapping::Neutral => ToneMapping::Paper,
                }
            }
            _ => {}
        }
        Request::Nothing
    }

    fn holds(&self, key: KeyCode) -> f64 {
        f64::from(u8::from(self.held.contains(&key)))
    }

    fn turn_g(&mut self) {
        let down = self.holds(KeyCode::ShiftLeft) + self.holds(KeyCode::ShiftRight) > 0.0;
        let step = if down { -0.02 } else { 0.02 };
        self.g = Some((self.g.unwrap_or(0.76) + step).clamp(-0.98, 0.98));
    }

    fn next_method(&self) -> Method {
        let [view, sun] = self.steps;
        match self.method {
            Method::Table => Method::March { view, sun },
            Method::March { sun: 0, .. } => Method::Table,
            Method::March { view, .. } => Method::March { view, sun: 0 },
        }
    }

    fn next_camera(&mut self) {
        let kind = match self.camera.kind {
            Kind::Ground => Kind::Orbit,
            Kind::Orbit => Kind::Fisheye,
            Kind::Fisheye => Kind::Ground,
        };
        let (heading, sun_elevation) = (self.camera.heading, self.camera.sun_elevation);
        self.camera = crate::camera::Camera {
            heading,
            sun_elevation,
            ..crate::camera::Camera::usual(kind, self.radii)
        };
    }

    /// When in the day of the animation the star stands where it is, before noon.
    fn time_of_day(&self) -> f64 {
        let share = (self.camera.sun_elevation / NOON).clamp(-1.0, 1.0);
        DAY * libm::asin(share) / (2.0 * std::f64::consts::PI)
    }

    /// Moves on by `dt` seconds what keys hold down and what runs by itself.
    pub fn advance(&mut self, dt: f64) {
        let axis = |up: KeyCode, down: KeyCode| self.holds(up) - self.holds(down);
        let turn = axis(KeyCode::ArrowRight, KeyCode::ArrowLeft);
        let tilt = axis(KeyCode::ArrowUp, KeyCode::ArrowDown);
        let climb = axis(KeyCode::PageUp, KeyCode::PageDown);
        let sun = axis(KeyCode::Period, KeyCode::Comma);
        let light = axis(KeyCode::Equal, KeyCode::Minus);
        let deeper = axis(KeyCode::BracketRight, KeyCode::BracketLeft);
        if self.deepest > 0.0 {
            self.depth = ((self.depth + 0.1) * libm::exp(dt * deeper) - 0.1).clamp(0.0, self.deepest);
        }
        let camera = &mut self.camera;
        let rate = dt * camera.field.min(60.0);
        camera.heading = (camera.heading + rate * turn).rem_euclid(360.0);
        camera.pitch = (camera.pitch + rate * tilt).clamp(-90.0, 90.0);
        // Equal shares of the height in equal times; the first metres by themselves.
        let highest = 60.0 * self.radii[0];
        let height = (camera.altitude + 10.0) * libm::exp(1.2 * dt * climb) - 10.0;
        camera.altitude = height.clamp(0.5, highest);
        camera.sun_elevation = (camera.sun_elevation + 12.0 * dt * sun).clamp(-90.0, 90.0);
        if let Some(day) = &mut self.day {
            *day = (*day + dt).rem_euclid(DAY);
            camera.sun_elevation = NOON * libm::sin(2.0 * std::f64::consts::PI * *day / DAY);
        }
        self.exposure = match self.exposure {
            Exposure::Auto(stops) => Exposure::Auto(stops + 2.0 * dt * light),
            Exposure::Ev100(ev) => Exposure::Ev100(ev - 2.0 * dt * light),
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use crate::frame::View;

    fn controls() -> Controls {
        let radii = [3.4e6, 3.5e6];
        let view = View {
            camera: Camera::usual(Kind::Ground, radii),
            size: [64, 36],
            exposure: 1.0,
            tone_mapping: ToneMapping::Neutral,
            horizon_mended: true,
            g: None,
            water_depth: 10.0,
        };
        Controls::new(&view, Exposure::Auto(0.0), Method::Table, [32, 8], radii)
    }

    /// Page Up held for ten seconds leaves the air; Page Down comes back to the ground, and not below it.
    #[test]
    fn page_up_climbs_to_orbit() {
        let mut c = controls();
        c.press(KeyCode::PageUp, false);
        (0..100).for_each(|_| c.advance(0.1));
        assert!(c.camera.altitude > 1e6, "{}", c.camera.altitude);
        c.release(KeyCode::PageUp);
        c.press(KeyCode::PageDown, false);
        (0..300).for_each(|_| c.advance(0.1));
        assert_eq!(c.camera.altitude, 0.5);
    }

    /// Without water its depth stays what it was; with it, brackets take it to the surface and to the deepest there is.
    #[test]
    fn brackets_change_the_depth() {
        let mut c = controls();
        c.press(KeyCode::BracketRight, false);
        c.advance(1.0);
        assert_eq!(c.depth, 10.0);
        c.deepest = 30.0;
        c.advance(0.5);
        assert!(c.depth > 10.0 && c.depth < 30.0, "{}", c.depth);
        c.advance(9.0);
        assert_eq!(c.depth, 30.0);
        c.release(KeyCode::BracketRight);
        c.press(KeyCode::BracketLeft, false);
        c.advance(20.0);
        assert_eq!(c.depth, 0.0);
    }

    /// The day starts where the star stands and brings it to its highest a quarter of a day after its rise.
    #[test]
    fn the_day_runs_from_where_the_star_is() {
        let mut c = controls();
        c.camera.sun_elevation = 0.0;
        c.press(KeyCode::Space, false);
        c.advance(1e-9);
        assert!(c.camera.sun_elevation.abs() < 1e-6);
        c.advance(DAY / 4.0);
        assert!((c.camera.sun_elevation - NOON).abs() < 1e-6);
        c.press(KeyCode::Space, false);
        c.advance(3.0);
        assert!((c.camera.sun_elevation - NOON).abs() < 1e-6, "stopped");
    }

    /// Each press of G, repeated ones too, turns g by .02 from the .76 it starts at, with Shift down; it stays below 1.
    #[test]
    fn g_is_turned_up_and_down() {
        let mut c = controls();
        (0..5).for_each(|i| assert_eq!(c.press(KeyCode::KeyG, i > 2), Request::Nothing));
        assert!((c.g.unwrap() - 0.86).abs() < 1e-9, "{:?}", c.g);
        (0..20).for_each(|_| assert_eq!(c.press(KeyCode::KeyG, true), Request::Nothing));
        assert_eq!(c.g, Some(0.98));
        c.press(KeyCode::ShiftLeft, false);
        c.press(KeyCode::KeyG, false);
        assert!((c.g.unwrap() - 0.96).abs() < 1e-9, "{:?}", c.g);
    }

    /// M goes through all three methods and back; a key that repeats switches nothing.
    #[test]
    fn methods_take_turns() {
        let mut c = controls();
        assert_eq!(c.press(KeyCode::KeyM, false), Request::Rebuild);
        assert_eq!(c.method, Method::March { view: 32, sun: 8 });
        c.press(KeyCode::KeyM, true);
        assert_eq!(c.method, Method::March { view: 32, sun: 8 });
        c.press(KeyCode::KeyM, false);
        assert_eq!(c.method, Method::March { view: 32, sun: 0 });
        c.press(KeyCode::KeyM, false);
        assert_eq!(c.method, Method::Table);
    }
}
