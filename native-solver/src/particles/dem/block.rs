//! A block of neighbouring particles with the contacts that it owns.

use std::hint::black_box;
use std::ops::Range;

use calcine_coupler::excursion::Excursion;
use calcine_coupler::motion::{Cohesion, Rolling};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::contact::{CohesionArea, ContactModel, Slip, tear_off_energy};

use super::candidates::{CandidatePairs, TouchingPair};
use super::contact::{SurfaceOverlap, evaluate};
use super::deep;
use super::energy::ContactEnergy;
use super::force_context::ForceContext;
use super::lanes;
use super::rules::ContactRules;
use super::sphere::{SphereLoad, SphereMotion, SpherePosition, Spheres};
use super::walls::group::WallContacts;

/// Most and fewest particles per block.
const SIZES: [usize; 2] = [256, 2048];
/// Blocks wanted at least, so that threads find equal shares: five blocks on two threads are three for the one
/// and two for the other.
const BLOCKS: usize = 16;

/// Up to so many particles are in the caches anyway, with their contacts.
const NEAR: usize = 4096;

/// Particles per block of so many; it depends on nothing else, so that sums do not depend on the number of
/// threads.
pub fn size(count: usize) -> usize {
    let share = count.div_ceil(BLOCKS).next_power_of_two();
    share.clamp(SIZES[0], SIZES[1])
}

/// A block.
#[derive(Clone, Debug, Default)]
pub struct Block {
    /// Index of its first particle.
    pub begin: usize,
    /// Pairs within the block.
    pub inner: CandidatePairs,
    /// Pairs with a sphere of another block.
    pub cross: CandidatePairs,
    /// Contacts with walls.
    pub walls: WallContacts,
    /// Loads on its particles.
    pub load: Vec<SphereLoad>,
    /// Loads from other blocks: block, slot, particle.
    pub incoming: Vec<[u32; 3]>,
    /// Candidates that touch, of the list at hand.
    pub touching: Vec<TouchingPair>,
    /// Energies of its contacts.
    pub budget: ContactEnergy,
    /// Force of all walls on its particles in the last evaluation, in N.
    pub wall_force: Vec3,
    /// Impulse in N s that walls and held particles gave its free ones, and what of it others' free ones
    /// got: sums over all blocks are of free particles.
    pub support: Vec3,
    /// Contacts of the last evaluation that are pressed in farther than their law holds, over the smaller radius, by rows.
    pub deep: Excursion,
}

impl Block {
    /// Forces of all contacts that the block owns; those on other blocks' particles go to `outgoing`.
    pub fn evaluate<L: ContactModel, const BUDGET: bool>(
        &mut self,
        scene: &ForceContext<'_, L>,
        outgoing: &mut [SphereLoad],
    ) {
        if scene.spheres.len() > NEAR {
            ahead(scene.spheres, self.begin..self.begin + self.load.len());
        }
        let held = std::mem::take(&mut self.budget.elastic_tangential);
        self.budget.elastic_normal = 0.0;
        self.load.fill(SphereLoad::default());
        self.deep = Excursion::default();
        self.walls.evaluate::<L, BUDGET>(
            scene,
            self.begin,
            &mut self.load,
            &mut self.budget,
            &mut self.deep,
        );
        self.wall_force = if self.walls.groups.is_empty() {
            Vec3::zeros()
        } else {
            self.load.iter().map(|load| load.force).sum()
        };
        let Self {
            begin,
            inner,
            cross,
            load,
            touching,
            budget,
            deep,
            ..
        } = self;
        let begin = *begin;
        outgoing.fill(SphereLoad::default());
        // Counting energies, rolling, cohesion and looks without a step go one by one.
        let plain = !BUDGET
            && L::SLIP == Slip::SpringKept
            && scene.rules.cohesion == Cohesion::None
            && scene.rules.rolling == Rolling::None
            && scene.step > 0.0;
        if plain {
            pulp::Arch::new().dispatch(Plain {
                scene,
                begin,
                lists: [inner, cross],
                touching,
                load,
                outgoing,
                deep,
            });
            return;
        }
        let found = held_of::<L, BUDGET>(scene, inner, touching, budget);
        pairs::<L, BUDGET>(
            scene,
            inner,
            &touching[..found],
            budget,
            deep,
            |[i, j], one, other, _| {
                load[i - begin].add(&one);
                load[j - begin].add(&other);
            },
        );
        let found = held_of::<L, BUDGET>(scene, cross, touching, budget);
        pairs::<L, BUDGET>(
            scene,
            cross,
            &touching[..found],
            budget,
            deep,
            |[i, _], one, other, slot| {
                load[i - begin].add(&one);
                outgoing[slot] = other;
            },
        );
        budget.lost_tangential += held - budget.elastic_tangential;
    }

