//! The usual contact of two spheres (elastic force, damping and friction, without rolling resistance or
//! cohesion), eight at a time: the same operations in the same order as `contact::evaluate`, and the same
//! bits, in loops over lanes that the compiler turns into vector instructions.

use std::ops::Range;

use calcine_coupler::excursion::Excursion;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::contact::{ContactModel, PairConstants};

use super::candidates::{CandidatePairs, TouchingPair};
use super::deep;
use super::force_context::ForceContext;
use super::sphere::SphereLoad;

/// Contacts at a time.
const LANES: usize = 8;
/// One number of each contact.
type Lane = [f64; LANES];

/// Eight contacts.
#[derive(Default)]
#[repr(align(64))]
struct Batch {
    between: [Lane; 3],
    velocity: [Lane; 3],
    spin: [[Lane; 3]; 2],
    shift: [Lane; 3],
    radius: [Lane; 2],
    inverse_mass: Lane,
    young: Lane,
    shear: Lane,
    stiffness_root: Lane,
    damping: Lane,
    friction: Lane,
    prepared: Lane,
    force: [Lane; 3],
    twist: [Lane; 3],
    arm: [Lane; 2],
    beyond: Lane,
}

/// Evaluates the candidates that touch; the sink gets the indices, both loads and the candidate.
#[inline(always)]
pub fn pairs<L: ContactModel>(
    scene: &ForceContext<'_, L>,
    candidates: &mut CandidatePairs,
    touching: &[TouchingPair],
    deep: &mut Excursion,
    mut sink: impl FnMut([usize; 2], SphereLoad, SphereLoad, usize),
) {
    let mut batch = Batch::default();
    if let Some(pair) = scene.rules.single() {
        batch.fill(0..LANES, pair);
    }
    for chunk in touching.chunks(LANES) {
        for lane in 0..LANES {
            // Lanes beyond the last contact repeat it.
            let touch = chunk[lane.min(chunk.len() - 1)];
            batch.gather(lane, touch, scene, candidates);
        }
        batch.evaluate(scene);
        if batch.is_deep() {
            let pairs = chunk.iter().map(|touch| candidates.pair[touch.index()]);
            deep::note_all(deep, scene.spheres, pairs);
        }
        for (lane, touch) in chunk.iter().enumerate() {
            let k = touch.index();
            let pair = candidates.pair[k].map(|index| index as usize);
            candidates.shift[k] = at(&batch.shift, lane);
            let (force, twist) = (at(&batch.force, lane), at(&batch.twist, lane));
            let one = SphereLoad {
                force,
                torque: -(batch.arm[0][lane] * twist),
            };
            let other = SphereLoad {
                force: -force,
                torque: -(batch.arm[1][lane] * twist),
            };
            sink(pair, one, other, k);
        }
    }
}

#[inline(always)]
fn at(vector: &[Lane; 3], lane: usize) -> Vec3 {
    Vec3::new(vector[0][lane], vector[1][lane], vector[2][lane])
}

#[inline(always)]
fn put(vector: &mut [Lane; 3], lane: usize, value: Vec3) {
    vector[0][lane] = value.x;
    vector[1][lane] = value.y;
    vector[2][lane] = value.z;
}

#[inline(always)]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

impl Batch {
    /// True where one of the contacts is pressed in farther than its law holds.
    #[inline(always)]
    fn is_deep(&self) -> bool {
        self.beyond
            .iter()
            .fold(false, |deep, &beyond| deep | (beyond > 0.0))
    }

    #[inline(always)]
    fn gather<L>(
        &mut self,
        lane: usize,
        touch: TouchingPair,
        scene: &ForceContext<'_, L>,
        candidates: &CandidatePairs,
    ) {
        let (spheres, k) = (scene.spheres, touch.index());
        let [i, j] = candidates.pair[k].map(|index| index as usize);
        let (a, b) = (&spheres.place[i], &spheres.place[j]);
        let (va, vb) = (&spheres.moves[i], &spheres.moves[j]);
        put(&mut self.between, lane, a.centre - b.centre);
        put(&mut self.velocity, lane, va.velocity - vb.velocity);
        put(&mut self.spin[0], lane, va.spin);
        put(&mut self.spin[1], lane, vb.spin);
        self.radius[0][lane] = a.radius;
        self.radius[1][lane] = b.radius;
        self.inverse_mass[lane] = va.inverse_mass + vb.inverse_mass;
        let shift = match touch.kept() {
            true => candidates.shift[k],
            false => Vec3::zeros(),
        };
        put(&mut self.shift, lane, shift);
        if scene.rules.single().is_none() {
            let pair = scene.rules.pair(spheres.material[i], spheres.material[j]);
            self.fill(lane..lane + 1, pair);
        }
        if !candidates.prepared.is_empty() {
            self.prepared[lane] = candidates.prepared[k];
        }
    }

