//! One step of all parcels through the mesh: flight by gravity, the force of the gas and drag, with impacts on walls.

use calcine_coupler::mesh::tetrahedra::TetPlace;
use calcine_coupler::parcels::ParcelImpact;
use calcine_coupler::physics::Vec3;
use rayon::prelude::*;

use super::flight::Flight;
use super::tetrahedra::Tetrahedra;
use super::track::WayEnd;
use super::walls::{WallFaces, rebound};

/// Parcels that one thread takes at a time.
pub const PIECE: usize = 256;
/// Impacts in a step after which a parcel slides along the wall to the step's end.
const IMPACTS: u32 = 8;

/// Walls that a parcel may meet on a way that is no flight; in a corner there are three.
const CORNERS: u32 = 4;

/// A parcel as it flies.
#[derive(Clone, Copy, Debug)]
pub struct FlyingParcel {
    /// Centre in m.
    pub position: Vec3,
    /// Velocity in m/s.
    pub velocity: Vec3,
    /// Its tetrahedron.
    pub place: TetPlace,
    /// Population.
    pub population: u32,
    /// What drag has added to its velocity since the window began, in m/s.
    pub dragged: Vec3,
    /// What the resistance has, in m/s.
    pub resisted: Vec3,
    /// Share of the resistance in what it and drag take of a force of the step.
    pub resistance: f64,
    /// Share φ₁ of what a force would add to its velocity in the step without drag.
    pub yielding: f64,
    /// What walls have added to its velocity in the step, in m/s.
    pub rebounded: Vec3,
}

/// Moves all parcels over a time in s; `flights` are what acts on each.
pub fn fly(
    tetrahedra: &Tetrahedra,
    walls: &WallFaces,
    (parcels, flights): (&mut [FlyingParcel], &[Flight]),
    time: f64,
) {
    parcels
        .par_iter_mut()
        .zip(flights)
        .with_min_len(PIECE)
        .for_each(|(parcel, flight)| parcel.fly(tetrahedra, walls, flight, time));
}

impl FlyingParcel {
    fn fly(&mut self, tetrahedra: &Tetrahedra, walls: &WallFaces, flight: &Flight, time: f64) {
        self.rebounded = Vec3::zeros();
        self.yielding = flight.yielding(time);
        self.resistance = match flight.resistance {
            0.0 => 0.0,
            rate => rate / (rate + flight.rate),
        };
        let mut left = time;
        for impacts in 1.. {
            // The way is the chord of the flight, whose ends are exact; what meets a wall is cut there and goes on from it.
            let (way, velocity) = flight.after(left, self.velocity);
            let end = tetrahedra.take(&mut self.place, &mut self.position, way);
            let WayEnd::Wall {
                share,
                face,
                normal,
            } = end
            else {
                self.accelerate(flight, left, velocity);
                return;
            };
            let flown = share * left;
            let met = flight.after(flown, self.velocity).1;
            self.accelerate(flight, flown, met);
            left -= flown;
            let (impact, along) = walls.at(face, self.population, self.position, normal);
            let towards = (met - along).dot(&normal);
            let pressed = (velocity - met).dot(&normal);
            // Rebounds, each e times the one before, end within the step.
            let e = impact.restitution;
            let settles = 2.0 * e * towards <= (1.0 - e) * pressed;
            if settles || impacts == IMPACTS {
                let resting = ParcelImpact {
                    restitution: 0.0,
                    ..impact
                };
                self.rebound(normal, resting, along);
                self.slide(tetrahedra, (normal, resting, along), flight, left);
                return;
            }
            self.rebound(normal, impact, along);
        }
    }

    /// Along a wall for the rest of a step; what presses the parcel against it rubs.
    fn slide(
        &mut self,
        tetrahedra: &Tetrahedra,
        (normal, resting, along): (Vec3, ParcelImpact, Vec3),
        flight: &Flight,
        left: f64,
    ) {
        let before = self.velocity;
        let (free, velocity) = flight.after(left, before);
        self.accelerate(flight, left, velocity);
        self.rebound(normal, resting, along);
        let mut way = free;
        if free.dot(&normal) > 0.0 {
            way = 0.5 * left * (before + self.velocity);
            way -= way.dot(&normal) * normal;
        }
        let end = tetrahedra.take(&mut self.place, &mut self.position, way);
        if let WayEnd::Wall { normal, .. } = end {
            // Into a corner: it stays there until the next step.
            let stopped = ParcelImpact {
                friction: 0.0,
                ..resting
            };
            self.rebound(normal, stopped, Vec3::zeros());
        }
    }

    /// Moves it along a way in m that is no flight: what would leave through a wall goes along it.
    pub fn shift(&mut self, tetrahedra: &Tetrahedra, mut way: Vec3) {
        for _ in 0..CORNERS {
            let end = tetrahedra.take(&mut self.place, &mut self.position, way);
            let WayEnd::Wall { share, normal, .. } = end else {
                return;
            };
            way *= 1.0 - share;
            way -= way.dot(&normal).max(0.0) * normal;
        }
    }

    /// Takes up the velocity after a flight.
    fn accelerate(&mut self, flight: &Flight, time: f64, velocity: Vec3) {
        let gained = velocity - self.velocity - flight.acceleration * time;
        let resisted = flight.resisted(gained, time);
        self.dragged += gained - resisted;
        self.resisted += resisted;
        self.velocity = velocity;
    }

    /// Takes up what a force of the step would add to the velocity without drag; drag takes its part. What is added in m/s.
    pub fn pushed(&mut self, change: Vec3) -> Vec3 {
        let added = self.yielding * change;
        self.velocity += added;
        let taken = added - change;
        let resisted = self.resistance * taken;
        self.dragged += taken - resisted;
        self.resisted += resisted;
        added
    }

    fn rebound(&mut self, normal: Vec3, impact: ParcelImpact, wall: Vec3) {
        let after = rebound(self.velocity, normal, impact, wall);
        self.rebounded += after - self.velocity;
        self.velocity = after;
    }
}
