//! Extensions that a file requires.

use super::document::Document;
use crate::read::raw::Raw;
use crate::read::text::quoted;

/// Those that are read.
const READ: [&str; 7] = [
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "KHR_draco_mesh_compression",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_transform",
];
/// Beginnings of the names of those that change no triangle: materials, textures, lights, animations, annotations.
const NOT_DRAWN: [&str; 21] = [
    "ADOBE_materials_",
    "AGI_",
    "CESIUM_",
    "EXT_feature_metadata",
    "EXT_instance_features",
    "EXT_lights_",
    "EXT_materials_",
    "EXT_mesh_features",
    "EXT_property_",
    "EXT_structural_metadata",
    "EXT_texture_",
    "FB_materials_",
    "GODOT_",
    "KHR_animation_",
    "KHR_audio",
    "KHR_interactivity",
    "KHR_lights_",
    "KHR_materials_",
    "KHR_texture_",
    "KHR_xmp",
    "MSFT_",
];

/// Warns of required extensions that may have changed triangles.
pub(super) fn warn(document: &Document, out: &mut Raw) {
    for name in &document.extensions_required {
        let is_harmless = NOT_DRAWN.iter().any(|beginning| name.starts_with(beginning));
        if !is_harmless && !READ.contains(&name.as_str()) {
            let name = quoted(name.as_bytes());
            out.warnings.push(format!("requires the extension {name}, which is not read: the mesh may lack something"));
        }
    }
}
