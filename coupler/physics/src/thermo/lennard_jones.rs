//! Chapman and Enskog's viscosity of a gas of Lennard-Jones molecules.

use super::Sutherland;

/// What two molecules of a gas do to each other: a potential of Lennard and Jones.
///
/// μ = 2.6693e-6 √(M T)/(σ² Ω(T*)),   T* = T k/ε,
/// Ω = 1.16145 T*^−0.14874 + 0.52487 e^(−0.77320 T*) + 2.16178 e^(−2.43787 T*),
///
/// μ in Pa s, M in g/mol, σ in Å, T in K.
///
/// Conversion: σ in m, M in kg/mol.
///
/// Validity: dilute gases of molecules without a strong dipole; Ω within 0.16 % from T* = 0.3 to 100.
///
/// Source: Neufeld, Janzen and Aziz, J. Chem. Phys. 57 (1972) 1100, doi 10.1063/1.1678363; Bird, Stewart and Lightfoot,
/// Transport Phenomena (2002), equation 1.4-14.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LennardJones {
    /// Collision diameter σ in m.
    pub diameter: f64,
    /// Depth of the potential ε/k in K.
    pub well_depth: f64,
}

/// Temperatures in K from which, up to which, and how many of which Sutherland's law is fitted.
const FIT: (f64, f64, i32) = (300.0, 1500.0, 61);
/// Sutherland's temperatures in K among which the fit looks, and how closely.
const SOUGHT: (f64, f64) = (1.0, 1e4);
const CLOSENESS: f64 = 1e-9;

impl LennardJones {
    /// Collision integral Ω at a temperature in K.
    pub fn collision_integral(&self, temperature: f64) -> f64 {
        let t = temperature / self.well_depth;
        1.161_45 * t.powf(-0.148_74)
            + 0.524_87 * (-0.773_20 * t).exp()
            + 2.161_78 * (-2.437_87 * t).exp()
    }

    /// Dynamic viscosity in Pa s of molecules of a molar mass in kg/mol, at a temperature in K.
    pub fn viscosity(&self, molar_mass: f64, temperature: f64) -> f64 {
        let angstrom = 1e10 * self.diameter;
        let grams = 1e3 * molar_mass;
        2.6693e-6 * (grams * temperature).sqrt()
            / (angstrom * angstrom * self.collision_integral(temperature))
    }

    /// Sutherland's law nearest to the viscosity, in the least squares of the relative deviation at 61 temperatures in
    /// geometric order from 300 to 1500 K.
    pub fn sutherland(&self, molar_mass: f64) -> Sutherland {
        let (lowest, highest, count) = FIT;
        let ratio = (highest / lowest).powf(1.0 / f64::from(count - 1));
        let points: Vec<(f64, f64)> = (0..count)
            .map(|k| lowest * ratio.powi(k))
            .map(|t| (t, self.viscosity(molar_mass, t)))
            .collect();
        let shape = |s: f64, t: f64| t.sqrt() / (1.0 + s / t);
        // For a given S the best A is a quotient of sums.
        let best = |s: f64| {
            let (mut one, mut two) = (0.0, 0.0);
            for &(t, mu) in &points {
                let g = shape(s, t) / mu;
                one += g;
                two += g * g;
            }
            one / two
        };
        let squares = |s: f64| -> f64 {
            let a = best(s);
            let each = points.iter();
            each.map(|&(t, mu)| (a * shape(s, t) / mu - 1.0).powi(2))
                .sum()
        };
        let temperature = least(squares, SOUGHT);
        Sutherland {
            coefficient: best(temperature),
            temperature,
        }
    }
}

/// Where a function with one minimum between positive bounds has it: golden sections of the logarithm.
fn least(of: impl Fn(f64) -> f64, (from, to): (f64, f64)) -> f64 {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = (from.ln(), to.ln());
    let at = |x: f64| of(x.exp());
    let (mut left, mut right) = (high - golden * (high - low), low + golden * (high - low));
    let (mut f_left, mut f_right) = (at(left), at(right));
    while high - low > CLOSENESS {
        if f_left < f_right {
            (high, right, f_right) = (right, left, f_left);
            left = high - golden * (high - low);
            f_left = at(left);
        } else {
            (low, left, f_left) = (left, right, f_right);
            right = low + golden * (high - low);
            f_right = at(right);
        }
    }
    (0.5 * (low + high)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::thermo::Species;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // Ethane by GRI-Mech 3.0's transport data at 300 K, in Python.
        let ethane = LennardJones {
            diameter: 4.302e-10,
            well_depth: 252.3,
        };
        let omega = ethane.collision_integral(300.0);
        assert!((omega / 1.4603111675240428 - 1.0).abs() < 1e-12, "{omega}");
        let mu = ethane.viscosity(30.07e-3, 300.0);
        assert!((mu / 9.380770461887135e-6 - 1.0).abs() < 1e-12, "{mu:e}");
    }

    #[test]
    fn the_fit_is_that_of_the_built_in_species() {
        // The table's own figures, found apart in Python: four digits of A, a tenth of a kelvin.
        for (name, angstrom, well_depth) in [
            ("N2", 3.621, 97.53),
            ("O2", 3.458, 107.4),
            ("CO2", 3.763, 244.0),
            ("H2", 2.92, 38.0),
            ("CH4", 3.746, 141.4),
        ] {
            let potential = LennardJones {
                diameter: angstrom * 1e-10,
                well_depth,
            };
            let own = Species::built_in(name).unwrap();
            let found = potential.sutherland(own.molar_mass());
            let table = own.sutherland();
            let off = found.coefficient / table.coefficient - 1.0;
            assert!(off.abs() < 5e-4, "{name}: {found:?} {table:?}");
            let off = found.temperature - table.temperature;
            assert!(off.abs() < 0.2, "{name}: {found:?} {table:?}");
        }
    }
}
