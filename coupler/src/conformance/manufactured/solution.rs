//! A closed form of the fields, and the sources that make it a solution of the equations of docs/theory.md.
//!
//! Fields are written in coordinates X = (ξ, η, ζ) of the upright box, x = X + ζ tan θ e_x, whose Jacobian is 1: a mass flux
//! M = ρ ε u that is a curl there, carried over by M_x = M_ξ + tan θ M_ζ (Piola), has no divergence in the leaning box.
//! Sources are divergences of fluxes by central differences of eighth order, of nothing but the closed forms and the laws
//! of the gas: no formula is shared with a solver.

use std::f64::consts::PI;

use calcine_physics::Vec3;
use calcine_physics::gas::GasProperties;
use calcine_physics::gas_model::GasModel;
use nalgebra::Matrix3;

/// Width of the box along η in m; along ξ and ζ it is 1 m.
pub const WIDTH: f64 = 0.5;
/// Temperature of the walls in K.
pub const WALL: f64 = 300.0;
/// Pressure of the equation of state in Pa.
pub const PRESSURE: f64 = 1e5;
/// Steps of the differences in m: what they leave, h⁸ f⁽⁹⁾/630, is as small as round-off.
const STEP: f64 = 2e-3;

/// Fields of a porous box that leans along x.
#[derive(Clone, Debug)]
pub struct ManufacturedFields {
    /// tan θ.
    pub lean: f64,
    /// Gravity in m/s².
    pub gravity: Vec3,
    /// Drag coefficient K of the middle in kg/m³/s.
    pub drag: f64,
    /// True where the gas takes all of −∇p (model B).
    pub takes_all_pressure: bool,
    /// The gas.
    pub gas: GasModel,
}

impl ManufacturedFields {
    /// Fields of a box that leans by an angle in degrees, at Reynolds and Péclet numbers of some tens.
    pub fn leaning(degrees: f64) -> Self {
        Self {
            lean: degrees.to_radians().tan(),
            gravity: Vec3::new(1.0, 0.0, -2.0),
            drag: 2.0,
            takes_all_pressure: false,
            gas: GasProperties {
                molar_mass: 28.96e-3,
                heat_capacity: 1000.0,
                sutherland_coefficient: 4e-3,
                sutherland_temperature: 116.0,
            }
            .into(),
        }
    }

    /// A point of the upright box, in the leaning one.
    pub fn displaced(&self, point: Vec3) -> Vec3 {
        Vec3::new(point.x + self.lean * point.z, point.y, point.z)
    }

    fn upright(&self, at: Vec3) -> [f64; 3] {
        [at.x - self.lean * at.z, at.y / WIDTH, at.z]
    }

    /// Void fraction.
    pub fn void_fraction(&self, at: Vec3) -> f64 {
        let [x, y, z] = self.upright(at);
        0.6 + 0.15 * (PI * x).cos() * (1.3 * z + 0.4).sin() + 0.05 * (PI * y).cos()
    }

    /// Temperature in K: that of the walls at ξ and ζ, without a slope across η.
    pub fn temperature(&self, at: Vec3) -> f64 {
        let [x, y, z] = self.upright(at);
        let bump = (PI * x).sin() * (PI * z).sin();
        WALL + 60.0 * bump * (1.0 + 0.3 * (PI * y).cos() + 0.4 * (PI * x).cos())
    }

    /// Density in kg/m³.
    pub fn density(&self, at: Vec3) -> f64 {
        self.gas.density(PRESSURE, self.temperature(at), &[])
    }

    /// Superficial mass flux ρ ε u in kg/m²/s, zero at ξ and ζ, along η at η: the curl of (0, G, H),
    /// G = s(ξ) s(ζ) (1 + ½ cos πη)/4, H = s(ξ) s(ζ) sin(πη)/8, s(a) = sin² πa.
    pub fn mass_flux(&self, at: Vec3) -> Vec3 {
        let [x, y, z] = self.upright(at);
        let bubble = |a: f64| (PI * a).sin().powi(2);
        let slope = |a: f64| PI * (2.0 * PI * a).sin();
        let across = 0.25 * (1.0 + 0.5 * (PI * y).cos());
        let along_x = -bubble(x) * slope(z) * across
            + bubble(x) * bubble(z) * 0.125 * PI / WIDTH * (PI * y).cos();
        let along_y = -0.125 * slope(x) * bubble(z) * (PI * y).sin();
        let along_z = slope(x) * bubble(z) * across;
        Vec3::new(along_x + self.lean * along_z, along_y, along_z)
    }

    /// Interstitial velocity in m/s.
    pub fn velocity(&self, at: Vec3) -> Vec3 {
        self.mass_flux(at) / (self.density(at) * self.void_fraction(at))
    }

    /// Pressure above that of the equation of state in Pa, up to a constant.
    pub fn pressure(&self, at: Vec3) -> f64 {
        let [x, y, z] = self.upright(at);
        (PI * x).cos() * (2.0 * z).sin() * (1.0 + 0.5 * (PI * y).cos()) + z * z
    }

    /// Drag coefficient in kg/m³/s.
    pub fn drag_coefficient(&self, at: Vec3) -> f64 {
        let [x, _, z] = self.upright(at);
        self.drag * (1.0 + 0.5 * (2.0 * x + z).sin())
    }

    /// Heat coefficient in W/m³/K.
    pub fn heat_coefficient(&self, at: Vec3) -> f64 {
        let [x, _, z] = self.upright(at);
        500.0 * (1.0 + 0.5 * (x - 2.0 * z).cos())
    }

