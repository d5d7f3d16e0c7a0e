//! A mesh made of a BTF, and the images that it was made from beside it.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use glam::{Vec2, Vec3, Vec4};
use image::RgbImage;
use serde_json::{Map, Value, json};
use subsurf_decoder::Btf;
use subsurf_encoder::btf::{Folder, Images};
use subsurf_runtime::{
    BACKGROUND, BtfFiltering, BtfImages, BtfMaterial, BtfOptions, Gpu, GpuMesh, RuntimeOptions, VertexData,
};
use subsurf_scene::{MAX_LIGHTS, Mesh, Placement, REFLECTION_SIZE, Scene, visibility};
use subsurf_shaders::{cpu, uniform};

use super::mesh::{SUPERSAMPLING, Shot, average_down, exposure_of};
use super::prepared::{Prepared, Ready};
use crate::failure::bad_request;
use crate::info::material_number;
use crate::picture::montage;
use crate::progress::Bars;

/// How BTFs lie on meshes and how they are looked up.
#[derive(clap::Args, Clone, Debug, Default)]
#[command(next_help_heading = "Bidirectional texture functions")]
pub(crate) struct BtfArgs {
    /// Copies of the material along u and v of the mesh's texture coordinates; so many that a copy is a fifth of the
    /// mesh's longest side if not given
    #[arg(long, value_name = "N|U,V")]
    pub(crate) repeat: Option<Copies>,
    /// Which material of a file that has several: its name, or its number from 0
    #[arg(long, value_name = "NAME|N")]
    pub(crate) material: Option<String>,
    /// Importance samples of the environment for every pixel: more of them, less grain; 0 leaves it out
    #[arg(long, value_name = "N")]
    pub(crate) samples: Option<u32>,
    /// Which texels a pixel shows; trilinear if not given
    #[arg(long, value_enum)]
    pub(crate) filter: Option<FilterArg>,
    /// The folder of images that the file was made from: drawn uncompressed beside it
    #[arg(long, value_name = "FOLDER")]
    pub(crate) images: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum FilterArg {
    /// The nearest one: the fastest
    Nearest,
    /// Four, linearly
    Bilinear,
    /// Four of each of the two nearest mipmap levels, where the file has several
    Trilinear,
}

/// Copies of a material along u and v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Copies([f32; 2]);

impl FromStr for Copies {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (u, v) = text.split_once(',').unwrap_or((text, text));
        match (u.trim().parse(), v.trim().parse()) {
            (Ok(u), Ok(v)) if [u, v].iter().all(|n: &f32| n.is_finite() && *n > 0.0 && *n <= 10_000.0) => {
                Ok(Self([u, v]))
            }
            _ => Err("expected a number of copies, or two for u and v, such as 4 or 6,2".to_owned()),
        }
    }
}

/// Most samples of the environment for a pixel.
const MAX_SAMPLES: u32 = 1_024;

impl BtfArgs {
    /// Refuses what cannot be drawn.
    pub(crate) fn check(&self) -> anyhow::Result<()> {
        match self.samples {
            Some(samples) if samples > MAX_SAMPLES => {
                Err(bad_request(format!("--samples is {samples}; at most {MAX_SAMPLES} are drawn")))
            }
            _ => Ok(()),
        }
    }

    /// Refuses options that say nothing to a material that is no BTF.
    pub(crate) fn expect_none(&self) -> anyhow::Result<()> {
        let given = [
            ("--repeat", self.repeat.is_some()),
            ("--material", self.material.is_some()),
            ("--samples", self.samples.is_some()),
            ("--filter", self.filter.is_some()),
            ("--images", self.images.is_some()),
        ];
        match given.iter().find(|(_, is_given)| *is_given) {
            Some((name, _)) => Err(bad_request(format!("{name} is for BTFs; this file is a translucent material"))),
            None => Ok(()),
        }
    }

    pub(crate) fn options(&self, usual: BtfOptions) -> BtfOptions {
        BtfOptions {
            filtering: match self.filter {
                None => usual.filtering,
                Some(FilterArg::Nearest) => BtfFiltering::Nearest,
                Some(FilterArg::Bilinear) => BtfFiltering::Bilinear,
                Some(FilterArg::Trilinear) => BtfFiltering::Trilinear,
            },
            samples: self.samples.unwrap_or(usual.samples),
        }
    }

    /// The number of the material that is asked for; the first one if none is.
    pub(crate) fn number(&self, btf: &Btf<'_>) -> anyhow::Result<usize> {
        let Some(asked) = &self.material else {
            return Ok(0);
        };
        let names: Vec<String> = btf.materials().map(|material| material.name().to_owned()).collect();
        material_number(&names, asked).ok_or_else(|| {
            bad_request(format!("--material {asked}: the file has {}, and 0 to {}", names.join(", "), names.len() - 1))
        })
    }

    /// Copies of a material of `size` texels to the unit square of a mesh's texture coordinates.
    pub(crate) fn copies(&self, mesh: &Mesh, size: [u32; 2]) -> [f32; 2] {
        self.repeat.map_or_else(|| usual_copies(mesh, size), |Copies(copies)| copies)
    }
}

