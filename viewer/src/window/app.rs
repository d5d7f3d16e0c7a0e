//! Application: events in, pictures out.

use std::sync::Arc;

use glam::Vec2;
use web_time::Instant;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoopProxy};
use winit::window::{Window, WindowId};

use super::assets::Kind;
use super::config::Config;
use super::controls::{Command, Drag, Pointer, command, steps};
use super::draw::{Overlay, Shows, Stage};
use super::event::{Event, EventKind};
use super::host::{Host, Picture};
use super::job::JobQueue;
use super::panel::{self, Message};
use super::session::Session;
use super::times::Patience;
use crate::error::{Error, Result, one_line};

/// Frames before a capture: the panel has settled, and the time is a median of several.
const FRAMES: u32 = 5;

/// Window and all that belongs to it.
pub(super) struct App<'a> {
    config: Config,
    proxy: EventLoopProxy<Event>,
    host: &'a mut dyn Host,
    session: Session,
    jobs: JobQueue,
    context: egui::Context,
    pointer: Pointer,
    opened: Option<Opened>,
    patience: Patience,
    /// Number of the device; complaints of earlier ones come late.
    number: u32,
    frames: u32,
    settled: u32,
    /// The next frame is saved.
    saves: bool,
    last: Instant,
    outcome: Result<()>,
}

/// What there is once the window is open.
struct Opened {
    window: Arc<Window>,
    input: egui_winit::State,
    stage: Stage,
}

impl<'a> App<'a> {
    pub(super) fn new(config: Config, session: Session, proxy: EventLoopProxy<Event>, host: &'a mut dyn Host) -> Self {
        let results = proxy.clone();
        let jobs = JobQueue::new(Arc::new(move |result| {
            // Where the window is closed by now, nobody wants it.
            let _ = results.send_event(Event(EventKind::Computed(result)));
        }));
        Self {
            config,
            proxy,
            host,
            session,
            jobs,
            context: egui::Context::default(),
            pointer: Pointer::default(),
            opened: None,
            patience: Patience::default(),
            number: 0,
            frames: 0,
            settled: 0,
            saves: false,
            last: Instant::now(),
            outcome: Ok(()),
        }
    }

    /// Result, once the window is closed.
    pub(super) fn outcome(self) -> Result<()> {
        self.outcome
    }

    fn end(&mut self, events: &ActiveEventLoop, outcome: Result<()>) {
        self.outcome = outcome;
        events.exit();
    }

    fn open(&mut self, events: &ActiveEventLoop) -> Result<Opened> {
        let [width, height] = self.config.size;
        let attributes =
            Window::default_attributes().with_title("subsurf view").with_inner_size(PhysicalSize::new(width, height));
        let window = events.create_window(attributes);
        let window = Arc::new(window.map_err(|error| Error::NoDisplay(format!("no window can be opened: {error}")))?);
        let stage = self.open_stage(&window)?;
        // egui's textures are for the device that they were made on: another device, another context.
        self.context = egui::Context::default();
        let side = stage.gpu.device().limits().max_texture_dimension_2d as usize;
        let (context, id) = (self.context.clone(), egui::ViewportId::ROOT);
        let input = egui_winit::State::new(context, id, events, None, Some(winit::window::Theme::Dark), Some(side));
        Ok(Opened { window, input, stage })
    }

    fn open_stage(&mut self, window: &Arc<Window>) -> Result<Stage> {
        self.number += 1;
        Stage::open(&self.config.backends, window, self.config.options, &self.proxy, self.number)
    }

    /// Opens everything anew after the device was lost.
    fn recover(&mut self, events: &ActiveEventLoop, reason: &str) {
        if !self.patience.lasts(Instant::now()) {
            let error = format!("the device was lost again and again ({reason})");
            return self.end(events, Err(subsurf_runtime::Error::Device(error).into()));
        }
        let Some(Opened { window, stage, .. }) = self.opened.take() else {
            return;
        };
        // A window has one surface at a time.
        drop(stage);
        drop(window);
        match self.open(events) {
            Ok(opened) => {
                opened.window.request_redraw();
                self.opened = Some(opened);
                self.session.changed();
                self.session.failure = None;
                self.session.message = Some(Message::Done(format!("the device was lost and opened anew ({reason})")));
                self.host.recovered(reason);
            }
            Err(error) => self.end(events, Err(Error::Lost(Box::new(error)))),
        }
    }

