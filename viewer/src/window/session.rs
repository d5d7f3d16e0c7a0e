//! Session: what is wanted, what is there, and how the one becomes the other.

use std::sync::Arc;
use std::time::Duration;

use glam::Vec3;

use super::artist::MakeKernel;
use super::assets::{Assets, Dropped, Kind, MeshReading};
use super::config::{Config, LoadImages};
use super::controls::{Command, Drag};
use super::draw::{Role, Shows, Stage};
use super::job::{Job, JobQueue, JobResult, Key, RenderMode};
use super::panel::{Facts, Message, Settings};
use super::state::SceneState;
use super::times::Times;
use crate::asset::{MappingChoice, Scattering};
use crate::error::{Error, Result, one_line};
use crate::request::ROUGHNESS;

/// The reference of translucent materials.
const GATHER: RenderMode = RenderMode::Scattering(Scattering::Gather);

/// Session: all that outlives a device.
pub(super) struct Session {
    pub(super) assets: Assets,
    pub(super) state: SceneState,
    pub(super) settings: Settings,
    mapping: MappingChoice,
    repeats: Option<[f32; 2]>,
    images: Option<Arc<LoadImages>>,
    make_kernel: Option<Arc<MakeKernel>>,
    budget_bytes: Option<u64>,
    times: Times,
    pub(super) message: Option<Message>,
    /// What went wrong since it was last asked for.
    pub(super) failure: Option<Error>,
    /// What failed is not tried again until something changes.
    refused: Vec<Key>,
    /// The picture is not of what is wanted any more.
    pub(super) is_stale: bool,
    /// The next picture chooses the exposure.
    exposes: bool,
}

impl Session {
    /// Opens the files of a configuration.
    pub(super) fn new(config: &Config) -> Result<Self> {
        if !(config.extent_mm.is_finite() && config.extent_mm > 0.0) {
            return Err(Error::Request(format!("an extent of {} mm; it must be positive", config.extent_mm)));
        }
        let reading = MeshReading { set: config.set, extent_mm: config.extent_mm, up: config.up };
        let assets = Assets::open(&config.files, config.material.as_deref(), &config.mesh, reading)?;
        Ok(Self {
            state: SceneState::of(config.set, &assets.bounds, &config.environment, config.size),
            settings: Settings {
                technique: config.technique,
                material: 0,
                roughness: ROUGHNESS,
                exposure: 1.0,
                shows_error: config.shows_error,
                splits: config.images.is_some() && !config.shows_error,
                turns_light: false,
                is_open: true,
                artist: None,
            },
            mapping: config.mapping,
            repeats: config.repeats,
            images: config.images.clone(),
            make_kernel: config.make_kernel.clone(),
            budget_bytes: config.options.budget_bytes,
            times: Times::default(),
            message: warning(&assets),
            assets,
            failure: None,
            refused: Vec::new(),
            is_stale: true,
            exposes: true,
        })
    }

    /// The light of the picture: a gather is too slow to follow the pointer.
    fn light(&self) -> Vec3 {
        if self.gathers() { self.state.rested } else { self.state.light }
    }

    fn gathers(&self) -> bool {
        self.kind() == Kind::Bssrdf && (self.settings.shows_error || self.settings.technique == Scattering::Gather)
    }

    fn kind(&self) -> Kind {
        self.assets.materials[self.settings.material].kind()
    }

    /// Whether a BTF is to be compared with its images.
    fn compares_images(&self) -> bool {
        self.images.is_some() && (self.settings.splits || self.settings.shows_error)
    }

    /// What is to be shown, and what it is to be compared with.
    fn wanted(&self, role: Role) -> Option<Key> {
        let Settings { technique, material, shows_error, .. } = self.settings;
        let key = |mode: RenderMode| {
            let light = (mode == GATHER).then_some(self.state.rested);
            Key { material, mesh: self.assets.mesh_number, mode, light }
        };
        match (role, self.kind()) {
            (Role::Shown, Kind::Bssrdf) => Some(key(RenderMode::Scattering(technique))),
            (Role::Shown, Kind::Btf) => Some(key(RenderMode::Btf)),
            (Role::Shown, Kind::Kernel(_)) => Some(key(RenderMode::Kernel(self.settings.artist))),
            (Role::Reference, Kind::Bssrdf) => (shows_error && technique != Scattering::Gather).then(|| key(GATHER)),
            (Role::Reference, Kind::Btf) => self.compares_images().then(|| key(RenderMode::Images)),
            (Role::Shown, Kind::Transfer) => Some(key(RenderMode::Transfer)),
            // There is one way to draw it.
            (Role::Reference, Kind::Kernel(_) | Kind::Transfer) => None,
        }
    }

