//! Viewer: opens its files, then its window.

use winit::event_loop::EventLoop;

use super::app::App;
use super::config::Config;
use super::event::Event;
use super::host::Host;
use super::session::Session;
use crate::error::{Error, Result};

/// Window that is about to open: its files are read and found to be in order.
pub struct Viewer {
    config: Config,
    session: Session,
}

impl Viewer {
    /// Reads materials and mesh.
    ///
    /// # Errors
    /// A file cannot be read or drawn, or the extent is not a positive length.
    pub fn open(config: Config) -> Result<Self> {
        let session = Session::new(&config)?;
        Ok(Self { config, session })
    }

    /// Shows the window until it is closed.
    ///
    /// # Errors
    /// [`Error::NoDisplay`] if no window can be opened, [`Error::Runtime`] if no device draws to it. With
    /// [`Config::captures`], whatever keeps the picture from being drawn.
    pub fn run(self, events: EventLoop<Event>, host: &mut dyn Host) -> Result<()> {
        let mut app = App::new(self.config, self.session, events.create_proxy(), host);
        events.run_app(&mut app).map_err(|error| Error::NoDisplay(format!("the display failed: {error}")))?;
        app.outcome()
    }
}

/// Connects to the display, from the main thread. Platforms that have to be told more build an event loop themselves.
///
/// # Errors
/// [`Error::NoDisplay`].
pub fn event_loop() -> Result<EventLoop<Event>> {
    EventLoop::<Event>::with_user_event().build().map_err(|error| {
        // Where in winit it happened helps nobody.
        let text = error.to_string();
        let reason = text.rsplit(": ").next().unwrap_or(&text).trim_end_matches('.');
        Error::NoDisplay(format!("no display to open a window on ({reason})"))
    })
}
