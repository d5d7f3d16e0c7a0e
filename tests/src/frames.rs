//! Meshes made of a material, under a scene, drawn by any technique on any device.

use std::path::Path;

use glam::Vec3;
use subsurf_decoder::{Bssrdf, Kernel};
use subsurf_encoder::metrics::psnr_db;
use subsurf_runtime::{
    BACKGROUND, Backend, BssrdfPlanes, Frame, GatherMaterial, Gpu, GpuMesh, GpuPoints, Input, Load, Material, Object,
    PictureTarget, Renderer, Result, RuntimeOptions, VertexData,
};
use subsurf_scene::{
    AmbientTransfer, Camera, Environment, Light, LightShape, Mapping, Mesh, Scene, Shadow, SurfacePoints, visibility,
};
use subsurf_shaders::separable::BasisNumbers;

/// Display values: steps of 255 between the two APIs. Their arithmetic is the same but for rounding; sums of splats are
/// half floats that lose up to 2⁻¹¹ with each addition.
pub const API_TOLERANCE: u8 = 2;
/// Share of pixels that may differ more: edges of triangles and of shadows, where a sample goes to one side or the other.
pub const EDGE_PIXELS: f64 = 0.01;
/// Pixels of the pictures.
pub const SIZE: [u32; 2] = [320, 240];

/// Pictures whose pixels differ by more than [`API_TOLERANCE`]: the share of them that do.
#[must_use]
pub fn share_that_differs(a: &[[u8; 3]], b: &[[u8; 3]]) -> f64 {
    let far = |(a, b): &(&[u8; 3], &[u8; 3])| (0..3).any(|c| a[c].abs_diff(b[c]) > API_TOLERANCE);
    a.iter().zip(b).filter(far).count() as f64 / a.len() as f64
}

/// # Panics
/// If there is none.
#[must_use]
pub fn device(backend: Backend) -> Gpu {
    Gpu::open(backend).unwrap_or_else(|error| panic!("{error}: run `make test`, which installs one"))
}

/// One light from the side, with shadow, and a sky, seen from where a mesh fills the picture.
#[must_use]
pub fn scene(mesh: &Mesh) -> Scene {
    let radius = mesh.positions.iter().map(|position| position.length()).fold(0.0, f32::max);
    let towards = Vec3::new(0.5, 0.3, 0.8).normalize();
    Scene {
        lights: vec![Light {
            shape: LightShape::Directional { towards: Vec3::new(0.9, 1.1, 0.35) },
            irradiance: [3.0, 2.9, 2.7],
            shadow: Shadow::Drawn,
        }],
        environment: Environment::uniform([0.35, 0.4, 0.5]),
        roughness: 0.25,
        camera: Camera { eye_mm: 4.2 * radius * towards, target_mm: Vec3::ZERO, fov_y_rad: 0.5, exposure: 0.9 },
    }
}

/// What paths draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RenderMode {
    /// The reference.
    Gather,
    /// Splats.
    Splat,
    /// The separable path.
    Separable,
}

/// A mesh and a material on a device, for one path.
pub struct Loaded {
    /// Mesh.
    pub mesh: GpuMesh,
    /// Material.
    pub material: Material,
    /// Rule by which one lies on the other.
    pub mapping: Mapping,
}

impl Loaded {
    /// Under [`scene`], by texture coordinates.
    ///
    /// # Panics
    /// If the device takes none of it.
    #[must_use]
    pub fn new(gpu: &Gpu, mode: RenderMode, file: &[u8], mesh: &Mesh) -> Self {
        Self::under(gpu, mode, file, mesh, Mapping::Uv([2.0, 1.0]), &scene(mesh))
    }

    /// # Panics
    /// If the device takes none of it.
    #[must_use]
    pub fn under(gpu: &Gpu, mode: RenderMode, file: &[u8], mesh: &Mesh, mapping: Mapping, scene: &Scene) -> Self {
        let material = Bssrdf::parse(file).unwrap();
        if mode != RenderMode::Gather {
            let shares = AmbientTransfer::of(mesh, &material).unwrap();
            return Self { mapping, ..Self::lit(gpu, mode, file, mesh, &shares) };
        }
        // Fine enough that the sum is close to its integral.
        let fine = mesh.clone().subdivided(0.8 * material.header().pitch_mm).unwrap();
        let visibilities = visibility(&fine, &scene.lights);
        let surface = SurfacePoints::new(&fine, mapping, material.header(), &visibilities);
        let known = VertexData { points: Some(&surface.point_of), ..Default::default() };
        let points = GpuPoints::upload(gpu, &surface).unwrap();
        let planes = BssrdfPlanes::upload(gpu, &material).unwrap();
        let mesh = GpuMesh::upload(gpu, &fine, known).unwrap();
        Self { mesh, material: GatherMaterial { planes, points }.into(), mapping }
    }

    /// By texture coordinates, with the light from all around that vertices have: for the paths that are no gather.
    ///
    /// # Panics
    /// If the device takes none of it.
    #[must_use]
    pub fn lit(gpu: &Gpu, mode: RenderMode, file: &[u8], mesh: &Mesh, shares: &[AmbientTransfer]) -> Self {
        let material = Bssrdf::parse(file).unwrap();
        let material: Material = match mode {
            RenderMode::Gather => panic!("a gather needs points"),
            RenderMode::Splat => Load::splat(gpu, &material).unwrap().finish().unwrap().into(),
            RenderMode::Separable => {
                let numbers = BasisNumbers::of(&material).expect("a file with a separable basis");
                Load::separable(gpu, &material, &numbers).unwrap().finish().unwrap().into()
            }
        };
        let known = VertexData { ambient: Some(shares), ..Default::default() };
        Self { mesh: GpuMesh::upload(gpu, mesh, known).unwrap(), material, mapping: Mapping::Uv([2.0, 1.0]) }
    }

