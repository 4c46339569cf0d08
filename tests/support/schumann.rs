//! Heat-up of a packed bed by a gas of constant properties: Schumann's exact solution, J. Franklin
//! Inst. 208 (1929) 405, doi 10.1016/S0016-0032(29)91186-8, and a case for it.

use calcine::results::read::Series;

/// Gas: density in kg/m³, c_p in J/kg/K, viscosity in Pa s, conductivity in W/m/K.
const GAS: [f64; 4] = [1.2, 1000.0, 2e-5, 0.02];
/// Superficial velocity in m/s.
const VELOCITY: f64 = 0.5;
/// Diameter of the spheres in m; four lie in 10 × 10 × 5 mm.
const DIAMETER: f64 = 4.5e-3;
/// ρ c of the solid in J/m³/K.
const SOLID: f64 = 2500.0 * 840.0;

/// Modified Bessel function of the first kind, e^−x I₀(x) = (1/π) ∫₀^π e^{x (cos θ − 1)} dθ, by the
/// trapezoidal rule, which converges exponentially for periodic functions.
fn bessel(x: f64) -> f64 {
    let steps = 40 + (8.0 * x.sqrt()) as u32;
    let width = std::f64::consts::PI / f64::from(steps);
    let value = |k: u32| (x * ((f64::from(k) * width).cos() - 1.0)).exp();
    let inner: f64 = (1..steps).map(value).sum();
    (inner + 0.5 * (value(0) + value(steps))) / f64::from(steps)
}

/// ∫₀^to e^{−(with + s)} I₀(2 √(with s)) ds by Simpson's rule in r = √s.
fn integral(to: f64, with: f64) -> f64 {
    let steps = 400;
    let width = to.sqrt() / f64::from(steps);
    let value = |k: u32| {
        let root = f64::from(k) * width;
        let (other, x) = (with.sqrt(), 2.0 * with.sqrt() * root);
        2.0 * root * (-(other - root).powi(2)).exp() * bessel(x)
    };
    let weight = |k: u32| match k {
        0 | 400 => 1.0,
        k if k % 2 == 1 => 4.0,
        _ => 2.0,
    };
    (0..=steps).map(|k| weight(k) * value(k)).sum::<f64>() * width / 3.0
}

/// Temperatures of gas and solid, 0 at the start and 1 in what flows in, at the distance ξ and the time
/// η since the gas arrived, in transfer units.
pub fn schumann(xi: f64, eta: f64) -> [f64; 2] {
    if eta <= 0.0 {
        return [(-xi).exp(), 0.0];
    }
    [1.0 - integral(xi, eta), integral(eta, xi)]
}

/// Solid fraction: four spheres in 10 × 10 × 5 mm.
fn solid_fraction() -> f64 {
    4.0 * std::f64::consts::PI / 6.0 * DIAMETER.powi(3) / 5e-7
}

/// h a in W/m³/K by Gunn's law (docs/theory.md, COR-3), transcribed apart from the program.
fn exchange() -> f64 {
    let [density, capacity, viscosity, conductivity] = GAS;
    let (eps, alpha) = (1.0 - solid_fraction(), solid_fraction());
    let re = density * VELOCITY * DIAMETER / viscosity;
    let pr = (capacity * viscosity / conductivity).cbrt();
    let nu = (7.0 - 10.0 * eps + 5.0 * eps * eps) * (1.0 + 0.7 * re.powf(0.2) * pr)
        + (1.33 - 2.4 * eps + 1.2 * eps * eps) * re.powf(0.7) * pr;
    nu * conductivity / DIAMETER * 6.0 * alpha / DIAMETER
}

/// The bed of 200 mm on so many cells along the flow, at AF = 200, with windows of so much process time in s.
pub fn case(cells: usize, window: f64, convection: &str) -> String {
    let window = window / 200.0;
    let [density, capacity, viscosity, conductivity] = GAS;
    format!(
        r#"
format = 1
title = "Schumann's bed"
[time]
end = "240 s"
motion_window = "{window} s"
acceleration = 200
[mesh]
box = {{ size = "10 10 200 mm", cells = [1, 1, {cells}] }}
[materials.glass]
density = "2500 kg/m^3"
heat_capacity = "840 J/kg/K"
[gas]
mixture = "fluid"
initial = {{ temperature = "300 K", pressure = "1 atm", velocity = "0 0 {VELOCITY} m/s" }}
constant = {{ density = "{density} kg/m^3", heat_capacity = "{capacity} J/kg/K", viscosity = "{viscosity} Pa s", conductivity = "{conductivity} W/m/K" }}
controls = {{ convection = "{convection}" }}
[gas.patch.bottom]
inlet = {{ superficial_velocity = "{VELOCITY} m/s", temperature = "400 K" }}
[gas.patch.top]
outlet = {{ pressure = "1 atm" }}
[gas.patch.side]
wall = {{ velocity = "slip", heat = "adiabatic" }}
[[particles]]
name = "spheres"
material = "glass"
diameter = "{DIAMETER} m"
motion = "frozen"
temperature = "300 K"
place = {{ grid = {{ first = "2.5 2.5 2.5 mm", spacing = "5 5 5 mm", counts = [2, 2, 40] }} }}
[laws]
drag = {{ law = "none" }}
heat_transfer = {{ law = "gunn" }}
conduction = {{ law = "none" }}
radiation = {{ law = "none" }}
[coupling]
mapping = "centroid"
smoother = {{ max_solid_fraction = 0.64, diffusion_length = "0 mm" }}
[output]
every = "240 s"
series_every = "40 s"
"#
    )
}

/// Mean difference in K of the mean of a cell's particles from that of Schumann's solid, over all rows
/// after the start.
pub fn error(series: &Series, cells: usize) -> f64 {
    let [density, capacity, ..] = GAS;
    let per_length = exchange() / (density * VELOCITY * capacity);
    let per_time = exchange() / (solid_fraction() * SOLID);
    let particles = series.particles();
    let held = particles.len() / cells;
    let (mut sum, mut count) = (0.0, 0.0);
    for (row, &time) in series.column("process_time").iter().enumerate() {
        if time == 0.0 {
            continue;
        }
        for cell in 0..cells {
            let mine = cell * held..(cell + 1) * held;
            let difference: f64 = mine
                .map(|index| {
                    let z = 2.5e-3 + 5e-3 * (index / 4) as f64;
                    let arrived = time - z * (1.0 - solid_fraction()) / VELOCITY;
                    let [_, solid] = schumann(per_length * z, per_time * arrived);
                    particles[index].1[row] - 300.0 - 100.0 * solid
                })
                .sum();
            sum += (difference / held as f64).abs();
            count += 1.0;
        }
    }
    assert_eq!(count, 6.0 * cells as f64);
    sum / count
}
