//! Loads a BTF, or its images in one array: read, parsed, uploaded, drawn once.

use std::path::Path;

use subsurf_cli::program::failure::bad_request;
use subsurf_decoder::NestedBtf;
use subsurf_encoder::capture::Folder;
use subsurf_runtime::{
    BtfImages, BtfLayout, BtfMaterial, Gpu, GpuMesh, Input, Material, Object, PictureTarget, Renderer, RuntimeOptions,
    Technique, VertexData,
};
use subsurf_scene::{Mapping, Mesh, Scene, relief};
use subsurf_viewer::{RenderRequest, parse_btf};

use super::results::Steps;
use crate::bench::timing::Clock;

/// Pixels to a side of the first frame.
const FRAME: [u32; 2] = [64; 2];
/// Copies of the material on the mesh of the first frame.
const COPIES: [f32; 2] = [4.0; 2];

/// A BTF or its images, to be loaded again and again.
pub(super) struct BtfLoader<'a> {
    gpu: Option<&'a Gpu>,
    path: &'a Path,
    layout: BtfLayout,
    size: [u32; 2],
    lights: Vec<glam::Vec3>,
    views: Vec<glam::Vec3>,
    scene: Scene,
    drawn: Option<(Renderer, GpuMesh)>,
}

impl<'a> BtfLoader<'a> {
    /// Compiles what an application has before it loads its first BTF.
    pub(super) fn new(gpu: Option<&'a Gpu>, path: &'a Path, images: &Path) -> anyhow::Result<Self> {
        let folder = Folder::open(images)?;
        let is_array = path.extension().is_some_and(|extension| extension == "raw");
        let layout = if is_array { BtfLayout::Images } else { BtfLayout::Nested };
        let mesh: Mesh = relief(20.0, 8, 22);
        let draw = |gpu: &Gpu| -> anyhow::Result<_> {
            let renderer = Renderer::for_technique(gpu, Technique::Btf(layout), RuntimeOptions::default())?;
            let tangents = mesh.tangents()?;
            let known = VertexData { tangents: Some(&tangents), ..Default::default() };
            Ok((renderer, GpuMesh::upload(gpu, &mesh, known)?))
        };
        Ok(Self {
            gpu,
            path,
            layout,
            size: folder.size(),
            lights: folder.lights().iter().map(|light| light.unit()).collect(),
            views: folder.views().iter().map(|view| view.unit()).collect(),
            scene: RenderRequest::usual(FRAME).scene(&mesh),
            drawn: gpu.map(draw).transpose()?,
        })
    }

    /// File to picture, once; and the material's bytes on the device.
    pub(super) fn once(&self) -> anyhow::Result<(Steps, u64)> {
        let mut clock = Clock::new();
        let bytes = std::fs::read(self.path)?;
        let read = clock.lap();
        // There is nothing to check in an array but its length.
        let btf = match self.layout {
            BtfLayout::Nested => Some(parse_btf(self.path, &bytes)?),
            BtfLayout::Images if bytes.len() == self.lights.len() * self.views.len() * self.image_len() => None,
            BtfLayout::Images => return Err(bad_request("the array has not the length of its images")),
        };
        let parse = clock.lap();
        let (upload, first_frame, gpu_bytes) = match (self.gpu, &self.drawn) {
            (Some(gpu), Some((renderer, mesh))) => {
                let material = self.upload(gpu, btf.as_ref(), &bytes)?;
                gpu.finish()?;
                let upload = clock.lap();
                let material = Material::Btf(material.into(), 0);
                let objects = [Object::new(mesh, &material, Mapping::Uv(COPIES), self.scene.roughness)];
                let input = Input::new(&self.scene, &objects, FRAME);
                let picture = PictureTarget::new(gpu, FRAME, renderer.options())?;
                let mut frame = renderer.prepare(gpu, &input, FRAME)?;
                renderer.draw_now(gpu, &mut frame, &input, &picture.target())?;
                gpu.finish()?;
                (upload, clock.lap(), material.gpu_bytes())
            }
            _ => {
                std::hint::black_box(self.picture(btf.as_ref(), &bytes));
                (0.0, clock.lap(), 0)
            }
        };
        Ok((Steps { read, parse, upload, first_frame, total: read + parse + upload + first_frame }, gpu_bytes))
    }

    fn image_len(&self) -> usize {
        3 * self.size.iter().map(|side| *side as usize).product::<usize>()
    }

    /// Pixels of the image of a light and a view.
    fn image<'b>(&self, bytes: &'b [u8], light: usize, view: usize) -> &'b [[u8; 3]] {
        let len = self.image_len();
        let first = (light * self.views.len() + view) * len;
        bytes.get(first..first + len).unwrap_or(&[]).as_chunks().0
    }

    fn upload(&self, gpu: &Gpu, btf: Option<&NestedBtf<'_>>, bytes: &[u8]) -> anyhow::Result<BtfMaterial> {
        Ok(if let Some(btf) = btf {
            BtfMaterial::upload(gpu, btf)?
        } else {
            let images = BtfImages { size: self.size, lights: &self.lights, views: &self.views, white: 1.0 };
            BtfMaterial::upload_images(gpu, &images, |light, view| self.image(bytes, light, view).to_vec())?
        })
    }

    /// Texels under the last light, seen from the last view.
    fn picture(&self, btf: Option<&NestedBtf<'_>>, bytes: &[u8]) -> Vec<[f32; 3]> {
        let (light, view) = (self.lights.len() - 1, self.views.len() - 1);
        let texels = (0..FRAME[0] * FRAME[1]).map(|k| [(k % FRAME[0]).cast_signed(), (k / FRAME[0]).cast_signed()]);
        match btf {
            Some(btf) => {
                let (light, view) = (self.lights[light].to_array(), btf.grid().view(self.views[view].to_array()));
                let value = |at| btf.texel(0, 0, at).map_or([0.0; 3], |texel| btf.eval_for(texel, light, &view));
                texels.map(value).collect()
            }
            None => {
                let image = self.image(bytes, light, view);
                let value = |[x, y]: [i32; 2]| {
                    let at = y.rem_euclid(self.size[1].cast_signed()) * self.size[0].cast_signed()
                        + x.rem_euclid(self.size[0].cast_signed());
                    let pixel = usize::try_from(at).ok().and_then(|at| image.get(at)).copied().unwrap_or_default();
                    pixel.map(|byte| f32::from(byte) / 255.0)
                };
                texels.map(value).collect()
            }
        }
    }
}
