//! Verification of packed beds through the program: Ergun's pressure drop, one bed on cells of very
//! different sizes, still gas, Schumann's heat-up, the same bits on any number of threads.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::fs;
use std::path::{Path, PathBuf};

use calcine::case::{particles, read};
use calcine::results::read::Series;

use crate::support::program::run_text;
use crate::support::schumann;

/// Writes a case, runs it on two threads into a folder of its name, and returns that folder.
fn run(directory: &Path, name: &str, text: &str, words: &[&str]) -> PathBuf {
    run_text(
        directory,
        name,
        text,
        &[words, &["--threads", "2"]].concat(),
    )
}

fn last(series: &Series, name: &str) -> f64 {
    *series.column(name).last().unwrap()
}

/// Ten layers of cells of 10 mm, empty below and above eight that hold two spheres each, in bulk as
/// cubic body-centred: a solid fraction of 0.6.
fn ergun(velocity: f64, viscosity: f64) -> String {
    format!(
        r#"
format = 1
title = "A uniform bed"
[time]
end = "2 s"
motion_window = "10 ms"
[mesh]
box = {{ size = "20 20 100 mm", cells = [2, 2, 10] }}
[materials.glass]
density = "2500 kg/m^3"
heat_capacity = "840 J/kg/K"
[gas]
mixture = "fluid"
initial = {{ temperature = "300 K", pressure = "1 atm", velocity = "0 0 {velocity} m/s" }}
constant = {{ density = "1.2 kg/m^3", heat_capacity = "1000 J/kg/K", viscosity = "{viscosity} Pa s", conductivity = "0.026 W/m/K" }}
[gas.patch.bottom]
inlet = {{ superficial_velocity = "{velocity} m/s", temperature = "300 K" }}
[gas.patch.top]
outlet = {{ pressure = "1 atm" }}
[gas.patch.side]
wall = {{ velocity = "slip", heat = "adiabatic" }}
[[particles]]
name = "corners"
material = "glass"
diameter = "{DIAMETER} m"
motion = "frozen"
temperature = "300 K"
place = {{ grid = {{ first = "2.5 2.5 12.5 mm", spacing = "10 10 10 mm", counts = [2, 2, 8] }} }}
[[particles]]
name = "centres"
material = "glass"
diameter = "{DIAMETER} m"
motion = "frozen"
temperature = "300 K"
place = {{ grid = {{ first = "7.5 7.5 17.5 mm", spacing = "10 10 10 mm", counts = [2, 2, 8] }} }}
[laws]
drag = {{ law = "ergun-wen-yu" }}
heat_transfer = {{ law = "none" }}
conduction = {{ law = "none" }}
radiation = {{ law = "none" }}
[coupling]
mapping = "centroid"
smoother = {{ max_solid_fraction = 0.64, diffusion_length = "0 mm" }}
[output]
every = "2 s"
gas = ["pressure", "velocity", "void_fraction"]
[[probes]]
name = "low"
point = "5 5 35 mm"
[[probes]]
name = "high"
point = "5 5 75 mm"
[[quantities]]
name = "low"
measure = {{ gas = "pressure", probe = "low" }}
[[quantities]]
name = "high"
measure = {{ gas = "pressure", probe = "high" }}
"#
    )
}

/// Diameter in m of spheres of which two fill 0.6 of a cubic centimetre: (1.8/π)^⅓ cm.
const DIAMETER: f64 = 0.008305661;

