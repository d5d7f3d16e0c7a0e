//! Pictures of the reference, kept beside the page: a comparison that was interrupted, or is made again, does not draw them anew.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

use serde::{Deserialize, Serialize};
use subsurf_cli::outln;
use subsurf_cli::picture::{image, write_picture};
use subsurf_scene::Mesh;

use crate::cache;

/// Picture of the reference, and the exposure that all pictures of the case have.
pub(super) struct Reference {
    pub(super) exposure: f32,
    pub(super) pixels: Vec<[u8; 3]>,
}

/// What a picture was drawn of.
#[derive(Serialize, Deserialize)]
struct Record {
    /// Hash of the material's file, the mesh and the size of the picture.
    case: u64,
    exposure: f32,
}

/// Hash of what a picture shows.
pub(super) fn case_of(material: &[u8], mesh: &Mesh, size: [u32; 2]) -> u64 {
    let mut hasher = DefaultHasher::new();
    (material, size, &mesh.triangles).hash(&mut hasher);
    let vectors = mesh.positions.iter().chain(&mesh.normals).flat_map(|vector| vector.to_array());
    let uvs = mesh.uvs.iter().flatten().flat_map(|uv| uv.to_array());
    vectors.chain(uvs).for_each(|value| value.to_bits().hash(&mut hasher));
    mesh.sides().iter().for_each(|sides| sides.0.hash(&mut hasher));
    hasher.finish()
}

/// The picture `name` in a folder if it is of this case, else what `draw` gives, which is written there.
pub(super) fn reference(
    folder: &Path,
    name: &str,
    case: u64,
    width: u32,
    draw: impl FnOnce() -> anyhow::Result<Reference>,
) -> anyhow::Result<Reference> {
    let [picture, record] = ["png", "json"].map(|extension| folder.join(format!("gather-{name}.{extension}")));
    if let Some(known) = cache::read::<Record>(&record).filter(|known| known.case == case)
        && let Ok(pixels) = image::open(&picture)
    {
        outln!("{} is kept: delete it to have it drawn again", picture.display());
        let pixels = pixels.into_rgb8().pixels().map(|pixel| pixel.0).collect();
        return Ok(Reference { exposure: known.exposure, pixels });
    }
    let drawn = draw()?;
    write_picture(&picture, &image(&drawn.pixels, width))?;
    cache::write(&record, &Record { case, exposure: drawn.exposure })?;
    Ok(drawn)
}
