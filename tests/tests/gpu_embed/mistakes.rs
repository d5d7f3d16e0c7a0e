//! What a host does wrong is said in one line, and is no failure of the device.

use glam::{Mat4, Vec3};
use subsurf_runtime::wgpu::{self, Backends, TextureFormat, TextureUsages};
use subsurf_runtime::{Error, Input, Object, Result, RuntimeOptions, ShadowMap};
use subsurf_scene::{Environment, Light, Lighting, Shadow};

use super::application;
use super::stage::{SIZE, Stage, sun};

/// Asserts that a call was refused as the caller's mistake, in a line with some words.
fn assert_refused<T: std::fmt::Debug>(result: Result<T>, words: &str) {
    match result {
        Err(Error::Usage(said)) => assert!(said.contains(words) && !said.contains('\n'), "{said}, expected: {words}"),
        other => panic!("{other:?}, expected: {words}"),
    }
}

/// Shadow map of any projection.
fn of(depth: &wgpu::TextureView) -> ShadowMap<'_> {
    ShadowMap { depth, clip_from_world: Mat4::IDENTITY, is_reversed: false }
}

/// Result of drawing an input with a frame that was prepared for another.
fn drawn(stage: &Stage, prepared: &Input<'_>, input: &Input<'_>) -> Result<()> {
    let mut frame = stage.renderer.prepare(&stage.gpu, prepared, SIZE).unwrap();
    let mut encoder = stage.app.device.create_command_encoder(&Default::default());
    let colour = stage.app.colour.create_view(&wgpu::TextureViewDescriptor::default());
    stage.renderer.draw(&stage.gpu, &mut encoder, &mut frame, input, &stage.over(&colour))
}

#[test]
fn objects_that_were_not_prepared_for() {
    let stage = Stage::open(Backends::VULKAN);
    let environment = Environment::uniform([1.0; 3]);
    let lighting = Lighting { lights: &[], environment: &environment, reference_mm: Vec3::ZERO };
    let only_jade = [stage.jade()];
    let prepared = Input { view: application::view(), exposure: 1.0, lighting, shadow_maps: &[], objects: &only_jade };
    let skewed = Object { world_from_mesh: Mat4::from_scale(Vec3::new(1.0, 2.0, 1.0)), ..stage.jade() };
    let many = [stage.jade(); 17];
    for (objects, words) in
        [(&[stage.leather()][..], "not prepared for"), (&[skewed][..], "no rotation"), (&many[..], "17 objects")]
    {
        assert_refused(drawn(&stage, &prepared, &Input { objects, ..prepared }), words);
    }
}

#[test]
fn lights_that_were_not_prepared_for_or_have_no_map() {
    let stage = Stage::with(Backends::VULKAN, RuntimeOptions { host_shadow_maps: true, ..RuntimeOptions::default() });
    let environment = Environment::uniform([1.0; 3]);
    let lit = |lights| Lighting { lights, environment: &environment, reference_mm: Vec3::ZERO };
    let objects = [stage.jade()];
    let [one, two, nine] = [1, 2, 9].map(|count| vec![sun(); count]);
    let lighting = lit(&one);
    let prepared = Input { view: application::view(), exposure: 1.0, lighting, shadow_maps: &[], objects: &objects };
    let with = |lights| Input { lighting: lit(lights), ..prepared };
    let through = [sun(), Light { shadow: Shadow::None, ..sun() }, Light { shadow: Shadow::None, ..sun() }];
    drawn(&stage, &prepared, &with(&through)).unwrap();
    drawn(&stage, &prepared, &with(&through[1..])).unwrap();
    assert_refused(drawn(&stage, &prepared, &with(&two)), "shadows of 2 lights; the frame was prepared for 1");
    assert_refused(drawn(&stage, &prepared, &with(&nine)), "9 lights; a frame has at most 8");
    assert_refused(stage.renderer.prepare(&stage.gpu, &with(&nine), SIZE), "9 lights");

    let layered = |format, usage, sample_count, layers| {
        let size = wgpu::Extent3d { width: 4, height: 4, depth_or_array_layers: layers };
        stage.app.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size,
            mip_level_count: 1,
            sample_count,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    };
    let whole = |texture: wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
    let texture = |format, usage, sample_count| whole(layered(format, usage, sample_count, 1));
    let (bound, drawn_to) = (TextureUsages::TEXTURE_BINDING, TextureUsages::RENDER_ATTACHMENT);
    let depth = texture(TextureFormat::Depth16Unorm, bound | drawn_to, 1);
    let hosted = [Light { shadow: Shadow::Host(1), ..sun() }];
    let one_map = [of(&depth)];
    let missing = Input { shadow_maps: &one_map, ..with(&hosted) };
    assert_refused(drawn(&stage, &prepared, &missing), "light 0 has shadow map 1 of 1");
    let maps = [of(&depth); 9];
    drawn(&stage, &prepared, &Input { shadow_maps: &maps[..8], ..with(&hosted) }).unwrap();
    assert_refused(drawn(&stage, &prepared, &Input { shadow_maps: &maps, ..with(&hosted) }), "9 shadow maps");
    for (view, words) in [
        (texture(TextureFormat::Rgba8Unorm, bound, 1), "shadow map 0 has Rgba8Unorm"),
        (texture(TextureFormat::Depth32Float, drawn_to, 1), "no usage TEXTURE_BINDING"),
        (texture(TextureFormat::Depth32Float, bound | drawn_to, 4), "4 samples"),
    ] {
        let maps = [of(&view)];
        assert_refused(drawn(&stage, &prepared, &Input { shadow_maps: &maps, ..with(&one) }), words);
    }
    // What a view shows of its texture only the device knows.
    let stencil = layered(TextureFormat::Depth24PlusStencil8, bound | drawn_to, 1, 1);
    let only = wgpu::TextureViewDescriptor { aspect: wgpu::TextureAspect::DepthOnly, ..Default::default() };
    let depth_alone = stencil.create_view(&only);
    let maps = [of(&depth), of(&depth_alone)];
    drawn(&stage, &prepared, &Input { shadow_maps: &maps, ..with(&hosted) }).unwrap();
    for view in [whole(stencil), whole(layered(TextureFormat::Depth16Unorm, bound | drawn_to, 1, 2))] {
        let maps = [of(&depth), of(&view)];
        let refused = drawn(&stage, &prepared, &Input { shadow_maps: &maps, ..with(&hosted) });
        assert_refused(refused, "shadow map 1 is a view of several layers, or of stencil; expected one layer");
    }
}