/// A copy is this share of the longest side of the mesh.
const SHARE_OF_MESH: f64 = 0.2;

/// Whole numbers of copies, in which texels are about square and a copy is about [`SHARE_OF_MESH`].
fn usual_copies(mesh: &Mesh, [width, height]: [u32; 2]) -> [f32; 2] {
    let Some(uvs) = &mesh.uvs else {
        return [1.0; 2];
    };
    // mm along u and along v to a unit of them, on average.
    let (mut along_u, mut along_v, mut area) = (0.0, 0.0, 0.0);
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|k| mesh.positions[k as usize]);
        let [ta, tb, tc]: [Vec2; 3] = triangle.map(|k| uvs[k as usize]);
        let (e1, e2, t1, t2): (Vec3, Vec3, Vec2, Vec2) = (b - a, c - a, tb - ta, tc - ta);
        // Twice the area in texture coordinates cancels: ∂P/∂u = (e1 t2.y − e2 t1.y) / (t1 × t2).
        along_u += f64::from((e1 * t2.y - e2 * t1.y).length());
        along_v += f64::from((e2 * t1.x - e1 * t2.x).length());
        area += f64::from(t1.perp_dot(t2).abs());
    }
    let [low, high] = mesh.bounds();
    let copy_mm = SHARE_OF_MESH * f64::from((high - low).max_element());
    let larger = f64::from(width.max(height));
    let copies = |along: f64, texels: u32| {
        let copies = along / area / (copy_mm * f64::from(texels) / larger);
        #[allow(clippy::cast_possible_truncation, reason = "a small whole number")]
        let whole = if copies.is_finite() { copies.round().clamp(1.0, 1_000.0) as f32 } else { 1.0 };
        whole
    };
    [copies(along_u, width), copies(along_v, height)]
}

/// A mesh that BTFs can lie on.
pub(crate) fn expect_uvs(mesh: &Mesh) -> anyhow::Result<()> {
    if mesh.uvs.is_some() {
        return Ok(());
    }
    Err(bad_request(
        "the mesh has no texture coordinates, which say how a BTF lies on it: unwrap it in a modelling program (in \
         Blender: Edit Mode, UV, Smart UV Project) and export them",
    ))
}

/// All images of a folder, for [`upload_images`].
pub(crate) fn read_images(folder: &Path) -> anyhow::Result<Images> {
    let found = Folder::open(folder)?;
    if found.is_linear() {
        return Err(bad_request(format!(
            "{}: linear floats, which take four times the memory of display values; --images draws .png and .jpg",
            folder.display()
        )));
    }
    Ok(Images::load(&found, &Bars::new())?)
}

/// The image of a pair, in bytes.
pub(crate) fn in_bytes(images: &Images, pair: usize) -> Vec<[u8; 3]> {
    images.image(pair).into_iter().map(cpu::display).collect()
}

/// Brings images to a device.
pub(crate) fn upload_images(gpu: &Gpu, images: &Images) -> anyhow::Result<BtfMaterial> {
    let white = match images.tone() {
        subsurf_decoder::btf::Tone::Display { white } => white,
        subsurf_decoder::btf::Tone::LogLuv { .. } => 1.0,
    };
    let views = images.views().len();
    let description = BtfImages { size: images.size(), lights: images.lights(), views: images.views(), white };
    Ok(BtfMaterial::upload_images(gpu, &description, |light, view| in_bytes(images, light * views + view))?)
}

/// A mesh and a material on a device.
pub(crate) fn prepare_btf(
    gpu: &Gpu,
    mesh: &Mesh,
    copies: [f32; 2],
    material: BtfMaterial,
    number: usize,
) -> anyhow::Result<Prepared> {
    let tangents = mesh.tangents()?;
    let mesh = GpuMesh::upload(gpu, mesh, &Placement::of_btf(mesh, copies), VertexData::Tangents(&tangents))?;
    Ok(Prepared::Btf { mesh, material, number })
}

