//! Upright cylinders of hexahedra: an O-grid, drawn out along z; and boxes graded the same way.

use std::f64::consts::{FRAC_PI_4, PI};

use calcine_physics::Vec3;

use super::extrude::{Plane, extrude};
use super::grading::{Region, levels};
use super::{Mesh, MeshError};

/// How far the core's edges bulge: 0 is a square, 1 a circle.
const ROUNDING: f64 = 0.5;

/// An upright cylinder.
#[derive(Clone, Debug, PartialEq)]
pub struct CylinderSpec {
    /// Centre of its bottom in m.
    pub origin: Vec3,
    /// Diameter in m.
    pub diameter: f64,
    /// Length along z in m.
    pub length: f64,
    /// Cells across the diameter, at least 3: about half in the core, the rest in the ring.
    pub cells_across: usize,
    /// Cells along z, from the bottom; `grading::uniform` for equal ones.
    pub along: Vec<Region>,
    /// Patch names of side, bottom and top; equal names make one patch.
    pub patches: [String; 3],
}

/// The outline of a cylinder's mesh: a regular polygon of the circle's area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outline {
    /// Number of its sides.
    pub sides: usize,
    /// Distance of opposite sides over the diameter, below 1.
    pub across_sides: f64,
    /// Distance of opposite corners over the diameter, above 1.
    pub across_corners: f64,
}

/// The outline of a cylinder with so many cells across. With α = π/sides a polygon whose corners are at the radius R has the area
/// sides R² sin α cos α, which is that of the circle where R² = α/(sin α cos α) of the circle's radius.
pub fn outline(cells_across: usize) -> Outline {
    let sides = 4 * (cells_across - 2 * ring_layers(cells_across));
    let (sine, cosine) = (PI / sides as f64).sin_cos();
    let corners = (PI / sides as f64 / (sine * cosine)).sqrt();
    Outline {
        sides,
        across_sides: corners * cosine,
        across_corners: corners,
    }
}

/// Layers of cells in the ring about the core.
fn ring_layers(across: usize) -> usize {
    (across / 4).max(1)
}

/// The mesh of a cylinder; its outline is a polygon of the same area, so that its volume is π/4 d² L.
pub fn cylinder_mesh(spec: &CylinderSpec) -> Result<Mesh, MeshError> {
    let wrong = |text: String| Err(MeshError::Inconsistent(text));
    if !(spec.diameter.is_finite() && spec.diameter > 0.0) {
        return wrong(format!("a cylinder of {} m diameter", spec.diameter));
    }
    if !(3..=20_000).contains(&spec.cells_across) {
        return wrong(format!(
            "a cylinder of {} cells across; it needs 3 to 20000",
            spec.cells_across
        ));
    }
    let levels = levels(spec.origin.z, spec.length, &spec.along)?;
    let radius = 0.5 * spec.diameter * outline(spec.cells_across).across_corners;
    let mut plane = o_grid(spec.cells_across);
    for [x, y] in &mut plane.points {
        *x = spec.origin.x + radius * *x;
        *y = spec.origin.y + radius * *y;
    }
    extrude(&plane, &levels, &spec.patches, |_| 0)
}

