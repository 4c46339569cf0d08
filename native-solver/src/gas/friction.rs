//! Friction while pressures are corrected. A correction moves velocities by the gradient of the pressure alone, and so lets
//! the gas slip along walls. The friction w = μ A/d that this slip has over one half cell is not that of the window, in which it
//! spreads over a layer of the thickness √(ν Δt). With all of w the second correction overshoots by about √(ν Δt)/(4 d), and outer
//! iterations diverge where ν Δt/d² is large, the more the finer the cells. Corrections therefore take the pull of a wall as
//!
//! w (u* − u_w) + w' (u − u*),  1/w' = (1/w + 1/w_δ) (a − w + g)/a,
//!
//! u* the velocity that the predictor found, w' at most w. w_δ is that of the layer on a row of cells of the same size, which one with the
//! next has the friction g = w d A/V: with i the part of the diagonal a by inertia and drag, all in kg/s,
//!
//! w_δ = i/2 + √(i²/4 + g i).
//!
//! (a − w + g)/a makes of the slip in the cell at the wall, whose diagonal has w in place of g, that of the cells beyond.
//! Where u = u* the pull is w (u − u_w): what the outer loop converges to is the same. Without friction, w ≪ i, corrections are those
//! of PISO (Issa 1986, doi 10.1016/0021-9991(86)90099-9); without inertia, w_δ = 0, two of them make the pressure's
//! preconditioner of Cahouet and Chabard 1988, doi 10.1002/fld.1650080802.
//!
//! A sequence of more corrections ([`HELD`]) sums the series of which two are the first terms: it takes friction in full, and with it what transport
//! does at faces of the velocity that each correction found ([`super::transport`]). On thin layers of prisms it must: there a velocity that differs
//! between the two prisms of a hexahedron is damped by friction between neighbours alone, far less than the diagonal a, and with a pull that is
//! not that of its own velocity the next predictor makes more of it than the corrections took away.

use calcine_coupler::physics::Vec3;

use super::attempt::AttemptFrame;
use super::momentum::Momentum;
use crate::numerics::grid::MeshGraph;
use crate::numerics::parallel::{fill, largest};

/// With more corrections than this in an outer iteration nothing of the friction at walls is held.
pub const HELD: u32 = 2;

/// Part along the face of half a line between two centres, over that along the normal, above which the line is oblique: 6°. Below it two corrections
/// converge at any viscosity that was tried, as on upright cells and wedges.
const OBLIQUE: f64 = 0.1;

/// What the corrections of an outer iteration hold of the friction at walls.
#[derive(Debug, Default)]
pub struct WallFriction {
    /// w − w' of each face of the boundary in kg/s; zero where no velocity is given. Empty where none is at all.
    held: Vec<f64>,
    /// u* of each cell in m/s.
    predicted: Vec<Vec3>,
}

/// w − w' in kg/s, by w, g, i and a in kg/s.
fn held(friction: f64, between: f64, inertia: f64, diagonal: f64) -> f64 {
    if friction == 0.0 {
        return 0.0;
    }
    let layer = 0.5 * inertia + (0.25 * inertia * inertia + between * inertia).sqrt();
    let beyond = diagonal - friction + between;
    let share = layer / (friction + layer) * diagonal / beyond;
    friction * (1.0 - share.min(1.0))
}

impl WallFriction {
    /// Takes up the momentum equation at hand and the velocity that its predictor found.
    pub fn begin(&mut self, frame: &AttemptFrame<'_>, momentum: &Momentum, predicted: &[Vec3]) {
        let grid = frame.grid;
        if (grid.internal..grid.faces.len()).all(|index| momentum.friction(index) == 0.0) {
            self.held.clear();
            return;
        }
        self.predicted.clear();
        self.predicted.extend_from_slice(predicted);
        self.held.resize(grid.faces.len() - grid.internal, 0.0);
        fill(&mut self.held, |boundary| {
            let index = grid.internal + boundary;
            let face = &grid.faces[index];
            let (cell, friction) = (face.owner, momentum.friction(index));
            let between = friction * face.area * face.owner_distance / grid.volume[cell];
            let diagonal = momentum.matrix.diagonal()[cell];
            let inertia = diagonal - momentum.transport(frame, cell);
            held(friction, between, inertia, diagonal)
        });
    }

