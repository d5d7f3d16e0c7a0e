//! Loads a BTF, or its images in one array: read, parsed, uploaded, drawn once.

use std::path::Path;

use subsurf_cli::program::failure::bad_request;
use subsurf_decoder::NestedBtf;
use subsurf_encoder::capture::Folder;
use subsurf_runtime::{BtfLayout, Gpu, LoadTimer, RawImages, Stored, Technique};
use subsurf_viewer::parse_btf;

use super::results::Steps;
use crate::bench::timing::Clock;

/// Pixels to a side of the first frame.
const FRAME: [u32; 2] = [64; 2];

/// A BTF or its images, to be loaded again and again.
pub(super) struct BtfLoader<'a> {
    path: &'a Path,
    layout: BtfLayout,
    size: [u32; 2],
    lights: Vec<glam::Vec3>,
    views: Vec<glam::Vec3>,
    /// None if texels are looked up on the CPU.
    timer: Option<LoadTimer<'a>>,
}

impl<'a> BtfLoader<'a> {
    /// Compiles what an application has before it loads its first BTF.
    pub(super) fn new(gpu: Option<&'a Gpu>, path: &'a Path, images: &Path) -> anyhow::Result<Self> {
        let folder = Folder::open(images)?;
        let is_array = path.extension().is_some_and(|extension| extension == "raw");
        let layout = if is_array { BtfLayout::Images } else { BtfLayout::Nested };
        let [lights, views]: [Vec<glam::Vec3>; 2] =
            [folder.lights(), folder.views()].map(|all| all.iter().map(|direction| direction.unit()).collect());
        let stored = match layout {
            BtfLayout::Nested => Stored::File(Technique::Btf(layout)),
            BtfLayout::Images => {
                Stored::Images(RawImages { size: folder.size(), lights: lights.clone(), views: views.clone() })
            }
        };
        let timer = gpu.map(|gpu| LoadTimer::new(gpu, stored)).transpose()?;
        Ok(Self { path, layout, size: folder.size(), lights, views, timer })
    }

    /// File to picture, once; microseconds of pipelines that were compiled before it or in it; the material's bytes on the device.
    pub(super) fn once(&self) -> anyhow::Result<(Steps, f64, u64)> {
        let mut clock = Clock::new();
        let bytes = std::fs::read(self.path)?;
        let read = clock.lap();
        if let Some(timer) = &self.timer {
            return Steps::timed(timer, &bytes, read);
        }
        // There is nothing to check in an array but its length.
        let btf = match self.layout {
            BtfLayout::Nested => Some(parse_btf(self.path, &bytes)?),
            BtfLayout::Images if bytes.len() == self.lights.len() * self.views.len() * self.image_len() => None,
            BtfLayout::Images => return Err(bad_request("the array has not the length of its images")),
        };
        let parse = clock.lap();
        std::hint::black_box(self.picture(btf.as_ref(), &bytes));
        let first_frame = clock.lap();
        Ok((Steps::by_cpu(read, parse, first_frame), 0.0, 0))
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