    /// A homogeneous material, with the light from all around that vertices have.
    ///
    /// # Panics
    /// If the device takes none of it.
    #[must_use]
    pub fn kernel(gpu: &Gpu, file: &[u8], mesh: &Mesh) -> Self {
        let kernel = Kernel::parse(file).unwrap();
        let shares = AmbientTransfer::of_kernel(mesh, &kernel).unwrap();
        let known = VertexData { ambient: Some(&shares), ..Default::default() };
        let material = Load::kernel(gpu, &kernel).unwrap().finish().unwrap().into();
        Self { mesh: GpuMesh::upload(gpu, mesh, known).unwrap(), material, mapping: Mapping::Box }
    }

    /// As a renderer takes it.
    #[must_use]
    pub fn object(&self, scene: &Scene) -> Object<'_> {
        Object::new(&self.mesh, &self.material, self.mapping, scene.roughness)
    }

    /// Renderer for the path.
    ///
    /// # Errors
    /// If the device cannot draw it.
    pub fn renderer(&self, gpu: &Gpu, options: RuntimeOptions) -> Result<Renderer> {
        Renderer::for_technique(gpu, self.material.technique(), options)
    }

    /// Buffers for pictures of `size` pixels.
    ///
    /// # Errors
    /// If there is no room for them.
    pub fn prepare(&self, gpu: &Gpu, renderer: &Renderer, scene: &Scene, size: [u32; 2]) -> Result<Frame> {
        renderer.prepare(gpu, &Input::new(scene, &[self.object(scene)], size), size)
    }

    /// # Panics
    /// If the device draws none.
    #[must_use]
    pub fn picture(&self, gpu: &Gpu, scene: &Scene, size: [u32; 2]) -> Vec<[u8; 3]> {
        self.picture_with(gpu, scene, size, RuntimeOptions::default())
    }

    /// # Panics
    /// If the device draws none.
    #[must_use]
    pub fn picture_with(&self, gpu: &Gpu, scene: &Scene, size: [u32; 2], options: RuntimeOptions) -> Vec<[u8; 3]> {
        let renderer = self.renderer(gpu, options).unwrap();
        let mut frame = self.prepare(gpu, &renderer, scene, size).unwrap();
        self.drawn(gpu, &renderer, &mut frame, scene, size)
    }

    /// Picture of `size` pixels by a frame that was prepared for it.
    ///
    /// # Panics
    /// If the device draws none.
    #[must_use]
    pub fn drawn(
        &self,
        gpu: &Gpu,
        renderer: &Renderer,
        frame: &mut Frame,
        scene: &Scene,
        size: [u32; 2],
    ) -> Vec<[u8; 3]> {
        let target = PictureTarget::new(gpu, size, renderer.options()).unwrap();
        renderer.picture(gpu, frame, &Input::new(scene, &[self.object(scene)], size), &target).unwrap()
    }
}

/// Small simulated material by its name in `tests/materials`, as a file.
///
/// # Panics
/// If it is not there.
#[must_use]
pub fn material_of(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("materials").join(name).with_extension("subsurf");
    std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// PSNR of display values over the pixels that the mesh covers in either picture.
///
/// # Panics
/// If it covers hardly any.
#[must_use]
pub fn psnr(reference: &[[u8; 3]], found: &[[u8; 3]]) -> f64 {
    let covered = reference.iter().zip(found).filter(|(a, b)| **a != [BACKGROUND; 3] || **b != [BACKGROUND; 3]);
    let value = |pixel: &[u8; 3]| pixel.map(|value| f64::from(value) / 255.0);
    let (a, b): (Vec<_>, Vec<_>) = covered.map(|(a, b)| (value(a), value(b))).unzip();
    assert!(10 * a.len() > reference.len(), "the mesh is in the picture");
    psnr_db(&a, &b)
}

/// Draws by every path on every device, and holds them to the gather of the first one, in dB, and to each other.
///
/// # Panics
/// If they are further apart than [`EDGE_PIXELS`] or the limits say.
pub fn assert_close(
    name: &str,
    gpus: &[Gpu; 2],
    limits: [(RenderMode, f64); 2],
    draw: impl Fn(&Gpu, RenderMode) -> Vec<[u8; 3]>,
) {
    let reference = draw(&gpus[0], RenderMode::Gather);
    for (mode, least_db) in limits {
        let pictures = gpus.each_ref().map(|gpu| draw(gpu, mode));
        let db = pictures.each_ref().map(|picture| psnr(&reference, picture));
        let share = share_that_differs(&pictures[0], &pictures[1]);
        println!("{name}, {mode:?}: {db:.1?} dB from the gather; {share} of pixels differ between the APIs");
        assert!(db.iter().all(|db| *db >= least_db), "{name}, {mode:?}: {db:?} dB");
        assert!(share <= EDGE_PIXELS, "{name}, {mode:?}: {share}");
    }
}
