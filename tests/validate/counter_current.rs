//! A shaft furnace in one dimension, without Calcine's solvers: solids sink, gas rises, burnt gas joins it at the burners.
//!
//! Per area of the shaft, with the enthalpies h_s and h_g and the mass fluxes G_s downwards and G_g upwards in kg/m²/s,
//!
//! G_s dh_s/dz + d/dz (k_e dT_s/dz) + q = 0,   −G_g dh_g/dz + d/dz (D dT_g/dz) − q + burners = 0,   q = h a (T_g − T_s),
//!
//! h by Gunn (1978), k_e by Zehner, Bauer and Schlünder with radiation (Tsotsas and Martin 1987), D the numerical
//! diffusion of upwind convection in the cells of the case. Each section is mixed, and spheres are points: what a sphere, and the width over
//! which it exchanges, carries along the shaft is not in it.

use calcine_coupler::physics::points::linear;
use calcine_coupler::physics::thermo::Species;

/// Slices over the height.
const SLICES: usize = 270;
/// Unknowns beside the diagonal: those of the neighbouring slices.
const BAND: usize = 3;
/// Stefan and Boltzmann's constant in W/m²/K⁴.
const STEFAN: f64 = 5.670_374e-8;
/// Temperature in K at which all comes in.
const COLD: f64 = 300.0;
/// Mole fractions of air, and of what the burners let in, burnt: methane and air at λ = 1.1.
const AIR: &[(&str, f64)] = &[("O2", 0.21), ("N2", 0.79)];
const PREMIXED: &[(&str, f64)] = &[("CH4", 0.087_17), ("O2", 0.191_77), ("N2", 0.721_06)];
const BURNT: &[(&str, f64)] = &[
    ("CO2", 0.087_17),
    ("H2O", 0.174_34),
    ("O2", 0.017_43),
    ("N2", 0.721_06),
];

/// What the case states of its shaft.
pub struct Shaft {
    /// Height in m of the bed, and that of the burners.
    pub height: f64,
    pub burners: f64,
    /// kg/m²/s of solids, of air from below and of the burners.
    pub solids: f64,
    pub air: f64,
    pub fired: f64,
    /// Void fraction, mean diameter in m, height of a cell in m.
    pub voids: f64,
    pub diameter: f64,
    pub cell: f64,
}

/// Species by mass, as shares of a kg.
struct Gas(Vec<(Species, f64)>);

impl Gas {
    fn by_moles(parts: &[(&str, f64)]) -> Self {
        let parts = parts
            .iter()
            .map(|&(name, x)| (Species::built_in(name).unwrap(), x));
        let heavy: Vec<(Species, f64)> = parts
            .map(|(one, x)| (one.clone(), x * one.molar_mass()))
            .collect();
        let all: f64 = heavy.iter().map(|one| one.1).sum();
        Self(
            heavy
                .into_iter()
                .map(|(one, mass)| (one, mass / all))
                .collect(),
        )
    }

    /// With the enthalpy of formation, in J/kg.
    fn enthalpy(&self, kelvin: f64) -> f64 {
        let one = |(one, y): &(Species, f64)| y * (one.formation_enthalpy() + one.enthalpy(kelvin));
        self.0.iter().map(one).sum()
    }

    fn heat_capacity(&self, kelvin: f64) -> f64 {
        self.0
            .iter()
            .map(|(one, y)| y * one.heat_capacity(kelvin))
            .sum()
    }
}

/// Magnesia, as the case has it: heat capacity in J/kg/K, conductivity in W/m/K, emissivity.
fn solid_heat_capacity(kelvin: f64) -> f64 {
    let table = [
        (300.0, 928.0),
        (500.0, 1130.0),
        (1000.0, 1270.0),
        (1500.0, 1318.0),
        (2000.0, 1364.0),
    ];
    linear(&table, kelvin)
}

/// Above the cold, in J/kg, by the midpoints of parts.
fn solid_enthalpy(kelvin: f64) -> f64 {
    let part = (kelvin - COLD) / 32.0;
    let middles = (0..32).map(|k| COLD + (f64::from(k) + 0.5) * part);
    part * middles.map(solid_heat_capacity).sum::<f64>()
}