    /// Holds nothing.
    pub fn release(&mut self) {
        self.held.clear();
    }

    /// What the gas of a cell gets back at a velocity in N: the pull (w − w') (u − u*) of walls on its slip along them.
    pub fn given_back(&self, grid: &MeshGraph, cell: usize, velocity: &Vec3) -> Vec3 {
        let mut force = Vec3::zeros();
        if self.held.is_empty() {
            return force;
        }
        for link in grid.links(cell).iter().filter(|link| link.is_boundary()) {
            let index = link.face as usize;
            let held = self.held[index - grid.internal];
            if held > 0.0 {
                let normal = &grid.faces[index].normal;
                let slip = velocity - self.predicted[cell];
                force += held * (slip - slip.dot(normal) * normal);
            }
        }
        force
    }
}

/// Friction of a cell with what is beside it, in kg/s.
pub fn of_cell(grid: &MeshGraph, momentum: &Momentum, cell: usize) -> f64 {
    let links = grid.links(cell).iter();
    links
        .map(|link| momentum.friction(link.face as usize))
        .sum()
}

/// The largest friction of a cell with an oblique line to a neighbour, over the cell's inertia and drag.
pub fn largest_share(frame: &AttemptFrame<'_>, momentum: &Momentum) -> f64 {
    let grid = frame.grid;
    if grid.orthogonal {
        return 0.0;
    }
    let share = |cell: usize| match leans(grid, cell) {
        true => {
            let held = momentum.matrix.diagonal()[cell] - momentum.transport(frame, cell);
            of_cell(grid, momentum, cell) / held
        }
        false => 0.0,
    };
    largest(grid.cells(), share).1
}

/// True where the line to a neighbour has more along its face than [`OBLIQUE`] allows.
fn leans(grid: &MeshGraph, cell: usize) -> bool {
    let mut links = grid.links(cell).iter();
    links.any(|link| !link.is_boundary() && grid.faces[link.face as usize].leans(OBLIQUE))
}

/// The share of a cell's diagonal that is not friction, convection aside: by so much the first correction of an outer iteration, which
/// overshoots by friction, moves the gradient that carries pressures along faces.
pub fn share_without(grid: &MeshGraph, momentum: &Momentum, cell: usize) -> f64 {
    1.0 - of_cell(grid, momentum, cell) / momentum.matrix.diagonal()[cell]
}

#[cfg(test)]
mod tests {
    use calcine_coupler::conformance::manufactured::meshes::{CellShape, shaped_box};

    use super::*;

    #[test]
    fn lines_are_oblique_from_a_tenth_on() {
        for (shear, oblique) in [(0.0995, false), (0.1005, true)] {
            let lean = |point: Vec3| Vec3::new(point.x + shear * point.z, point.y, point.z);
            let mesh = shaped_box(CellShape::Hexahedra(0.0), 3, lean).unwrap();
            let grid = MeshGraph::new(&mesh);
            assert!((0..grid.cells()).all(|cell| leans(&grid, cell) == oblique));
        }
    }

    #[test]
    fn a_wall_pulls_as_the_layer_that_an_implicit_step_makes() {
        // A row of cells at rest but for a force: with the slip u of cells far away, wall and all cells of a row of 400 solved.
        for (between, inertia) in [(0.1, 1.0), (1.0, 1.0), (40.0, 1.0), (40.0, 9.0)] {
            let wall = 2.0 * between;
            let cells = 400;
            // Thomas' algorithm from the far end, where there is no gradient.
            let (mut fed, mut left) = (0.0, 0.0);
            for cell in (0..cells).rev() {
                let sides = if cell == 0 { wall } else { between };
                let beyond = if cell + 1 < cells { between } else { 0.0 };
                let diagonal = inertia + sides + beyond - beyond * fed;
                left = (inertia + beyond * left) / diagonal;
                fed = between / diagonal;
            }
            let pull = wall * left;
            // Without other friction a is i + w + g at the wall; the slip before friction acts is (a - w + g)/a there.
            let diagonal = inertia + wall + between;
            let slip = (diagonal - wall + between) / diagonal;
            let found = (wall - held(wall, between, inertia, diagonal)) * slip;
            assert!((found / pull - 1.0).abs() < 1e-12, "{found} for {pull}");
        }
    }
}
