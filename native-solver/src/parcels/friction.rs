//! Friction of the solid with itself and with walls, by the averages of the mesh (docs/theory.md, NSP-1).
//!
//! The mean velocities of the cells at the end of a step are those that minimise
//!
//! ½ Σ_c m_c |u_c − u_c*|² + Σ_f μ_f τ_f A_f Δt √(|s_f|² + s₀²),
//!
//! with the slip s_f along each face. Between two cells it is u_N − u_P − ω_f × (x_N − x_P) along the face, x the centres of mass and
//! ω_f the mean of the rotations that fit the neighbours of both cells best; at a wall it is that of the solid at the wall. So no impulse is
//! larger than μ τ A Δt, a bed that moves or turns as one feels nothing, and momentum and its moment are kept to round-off,
//! however far the iteration goes (Kačanov's: weighted least squares by conjugate gradients).

use calcine_coupler::physics::Vec3;
use nalgebra::Matrix3;

/// Iterations at most.
const ITERATIONS: u32 = 30;
/// What is left of the impulses, as a share of those that friction can give, at which they end.
const LEFT: f64 = 1e-3;
/// Share of its residual that a linear solve leaves.
const SOLVED: f64 = 0.1;
/// Iterations of a linear solve at most.
const LINEAR: u32 = 200;
/// Moments of inertia of the neighbours below this share of their sum are none.
const SLENDER: f64 = 1e-9;

/// The solid in a cell.
#[derive(Clone, Copy, Debug)]
pub struct RubbingCell {
    /// Mass in kg that an impulse accelerates.
    pub mass: f64,
    /// Mean velocity in m/s.
    pub velocity: Vec3,
}

/// A face between two cells with solid.
#[derive(Clone, Copy, Debug)]
pub struct RubbingFace {
    /// Both cells.
    pub cells: [usize; 2],
    /// From the centre of mass of the first to that of the second, in m.
    pub way: Vec3,
    /// Unit normal.
    pub normal: Vec3,
    /// Largest impulse in N s.
    pub limit: f64,
}

/// A face between a cell and a wall.
#[derive(Clone, Copy, Debug)]
pub struct RubbingWall {
    /// The cell.
    pub cell: usize,
    /// From its centre of mass to the wall, in m.
    pub way: Vec3,
    /// Unit normal.
    pub normal: Vec3,
    /// Velocity of the wall there in m/s.
    pub velocity: Vec3,
    /// Largest impulse in N s.
    pub limit: f64,
}

/// How the rotation of the solid about a cell follows from the velocities of its neighbours.
#[derive(Clone, Debug, Default)]
struct RotationFit {
    inverse: Matrix3<f64>,
    /// Neighbours, with the ways to them over their squares, in 1/m.
    neighbours: Vec<(usize, Vec3)>,
}

/// Solid that rubs.
#[derive(Clone, Debug)]
pub struct RubbingSolid {
    cells: Vec<RubbingCell>,
    inner: Vec<RubbingFace>,
    walls: Vec<RubbingWall>,
    fits: Vec<RotationFit>,
    /// Slip s₀ in m/s below which friction falls off.
    slip: f64,
}

/// The inverse of the inertia of neighbours; those along a line do not tell how it turns about itself.
fn pseudo_inverse(inertia: Matrix3<f64>) -> Matrix3<f64> {
    let mut parts = inertia.symmetric_eigen();
    let least = SLENDER * inertia.trace();
    parts.eigenvalues.apply(|value| {
        *value = if *value > least { 1.0 / *value } else { 0.0 };
    });
    parts.recompose()
}

/// Part along a face.
fn along(vector: Vec3, normal: Vec3) -> Vec3 {
    vector - vector.dot(&normal) * normal
}

fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

