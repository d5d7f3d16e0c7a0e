//! Precomputed scattering: the vertices of a mesh know what leaves at them, by a small table of what shines.
//!
//! Exitance is linear in the table, so that all lights and the environment are one table, made on the CPU where they change.

use std::sync::Arc;

use subsurf_shaders::passes::transfer;
use subsurf_shaders::{TransferLight, cpu};
use wgpu::{BindGroup, BindingResource, TextureFormat};

use super::bindings::{Bindings, Group};
use super::mesh_pass::MeshPass;
use crate::asset::TransferMaterial;
use crate::error::Result;
use crate::frame::RuntimeOptions;
use crate::gpu::{Gpu, Purpose, Surface2d, TextureSpec};

/// Pipeline for all files.
#[derive(Debug)]
pub(crate) struct Passes {
    shade: MeshPass,
    /// What is left without scattered light, for benchmarks.
    #[cfg(feature = "reference")]
    coat: MeshPass,
}

/// Bind group of one material, and the table of the light that it was last lit by.
#[derive(Debug)]
struct Bound {
    passes: Arc<Passes>,
    material: Arc<TransferMaterial>,
    table: Surface2d,
    shade: BindGroup,
    lit_by: Option<TransferLight>,
}

/// Table of the light on a material.
fn table_spec(material: &TransferMaterial) -> TextureSpec {
    let table = TextureSpec::table("table of light", material.table_size(), TextureFormat::Rgba32Float);
    TextureSpec { purpose: Purpose::Frame, ..table }
}

/// Bytes on the device of the table of a material.
pub(crate) fn bytes_of(material: &TransferMaterial) -> u64 {
    table_spec(material).bytes()
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, options: &RuntimeOptions) -> Result<Self> {
        Ok(Self {
            shade: MeshPass::picture(gpu, transfer::SHADE_TRANSFER.only(), options)?,
            #[cfg(feature = "reference")]
            coat: MeshPass::picture(gpu, transfer::SHADE_COAT.only(), options)?,
        })
    }

    /// Pass that draws a material.
    #[cfg(feature = "reference")]
    fn of(&self, material: &TransferMaterial) -> &MeshPass {
        if material.is_bare { &self.coat } else { &self.shade }
    }

    /// Pass that draws all materials.
    #[cfg(not(feature = "reference"))]
    fn of(&self, _material: &TransferMaterial) -> &MeshPass {
        &self.shade
    }

    /// Binds a material, with a table of its own.
    pub(crate) fn bind(self: &Arc<Self>, gpu: &Gpu, material: &Arc<TransferMaterial>) -> Result<Box<dyn Bindings>> {
        let table = gpu.texture(&table_spec(material))?;
        let [block, codes] = material.resources();
        let of_shade = [block, codes, BindingResource::TextureView(&table.view)];
        #[cfg(feature = "reference")]
        let of_shade = if material.is_bare { &[] } else { &of_shade[..] };
        #[cfg(not(feature = "reference"))]
        let of_shade = &of_shade;
        Ok(Box::new(Bound {
            shade: self.of(material).bind(gpu, 1, of_shade)?,
            passes: self.clone(),
            material: material.clone(),
            table,
            lit_by: None,
        }))
    }
}

impl Bindings for Bound {
    /// Makes the table of the light on the mesh, unless it is known already.
    fn update(&mut self, gpu: &Gpu, group: &Group<'_>) {
        #[cfg(feature = "reference")]
        if self.material.is_bare {
            return;
        }
        let mut of_group = group.input.objects.iter().zip(group.placed).filter(|(_, placed)| placed.slot == group.slot);
        let Some((object, _)) = of_group.next() else {
            return;
        };
        let levels = group.input.lighting.environment.reflections();
        let reflections = cpu::Reflections { size: subsurf_scene::REFLECTION_SIZE, levels };
        let centre_mm = object.bounds().centre_mm;
        let light =
            TransferLight::new(self.material.lights(), group.block, &object.world_from_mesh, centre_mm, &reflections);
        if self.lit_by.as_ref() == Some(&light) {
            return;
        }
        gpu.fill(&self.table.texture, 0, bytemuck::cast_slice(&self.material.table(&light)));
        self.lit_by = Some(light);
    }

    fn shade(&self) -> (&MeshPass, &BindGroup) {
        (self.passes.of(&self.material), &self.shade)
    }
}
