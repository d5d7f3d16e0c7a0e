//! One packet on its way.

use std::f64::consts::TAU;

use rand::{Rng, RngExt};

use super::outcome::Sums;
use super::request::Request;
use super::roulette;
use super::score::{Event, Quantity};
use super::stack::Source;
use crate::simulate::fresnel;

/// Light in air goes this far in mm per ps.
const C_MM_PER_PS: f64 = 0.299_792_458;

/// A packet of photons that take the same way.
struct Packet {
    position: [f64; 3],
    direction: [f64; 3],
    weight: f64,
    /// Layer that it is in.
    layer: usize,
    /// Optical path that is left until the next collision.
    left: f64,
    /// Whether it was ever scattered.
    scattered: bool,
    t_ps: f64,
    /// Weight absorbed so far.
    absorbed: f64,
}

/// Traces one packet from its start until it has left or lost all its weight.
pub(super) fn trace(request: &Request, planes: &[f64], rng: &mut impl Rng, sums: &mut Sums) {
    let mut packet = start(request, planes, rng);
    let mut events: u64 = 0;
    loop {
        let layer = request.stack.layers[packet.layer];
        let sigma_t = layer.sigma_t();
        // s = −ln ξ, in mean free paths.
        if packet.left == 0.0 && sigma_t > 0.0 {
            packet.left = -(1.0 - rng.random::<f64>()).ln();
        }
        let [_, _, uz] = packet.direction;
        let plane = if uz > 0.0 { planes[packet.layer + 1] } else { planes[packet.layer] };
        let to_plane = if uz == 0.0 { f64::INFINITY } else { (plane - packet.position[2]) / uz };
        let to_collision = if sigma_t > 0.0 { packet.left / sigma_t } else { f64::INFINITY };
        events += 1;
        if to_plane <= to_collision {
            if to_plane.is_infinite() {
                // Along a clear layer for ever: light that nothing of the model takes up.
                break;
            }
            packet.advance(to_plane, layer.eta);
            packet.position[2] = plane;
            packet.left = (packet.left - to_plane * sigma_t).max(0.0);
            if packet.cross(request, rng, sums) {
                break;
            }
        } else {
            packet.advance(to_collision, layer.eta);
            packet.left = 0.0;
            packet.collide(request, rng, sums);
        }
        let survival = if packet.weight < request.threshold {
            roulette::LIGHT
        } else if events >= u64::from(roulette::EVENTS) && events.is_power_of_two() {
            roulette::LATE
        } else {
            continue;
        };
        if rng.random::<f64>() >= survival {
            break;
        }
        packet.weight /= survival;
    }
    sums.absorbed.add(packet.absorbed);
}

fn start(request: &Request, planes: &[f64], rng: &mut impl Rng) -> Packet {
    let z_mm = request.source.z_mm();
    let mut weight = 1.0;
    let mut layer =
        planes.partition_point(|plane| *plane <= z_mm).saturating_sub(1).min(request.stack.layers.len() - 1);
    let direction = match request.source {
        Source::Pencil { z_mm } => {
            if z_mm == 0.0 {
                // What is mirrored before it enters never becomes a packet, nor does what a first pane of glass mirrors.
                weight -= request.stack.specular();
                if request.stack.layers[0].sigma_t() == 0.0 && request.stack.layers.len() > 1 {
                    layer = 1;
                }
            }
            [0.0, 0.0, 1.0]
        }
        Source::Isotropic { .. } => {
            let cosine = 2.0 * rng.random::<f64>() - 1.0;
            let (sine, phi) = ((1.0 - cosine * cosine).sqrt(), TAU * rng.random::<f64>());
            [sine * phi.cos(), sine * phi.sin(), cosine]
        }
    };
    let position = [0.0, 0.0, z_mm.max(planes[layer])];
    Packet { position, direction, weight, layer, left: 0.0, scattered: false, t_ps: 0.0, absorbed: 0.0 }
}