impl RubbingSolid {
    /// Cells and the faces between and about them.
    pub fn new(
        cells: Vec<RubbingCell>,
        inner: Vec<RubbingFace>,
        walls: Vec<RubbingWall>,
        slip: f64,
    ) -> Self {
        let mut fits = vec![RotationFit::default(); cells.len()];
        for face in &inner {
            let [one, two] = face.cells;
            let square = face.way.norm_squared();
            if square > 0.0 {
                let way = face.way / square;
                fits[one].neighbours.push((two, way));
                fits[two].neighbours.push((one, -way));
            }
        }
        for fit in &mut fits {
            let mut inertia = Matrix3::zeros();
            for (_, way) in &fit.neighbours {
                // Weights are one over the square of the distance.
                let square = way.norm_squared();
                inertia += (Matrix3::identity() * square - way * way.transpose()) / square;
            }
            fit.inverse = pseudo_inverse(inertia);
        }
        Self {
            cells,
            inner,
            walls,
            fits,
            slip,
        }
    }

    /// What friction adds to the velocity of each cell in m/s.
    pub fn changes(&self) -> Vec<Vec3> {
        let count = self.cells.len();
        let most: f64 = self.limits().sum();
        let mut change = vec![Vec3::zeros(); count];
        let mut moved: Vec<Vec3> = self.cells.iter().map(|cell| cell.velocity).collect();
        for _ in 0..ITERATIONS {
            let slips = self.slips(&moved, true);
            let weights: Vec<f64> = slips
                .iter()
                .zip(self.limits())
                .map(|(slip, limit)| limit / slip.norm().hypot(self.slip))
                .collect();
            let mut residual = self.impulses(&weighted(&slips, &weights));
            for ((left, cell), change) in residual.iter_mut().zip(&self.cells).zip(&change) {
                *left = -(*left + cell.mass * change);
            }
            let left: f64 = residual.iter().map(|left| left.norm()).sum();
            if left <= LEFT * most {
                break;
            }
            let step = self.solve(&weights, residual);
            for ((change, moved), step) in change.iter_mut().zip(&mut moved).zip(&step) {
                *change += step;
                *moved += step;
            }
        }
        change
    }

    fn limits(&self) -> impl Iterator<Item = f64> {
        let inner = self.inner.iter().map(|face| face.limit);
        inner.chain(self.walls.iter().map(|face| face.limit))
    }

    /// Rotation in 1/s about each cell.
    fn rotations(&self, velocity: &[Vec3]) -> Vec<Vec3> {
        let rotation = |(cell, fit): (usize, &RotationFit)| {
            let mut sum = Vec3::zeros();
            for &(other, way) in &fit.neighbours {
                sum += way.cross(&(velocity[other] - velocity[cell]));
            }
            fit.inverse * sum
        };
        self.fits.iter().enumerate().map(rotation).collect()
    }

    /// Slip in m/s along each face, first between cells, then at walls; of the velocities alone where walls stand.
    fn slips(&self, velocity: &[Vec3], walls_move: bool) -> Vec<Vec3> {
        let rotation = self.rotations(velocity);
        let inner = self.inner.iter().map(|face| {
            let [one, two] = face.cells;
            let turn = 0.5 * (rotation[one] + rotation[two]);
            let slip = velocity[two] - velocity[one] - turn.cross(&face.way);
            along(slip, face.normal)
        });
        let walls = self.walls.iter().map(|face| {
            let wall = if walls_move {
                face.velocity
            } else {
                Vec3::zeros()
            };
            let slip = velocity[face.cell] + rotation[face.cell].cross(&face.way) - wall;
            along(slip, face.normal)
        });
        inner.chain(walls).collect()
    }

    /// Impulses in N s that cells give off by impulses along the faces: the transpose of the slips.
    fn impulses(&self, along_faces: &[Vec3]) -> Vec<Vec3> {
        let mut sums = vec![Vec3::zeros(); self.cells.len()];
        let mut moments = vec![Vec3::zeros(); self.cells.len()];
        let (inner, walls) = along_faces.split_at(self.inner.len());
        for (face, &impulse) in self.inner.iter().zip(inner) {
            let [one, two] = face.cells;
            sums[two] += impulse;
            sums[one] -= impulse;
            let moment = 0.5 * face.way.cross(&impulse);
            moments[one] -= moment;
            moments[two] -= moment;
        }
        for (face, &impulse) in self.walls.iter().zip(walls) {
            sums[face.cell] += impulse;
            moments[face.cell] += face.way.cross(&impulse);
        }
        for (cell, fit) in self.fits.iter().enumerate() {
            let moment = fit.inverse * moments[cell];
            for &(other, way) in &fit.neighbours {
                let part = moment.cross(&way);
                sums[other] += part;
                sums[cell] -= part;
            }
        }
        sums
    }

