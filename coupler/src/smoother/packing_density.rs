//! How densely particles are packed on a scale at which packing means something, whatever the size of the cells.

use crate::mapping::Weights;
use crate::mesh::Mesh;

/// Most cells about which the packing is looked at.
const SAMPLES: usize = 2000;
/// Cells that hold less than this share of solid are beside the bed.
const LEAST: f64 = 1e-9;

/// Median over the volume of the cells with solid of the solid fraction within `reach`, in m, of their centres. In a cell that lies
/// in a particle the solid fraction is 1 however loose the bed is: the mean over some diameters is that of the packing.
/// 0 where there is no solid. `solid_volume`: in m³, by particle.
pub fn median_solid_fraction(
    mesh: &Mesh,
    weights: &Weights,
    solid_volume: &[f64],
    reach: f64,
) -> f64 {
    let volume = mesh.cell_volume();
    let mut solid = vec![0.0; mesh.cells()];
    weights.spread(solid_volume, &mut solid);
    let held = |cell: &usize| solid[*cell] > LEAST * volume[*cell];
    let filled: Vec<usize> = (0..mesh.cells()).filter(held).collect();
    let stride = filled.len().div_ceil(SAMPLES).max(1);
    let mut visited = vec![0_u32; mesh.cells()];
    let samples = filled.iter().step_by(stride).zip(1..);
    let mut found: Vec<(f64, f64)> = samples
        .map(|(&cell, mark)| {
            let about = about(mesh, cell, reach, mark, &mut visited);
            let sums = about.iter().fold((0.0, 0.0), |(held, room), &cell| {
                (held + solid[cell], room + volume[cell])
            });
            (sums.0 / sums.1, volume[cell])
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = 0.5 * found.iter().map(|one| one.1).sum::<f64>();
    let mut below = 0.0;
    let median = found.iter().find(|one| {
        below += one.1;
        below >= half
    });
    median.map_or(0.0, |one| one.0)
}

/// The connected cells whose centres lie within `reach` of that of a cell. `visited` is marked with `mark`, which is new each time.
fn about(mesh: &Mesh, cell: usize, reach: f64, mark: u32, visited: &mut [u32]) -> Vec<usize> {
    let centres = mesh.cell_centre();
    let mut found = vec![cell];
    visited[cell] = mark;
    let mut next = 0;
    while let Some(&current) = found.get(next) {
        next += 1;
        for &face in mesh.faces_of(current) {
            let Some(other) = mesh.beyond(current, face as usize) else {
                continue;
            };
            let other = other.cell;
            let distance = || mesh.periodicity().shortest(centres[other] - centres[cell]);
            if visited[other] != mark && distance().norm() <= reach {
                visited[other] = mark;
                found.push(other);
            }
        }
    }
    found
}