/// Disc with its corners at radius 1: a rounded square of `core`² cells, and a ring of `ring` layers about it.
fn o_grid(across: usize) -> Plane {
    let ring = ring_layers(across);
    let core = across - 2 * ring;
    let size = 1.05 * core as f64 / across as f64;
    let coordinate = |i: usize| 2.0 * i as f64 / core as f64 - 1.0;
    let mut plane = Plane {
        points: Vec::new(),
        cells: Vec::new(),
    };
    for j in 0..=core {
        for i in 0..=core {
            plane
                .points
                .push(rounded(coordinate(i), coordinate(j)).map(|x| size * x));
        }
    }
    let row = core + 1;
    let quad = |a: usize, b: usize, c: usize, d: usize| [a, b, c, d].map(|p| p as u32);
    for j in 0..core {
        for i in 0..core {
            let p = i + row * j;
            plane.cells.push(quad(p, p + 1, p + row + 1, p + row));
        }
    }
    // The core's outline, counter-clockwise from its lower left corner.
    let outline: Vec<usize> = (0..core)
        .chain((0..core).map(|j| core + row * j))
        .chain((0..core).map(|i| core - i + row * core))
        .chain((0..core).map(|j| row * (core - j)))
        .collect();
    let around = outline.len();
    let mut inside = outline.clone();
    for layer in 1..=ring {
        let part = layer as f64 / ring as f64;
        let first = plane.points.len();
        for (k, &at) in outline.iter().enumerate() {
            let angle = FRAC_PI_4 * (2.0 * k as f64 / core as f64 - 3.0);
            let (edge, circle) = (plane.points[at], [angle.cos(), angle.sin()]);
            plane
                .points
                .push([0, 1].map(|axis| (1.0 - part) * edge[axis] + part * circle[axis]));
        }
        let outside: Vec<usize> = (first..first + around).collect();
        for k in 0..around {
            let next = (k + 1) % around;
            plane
                .cells
                .push(quad(inside[k], outside[k], outside[next], inside[next]));
        }
        inside = outside;
    }
    plane
}

/// Bends the square [−1, 1]² towards a disc, the more so the farther from its centre.
fn rounded(s: f64, t: f64) -> [f64; 2] {
    let reach = s.abs().max(t.abs());
    if reach == 0.0 {
        return [0.0, 0.0];
    }
    let (x, y) = (s / reach, t / reach);
    let circle = if s.abs() >= t.abs() {
        let angle = FRAC_PI_4 * y;
        [x * angle.cos(), angle.sin()]
    } else {
        let angle = FRAC_PI_4 * x;
        [angle.sin(), y * angle.cos()]
    };
    let weight = ROUNDING * reach * reach;
    [
        (1.0 - weight) * s + weight * reach * circle[0],
        (1.0 - weight) * t + weight * reach * circle[1],
    ]
}

/// A box with graded cells along each axis.
#[derive(Clone, Debug, PartialEq)]
pub struct GradedBoxSpec {
    /// Its lowest corner in m.
    pub origin: Vec3,
    /// Its edge lengths in m.
    pub size: Vec3,
    /// Regions along x, y, z.
    pub along: [Vec<Region>; 3],
    /// Patch names of the sides x−, x+, y−, y+, z−, z+; sides of equal names make one patch.
    pub patches: [String; 6],
}

/// The mesh of a graded box, numbered as `block::box_mesh` numbers an equal one.
pub fn graded_box_mesh(spec: &GradedBoxSpec) -> Result<Mesh, MeshError> {
    let axis = |a: usize| levels(spec.origin[a], spec.size[a], &spec.along[a]);
    let (x, y, z) = (axis(0)?, axis(1)?, axis(2)?);
    if x.len().saturating_mul(y.len()) > u32::MAX as usize / 12 {
        return Err(MeshError::Inconsistent(format!(
            "{} by {} cells are too many for 32-bit numbering",
            x.len() - 1,
            y.len() - 1
        )));
    }
    let row = x.len();
    let mut plane = Plane {
        points: y
            .iter()
            .flat_map(|&y| x.iter().map(move |&x| [x, y]))
            .collect(),
        cells: Vec::new(),
    };
    for j in 0..y.len() - 1 {
        for i in 0..row - 1 {
            let p = i + row * j;
            plane
                .cells
                .push([p, p + 1, p + row + 1, p + row].map(|p| p as u32));
        }
    }
    let (last_x, last_y) = (x[row - 1], y[y.len() - 1]);
    extrude(&plane, &z, &spec.patches, |[at_x, at_y]| {
        if at_x == x[0] {
            0
        } else if at_x == last_x {
            1
        } else if at_y == y[0] {
            2
        } else {
            debug_assert!(at_y == last_y);
            3
        }
    })
}