    /// Mass and weighted slips times a change of velocities.
    fn times(&self, weights: &[f64], change: &[Vec3]) -> Vec<Vec3> {
        let slips = self.slips(change, false);
        let mut sums = self.impulses(&weighted(&slips, weights));
        for ((sum, cell), change) in sums.iter_mut().zip(&self.cells).zip(change) {
            *sum += cell.mass * change;
        }
        sums
    }

    /// Conjugate gradients, with the masses as a preconditioner: every iterate is a sum of impulses along faces over the masses, so that
    /// momentum and its moment are kept by each.
    fn solve(&self, weights: &[f64], mut residual: Vec<Vec3>) -> Vec<Vec3> {
        let scaled = |residual: &[Vec3]| -> Vec<Vec3> {
            let pairs = residual.iter().zip(&self.cells);
            pairs.map(|(left, cell)| left / cell.mass).collect()
        };
        let mut solution = vec![Vec3::zeros(); residual.len()];
        let mut z = scaled(&residual);
        let mut direction = z.clone();
        let mut product = dot(&residual, &z);
        let enough = SOLVED * SOLVED * product;
        for _ in 0..LINEAR {
            let image = self.times(weights, &direction);
            let curvature = dot(&direction, &image);
            if curvature <= 0.0 || !curvature.is_finite() {
                break;
            }
            let length = product / curvature;
            for row in 0..residual.len() {
                solution[row] += length * direction[row];
                residual[row] -= length * image[row];
            }
            z = scaled(&residual);
            let next = dot(&residual, &z);
            if next <= enough {
                break;
            }
            let share = next / product;
            for (direction, z) in direction.iter_mut().zip(&z) {
                *direction = z + share * *direction;
            }
            product = next;
        }
        solution
    }
}

fn weighted(slips: &[Vec3], weights: &[f64]) -> Vec<Vec3> {
    let pairs = slips.iter().zip(weights);
    pairs.map(|(slip, weight)| *weight * slip).collect()
}

#[cfg(test)]
mod tests {
    use super::super::collisions::Draws;
    use super::*;

    /// A block of cells, with centres of mass off the corners of a lattice and any velocities.
    fn block(limit: f64) -> (RubbingSolid, Vec<Vec3>) {
        let count = [4, 3, 3];
        let mut draws = Draws::new(7, 0, 0);
        let mut next = || draws.uniform() - 0.5;
        let place = |x: usize, y: usize, z: usize| (z * count[1] + y) * count[0] + x;
        let (mut centre, mut cells, mut inner) = (Vec::new(), Vec::new(), Vec::new());
        for z in 0..count[2] {
            for y in 0..count[1] {
                for x in 0..count[0] {
                    let off = 0.4 * Vec3::new(next(), next(), next());
                    centre.push(0.01 * (Vec3::new(x as f64, y as f64, z as f64) + off));
                    cells.push(RubbingCell {
                        mass: 1e-3 * (1.0 + next()),
                        velocity: Vec3::new(next(), next(), next()),
                    });
                }
            }
        }
        for z in 0..count[2] {
            for y in 0..count[1] {
                for x in 0..count[0] {
                    for (axis, beyond) in [[x + 1, y, z], [x, y + 1, z], [x, y, z + 1]]
                        .into_iter()
                        .enumerate()
                        .filter(|(axis, beyond)| beyond[*axis] < count[*axis])
                    {
                        let pair = [place(x, y, z), place(beyond[0], beyond[1], beyond[2])];
                        inner.push(RubbingFace {
                            cells: pair,
                            way: centre[pair[1]] - centre[pair[0]],
                            normal: Vec3::ith(axis, 1.0),
                            limit: limit * (1.0 + next()),
                        });
                    }
                }
            }
        }
        (RubbingSolid::new(cells, inner, Vec::new(), 1e-4), centre)
    }

