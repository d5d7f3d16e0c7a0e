//! Weighted irradiance maps, and the cascade of Gaussians over them.

use subsurf_shaders::source::{self, Domain};
use wgpu::{BindGroup, BindingResource, CommandEncoder, TextureView};

use crate::asset::SeparableMaterial;
use crate::error::Result;
use crate::gpu::{CoverPass, Gpu, HALF, Rows, Slot, Surface2d, TextureSpec, layer_of, layers_of};

/// L maps in one texture.
#[derive(Debug)]
pub(crate) struct Maps {
    surface: Surface2d,
    /// All of them, to be read.
    pub(crate) all: TextureView,
    /// Each, to be drawn to.
    pub(crate) layers: Vec<TextureView>,
}

impl Maps {
    pub(crate) fn new(gpu: &Gpu, label: &'static str, size: [u32; 2], terms: usize) -> Result<Self> {
        let count = u32::try_from(terms).unwrap_or(u32::MAX);
        let target = TextureSpec::target(label, size, gpu.kept());
        let surface = gpu
            .texture(&TextureSpec { usage: target.usage, ..TextureSpec::layered(label, size, count, target.format) })?;
        let layers = (0..count).map(|layer| layer_of(&surface, layer)).collect();
        Ok(Self { all: layers_of(&surface), layers, surface })
    }

    /// What [`Maps::new`] takes on the device.
    pub(crate) fn bytes_of(size: [u32; 2], terms: usize) -> u64 {
        let count = u32::try_from(terms).unwrap_or(u32::MAX);
        TextureSpec::layered("", size, count, HALF).bytes()
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.surface.texture.bytes()
    }
}

/// The passes of the cascade, for maps that lie on a patch or on the screen.
#[derive(Debug)]
pub(crate) struct BlurPasses {
    terms: usize,
    rows: CoverPass,
    columns: CoverPass,
}

impl BlurPasses {
    pub(crate) fn new(gpu: &Gpu, domain: Domain, terms: usize) -> Result<Self> {
        // Maps of a patch are sampled.
        let (of_domain, of_maps) = match domain {
            Domain::Patch => (Slot::Nearest, Slot::FloatLayers),
            Domain::Screen => (Slot::Uniform, Slot::KeptLayers),
        };
        let of_rows = [Slot::Uniform, of_domain, of_maps];
        let of_columns = [Slot::Uniform, of_domain, of_maps, Slot::KeptLayers];
        let targets = vec![gpu.kept(); 2 * terms];
        Ok(Self {
            terms,
            rows: CoverPass::new(gpu, source::blur_rows(domain, terms), "blur", &[&of_rows], &targets[..terms])?,
            columns: CoverPass::new(gpu, source::blur_columns(domain, terms), "blur", &[&of_columns], &targets)?,
        })
    }
}

/// Maps of one size, and everything that is bound to blur them.
#[derive(Debug)]
pub(crate) struct Cascade {
    size: [u32; 2],
    /// c_l E, where the cascade begins and what it leaves of it, and the same between rows and columns.
    pub(crate) maps: [Maps; 2],
    /// S_m of the stage before and of this one, by turns.
    sums: [Maps; 2],
    groups: Vec<[BindGroup; 2]>,
}

impl Cascade {
    /// `domain` is what [`Domain`] wants bound: the block of the screen, or a sampler that wraps as the patch does.
    pub(crate) fn new(
        gpu: &Gpu,
        passes: &BlurPasses,
        material: &SeparableMaterial,
        domain: &BindingResource<'_>,
        size: [u32; 2],
    ) -> Result<Self> {
        let map = |label| Maps::new(gpu, label, size, passes.terms);
        let maps = [map("weighted irradiance")?, map("irradiance blurred along rows")?];
        let sums = [map("sums of stages")?, map("sums of stages, by turns")?];
        let texture = BindingResource::TextureView;
        let groups = material.stages().iter().enumerate().map(|(a, [rows, columns])| {
            let of_rows = [rows.as_entire_binding(), domain.clone(), texture(&maps[0].all)];
            let so_far = texture(&sums[(a + 1) % 2].all);
            let of_columns = [columns.as_entire_binding(), domain.clone(), texture(&maps[1].all), so_far];
            Ok([passes.rows.bind(gpu, 0, &of_rows)?, passes.columns.bind(gpu, 0, &of_columns)?])
        });
        let groups = groups.collect::<Result<_>>()?;
        Ok(Self { size, maps, sums, groups })
    }

    /// Bytes of all maps of a cascade.
    pub(crate) fn bytes_of(size: [u32; 2], terms: usize) -> u64 {
        4 * Maps::bytes_of(size, terms)
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.maps.iter().chain(&self.sums).map(Maps::bytes).sum()
    }

    /// S_m before the first stage, which only a domain that has some looks at.
    pub(crate) fn begun_sums(&self) -> &Maps {
        &self.sums[1]
    }

    /// S_m once all stages are through.
    pub(crate) fn sums(&self) -> &Maps {
        &self.sums[(self.groups.len() + 1) % 2]
    }

    /// S_m before the last stage.
    pub(crate) fn sums_before_last(&self) -> &Maps {
        &self.sums[self.groups.len() % 2]
    }

    /// Blurs stage by stage, from the first maps to the sums; or from where `ends` begin to where they end.
    pub(crate) fn record(&self, encoder: &mut CommandEncoder, passes: &BlurPasses, ends: Option<Ends<'_>>) {
        let [maps, between] = &self.maps;
        let all = Rows::all(self.size);
        let last = self.groups.len() - 1;
        for (a, [of_rows, of_columns]) in self.groups.iter().enumerate() {
            let to: Vec<&TextureView> = between.layers.iter().collect();
            match ends {
                Some(Ends { first: (rows, of_rows), .. }) if a == 0 => rows.record(encoder, &to, &[of_rows], all),
                _ => passes.rows.record(encoder, &to, &[of_rows], all),
            }
            let to: Vec<&TextureView> = maps.layers.iter().chain(&self.sums[a % 2].layers).collect();
            match ends {
                Some(Ends { last: (columns, of_columns), target, .. }) if a == last => {
                    columns.record(encoder, &[target], &[of_columns], all);
                }
                _ => passes.columns.record(encoder, &to, &[of_columns], all),
            }
        }
    }
}

/// What takes the place of the first pass and of the last one: passes, what is bound to them, and what is drawn to.
#[derive(Clone, Copy)]
pub(crate) struct Ends<'a> {
    pub(crate) first: (&'a CoverPass, &'a BindGroup),
    pub(crate) last: (&'a CoverPass, &'a BindGroup),
    pub(crate) target: &'a TextureView,
}
