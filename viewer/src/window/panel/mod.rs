//! Panel over the picture.

mod kernel;

use egui::{Color32, Context, FontId, Frame, RichText, Slider, TextStyle, Ui, Window};
use subsurf_runtime::Plan;

use super::artist::Artist;
use super::assets::Kind;
use super::controls::{Command, TECHNIQUES};
use crate::asset::Scattering;
use crate::units::human;

/// Settings that the panel changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Settings {
    pub(super) technique: Scattering,
    pub(super) material: usize,
    pub(super) roughness: f32,
    pub(super) exposure: f32,
    /// Ten times the difference to the gather, or of a BTF to its images, instead of the picture.
    pub(super) shows_error: bool,
    /// A BTF on the left, its images on the right.
    pub(super) splits: bool,
    /// Whether the light goes around.
    pub(super) turns_light: bool,
    pub(super) is_open: bool,
    /// Numbers of the kernel, once one of them was changed.
    pub(super) artist: Option<Artist>,
}

/// Facts that the panel tells.
#[derive(PartialEq)]
pub(super) struct Facts {
    pub(super) device: String,
    pub(super) kind: Kind,
    /// Whether there are images to compare a BTF with.
    pub(super) has_images: bool,
    /// Whether kernels can be made of other numbers.
    pub(super) makes_kernels: bool,
    pub(super) materials: Vec<String>,
    pub(super) mesh: String,
    pub(super) size: [u32; 2],
    /// Median of frame times in ms, and the number of frames.
    pub(super) frame_ms: Option<(f64, usize)>,
    pub(super) device_bytes: u64,
    pub(super) budget_bytes: Option<u64>,
    pub(super) model_bytes: Option<[u64; 2]>,
    pub(super) plan: Option<Plan>,
    /// What has to be waited for, in words.
    pub(super) busy: Option<String>,
    pub(super) message: Option<Message>,
}

/// Message below the facts, until the next.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Message {
    Done(String),
    Failed(String),
}

const WIDTH: f32 = 288.0;
const EXPOSURES: std::ops::RangeInclusive<f32> = 0.01..=20.0;

/// Lays the panel out; gives back what was clicked.
pub(super) fn show(context: &Context, settings: &mut Settings, facts: &Facts) -> Vec<Command> {
    let mut commands = Vec::new();
    if settings.is_open {
        context.style_mut(|style| {
            style.visuals.override_text_color = Some(Color32::from_gray(225));
            style.text_styles.insert(TextStyle::Small, FontId::proportional(11.0));
        });
        let frame = Frame::window(&context.style()).fill(Color32::from_black_alpha(200)).inner_margin(12.0);
        Window::new("subsurf view").frame(frame).fixed_pos([12.0, 12.0]).resizable(false).show(context, |ui| {
            ui.set_width(WIDTH);
            choices(ui, settings, facts, &mut commands);
            ui.separator();
            sliders(ui, settings, facts, &mut commands);
            ui.separator();
            tell(ui, facts);
        });
    }
    commands
}

fn choices(ui: &mut Ui, settings: &mut Settings, facts: &Facts, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        for (number, name) in facts.materials.iter().enumerate() {
            ui.selectable_value(&mut settings.material, number, name);
        }
    });
    ui.horizontal(|ui| {
        ui.label(format!("on {}", facts.mesh));
        if ui.small_button("next shape").on_hover_text("M; or drop a mesh onto the window").clicked() {
            commands.push(Command::NextShape);
        }
    });
    ui.separator();
    match facts.kind {
        Kind::Bssrdf => {
            for (key, technique, name, meaning) in TECHNIQUES {
                let text = format!("{key}  {name}");
                ui.selectable_value(&mut settings.technique, technique, text).on_hover_text(meaning);
            }
            ui.checkbox(&mut settings.shows_error, "10 × difference to the gather (E)")
                .on_hover_text("Of display values. The gather follows when the light is let go");
        }
        Kind::Btf if facts.has_images => {
            ui.checkbox(&mut settings.splits, "images on the right (C)")
                .on_hover_text("On the left the file, on the right the images that it was made from");
            ui.checkbox(&mut settings.shows_error, "10 × difference to the images (E)")
                .on_hover_text("Of display values, grain of the environment included");
        }
        Kind::Btf => {
            ui.label("A BTF, without images to compare it with");
        }
        Kind::Transfer => {
            ui.label("Precomputed for one mesh");
        }
        Kind::Kernel(artist) => {
            kernel::numbers(ui, artist.filter(|_| facts.makes_kernels), &mut settings.artist, commands)
        }
    }
}

