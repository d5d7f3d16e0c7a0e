//! The passes, as WGSL text, to be completed by [`Keeping::complete`].

use crate::separable::MAX_TERMS;

/// How a material's reflectance is stored on the device; each has the functions `load_pixel`, `partner_at` and
/// `reflectance`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// One base material per pixel.
    Single,
    /// Two base materials per pixel, an index for each.
    Bmpp,
    /// Two base materials per pixel, from a palette of pairs.
    Palette,
    /// Three base materials per pixel.
    Three,
    /// Five base materials per pixel.
    Five,
    /// A profile for every pixel.
    PerPixel,
    /// Every entry of an uncompressed capture.
    Capture,
}

impl Storage {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Single, Self::Bmpp, Self::Palette, Self::Three, Self::Five, Self::PerPixel, Self::Capture];
}

/// How passes keep four values for later ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keeping {
    /// As half floats.
    Halves,
    /// As the bits of half floats in integers, which every GLES 3.0 device draws to. They cannot be added up or sampled:
    /// for splats and for blurs on flat patches it takes half floats.
    Packed,
}

impl Keeping {
    /// A pass of this module with what says how it keeps values: the text to compile.
    #[must_use]
    pub fn complete(self, pass: &str) -> String {
        let prelude = match self {
            Self::Halves => include_str!("../wgsl/lib/target_half.wgsl"),
            Self::Packed => include_str!("../wgsl/lib/target_packed.wgsl"),
        };
        format!("{prelude}{pass}")
    }
}

/// Files one after another, what all materials share first.
macro_rules! with_material {
    ($($part:literal),+) => {
        concat!(include_str!("../wgsl/material/material.wgsl"), $(include_str!(concat!("../wgsl/", $part))),+)
    };
}

/// A pass for the storage of fitted materials.
macro_rules! by_storage {
    ($storage:expr, $capture:expr, $($pass:literal),+) => {
        match $storage {
            Storage::Single => with_material!("material/base_profiles.wgsl", "material/bmpp1.wgsl", "material/reflectance.wgsl", $($pass),+),
            Storage::Bmpp => with_material!("material/base_profiles.wgsl", "material/bmpp2.wgsl", "material/bmpp2_indices.wgsl", "material/reflectance.wgsl", $($pass),+),
            Storage::Palette => with_material!("material/base_profiles.wgsl", "material/bmpp2.wgsl", "material/bmpp2_palette.wgsl", "material/reflectance.wgsl", $($pass),+),
            Storage::Three => concat!(
                "const PER_PIXEL: u32 = 3u;\n",
                with_material!("material/base_profiles.wgsl", "material/bmpp_k.wgsl", "material/reflectance.wgsl", $($pass),+)
            ),
            Storage::Five => concat!(
                "const PER_PIXEL: u32 = 5u;\n",
                with_material!("material/base_profiles.wgsl", "material/bmpp_k.wgsl", "material/reflectance.wgsl", $($pass),+)
            ),
            Storage::PerPixel => with_material!("material/per_pixel.wgsl", "material/reflectance.wgsl", $($pass),+),
            Storage::Capture => $capture,
        }
    };
}

/// Exitance of a flat patch; entry points `cover` and `gather`.
#[must_use]
pub const fn gather(storage: Storage) -> &'static str {
    by_storage!(storage, with_material!("material/capture.wgsl", "lib/fullscreen.wgsl", "pass/patch/gather.wgsl"), "lib/fullscreen.wgsl", "pass/patch/gather.wgsl")
}

/// Exitance at the points of a surface; entry points `cover` and `surface_gather`. Captures have no distances but those
/// of their own patch: nothing for them.
#[must_use]
pub const fn surface_gather(storage: Storage) -> &'static str {
    by_storage!(storage, "", "lib/fullscreen.wgsl", "pass/surface/surface_gather.wgsl")
}

