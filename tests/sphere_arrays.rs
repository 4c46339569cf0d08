//! A cubic array of spheres, larger than cells, in a domain of one of them that is periodic along all axes (docs/theory.md, BND-2):
//! where the planes cut, through spheres or between them, changes nothing of the drag.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use calcine::results::read;

use crate::support::program::run_text;

/// Distance of neighbours in m, and cells along it.
const PERIOD: f64 = 0.01;
const CELLS: usize = 8;

/// Gas that a pressure gradient drives through the array; the sphere lies at a place in cells.
fn array(place: [f64; 3]) -> String {
    let [x, y, z] = place.map(|cells| 1e3 * PERIOD * cells / CELLS as f64);
    format!(
        r#"
format = 1
title = "An array of spheres"
[time]
end = "0.4 s"
motion_window = "20 ms"
[mesh]
box = {{ size = "10 10 10 mm", cells = [{CELLS}, {CELLS}, {CELLS}], patches = ["left", "right", "front", "back", "bottom", "top"] }}
[materials.glass]
density = "2500 kg/m^3"
heat_capacity = "840 J/kg/K"
[gas]
mixture = "fluid"
initial = {{ temperature = "300 K", pressure = "1 atm" }}
constant = {{ density = "1.2 kg/m^3", heat_capacity = "1 kJ/kg/K", viscosity = "2e-5 Pa s", conductivity = "0.03 W/m/K" }}
pressure_gradient = "-3 0 -10 Pa/m"
controls = {{ convection = "central", outer_tolerance = 1e-10, outer_iterations = 60, linear_tolerance = 1e-13 }}
[gas.patch.left]
periodic = {{ with = "right" }}
[gas.patch.front]
periodic = {{ with = "back" }}
[gas.patch.bottom]
periodic = {{ with = "top" }}
[[particles]]
name = "spheres"
material = "glass"
diameter = "7.5 mm"
motion = "frozen"
temperature = "300 K"
place = {{ grid = {{ first = "{x} {y} {z} mm", spacing = "10 10 10 mm", counts = [1, 1, 1] }} }}
[laws]
drag = {{ law = "gidaspow" }}
heat_transfer = {{ law = "none" }}
conduction = {{ law = "none" }}
radiation = {{ law = "none" }}
[coupling]
mapping = "overlap"
smoother = {{ max_solid_fraction = 0.6, diffusion_length = "2 mm" }}
[output]
every = "0.4 s"
gas = ["velocity"]
particles = ["force", "void_fraction"]
"#
    )
}

/// Force on the sphere in N, the void fraction at its place, and the mean superficial velocity in m/s.
fn found(directory: &std::path::Path, name: &str, place: [f64; 3], gas: &str) -> Vec<f64> {
    let out = run_text(directory, name, &array(place), &["--gas", gas]);
    let last = |list| {
        let files = read::collection(&out, list).unwrap();
        read::arrays(&files.last().unwrap().1).unwrap()
    };
    let (particles, gas) = (last("particles.pvd"), last("gas.pvd"));
    let velocity = gas["velocity"].values.as_chunks::<3>().0;
    let mean = |axis: usize| {
        let sum: f64 = velocity.iter().map(|one| one[axis]).sum();
        sum / velocity.len() as f64
    };
    let mut all = particles["force"].values.clone();
    all.extend(&particles["void_fraction"].values);
    all.extend([mean(0), mean(1), mean(2)]);
    all
}

/// The sphere in the middle, cut by all planes at a corner, and cut by one and two; off the cells' lattice by as much each time.
#[test]
fn the_drag_of_an_array_does_not_depend_on_where_the_boundary_cuts_in_either_gas() {
    let directory = tempfile::tempdir().unwrap();
    for gas in ["native", "openfoam"] {
        let middle = [4.3, 4.1, 4.4];
        let reference = found(directory.path(), &format!("{gas}-middle"), middle, gas);
        println!("{gas}: {reference:?}");
        // It flows along both components of the gradient, which drag takes up in part by then.
        assert!(reference[0] > 1e-8 && reference[2] > 1e-8 && reference[6] > reference[4]);
        for (name, cells) in [
            ("corner", [4.0, 4.0, 4.0]),
            ("face", [0.0, 0.0, 3.0]),
            ("edge", [5.0, 3.0, 0.0]),
        ] {
            let place = [0, 1, 2].map(|axis| (middle[axis] + cells[axis]) % CELLS as f64);
            let name = format!("{gas}-{name}");
            let other = found(directory.path(), &name, place, gas);
            println!("{name}: {other:?}");
            let largest = |range: std::ops::Range<usize>| {
                let each = range.map(|k| (other[k] - reference[k]).abs());
                each.fold(0.0, f64::max)
            };
            let [force, velocity] = [reference[2], reference[6]];
            assert!(largest(0..3) < 1e-8 * force, "{name}: {other:?}");
            assert!(largest(3..4) < 1e-12, "{name}: {other:?}");
            assert!(largest(4..7) < 1e-8 * velocity, "{name}: {other:?}");
        }
    }
}
