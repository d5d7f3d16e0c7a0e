//! Uniform blocks have the same members at the same offsets in WGSL and in Rust.

use std::mem::{offset_of, size_of};

use naga::TypeInner;
use subsurf_shaders::passes::{ALL, Choice, table};
use subsurf_shaders::{MaterialLayout, TargetFormat, uniform};

/// Every variant of every pass for every target format: name and WGSL.
fn all() -> Vec<(String, String)> {
    let variants = ALL.into_iter().flat_map(|pass| pass.variants());
    let texts = variants.flat_map(|variant| TargetFormat::ALL.map(|target| (variant.name(), variant.wgsl(target))));
    texts.collect()
}

/// Asserts that the WGSL struct `name` has exactly `members` (name, offset), and `size` bytes, wherever there is one.
fn assert_layout(name: &str, size: usize, members: &[(&str, usize)]) {
    let mut found = 0;
    for (pass, text) in &all() {
        let module = naga::front::wgsl::parse_str(text).unwrap();
        let structs = module.types.iter().filter(|(_, ty)| ty.name.as_deref() == Some(name));
        for (_, ty) in structs {
            let TypeInner::Struct { members: wgsl, span } = &ty.inner else {
                panic!("{pass}: {name} is no struct");
            };
            // Padding has no meaning; what has one must be in both.
            let wgsl = wgsl.iter().map(|member| (member.name.as_deref().unwrap(), member.offset as usize));
            let wgsl: Vec<(&str, usize)> = wgsl.filter(|(name, _)| !name.starts_with("pad")).collect();
            assert_eq!(wgsl, members, "{pass}: {name}");
            assert_eq!(*span as usize, size, "{pass}: size of {name}");
            found += 1;
        }
    }
    assert!(found > 0, "no pass has a struct {name}");
}

macro_rules! assert_layout_of {
    ($name:ident: $($member:ident),+) => {
        assert_layout(
            stringify!($name),
            size_of::<uniform::$name>(),
            &[$((stringify!($member), offset_of!(uniform::$name, $member))),+],
        )
    };
}

#[test]
fn uniforms_are_laid_out_as_in_wgsl() {
    assert_layout_of!(Material: size, addressing, window_radius, samples, base_materials, pitch_mm, r_max_mm, nodes_per_mm, rows);
    assert_layout_of!(PatchRegion: origin);
    assert_layout_of!(PatchDomain: size, addressing);
    assert_layout_of!(PointGrid: origin_mm, cell_mm, cells, points);
    assert_layout_of!(LightSource: clip_from_world, position_or_direction, is_local, irradiance, cos_outer, axis, cos_inner, middle_mm, texel_mm, shadow, map);
    assert_layout_of!(Scene: clip_from_world, eye_mm, exposure, forward, lights, centre_mm, light_texels, light_columns, sky, light);
    assert_layout_of!(Object: world_from_mesh, place_from_world, uv_scale, patches_per_mm, is_boxed, eta, sky_transmittance, roughness, depth_offset_mm, group, handedness);
    assert_layout_of!(TsmLight: light, group, level);
    assert_layout_of!(Splat: softening_gain, clip_from_centre, fade_in, fade_out, middle_mm, texel_mm, tile, level, side, refines, stride, pitch_mm, group, columns);
    assert_layout_of!(SplatRings: count, near_mm);
    assert_layout_of!(Upsampling: texels_per_pixel, origin, near_mm, last);
    assert_layout_of!(Transmission: weights, gaussians);
    assert_layout_of!(Volume: world_from_clip, origin_mm, cell_mm, cells, columns, first, group, pitch_mm);
    assert_layout_of!(Frame: size, texels, exposure);
    assert_layout_of!(BlurStage: weights, axis, sigma, stride, taps, step, sparse, has_sum);
    assert_layout_of!(Kernel: weights, axis, taps);
    assert_layout_of!(BtfTable: start, width, row_bits, index_bits, last, code_mask, sign_at, sign_mask, step, offset);
    assert_layout_of!(BtfCodebooks: chains, merged, i2, i1, p2_bytes, p1, is_signed, colours, tints, tint_count, tint_at, i2_mask, last_i2, stages, is_relative, first, step, nodes, alpha_max, sin_beta_max, theta_max, cos_light_min, colour_encoding, white, octaves, last_word);
    assert_layout_of!(BtfImages: light_rings, view_rings, rings, size, tiles, white, cos_light_min);
    assert_layout_of!(BtfTexture: levels, count, filtering, samples);
    assert_layout_of!(KernelTerm: taps, sign, axis, side, falloff);
    assert_layout_of!(KernelProfile: reflectance, radius_mm, last_node, spread_mm);
    assert_layout_of!(Transfer: codes, components, texels);
    assert_layout_of!(Linsss: sigmas_mm, gaussians, is_exact, turn);
    assert_layout_of!(LinsssStage: sigma_mm, axis, size, focal_texels, middle_mm, perspective, levels, level, most);
    assert_layout_of!(ScreenDomain: size, focal_texels, middle_mm, pitch_mm, perspective, is_jittered);
}

