//! Controls: what keys and the pointer mean.

use glam::Vec2;
use winit::event::{ElementState, MouseButton, MouseScrollDelta};
use winit::keyboard::{Key, NamedKey};

use crate::asset::Scattering;

/// Key, technique, name and meaning of what a translucent material can be drawn by.
pub(super) const TECHNIQUES: [(&str, Scattering, &str, &str); 5] = [
    ("1", Scattering::Splat, "splat", "Every place that the light reaches is spread over what lies around it"),
    ("2", Scattering::Separable, "separable", "Weighted irradiance maps and shared Gaussians: the fastest"),
    ("3", Scattering::Homogeneous, "homogeneous", "One mean profile everywhere; for comparison"),
    ("4", Scattering::Opaque, "opaque", "Light leaves where it enters; for comparison"),
    ("5", Scattering::Gather, "gather", "Every point gathers from all others: the reference, and slow"),
];

/// Keys and pointer of the window, in lines for a help text.
pub const KEYS: &str = "\
  drag            turn the mesh
  right drag      drag the light; shift and drag do the same
  wheel           zoom
  1 2 3 4 5       technique: splat, separable, homogeneous, opaque, gather
  N               next material
  M               next shape
  E               ten times the difference to the gather, of a BTF to its images
  C               a BTF on the left, its images on the right
  L               let the light go around
  X               choose the exposure
  R               view and light as at the beginning
  S               save what the window shows as PNG
  H               hide the panel
  Q, Esc          quit
  drop a file     a material (.subsurf) or a mesh (.obj, .ply, .stl, .off, .glb, .gltf)";

/// Request of a key or a button.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Command {
    Technique(Scattering),
    NextMaterial,
    NextShape,
    Error,
    Split,
    TurnLight,
    Expose,
    Reset,
    Save,
    /// The kernel that the panel made.
    SaveKernel,
    Hide,
    Quit,
}

/// What a key asks for, if anything.
pub(super) fn command(key: &Key) -> Option<Command> {
    if *key == Key::Named(NamedKey::Escape) {
        return Some(Command::Quit);
    }
    let text = key.to_text()?.to_lowercase();
    if let Some((_, technique, ..)) = TECHNIQUES.iter().find(|(key, ..)| *key == text) {
        return Some(Command::Technique(*technique));
    }
    Some(match text.as_str() {
        "n" => Command::NextMaterial,
        "m" => Command::NextShape,
        "e" => Command::Error,
        "c" => Command::Split,
        "l" => Command::TurnLight,
        "x" => Command::Expose,
        "r" => Command::Reset,
        "s" => Command::Save,
        "h" => Command::Hide,
        "q" => Command::Quit,
        _ => return None,
    })
}

/// Eye or light, whichever the pointer drags.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Drag {
    View,
    Light,
}

/// Pointer: where it is and what it drags.
#[derive(Debug, Default)]
pub(super) struct Pointer {
    at: Vec2,
    pub(super) drag: Option<Drag>,
    pub(super) is_shifted: bool,
}

impl Pointer {
    /// A button went down over the picture, or up anywhere.
    pub(super) fn press(&mut self, button: MouseButton, state: ElementState) {
        self.drag = match (state, button) {
            (ElementState::Released, _) => None,
            (_, MouseButton::Left) if !self.is_shifted => Some(Drag::View),
            (_, MouseButton::Left | MouseButton::Right) => Some(Drag::Light),
            _ => self.drag,
        };
    }

    /// Goes to a place in pixels; what is dragged, and how far in heights of the window.
    pub(super) fn go(&mut self, at: Vec2, height: u32) -> Option<(Drag, Vec2)> {
        #[allow(clippy::cast_precision_loss, reason = "windows are a few thousand pixels high")]
        let by = (at - self.at) / height.max(1) as f32;
        self.at = at;
        self.drag.map(|drag| (drag, by))
    }
}

/// Steps of the wheel, towards the picture.
pub(super) fn steps(delta: MouseScrollDelta) -> f32 {
    const PIXELS: f64 = 40.0;
    match delta {
        MouseScrollDelta::LineDelta(_, lines) => lines,
        #[allow(clippy::cast_possible_truncation, reason = "a few")]
        MouseScrollDelta::PixelDelta(pixels) => (pixels.y / PIXELS) as f32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_of_the_help_does_something() {
        let asked = |text: &str| command(&Key::Character(text.into()));
        for line in KEYS.lines() {
            for word in line[2..18].split([' ', ',']).filter(|word| word.len() == 1 && *word != "a") {
                assert!(asked(word).is_some(), "{word} in \"{line}\"");
            }
        }
        assert_eq!(asked("2"), Some(Command::Technique(Scattering::Separable)));
        assert_eq!(asked("S"), Some(Command::Save));
        assert_eq!(command(&Key::Named(NamedKey::Escape)), Some(Command::Quit));
        assert_eq!(asked("ß"), None);
    }

    #[test]
    fn the_right_button_and_shift_drag_the_light() {
        let mut pointer = Pointer::default();
        assert_eq!(pointer.go(Vec2::new(10.0, 10.0), 100), None);
        pointer.press(MouseButton::Left, ElementState::Pressed);
        assert_eq!(pointer.go(Vec2::new(60.0, 10.0), 100), Some((Drag::View, Vec2::new(0.5, 0.0))));
        pointer.press(MouseButton::Left, ElementState::Released);
        pointer.is_shifted = true;
        pointer.press(MouseButton::Left, ElementState::Pressed);
        assert_eq!(pointer.drag, Some(Drag::Light));
        pointer.press(MouseButton::Left, ElementState::Released);
        pointer.is_shifted = false;
        pointer.press(MouseButton::Right, ElementState::Pressed);
        assert_eq!(pointer.drag, Some(Drag::Light));
    }
}
