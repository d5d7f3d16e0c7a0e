//! State of the scene: eye, light and surroundings.

use glam::{Quat, Vec2, Vec3};
use subsurf_scene::{BoundingSphere, Environment, LightShape, Scene};

use super::orbit::{Orbit, dragged};
use super::panel::Settings;
use crate::request::RenderRequest;
use crate::set::Set;

/// Speed of the light that goes around, in radians per second.
const LIGHT_SPEED: f32 = 0.6;

/// Scene, and what moves in it.
pub(super) struct SceneState {
    set: Set,
    scene: Scene,
    orbit: Orbit,
    /// Direction towards the light, of length 1.
    pub(super) light: Vec3,
    /// The same when it was last let go.
    pub(super) rested: Vec3,
}

impl SceneState {
    /// Light and view of a set on a mesh within a sphere, in a window of `size`.
    pub(super) fn of(set: Set, bounds: &BoundingSphere, environment: &Environment, size: [u32; 2]) -> Self {
        let request = RenderRequest { environment: environment.clone(), ..RenderRequest::of(set, size) };
        let scene = request.scene_around(bounds);
        Self { set, orbit: Orbit::of(&scene.camera), scene, light: request.direction, rested: request.direction }
    }

    /// View and light as at the beginning; the surroundings stay.
    pub(super) fn reset(&mut self, bounds: &BoundingSphere, size: [u32; 2]) {
        *self = Self::of(self.set, bounds, &self.scene.environment, size);
    }

    /// Sees another mesh in the same light.
    pub(super) fn look_at(&mut self, bounds: &BoundingSphere, size: [u32; 2]) {
        let (light, rested) = (self.light, self.rested);
        self.reset(bounds, size);
        (self.light, self.rested) = (light, rested);
    }

    pub(super) fn turn(&mut self, by: Vec2) {
        self.orbit.turn(by);
    }

    pub(super) fn zoom(&mut self, steps: f32) {
        self.orbit.zoom(steps);
    }

    pub(super) fn drag_light(&mut self, by: Vec2) {
        self.light = dragged(self.light, by, &self.orbit.view(1.0));
    }

    /// Lets the light go around for some time.
    pub(super) fn move_light(&mut self, seconds: f32) {
        self.light = Quat::from_axis_angle(Vec3::Y, LIGHT_SPEED * seconds) * self.light;
        self.rested = self.light;
    }

    /// What is drawn under a light from there.
    pub(super) fn scene(&mut self, light: Vec3, settings: &Settings) -> &Scene {
        self.scene.camera = self.orbit.view(settings.exposure);
        self.scene.roughness = settings.roughness;
        for source in &mut self.scene.lights {
            source.shape = LightShape::Directional { towards: light };
        }
        &self.scene
    }
}