    /// Brings to the device what is wanted and computed, and has the rest computed.
    pub(super) fn follow(&mut self, stage: &mut Stage, jobs: &mut JobQueue) {
        // What is shown may be what is compared with next, and the other way around: nothing is computed twice.
        let [shown, reference] = Role::ALL.map(|role| self.wanted(role));
        let is_there = |role, wanted: &Option<Key>| wanted.is_some() && stage.key(role) == wanted.as_ref();
        if is_there(Role::Reference, &shown) || is_there(Role::Shown, &reference) {
            stage.swap();
            self.is_stale = true;
        }
        for role in Role::ALL {
            let Some(key) = self.wanted(role) else {
                stage.clear(role);
                continue;
            };
            if stage.key(role) == Some(&key) || self.refused.contains(&key) {
                continue;
            }
            let material = self.assets.materials[key.material].clone();
            let found = jobs.find(&key).map(|computed| (key, computed));
            let is_there = found.is_some();
            let shown = found.or_else(|| jobs.find_edit(&key)).filter(|(found, _)| stage.key(role) != Some(found));
            if let Some((key, computed)) = shown {
                match stage.place(role, key, &computed, &material, &self.assets.mesh) {
                    Ok(()) => self.changed(),
                    Err(error) => self.refuse(key, error),
                }
            }
            if !is_there {
                jobs.start(Job {
                    key,
                    material: material.clone(),
                    mesh: self.assets.mesh.clone(),
                    mapping: self.mapping,
                    repeats: self.repeats,
                    images: self.images.clone(),
                    make_kernel: self.make_kernel.clone(),
                    scene: self.state.scene(self.state.rested, &self.settings).clone(),
                });
            }
        }
    }

    /// Takes in the result of a job.
    pub(super) fn receive(&mut self, result: JobResult, jobs: &mut JobQueue) {
        if let Err(failed) = jobs.receive(result) {
            let (key, error) = *failed;
            self.refuse(key, error);
        }
    }

    /// Draws what has changed; how long the picture took.
    pub(super) fn draw(&mut self, stage: &mut Stage) {
        if !std::mem::take(&mut self.is_stale) {
            return;
        }
        let light = self.light();
        for role in Role::ALL {
            let Some(key) = stage.key(role).copied() else {
                continue;
            };
            if self.refused.contains(&key) {
                continue;
            }
            match self.draw_one(stage, role, light) {
                Ok(Some(time)) if role == Role::Shown => self.times.enter(time),
                Ok(_) => {}
                Err(error) => self.refuse(key, error),
            }
        }
    }

    fn draw_one(&mut self, stage: &mut Stage, role: Role, light: Vec3) -> Result<Option<Duration>> {
        let scene = self.state.scene(light, &self.settings);
        let time = stage.draw(role, scene)?;
        if role == Role::Reference || !std::mem::take(&mut self.exposes) {
            return Ok(time);
        }
        let Some(exposure) = stage.exposure(scene)? else {
            self.exposes = true;
            return Ok(time);
        };
        self.settings.exposure = exposure;
        // Drivers compile at the first frame: it does not count.
        stage.draw(role, self.state.scene(light, &self.settings))
    }

    /// Choice of what the window shows: what is wanted, as far as it is there.
    pub(super) fn shows(&self, stage: &Stage) -> Shows {
        // The gather itself differs from nothing: it is shown.
        let reference = self.wanted(Role::Reference);
        let is_there = stage.has_picture(Role::Reference) && stage.key(Role::Reference) == reference.as_ref();
        match is_there {
            false => Shows::Picture,
            true if self.settings.shows_error => Shows::Difference,
            true => Shows::Split,
        }
    }

    /// Whether everything that is wanted is shown.
    pub(super) fn is_settled(&self, stage: &Stage) -> bool {
        let is_there = |role| match self.wanted(role) {
            Some(key) => stage.key(role) == Some(&key) && stage.has_picture(role),
            None => true,
        };
        !self.is_stale && Role::ALL.into_iter().all(is_there)
    }

    /// Notices what the panel or a key changed.
    pub(super) fn compare(&mut self, before: &Settings) {
        if *before == self.settings {
            return;
        }
        (self.is_stale, self.message) = (true, None);
        self.refused.clear();
        if (before.technique, before.material) != (self.settings.technique, self.settings.material) {
            self.times.clear();
        }
        if before.material != self.settings.material {
            self.settings.artist = None;
        }
    }

    /// Another mesh, size or material: nothing that is known of the last frames holds.
    pub(super) fn changed(&mut self) {
        self.is_stale = true;
        self.refused.clear();
        self.times.clear();
    }

