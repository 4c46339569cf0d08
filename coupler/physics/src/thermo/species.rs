//! Species of a gas.

use super::table::{RECORDS, SpeciesRecord};
use super::{Element, LennardJones, Nasa7, Sutherland, ThermoError, eucken};
use crate::gas::{GAS_CONSTANT, REFERENCE_TEMPERATURE};

/// A species of an ideal gas: what it is made of and its properties.
///
/// Built in are N2, O2, Ar, CO2, H2O, CO, H2 and CH4; the figures and their sources are in the table of
/// this module's source. The conductivity is [`eucken`]'s of the viscosity.
#[derive(Clone, Debug, PartialEq)]
pub struct Species {
    name: String,
    atoms: [f64; Element::COUNT],
    polynomial: Nasa7,
    viscosity: Sutherland,
    diffusion_volume: f64,
    molar_mass: f64,
    reference_enthalpy: f64,
}

impl Species {
    /// A species of so many atoms of each element, in the order of [`Element::ALL`]; the diffusion
    /// volume is that of [`super::fuller`].
    pub fn new(
        name: &str,
        atoms: [f64; Element::COUNT],
        polynomial: Nasa7,
        viscosity: Sutherland,
        diffusion_volume: f64,
    ) -> Result<Self, ThermoError> {
        let species = Self::assemble(name, atoms, polynomial, viscosity, diffusion_volume);
        let some_atom = atoms.iter().all(|n| *n >= 0.0 && n.is_finite());
        let molar_mass = if some_atom {
            species.molar_mass
        } else {
            f64::NAN
        };
        for (quantity, value) in [
            ("the molar mass in kg/mol", molar_mass),
            (
                "Sutherland's coefficient in kg/m/s/K^0.5",
                viscosity.coefficient,
            ),
            ("Sutherland's temperature in K", viscosity.temperature),
            ("the diffusion volume", diffusion_volume),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ThermoError::NotPositive {
                    species: name.to_owned(),
                    quantity,
                    value,
                });
            }
        }
        Ok(species)
    }

    /// A species whose viscosity follows from how its molecules meet: by Sutherland's law nearest to
    /// [`LennardJones`]'s viscosity, as the built-in ones.
    pub fn of_molecules(
        name: &str,
        atoms: [f64; Element::COUNT],
        polynomial: Nasa7,
        potential: LennardJones,
        diffusion_volume: f64,
    ) -> Result<Self, ThermoError> {
        let weighed = Element::ALL.iter().zip(atoms);
        let molar_mass: f64 = weighed.map(|(element, n)| n * element.molar_mass()).sum();
        let viscosity = potential.sutherland(molar_mass);
        Self::new(name, atoms, polynomial, viscosity, diffusion_volume)
    }

    fn assemble(
        name: &str,
        atoms: [f64; Element::COUNT],
        polynomial: Nasa7,
        viscosity: Sutherland,
        diffusion_volume: f64,
    ) -> Self {
        let polynomial = polynomial.joined();
        let weighed = Element::ALL.iter().zip(atoms);
        let molar_mass = weighed.map(|(element, n)| n * element.molar_mass()).sum();
        Self {
            name: name.to_owned(),
            atoms,
            polynomial,
            viscosity,
            diffusion_volume,
            molar_mass,
            reference_enthalpy: polynomial.enthalpy(REFERENCE_TEMPERATURE),
        }
    }

    fn of(record: &SpeciesRecord) -> Self {
        let mut atoms = [0.0; Element::COUNT];
        for (element, count) in record.atoms {
            atoms[*element as usize] = *count;
        }
        let SpeciesRecord {
            name,
            polynomial,
            viscosity,
            diffusion_volume,
            ..
        } = *record;
        Self::assemble(name, atoms, polynomial, viscosity, diffusion_volume)
    }

    /// Names of the built-in species.
    pub fn built_in_names() -> impl Iterator<Item = &'static str> {
        RECORDS.iter().map(|record| record.name)
    }

    /// The built-in species of this name.
    pub fn built_in(name: &str) -> Result<Self, ThermoError> {
        let record = RECORDS.iter().find(|record| record.name == name);
        record
            .map(Self::of)
            .ok_or_else(|| ThermoError::UnknownSpecies {
                name: name.to_owned(),
                known: Self::built_in_names().collect::<Vec<_>>().join(", "),
            })
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Atoms in a molecule, in the order of [`Element::ALL`].
    pub fn atoms(&self) -> &[f64; Element::COUNT] {
        &self.atoms
    }

    /// Its polynomial, molar.
    pub fn polynomial(&self) -> &Nasa7 {
        &self.polynomial
    }

    /// Its law of viscosity.
    pub fn sutherland(&self) -> &Sutherland {
        &self.viscosity
    }

    /// Its diffusion volume as [`super::fuller`] takes it.
    pub fn diffusion_volume(&self) -> f64 {
        self.diffusion_volume
    }

    /// Molar mass in kg/mol.
    pub fn molar_mass(&self) -> f64 {
        self.molar_mass
    }

    /// Specific gas constant R/M in J/kg/K.
    pub fn specific_gas_constant(&self) -> f64 {
        GAS_CONSTANT / self.molar_mass
    }

    /// Specific heat capacity c_p in J/kg/K.
    pub fn heat_capacity(&self, temperature: f64) -> f64 {
        self.polynomial.heat_capacity(temperature) / self.molar_mass
    }

    /// Sensible enthalpy in J/kg, zero at 298.15 K.
    pub fn enthalpy(&self, temperature: f64) -> f64 {
        (self.polynomial.enthalpy(temperature) - self.reference_enthalpy) / self.molar_mass
    }

    /// Enthalpy of formation at 298.15 K in J/kg.
    pub fn formation_enthalpy(&self) -> f64 {
        self.reference_enthalpy / self.molar_mass
    }

    /// Dynamic viscosity in Pa s.
    pub fn viscosity(&self, temperature: f64) -> f64 {
        self.viscosity.viscosity(temperature)
    }

    /// Thermal conductivity in W/m/K.
    pub fn conductivity(&self, temperature: f64) -> f64 {
        let heat_capacity = self.heat_capacity(temperature);
        let viscosity = self.viscosity(temperature);
        eucken::conductivity(viscosity, heat_capacity, self.specific_gas_constant())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn species(name: &str) -> Species {
        Species::built_in(name).unwrap()
    }

    #[test]
    fn heat_capacities_are_those_of_cor_8() {
        // J/kg/K, of another set of polynomials; the reference's molar masses have fewer digits.
        for (name, at_300, at_800) in [
            ("N2", 1039.69, 1121.91),
            ("CO2", 845.67, 1168.61),
            ("H2O", 1864.89, 2150.01),
        ] {
            for (t, expected) in [(300.0, at_300), (800.0, at_800)] {
                let c_p = species(name).heat_capacity(t);
                assert!((c_p / expected - 1.0).abs() < 5e-5, "{name} {t}: {c_p}");
            }
        }
    }

    #[test]
    fn formation_enthalpies_and_entropies_are_codata_s() {
        // Cox, Wagman and Medvedev, CODATA Key Values for Thermodynamics (1989), 298.15 K and 1 bar:
        // kJ/mol and J/mol/K. CH4, which is not among them: NIST-JANAF (1998).
        for (name, enthalpy, entropy) in [
            ("N2", 0.0, 191.609),
            ("O2", 0.0, 205.152),
            ("CO2", -393.51, 213.785),
            ("H2O", -241.826, 188.835),
            ("CO", -110.53, 197.660),
            ("H2", 0.0, 130.680),
            ("CH4", -74.873, 186.251),
            ("Ar", 0.0, 154.846),
        ] {
            let gas = species(name);
            let molar = gas.formation_enthalpy() * gas.molar_mass() / 1e3;
            let s = gas.polynomial().entropy(REFERENCE_TEMPERATURE);
            let (of_h, of_s) = if name == "CH4" {
                (0.3, 0.15)
            } else {
                (0.005, 0.01)
            };
            assert!((molar - enthalpy).abs() < of_h, "{name}: {molar} kJ/mol");
            assert!((s - entropy).abs() < of_s, "{name}: {s} J/mol/K");
        }
    }

    #[test]
    fn the_water_gas_shift_has_its_equilibrium_where_the_tables_have_it() {
        // NIST-JANAF at 1000 K, log10 K_f: CO2 20.680, CO 10.459, H2O 10.062, so 0.159.
        let g = |name| species(name).polynomial().gibbs_energy(1000.0);
        let change = g("CO2") + g("H2") - g("CO") - g("H2O");
        let log_k = -change / (GAS_CONSTANT * 1000.0) / std::f64::consts::LN_10;
        assert!((log_k - 0.159).abs() < 0.005, "{log_k}");
    }

    #[test]
    fn viscosities_are_those_of_the_handbook_within_2_5_percent() {
        // CRC Handbook of Chemistry and Physics, "Viscosity of gases", µPa s at 300 (H2O: 400) and 600 K.
        for (name, cold, at_cold, at_600) in [
            ("N2", 300.0, 17.9, 29.6),
            ("O2", 300.0, 20.7, 34.7),
            ("CO2", 300.0, 15.0, 28.0),
            ("H2O", 400.0, 13.4, 21.4),
            ("CO", 300.0, 17.8, 29.1),
            ("H2", 300.0, 8.9, 14.5),
            ("CH4", 300.0, 11.1, 19.4),
            ("Ar", 300.0, 22.7, 38.8),
        ] {
            for (t, expected) in [(cold, at_cold), (600.0, at_600)] {
                let mu = 1e6 * species(name).viscosity(t);
                assert!((mu / expected - 1.0).abs() < 0.025, "{name} {t}: {mu}");
            }
        }
    }

    #[test]
    fn conductivities_agree_with_an_independent_evaluation() {
        // In Python, with c_v (1.32 + 1.77 R/c_v).
        for (name, t, expected) in [
            ("N2", 300.0, 0.026883845512589634),
            ("CO2", 600.0, 0.041981117017847853),
            ("H2", 1000.0, 0.42568550322498083),
            ("Ar", 1000.0, 0.04346225353964489),
        ] {
            let kappa = species(name).conductivity(t);
            assert!(
                (kappa / expected - 1.0).abs() < 1e-12,
                "{name} {t}: {kappa}"
            );
        }
    }

    #[test]
    fn conductivities_are_those_of_the_handbook_within_8_percent_but_for_water_vapour() {
        // CRC Handbook of Chemistry and Physics, "Thermal conductivity of gases", mW/m/K.
        for (name, t, measured) in [
            ("N2", 300.0, 26.0),
            ("N2", 600.0, 44.0),
            ("O2", 300.0, 26.3),
            ("O2", 600.0, 48.1),
            ("CO2", 300.0, 16.8),
            ("CO2", 600.0, 41.6),
            ("CO", 300.0, 25.0),
            ("CO", 600.0, 45.7),
            ("H2", 300.0, 186.9),
            ("H2", 400.0, 230.4),
            ("CH4", 300.0, 34.1),
            ("CH4", 600.0, 84.1),
            ("Ar", 300.0, 17.9),
            ("Ar", 600.0, 30.6),
        ] {
            let ratio = 1e3 * species(name).conductivity(t) / measured;
            assert!((ratio - 1.0).abs() < 0.08, "{name} {t}: {ratio}");
        }
        let water = 1e3 * species("H2O").conductivity(600.0) / 47.1;
        assert!((water - 1.31).abs() < 0.01, "{water}");
    }

    #[test]
    fn an_unknown_species_is_refused_with_those_that_are_known() {
        let message = Species::built_in("O3").unwrap_err().to_string();
        assert!(
            message.contains("O3 is not built in; there are N2, O2, Ar, CO2, H2O, CO, H2, CH4"),
            "{message}"
        );
    }

    #[test]
    fn a_species_without_mass_or_with_a_negative_property_is_refused() {
        let n2 = species("N2");
        let with = |atoms, coefficient, volume| {
            let viscosity = Sutherland {
                coefficient,
                temperature: 100.0,
            };
            Species::new("X", atoms, *n2.polynomial(), viscosity, volume)
        };
        assert!(with(*n2.atoms(), 1e-6, 18.5).is_ok());
        assert!(with([0.0; Element::COUNT], 1e-6, 18.5).is_err());
        let mut negative = *n2.atoms();
        negative[0] = -1.0;
        assert!(with(negative, 1e-6, 18.5).is_err());
        assert!(with(*n2.atoms(), -1e-6, 18.5).is_err());
        let message = with(*n2.atoms(), 1e-6, f64::NAN).unwrap_err().to_string();
        assert!(
            message.contains("the diffusion volume of the species X is NaN"),
            "{message}"
        );
    }
}
