//! What is wanted, what is there, and how the one becomes the other.

use std::time::Duration;

use glam::Vec3;

use super::compose::Shows;
use super::controls::{Command, Drag};
use super::loader::{Answer, Key, Loader, Order, Way};
use super::panel::{Facts, Message, Settings};
use super::stage::{Role, Stage};
use super::studio::Studio;
use super::subject::{Dropped, Subject};
use super::times::Times;
use crate::failure::line;
use crate::render::{MappingArg, PathArg};

/// All that outlives a device.
pub(super) struct Session {
    pub(super) subject: Subject,
    pub(super) studio: Studio,
    pub(super) settings: Settings,
    pub(super) loader: Loader,
    pub(super) mapping: MappingArg,
    pub(super) budget_bytes: Option<u64>,
    pub(super) times: Times,
    pub(super) message: Option<Message>,
    /// What went wrong since it was last asked for.
    pub(super) failure: Option<anyhow::Error>,
    /// What failed is not tried again until something changes.
    pub(super) refused: Vec<Key>,
    /// The picture is not of what is wanted any more.
    pub(super) is_stale: bool,
    /// The next picture chooses the exposure.
    pub(super) exposes: bool,
}

impl Session {
    /// The light of the picture: a gather is too slow to follow the pointer.
    fn light(&self) -> Vec3 {
        if self.gathers() { self.studio.rested } else { self.studio.light }
    }

    fn gathers(&self) -> bool {
        !self.is_btf() && (self.settings.shows_error || self.settings.path == PathArg::Gather)
    }

    fn is_btf(&self) -> bool {
        self.subject.materials[self.settings.material].is_btf()
    }

    /// Whether a BTF is to be compared with its images.
    fn compares_images(&self) -> bool {
        self.subject.btf.images.is_some() && (self.settings.splits || self.settings.shows_error)
    }

    /// What is to be shown, and what it is to be compared with.
    fn wanted(&self, role: Role) -> Option<Key> {
        let Settings { path, material, shows_error, .. } = self.settings;
        let key = |way: Way| {
            let light = (way == Way::Path(PathArg::Gather)).then_some(self.studio.rested);
            Key { material, mesh: self.subject.mesh_number, way, light }
        };
        match (role, self.is_btf()) {
            (Role::Shown, false) => Some(key(Way::Path(path))),
            (Role::Shown, true) => Some(key(Way::Btf)),
            (Role::Reference, false) => {
                (shows_error && path != PathArg::Gather).then(|| key(Way::Path(PathArg::Gather)))
            }
            (Role::Reference, true) => self.compares_images().then(|| key(Way::Images)),
        }
    }

    /// Brings to the device what is wanted and computed, and has the rest computed.
    pub(super) fn follow(&mut self, stage: &mut Stage) {
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
            let material = &self.subject.materials[key.material];
            if let Some(computed) = self.loader.find(&key) {
                match stage.place(role, key, &computed, material, &self.subject.mesh) {
                    Ok(()) => self.changed(),
                    Err(error) => self.refuse(key, error),
                }
            } else {
                self.loader.start(Order {
                    key,
                    material: material.clone(),
                    mesh: self.subject.mesh.clone(),
                    mapping: self.mapping,
                    btf: self.subject.btf.clone(),
                    scene: self.studio.scene(self.studio.rested, &self.settings).clone(),
                });
            }
        }
    }

    /// Takes in what was computed.
    pub(super) fn receive(&mut self, answer: Answer) {
        if let Err((key, error)) = self.loader.receive(answer) {
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

    fn draw_one(&mut self, stage: &mut Stage, role: Role, light: Vec3) -> anyhow::Result<Option<Duration>> {
        let scene = self.studio.scene(light, &self.settings);
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
        stage.draw(role, self.studio.scene(light, &self.settings))
    }

    /// What the window shows.
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
        if (before.path, before.material) != (self.settings.path, self.settings.material) {
            self.times.clear();
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
            Command::Path(path) => self.settings.path = path,
            Command::NextMaterial => {
                self.settings.material = (self.settings.material + 1) % self.subject.materials.len();
            }
            Command::NextShape => match self.subject.next_shape() {
                Ok(()) => self.show_mesh(size),
                Err(error) => self.fail(error),
            },
            Command::Error => self.settings.shows_error ^= true,
            Command::Split => self.settings.splits ^= true,
            Command::TurnLight => self.settings.turns_light ^= true,
            Command::Expose => (self.exposes, self.is_stale) = (true, true),
            Command::Reset => {
                self.studio.reset(&self.subject.mesh, size);
                self.is_stale = true;
            }
            // Nothing of the picture changes.
            Command::Hide => {
                self.settings.is_open ^= true;
                return;
            }
            Command::Save | Command::Quit => {}
        }
        self.compare(&before);
    }

    /// Opens a file that was dropped onto the window.
    pub(super) fn open(&mut self, path: &std::path::Path, size: [u32; 2]) {
        match self.subject.drop(path) {
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
        self.message = None;
        self.studio.look_at(&self.subject.mesh, size);
        self.changed();
    }

    /// Moves what is dragged.
    pub(super) fn drag(&mut self, drag: Drag, by: glam::Vec2) {
        match drag {
            Drag::View => self.studio.turn(by),
            Drag::Light => self.studio.drag_light(by),
        }
        self.is_stale |= drag == Drag::View || !self.gathers();
    }

    /// The light was let go.
    pub(super) fn rest(&mut self) {
        if self.studio.rested != self.studio.light {
            self.studio.rested = self.studio.light;
            self.is_stale = true;
        }
    }

    /// Lets the light go around, if it does; whether it did.
    pub(super) fn pass_time(&mut self, seconds: f32) -> bool {
        let moves = self.settings.turns_light && !self.gathers();
        if moves {
            self.studio.move_light(seconds);
            self.is_stale = true;
        }
        moves
    }

    pub(super) fn fail(&mut self, error: anyhow::Error) {
        self.message = Some(Message::Failed(line(&error)));
        self.failure = Some(error);
    }

    fn refuse(&mut self, key: Key, error: anyhow::Error) {
        self.refused.push(key);
        self.fail(error);
    }

    /// What the panel tells.
    pub(super) fn facts(&self, stage: &Stage) -> Facts {
        let busy = self.loader.pending().map(|key| match key.way {
            Way::Path(PathArg::Gather) => "finding which points exchange light ...".to_owned(),
            Way::Path(_) => "computing what the path needs ...".to_owned(),
            Way::Btf => "reading the BTF ...".to_owned(),
            Way::Images => "reading images ...".to_owned(),
        });
        Facts {
            device: format!("{}, {:?}", stage.gpu.info().name, stage.gpu.info().backend),
            btf: self.is_btf().then(|| self.subject.btf.images.is_some()),
            materials: self.subject.materials.iter().map(|file| file.name()).collect(),
            mesh: format!("{}, {} triangles", self.subject.mesh_name, self.subject.mesh.triangles.len()),
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