#[test]
fn a_uniform_bed_has_the_pressure_drop_of_ergun_in_both_regimes() {
    let directory = tempfile::tempdir().unwrap();
    // Re = ρ U d/(μ (1 − ε)): far below and far above 150/1.75 = 86, where both terms are equal.
    for (velocity, viscosity) in [(0.01, 2e-4), (1.0, 2e-5), (5.0, 2e-5)] {
        let case = ergun(velocity, viscosity);
        let out = run(directory.path(), &format!("u{velocity}"), &case, &[]);
        let series = Series::read(&out).unwrap();
        let drop = last(&series, "quantities.low") - last(&series, "quantities.high");
        let (eps, d): (f64, f64) = (0.4, DIAMETER);
        // Requirements COR-5, over the 40 mm between the probes.
        let viscous = 150.0 * 0.36 * viscosity * velocity / (eps.powi(3) * d * d);
        let inertial = 1.75 * 0.6 * 1.2 * velocity * velocity / (eps.powi(3) * d);
        let exact = 0.04 * (viscous + inertial);
        println!(
            "U {velocity} m/s, Re {:.1}: {drop} Pa of {exact} Pa, {:.1e}",
            1.2 * velocity * d / (viscosity * 0.6),
            drop / exact - 1.0
        );
        assert!((drop / exact - 1.0).abs() < 0.01, "{drop} of {exact} Pa");
    }
}

/// The middle of a random bed eight diameters wide, so that no wall has ordered it: centres within
/// 40 × 40 mm of spheres of 10 mm in a layer of so much height, as a file of particles. What of a sphere
/// lies beyond the mesh is mapped into it.
fn cut(directory: &Path, height: usize) -> usize {
    let place = format!(
        "packing = \"random\", region = {{ from = \"40 mm\", to = \"{} mm\" }}, solid_fraction = 0.55, \
         seed = 1",
        40 + height
    );
    let text = in_duct(&place, 20.0, 80, height);
    let case = directory.join("whole.toml");
    fs::write(&case, text).unwrap();
    let case = read(&case, &[]).unwrap_or_else(|errors| panic!("{errors}"));
    let placed = particles(&case, &Default::default()).unwrap();
    let mut table = "x,y,z\n".to_owned();
    let mut count = 0;
    for centre in &placed.setup.position {
        let (x, y) = (centre.x - 0.02, centre.y - 0.02);
        if (0.0..0.04).contains(&x) && (0.0..0.04).contains(&y) {
            table += &format!("{x},{y},{}\n", centre.z);
            count += 1;
        }
    }
    fs::write(directory.join("cut.csv"), table).unwrap();
    count
}

/// A bed in a duct from 40 mm on, cells of so many mm.
fn in_duct(place: &str, size: f64, width: usize, height: usize) -> String {
    let length = height + 80;
    let count = |length: usize| (length as f64 / size).round();
    let cells = [width, width, length].map(|length| count(length) as usize);
    format!(
        r#"
format = 1
title = "One bed on many meshes"
[time]
end = "20 ms"
motion_window = "20 ms"
[mesh]
box = {{ size = "{width} {width} {length} mm", cells = {cells:?} }}
[materials.glass]
density = "2500 kg/m^3"
heat_capacity = "840 J/kg/K"
[gas]
mixture = "air"
initial = {{ temperature = "300 K", pressure = "1 atm", velocity = "0 0 1 m/s" }}
controls = {{ outer_tolerance = 1e-4 }}
[gas.patch.bottom]
inlet = {{ superficial_velocity = "1 m/s", temperature = "300 K" }}
[gas.patch.top]
outlet = {{ pressure = "1 atm" }}
[gas.patch.side]
wall = {{ velocity = "slip", heat = "adiabatic" }}
[[particles]]
name = "spheres"
material = "glass"
diameter = "10 mm"
motion = "frozen"
temperature = "300 K"
place = {{ {place} }}
[laws]
drag = {{ law = "ergun-wen-yu" }}
heat_transfer = {{ law = "none" }}
conduction = {{ law = "none" }}
radiation = {{ law = "none" }}
[coupling]
mapping = "overlap"
[output]
every = "20 ms"
series_every = "20 ms"
gas = ["pressure", "velocity", "void_fraction"]
[[quantities]]
name = "drop"
measure = {{ difference = "pressure", patches = ["bottom", "top"] }}
"#
    )
}

/// Pressure drops in Pa of a case on cells of 20, 6.7 and 2 mm: particle to cell ratios of 0.5, 1.5
/// and 5; the short diffusion has its default length, half a diameter.
fn on_three_meshes(directory: &Path, case: impl Fn(f64) -> String) -> [f64; 3] {
    [20.0, 20.0 / 3.0, 2.0].map(|size| {
        let out = run(directory, &format!("h{size:.0}"), &case(size), &[]);
        last(&Series::read(&out).unwrap(), "quantities.drop")
    })
}