    /// Does what a key or button asks for, but for what the window does.
    pub(super) fn obey(&mut self, command: Command, size: [u32; 2]) {
        let before = self.settings;
        match command {
            Command::Technique(technique) => self.settings.technique = technique,
            Command::NextMaterial => {
                self.settings.material = (self.settings.material + 1) % self.assets.materials.len();
            }
            Command::NextShape => match self.assets.next_shape() {
                Ok(()) => self.show_mesh(size),
                Err(error) => self.fail(error),
            },
            Command::Error => self.settings.shows_error ^= true,
            Command::Split => self.settings.splits ^= true,
            Command::TurnLight => self.settings.turns_light ^= true,
            Command::Expose => (self.exposes, self.is_stale) = (true, true),
            Command::Reset => {
                self.state.reset(&self.assets.bounds, size);
                self.is_stale = true;
            }
            // Nothing of the picture changes.
            Command::Hide => {
                self.settings.is_open ^= true;
                return;
            }
            Command::Save | Command::SaveKernel | Command::Quit => {}
        }
        self.compare(&before);
    }

    /// Opens a file that was dropped onto the window.
    pub(super) fn open(&mut self, path: &std::path::Path, size: [u32; 2]) {
        match self.assets.drop(path) {
            Ok(Dropped::Material(number)) => {
                let before = self.settings;
                self.settings.material = number;
                self.compare(&before);
            }
            Ok(Dropped::Mesh) => self.show_mesh(size),
            Err(error) => self.fail(error),
        }
    }

    fn show_mesh(&mut self, size: [u32; 2]) {
        self.message = warning(&self.assets);
        self.state.look_at(&self.assets.bounds, size);
        self.changed();
    }

    /// Moves what is dragged.
    pub(super) fn drag(&mut self, drag: Drag, by: glam::Vec2) {
        match drag {
            Drag::View => self.state.turn(by),
            Drag::Light => self.state.drag_light(by),
        }
        self.is_stale |= drag == Drag::View || !self.gathers();
    }

    /// The light was let go.
    pub(super) fn rest(&mut self) {
        if self.state.rested != self.state.light {
            self.state.rested = self.state.light;
            self.is_stale = true;
        }
    }

    /// Lets the light go around, if it does; whether it did.
    pub(super) fn pass_time(&mut self, seconds: f32) -> bool {
        let moves = self.settings.turns_light && !self.gathers();
        if moves {
            self.state.move_light(seconds);
            self.is_stale = true;
        }
        moves
    }

    pub(super) fn fail(&mut self, error: Error) {
        self.message = Some(Message::Failed(one_line(&error)));
        self.failure = Some(error);
    }

    fn refuse(&mut self, key: Key, error: Error) {
        self.refused.push(key);
        self.fail(error);
    }

    /// File of the kernel that the panel made.
    pub(super) fn kernel(&self) -> Result<Vec<u8>> {
        match (&self.make_kernel, self.settings.artist) {
            (Some(make), Some(artist)) => make(&artist),
            _ => Err(Error::Request("no number of a kernel was changed".to_owned())),
        }
    }

    /// Facts for the panel.
    pub(super) fn facts(&self, stage: &Stage, jobs: &JobQueue) -> Facts {
        let busy = jobs.pending().map(|key| match key.mode {
            GATHER => "finding which points exchange light ...".to_owned(),
            RenderMode::Scattering(_) => "computing what the path needs ...".to_owned(),
            RenderMode::Btf => "reading the BTF ...".to_owned(),
            RenderMode::Images => "reading images ...".to_owned(),
            RenderMode::Kernel(_) => "making the kernel ...".to_owned(),
            RenderMode::Transfer => "reading what is precomputed ...".to_owned(),
        });
        Facts {
            device: format!("{}, {:?}", stage.gpu.info().name, stage.gpu.info().backend),
            kind: self.kind(),
            has_images: self.images.is_some(),
            makes_kernels: self.make_kernel.is_some(),
            materials: self.assets.materials.iter().map(|file| file.name()).collect(),
            mesh: format!("{}, {} triangles", self.assets.mesh_name, self.assets.mesh.triangles.len()),
            size: stage.canvas.size(),
            frame_ms: self.times.median_ms(),
            device_bytes: stage.gpu.ledger().bytes(),
            budget_bytes: self.budget_bytes,
            model_bytes: stage.model_bytes(),
            plan: stage.plan().copied(),
            busy,
            message: self.message.clone(),
        }
    }
}

/// What was changed or left out of the mesh's file, for the panel.
fn warning(assets: &Assets) -> Option<Message> {
    (!assets.warnings.is_empty())
        .then(|| Message::Done(format!("{}: {}", assets.mesh_name, assets.warnings.join("; "))))
}
