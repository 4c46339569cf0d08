//! Thermal runaway of beds of particles in idealised containers, through the program: beyond the limit of Frank
//! and Kamenetskii it appears, below it does not (docs/theory.md, DRI-V1).
//!
//! A zero-order reaction sets heat free in particles on a cubic lattice, whose contacts conduct as a continuum of
//! k = G/d does: a slab between walls, whose contacts leave a Biot number, and pieces of an endless cylinder and a
//! sphere cut out of the lattice, in a shell that keeps its temperature. Conductance and size of each container
//! are measured by the same program: with a constant source its steady temperatures say what L²/k is. The
//! limits themselves are integrated here, apart from Calcine, for the activation energy at hand.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;

use calcine::results::Summary;
use calcine::results::read::Series;

use crate::support::program;

/// Distance of centres and diameter in m, wall temperature in K.
const APART: f64 = 10e-3;
const DIAMETER: f64 = 10.1e-3;
const WALL: f64 = 400.0;
/// Activation energy and heat of the reaction in J/mol, gas constant in J/mol/K.
const ENERGY: f64 = 80e3;
const HEAT: f64 = 90e3;
const GAS: f64 = 8.314_462_618;
/// Density in kg/m³ and heat capacity in J/kg/K.
const DENSITY: f64 = 2500.0;
const CAPACITY: f64 = 1000.0;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    Slab,
    Cylinder,
    Sphere,
}

impl Shape {
    /// 0, 1, 2: what stands in front of 1/x in the equation.
    fn bend(self) -> f64 {
        match self {
            Shape::Slab => 0.0,
            Shape::Cylinder => 1.0,
            Shape::Sphere => 2.0,
        }
    }
}

/// Largest δ for which θ'' + (j/x) θ' + δ exp(θ/(1 + ε θ)) = 0 with −θ'(1) = Bi θ(1) has a solution, and its
/// θ in the middle: by Runge and Kutta from the middle outwards, over all θ there.
fn limit(bend: f64, epsilon: f64, biot: f64) -> (f64, f64) {
    let source = |theta: f64| (theta / (1.0 + epsilon * theta)).exp();
    let delta = |middle: f64| {
        let step = 2e-3 / source(middle).sqrt();
        let slope = |x: f64, [theta, p]: [f64; 2]| [p, -bend / x * p - source(theta)];
        let open = |x: f64, [theta, p]: [f64; 2]| match biot.is_finite() {
            true => theta + x * p / biot,
            false => theta,
        };
        let mut x = step;
        let curved = source(middle) / (bend + 1.0);
        let mut state = [middle - 0.5 * curved * x * x, -curved * x];
        loop {
            let moved =
                |k: [f64; 2], share: f64| [state[0] + share * k[0], state[1] + share * k[1]];
            let a = slope(x, state);
            let b = slope(x + 0.5 * step, moved(a, 0.5 * step));
            let c = slope(x + 0.5 * step, moved(b, 0.5 * step));
            let d = slope(x + step, moved(c, step));
            let mean = |k: usize| (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]) / 6.0;
            let next = [state[0] + step * mean(0), state[1] + step * mean(1)];
            let (before, after) = (open(x, state), open(x + step, next));
            if after <= 0.0 {
                let edge = x + step * before / (before - after);
                return edge * edge;
            }
            (x, state) = (x + step, next);
        }
    };
    let middles = (1..300).map(|k| 0.5 + f64::from(k) * 0.01);
    let found = middles.map(|middle| (delta(middle), middle));
    found.fold(
        (0.0, 0.0),
        |best, one| if one.0 > best.0 { one } else { best },
    )
}

#[test]
fn the_integrated_limits_are_those_of_frank_and_kamenetskii() {
    // D. A. Frank-Kamenetskii, Diffusion and Heat Exchange in Chemical Kinetics, 1955: 0.878, 2, 3.322.
    for (bend, published) in [(0.0, 0.878), (1.0, 2.0), (2.0, 3.322)] {
        let (delta, _) = limit(bend, 0.0, f64::INFINITY);
        assert!(
            (delta / published - 1.0).abs() < 1e-3,
            "{delta} {published}"
        );
    }
    // Semenov's limit, where all resistance is at the surface: δ → Bi (j + 1)/e.
    let (delta, middle) = limit(0.0, 0.0, 1e-3);
    assert!((delta / (1e-3 / 1f64.exp()) - 1.0).abs() < 1e-2, "{delta}");
    assert!((middle - 1.0).abs() < 0.05, "{middle}");
}

/// A bed in its container, as files of a case.
struct Container {
    shape: Shape,
    /// Centres of particles that react, and of those that keep the temperature of the wall.
    inside: Vec<[f64; 3]>,
    shell: Vec<[f64; 3]>,
    /// Size of the box in m.
    size: [f64; 3],
}