fn solid_conductivity(kelvin: f64) -> f64 {
    linear(&[(300.0, 20.0), (1000.0, 6.0), (1500.0, 5.0)], kelvin)
}

const EMISSIVITY: f64 = 0.4;

/// Air's viscosity in Pa s and conductivity in W/m/K, power laws through 300 and 1500 K.
fn viscosity(kelvin: f64) -> f64 {
    1.846e-5 * (kelvin / COLD).powf(0.68)
}

fn conductivity(kelvin: f64) -> f64 {
    0.0263 * (kelvin / COLD).powf(0.78)
}

impl Shaft {
    /// Heat transfer in W/m³/K between gas of a mass flux and temperature and the bed.
    fn transfer(&self, flux: f64, kelvin: f64) -> f64 {
        let (e, re, pr) = (
            self.voids,
            flux * self.diameter / viscosity(kelvin),
            0.7_f64,
        );
        let nusselt = (7.0 - 10.0 * e + 5.0 * e * e) * (1.0 + 0.7 * re.powf(0.2) * pr.cbrt())
            + (1.33 - 2.4 * e + 1.2 * e * e) * re.powf(0.7) * pr.cbrt();
        nusselt * conductivity(kelvin) / self.diameter * 6.0 * (1.0 - e) / self.diameter
    }

    /// Conductivity of the bed in W/m/K by Zehner, Bauer and Schlünder, contacts left out.
    fn bed_conductivity(&self, kelvin: f64) -> f64 {
        let (e, gas) = (self.voids, conductivity(kelvin));
        let solid = solid_conductivity(kelvin) / gas;
        let shape = 1.25 * ((1.0 - e) / e).powf(10.0 / 9.0);
        let rays = 4.0 * STEFAN * kelvin.powi(3) * self.diameter / (2.0 / EMISSIVITY - 1.0) / gas;
        let n = 1.0 + (rays - shape) / solid;
        let core = 2.0 / n
            * (shape * (solid + rays - 1.0) / (n * n * solid) * ((solid + rays) / shape).ln()
                + (shape + 1.0) / (2.0 * shape) * (rays - shape)
                - (shape - 1.0) / n);
        let open = (1.0 - e).sqrt();
        gas * ((1.0 - open) * (1.0 + e * rays) + open * core)
    }

    /// Temperatures in K of the solids at heights in m, means over a width in m.
    pub fn solids_at(&self, heights: &[f64], width: f64) -> Vec<f64> {
        let kelvin = self.solve();
        let slice = self.height / SLICES as f64;
        let mean = |middle: &f64| {
            let near = |k: &usize| ((*k as f64 + 0.5) * slice - middle).abs() < 0.5 * width;
            let own: Vec<f64> = (0..SLICES).filter(near).map(|k| kelvin[2 * k]).collect();
            own.iter().sum::<f64>() / own.len() as f64
        };
        heights.iter().map(mean).collect()
    }

    /// Temperatures in K of solids and gas, slice by slice, by Newton's method with pseudo-time steps that grow.
    fn solve(&self) -> Vec<f64> {
        let mut kelvin: Vec<f64> = (0..SLICES)
            .flat_map(|k| {
                let z = (k as f64 + 0.5) * self.height / SLICES as f64;
                let rise = 1.0 - (z - self.burners).abs() / self.burners;
                [
                    400.0 + 1000.0 * rise.max(0.0),
                    400.0 + 1200.0 * rise.max(0.0),
                ]
            })
            .collect();
        let mut inertia = 1e3;
        for _ in 0..400 {
            let (mut rows, residual) = self.linearised(&kelvin);
            for row in &mut rows {
                row[BAND] += inertia;
            }
            let step = banded(rows, residual);
            let largest = step.iter().fold(0.0_f64, |most, one| most.max(one.abs()));
            let share = (150.0 / largest).min(1.0);
            for (kelvin, step) in kelvin.iter_mut().zip(&step) {
                *kelvin = (*kelvin + share * step).clamp(280.0, 2480.0);
            }
            if largest < 20.0 {
                inertia *= 0.5;
            }
            if largest < 1e-6 {
                return kelvin;
            }
        }
        panic!("the one-dimensional furnace does not converge");
    }

