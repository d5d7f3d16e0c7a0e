//! Uniform blocks, laid out as in WGSL; `tests/layout.rs` holds them to it.

mod blur;
mod btf;
mod kernel;
mod linsss;
mod material;
mod object;
mod patch;
mod scene;
mod splat;
mod transfer;
mod volume;

pub use blur::{BlurStage, MOST_TAPS, ScreenDomain, Transmission, Upsampling};
pub use btf::{BtfCodebooks, BtfFiltering, BtfImages, BtfTable, BtfTexture, MAX_LEVELS, MAX_RINGS_OF_DIRECTIONS};
pub use kernel::{KernelProfile, KernelTerm};
pub use linsss::{Linsss, LinsssStage, MAX_LINSSS_GAUSSIANS};
pub use material::{BASE_ROWS, Material, ROW};
pub use object::{Blocks, Object};
pub use patch::{Frame, Kernel, MAX_KERNEL, PatchDomain, PatchRegion};
pub use scene::{HOST_SHADOW, HOST_SHADOW_REVERSED, LightSource, NO_SHADOW, OWN_SHADOW, PointGrid, Scene};
pub use splat::{MAX_RINGS, Splat, SplatRings, TsmLight};
pub use transfer::Transfer;
pub use volume::Volume;