impl Container {
    /// Half a slab, a quarter of a cylinder of one layer, an eighth of a sphere, `radius` particles wide; no heat
    /// passes planes of symmetry.
    fn new(shape: Shape, radius: usize) -> Self {
        let wide = radius + 2;
        let counts = match shape {
            Shape::Slab => [1, 1, radius],
            Shape::Cylinder => [wide, wide, 1],
            Shape::Sphere => [wide; 3],
        };
        let within = |[i, j, k]: [usize; 3]| {
            let square = |n: usize| (n as f64 + 0.5).powi(2);
            let square = match shape {
                Shape::Slab => 0.0,
                Shape::Cylinder => square(i) + square(j),
                Shape::Sphere => square(i) + square(j) + square(k),
            };
            square < (radius as f64).powi(2)
        };
        let (mut inside, mut shell) = (Vec::new(), Vec::new());
        for k in 0..counts[2] {
            for j in 0..counts[1] {
                for i in 0..counts[0] {
                    let place = [i, j, k].map(|n| (n as f64 + 0.5) * APART);
                    let lower = |axis: usize| {
                        let mut beside = [i, j, k];
                        beside[axis] = beside[axis].wrapping_sub(1);
                        [i, j, k][axis] > 0 && within(beside)
                    };
                    if within([i, j, k]) {
                        inside.push(place);
                    } else if (0..3).any(lower) {
                        shell.push(place);
                    }
                }
            }
        }
        Self {
            shape,
            inside,
            shell,
            size: counts.map(|n| n as f64 * APART),
        }
    }

    /// Runs the bed with a rate in mol/m³/s at the temperature of the wall, for so many windows of a span in s;
    /// temperatures of the first two particles at the end, and the highest of all times, in K above the wall's.
    fn run(&self, rate: f64, energy: f64, (windows, span): (u32, f64)) -> [f64; 3] {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str, centres: &[[f64; 3]]| {
            let mut text = String::from("x,y,z\n");
            for [x, y, z] in centres {
                let _ = writeln!(text, "{x},{y},{z}");
            }
            std::fs::write(folder.path().join(name), text).unwrap();
        };
        file("inside.csv", &self.inside);
        file("shell.csv", &self.shell);
        let case = folder.path().join("case.toml");
        std::fs::write(&case, self.case(rate, energy, (windows, span))).unwrap();
        let out = folder.path().join("out");
        // Particles that have run away burn so fast that a window may have no end: what came before counts.
        let ended = run(&case, &out);
        let summary = Summary::read(&out).unwrap();
        for name in ["energy", "particle_mass"] {
            let error = summary.ledger.lines[name].relative_error;
            // What the shell takes up is little of what it holds.
            assert!(!ended || error < 1e-7, "{name}: {error}");
        }
        let series = Series::read(&out).unwrap();
        let hottest = series.column("quantities.hottest").iter();
        let [first, second] = ["first", "second"]
            .map(|name| *series.column(&format!("quantities.{name}")).last().unwrap() - WALL);
        [first, second, hottest.copied().fold(0.0, f64::max) - WALL]
    }

    fn case(&self, rate: f64, energy: f64, (windows, span): (u32, f64)) -> String {
        let factor = rate * (energy / (GAS * WALL)).exp();
        let [x, y, z] = self.size;
        let population = |name: &str, material: &str| {
            format!(
                "[[particles]]\nname = \"{name}\"\nmaterial = \"{material}\"\ndiameter = \"{DIAMETER} m\"\n\
                 motion = \"frozen\"\nplace = {{ file = \"{name}.csv\" }}\ntemperature = \"{WALL} K\"\n"
            )
        };
        let shell = if self.shell.is_empty() {
            format!(
                "[[walls]]\nname = \"wall\"\nmaterial = \"steel\"\npatches = [\"bottom\"]\ntemperature = \"{WALL} K\"\n"
            )
        } else {
            population("shell", "steel")
        };
        format!(
            r#"format = 1
title = "Self-heating in a container"
[time]
end = "{end} s"
process_step = "{span} s"
[mesh]
box = {{ size = "{x} {y} {z} m", cells = [1, 1, 1] }}
[solids.warm]
formula = "SiO2"
formation_enthalpy = "-820.7 kJ/mol"
entropy = "41.5 J/mol/K"
heat_capacity = "{CAPACITY} J/kg/K"
[solids.spent]
formula = "SiO2"
formation_enthalpy = "-910.7 kJ/mol"
entropy = "41.5 J/mol/K"
heat_capacity = "{CAPACITY} J/kg/K"
[materials.grain]
density = "{DENSITY} kg/m^3"
composition = {{ mass = {{ warm = 1 }} }}
conductivity = "2 W/m/K"
[materials.steel]
density = "{DENSITY} kg/m^3"
heat_capacity = "1e8 J/kg/K"
conductivity = "2 W/m/K"
[gas]
mixture = "air"
initial = {{ temperature = "{WALL} K", pressure = "1 atm" }}
held = true
[gas.patch.bottom]
wall = {{ velocity = "slip", heat = "adiabatic" }}
[gas.patch.top]
outlet = {{ pressure = "1 atm" }}
[gas.patch.side]
wall = {{ velocity = "slip", heat = "adiabatic" }}
{inside}{shell}
[[reactions]]
name = "self-heating"
equation = "warm => spent"
law = "power-law"
rate = {{ factor = {factor:e}, activation_energy = "{energy} J/mol", orders = {{}} }}
[laws]
drag = {{ law = "none" }}
heat_transfer = {{ law = "none" }}
conduction = {{ law = "batchelor-obrien" }}
radiation = {{ law = "none" }}
[coupling]
mapping = "centroid"
smoother = {{ max_solid_fraction = 0.9 }}
[output]
every = "{end} s"
series_every = "{span} s"
gas = []
particles = ["temperature"]
[[quantities]]
name = "first"
measure = {{ particle = "temperature", number = 1 }}
[[quantities]]
name = "second"
measure = {{ particle = "temperature", number = 2 }}
[[quantities]]
name = "hottest"
measure = {{ particles = "temperature", statistic = "max" }}
"#,
            end = f64::from(windows) * span,
            inside = population("inside", "grain"),
        )
    }
}

