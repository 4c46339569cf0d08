//! Contacts of a block's particles with walls.

use std::ops::Range;

use calcine_coupler::excursion::Excursion;
use calcine_coupler::motion::{Cohesion, Rolling, WallShape};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::contact::{CohesionArea, ContactModel, tear_off_energy};

use super::super::contact::{SurfaceOverlap, evaluate};
use super::super::deep;
use super::super::energy::ContactEnergy;
use super::super::force_context::ForceContext;
use super::super::sphere::{SphereLoad, SpherePosition};
use super::WallBody;
use super::shape::{self, NearestPoint};
use super::triangle::{self, MOST, TriangleTouch};

/// Most contacts of one sphere with one mesh.
pub const CONTACTS: usize = 8;
/// How far a contact point may go in a step and still be the same contact, in radii.
const SAME: f64 = 0.1;

/// A wall that is near a particle.
#[derive(Clone, Debug)]
pub struct NearWall {
    /// Index of the particle in its block.
    pub particle: u32,
    /// Index of the wall.
    pub wall: u32,
    /// Triangles that are near.
    pub triangles: Range<u32>,
    /// Memories of its contacts.
    pub slots: Range<u32>,
}

/// The memory of a contact with a wall.
#[derive(Clone, Copy, Debug, Default)]
pub struct WallContactMemory {
    /// Where it touched, in the wall's own frame.
    pub point: Vec3,
    /// Elongation of the tangential spring in m.
    pub shift: Vec3,
    /// Torque of the rolling spring in N m.
    pub rolling: Vec3,
    /// The evaluation in which it touched last.
    pub stamp: u64,
}

/// Walls near the particles of a block.
#[derive(Clone, Debug, Default)]
pub struct WallContacts {
    /// One for each particle and wall, in this order.
    pub groups: Vec<NearWall>,
    /// Triangles of the groups.
    pub triangles: Vec<u32>,
    /// Memories of the groups.
    pub slots: Vec<WallContactMemory>,
    /// What the law prepared, one per group; empty where it prepares nothing.
    pub prepared: Vec<f64>,
    /// Force in N with which the particles of the block pressed against each wall in the last evaluation; empty where none
    /// holds a force.
    pub pressed: Vec<Vec3>,
}

/// A contact with a wall: in the wall's own frame.
struct Found {
    near: NearestPoint,
    point: Vec3,
}

impl WallContacts {
    /// Forgets all; keeps the memory.
    pub fn clear(&mut self) {
        self.groups.clear();
        self.triangles.clear();
        self.slots.clear();
        self.prepared.clear();
    }

    /// Adds a wall that is near a particle.
    pub fn add(
        &mut self,
        particle: u32,
        wall: u32,
        triangles: impl Iterator<Item = u32>,
        mesh: bool,
    ) {
        let first = self.triangles.len() as u32;
        self.triangles.extend(triangles);
        let end = self.triangles.len() as u32;
        if mesh && first == end {
            return;
        }
        let contacts = if mesh {
            (end - first).min(CONTACTS as u32)
        } else {
            1
        };
        let slot = self.slots.len() as u32;
        self.slots
            .resize((slot + contacts) as usize, WallContactMemory::default());
        self.groups.push(NearWall {
            particle,
            wall,
            triangles: first..end,
            slots: slot..slot + contacts,
        });
    }

    /// Forces of all contacts with walls.
    pub fn evaluate<L: ContactModel, const BUDGET: bool>(
        &mut self,
        scene: &ForceContext<'_, L>,
        begin: usize,
        load: &mut [SphereLoad],
        budget: &mut ContactEnergy,
        deep: &mut Excursion,
    ) {
        self.pressed.clear();
        if scene.walls.iter().any(|wall| wall.servo.is_some()) {
            self.pressed.resize(scene.walls.len(), Vec3::zeros());
        }
        let presses = !self.pressed.is_empty();
        for (k, group) in self.groups.iter().enumerate() {
            let before = load[group.particle as usize].force;
            let wall = &scene.walls[group.wall as usize];
            let index = begin + group.particle as usize;
            let place = &scene.spheres.place[index];
            let slots = &mut self.slots[group.slots.start as usize..group.slots.end as usize];
            let prepared = self.prepared.get(k).copied().unwrap_or(0.0);
            let load = &mut load[group.particle as usize];
            let own = wall.own(place.centre);
            let pair = scene
                .rules
                .pair(scene.spheres.material[index], wall.material);
            let tear_off = scene.rules.tear_off(pair, place.radius);
            let reach = place.radius + tear_off;
            let mut touch = |near: NearestPoint, slots: &mut [WallContactMemory]| {
                let point = own - near.distance * near.normal;
                let found = Found { near, point };
                let inside = place.radius - near.distance;
                // Where surfaces have parted, adhesion holds a contact that was made.
                let parted = tear_off > 0.0 && inside <= 0.0;
                if parted && touched(slots, point, place.radius, scene.stamp).is_none() {
                    return;
                }
                if deep::beyond(inside, [place.radius; 2]) > 0.0 {
                    deep::note(deep, scene.spheres, [index; 2], inside);
                }
                contact::<L, BUDGET>(scene, wall, index, found, prepared, slots, load, budget);
            };
            match &wall.shape {
                WallShape::Mesh { triangles } => {
                    let near = &self.triangles
                        [group.triangles.start as usize..group.triangles.end as usize];
                    let mut touches = [TriangleTouch::default(); MOST];
                    let found = touching(near, triangles, own, reach, &mut touches);
                    let touches = &mut touches[..found];
                    let kept =
                        triangle::keep_distinct(touches, triangles, place.radius, slots.len());
                    for one in &touches[..kept] {
                        let distance = one.square.sqrt();
                        if distance > 0.0 {
                            let normal = (own - one.point) / distance;
                            touch(NearestPoint { normal, distance }, slots);
                        }
                    }
                }
                other => {
                    if let Some(near) = shape::nearest(other, own)
                        && near.distance < reach
                    {
                        touch(near, slots);
                    }
                }
            }
            if BUDGET && tear_off > 0.0 {
                let torn = slots.iter().filter(|slot| slot.stamp + 1 == scene.stamp);
                budget.lost_normal += torn.count() as f64 * tear_off_energy(pair, place.radius);
            }
            if presses {
                self.pressed[group.wall as usize] -= load.force - before;
            }
        }
    }
}

