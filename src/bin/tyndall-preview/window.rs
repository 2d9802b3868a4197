//! The window: events to controls, controls to frames.

use crate::bake::{Bake, Layout};
use crate::camera::{Camera, Kind};
use crate::controls::{Controls, Request, TITLE_KEYS};
use crate::exposure::{self, Exposure, factor};
use crate::frame::{FrameUniform, View};
use crate::gpu::{Gpu, failed, line};
use crate::headless::{pixels, write_rgba};
use crate::held;
use crate::options::Options;
use crate::painter::{Look, Painter};
use crate::resources::Method;
use crate::screen::Screen;
use crate::target::SHOWN;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime};
use tyndall::internals::files::manifest::MANIFEST;
use tyndall::internals::machine::output::{print, say};
use tyndall::{Error, Result};
use winit::application::ApplicationHandler;
use winit::error::EventLoopError;
use winit::event::{ElementState, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::keyboard::PhysicalKey;
use winit::window::{Window, WindowId};

/// Shows the bake until the window is closed.
///
/// # Errors
/// `Machine` where there is no display, no GPU, or the GPU is lost.
pub fn run(options: &Options, bake: Bake) -> Result<()> {
    let events = EventLoop::new().map_err(no_display)?;
    events.set_control_flow(ControlFlow::Poll);
    let view = options.view(&bake)?;
    let method = options.method(&bake)?;
    let mut controls = Controls::new(&view, options.exposure, method, options.steps, bake.radii());
    controls.deepest = deepest(&bake);
    let mut app = App {
        hand_filtered: options.hand_filtered,
        lose_device: options.lose_device,
        relief: options.relief,
        size: options.size,
        written: written(&bake.folder),
        bake,
        controls,
        shown: None,
        clock: Instant::now(),
        titled: None,
        exposed: None,
        looked: Instant::now(),
        shots: 0,
        beyond: None,
        failure: None,
    };
    events.run_app(&mut app).map_err(failed)?;
    app.failure.map_or(Ok(()), Err)
}

/// Without a display there can be no window.
fn no_display(reason: EventLoopError) -> Error {
    let reason = format!("no window: {}; --headless --out PNG needs no display", line(reason));
    Error::machine("display", std::io::Error::other(reason))
}

/// The window and what draws into it.
struct Shown {
    window: Arc<Window>,
    screen: Screen,
    gpu: Gpu,
    painter: Painter,
}

struct App {
    hand_filtered: bool,
    lose_device: bool,
    relief: bool,
    size: [u32; 2],
    bake: Bake,
    controls: Controls,
    shown: Option<Shown>,
    /// Of the last frame.
    clock: Instant,
    /// When the title was last written.
    titled: Option<Instant>,
    /// What the last exposure was found for, and what it was.
    exposed: Option<((Exposure, Camera, f64, f64), f64)>,
    /// When the bake's file was last looked at, and when it had been written.
    looked: Instant,
    written: Option<SystemTime>,
    shots: u32,
    /// What the tables did not hold of the last frame, told once.
    beyond: Option<&'static str>,
    failure: Option<Error>,
}

/// The deepest water that can be shown, m; 0 of land.
fn deepest(bake: &Bake) -> f64 {
    bake.water.as_ref().map_or(0.0, |w| w.sky.largest_depth)
}

fn written(folder: &Path) -> Option<SystemTime> {
    let file = if folder.is_dir() { folder.join(MANIFEST) } else { folder.to_path_buf() };
    std::fs::metadata(file).ok()?.modified().ok()
}

impl App {
    fn look(&self, format: wgpu::TextureFormat, size: [u32; 2]) -> Look {
        let relief = self.relief && self.controls.camera.kind == Kind::Ground && !size.contains(&0);
        let (method, hand_filtered) = (self.controls.method, self.hand_filtered);
        Look { method, hand_filtered, format, relief: relief.then_some(size) }
    }

    fn open_window(&mut self, events: &ActiveEventLoop) -> Result<Shown> {
        let [width, height] = self.size;
        let attributes = Window::default_attributes()
            .with_title("tyndall-preview")
            .with_inner_size(winit::dpi::PhysicalSize::new(width, height));
        let window = Arc::new(events.create_window(attributes).map_err(failed)?);
        let (gpu, screen) = Screen::new(window.clone())?;
        let painter = Painter::new(&gpu, &self.bake, &self.look(screen.format(), screen.size()))?;
        gpu.check()?;
        Ok(Shown { window, screen, gpu, painter })
    }

    fn rebuild(&mut self) -> Result<()> {
        // A layout that cannot march shows its tables.
        if self.bake.layout != Layout::Compact {
            self.controls.method = Method::Table;
        }
        if let Some(mut shown) = self.shown.take() {
            let look = self.look(shown.screen.format(), shown.screen.size());
            let made = Painter::new(&shown.gpu, &self.bake, &look);
            let made = made.map(|painter| shown.painter = painter);
            self.shown = Some(shown);
            made?;
        }
        Ok(())
    }

    /// Another bake or layout; what cannot be read leaves the one that is shown, with a line on stderr.
    fn load(&mut self, folder: &Path, layout: Option<Layout>) {
        // What is written from here on is loaded again.
        let seen = written(folder);
        // The water of before, where the new bake has it too.
        let water = self.bake.water.as_ref().map(|w| w.name.clone());
        let opened = Bake::open(folder, layout).and_then(|bake| {
            let kept = water.filter(|name| bake.waters().any(|w| w == name));
            bake.with_water(kept.as_deref())
        });
        self.show(opened);
        // A folder that was refused is not watched.
        if self.bake.folder == folder {
            self.written = seen;
        }
    }

    fn show(&mut self, opened: Result<Bake>) {
        let outcome = opened.and_then(|bake| {
            let before = std::mem::replace(&mut self.bake, bake);
            self.exposed = None;
            self.rebuild().inspect_err(|_| self.bake = before)
        });
        self.controls.radii = self.bake.radii();
        self.controls.deepest = deepest(&self.bake);
        if self.bake.water.is_some() {
            self.controls.depth = self.controls.depth.min(self.controls.deepest);
        }
        if let Err(error) = outcome {
            say(&format!("error: {error}"));
        }
    }

    /// The next water of the bake; after the last, land.
    fn switch_water(&mut self) {
        let shown = self.bake.water.as_ref().map(|w| w.name.as_str());
        let next = match shown {
            None => self.bake.waters().next(),
            Some(name) => self.bake.waters().skip_while(|w| *w != name).nth(1),
        };
        if next.is_none() && shown.is_none() {
            say("no waters in this bake (tyndall bake PRESET --waters NAME)");
            return;
        }
        let next = next.map(str::to_string);
        let opened = Bake::open(&self.bake.folder, Some(self.bake.layout));
        self.show(opened.and_then(|bake| bake.with_water(next.as_deref())));
    }

    fn reload_if_written(&mut self) {
        if self.looked.elapsed() < Duration::from_millis(500) {
            return;
        }
        self.looked = Instant::now();
        let now = written(&self.bake.folder);
        if now.is_some() && now != self.written {
            let folder = self.bake.folder.clone();
            let has = |m: &tyndall::internals::files::manifest::Manifest| {
                m.tables.iter().any(|t| t.layout == self.bake.layout.name())
            };
            let layout = tyndall::internals::files::manifest::Manifest::read(&folder).ok().filter(has);
            let layout = layout.map(|_| self.bake.layout);
            self.load(&folder, layout);
        }
    }

    /// What 1 cd/m² becomes, found anew where something has changed.
    fn exposure(&mut self, aspect: f64) -> f64 {
        let c = &self.controls;
        let wanted = (c.exposure, c.camera, aspect, c.depth);
        match self.exposed {
            Some((found_for, exposure)) if found_for == wanted => exposure,
            _ => {
                let exposure = factor(c.exposure, &self.bake, &c.camera, aspect, c.depth);
                self.exposed = Some((wanted, exposure));
                exposure
            }
        }
    }

    /// Warns where the view leaves what the tables hold, once until it is back.
    fn tell_beyond(&mut self, view: &View) {
        let aspect = f64::from(view.size[0]) / f64::from(view.size[1]);
        let found = held::beyond(&self.bake, &view.camera, aspect);
        if let Some((key, text)) = &found
            && self.beyond != Some(*key)
        {
            held::warn(text);
        }
        self.beyond = found.map(|(key, _)| key);
    }

    fn view(&mut self, size: [u32; 2]) -> View {
        let exposure = self.exposure(f64::from(size[0]) / f64::from(size[1]));
        let c = &self.controls;
        let g = c.g.filter(|_| self.bake.layout == Layout::Elek2010);
        let (tone_mapping, water_depth) = (c.tone_mapping, c.depth);
        View { camera: c.camera, size, exposure, tone_mapping, horizon_mended: true, g, water_depth }
    }

    /// The title, some times a second: servers take long over it.
    fn new_title(&mut self, view: &View, dt: f64) -> Option<String> {
        if self.titled.is_some_and(|t| t.elapsed() < Duration::from_millis(200)) {
            return None;
        }
        self.titled = Some(Instant::now());
        Some(self.title(view, 1.0 / dt.max(1e-3)))
    }

    fn title(&self, view: &View, fps: f64) -> String {
        let camera = &view.camera;
        let method = match self.controls.method {
            Method::Table => "tables",
            Method::March { sun: 0, .. } => "march, 2D table",
            Method::March { .. } => "march",
        };
        let water = self.bake.water.as_ref();
        let water =
            water.map_or(String::new(), |w| format!(", {} {:.1} m deep", w.name, self.controls.depth));
        let g = view.g.map_or(String::new(), |g| format!(", g {g:.2}"));
        format!(
            "{} {} {method}{water}{g} | {:.0} m, star {:.1}°, EV {:.1} | {fps:.0}/s | {TITLE_KEYS}",
            self.bake.manifest.preset.name,
            self.bake.layout.name(),
            camera.altitude,
            camera.sun_elevation,
            exposure::ev100(view.exposure),
        )
    }

    fn frame(&mut self) -> Result<()> {
        let dt = self.clock.elapsed().as_secs_f64();
        self.clock = Instant::now();
        self.controls.advance(dt.min(0.2));
        self.reload_if_written();
        let Some(size) = self.shown.as_ref().map(|s| s.screen.size()) else { return Ok(()) };
        // A window of no size shows nothing.
        if size.contains(&0) {
            std::thread::sleep(Duration::from_millis(50));
            return Ok(());
        }
        let view = self.view(size);
        let title = self.new_title(&view, dt);
        if title.is_some() {
            self.tell_beyond(&view);
        }
        let uniform = FrameUniform::new(&self.bake, &view);
        let bake = &self.bake;
        let Some(shown) = &mut self.shown else { return Ok(()) };
        if let Some(title) = title {
            shown.window.set_title(&title);
        }
        let Shown { gpu, painter, .. } = &*shown;
        shown.screen.show(gpu, |encoder, target| painter.draw(gpu, bake, encoder, target, &uniform))?;
        if self.lose_device {
            shown.gpu.device.destroy();
        }
        shown.gpu.check()
    }

    fn screenshot(&mut self) -> Result<()> {
        let Some(size) = self.shown.as_ref().map(|s| s.screen.size()).filter(|s| !s.contains(&0)) else {
            return Ok(());
        };
        let view = self.view(size);
        let Some(shown) = &self.shown else { return Ok(()) };
        let bytes = pixels(&shown.gpu, &self.bake, &view, &self.look(SHOWN, size))?;
        let mut path = PathBuf::new();
        while path.as_os_str().is_empty() || path.exists() {
            self.shots += 1;
            path = PathBuf::from(format!("preview-{:03}.png", self.shots));
        }
        write_rgba(&path, size, &bytes)?;
        print(&format!("{}\n", path.display()))
    }

    fn request(&mut self, request: Request, events: &ActiveEventLoop) -> Result<()> {
        match request {
            Request::Nothing => Ok(()),
            Request::Rebuild => self.rebuild(),
            Request::Screenshot => self.screenshot(),
            Request::SwitchLayout => {
                let folder = self.bake.folder.clone();
                self.load(&folder, Some(self.bake.layout.other()));
                Ok(())
            }
            Request::SwitchWater => {
                self.switch_water();
                Ok(())
            }
            Request::Quit => {
                events.exit();
                Ok(())
            }
        }
    }

    fn event(&mut self, event: WindowEvent, events: &ActiveEventLoop) -> Result<()> {
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::DroppedFile(path) => self.load(&path, None),
            WindowEvent::Resized(size) => {
                if let Some(shown) = &mut self.shown {
                    shown.screen.resize(&shown.gpu, [size.width, size.height]);
                }
                if self.relief {
                    return self.rebuild();
                }
            }
            WindowEvent::KeyboardInput { event, is_synthetic, .. } => {
                if let PhysicalKey::Code(key) = event.physical_key {
                    match event.state {
                        // Keys that are down as the window gets the focus; on X11 the press itself may come after.
                        ElementState::Pressed if is_synthetic => {}
                        ElementState::Released => self.controls.release(key),
                        ElementState::Pressed => {
                            let request = self.controls.press(key, event.repeat);
                            return self.request(request, events);
                        }
                    }
                }
            }
            WindowEvent::RedrawRequested => return self.frame(),
            _ => {}
        }
        Ok(())
    }

    /// The first failure closes the window; `run` then returns it.
    fn end_on(&mut self, outcome: Result<()>, events: &ActiveEventLoop) {
        if let Err(error) = outcome {
            self.failure.get_or_insert(error);
            events.exit();
        }
    }
}

impl ApplicationHandler for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.shown.is_none() {
            let opened = self.open_window(events).map(|shown| self.shown = Some(shown));
            self.end_on(opened, events);
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let outcome = self.event(event, events);
        self.end_on(outcome, events);
    }

    fn about_to_wait(&mut self, _: &ActiveEventLoop) {
        if let Some(shown) = &self.shown {
            shown.window.request_redraw();
        }
    }
}
