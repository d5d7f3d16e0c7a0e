//! Frames whose passes are timed: for tools, which may wait.

use std::time::{Duration, Instant};

use wgpu::{
    BufferDescriptor, BufferUsages, CommandEncoder, CommandEncoderDescriptor, QUERY_SIZE, QuerySetDescriptor, QueryType,
};

use super::input::{Input, Target};
use super::prepare::Frame;
use super::renderer::Renderer;
use crate::error::{Error, Result};
use crate::gpu::{Gpu, TIMESTAMPS};

/// Times of the passes of a frame.
#[derive(Clone, Debug)]
pub struct PassTimes {
    /// Names of the passes, as the table of shaders has them, in the order in which they begin; all runs of a pass together.
    pub passes: Vec<(&'static str, Duration)>,
    /// Whether the device took the times while it drew the frame at once. Else every pass was waited for, and the sum is more than
    /// a frame takes: nothing overlaps.
    pub is_by_device: bool,
}

impl PassTimes {
    fn add(&mut self, name: &'static str, time: Duration) {
        match self.passes.iter_mut().find(|(known, _)| *known == name) {
            Some((_, sum)) => *sum += time,
            None => self.passes.push((name, time)),
        }
    }
}

/// Timestamps of a frame at most: one before its passes and one after each.
const MOST: u32 = 1_024;

impl Renderer {
    /// Draws a frame, and gives the time that each pass took: by timestamps of the device where it has them.
    ///
    /// # Errors
    /// As [`Renderer::draw_now`].
    pub fn draw_timed(
        &self,
        gpu: &Gpu,
        frame: &mut Frame,
        input: &Input<'_>,
        target: &Target<'_>,
    ) -> Result<PassTimes> {
        self.gather(gpu, frame, input)?;
        gpu.finish()?;
        if gpu.device.features().contains(TIMESTAMPS) {
            self.draw_by_timestamps(gpu, frame, input, target)
        } else {
            self.draw_by_clock(gpu, frame, input, target)
        }
    }

    fn draw_by_timestamps(
        &self,
        gpu: &Gpu,
        frame: &mut Frame,
        input: &Input<'_>,
        target: &Target<'_>,
    ) -> Result<PassTimes> {
        let bytes = u64::from(MOST) * u64::from(QUERY_SIZE);
        let buffer = |label, usage| {
            gpu.device.create_buffer(&BufferDescriptor {
                label: Some(label),
                size: bytes,
                usage,
                mapped_at_creation: false,
            })
        };
        let mut names = Vec::new();
        let read = gpu.checked(|| {
            let queries = gpu.device.create_query_set(&QuerySetDescriptor {
                label: Some("timestamps"),
                ty: QueryType::Timestamp,
                count: MOST,
            });
            let resolved = buffer("timestamps", BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC);
            let read = buffer("timestamps, to read", BufferUsages::COPY_DST | BufferUsages::MAP_READ);
            let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
            encoder.write_timestamp(&queries, 0);
            let mut number = 0;
            let mut lap = |name, encoder: &mut CommandEncoder| {
                if number + 1 < MOST {
                    number += 1;
                    encoder.write_timestamp(&queries, number);
                    names.push(name);
                }
            };
            self.record(gpu, &mut encoder, frame, input, target, &mut lap)?;
            encoder.resolve_query_set(&queries, 0..number + 1, &resolved, 0);
            encoder.copy_buffer_to_buffer(&resolved, 0, &read, 0, bytes);
            gpu.queue.submit([encoder.finish()]);
            Ok::<_, Error>(read)
        })??;
        let stamps: Vec<u64> = gpu.read_buffer(&read)?;
        let mut times = PassTimes { passes: Vec::new(), is_by_device: true };
        for (name, stamps) in names.into_iter().zip(stamps.windows(2)) {
            #[allow(clippy::cast_precision_loss, reason = "less than a frame")]
            let ticks = stamps[1].saturating_sub(stamps[0]) as f64;
            times.add(name, Duration::from_secs_f64(1e-9 * ticks * f64::from(gpu.queue.get_timestamp_period())));
        }
        Ok(times)
    }

    /// The same by a clock: every pass is submitted and waited for.
    fn draw_by_clock(&self, gpu: &Gpu, frame: &mut Frame, input: &Input<'_>, target: &Target<'_>) -> Result<PassTimes> {
        let mut times = PassTimes { passes: Vec::new(), is_by_device: false };
        let new = || gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
        let mut failed = Ok(());
        gpu.checked(|| {
            let mut begin = Instant::now();
            let mut lap = |name, encoder: &mut CommandEncoder| {
                gpu.queue.submit([std::mem::replace(encoder, new()).finish()]);
                failed = gpu.finish().and(std::mem::replace(&mut failed, Ok(())));
                times.add(name, begin.elapsed());
                begin = Instant::now();
            };
            let mut encoder = new();
            self.record(gpu, &mut encoder, frame, input, target, &mut lap)?;
            gpu.queue.submit([encoder.finish()]);
            Ok::<(), Error>(())
        })??;
        failed?;
        Ok(times)
    }
}