    /// Takes up the loads that other blocks left for this one's particles.
    pub fn take_up(&mut self, outgoing: &[Vec<SphereLoad>]) {
        for &[block, slot, particle] in &self.incoming {
            self.load[particle as usize].add(&outgoing[block as usize][slot as usize]);
        }
    }
}

/// The work of a block where its contacts are plain, compiled for each set of vector instructions.
struct Plain<'a, 'b, L> {
    scene: &'a ForceContext<'b, L>,
    begin: usize,
    lists: [&'a mut CandidatePairs; 2],
    touching: &'a mut [TouchingPair],
    load: &'a mut [SphereLoad],
    outgoing: &'a mut [SphereLoad],
    deep: &'a mut Excursion,
}

impl<L: ContactModel> pulp::WithSimd for Plain<'_, '_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self {
            scene,
            begin,
            lists: [inner, cross],
            touching,
            load,
            outgoing,
            deep,
        } = self;
        let found = touching_of(inner, &scene.spheres.place, touching);
        lanes::pairs(
            scene,
            inner,
            &touching[..found],
            deep,
            #[inline(always)]
            |[i, j], one, other, _| {
                load[i - begin].add(&one);
                load[j - begin].add(&other);
            },
        );
        let found = touching_of(cross, &scene.spheres.place, touching);
        let moves = &scene.spheres.moves;
        let beyond =
            |touch: &TouchingPair| moves[cross.pair[touch.index()][1] as usize].inverse_mass;
        black_box(touching[..found].iter().map(beyond).sum::<f64>());
        lanes::pairs(
            scene,
            cross,
            &touching[..found],
            deep,
            #[inline(always)]
            |[i, _], one, other, slot| {
                load[i - begin].add(&one);
                outgoing[slot] = other;
            },
        );
    }
}

/// Reads the particles of a block in a row: contacts ask for them here and there, and would wait for memory each
/// time where many particles are more than caches hold.
fn ahead(spheres: &Spheres, own: Range<usize>) {
    let (place, moves) = (&spheres.place[own.clone()], &spheres.moves[own]);
    black_box(place.iter().map(|place| place.radius).sum::<f64>());
    black_box(moves.iter().map(|moves| moves.inverse_mass).sum::<f64>());
}

/// Lists the candidates that touch, without a branch that could be guessed wrong, and notes which they are;
/// returns their number.
#[inline(always)]
fn touching_of(
    candidates: &mut CandidatePairs,
    place: &[SpherePosition],
    touching: &mut [TouchingPair],
) -> usize {
    let mut found = 0;
    let pairs = candidates.pair.iter().zip(&mut candidates.touched);
    for (k, (&[i, j], touched)) in pairs.enumerate() {
        let (a, b) = (&place[i as usize], &place[j as usize]);
        let reach = a.radius + b.radius;
        let apart = (a.centre - b.centre).norm_squared();
        touching[found] = TouchingPair::new(k, *touched);
        *touched = apart < reach * reach;
        found += usize::from(*touched);
    }
    found
}

/// Lists the candidates that touch, or that adhesion holds, and counts the energy of what tears off.
fn held_of<L, const BUDGET: bool>(
    scene: &ForceContext<'_, L>,
    candidates: &mut CandidatePairs,
    touching: &mut [TouchingPair],
    budget: &mut ContactEnergy,
) -> usize {
    let spheres = scene.spheres;
    if scene.rules.cohesion != Cohesion::Jkr {
        return touching_of(candidates, &spheres.place, touching);
    }
    candidates.adhering(&spheres.place, touching, |[i, j]| {
        if BUDGET {
            let pair = scene.rules.pair(spheres.material[i], spheres.material[j]);
            let [a, b] = [i, j].map(|index| spheres.place[index].radius);
            budget.lost_normal += tear_off_energy(pair, a * b / (a + b));
        }
    })
}