/// Draws a mesh made of a BTF; where there are images, they come second.
pub(crate) fn draw_btf(
    gpu: Option<&Gpu>,
    btf: &Btf<'_>,
    mesh: &Mesh,
    args: &BtfArgs,
    shot: &Shot,
) -> anyhow::Result<(RgbImage, Map<String, Value>)> {
    expect_uvs(mesh)?;
    let number = args.number(btf)?;
    let size = btf.materials().nth(number).map_or([1; 2], |material| material.size(0));
    let copies = args.copies(mesh, size);
    let options = RuntimeOptions { btf: args.options(shot.options.btf), ..shot.options };
    let large = shot.size.map(|side| side * SUPERSAMPLING);
    let mut scene = shot.scene(mesh);
    let mut facts = Map::new();
    facts.insert("size".to_owned(), json!(shot.size));
    facts.insert("triangles".to_owned(), json!(mesh.triangles.len()));
    facts.insert("repeat".to_owned(), json!(copies));
    facts.insert("samples".to_owned(), json!(options.btf.samples));
    let Some(gpu) = gpu else {
        if args.images.is_some() {
            return Err(bad_request("--images are drawn by devices only; leave them out, or --backend cpu"));
        }
        let surface =
            cpu::BtfSurface { btf, material: number, filtering: options.btf.filtering, samples: options.btf.samples };
        let (picture, exposure) = on_cpu(&surface, mesh, copies, &scene, shot.exposure, large)?;
        facts.insert("exposure".to_owned(), json!(exposure));
        return Ok((average_down(&picture, large), facts));
    };
    let mut draw = |material: BtfMaterial, number: usize, scene: &mut Scene, exposure: Option<f32>, name: &str| {
        facts.insert(name.to_owned(), json!(material.gpu_bytes()));
        let mut ready = Ready::new(gpu, prepare_btf(gpu, mesh, copies, material, number)?, scene, large, options)?;
        scene.camera.exposure = match exposure {
            Some(exposure) => exposure,
            None => ready.exposure(gpu, scene)?,
        };
        anyhow::Ok(average_down(&ready.picture(gpu, scene)?, large))
    };
    let picture = draw(BtfMaterial::upload(gpu, btf)?, number, &mut scene, shot.exposure, "gpu_bytes")?;
    let picture = match &args.images {
        None => picture,
        Some(folder) => {
            let images = read_images(folder)?;
            let exposure = Some(scene.camera.exposure);
            let beside = draw(upload_images(gpu, &images)?, 0, &mut scene, exposure, "images_gpu_bytes")?;
            montage(&[vec![picture, beside]])
        }
    };
    facts.insert("exposure".to_owned(), json!(scene.camera.exposure));
    Ok((picture, facts))
}

/// What the twin of the shaders wants to know of a mesh.
pub(crate) struct Textured {
    uvs: Vec<Vec2>,
    tangents: Vec<Vec4>,
}

impl Textured {
    /// For so many copies of a material along u and v.
    pub(crate) fn new(mesh: &Mesh, copies: [f32; 2]) -> anyhow::Result<Self> {
        let down = |uv: &Vec2| Vec2::new(uv.x * copies[0], 1.0 - uv.y * copies[1]);
        Ok(Self { uvs: mesh.uvs.iter().flatten().map(down).collect(), tangents: mesh.tangents()? })
    }

    pub(crate) fn triangles<'a>(
        &'a self,
        mesh: &'a Mesh,
        visibilities: &'a [[f32; MAX_LIGHTS]],
    ) -> cpu::BtfTriangles<'a> {
        cpu::BtfTriangles {
            positions: &mesh.positions,
            normals: &mesh.normals,
            uvs: &self.uvs,
            tangents: &self.tangents,
            visibilities,
            triangles: &mesh.triangles,
        }
    }
}

/// The same by the twin of the shaders, with the exposure; shadows are known of vertices only.
fn on_cpu(
    surface: &cpu::BtfSurface<'_>,
    mesh: &Mesh,
    copies: [f32; 2],
    scene: &Scene,
    exposure: Option<f32>,
    size: [u32; 2],
) -> anyhow::Result<(Vec<[u8; 3]>, f32)> {
    let visibilities = visibility(mesh, &scene.lights);
    let textured = Textured::new(mesh, copies)?;
    let triangles = textured.triangles(mesh, &visibilities);
    let reflections = cpu::Reflections { size: REFLECTION_SIZE, levels: scene.environment.reflections() };
    let placement = Placement::of_btf(mesh, copies);
    let draw = |exposure, size| {
        let mut block = uniform::Scene::new(scene, &placement, size, RuntimeOptions::default().light_texels);
        block.exposure = exposure;
        cpu::shade_btf(&triangles, surface, &block, &reflections, size, [BACKGROUND; 3])
    };
    let exposure = exposure.unwrap_or_else(|| exposure_of(|dark| draw(dark, size.map(|side| side.div_ceil(4)))));
    Ok((draw(exposure, size), exposure))
}

#[cfg(test)]
mod tests {
    use super::*;
    use subsurf_scene::{sphere, torus};

    #[test]
    fn copies_are_about_square_and_a_fifth_of_the_mesh() {
        // 20 mm in radius: 126 mm around the equator, 63 mm from pole to pole, and 80 mm around on average.
        assert_eq!(usual_copies(&sphere(20.0, 32), [64, 64]), [10.0, 8.0]);
        assert_eq!(usual_copies(&sphere(20.0, 32), [64, 32]), [10.0, 16.0]);
        // 2 π 18 mm along the middle of a tube of 2 π 8 mm.
        assert_eq!(usual_copies(&torus(18.0, 8.0, 32), [128, 128]), [11.0, 5.0]);
    }

    #[test]
    fn numbers_of_copies() {
        assert_eq!("4".parse(), Ok(Copies([4.0; 2])));
        assert_eq!("6, 2.5".parse(), Ok(Copies([6.0, 2.5])));
        assert!(["0", "-1", "a", "1,2,3", "inf"].iter().all(|text| text.parse::<Copies>().is_err()), "no copies");
    }
}
