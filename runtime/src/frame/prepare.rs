//! Room for frames: buffers, maps and bind groups of the materials that are drawn, within the budget.

use std::sync::Arc;

use subsurf_scene::BoundingSphere;
use wgpu::{BindGroup, BindingResource};

use super::input::{Input, Object};
use super::plan::Plan;
use super::renderer::Renderer;
use crate::asset::Material;
use crate::error::{Error, Result};
use crate::gpu::Gpu;
#[cfg(feature = "reference")]
use crate::technique::linsss;
#[cfg(feature = "transfer")]
use crate::technique::transfer;
use crate::technique::{
    Bindings, Common, MapArea, TranslucentShadowMaps, kernel, reflection_sampler, separable, splat,
};

/// Object of the input in a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    /// Number of its material in the frame.
    pub(crate) slot: usize,
    /// Offset of its block in bytes.
    pub(crate) offset: u32,
    pub(crate) is_visible: bool,
}

/// How much finer or coarser than a view needs maps may be before others serve it better.
const FINENESS: f32 = 1.25;

/// Width and height of maps that are large enough for all that they hold to grow with them.
const LARGE: [u32; 2] = [1024; 2];

/// Bytes that uniform blocks of the passes of one material are sure not to exceed.
const UNIFORMS: u64 = 48 << 10;

/// Buffers, maps and bind groups for frames of one size, of the materials that it was prepared for.
#[derive(Debug)]
pub struct Frame {
    pub(super) plan: Plan,
    /// Divisor of the maps that the view asked for, whatever the budget gave.
    wanted_divisor: f32,
    pub(super) common: Common,
    pub(super) lights: TranslucentShadowMaps,
    pub(super) slots: Vec<Slot>,
    /// Where the objects of the input are, in its order.
    pub(super) placed: Vec<Placed>,
    /// Blocks of the objects, to be uploaded at once.
    pub(super) blocks: Vec<u8>,
}

/// Material of a frame.
#[derive(Debug)]
pub(super) struct Slot {
    pub(super) material: Material,
    /// Bind group 0 of the picture.
    pub(super) scene: BindGroup,
    pub(super) bindings: Box<dyn Bindings>,
    /// Sphere that holds the visible objects of the material, as they were placed last; none if none is seen.
    pub(super) bounds: Option<BoundingSphere>,
}

/// Maps of a frame, which the materials of a technique use one after the other.
#[derive(Default)]
struct Shared {
    separable: Vec<(usize, Arc<separable::Maps>)>,
    splat: Option<Arc<splat::Maps>>,
    /// By whether they are for several terms.
    kernel: Vec<(bool, Arc<kernel::Maps>)>,
}

/// Maps of a kind, made by the first material that wants them.
fn made_once<K: PartialEq, M>(
    known: &mut Vec<(K, Arc<M>)>,
    kind: K,
    make: impl FnOnce() -> Result<M>,
) -> Result<Arc<M>> {
    if let Some((_, maps)) = known.iter().find(|(of, _)| *of == kind) {
        return Ok(maps.clone());
    }
    let maps = Arc::new(make()?);
    known.push((kind, maps.clone()));
    Ok(maps)
}