/// Irradiance at the points of a surface; entry points `cover` and `irradiance`.
pub const IRRADIANCE: &str = concat!(
    include_str!("../wgsl/lib/fresnel.wgsl"),
    include_str!("../wgsl/lib/scene.wgsl"),
    include_str!("../wgsl/lib/fullscreen.wgsl"),
    include_str!("../wgsl/pass/surface/irradiance.wgsl")
);

/// What a light sees of a mesh; entry points `project` and `see`.
pub const LIGHT_VIEW: &str = concat!(
    include_str!("../wgsl/lib/fresnel.wgsl"),
    include_str!("../wgsl/lib/scene.wgsl"),
    include_str!("../wgsl/lib/mesh/mapping.wgsl"),
    include_str!("../wgsl/lib/light_depth.wgsl"),
    include_str!("../wgsl/lib/screen/tsm.wgsl"),
    include_str!("../wgsl/pass/tsm/tsm_render.wgsl")
);

/// Files one after another, what says how many weighted maps there are first.
macro_rules! with_terms {
    ($terms:expr, $($part:literal),+) => {
        match $terms {
            1 => concat!(include_str!("../wgsl/lib/blur/terms_1.wgsl"), $(include_str!(concat!("../wgsl/", $part))),+),
            _ => concat!(include_str!("../wgsl/lib/blur/terms_2.wgsl"), $(include_str!(concat!("../wgsl/", $part))),+),
        }
    };
}

/// Where maps lie that are blurred.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// On a flat patch.
    Patch,
    /// On the screen.
    Screen,
}

/// One stage of the cascade along rows; entry points `cover` and `blur`.
#[must_use]
pub const fn blur_rows(domain: Domain, terms: usize) -> &'static str {
    match domain {
        Domain::Patch => {
            with_terms!(terms, "lib/fullscreen.wgsl", "lib/blur/domain_patch.wgsl", "lib/blur/blur.wgsl", "lib/blur/maps_stage.wgsl", "pass/patch/blur_patch_rows.wgsl")
        }
        Domain::Screen => {
            with_terms!(terms, "lib/fullscreen.wgsl", "lib/blur/domain_screen.wgsl", "lib/blur/blur.wgsl", "pass/patch/blur_patch_rows.wgsl")
        }
    }
}

/// The first stage along rows of a flat patch, from its factors and the light on it; entry points `cover` and `blur`.
#[must_use]
pub const fn first_rows(terms: usize) -> &'static str {
    with_terms!(terms, "lib/fullscreen.wgsl", "lib/blur/domain_patch.wgsl", "lib/blur/blur.wgsl", "lib/blur/maps_irradiance.wgsl", "pass/patch/blur_patch_rows.wgsl")
}

/// One stage along columns, and the sum of the stages; entry points `cover` and `blur`.
#[must_use]
pub const fn blur_columns(domain: Domain, terms: usize) -> &'static str {
    match domain {
        Domain::Patch => with_terms!(
            terms,
            "lib/fullscreen.wgsl",
            "lib/blur/domain_patch.wgsl",
            "lib/blur/blur.wgsl",
            "lib/blur/maps_stage.wgsl",
            "lib/blur/stage_sum.wgsl",
            "pass/patch/blur_patch_columns.wgsl"
        ),
        Domain::Screen => {
            with_terms!(terms, "lib/fullscreen.wgsl", "lib/blur/domain_screen.wgsl", "lib/blur/blur.wgsl", "lib/blur/stage_sum.wgsl", "pass/patch/blur_patch_columns.wgsl")
        }
    }
}

/// The last stage along columns of a flat patch, and its exitance; entry points `cover` and `blur`.
#[must_use]
pub const fn last_columns(terms: usize) -> &'static str {
    with_terms!(terms, "lib/fullscreen.wgsl", "lib/blur/domain_patch.wgsl", "lib/blur/blur.wgsl", "lib/blur/maps_stage.wgsl", "lib/blur/stage_sum.wgsl", "pass/patch/blur_patch_last.wgsl")
}