#[inline(always)]
fn pairs<L: ContactModel, const BUDGET: bool>(
    scene: &ForceContext<'_, L>,
    candidates: &mut CandidatePairs,
    touching: &[TouchingPair],
    budget: &mut ContactEnergy,
    deep: &mut Excursion,
    mut sink: impl FnMut([usize; 2], SphereLoad, SphereLoad, usize),
) {
    let spheres = scene.spheres;
    let mut unused = Vec3::zeros();
    for touch in touching {
        let k = touch.index();
        let [i, j] = candidates.pair[k].map(|index| index as usize);
        let (a, b) = (&spheres.place[i], &spheres.place[j]);
        let (va, vb) = (&spheres.moves[i], &spheres.moves[j]);
        let shift = &mut candidates.shift[k];
        if !touch.kept() {
            *shift = Vec3::zeros();
            if let Some(torque) = candidates.rolling.get_mut(k) {
                *torque = Vec3::zeros();
            }
        }
        let (surfaces, arms) = meet(scene.rules, a, b, va, vb);
        if deep::beyond(surfaces.overlap, [a.radius, b.radius]) > 0.0 {
            deep::note(deep, spheres, [i, j], surfaces.overlap);
        }
        let pair = scene.rules.pair(spheres.material[i], spheres.material[j]);
        let prepared = candidates.prepared.get(k).copied().unwrap_or(0.0);
        let torque = candidates.rolling.get_mut(k).unwrap_or(&mut unused);
        let outcome = evaluate::<L, BUDGET>(
            scene.law,
            scene.rules,
            (pair, prepared),
            &surfaces,
            shift,
            torque,
            scene.step,
            budget,
        );
        let one = SphereLoad {
            force: outcome.force,
            torque: outcome.rolling - arms[0] * outcome.twist,
        };
        let other = SphereLoad {
            force: -outcome.force,
            torque: -outcome.rolling - arms[1] * outcome.twist,
        };
        sink([i, j], one, other, k);
    }
}

/// Two spheres that overlap, and their arms: from each centre to the middle of the overlap.
#[inline(always)]
fn meet(
    rules: &ContactRules,
    a: &SpherePosition,
    b: &SpherePosition,
    va: &SphereMotion,
    vb: &SphereMotion,
) -> (SurfaceOverlap, [f64; 2]) {
    let between = a.centre - b.centre;
    let distance = between.norm();
    let sum = a.radius + b.radius;
    let overlap = sum - distance;
    let arms = [a.radius - 0.5 * overlap, b.radius - 0.5 * overlap];
    // R* = r₁r₂/(r₁ + r₂) and m* = 1/(1/m₁ + 1/m₂) by one division.
    let inverse = va.inverse_mass + vb.inverse_mass;
    let share = 1.0 / (sum * inverse);
    let radius = a.radius * b.radius * inverse * share;
    let moment = |place: &SpherePosition, moves: &SphereMotion| {
        moves.inverse_mass / (place.radius * place.radius)
    };
    let surfaces = SurfaceOverlap {
        normal: between * (1.0 / distance),
        overlap,
        radius,
        mass: sum * share,
        velocity: va.velocity - vb.velocity,
        turning: arms[0] * va.spin + arms[1] * vb.spin,
        rotation: va.spin - vb.spin,
        inertia: match rules.rolling {
            Rolling::ElasticPlastic => 1.4 / (moment(a, va) + moment(b, vb)),
            _ => 0.0,
        },
        area: if rules.cohesion == Cohesion::Sjkr {
            CohesionArea::of_spheres(a.radius, b.radius, distance)
        } else {
            CohesionArea {
                area: 0.0,
                integral: 0.0,
            }
        },
    };
    (surfaces, arms)
}