impl Renderer {
    /// Makes room for pictures of `size` pixels with the materials of an input and as many shadows as it has to be drawn, within
    /// the budget: shadow maps and maps become coarser until everything fits. Maps are as fine as the view of the input needs;
    /// other views and objects may be drawn with them, as many such shadows or fewer, and any lights without them, which take
    /// no memory.
    ///
    /// # Errors
    /// [`Error::OverBudget`](crate::Error::OverBudget) if even the coarsest does not fit, before anything is allocated;
    /// [`Error::Mesh`] if a transfer lies on a mesh that it is not of;
    /// [`Error::Usage`] if a technique was not compiled, the size is 0, there are too many lights or materials, or a shadow map
    /// is not what it has to be; [`Error::Device`] if the device is lost.
    pub fn prepare(&self, gpu: &Gpu, input: &Input<'_>, size: [u32; 2]) -> Result<Frame> {
        gpu.expect_alive()?;
        let mut materials: Vec<&Material> = Vec::new();
        for object in input.objects {
            if !materials.iter().any(|known| known.is(object.material)) {
                materials.push(object.material);
            }
            #[cfg(feature = "transfer")]
            if let Material::Transfer(material) = object.material {
                material.expect(object.mesh)?;
            }
        }
        if size.contains(&0) {
            return Err(Error::Usage(format!("a frame of {size:?} pixels")));
        }
        expect_groups(materials.len())?;
        let lights = input.drawn_shadows(&self.options)?;
        let divisor = self.divisor(input, size);
        let most = gpu.device.limits().max_texture_dimension_2d;
        let [light_texels, light_columns] = Plan::tiles(lights, self.options.light_texels, most);
        let plan = Plan {
            size,
            light_texels,
            lights,
            light_columns,
            divisor,
            blur_size: self.blur_size(input, &materials, divisor, size),
            has_light_levels: materials.iter().any(|material| matches!(material, Material::Splat(_))),
        };
        let bytes = |plan: &Plan| {
            let blocks = UNIFORMS * (1 + materials.len() as u64) + Common::bytes_of(self.options.objects);
            self.map_bytes(&materials, plan) + TranslucentShadowMaps::bytes_of(gpu, plan) + blocks
        };
        let plan = plan.within(self.options.budget_bytes, gpu.ledger().bytes(), bytes)?;
        let common = Common::new(gpu, self.tsm.of(&plan), self.options.objects)?;
        let lights = TranslucentShadowMaps::new(gpu, self.tsm.of(&plan), &common.scene, &plan)?;
        let sampler = reflection_sampler(gpu);
        let of_scene = [
            common.scene.as_entire_binding(),
            BindingResource::TextureView(lights.views()[0]),
            BindingResource::TextureView(&common.reflections.view),
            BindingResource::Sampler(&sampler),
        ];
        let mut shared = Shared::default();
        let mut slots = Vec::new();
        for material in materials {
            let bindings = self.bind(gpu, (material, slots.len()), &common, &lights, &plan, &mut shared)?;
            let scene = bindings.shade().0.bind(gpu, 0, &of_scene)?;
            slots.push(Slot { material: material.clone(), scene, bindings, bounds: None });
        }
        let objects = self.options.objects as usize;
        Ok(Frame {
            plan,
            wanted_divisor: divisor,
            common,
            lights,
            slots,
            placed: Vec::with_capacity(objects),
            blocks: Vec::new(),
        })
    }

    /// Whether a frame that was prepared serves an input as well as another one would: its size, its materials and its shadows are
    /// there, and its maps are about as fine as the view needs.
    ///
    /// # Errors
    /// [`Error::Usage`] if there are too many lights, or a shadow map is not what it has to be.
    pub fn serves(&self, frame: &Frame, input: &Input<'_>, size: [u32; 2]) -> Result<bool> {
        let is_known = |object: &Object<'_>| frame.slots.iter().any(|slot| slot.material.is(object.material));
        let has_room = frame.plan.size == size && frame.plan.lights >= input.drawn_shadows(&self.options)?;
        let ratio = self.divisor(input, size) / frame.wanted_divisor;
        Ok(has_room && input.objects.iter().all(is_known) && (1.0 / FINENESS..=FINENESS).contains(&ratio))
    }

    /// Bytes of the maps of some materials.
    fn map_bytes(&self, materials: &[&Material], plan: &Plan) -> u64 {
        let splats = materials.iter().any(|material| matches!(material, Material::Splat(_)));
        #[cfg(feature = "reference")]
        let of_rivals: u64 = materials
            .iter()
            .filter_map(|material| match material {
                Material::Linsss(of) => Some(linsss::Maps::bytes_of(plan.blur_size, of.gaussians(), of.is_shortcut())),
                _ => None,
            })
            .sum();
        #[cfg(not(feature = "reference"))]
        let of_rivals = 0;
        #[cfg(feature = "transfer")]
        let of_tables: u64 = materials
            .iter()
            .filter_map(|material| match material {
                Material::Transfer(of) => Some(transfer::bytes_of(of)),
                _ => None,
            })
            .sum();
        #[cfg(not(feature = "transfer"))]
        let of_tables = 0;
        of_rivals
            + of_tables
            + self.blur_bytes(materials, plan.blur_size)
            + if splats { splat::Maps::bytes_of(plan, &self.options) } else { 0 }
    }