    fn redraw(&mut self, events: &ActiveEventLoop) {
        let Some(mut opened) = self.opened.take_if(|opened| !opened.stage.is_lost()) else {
            return;
        };
        let result = self.draw(&mut opened, events);
        let is_lost = opened.stage.is_lost();
        self.opened = Some(opened);
        // What a lost device complains of is no news.
        if is_lost {
            return;
        }
        if let Err(error) = result {
            self.end(events, Err(error));
        } else if self.config.captures
            && let Some(error) = self.session.failure.take()
        {
            self.end(events, Err(error));
        }
    }

    fn draw(&mut self, opened: &mut Opened, events: &ActiveEventLoop) -> Result<()> {
        let Opened { window, input, stage } = opened;
        let seconds = self.last.elapsed().as_secs_f32();
        self.last = Instant::now();
        let mut goes_on = self.session.pass_time(seconds.min(0.1));

        // The panel, and what it asks for.
        let (before, facts) = (self.session.settings, self.session.facts(stage, &self.jobs));
        let (context, session) = (&self.context, &mut self.session);
        let mut commands = Vec::new();
        let output = context.run(input.take_egui_input(window), |context| {
            commands.extend(panel::show(context, &mut session.settings, &facts));
        });
        session.compare(&before);
        input.handle_platform_output(window, output.platform_output);
        let overlay = Overlay {
            primitives: context.tessellate(output.shapes, output.pixels_per_point),
            pixels_per_point: output.pixels_per_point,
        };
        let (painter, gpu) = stage.painter();
        painter.receive(gpu, &output.textures_delta);

        // The picture.
        session.follow(stage, &mut self.jobs);
        session.draw(stage);
        let shows = session.shows(stage);
        stage.present(shows, &overlay, window)?;

        self.frames += 1;
        self.host.presented(self.frames, &stage.gpu);
        let is_settled = self.session.is_settled(stage);
        if self.config.captures && is_settled {
            self.settled += 1;
            (self.session.is_stale, goes_on) = (true, true);
            if self.settled > FRAMES {
                let picture = picture(stage, shows, &overlay)?;
                self.host.capture(&picture, &facts.device).map_err(Error::Host)?;
                events.exit();
            }
        }
        commands.extend(std::mem::take(&mut self.saves).then_some(Command::Save));
        for command in commands {
            match command {
                Command::Save => {
                    let saved = picture(stage, self.session.shows(stage), &overlay).map_err(|error| one_line(&error));
                    let saved = saved.and_then(|picture| self.host.save(&stem(&self.session), &picture));
                    self.session.message = Some(told(saved));
                }
                Command::SaveKernel => {
                    let saved = self.session.kernel().map_err(|error| one_line(&error));
                    let saved = saved.and_then(|file| self.host.save_kernel(&kernel_stem(&self.session), &file));
                    self.session.message = Some(told(saved));
                }
                command => self.session.obey(command, stage.canvas.size()),
            }
            goes_on = true;
        }
        // The panel was laid out before the picture was drawn: it tells what it found then.
        goes_on |= self.session.facts(stage, &self.jobs) != facts;
        stage.painter().0.forget(&output.textures_delta);
        window.set_title(&title(&self.session));

        let delay = output.viewport_output.values().map(|viewport| viewport.repaint_delay).min().unwrap_or_default();
        if goes_on || self.session.is_stale || delay.is_zero() {
            window.request_redraw();
        }
        events.set_control_flow(match Instant::now().checked_add(delay) {
            Some(then) if !delay.is_zero() => ControlFlow::WaitUntil(then),
            _ => ControlFlow::Wait,
        });
        Ok(())
    }

    fn press(&mut self, events: &ActiveEventLoop, key: &winit::keyboard::Key) {
        let Some(Opened { window, stage, .. }) = &mut self.opened else {
            return;
        };
        match command(key) {
            None => return,
            Some(Command::Quit) => return events.exit(),
            // With the panel, which is there in a frame only.
            Some(Command::Save) => self.saves = true,
            Some(command) => self.session.obey(command, stage.canvas.size()),
        }
        window.request_redraw();
    }
}

