//! A torus under the sun: how much of it is in shadow, and what a studio adds.
//!
//! `cargo run -p subsurf-scene --example shadow`; with the name of a mesh file, that mesh.

use std::path::Path;

use glam::Vec3;
use subsurf_scene::{Environment, Light, LightShape, Shadow, UpAxis, load_mesh, visibility};

fn main() -> subsurf_scene::Result<()> {
    let file = std::env::args().nth(1).unwrap_or_else(|| "torus".to_owned());
    // 40 mm large, around the origin; edges of at most 2 mm, so that shadows have an outline.
    let mesh = load_mesh(Path::new(&file), 40.0, UpAxis::Y)?.mesh.subdivided(2.0)?;

    let towards = Vec3::new(0.9, 0.3, 0.35);
    let sun = Light { shape: LightShape::Directional { towards }, irradiance: [3.0, 2.9, 2.7], shadow: Shadow::Drawn };
    let seen = visibility(&mesh, &[sun]);
    let hidden = seen.iter().filter(|seen| seen[0] == 0.0).count();
    println!("{file}: {} triangles, {hidden} of {} vertices in shadow", mesh.triangles.len(), seen.len());

    let studio = Environment::studio();
    for (name, normal) in [("up", Vec3::Y), ("down", Vec3::NEG_Y)] {
        println!("irradiance of the studio on what faces {name}: {:.2?}", studio.irradiance(normal));
    }
    Ok(())
}
