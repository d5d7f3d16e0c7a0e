//! Rows of the table: what the runs of one entry point of a frame read and write.

use anyhow::Context;
use naga::Module;
use subsurf_shaders::TargetFormat;
use subsurf_shaders::passes::Variant;

use super::count::{Assumptions, reads};

/// Numbers that frames of all techniques have.
#[derive(Clone, Copy)]
pub(super) struct Common {
    /// Number of lights.
    pub(super) lights: u32,
    /// Texels of the views of all lights together, columns and rows.
    pub(super) light_size: [u32; 2],
    /// Pixels of the picture.
    pub(super) picture: [u32; 2],
    /// Share of the pixels that face a light.
    pub(super) facing: f64,
}

/// Runs of one entry point in a frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    /// Name of the entry point: of fragments, that of the pass.
    pub(super) entry: &'static str,
    /// Columns and rows that are drawn, or of samples that are.
    pub(super) size: [u32; 2],
    /// Invocations of all runs.
    pub(super) invocations: f64,
    /// Reads of textures by an invocation, the mean over all of them.
    pub(super) reads: f64,
    /// Bytes that all runs read.
    pub(super) bytes_read: f64,
    /// Bytes that all runs write.
    pub(super) bytes_written: u64,
}

/// Entry point of a pass, whose runs are counted.
pub(super) struct Counted {
    module: Module,
    row: Row,
}

impl Counted {
    /// Entry point that has not run yet.
    pub(super) fn new(variant: Variant, entry: &'static str, size: [u32; 2]) -> anyhow::Result<Self> {
        let row = Row { entry, size, invocations: 0.0, reads: 0.0, bytes_read: 0.0, bytes_written: 0 };
        Ok(Self { module: naga::front::wgsl::parse_str(&variant.wgsl(TargetFormat::Half))?, row })
    }

    /// Adds a run: so many invocations for each texel, which write so many bytes there; `texel_bytes` tells those of the textures by
    /// their names in the shaders.
    pub(super) fn run(
        mut self,
        for_each: f64,
        assumed: &Assumptions<'_>,
        written: u64,
        texel_bytes: &dyn Fn(&str) -> Option<f64>,
    ) -> anyhow::Result<Self> {
        let row = &mut self.row;
        let texels = u64::from(row.size[0]) * u64::from(row.size[1]);
        #[allow(clippy::cast_precision_loss, reason = "texels of a picture")]
        let invocations = for_each * texels as f64;
        let mut count = 0.0;
        for (texture, reads) in reads(&self.module, row.entry, assumed).with_context(|| row.entry)? {
            count += reads;
            let bytes =
                texel_bytes(&texture).with_context(|| format!("{}: bytes of a texel of {texture}", row.entry))?;
            row.bytes_read += invocations * reads * bytes;
        }
        // Mean over this run and those before.
        row.reads = (row.reads * row.invocations + count * invocations) / (row.invocations + invocations).max(1.0);
        row.invocations += invocations;
        row.bytes_written += texels * written;
        Ok(self)
    }

    /// The row of all runs.
    pub(super) fn row(self) -> Row {
        self.row
    }
}

impl Common {
    /// Row of the pass that draws what lights see, to targets of so many bytes a texel.
    pub(super) fn tsm_render(&self, written: u64) -> anyhow::Result<Row> {
        let none = Assumptions { turns: &[], shares: &[] };
        let pass = subsurf_shaders::passes::table::TSM_RENDER.only();
        Ok(Counted::new(pass, "tsm_render", self.light_size)?.run(1.0, &none, written, &|_| None)?.row())
    }
}
