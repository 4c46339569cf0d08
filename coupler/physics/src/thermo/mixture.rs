//! Mixtures of ideal gases.

use thiserror::Error;

use super::species::{Species, atomic_mass, species, species_names};
use crate::gas::{GAS_CONSTANT, REFERENCE_TEMPERATURE};

/// Species in a mixture at most.
pub const MOST: usize = 16;
/// Newton steps for a temperature at most.
const STEPS: u32 = 60;

/// A mixture of built-in species as an ideal gas; its state is a temperature and mass fractions in the
/// order of the species.
///
/// Density from Dalton's law; enthalpy and heat capacity weighted by mass; viscosity by Wilke 1950,
/// doi 10.1063/1.1747673; conductivity by the same weights (Mason and Saxena 1958,
/// doi 10.1063/1.1724352) from the species' modified Eucken values, κ = μ c_v (1.32 + 1.77 R/c_v)
/// (requirements COR-7).
#[derive(Clone, Debug, PartialEq)]
pub struct Mixture {
    names: Vec<String>,
    species: Vec<Species>,
    /// Molar masses in kg/mol.
    molar_mass: Vec<f64>,
    /// Sensible enthalpies count from here, J/kg.
    reference: Vec<f64>,
    /// (M_j/M_i)^¼ and 1/√(8 (1 + M_i/M_j)), row i.
    wilke: Vec<[f64; 2]>,
}

/// Why a mixture cannot be made.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum MixtureError {
    /// A species that is not built in.
    #[error("the species {name} is not built in; there are {known}")]
    Unknown {
        /// The name.
        name: String,
        /// Names of the built-in species.
        known: String,
    },
    /// A species that stands twice.
    #[error("the species {name} stands twice")]
    Twice {
        /// The name.
        name: String,
    },
    /// No species, or too many.
    #[error("a mixture of {count} species; it needs 1 to {MOST}")]
    Count {
        /// How many.
        count: usize,
    },
}