/// WGSL of the reference pass for a layout.
fn gather(layout: MaterialLayout) -> String {
    table::GATHER.with(Choice::Material(layout)).wgsl(TargetFormat::Half)
}

#[test]
fn palette_codes_are_those_of_the_format() {
    use subsurf_decoder::bssrdf::layout::{MAX_CODED_RATIO, MAX_PAIRS};
    let text = gather(MaterialLayout::Bmpp2Palette);
    for wanted in [format!("code % {MAX_PAIRS}u"), format!("code / {MAX_PAIRS}u) / {MAX_CODED_RATIO}.0")] {
        assert!(text.contains(&wanted), "{wanted}");
    }
}

#[test]
fn taps_on_the_screen_are_those_of_the_shader() {
    use subsurf_shaders::uniform::MOST_TAPS;
    let text = table::BLUR_SCREEN.with(Choice::Terms(1)).wgsl(TargetFormat::Half);
    for wanted in [
        format!("const MOST_TAPS: f32 = {MOST_TAPS:.1};"),
        "let sigma = stage.step * texels_per_pixel;".to_owned(),
        "let sparse = max(floor(stage.sparse * texels_per_pixel), 1.0);".to_owned(),
        "let taps = clamp(ceil(3.2 * sigma / sparse), 1.0, MOST_TAPS);".to_owned(),
    ] {
        assert!(text.contains(&wanted), "{wanted}");
    }
}

/// Numbers that stand in both languages.
#[test]
fn addressing_codes_are_those_of_the_format() {
    use subsurf_decoder::bssrdf::Addressing;
    let codes = [Addressing::Clamp, Addressing::Repeat, Addressing::Mirror].map(Addressing::code);
    assert_eq!(codes, [0, 1, 2]);
    let text = gather(MaterialLayout::Bmpp2);
    assert!(
        text.contains("material.addressing == 0u") && text.contains("material.addressing == 2u"),
        "clamp and mirror"
    );
}

#[test]
fn rows_of_arrays_are_those_of_the_textures() {
    use uniform::{BASE_ROWS, ROW};
    let text = gather(MaterialLayout::Capture) + &gather(MaterialLayout::Bmpp2);
    for (name, value) in [("ROW", ROW), ("BASE_ROWS", BASE_ROWS)] {
        let wanted = format!("const {name}: u32 = {value}u;");
        assert!(text.contains(&wanted), "{wanted}");
    }
}

#[test]
fn shadows_of_lights_are_those_of_the_blocks() {
    let text = table::SHADE_SPLAT.only().wgsl(TargetFormat::Half);
    for (name, value) in [
        ("NO_SHADOW", uniform::NO_SHADOW),
        ("OWN_SHADOW", uniform::OWN_SHADOW),
        ("HOST_SHADOW", uniform::HOST_SHADOW),
        ("HOST_SHADOW_REVERSED", uniform::HOST_SHADOW_REVERSED),
    ] {
        let wanted = format!("const {name}: u32 = {value}u;");
        assert!(text.contains(&wanted), "{wanted}");
    }
}