    #[test]
    fn what_moves_and_turns_as_one_feels_nothing() {
        let (mut solid, centre) = block(1e-4);
        let turn = Vec3::new(3.0, -7.0, 5.0);
        for (cell, centre) in solid.cells.iter_mut().zip(&centre) {
            cell.velocity = Vec3::new(1.0, 2.0, -0.5) + turn.cross(centre);
        }
        let moved: Vec<Vec3> = solid.cells.iter().map(|cell| cell.velocity).collect();
        let slips = solid.slips(&moved, true);
        let most = slips.iter().map(|slip| slip.norm()).fold(0.0, f64::max);
        assert!(most < 1e-14, "{most}");
        assert_eq!(solid.changes(), vec![Vec3::zeros(); moved.len()]);
    }

    #[test]
    fn momentum_and_its_moment_are_kept_and_energy_falls() {
        let (solid, centre) = block(1e-5);
        let changes = solid.changes();
        let (mut momentum, mut moment, mut size) = (Vec3::zeros(), Vec3::zeros(), 0.0);
        let (mut before, mut after) = (0.0, 0.0);
        for ((cell, change), centre) in solid.cells.iter().zip(&changes).zip(&centre) {
            momentum += cell.mass * change;
            moment += centre.cross(&(cell.mass * change));
            size += cell.mass * change.norm();
            before += cell.mass * cell.velocity.norm_squared();
            after += cell.mass * (cell.velocity + change).norm_squared();
        }
        assert!(size > 1e-6, "{size}");
        assert!(momentum.norm() < 1e-14 * size, "{momentum}");
        assert!(moment.norm() < 1e-14 * size, "{moment}");
        assert!(after < before, "{after} {before}");
    }

    #[test]
    fn strong_friction_makes_one_body_of_the_cells() {
        let (solid, centre) = block(1e-2);
        let changes = solid.changes();
        let moved: Vec<Vec3> = solid
            .cells
            .iter()
            .zip(&changes)
            .map(|(cell, change)| cell.velocity + change)
            .collect();
        // The rigid motion of the same momentum and moment.
        let mass: f64 = solid.cells.iter().map(|cell| cell.mass).sum();
        let mut middle = Vec3::zeros();
        let mut mean = Vec3::zeros();
        for (cell, centre) in solid.cells.iter().zip(&centre) {
            middle += cell.mass / mass * centre;
            mean += cell.mass / mass * cell.velocity;
        }
        let (mut inertia, mut moment) = (Matrix3::zeros(), Vec3::zeros());
        for (cell, centre) in solid.cells.iter().zip(&centre) {
            let way = centre - middle;
            inertia +=
                cell.mass * (Matrix3::identity() * way.norm_squared() - way * way.transpose());
            moment += way.cross(&(cell.mass * cell.velocity));
        }
        let turn = inertia.try_inverse().unwrap_or_default() * moment;
        for (moved, centre) in moved.iter().zip(&centre) {
            let rigid = mean + turn.cross(&(centre - middle));
            // Of 0.5 m/s; what holds slips by less than s₀.
            assert!((moved - rigid).norm() < 5e-3, "{moved} {rigid}");
        }
    }

    #[test]
    fn a_wall_gives_at_most_its_limit_and_carries_what_sticks() {
        for (limit, slides) in [(2e-4, true), (2e-3, false)] {
            let cell = RubbingCell {
                mass: 1e-3,
                velocity: Vec3::new(0.0, 0.0, -0.3),
            };
            let wall = RubbingWall {
                cell: 0,
                way: Vec3::new(0.0, 0.0, -0.01),
                normal: Vec3::new(0.0, 0.0, -1.0),
                velocity: Vec3::new(1.0, 0.0, 0.0),
                limit,
            };
            let solid = RubbingSolid::new(vec![cell], Vec::new(), vec![wall], 1e-4);
            let change = solid.changes()[0];
            let wanted = if slides { limit / 1e-3 } else { 1.0 };
            assert!((change.x / wanted - 1.0).abs() < 1e-3, "{change}");
            assert_eq!([change.y, change.z], [0.0, 0.0]);
        }
    }
}
