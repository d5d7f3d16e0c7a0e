//! Window in which a material is turned, lit and compared; and how materials and meshes become pictures.
//!
//! [`Viewer`] is the window, the same on every platform: files come from a [`Config`], pictures and news go to a [`Host`].
//! [`Asset`], [`GpuAsset`] and [`RenderSession`] are the steps from a file to a picture, with and without a window.

mod asset;
mod error;
mod file;
mod request;
mod set;
mod units;
mod window;

pub use asset::{
    Asset, BtfImageSet, GpuAsset, MappingChoice, RenderSession, Scattering, TexturedMesh, basis, choose_mapping,
    expect_uvs, exposure_of, light_of, numbers, points, repeats, upload_images,
};
pub use error::{Error, Result, one_line};
pub use file::{DrawnMaterial, material_number, parse, parse_btf, read, stem};
pub use request::{ROUGHNESS, RenderRequest};
pub use set::{Angles, Set};
pub use units::human;
pub use window::{Artist, Config, Event, Host, KEYS, LoadImages, MakeKernel, Picture, Viewer, event_loop, options};
