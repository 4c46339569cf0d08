//! Regular stackings of equal spheres.

use calcine_physics::Vec3;

use super::Packing;

/// Simple cubic: `counts` spheres along x, y, z in a box whose lowest corner is `origin` (m); the
/// box is full to π/6 = 0.5236.
pub fn simple_cubic(origin: Vec3, diameter: f64, counts: [usize; 3]) -> Packing {
    let height = counts[2] as f64 * diameter;
    stack(diameter, counts, height, |[i, j, k]| {
        origin + diameter * Vec3::new(i + 0.5, j + 0.5, k + 0.5)
    })
}

/// Hexagonal close: rows along x, layers along z, every second row and layer set into the gaps of
/// the one before; without walls the solid fraction is π/(3√2) = 0.7405. `origin` (m) is the lowest
/// corner of the box around them.
pub fn hexagonal_close(origin: Vec3, diameter: f64, counts: [usize; 3]) -> Packing {
    let (row, layer) = (0.75f64.sqrt(), (2.0 / 3.0f64).sqrt());
    let height = diameter * (1.0 + layer * (counts[2].max(1) - 1) as f64);
    stack(diameter, counts, height, |[i, j, k]| {
        let odd = k % 2.0;
        let x = i + 0.5 * ((j + k) % 2.0);
        let y = row * (j + odd / 3.0);
        origin + diameter * Vec3::new(x + 0.5, y + 0.5, layer * k + 0.5)
    })
}

fn stack(
    diameter: f64,
    [nx, ny, nz]: [usize; 3],
    height: f64,
    place: impl Fn([f64; 3]) -> Vec3,
) -> Packing {
    let mut centres = Vec::new();
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                centres.push(place([i, j, k].map(|index| index as f64)));
            }
        }
    }
    Packing {
        diameters: vec![diameter; centres.len()],
        centres,
        height,
    }
}
