//! LinSSS (Yatagawa et al. 2020b) on the screen, a rival: by blurs of light and of weighted light, or by the authors' shortcut, a
//! pyramid of light alone.

mod bound;
mod maps;
mod passes;

pub(crate) use maps::Maps;
pub(crate) use passes::Passes;