/// Runs a case; false where its reactions went faster than could be followed.
fn run(case: &Path, out: &Path) -> bool {
    let output = program::command(case, out, &[], &[""; 0]).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    let fast = text.contains("the rates could not be followed");
    assert!(output.status.success() || fast, "{text}");
    output.status.success()
}

/// What the container conducts, from its temperatures with a constant source.
#[derive(Clone, Copy, Debug)]
struct Measured {
    /// (L/d)² over the conductance of a contact, in K/W, and the Biot number.
    resistance: f64,
    biot: f64,
    /// Conductance of a contact in W/K.
    contact: f64,
}

const VOLUME: f64 = PI / 6.0 * DIAMETER * DIAMETER * DIAMETER;

fn measure(container: &Container, contact: Option<f64>, radius: usize) -> Measured {
    let rate = 1e-3;
    let source = rate * VOLUME * HEAT;
    let wide = (radius * radius) as f64;
    // Long against the conduction through the bed, whatever its contacts are: 2 k √(R* δ), about 2 mW/K.
    let time = wide * DENSITY * VOLUME * CAPACITY / 2e-3;
    let [first, second, hottest] = container.run(rate, 0.0, (40, 0.4 * time));
    if container.shape == Shape::Slab {
        // Particle 1 is at the wall, and passes on the heat of all.
        let count = radius as f64;
        let contact = (count - 1.0) * source / (second - first);
        let beside = 1.0 / (count * source / first);
        let film = beside - 0.5 / contact;
        return Measured {
            resistance: wide / contact,
            biot: count / (contact * film),
            contact,
        };
    }
    let contact = contact.unwrap();
    // T = T_c − q r²/(2 (j+1) G d²), and the hottest particle is half a distance off each plane of symmetry.
    let bend = container.shape.bend();
    let off = (bend + 1.0) / 4.0;
    let square = 2.0 * (bend + 1.0) * contact * hottest / source + off;
    Measured {
        resistance: square / contact,
        biot: f64::INFINITY,
        contact,
    }
}

#[test]
fn runaway_appears_beyond_the_limit_of_a_container_and_not_below_it() {
    let epsilon = GAS * WALL / ENERGY;
    let rise = epsilon * WALL;
    let mut contact = None;
    for (shape, radius, [windows, share]) in [
        (Shape::Slab, 12, [400.0, 0.05]),
        (Shape::Cylinder, 10, [200.0, 0.04]),
        (Shape::Sphere, 8, [150.0, 0.03]),
    ] {
        let container = Container::new(shape, radius);
        let measured = measure(&container, contact, radius);
        contact = contact.or(Some(measured.contact));
        let (delta, middle) = limit(shape.bend(), epsilon, measured.biot);
        // δ = E/(R T²) q L²/k, with k = G/d and q by the volume d³ of a particle.
        let rate = |of_limit: f64| of_limit * delta * rise / (measured.resistance * VOLUME * HEAT);
        let time = measured.resistance * DENSITY * VOLUME * CAPACITY;
        let run = |of_limit: f64| {
            let windows = (windows as u32, share * time);
            container.run(rate(of_limit), ENERGY, windows)[2] / rise
        };
        let (below, above) = (run(0.96), run(1.04));
        println!(
            "{shape:?}: {} particles, Bi {:.1}, effective radius {:.3} d, limit {delta:.4} (θ {middle:.2}): θ = \
             {below:.3} at 0.96 of it, {above:.1} at 1.04",
            container.inside.len(),
            measured.biot,
            (measured.resistance * measured.contact).sqrt(),
        );
        assert!(below > 0.6 * middle && below < middle, "{shape:?}: {below}");
        assert!(above > 2.0 * middle, "{shape:?}: {above}");
    }
}