fn sliders(ui: &mut Ui, settings: &mut Settings, facts: &Facts, commands: &mut Vec<Command>) {
    ui.spacing_mut().slider_width = 120.0;
    if facts.kind != Kind::Btf {
        ui.add(Slider::new(&mut settings.roughness, 0.0..=1.0).text("roughness").max_decimals(2));
    }
    ui.add(Slider::new(&mut settings.exposure, EXPOSURES).logarithmic(true).text("exposure").max_decimals(3));
    ui.checkbox(&mut settings.turns_light, "the light goes around (L)");
    ui.horizontal(|ui| {
        for (name, hint, command) in [
            ("Expose", "X: so that this picture is neither dark nor burnt out", Command::Expose),
            ("Reset", "R: view and light as at the beginning", Command::Reset),
            ("Save PNG", "S: what the window shows", Command::Save),
        ] {
            if ui.button(name).on_hover_text(hint).clicked() {
                commands.push(command);
            }
        }
    });
}

fn tell(ui: &mut Ui, facts: &Facts) {
    let small = |ui: &mut Ui, text: String| ui.label(RichText::new(text).small());
    if let Some((ms, frames)) = facts.frame_ms {
        let frames = if frames == 1 { "one frame".to_owned() } else { format!("median of {frames} frames") };
        ui.label(format!("{ms:.1} ms, {frames}"));
    }
    let budget = facts.budget_bytes.map_or_else(String::new, |bytes| format!(" of {}", human(bytes)));
    ui.label(format!("{}{budget} on the device", human(facts.device_bytes)));
    if let Some([material, mesh]) = facts.model_bytes {
        small(ui, format!("material {}, mesh {}, the rest are buffers", human(material), human(mesh)));
    }
    if let Some(plan) = &facts.plan {
        small(ui, plan_line(plan));
    }
    small(ui, format!("{} × {} pixels; {}", facts.size[0], facts.size[1], facts.device));
    small(ui, "drag: turn · right drag: light · wheel: zoom · H: hide".to_owned());
    if let Some(busy) = &facts.busy {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.label(busy);
        });
    }
    match &facts.message {
        Some(Message::Done(text)) => ui.label(text),
        Some(Message::Failed(text)) => ui.colored_label(Color32::from_rgb(255, 140, 110), text),
        None => return,
    };
}

/// What the frame's buffers are like.
fn plan_line(plan: &Plan) -> String {
    let maps = if plan.divisor > 1.0 {
        format!("maps 1/{}", (10.0 * plan.divisor).round() / 10.0)
    } else {
        "maps in full size".to_owned()
    };
    format!("plan: {maps}, light view {0} × {0}", plan.light_texels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plans_in_words() {
        let plan = Plan {
            size: [640, 480],
            light_texels: 512,
            lights: 1,
            light_columns: 1,
            divisor: 1.0,
            blur_size: [640, 480],
            has_light_levels: false,
        };
        assert_eq!(plan_line(&plan), "plan: maps in full size, light view 512 × 512");
        let coarse = Plan { divisor: 3.0, light_texels: 256, ..plan };
        assert_eq!(plan_line(&coarse), "plan: maps 1/3, light view 256 × 256");
    }
}