/// One kernel for a whole patch, along one axis; entry points `cover` and `homogeneous`.
pub const HOMOGENEOUS: &str = concat!(include_str!("../wgsl/lib/fullscreen.wgsl"), include_str!("../wgsl/pass/patch/homogeneous.wgsl"));

/// L weighted irradiance maps where the eye sees a mesh; entry points `project` and `weigh`.
#[must_use]
pub const fn weigh_mesh(terms: usize) -> &'static str {
    with_terms!(
        terms,
        "lib/fresnel.wgsl",
        "lib/scene.wgsl",
        "lib/mesh/mapping.wgsl",
        "lib/light_depth.wgsl",
        "lib/screen/tsm_visibility.wgsl",
        "lib/mesh/patch_layers.wgsl",
        "lib/blur/separable_basis.wgsl",
        "lib/mesh/vertex_none.wgsl",
        "lib/mesh/vertex.wgsl",
        "lib/screen/transmission.wgsl",
        "pass/separable/separable_gbuffer.wgsl"
    )
}

/// Who encodes linear light for the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// The shader: the target takes display values.
    Here,
    /// The target, by its format.
    There,
}

/// What all pictures of meshes need, for both encodings, and more files after it.
macro_rules! lit {
    ($encoding:expr, $with:ident!($($first:expr)?), $($part:literal),+) => {
        match $encoding {
            Encoding::Here => $with!($($first,)? "lib/display.wgsl", "lib/fresnel.wgsl", "lib/scene.wgsl", "lib/coat.wgsl", "lib/tone.wgsl", "lib/light_depth.wgsl", "lib/screen/tsm_visibility.wgsl", $($part),+),
            Encoding::There => $with!($($first,)? "lib/display_none.wgsl", "lib/fresnel.wgsl", "lib/scene.wgsl", "lib/coat.wgsl", "lib/tone.wgsl", "lib/light_depth.wgsl", "lib/screen/tsm_visibility.wgsl", $($part),+),
        }
    };
}

/// A picture's shader for both encodings.
macro_rules! shading {
    ($encoding:expr, $with:ident!($($first:expr)?), $($part:literal),+) => {
        match $encoding {
            Encoding::Here => $with!($($first,)? "lib/display.wgsl", "lib/fresnel.wgsl", "lib/scene.wgsl", "lib/coat.wgsl", "lib/mesh/vertex.wgsl", "lib/tone.wgsl", "lib/mesh/shading.wgsl", $($part),+),
            Encoding::There => $with!($($first,)? "lib/display_none.wgsl", "lib/fresnel.wgsl", "lib/scene.wgsl", "lib/coat.wgsl", "lib/mesh/vertex.wgsl", "lib/tone.wgsl", "lib/mesh/shading.wgsl", $($part),+),
        }
    };
}

macro_rules! joined {
    ($($part:literal),+) => { concat!($(include_str!(concat!("../wgsl/", $part))),+) };
}

/// Picture of a mesh from the exitance of its vertices; entry points `project` and `shade`.
#[must_use]
pub const fn shade_points(encoding: Encoding) -> &'static str {
    shading!(encoding, joined!(), "lib/mesh/exitance_vertex.wgsl")
}

/// Picture of a mesh from L blurred maps; entry points `project` and `shade`.
#[must_use]
pub const fn shade_sums(encoding: Encoding, terms: usize) -> &'static str {
    shading!(
        encoding,
        with_terms!(terms),
        "lib/mesh/mapping.wgsl",
        "lib/light_depth.wgsl",
        "lib/screen/tsm_visibility.wgsl",
        "lib/mesh/patch_layers.wgsl",
        "lib/blur/separable_basis.wgsl",
        "lib/mesh/vertex_none.wgsl",
        "lib/screen/neighbours.wgsl",
        "lib/screen/upsampling.wgsl",
        "pass/separable/shade_separable.wgsl"
    )
}

