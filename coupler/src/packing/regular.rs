//! Regular stackings of equal spheres: blocks of so many, and containers filled from wall to wall.

use calcine_physics::Vec3;

use super::container::{Container, Section};
use super::error::{PackingError, positive};
use super::{MOST, Packing, too_many};
use crate::periodicity::Periodicity;

/// Regular stackings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lattice {
    /// Simple cubic: solid fraction π/6 = 0.5236, 6 contacts.
    SimpleCubic,
    /// Hexagonal close, rows along x, close layers along z: π/(3√2) = 0.7405, 12 contacts.
    HexagonalClose,
    /// Face-centred cubic, square layers along z: π/(3√2) = 0.7405, 12 contacts.
    FaceCentred,
}

impl Lattice {
    /// Distances of rows along y and of layers along z, in diameters.
    fn steps(self) -> [f64; 2] {
        match self {
            Self::SimpleCubic => [1.0, 1.0],
            Self::HexagonalClose => [0.75f64.sqrt(), (2.0 / 3.0f64).sqrt()],
            Self::FaceCentred => [1.0, 0.5f64.sqrt()],
        }
    }

    /// Place of sphere i of row j of layer k, in diameters; every second row or layer is set into
    /// the gaps of the one before.
    fn site(self, i: i64, j: i64, k: i64) -> [f64; 3] {
        let [row, layer] = self.steps();
        let odd = k.rem_euclid(2) as f64;
        let (x, y) = match self {
            Self::SimpleCubic => (0.0, 0.0),
            Self::HexagonalClose => (0.5 * (j + k).rem_euclid(2) as f64, row * odd / 3.0),
            Self::FaceCentred => (0.5 * odd, 0.5 * odd),
        };
        [i as f64 + x, row * j as f64 + y, layer * k as f64]
    }
}

/// Round-off of lengths, in diameters: a tube of ten diameters holds ten spheres across.
const ROUND_OFF: f64 = 1e-9;

/// Fills a box (edges `size`, lowest corner `origin`, in m) with whole spheres from its bottom on;
/// what is left over across is shared between opposite walls.
pub fn regular_in_box(
    origin: Vec3,
    size: [f64; 3],
    diameter: f64,
    lattice: Lattice,
) -> Result<Packing, PackingError> {
    positive("box width", size[0])?;
    positive("box width", size[1])?;
    let container = Container {
        origin,
        section: Section::Rectangle {
            size: [size[0], size[1]],
        },
        height: size[2],
        periodicity: Periodicity::default(),
    };
    filled(&container, diameter, lattice)
}

/// Fills an upright cylinder (centre of the bottom `origin`, in m) with whole spheres from its
/// bottom on, one sphere of the lowest layer on the axis.
pub fn regular_in_cylinder(
    origin: Vec3,
    size: [f64; 2],
    diameter: f64,
    lattice: Lattice,
) -> Result<Packing, PackingError> {
    positive("cylinder diameter", size[0])?;
    let container = Container {
        origin,
        section: Section::Disc { diameter: size[0] },
        height: size[1],
        periodicity: Periodicity::default(),
    };
    filled(&container, diameter, lattice)
}

fn filled(container: &Container, diameter: f64, lattice: Lattice) -> Result<Packing, PackingError> {
    positive("height", container.height)?;
    positive("diameter", diameter)?;
    if diameter > container.width() * (1.0 + ROUND_OFF) {
        let width = container.width();
        return Err(PackingError::TooNarrow { diameter, width });
    }
    // 0.74 is the densest, and the sites around the space come on top.
    let sites = container.section.area() * container.height / diameter.powi(3) * 2f64.sqrt();
    if sites > MOST as f64 {
        return Err(too_many(sites));
    }
    let (corner, size) = container.bounds();
    let [row, layer] = lattice.steps();
    let count = |length: f64, step: f64| (length / (step * diameter)).ceil() as i64 + 2;
    let (first, across) = match container.section {
        Section::Disc { .. } => (container.origin, -1),
        Section::Rectangle { .. } => (corner + Vec3::new(0.5, 0.5, 0.0) * diameter, 0),
    };
    let [nx, ny, nz] = [count(size.x, 1.0), count(size.y, row), count(size.z, layer)];
    let mut packing = Packing::default();
    let top = container.height - diameter * (0.5 - ROUND_OFF);
    for k in 0..nz {
        for j in across * ny..ny {
            for i in across * nx..nx {
                let [x, y, z] = lattice.site(i, j, k);
                let centre = first + diameter * Vec3::new(x, y, z + 0.5);
                let across = container.inside(centre, 0.5 * diameter) - centre;
                if centre.z - container.origin.z <= top
                    && across.xy().norm() <= ROUND_OFF * diameter
                {
                    packing.centres.push(centre);
                }
            }
        }
    }
    if let Section::Rectangle { .. } = container.section {
        let high = packing.centres.iter().fold(corner, |high, c| high.sup(c));
        let mut shift = 0.5 * (corner + size - high - Vec3::repeat(0.5 * diameter));
        shift.z = 0.0;
        packing
            .centres
            .iter_mut()
            .for_each(|centre| *centre += shift);
    }
    packing.diameters = vec![diameter; packing.centres.len()];
    packing.height = packing
        .centres
        .last()
        .map_or(0.0, |last| last.z + 0.5 * diameter - container.origin.z);
    Ok(packing)
}

/// Simple cubic: `counts` spheres along x, y, z in a box whose lowest corner is `origin` (m); the
/// box is full to π/6 = 0.5236.
pub fn simple_cubic(origin: Vec3, diameter: f64, counts: [usize; 3]) -> Packing {
    block(Lattice::SimpleCubic, origin, diameter, counts)
}

/// Hexagonal close: without walls the solid fraction is π/(3√2) = 0.7405. `origin` (m) is the lowest
/// corner of the box around them.
pub fn hexagonal_close(origin: Vec3, diameter: f64, counts: [usize; 3]) -> Packing {
    block(Lattice::HexagonalClose, origin, diameter, counts)
}

fn block(lattice: Lattice, origin: Vec3, diameter: f64, [nx, ny, nz]: [usize; 3]) -> Packing {
    let mut centres = Vec::new();
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let site = lattice.site(i as i64, j as i64, k as i64);
                centres.push(origin + diameter * Vec3::from(site.map(|x| x + 0.5)));
            }
        }
    }
    Packing {
        diameters: vec![diameter; centres.len()],
        centres,
        height: diameter * (1.0 + lattice.steps()[1] * (nz.max(1) - 1) as f64),
    }
}