impl Mixture {
    /// A mixture of built-in species.
    pub fn new<'n>(names: impl IntoIterator<Item = &'n str>) -> Result<Self, MixtureError> {
        let names: Vec<String> = names.into_iter().map(str::to_owned).collect();
        if names.is_empty() || names.len() > MOST {
            return Err(MixtureError::Count { count: names.len() });
        }
        let mut found = Vec::new();
        for (k, name) in names.iter().enumerate() {
            let Some(&(mut one)) = species(name) else {
                let known: Vec<_> = species_names().collect();
                return Err(MixtureError::Unknown {
                    name: name.clone(),
                    known: known.join(", "),
                });
            };
            if names[..k].contains(name) {
                return Err(MixtureError::Twice { name: name.clone() });
            }
            one.thermo = one.thermo.joined();
            found.push(one);
        }
        let molar_mass: Vec<f64> = found.iter().map(Species::molar_mass).collect();
        let reference = found.iter().zip(&molar_mass);
        let reference = reference.map(|(s, m)| s.thermo.enthalpy(REFERENCE_TEMPERATURE) / m);
        let mut wilke = Vec::new();
        for own in &molar_mass {
            for other in &molar_mass {
                wilke.push([
                    (other / own).powf(0.25),
                    1.0 / (8.0 * (1.0 + own / other)).sqrt(),
                ]);
            }
        }
        Ok(Self {
            reference: reference.collect(),
            names,
            species: found,
            molar_mass,
            wilke,
        })
    }

    /// Names of the species.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Mass fractions of mole fractions (or amounts of substance).
    pub fn mass_fractions(&self, mole: &[f64]) -> Vec<f64> {
        let mass: Vec<f64> = mole
            .iter()
            .zip(&self.molar_mass)
            .map(|(x, m)| x * m)
            .collect();
        let total: f64 = mass.iter().sum();
        mass.into_iter().map(|one| one / total).collect()
    }

    /// Each element with its mass in a unit mass of each species.
    pub fn elements(&self) -> Vec<(String, Vec<f64>)> {
        let mut found: Vec<(String, Vec<f64>)> = Vec::new();
        for (k, species) in self.species.iter().enumerate() {
            for &(element, atoms) in species.elements {
                let at = found.iter().position(|(name, _)| name == element);
                let at = at.unwrap_or_else(|| {
                    found.push((element.to_owned(), vec![0.0; self.species.len()]));
                    found.len() - 1
                });
                found[at].1[k] = atoms * atomic_mass(element).unwrap_or(0.0) / self.molar_mass[k];
            }
        }
        found
    }

    /// Amount of substance of a unit mass, 1/M, in mol/kg.
    #[inline]
    fn moles(&self, composition: &[f64]) -> f64 {
        composition
            .iter()
            .zip(&self.molar_mass)
            .map(|(y, m)| y / m)
            .sum()
    }

    /// Density in kg/m³ at a pressure in Pa and a temperature in K.
    #[inline]
    pub fn density(&self, pressure: f64, temperature: f64, composition: &[f64]) -> f64 {
        pressure / (GAS_CONSTANT * self.moles(composition) * temperature)
    }

    /// Specific heat capacity c_p in J/kg/K.
    #[inline]
    pub fn heat_capacity(&self, temperature: f64, composition: &[f64]) -> f64 {
        let one = |k: usize| self.species[k].thermo.heat_capacity(temperature) / self.molar_mass[k];
        composition
            .iter()
            .enumerate()
            .map(|(k, y)| y * one(k))
            .sum()
    }

    /// Sensible enthalpy of a species in J/kg, zero at 298.15 K.
    #[inline]
    pub fn species_enthalpy(&self, k: usize, temperature: f64) -> f64 {
        self.species[k].thermo.enthalpy(temperature) / self.molar_mass[k] - self.reference[k]
    }

    /// Sensible enthalpy in J/kg, zero at 298.15 K.
    #[inline]
    pub fn enthalpy(&self, temperature: f64, composition: &[f64]) -> f64 {
        let each = composition.iter().enumerate();
        each.map(|(k, y)| y * self.species_enthalpy(k, temperature))
            .sum()
    }

    /// Temperature in K of a sensible enthalpy in J/kg, from a guess in K, by Newton's method: c_p is
    /// positive, so that the enthalpy grows with the temperature. Not a number where none is found.
    pub fn temperature(&self, enthalpy: f64, composition: &[f64], guess: f64) -> f64 {
        let mut temperature = guess;
        for _ in 0..STEPS {
            let error = self.enthalpy(temperature, composition) - enthalpy;
            let step = error / self.heat_capacity(temperature, composition);
            temperature -= step;
            if step.abs() <= 4.0 * f64::EPSILON * temperature.abs() {
                return temperature;
            }
        }
        // Newton's last steps may jump between neighbours of the solution.
        let error = self.enthalpy(temperature, composition) - enthalpy;
        let step = error / self.heat_capacity(temperature, composition);
        if step.abs() < 1e-10 * temperature.abs() {
            temperature
        } else {
            f64::NAN
        }
    }

    /// Mole fractions and the species' viscosities.
    #[inline]
    fn parts(&self, temperature: f64, composition: &[f64]) -> ([f64; MOST], [f64; MOST]) {
        let (mut mole, mut viscosity) = ([0.0; MOST], [0.0; MOST]);
        let moles = self.moles(composition);
        for (k, species) in self.species.iter().enumerate() {
            // What linear solvers leave below zero counts as nothing.
            mole[k] = composition[k].max(0.0) / self.molar_mass[k] / moles;
            viscosity[k] = species.viscosity.viscosity(temperature);
        }
        (mole, viscosity)
    }

    /// Σ_i x_i v_i/Σ_j x_j Φ_ij.
    #[inline]
    fn weighted(&self, mole: &[f64; MOST], viscosity: &[f64; MOST], values: &[f64; MOST]) -> f64 {
        let count = self.species.len();
        let mut sum = 0.0;
        for i in 0..count {
            if mole[i] == 0.0 {
                continue;
            }
            let mut crowd = 0.0;
            for j in 0..count {
                let [root, scale] = self.wilke[i * count + j];
                let ratio = 1.0 + (viscosity[i] / viscosity[j]).sqrt() * root;
                crowd += mole[j] * ratio * ratio * scale;
            }
            sum += mole[i] * values[i] / crowd;
        }
        sum
    }

    /// Dynamic viscosity in Pa s.
    pub fn viscosity(&self, temperature: f64, composition: &[f64]) -> f64 {
        let (mole, viscosity) = self.parts(temperature, composition);
        self.weighted(&mole, &viscosity, &viscosity)
    }

    /// Thermal conductivity in W/m/K.
    pub fn conductivity(&self, temperature: f64, composition: &[f64]) -> f64 {
        let (mole, viscosity) = self.parts(temperature, composition);
        let mut conductivity = [0.0; MOST];
        for (k, species) in self.species.iter().enumerate() {
            let gas_constant = GAS_CONSTANT / self.molar_mass[k];
            let isochoric =
                species.thermo.heat_capacity(temperature) / self.molar_mass[k] - gas_constant;
            conductivity[k] = viscosity[k] * isochoric * (1.32 + 1.77 * gas_constant / isochoric);
        }
        self.weighted(&mole, &viscosity, &conductivity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn air() -> (Mixture, Vec<f64>) {
        let air = Mixture::new(["N2", "O2", "Ar"]).unwrap();
        // US Standard Atmosphere 1976, rounded, mole fractions.
        let composition = air.mass_fractions(&[0.7809, 0.2095, 0.0096]);
        (air, composition)
    }

    #[test]
    fn dry_air_has_the_properties_of_the_tables() {
        // Incropera, table A.4: 300 K and 800 K.
        let (air, y) = air();
        assert!((air.density(101_325.0, 300.0, &y) - 1.1770).abs() < 1e-3);
        for (t, heat_capacity, viscosity, conductivity) in [
            (300.0, 1007.0, 184.6e-7, 26.3e-3),
            (800.0, 1099.0, 369.8e-7, 57.3e-3),
        ] {
            assert!((air.heat_capacity(t, &y) / heat_capacity - 1.0).abs() < 3e-3);
            assert!((air.viscosity(t, &y) / viscosity - 1.0).abs() < 0.015);
            let found = air.conductivity(t, &y);
            assert!((found / conductivity - 1.0).abs() < 0.06, "{t}: {found}");
        }
    }

    #[test]
    fn a_pure_species_in_a_mixture_is_that_species() {
        let mixture = Mixture::new(["N2", "CO2", "H2"]).unwrap();
        let alone = Mixture::new(["CO2"]).unwrap();
        let y = [0.0, 1.0, 0.0];
        let both = |f: fn(&Mixture, f64, &[f64]) -> f64| {
            (f(&mixture, 700.0, &y), f(&alone, 700.0, &[1.0]))
        };
        for (found, expected) in [
            both(Mixture::viscosity),
            both(Mixture::conductivity),
            both(Mixture::enthalpy),
            both(Mixture::heat_capacity),
        ] {
            assert!((found / expected - 1.0).abs() < 1e-14, "{found} {expected}");
        }
    }

    #[test]
    fn wilke_s_viscosity_agrees_with_an_independent_evaluation() {
        // In Python: N2 and CO2, mole fractions 0.6 and 0.4, 300 K, from the two pure viscosities.
        let mixture = Mixture::new(["N2", "CO2"]).unwrap();
        let y = mixture.mass_fractions(&[0.6, 0.4]);
        let found = mixture.viscosity(300.0, &y);
        assert!(
            (found / 1.6512048007503728e-05 - 1.0).abs() < 1e-9,
            "{found:e}"
        );
    }

    #[test]
    fn temperature_and_enthalpy_are_inverse_from_any_guess() {
        let (air, y) = air();
        for t in [150.0, 250.0, 298.15, 900.0, 1000.0, 2000.0, 4000.0] {
            for guess in [200.0, 300.0, 3000.0] {
                let found = air.temperature(air.enthalpy(t, &y), &y, guess);
                assert!((found - t).abs() < 1e-9 * t, "{t} from {guess}: {found}");
            }
        }
        assert_eq!(air.enthalpy(298.15, &y), 0.0);
    }

    #[test]
    fn the_elements_of_a_unit_mass_sum_to_one_for_each_species() {
        let mixture = Mixture::new(["CH4", "O2", "CO2", "H2O", "N2"]).unwrap();
        let elements = mixture.elements();
        for k in 0..5 {
            let sum: f64 = elements.iter().map(|(_, mass)| mass[k]).sum();
            assert!((sum - 1.0).abs() < 1e-15, "{k}: {sum}");
        }
        let carbon = &elements.iter().find(|(name, _)| name == "C").unwrap().1;
        assert!((carbon[0] - 12.011 / 16.043).abs() < 1e-12);
        assert_eq!(carbon[1], 0.0);
    }

    #[test]
    fn what_is_no_mixture_is_refused_by_name() {
        let error = Mixture::new(["N2", "Xe"]).unwrap_err().to_string();
        assert!(
            error.starts_with("the species Xe is not built in; there are N2, O2"),
            "{error}"
        );
        let error = Mixture::new(["N2", "N2"]).unwrap_err().to_string();
        assert_eq!(error, "the species N2 stands twice");
        assert!(Mixture::new([]).is_err());
    }
}
