//! Friction of parcels under the stress of the solid: from parcels to cells and back (docs/theory.md, NSP-1).

use calcine_coupler::mesh::tetrahedra::{Barycentric, TetPlace};
use calcine_coupler::parcels::ParcelFriction;
use calcine_coupler::physics::Vec3;

use super::friction::{RubbingCell, RubbingFace, RubbingSolid, RubbingWall};
use super::packing::{Packer, RowAmounts};
use super::step::FlyingParcel;
use super::tetrahedra::Tetrahedra;
use super::walls::WallFaces;

/// No row of the cells with solid.
const NONE: usize = usize::MAX;

/// What rubs in a step.
#[derive(Clone, Copy, Debug)]
pub struct RubStep<'a> {
    /// The law.
    pub friction: ParcelFriction,
    /// The walls.
    pub walls: &'a WallFaces,
    /// The tetrahedra of the mesh.
    pub tetrahedra: &'a Tetrahedra,
    /// Length of the step in s.
    pub time: f64,
}

impl RubStep<'_> {
    /// Has friction act under a stress in Pa; the impulse in N s that walls gave all parcels.
    pub fn act(
        &self,
        (packer, stress): (&Packer, &[f64]),
        (parcels, amounts): (&mut [FlyingParcel], RowAmounts<'_>),
    ) -> Vec3 {
        if stress.is_empty() {
            return Vec3::zeros();
        }
        let mesh = self.tetrahedra.mesh();
        let weights = packer.weights();
        let solid = packer.solid(self.tetrahedra, parcels, amounts);
        let holds = |cell: &usize| solid.mass[*cell] > 0.0 && solid.yielding[*cell] > 0.0;
        let cells: Vec<usize> = (0..mesh.cells()).filter(holds).collect();
        let mut row_of = vec![NONE; mesh.cells()];
        for (row, &cell) in cells.iter().enumerate() {
            row_of[cell] = row;
        }
        let place = |parcel: &FlyingParcel| {
            let map = self.tetrahedra.map(parcel.place);
            (parcel.place, map.of(parcel.position))
        };
        let places: Vec<(TetPlace, Barycentric)> = parcels.iter().map(place).collect();
        // From the centre of each cell to the centre of mass of what belongs to it, in m.
        let mut offset = vec![Vec3::zeros(); mesh.cells()];
        for ((parcel, &at), amount) in parcels.iter().zip(&places).zip(amounts.mass) {
            weights.shares(mesh, at, |cell, share| {
                let cell = cell as usize;
                let way = parcel.position - mesh.cell_centre()[cell];
                let way = mesh.periodicity().shortest(way);
                offset[cell] += share * *amount / solid.mass[cell] * way;
            });
        }
        let rubbing = cells.iter().map(|&cell| RubbingCell {
            // What drag leaves of an impulse accelerates less.
            mass: solid.mass[cell] * solid.mass[cell] / solid.yielding[cell],
            velocity: solid.momentum[cell] / solid.mass[cell],
        });
        let rubbing: Vec<RubbingCell> = rubbing.collect();
        let grid = packer.grid();
        let mut inner = Vec::new();
        for (index, face) in grid.faces[..grid.internal].iter().enumerate() {
            let rows = [row_of[face.owner], row_of[face.neighbour]];
            if rows.contains(&NONE) {
                continue;
            }
            // As the stress of the face is shared by the masses at both its sides, so much rests on it.
            let [own, other] = [face.owner, face.neighbour].map(|cell| solid.mass[cell]);
            let between =
                (own * stress[face.neighbour] + other * stress[face.owner]) / (own + other);
            inner.push(RubbingFace {
                cells: rows,
                way: grid.between(index) + offset[face.neighbour] - offset[face.owner],
                normal: face.normal,
                limit: self.friction.bed * between * face.area * self.time,
            });
        }
        let against = Against::new(parcels, amounts, mesh.cells());
        let mut walls = Vec::new();
        for (index, face) in grid.faces.iter().enumerate().skip(grid.internal) {
            let row = row_of[face.owner];
            if row == NONE {
                continue;
            }
            let of_mesh = packer.face_of_mesh(index);
            let friction = against.friction(self.walls, of_mesh, face.owner);
            let pressed = packer.stress_at_wall(stress, face.owner, index);
            let centre = grid.centre[face.owner] + offset[face.owner];
            let distance = face.owner_distance - offset[face.owner].dot(&face.normal);
            let way = distance * face.normal;
            let velocity = self.walls.velocity(of_mesh, centre + way, face.normal);
            walls.push(RubbingWall {
                cell: row,
                way,
                normal: face.normal,
                velocity,
                limit: friction * pressed * face.area * self.time,
            });
        }
        let changes = RubbingSolid::new(rubbing, inner, walls, self.friction.slip).changes();
        // Impulses over the masses: drag takes its part of them where parcels take them up.
        let mut felt = vec![Vec3::zeros(); mesh.cells()];
        for (&cell, change) in cells.iter().zip(changes) {
            felt[cell] = solid.mass[cell] / solid.yielding[cell] * change;
        }
        let felt = weights.spread(mesh, &felt);
        let mut given = Vec3::zeros();
        for ((parcel, at), mass) in parcels.iter_mut().zip(places).zip(amounts.mass) {
            let change = weights.at(mesh, &felt, at);
            parcel.pushed(change);
            given += *mass * change;
        }
        given
    }
}

/// Of which populations the mass in each cell is.
struct Against {
    populations: usize,
    /// Mass in kg by cell and population.
    mass: Vec<f64>,
}

impl Against {
    fn new(parcels: &[FlyingParcel], amounts: RowAmounts<'_>, cells: usize) -> Self {
        let populations = parcels.iter().map(|parcel| parcel.population as usize + 1);
        let populations = populations.max().unwrap_or(1);
        let mut mass = vec![0.0; cells * populations];
        for (parcel, amount) in parcels.iter().zip(amounts.mass) {
            mass[parcel.place.cell as usize * populations + parcel.population as usize] += amount;
        }
        Self { populations, mass }
    }

    /// Mean coefficient of friction of a wall with what lies in a cell, by mass; of all populations where none does.
    fn friction(&self, walls: &WallFaces, face: usize, cell: usize) -> f64 {
        let masses = &self.mass[cell * self.populations..][..self.populations];
        let whole: f64 = masses.iter().sum();
        let even = 1.0 / self.populations as f64;
        let share = |mass: &f64| if whole > 0.0 { mass / whole } else { even };
        let parts = masses.iter().enumerate();
        parts
            .map(|(population, mass)| share(mass) * walls.friction(face, population))
            .sum()
    }
}