/// Picture of all that the window shows.
fn picture(stage: &mut Stage, shows: Shows, overlay: &Overlay) -> Result<Picture> {
    Ok(Picture { size: stage.canvas.size(), pixels: stage.capture(shows, overlay)? })
}

/// Message of what was saved, or why not.
fn told(saved: std::result::Result<String, String>) -> Message {
    match saved {
        Ok(place) => Message::Done(format!("saved {place}")),
        Err(reason) => Message::Failed(reason),
    }
}

/// Name of a kernel that the panel made.
fn kernel_stem(session: &Session) -> String {
    format!("{}-artist", session.assets.materials[session.settings.material].name())
}

/// Name of a picture: material, mesh and technique.
fn stem(session: &Session) -> String {
    let material = &session.assets.materials[session.settings.material];
    let technique = match material.kind() {
        Kind::Bssrdf => format!("{:?}", session.settings.technique),
        Kind::Btf => "btf".to_owned(),
        Kind::Kernel(_) => "kernel".to_owned(),
        Kind::Transfer => "transfer".to_owned(),
    };
    format!("{}-{}-{technique}", material.name(), session.assets.mesh_name).to_lowercase()
}

fn title(session: &Session) -> String {
    let material = &session.assets.materials[session.settings.material];
    format!("{} on {} – subsurf view", material.name(), session.assets.mesh_name)
}

impl ApplicationHandler<Event> for App<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.opened.is_some() {
            return;
        }
        match self.open(events) {
            Ok(opened) => {
                opened.window.request_redraw();
                self.opened = Some(opened);
            }
            Err(error) => self.end(events, Err(error)),
        }
    }

    fn new_events(&mut self, _: &ActiveEventLoop, cause: StartCause) {
        if let (StartCause::ResumeTimeReached { .. }, Some(opened)) = (cause, &self.opened) {
            opened.window.request_redraw();
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, event: Event) {
        match event.0 {
            EventKind::Computed(result) => self.session.receive(result, &mut self.jobs),
            EventKind::DeviceError(reason) => self.session.fail(subsurf_runtime::Error::Device(reason).into()),
            EventKind::DeviceLost { number, reason } if number == self.number => self.recover(events, &reason),
            EventKind::DeviceLost { .. } => return,
        }
        if let Some(opened) = &self.opened {
            opened.window.request_redraw();
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(Opened { window, input, stage }) = &mut self.opened else {
            return;
        };
        let response = input.on_window_event(window, &event);
        if response.repaint {
            window.request_redraw();
        }
        let size = stage.canvas.size();
        match event {
            WindowEvent::RedrawRequested => return self.redraw(events),
            WindowEvent::CloseRequested => return events.exit(),
            WindowEvent::Resized(to) if to.width > 0 && to.height > 0 => {
                if let Err(error) = stage.canvas.resize(&stage.gpu, [to.width, to.height]) {
                    self.session.fail(error);
                }
                self.session.changed();
            }
            WindowEvent::ModifiersChanged(modifiers) => self.pointer.is_shifted = modifiers.state().shift_key(),
            WindowEvent::DroppedFile(path) => self.session.open(&path, size),
            WindowEvent::KeyboardInput { event, .. } => {
                if event.state == ElementState::Pressed && !event.repeat && !self.context.wants_keyboard_input() {
                    self.press(events, &event.logical_key);
                }
                return;
            }
            WindowEvent::MouseInput { state, button, .. } => {
                if state == ElementState::Released || !response.consumed {
                    self.pointer.press(button, state);
                }
                if self.pointer.drag.is_none() {
                    self.session.rest();
                }
            }
            WindowEvent::CursorMoved { position, .. } => {
                #[allow(clippy::cast_possible_truncation, reason = "pixels of a window")]
                let at = Vec2::new(position.x as f32, position.y as f32);
                match self.pointer.go(at, size[1]) {
                    Some((drag @ (Drag::View | Drag::Light), by)) => self.session.drag(drag, by),
                    None => return,
                }
            }
            WindowEvent::MouseWheel { delta, .. } if !response.consumed => {
                self.session.state.zoom(steps(delta));
                self.session.is_stale = true;
            }
            _ => return,
        }
        window.request_redraw();
    }
}