    /// ρ ε u u − ε μ (∇u + ∇uᵀ − ⅔ ∇·u) in N/m²; row i is what passes of component i.
    fn momentum_flux(&self, at: Vec3) -> Matrix3<f64> {
        let velocity = self.velocity(at);
        let gradient = gradient(|at| self.velocity(at), at);
        let stress =
            gradient + gradient.transpose() - Matrix3::identity() * (2.0 / 3.0 * gradient.trace());
        let viscosity = self.void_fraction(at) * self.gas.viscosity(self.temperature(at), &[]);
        velocity * self.mass_flux(at).transpose() - viscosity * stress
    }

    /// ρ ε u h − ε κ ∇T in W/m².
    fn heat_flux(&self, at: Vec3) -> Vec3 {
        let temperature = self.temperature(at);
        let slope = gradient(|at| Vec3::new(self.temperature(at), 0.0, 0.0), at)
            .row(0)
            .transpose();
        let conductivity = self.void_fraction(at) * self.gas.conductivity(temperature, &[]);
        self.gas.enthalpy(temperature, &[]) * self.mass_flux(at) - conductivity * slope
    }

    /// What particles must give beside −K u, in N/m³.
    pub fn drag_source(&self, at: Vec3) -> Vec3 {
        let push = gradient(|at| Vec3::new(self.pressure(at), 0.0, 0.0), at)
            .row(0)
            .transpose();
        let share = if self.takes_all_pressure {
            1.0
        } else {
            self.void_fraction(at)
        };
        divergence(|at| self.momentum_flux(at), at)
            + share * (push - self.density(at) * self.gravity)
            + self.drag_coefficient(at) * self.velocity(at)
    }

    /// What particles must give beside −H T, in W/m³.
    pub fn heat_source(&self, at: Vec3) -> f64 {
        let flux = |at| {
            Matrix3::from_rows(&[
                self.heat_flux(at).transpose(),
                Vec3::zeros().transpose(),
                Vec3::zeros().transpose(),
            ])
        };
        divergence(flux, at).x + self.heat_coefficient(at) * self.temperature(at)
    }
}

/// Points and weights of the first derivative.
const STENCIL: [(f64, f64); 8] = [
    (-4.0, 1.0 / 280.0),
    (-3.0, -4.0 / 105.0),
    (-2.0, 1.0 / 5.0),
    (-1.0, -4.0 / 5.0),
    (1.0, 4.0 / 5.0),
    (2.0, -1.0 / 5.0),
    (3.0, 4.0 / 105.0),
    (4.0, -1.0 / 280.0),
];

/// ∂f_i/∂x_j.
fn gradient(field: impl Fn(Vec3) -> Vec3, at: Vec3) -> Matrix3<f64> {
    let along = |axis: usize| {
        let mut sum = Vec3::zeros();
        for (steps, weight) in STENCIL {
            let mut beside = at;
            beside[axis] += steps * STEP;
            sum += weight / STEP * field(beside);
        }
        sum
    };
    Matrix3::from_columns(&[along(0), along(1), along(2)])
}

/// ∂F_ij/∂x_j.
fn divergence(flux: impl Fn(Vec3) -> Matrix3<f64>, at: Vec3) -> Vec3 {
    let mut sum = Vec3::zeros();
    for axis in 0..3 {
        for (steps, weight) in STENCIL {
            let mut beside = at;
            beside[axis] += steps * STEP;
            sum += weight / STEP * flux(beside).column(axis);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_exact_to_ten_digits() {
        let field = |at: Vec3| Vec3::new((3.0 * at.x + at.y).sin(), at.z.exp(), at.x * at.y * at.z);
        let at = Vec3::new(0.3, -0.2, 0.7);
        let cos = (0.9f64 - 0.2).cos();
        let exact = Matrix3::new(
            3.0 * cos,
            cos,
            0.0,
            0.0,
            0.0,
            0.7f64.exp(),
            -0.14,
            0.21,
            -0.06,
        );
        assert!((gradient(field, at) - exact).norm() < 1e-11);
        let flux = |at: Vec3| Matrix3::from_diagonal(&field(at));
        let sum = Vec3::new(3.0 * cos, 0.0, -0.06);
        assert!((divergence(flux, at) - sum).norm() < 1e-11);
    }

    #[test]
    fn mass_is_conserved_and_nothing_flows_through_or_along_walls() {
        for degrees in [0.0, 45.0, 70.0] {
            let fields = ManufacturedFields::leaning(degrees);
            let at = fields.displaced(Vec3::new(0.31, 0.17, 0.62));
            assert!(gradient(|at| fields.mass_flux(at), at).trace().abs() < 1e-10);
            for wall in [Vec3::new(1.0, 0.2, 0.3), Vec3::new(0.2, 0.3, 0.0)] {
                let at = fields.displaced(wall);
                assert!(fields.mass_flux(at).norm() < 1e-15);
                assert!((fields.temperature(at) - WALL).abs() < 1e-12);
            }
            let at = fields.displaced(Vec3::new(0.3, WIDTH, 0.6));
            let slope = gradient(|at| fields.velocity(at), at);
            assert!(fields.velocity(at).y.abs() < 1e-14);
            assert!(slope[(0, 1)].abs() < 1e-9 && slope[(2, 1)].abs() < 1e-9);
        }
    }
}
