//! Steps that make a material of a file, one list for each technique.

use std::sync::Arc;

#[cfg(feature = "transfer")]
use subsurf_decoder::Transfer;
use subsurf_decoder::{Bssrdf, Content, File, Kernel};
use subsurf_shaders::separable::{BasisNumbers, ProfileSums};

use super::projection::table;
use super::steps::Load;
use super::work::Work;
#[cfg(feature = "transfer")]
use crate::asset::TransferMaterial;
use crate::asset::{BssrdfPlanes, BtfMaterial, KernelMaterial, Material, SeparableMaterial, SplatMaterial};
use crate::error::{Error, Result};
use crate::gpu::Gpu;

impl<'a> Load<'a> {
    /// Begins to load a file for the fastest technique that it offers: separable blurs where it has a basis for them, else splats;
    /// a BTF as it is, its first material; a kernel or a transfer as it is.
    ///
    /// # Errors
    /// [`Error::Usage`] for a factored BTF, which no technique draws; [`Error::Unsupported`] if the device takes no texture of
    /// that size.
    pub fn new(gpu: &'a Gpu, file: &File<'a>) -> Result<Self> {
        match file.content() {
            Content::Bssrdf(material) => match BasisNumbers::of(&material) {
                Some(numbers) => Ok(Load::separable(gpu, &material, &numbers)?.map(Material::Separable)),
                None => Ok(Load::splat(gpu, &material)?.map(Material::Splat)),
            },
            Content::NestedBtf(btf) => {
                let (material, fills) = BtfMaterial::begin(gpu, &btf)?;
                Ok(Load::of(gpu, Material::Btf(Arc::new(material), 0)).filled(fills))
            }
            Content::Kernel(kernel) => Ok(Load::kernel(gpu, &kernel)?.map(Material::Kernel)),
            #[cfg(feature = "transfer")]
            Content::Transfer(transfer) => Ok(Load::transfer(gpu, &transfer)?.map(Material::Transfer)),
            Content::FactoredBtf(_) => {
                Err(Error::Usage("factored BTFs are not drawn from the file: encode the images as nested".to_owned()))
            }
            other => Err(Error::Usage(format!("no technique here draws a file of the family {}", other.family()))),
        }
    }
}

impl<'a> Load<'a, Arc<SeparableMaterial>> {
    /// Begins to load a translucent material for separable blurs by the numbers of a basis, [`BasisNumbers::of`] the same file.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size; [`Error::Usage`] for numbers of another patch.
    pub fn separable(gpu: &'a Gpu, material: &Bssrdf<'a>, numbers: &BasisNumbers) -> Result<Self> {
        if numbers.header() != material.header() {
            return Err(Error::Usage("numbers of a basis for another material".to_owned()));
        }
        let (planes, fills) = BssrdfPlanes::begin(gpu, material)?;
        let (table, fill) = table(gpu, numbers.sums())?;
        let made = Arc::new(SeparableMaterial::new(gpu, numbers)?);
        let (terms, to) = (made.terms(), made.clone());
        let load = Load::of(gpu, made).filled(fills.into_iter().chain([fill]));
        let load = load
            .then(Work::CompileSums(planes.layout(), terms))
            .then(Work::CompileAlbedo(terms))
            .then(Work::CompileLevels(terms + 1));
        Ok(load.then(Work::ProjectBasis { planes, table, to }))
    }
}

impl<'a> Load<'a, Arc<SplatMaterial>> {
    /// Begins to load a translucent material for splats: the planes of its file, and its albedo under uniform light: by the basis
    /// of the file; where it has none, [`ProfileSums::albedo`].
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size.
    pub fn splat(gpu: &'a Gpu, material: &Bssrdf<'a>) -> Result<Self> {
        let (planes, fills) = BssrdfPlanes::begin(gpu, material)?;
        let layout = planes.layout();
        let made = Arc::new(SplatMaterial::new(gpu, material, planes)?);
        let to = made.clone();
        let load = Load::of(gpu, made);
        let Some(numbers) = BasisNumbers::of(material) else {
            let (table, fill) = table(gpu, &ProfileSums::albedo(material))?;
            let load = load
                .filled(fills.into_iter().chain([fill]))
                .then(Work::CompileSums(layout, 1))
                .then(Work::CompileLevels(1));
            return Ok(load.then(Work::ProjectAlbedo { table, to }));
        };
        let (table, fill) = table(gpu, numbers.sums())?;
        let basis = SeparableMaterial::new(gpu, &numbers)?;
        let terms = basis.terms();
        let load = load
            .filled(fills.into_iter().chain([fill]))
            .then(Work::CompileSums(layout, terms))
            .then(Work::CompileAlbedo(terms))
            .then(Work::CompileLevels(1));
        Ok(load.then(Work::ProjectAlbedoByBasis { table, basis: Box::new(basis), to }))
    }
}

impl<'a> Load<'a, Arc<KernelMaterial>> {
    /// Begins to load a homogeneous material for its separable kernel.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size.
    pub fn kernel(gpu: &'a Gpu, kernel: &Kernel<'_>) -> Result<Self> {
        let (material, fill) = KernelMaterial::begin(gpu, kernel)?;
        Ok(Load::of(gpu, Arc::new(material)).filled([fill]))
    }
}

#[cfg(feature = "transfer")]
impl<'a> Load<'a, Arc<TransferMaterial>> {
    /// Begins to load what is precomputed for the vertices of a mesh.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size.
    pub fn transfer(gpu: &'a Gpu, transfer: &Transfer<'_>) -> Result<Self> {
        let (material, fills) = TransferMaterial::begin(gpu, transfer)?;
        let made = Arc::new(material);
        let to = made.clone();
        Ok(Load::of(gpu, made).filled(fills).then(Work::PrepareTransfer(to)))
    }
}

impl Material {
    /// Uploads a file for the fastest technique that it offers, all steps of [`Load::new`] at once.
    ///
    /// # Errors
    /// As [`Load::new`] and [`Load::step`].
    pub fn load(gpu: &Gpu, file: &File<'_>) -> Result<Self> {
        Load::new(gpu, file)?.finish()
    }
}