/// What the eye sees of a mesh; entry points `project` and `view`.
pub const SURFACE_VIEW: &str = joined!(
    "lib/fresnel.wgsl",
    "lib/scene.wgsl",
    "lib/mesh/mapping.wgsl",
    "lib/mesh/patch_layers.wgsl",
    "lib/mesh/vertex_none.wgsl",
    "lib/mesh/vertex.wgsl",
    "pass/splat/surface_gbuffer.wgsl"
);

/// The next level of what a light sees; entry points `cover` and `reduce`.
pub const REDUCE: &str = joined!("lib/fullscreen.wgsl", "lib/screen/tsm.wgsl", "pass/tsm/tsm_reduce.wgsl");

/// Light of samples on what lies around them; entry points `spread` and `splat`. Nothing for captures.
#[must_use]
pub const fn splat(storage: Storage) -> &'static str {
    by_storage!(storage, "", "pass/splat/splat.wgsl")
}

/// All rings of splats in one picture; entry points `cover` and `collapse`.
pub const COLLAPSE: &str = joined!("lib/fullscreen.wgsl", "lib/screen/neighbours.wgsl", "pass/splat/splat_resolve.wgsl");

/// Picture of a mesh from splats; entry points `project` and `shade`.
#[must_use]
pub const fn shade_splats(encoding: Encoding) -> &'static str {
    shading!(
        encoding,
        joined!(),
        "lib/mesh/mapping.wgsl",
        "lib/light_depth.wgsl",
        "lib/screen/tsm_visibility.wgsl",
        "lib/mesh/patch_layers.wgsl",
        "lib/mesh/vertex_none.wgsl",
        "lib/screen/neighbours.wgsl",
        "lib/screen/upsampling.wgsl",
        "pass/splat/shade_splat.wgsl"
    )
}

/// Picture of a flat patch; entry points `cover` and `present`.
pub const PRESENT: &str = concat!(
    include_str!("../wgsl/lib/fullscreen.wgsl"),
    include_str!("../wgsl/lib/tone.wgsl"),
    include_str!("../wgsl/pass/patch/present.wgsl")
);

/// How a bidirectional texture function is stored on the device; each has the functions `seen_from`, `apparent_of`,
/// `value_of`, `sampler_of`, `sampled` and `density_of`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BtfStorage {
    /// Nested codebooks: a file as it is.
    Nested,
    /// An image for every pair of a light and a view, uncompressed.
    Images,
}

impl BtfStorage {
    /// Both of them.
    pub const ALL: [Self; 2] = [Self::Nested, Self::Images];
}

/// What reads nested codebooks, and more files after it.
macro_rules! with_nested {
    ($($part:literal),+) => {
        joined!(
            "material/btf/btf_words.wgsl", "material/btf/btf_angle.wgsl", "material/btf/btf_grid.wgsl", "material/btf/btf_chain.wgsl", "lib/from_srgb.wgsl", "material/btf/btf_colour.wgsl",
            "material/btf/btf_sampler.wgsl", $($part),+
        )
    };
}

/// What reads images, and more files after it.
macro_rules! with_images {
    ($($part:literal),+) => { joined!("material/btf/btf_angle.wgsl", "lib/from_srgb.wgsl", "material/btf/btf_images.wgsl", $($part),+) };
}

/// Values and samples of a BTF for lists of directions; entry points `cover` and `answer`.
#[must_use]
pub const fn btf_query(storage: BtfStorage) -> &'static str {
    match storage {
        BtfStorage::Nested => with_nested!("lib/fullscreen.wgsl", "pass/btf/btf_query.wgsl"),
        BtfStorage::Images => with_images!("lib/fullscreen.wgsl", "pass/btf/btf_query.wgsl"),
    }
}

/// Files of a picture of a mesh of a BTF, with light from all around or without.
macro_rules! btf_picture {
    ($encoding:expr, $with:ident, $has_surroundings:expr) => {
        if $has_surroundings {
            lit!(
                $encoding,
                $with!(),
                "lib/mesh/btf_vertex.wgsl",
                "material/btf/btf_texture.wgsl",
                "lib/mesh/btf_tangents.wgsl",
                "material/btf/btf_ambient.wgsl",
                "pass/btf/shade_btf.wgsl"
            )
        } else {
            lit!(
                $encoding,
                $with!(),
                "lib/mesh/btf_vertex.wgsl",
                "material/btf/btf_texture.wgsl",
                "lib/mesh/btf_tangents.wgsl",
                "material/btf/ambient_none.wgsl",
                "pass/btf/shade_btf.wgsl"
            )
        }
    };
}

