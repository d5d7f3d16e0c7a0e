//! What the window leaves to the program around it.

use subsurf_runtime::Gpu;

/// Picture of all that the window shows.
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// sRGB bytes, row by row from the top.
    pub pixels: Vec<[u8; 3]>,
}

/// Program around the window: keeps pictures and hears news.
pub trait Host {
    /// Keeps a picture that the user asked for; `stem` would be a good name for it. Says where it is, for the panel.
    ///
    /// # Errors
    /// The picture cannot be kept; the panel shows why.
    fn save(&mut self, stem: &str, picture: &Picture) -> Result<String, String>;

    /// Keeps a kernel file that the user made with the panel; `stem` would be a good name for it. Says where it is.
    ///
    /// # Errors
    /// The file cannot be kept; the panel shows why.
    fn save_kernel(&mut self, stem: &str, file: &[u8]) -> Result<String, String> {
        let _ = (stem, file);
        Err("there is no place for kernels".to_owned())
    }

    /// Takes the picture that [`Config::captures`](crate::Config::captures) asks for; the window closes then.
    ///
    /// # Errors
    /// The picture cannot be kept; [`Viewer::run`](crate::Viewer::run) ends with that error.
    fn capture(&mut self, picture: &Picture, device: &str) -> Result<(), Box<dyn std::error::Error + Send + Sync>>;

    /// Hears that the device was lost and opened anew, and why.
    fn recovered(&mut self, reason: &str);

    /// Hears that a frame was shown, the first being number 1, and what drew it.
    fn presented(&mut self, frame: u32, gpu: &Gpu) {
        let _ = (frame, gpu);
    }
}