    /// Minus the derivatives of the balances of all slices in W/m², and the balances.
    fn linearised(&self, kelvin: &[f64]) -> (Vec<[f64; 2 * BAND + 1]>, Vec<f64>) {
        let slice = self.height / SLICES as f64;
        let (air, premixed, burnt) = (
            Gas::by_moles(AIR),
            Gas::by_moles(PREMIXED),
            Gas::by_moles(BURNT),
        );
        let burner = (self.burners / slice) as usize;
        let gas = |k: usize, kelvin: f64| -> [f64; 2] {
            let fired = if k >= burner { self.fired } else { 0.0 };
            [
                self.air * air.enthalpy(kelvin) + fired * burnt.enthalpy(kelvin),
                self.air * air.heat_capacity(kelvin) + fired * burnt.heat_capacity(kelvin),
            ]
        };
        let mut rows = vec![[0.0; 2 * BAND + 1]; 2 * SLICES];
        let mut residual = vec![0.0; 2 * SLICES];
        // A flow in W/m² out of one unknown's balance into another's, and its slopes by these unknowns.
        let mut flow = |from: usize, to: Option<usize>, by: &[(usize, f64)], watt: f64| {
            residual[from] -= watt;
            for &(at, slope) in by {
                rows[from][at + BAND - from] += slope;
            }
            let Some(to) = to else { return };
            residual[to] += watt;
            for &(at, slope) in by {
                rows[to][at + BAND - to] -= slope;
            }
        };
        for k in 0..SLICES {
            let (solid, above) = (2 * k, 2 * k + 1);
            let (t_s, t_g) = (kelvin[solid], kelvin[above]);
            // Relative to the cold, so that what comes in brings nothing.
            let heat = solid_enthalpy(t_s);
            let slope = self.solids * solid_heat_capacity(t_s);
            let below = k.checked_sub(1).map(|one| 2 * one);
            flow(solid, below, &[(solid, slope)], self.solids * heat);
            let [carried, slope] = gas(k, t_g);
            let next = (k + 1 < SLICES).then_some(above + 2);
            flow(above, next, &[(above, slope)], carried);
            let exchange = slice
                * self.transfer(
                    if k >= burner {
                        self.air + self.fired
                    } else {
                        self.air
                    },
                    t_g,
                );
            let by = [(above, exchange), (solid, -exchange)];
            flow(above, Some(solid), &by, exchange * (t_g - t_s));
            if k + 1 < SLICES {
                let conducts = self.bed_conductivity(0.5 * (t_s + kelvin[solid + 2])) / slice;
                let by = [(solid, conducts), (solid + 2, -conducts)];
                flow(
                    solid,
                    Some(solid + 2),
                    &by,
                    conducts * (t_s - kelvin[solid + 2]),
                );
                let mixes = 0.5 * self.cell * gas(k, t_g)[1] / slice;
                let by = [(above, mixes), (above + 2, -mixes)];
                flow(
                    above,
                    Some(above + 2),
                    &by,
                    mixes * (t_g - kelvin[above + 2]),
                );
            }
        }
        residual[1] += self.air * air.enthalpy(COLD);
        residual[2 * burner + 1] += self.fired * premixed.enthalpy(COLD);
        (rows, residual)
    }
}

/// Solves a banded system by elimination without pivoting.
fn banded(mut rows: Vec<[f64; 2 * BAND + 1]>, mut right: Vec<f64>) -> Vec<f64> {
    let count = right.len();
    for k in 0..count {
        for below in 1..=BAND.min(count - 1 - k) {
            let row = k + below;
            let factor = rows[row][BAND - below] / rows[k][BAND];
            for at in 0..=BAND {
                let value = rows[k][BAND + at];
                rows[row][BAND - below + at] -= factor * value;
            }
            right[row] -= factor * right[k];
        }
    }
    for k in (0..count).rev() {
        let known: f64 = (1..=BAND.min(count - 1 - k))
            .map(|at| rows[k][BAND + at] * right[k + at])
            .sum();
        right[k] = (right[k] - known) / rows[k][BAND];
    }
    right
}