#[test]
fn a_tall_stack_has_one_pressure_drop_on_cells_of_any_size() {
    let directory = tempfile::tempdir().unwrap();
    let stack = "packing = \"simple-cubic\", region = { from = \"40 mm\", to = \"440.1 mm\" }";
    let drops = on_three_meshes(directory.path(), |size| in_duct(stack, size, 20, 400));
    println!("stack: {drops:?} Pa");
    for drop in drops {
        // Above an end that coincides with faces, coarse cells diffuse less: half a diameter of bed.
        assert!((drop / drops[2] - 1.0).abs() < 0.02, "{drops:?} Pa");
    }
}

#[test]
fn a_random_bed_loses_more_pressure_on_cells_that_do_not_see_how_it_varies_sideways() {
    let directory = tempfile::tempdir().unwrap();
    let count = cut(directory.path(), 200);
    assert!(count > 300, "{count}");
    let drops = on_three_meshes(directory.path(), |size| {
        in_duct("file = \"cut.csv\"", size, 40, 200)
    });
    println!("random: {drops:?} Pa");
    let share = |drop: f64| drop / drops[2] - 1.0;
    assert!(share(drops[1]).abs() < 0.01, "{drops:?} Pa");
    assert!((0.0..0.045).contains(&share(drops[0])), "{drops:?} Pa");
}

const SHIPPED: &str = include_str!("../cases/heated-bed.toml");

#[test]
fn still_gas_stays_still_in_a_random_bed_under_gravity_through_the_smoother() {
    let directory = tempfile::tempdir().unwrap();
    let text = SHIPPED
        .replace("velocity = \"0 0 0.5 m/s\"", "velocity = \"0 0 0 m/s\"")
        .replace(
            "superficial_velocity = \"0.5 m/s\", temperature = [[\"0 s\", \"300 K\"], [\"10 s\", \"400 K\"]]",
            "superficial_velocity = \"0 m/s\", temperature = \"300 K\"",
        )
        .replace("controls = { outer_tolerance = 1e-6 }", "gravity = \"0 0 -9.81 m/s^2\"\ncontrols = { outer_tolerance = 1e-10 }")
        .replace("end = \"60 s\"", "end = \"40 s\"");
    let text = text
        + "\n[[quantities]]\nname = \"speed\"\nmeasure = { gas = \"speed\", statistic = \"max\" }\n\
           [[quantities]]\nname = \"pores\"\nmeasure = { gas = \"void_fraction\", statistic = \"min\" }\n";
    let out = run(directory.path(), "still", &text, &[]);
    let series = Series::read(&out).unwrap();
    assert_eq!(last(&series, "windows"), 100.0);
    assert!(last(&series, "quantities.pores") < 0.45);
    let drop = last(&series, "quantities.pressure_drop");
    let speeds = series.column("quantities.speed")[1..].iter();
    let speed = speeds.fold(0.0f64, |most, &speed| most.max(speed));
    println!("{speed:.1e} m/s at most; {drop} Pa of height");
    assert!(speed < 1e-10, "{speed} m/s");
    // ρ g times 100 mm, less what lies beyond the outermost centres.
    assert!(drop > 1.0 && drop < 1.155, "{drop} Pa");
}

#[cfg(feature = "hdf5")]
#[test]
fn a_whole_run_has_the_same_bits_on_one_and_on_two_threads() {
    let directory = tempfile::tempdir().unwrap();
    let set = [
        "--set",
        "time.end=0.8 s",
        "--set",
        "mesh.cylinder.cells=[20, 56]",
        "--set",
        "output.every=1 s",
    ];
    let [one, two] = ["1", "2"].map(|threads| {
        let folder = directory.path().join(format!("on-{threads}"));
        fs::create_dir(&folder).unwrap();
        let words = [&set[..], &["--threads", threads]].concat();
        run_text(&folder, "bed", SHIPPED, &words)
    });
    let summary = calcine::results::Summary::read(&one).unwrap();
    // Loops over fewer than 16 384 cells stay on one thread anyway.
    assert!(summary.cells > 16_384, "{} cells", summary.cells);
    let differing = crate::support::results_equal::differences(&one, &two);
    assert_eq!(differing, [""; 0]);
}