/// Picture of a mesh of a BTF, with samples of light from all around or without; entry points `project` and `shade`.
#[must_use]
pub const fn shade_btf(encoding: Encoding, storage: BtfStorage, has_surroundings: bool) -> &'static str {
    match storage {
        BtfStorage::Nested => btf_picture!(encoding, with_nested, has_surroundings),
        BtfStorage::Images => btf_picture!(encoding, with_images, has_surroundings),
    }
}

/// Every pass in every variant, by name, complete.
#[must_use]
pub fn all() -> Vec<(String, String)> {
    let both = |(name, pass): (String, &'static str)| {
        let packed = format!("{name}, packed");
        [(name, Keeping::Halves.complete(pass)), (packed, Keeping::Packed.complete(pass))]
    };
    passes().into_iter().flat_map(both).collect()
}

fn passes() -> Vec<(String, &'static str)> {
    let gathers = Storage::ALL.into_iter().map(|storage| (format!("gather, {storage:?}"), gather(storage)));
    let fitted = Storage::ALL.into_iter().filter(|storage| *storage != Storage::Capture);
    let on_surfaces = fitted.flat_map(|storage| {
        [
            (format!("surface gather, {storage:?}"), surface_gather(storage)),
            (format!("splat, {storage:?}"), splat(storage)),
        ]
    });
    let separable = (1..=MAX_TERMS).flat_map(|terms| {
        let of_domain = |domain| {
            [
                (format!("blur rows, {domain:?}, L = {terms}"), blur_rows(domain, terms)),
                (format!("blur columns, {domain:?}, L = {terms}"), blur_columns(domain, terms)),
            ]
        };
        let others = [
            (format!("blur first rows, Patch, L = {terms}"), first_rows(terms)),
            (format!("blur last columns, Patch, L = {terms}"), last_columns(terms)),
            (format!("weigh mesh, L = {terms}"), weigh_mesh(terms)),
            (format!("shade sums, L = {terms}"), shade_sums(Encoding::Here, terms)),
            (format!("shade sums there, L = {terms}"), shade_sums(Encoding::There, terms)),
        ];
        others.into_iter().chain(of_domain(Domain::Patch)).chain(of_domain(Domain::Screen))
    });
    let others = [
        ("irradiance", IRRADIANCE),
        ("light view", LIGHT_VIEW),
        ("shade points", shade_points(Encoding::Here)),
        ("shade points there", shade_points(Encoding::There)),
        ("surface view", SURFACE_VIEW),
        ("reduce", REDUCE),
        ("collapse", COLLAPSE),
        ("shade splats", shade_splats(Encoding::Here)),
        ("shade splats there", shade_splats(Encoding::There)),
        ("present", PRESENT),
        ("homogeneous", HOMOGENEOUS),
    ];
    let others = others.into_iter().map(|(name, text)| (name.to_owned(), text));
    let btfs = BtfStorage::ALL.into_iter().flat_map(|storage| {
        [
            (format!("BTF query, {storage:?}"), btf_query(storage)),
            (format!("shade BTF, {storage:?}"), shade_btf(Encoding::Here, storage, true)),
            (format!("shade BTF there, {storage:?}"), shade_btf(Encoding::There, storage, true)),
            (format!("shade BTF in the dark, {storage:?}"), shade_btf(Encoding::Here, storage, false)),
            (format!("shade BTF in the dark there, {storage:?}"), shade_btf(Encoding::There, storage, false)),
        ]
    });
    gathers.chain(on_surfaces).chain(separable).chain(others).chain(btfs).collect()
}