impl Packet {
    fn advance(&mut self, distance: f64, eta: f64) {
        for (x, u) in self.position.iter_mut().zip(self.direction) {
            *x += distance * u;
        }
        self.t_ps += distance * eta / C_MM_PER_PS;
    }

    fn event(&self, cosine: f64) -> Event {
        let [x, y, z_mm] = self.position;
        Event { r_mm: x.hypot(y), z_mm, cosine, t_ps: self.t_ps }
    }

    /// Drops w σ_a / σ_t, and takes a new direction.
    fn collide(&mut self, request: &Request, rng: &mut impl Rng, sums: &mut Sums) {
        let layer = request.stack.layers[self.layer];
        let drop = self.weight * layer.sigma_a / layer.sigma_t();
        if drop > 0.0 {
            self.weight -= drop;
            self.absorbed += drop;
            let ballistic = request.ballistic_apart && !self.scattered;
            sums.absorb(self.layer, ballistic, &self.event(1.0), drop);
        }
        self.scattered = true;
        self.direction = scatter(self.direction, layer.g, rng);
    }

    /// Is reflected at the plane that it has come to, or goes through it; whether it left the stack.
    fn cross(&mut self, request: &Request, rng: &mut impl Rng, sums: &mut Sums) -> bool {
        let stack = &request.stack;
        let down = self.direction[2] > 0.0;
        let next = if down {
            self.layer.checked_add(1).filter(|k| *k < stack.layers.len())
        } else {
            self.layer.checked_sub(1)
        };
        let here = stack.layers[self.layer].eta;
        let there = next.map_or(if down { stack.eta_below } else { stack.eta_above }, |k| stack.layers[k].eta);
        let cosine = self.direction[2].abs();
        let eta = here / there;
        let reflectance = fresnel::reflectance(eta, cosine);
        if rng.random::<f64>() < reflectance {
            self.direction[2] = -self.direction[2];
            return false;
        }
        // Snell: sines grow by η.
        let refracted = (1.0 - eta * eta * (1.0 - cosine * cosine)).max(0.0).sqrt();
        let Some(next) = next else {
            let quantity = if down { Quantity::Transmitted } else { Quantity::Reflected };
            let ballistic = request.ballistic_apart && !self.scattered;
            sums.leave(quantity, ballistic, &self.event(refracted), self.weight);
            return true;
        };
        self.direction[0] *= eta;
        self.direction[1] *= eta;
        self.direction[2] = refracted.copysign(self.direction[2]);
        self.layer = next;
        false
    }
}

/// A direction by Henyey and Greenstein's phase function about `u`, with the mean cosine `g`.
fn scatter(u: [f64; 3], g: f64, rng: &mut impl Rng) -> [f64; 3] {
    let xi = rng.random::<f64>();
    let cosine = if g.abs() < 1e-6 {
        2.0 * xi - 1.0
    } else {
        // (1 + g² − ((1 − g²) / (1 − g + 2 g ξ))²) / 2g.
        let ratio = (1.0 - g * g) / (1.0 - g + 2.0 * g * xi);
        ((1.0 + g * g - ratio * ratio) / (2.0 * g)).clamp(-1.0, 1.0)
    };
    let sine = (1.0 - cosine * cosine).sqrt();
    let (sin_phi, cos_phi) = (TAU * rng.random::<f64>()).sin_cos();
    let [ux, uy, uz] = u;
    // Where u is all but vertical the frame below has no direction across.
    let new = if uz.abs() > 0.999_99 {
        [sine * cos_phi, sine * sin_phi, cosine * uz.signum()]
    } else {
        let across = (ux * ux + uy * uy).sqrt();
        [
            sine * (ux * uz * cos_phi - uy * sin_phi) / across + ux * cosine,
            sine * (uy * uz * cos_phi + ux * sin_phi) / across + uy * cosine,
            -sine * cos_phi * across + uz * cosine,
        ]
    };
    // Rounding would let the length drift over thousands of turns.
    let length = (new[0] * new[0] + new[1] * new[1] + new[2] * new[2]).sqrt();
    new.map(|x| x / length)
}