/// Triangles that a sphere touches; the nearest point of each.
fn touching(
    near: &[u32],
    triangles: &[[Vec3; 3]],
    centre: Vec3,
    radius: f64,
    touches: &mut [TriangleTouch; MOST],
) -> usize {
    let mut found = 0;
    for &index in near {
        let (point, face) = triangle::nearest(centre, &triangles[index as usize]);
        let square = (centre - point).norm_squared();
        if square < radius * radius && found < MOST {
            touches[found] = TriangleTouch {
                point,
                square,
                face,
                triangle: index,
            };
            found += 1;
        }
    }
    found
}

/// The slot that touched in the last evaluation near this point; where there is one slot only, anywhere.
#[inline(always)]
fn touched(slots: &[WallContactMemory], point: Vec3, radius: f64, stamp: u64) -> Option<usize> {
    let alone = slots.len() == 1;
    let mut best: Option<(usize, f64)> = None;
    for (k, slot) in slots.iter().enumerate() {
        let square = (slot.point - point).norm_squared();
        if slot.stamp + 1 == stamp
            && (alone || square < (SAME * radius).powi(2))
            && best.is_none_or(|(_, least)| square < least)
        {
            best = Some((k, square));
        }
    }
    best.map(|(k, _)| k)
}

/// The memory of a contact: of the slot that touched in the last evaluation near this point, else a free one.
#[inline(always)]
fn memory(
    slots: &mut [WallContactMemory],
    point: Vec3,
    radius: f64,
    stamp: u64,
) -> Option<&mut WallContactMemory> {
    if let Some(k) = touched(slots, point, radius, stamp) {
        return slots.get_mut(k);
    }
    // One that did not touch last, or else one that is not used now.
    let free = slots
        .iter()
        .position(|slot| slot.stamp + 1 < stamp)
        .or_else(|| slots.iter().position(|slot| slot.stamp != stamp))?;
    let slot = slots.get_mut(free)?;
    (slot.shift, slot.rolling) = (Vec3::zeros(), Vec3::zeros());
    Some(slot)
}

#[inline(always)]
#[allow(clippy::too_many_arguments)]
fn contact<L: ContactModel, const BUDGET: bool>(
    scene: &ForceContext<'_, L>,
    wall: &WallBody,
    index: usize,
    found: Found,
    prepared: f64,
    slots: &mut [WallContactMemory],
    load: &mut SphereLoad,
    budget: &mut ContactEnergy,
) {
    let SpherePosition { centre, radius } = scene.spheres.place[index];
    let moves = &scene.spheres.moves[index];
    let Some(slot) = memory(slots, found.point, radius, scene.stamp) else {
        return;
    };
    (slot.point, slot.stamp) = (found.point, scene.stamp);
    let normal = wall.outside(found.near.normal);
    let distance = found.near.distance;
    let overlap = radius - distance;
    let arm = radius - 0.5 * overlap;
    let surface = wall.velocity(centre - distance * normal);
    let surfaces = SurfaceOverlap {
        normal,
        overlap,
        radius,
        mass: 1.0 / moves.inverse_mass,
        velocity: moves.velocity - surface,
        turning: arm * moves.spin,
        rotation: moves.spin - wall.spin(),
        inertia: match scene.rules.rolling {
            Rolling::ElasticPlastic => 1.4 * radius * radius / moves.inverse_mass,
            _ => 0.0,
        },
        area: if scene.rules.cohesion == Cohesion::Sjkr {
            CohesionArea::of_wall(radius, distance)
        } else {
            CohesionArea {
                area: 0.0,
                integral: 0.0,
            }
        },
    };
    let pair = scene
        .rules
        .pair(scene.spheres.material[index], wall.material);
    let outcome = evaluate::<L, BUDGET>(
        scene.law,
        scene.rules,
        (pair, prepared),
        &surfaces,
        &mut slot.shift,
        &mut slot.rolling,
        scene.step,
        budget,
    );
    if BUDGET {
        budget.wall_work += outcome.force.dot(&surface) * scene.step;
        budget.wall_work += outcome.rolling.dot(&wall.spin()) * scene.step;
    }
    load.add(&SphereLoad {
        force: outcome.force,
        torque: outcome.rolling - arm * outcome.twist,
    });
}