    /// Constants of a pair of materials.
    #[inline(always)]
    fn fill(&mut self, lanes: Range<usize>, pair: &PairConstants) {
        for lane in lanes {
            self.young[lane] = pair.young;
            self.shear[lane] = pair.shear;
            self.stiffness_root[lane] = pair.stiffness_root;
            self.damping[lane] = pair.damping;
            self.friction[lane] = pair.friction;
        }
    }

    // Components of several arrays side by side: an index reads better than zips.
    #[allow(clippy::needless_range_loop)]
    #[inline(always)]
    fn evaluate<L: ContactModel>(&mut self, scene: &ForceContext<'_, L>) {
        let (law, step, attractive) = (scene.law, scene.step, scene.rules.attractive);
        for l in 0..LANES {
            let pair = PairConstants {
                young: self.young[l],
                shear: self.shear[l],
                stiffness_root: self.stiffness_root[l],
                damping: self.damping[l],
                friction: self.friction[l],
                rolling_friction: 0.0,
                rolling_damping: 0.0,
                cohesion_energy: 0.0,
                work_of_adhesion: 0.0,
            };
            let between = [self.between[0][l], self.between[1][l], self.between[2][l]];
            let velocity = [
                self.velocity[0][l],
                self.velocity[1][l],
                self.velocity[2][l],
            ];
            let (ra, rb) = (self.radius[0][l], self.radius[1][l]);
            let distance = dot(between, between).sqrt();
            let sum = ra + rb;
            let overlap = sum - distance;
            let arms = [ra - 0.5 * overlap, rb - 0.5 * overlap];
            let inverse = self.inverse_mass[l];
            let share = 1.0 / (sum * inverse);
            let radius = ra * rb * inverse * share;
            let inverse_distance = 1.0 / distance;
            let normal = between.map(|x| x * inverse_distance);
            let springs = law.springs(&pair, self.prepared[l], overlap, radius, sum * share);
            let approach = dot(velocity, normal);
            let push = springs.elastic - springs.normal_damping * approach;
            let push = if !attractive && push < 0.0 { 0.0 } else { push };
            let mut turning = [0.0; 3];
            for x in 0..3 {
                turning[x] = arms[0] * self.spin[0][x][l] + arms[1] * self.spin[1][x][l];
            }
            let turning = cross(turning, normal);
            let mut slip = [0.0; 3];
            let mut moved = [0.0; 3];
            for x in 0..3 {
                slip[x] = velocity[x] - approach * normal[x] - turning[x];
                moved[x] = self.shift[x][l] + slip[x] * step;
            }
            let out = dot(moved, normal);
            for x in 0..3 {
                moved[x] -= out * normal[x];
            }
            let limit = pair.friction * push.abs();
            let stiffness = springs.tangential_stiffness;
            let squared = stiffness * stiffness * dot(moved, moved);
            let slides = squared > limit * limit;
            let kept = if slides { limit / squared.sqrt() } else { 1.0 };
            let damping = if slides {
                0.0
            } else {
                springs.tangential_damping
            };
            let mut tangential = [0.0; 3];
            for x in 0..3 {
                let shift = kept * moved[x];
                self.shift[x][l] = shift;
                tangential[x] = -stiffness * shift - damping * slip[x];
                self.force[x][l] = push * normal[x] + tangential[x];
            }
            let twist = cross(normal, tangential);
            for x in 0..3 {
                self.twist[x][l] = twist[x];
            }
            self.arm[0][l] = arms[0];
            self.arm[1][l] = arms[1];
            self.beyond[l] = deep::beyond(overlap, [ra, rb]);
        }
    }
}