    /// Bytes of the maps of blurs on the screen, of so many texels.
    fn blur_bytes(&self, materials: &[&Material], size: [u32; 2]) -> u64 {
        let of_terms = terms_of(materials).into_iter();
        let of_terms = of_terms.map(|terms| separable::Maps::bytes_of(size, terms, &self.options));
        let has_kernel = |has_several| {
            let of = |material: &&Material| matches!(material, Material::Kernel(of) if (of.terms() > 1) == has_several);
            materials.iter().any(of)
        };
        let of_kernels = [false, true].into_iter().filter(|several| has_kernel(*several));
        let of_kernels = of_kernels.map(|several| kernel::Maps::bytes_of(size, several, &self.options));
        of_terms.chain(of_kernels).sum()
    }

    /// Width and height of the maps of blurs on the screen: as many texels as their bytes for each pixel allow, in the shape of what the
    /// objects of a material cover.
    fn blur_size(&self, input: &Input<'_>, materials: &[&Material], divisor: f32, size: [u32; 2]) -> [u32; 2] {
        let mut bytes = self.blur_bytes(materials, LARGE);
        if bytes == 0 && materials.iter().any(|material| is_blurred(material)) {
            bytes = separable::Maps::bytes_of(LARGE, 1, &self.options);
        }
        #[allow(clippy::cast_precision_loss, reason = "a few dozen a texel")]
        let held = (bytes / u64::from(LARGE[0] * LARGE[1])) as f32 / self.options.map_bytes_per_pixel;
        let covered = materials.iter().filter_map(|material| {
            let of_material = |object: &&Object<'_>| object.material.is(material);
            let bounds = input.objects.iter().filter(of_material).map(Object::bounds);
            let seen = bounds.filter(|bounds| input.view.sees(bounds)).reduce(|all, bounds| all.union(&bounds))?;
            is_blurred(material).then(|| input.view.rectangle(&seen))
        });
        let covered = covered.map(|[low, high]| 0.5 * (high - low)).reduce(glam::Vec2::max);
        MapArea::shape(size, divisor, held.sqrt(), covered.unwrap_or(glam::Vec2::ONE))
    }

    /// Binds a material, number `slot` of the frame, to the maps of its technique.
    fn bind(
        &self,
        gpu: &Gpu,
        (material, slot): (&Material, usize),
        common: &Common,
        lights: &TranslucentShadowMaps,
        plan: &Plan,
        shared: &mut Shared,
    ) -> Result<Box<dyn Bindings>> {
        match material {
            Material::Gather(material) => self.gather.of(material.planes.layout())?.bind(gpu, material, common),
            Material::Splat(material) => {
                let passes = self.splat.of(material.planes.layout())?;
                let maps = match &shared.splat {
                    Some(maps) => maps.clone(),
                    None => shared.splat.insert(Arc::new(splat::Maps::new(gpu, plan, &self.options)?)).clone(),
                };
                passes.bind(gpu, (material, slot), common, lights, &maps, plan)
            }
            Material::Separable(material) => {
                let terms = material.terms();
                let passes = self.separable.of(terms)?;
                let make = || separable::Maps::new(gpu, plan, &self.options, terms);
                let maps = made_once(&mut shared.separable, terms, make)?;
                passes.bind(gpu, material, common, lights, &maps)
            }
            #[cfg(feature = "reference")]
            Material::Linsss(material) => {
                let (count, depth) = (material.gaussians(), self.options.depth.format);
                let maps = linsss::Maps::new(gpu, plan.blur_size, count, material.is_shortcut(), depth)?;
                self.linsss.of(())?.bind(gpu, material, common, lights, maps)
            }
            Material::Kernel(material) => {
                let (passes, has_several) = (self.kernel.of(())?, material.terms() > 1);
                let make = || kernel::Maps::new(gpu, plan, &self.options, has_several);
                let maps = made_once(&mut shared.kernel, has_several, make)?;
                passes.bind(gpu, material, common, lights, &maps)
            }
            Material::Btf(material, number) => self.btf.of(material.layout())?.bind(gpu, material, *number),
            #[cfg(feature = "transfer")]
            Material::Transfer(material) => self.transfer.of(())?.bind(gpu, material),
        }
    }

