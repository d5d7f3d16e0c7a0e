//! Numbers of a kernel of two Gaussians, to be changed.

use std::ops::RangeInclusive;

use egui::{Button, DragValue, Grid, Slider, Ui};

use crate::window::artist::Artist;
use crate::window::controls::Command;

/// Standard deviations in mm.
const SIGMAS_MM: RangeInclusive<f32> = 0.01..=50.0;
const REFLECTANCES: RangeInclusive<f32> = 0.01..=1.0;
const STRENGTHS: RangeInclusive<f32> = 0.1..=5.0;

/// Lays out the numbers: those of the file, or `changed` ones, which are there from the first change on.
pub(super) fn numbers(ui: &mut Ui, of_file: Option<Artist>, changed: &mut Option<Artist>, commands: &mut Vec<Command>) {
    let Some(of_file) = of_file else {
        ui.label("A kernel, which is not made of two Gaussians");
        return;
    };
    let mut artist = changed.unwrap_or(of_file);
    Grid::new("two Gaussians").num_columns(4).show(ui, |ui| {
        ui.label("two Gaussians");
        for name in ["red", "green", "blue"] {
            ui.label(name);
        }
        ui.end_row();
        row(ui, "near (mm)", "Standard deviation of the narrow one", &mut artist.near_mm, SIGMAS_MM);
        row(ui, "far (mm)", "Standard deviation of the wide one", &mut artist.far_mm, SIGMAS_MM);
        row(ui, "w", "Share of the narrow one", &mut artist.weight, 0.0..=1.0);
        row(ui, "reflectance", "Share of the light that leaves again", &mut artist.reflectance, REFLECTANCES);
    });
    ui.add(Slider::new(&mut artist.strength, STRENGTHS).logarithmic(true).text("strength").max_decimals(2))
        .on_hover_text("Factor of all distances");
    for c in 0..3 {
        artist.far_mm[c] = artist.far_mm[c].max(artist.near_mm[c]);
    }
    if artist != changed.unwrap_or(of_file) {
        *changed = Some(artist);
    }
    ui.horizontal(|ui| {
        let is_changed = changed.is_some();
        let save = ui.add_enabled(is_changed, Button::new("Save kernel"));
        if save.on_hover_text("As a .subsurf file").clicked() {
            commands.push(Command::SaveKernel);
        }
        let undo = ui.add_enabled(is_changed, Button::new("As in the file"));
        if undo.on_hover_text("Takes all changes back").clicked() {
            *changed = None;
        }
    });
}

fn row(ui: &mut Ui, name: &str, meaning: &str, values: &mut [f32; 3], range: RangeInclusive<f32>) {
    ui.label(name).on_hover_text(meaning);
    for value in values {
        // Slower where values are small.
        let speed = 0.01 * f64::from(value.max(0.05));
        // What a file has may lie beyond what can be dragged to.
        ui.add(DragValue::new(value).range(range.clone()).clamp_existing_to_range(false).speed(speed).max_decimals(3));
    }
    ui.end_row();
}

#[cfg(test)]
mod tests {
    use egui::{Context, Event, Modifiers, PointerButton, Pos2, RawInput, Rect, Vec2, pos2};

    use super::*;

    const FILE: Artist = Artist {
        weight: [0.5; 3],
        near_mm: [0.2; 3],
        far_mm: [1.0; 3],
        reflectance: [0.6; 3],
        strength: 1.0,
        eta: 1.4,
        taps: 17,
    };

    /// Lays the numbers out with the pointer at a place, its button down or up; what was asked for.
    fn frame(context: &Context, changed: &mut Option<Artist>, at: Pos2, pressed: Option<bool>) -> Vec<Command> {
        let mut events = vec![Event::PointerMoved(at)];
        let button = |pressed| Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        events.extend(pressed.map(button));
        let screen_rect = Some(Rect::from_min_size(Pos2::ZERO, Vec2::new(400.0, 400.0)));
        let mut commands = Vec::new();
        let _ = context.run(RawInput { events, screen_rect, ..Default::default() }, |context| {
            egui::CentralPanel::default().show(context, |ui| numbers(ui, Some(FILE), changed, &mut commands));
        });
        commands
    }

    /// All places of the panel are clicked: the buttons work once something was changed, and nothing breaks what Gaussians are.
    #[test]
    fn numbers_change_and_are_saved_and_taken_back() {
        let context = Context::default();
        let (mut changed, mut saves, mut undone, mut changes) = (None, 0, 0, 0);
        for y in (8..170).step_by(9) {
            for x in (12..330).step_by(22) {
                let at = pos2(x as f32, y as f32);
                let before: Option<Artist> = changed;
                frame(&context, &mut changed, at, None);
                // A drag, and a click.
                frame(&context, &mut changed, at, Some(true));
                let aside = at + Vec2::new(9.0, 0.0);
                frame(&context, &mut changed, aside, None);
                frame(&context, &mut changed, aside, Some(false));
                changes += usize::from(changed.is_some() && changed != before);
                let before = changed;
                frame(&context, &mut changed, at, Some(true));
                let commands = frame(&context, &mut changed, at, Some(false));
                saves += commands.iter().filter(|command| **command == Command::SaveKernel).count();
                assert!(commands.is_empty() || before.is_some(), "nothing to save yet");
                undone += usize::from(before.is_some() && changed.is_none());
                if let Some(artist) = changed {
                    assert!((0..3).all(|c| artist.near_mm[c] <= artist.far_mm[c]), "{artist:?}");
                }
            }
        }
        assert!(saves > 0 && undone > 0 && changes > 10, "{saves} saved, {undone} taken back, {changes} changes");
    }
}