/// Errors in K against Schumann on so many cells, with windows of process time in s.
fn schumann_error(directory: &Path, cells: usize, window: f64, law: &str, gas: &str) -> f64 {
    let text = schumann::case(cells, window, law);
    let name = format!("{gas}-{law}-{cells}-{window}");
    let out = run(directory, &name, &text, &["--gas", gas]);
    schumann::error(&Series::read(&out).unwrap(), cells)
}

#[test]
fn schumann_s_solution_obeys_its_equations() {
    // ∂θ_g/∂ξ = θ_s − θ_g and ∂θ_s/∂η = θ_g − θ_s by central differences.
    for (xi, eta) in [(0.3, 0.2), (2.0, 5.0), (14.0, 9.0), (14.0, 14.0)] {
        let [gas, solid] = schumann::schumann(xi, eta);
        let step = 1e-3;
        let along = schumann::schumann(xi + step, eta)[0] - schumann::schumann(xi - step, eta)[0];
        let later = schumann::schumann(xi, eta + step)[1] - schumann::schumann(xi, eta - step)[1];
        assert!(
            (along / (2.0 * step) - (solid - gas)).abs() < 1e-6,
            "{xi} {eta}"
        );
        assert!(
            (later / (2.0 * step) - (gas - solid)).abs() < 1e-6,
            "{xi} {eta}"
        );
    }
    // At the inlet the solid heats as 1 − e^−η; at first the gas cools as e^−ξ.
    assert!((schumann::schumann(0.0, 1.5)[1] - (1.0 - (-1.5f64).exp())).abs() < 1e-9);
    assert!((schumann::schumann(1.5, 0.0)[0] - (-1.5f64).exp()).abs() < 1e-12);
}

#[test]
fn a_packed_bed_heats_up_as_schumann_found_the_closer_the_finer() {
    let directory = tempfile::tempdir().unwrap();
    let error = |cells, window, law| schumann_error(directory.path(), cells, window, law, "native");
    // Windows of 4, 1 and 0.25 s: implicit steps, first order, over what the cells leave.
    let [long, middle, short] = [4.0, 1.0, 0.25].map(|window| error(40, window, "van-leer"));
    println!("windows: {long:.3}, {middle:.3}, {short:.3} K");
    let order = ((long - middle) / (middle - short)).log2() / 2.0;
    assert!((order - 1.0).abs() < 0.15, "{order}");
    assert!(short < 0.08, "{short} K");
    // Cells of 20, 10 and 5 mm, less what windows of 0.25 s leave at first order.
    let of_window = 0.25 * (long - middle) / 3.0;
    for (law, least, most) in [("upwind", 0.75, 1.1), ("van-leer", 1.5, 2.2)] {
        let [coarse, middle] = [10, 20].map(|cells| error(cells, 0.25, law));
        let fine = if law == "van-leer" {
            short
        } else {
            error(40, 0.25, law)
        };
        println!("{law}: {coarse:.3}, {middle:.3}, {fine:.3} K");
        let [coarse, middle, fine] = [coarse, middle, fine].map(|error| error - of_window);
        for order in [(coarse / middle).log2(), (middle / fine).log2()] {
            assert!(least < order && order < most, "{law}: {order}");
        }
    }
}

#[test]
fn a_bed_heats_up_as_schumann_found_with_openfoam_gas_too() {
    let directory = tempfile::tempdir().unwrap();
    let [native, openfoam] = ["native", "openfoam"]
        .map(|gas| schumann_error(directory.path(), 40, 1.0, "van-leer", gas));
    println!("native {native:.4}, OpenFOAM {openfoam:.4} K");
    assert!(
        openfoam < 0.25 && (openfoam - native).abs() < 0.01,
        "{openfoam} {native} K"
    );
}