    /// Pixels of the picture to a side of a texel of the maps: as few as any object needs.
    fn divisor(&self, input: &Input<'_>, size: [u32; 2]) -> f32 {
        let (view, light_texels) = (&input.view, self.options.light_texels);
        let bounds: Vec<_> = input.objects.iter().map(Object::bounds).collect();
        let radius_mm =
            bounds.iter().copied().reduce(|all, bounds| all.union(&bounds)).map_or(1.0, |all| all.radius_mm);
        let divisors = input.objects.iter().zip(&bounds).filter_map(|(object, bounds)| {
            let distance_mm = if view.is_parallel() {
                1.0
            } else {
                let from_eye = bounds.centre_mm - view.eye_mm();
                let depth_mm = from_eye.dot(view.forward());
                // What is beside the eye or around it is seen from about its radius, if at all.
                if depth_mm < bounds.radius_mm { from_eye.length().max(bounds.radius_mm) } else { depth_mm }
            };
            // Along the axis where pixels are larger.
            #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
            let of_tangent = size.map(|side| 0.5 * side as f32);
            let pixels_per_mm = (of_tangent[0] * view.focal().x).min(of_tangent[1] * view.focal().y) / distance_mm;
            match object.material {
                Material::Separable(material) => Some(separable::divisor(material, pixels_per_mm)),
                Material::Splat(material) => {
                    Some(splat::divisor(material.planes.header(), radius_mm, light_texels, pixels_per_mm))
                }
                #[cfg(feature = "reference")]
                Material::Linsss(material) => {
                    Some(separable::divisor_of(material.narrowest_pixels(), material.header().pitch_mm, pixels_per_mm))
                }
                Material::Kernel(material) => Some(kernel::divisor(material, pixels_per_mm)),
                Material::Gather(_) | Material::Btf(..) => None,
                #[cfg(feature = "transfer")]
                Material::Transfer(_) => None,
            }
        });
        divisors.reduce(f32::min).unwrap_or(1.0)
    }
}

/// Whether a material is drawn by blurs on the screen.
fn is_blurred(material: &Material) -> bool {
    match material {
        Material::Separable(_) | Material::Kernel(_) => true,
        // A rival gets maps as fine as those of one term.
        #[cfg(feature = "reference")]
        Material::Linsss(_) => true,
        _ => false,
    }
}

/// Numbers L of the separable materials among some, each once.
fn terms_of(materials: &[&Material]) -> Vec<usize> {
    let mut all = Vec::new();
    for material in materials {
        if let Material::Separable(material) = material
            && !all.contains(&material.terms())
        {
            all.push(material.terms());
        }
    }
    all
}

/// Most materials of a frame: numbers of groups are half floats in shadow maps, whole up to this.
const MOST_GROUPS: usize = 2_048;

/// Refuses more materials than shadow maps tell apart.
fn expect_groups(materials: usize) -> Result<()> {
    if materials > MOST_GROUPS {
        return Err(Error::Usage(format!("{materials} materials; a frame has at most {MOST_GROUPS}")));
    }
    Ok(())
}

impl Frame {
    /// Sizes that were chosen within the budget.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_as_many_as_half_floats_tell_apart() {
        let whole = |slot| half::f16::from_f32(crate::technique::group_number(slot)).to_f32();
        let last = MOST_GROUPS - 1;
        assert_eq!(whole(last) - whole(last - 1), 1.0, "the last one");
        assert_eq!(whole(MOST_GROUPS), whole(last), "the one after it is the same");
        expect_groups(MOST_GROUPS).unwrap();
        match expect_groups(MOST_GROUPS + 1) {
            Err(Error::Usage(reason)) => assert_eq!(reason, "2049 materials; a frame has at most 2048"),
            other => panic!("{other:?}"),
        }
    }
}
