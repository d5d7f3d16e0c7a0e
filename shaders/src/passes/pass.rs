//! What a pass is made of, and one pipeline's variant of it.

use super::binding::Binding;
use super::file::File;
use super::layout::{BtfLayout, MaterialLayout, TargetFormat, ambient, terms};
use subsurf_decoder::bssrdf::basis::MAX_TERMS;

/// Pass of the renderers: WGSL files that are joined, entry points and bindings. The fragment entry point is named as the
/// file.
#[derive(Clone, Copy, Debug)]
pub struct Pass {
    /// File under `wgsl/pass/` with the fragment entry point.
    pub file: File,
    /// Parts that stand before the file, in order; its first line names them.
    pub parts: &'static [Part],
    /// Vertex entry point.
    pub vertex: &'static str,
    /// Bind groups, from 0 on.
    pub groups: &'static [Group],
    /// Names of the pipeline-overridable constants, all of them booleans.
    pub overrides: &'static [&'static str],
}

/// Part of a pass: a file, or a choice between lists of files.
#[derive(Clone, Copy, Debug)]
pub enum Part {
    /// File that always belongs to the pass.
    File(File),
    /// Files of the [`TargetFormat`].
    TargetFormat,
    /// Files of a [`MaterialLayout`].
    MaterialLayout,
    /// Files of a [`MaterialLayout`] other than captures, which have no distances but those of their own patch.
    FittedLayout,
    /// Files for L weighted irradiance maps.
    Terms,
    /// Files of a [`BtfLayout`].
    BtfLayout,
    /// Files for light of the environment on BTFs, or for none.
    Ambient,
}

/// Bind group of a pass.
#[derive(Clone, Copy, Debug)]
pub enum Group {
    /// The same bindings for all variants.
    Fixed(&'static [Binding]),
    /// Bindings in which arrays of maps, of targets or of floats, are plain textures where L = 1: the GL backend makes no array
    /// of one layer.
    Maps(&'static [Binding]),
    /// Bindings of the [`MaterialLayout`].
    Material,
    /// Bindings of the [`BtfLayout`], and more after them.
    Btf(&'static [Binding]),
}

/// Choice of what a pass leaves open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// Nothing is left open.
    None,
    /// Storage of a material.
    Material(MaterialLayout),
    /// L, the number of weighted irradiance maps, 1 to [`MAX_TERMS`].
    Terms(usize),
    /// Storage of a BTF, without a picture.
    Btf(BtfLayout),
    /// Storage of a BTF, and whether it is lit by the environment, for a picture.
    LitBtf(BtfLayout, bool),
}

/// Pass with its choice made, ready to be compiled once the target format of the device is known.
#[derive(Clone, Copy, Debug)]
pub struct Variant {
    /// The pass.
    pub pass: &'static Pass,
    choice: Choice,
}

impl Pass {
    /// Variant for a choice.
    #[must_use]
    pub const fn with(&'static self, choice: Choice) -> Variant {
        Variant { pass: self, choice }
    }

    /// The only variant of a pass that leaves nothing open.
    #[must_use]
    pub const fn only(&'static self) -> Variant {
        self.with(Choice::None)
    }

    /// Name of the pass: stem of its file, and fragment entry point.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.file.stem()
    }

    /// All variants.
    #[must_use]
    pub fn variants(&'static self) -> Vec<Variant> {
        let has = |kind: fn(&Part) -> bool| self.parts.iter().any(kind);
        let fitted = MaterialLayout::ALL.into_iter().filter(|layout| *layout != MaterialLayout::Capture);
        let choices: Vec<Choice> = if has(|part| matches!(part, Part::MaterialLayout)) {
            MaterialLayout::ALL.map(Choice::Material).into()
        } else if has(|part| matches!(part, Part::FittedLayout)) {
            fitted.map(Choice::Material).collect()
        } else if has(|part| matches!(part, Part::Terms)) {
            (1..=MAX_TERMS).map(Choice::Terms).collect()
        } else if has(|part| matches!(part, Part::Ambient)) {
            let both = |layout| [true, false].map(|has_ambient| Choice::LitBtf(layout, has_ambient));
            BtfLayout::ALL.into_iter().flat_map(both).collect()
        } else if has(|part| matches!(part, Part::BtfLayout)) {
            BtfLayout::ALL.map(Choice::Btf).into()
        } else {
            vec![Choice::None]
        };
        choices.into_iter().map(|choice| self.with(choice)).collect()
    }
}

impl Part {
    /// How the first line of a pass names the part.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::File(file) => file.stem(),
            Self::TargetFormat => "<target format>",
            Self::MaterialLayout => "<material layout>",
            Self::FittedLayout => "<fitted material layout>",
            Self::Terms => "<terms>",
            Self::BtfLayout => "<BTF layout>",
            Self::Ambient => "<ambient>",
        }
    }
}

impl Variant {
    /// Name for messages: that of the pass, and the choice.
    #[must_use]
    pub fn name(&self) -> String {
        match self.choice {
            Choice::None => self.pass.name().to_owned(),
            choice => format!("{}, {choice:?}", self.pass.name()),
        }
    }

    /// Files of the variant, in order.
    ///
    /// # Panics
    /// If the choice is not one that the pass leaves open.
    #[must_use]
    pub fn files(&self, target: TargetFormat) -> Vec<File> {
        let of_part = |part: &Part| match (part, self.choice) {
            (Part::File(file), _) => vec![*file],
            (Part::TargetFormat, _) => target.files().to_vec(),
            (Part::MaterialLayout | Part::FittedLayout, Choice::Material(layout)) => layout.files().to_vec(),
            (Part::Terms, Choice::Terms(count)) => terms(count).to_vec(),
            (Part::BtfLayout, Choice::Btf(layout) | Choice::LitBtf(layout, _)) => layout.files().to_vec(),
            (Part::Ambient, Choice::LitBtf(_, has_ambient)) => ambient(has_ambient).to_vec(),
            (part, choice) => panic!("{}: {choice:?} for {part:?}", self.pass.name()),
        };
        self.pass.parts.iter().flat_map(of_part).chain([self.pass.file]).collect()
    }

    /// WGSL to compile.
    ///
    /// # Panics
    /// If the choice is not one that the pass leaves open.
    #[must_use]
    pub fn wgsl(&self, target: TargetFormat) -> String {
        self.files(target).iter().map(|file| file.text).collect()
    }

    /// Bindings of the bind groups, from 0 on.
    ///
    /// # Panics
    /// If the choice is not one that the pass leaves open.
    #[must_use]
    pub fn groups(&self) -> Vec<Vec<Binding>> {
        let of_group = |group: &Group| match (group, self.choice) {
            (Group::Fixed(bindings), _) => bindings.to_vec(),
            (Group::Maps(bindings), Choice::Terms(1)) => bindings.iter().map(|binding| binding.plain()).collect(),
            (Group::Maps(bindings), Choice::Terms(_)) => bindings.to_vec(),
            (Group::Material, Choice::Material(layout)) => layout.bindings().to_vec(),
            (Group::Btf(more), Choice::Btf(layout) | Choice::LitBtf(layout, _)) => [layout.bindings(), more].concat(),
            (group, choice) => panic!("{}: {choice:?} for {group:?}", self.pass.name()),
        };
        self.pass.groups.iter().map(of_group).collect()
    }
}
