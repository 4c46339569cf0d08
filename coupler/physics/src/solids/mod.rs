//! Solid species: what particles that react are made of.

mod table;

use calcine_numerics::Lanes;
use thiserror::Error;

use crate::gas::REFERENCE_TEMPERATURE;
use crate::reaction::formula::{self, FormulaError};
use crate::solid::HeatCapacity;
use crate::thermo::Element;
use table::{RECORDS, SolidRecord};

/// A pure solid: what it is made of, its enthalpy and entropy. Volumes of solids do not enter: what a
/// particle's pores and grains do to its size is the particle's matter.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidSpecies {
    name: String,
    atoms: [f64; Element::COUNT],
    molar_mass: f64,
    formation_enthalpy: f64,
    entropy: f64,
    heat_capacity: HeatCapacity,
    /// Enthalpy and entropy of the heat capacity's law at 298.15 K.
    reference: [f64; 2],
    /// True of a liquid, which is gone before it is hotter than its heat capacity is given for.
    liquid: bool,
}

/// A solid that cannot be.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SolidError {
    /// A formula that is none.
    #[error(transparent)]
    Formula(#[from] FormulaError),
    /// No built-in solid has this name.
    #[error("the solid {name} is not built in; there are {known}")]
    Unknown {
        /// The name.
        name: String,
        /// The names there are.
        known: String,
    },
}

impl SolidSpecies {
    /// A solid of a chemical formula with its enthalpy of formation in J/mol and entropy in J/mol/K at
    /// 298.15 K, and its heat capacity in J/kg/K.
    pub fn new(
        name: &str,
        chemical: &str,
        formation_enthalpy: f64,
        entropy: f64,
        heat_capacity: HeatCapacity,
    ) -> Result<Self, SolidError> {
        let atoms = formula::atoms(chemical)?;
        Ok(Self::assemble(
            name,
            atoms,
            formation_enthalpy,
            entropy,
            heat_capacity,
        ))
    }

    /// A material that takes part in no reaction; of no element, 1 kg/mol.
    pub fn inert(name: &str, heat_capacity: HeatCapacity) -> Self {
        let mut made = Self::assemble(name, [0.0; Element::COUNT], 0.0, 0.0, heat_capacity);
        made.molar_mass = 1.0;
        made
    }

    fn assemble(
        name: &str,
        atoms: [f64; Element::COUNT],
        formation_enthalpy: f64,
        entropy: f64,
        heat_capacity: HeatCapacity,
    ) -> Self {
        let weighed = Element::ALL.iter().zip(atoms);
        let reference = [
            heat_capacity.enthalpy(REFERENCE_TEMPERATURE),
            heat_capacity.entropy(REFERENCE_TEMPERATURE),
        ];
        Self {
            name: name.to_owned(),
            atoms,
            molar_mass: weighed.map(|(element, n)| n * element.molar_mass()).sum(),
            formation_enthalpy,
            entropy,
            heat_capacity,
            reference,
            liquid: false,
        }
    }

    fn of(record: &SolidRecord) -> Result<Self, SolidError> {
        let chemical = record.name.trim_end_matches("(l)");
        let atoms = formula::atoms(chemical)?;
        let weighed = Element::ALL.iter().zip(atoms);
        let molar_mass: f64 = weighed.map(|(element, n)| n * element.molar_mass()).sum();
        let points = record.heat_capacity.iter();
        let law = HeatCapacity::table(points.map(|&(t, c)| (t, c / molar_mass)).collect());
        let mut made = Self::assemble(
            record.name,
            atoms,
            record.formation_enthalpy,
            record.entropy,
            law,
        );
        made.liquid = chemical != record.name;
        Ok(made)
    }

    /// Names of the built-in solids.
    pub fn built_in_names() -> impl Iterator<Item = &'static str> {
        RECORDS.iter().map(|record| record.name)
    }

    /// The built-in solid of this name.
    pub fn built_in(name: &str) -> Result<Self, SolidError> {
        let record = RECORDS.iter().find(|record| record.name == name);
        record.map_or_else(
            || {
                Err(SolidError::Unknown {
                    name: name.to_owned(),
                    known: Self::built_in_names().collect::<Vec<_>>().join(", "),
                })
            },
            Self::of,
        )
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Atoms in a formula unit, in the order of [`Element::ALL`].
    pub fn atoms(&self) -> &[f64; Element::COUNT] {
        &self.atoms
    }

    /// Molar mass in kg/mol.
    pub fn molar_mass(&self) -> f64 {
        self.molar_mass
    }

    /// Enthalpy of formation at 298.15 K in J/mol.
    pub fn formation_enthalpy(&self) -> f64 {
        self.formation_enthalpy
    }

    /// Lowest and highest temperature in K for which its heat capacity is given.
    pub fn range(&self) -> (f64, f64) {
        let (low, high) = self.heat_capacity.range();
        (low, if self.liquid { f64::INFINITY } else { high })
    }

    /// Specific heat capacity in J/kg/K.
    pub fn heat_capacity(&self, temperature: f64) -> f64 {
        self.heat_capacity.at(temperature)
    }

    /// Derivative of the specific heat capacity in J/kg/K².
    pub fn heat_capacity_slope(&self, temperature: f64) -> f64 {
        self.heat_capacity.slope(temperature)
    }

    /// Sensible enthalpy in J/kg, zero at 298.15 K.
    pub fn enthalpy(&self, temperature: f64) -> f64 {
        self.heat_capacity.enthalpy(temperature) - self.reference[0]
    }

    /// Molar heat capacity in J/mol/K and enthalpy with that of formation in J/mol, at temperatures in K side by side.
    #[inline(always)]
    pub fn molar_lanes<const N: usize>(&self, temperature: Lanes<N>) -> [Lanes<N>; 2] {
        let [capacity, enthalpy] = self.heat_capacity.lanes(temperature);
        let sensible = (enthalpy - self.reference[0]) * self.molar_mass;
        [
            capacity * self.molar_mass,
            sensible + self.formation_enthalpy,
        ]
    }

    /// Molar Gibbs energy in J/mol.
    pub fn gibbs_energy(&self, temperature: f64) -> f64 {
        let rise = self.heat_capacity.entropy(temperature) - self.reference[1];
        self.formation_enthalpy + self.molar_mass * self.enthalpy(temperature)
            - temperature * (self.entropy + self.molar_mass * rise)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gas::GAS_CONSTANT;
    use crate::thermo::Species;

    fn solid(name: &str) -> SolidSpecies {
        SolidSpecies::built_in(name).unwrap()
    }

    /// K of a reaction of solids and gases with their coefficients, products positive.
    fn constant(temperature: f64, solids: &[(&str, f64)], gases: &[(&str, f64)]) -> f64 {
        let solids = solids
            .iter()
            .map(|(s, n)| n * solid(s).gibbs_energy(temperature));
        let gases = gases.iter().map(|(g, n)| {
            let gas = Species::built_in(g).unwrap();
            n * gas.polynomial().gibbs_energy(temperature)
        });
        let change: f64 = solids.chain(gases).sum();
        (-change / (GAS_CONSTANT * temperature)).exp()
    }

    #[test]
    fn heat_contents_are_those_of_the_polynomials_they_were_drawn_from() {
        // H(T) − H(298.15 K) in J/mol of the polynomials (iron with its transitions), in Python.
        for (name, t, expected) in [
            ("C", 2500.0, 48_297.0),
            ("CaCO3", 1200.0, 101_892.3),
            ("CaO", 2000.0, 91_448.9),
            ("FeO", 1650.0, 79_070.6),
            ("Fe0.947O", 1650.0, 76_198.8),
            ("Fe2O3", 1700.0, 200_925.2),
            ("Fe3O4", 1800.0, 307_283.3),
            ("Al2O3", 2300.0, 251_010.4),
            ("Fe", 1400.0, 42_274.9),
            ("Fe", 1042.0, 26_982.8),
        ] {
            let one = solid(name);
            let rise = one.molar_mass() * one.enthalpy(t);
            assert!((rise / expected - 1.0).abs() < 1.5e-3, "{name}: {rise}");
        }
    }

    #[test]
    fn limestone_decomposes_at_one_bar_near_894_degrees() {
        // Measured: 1168 K (Stern and Weise, NSRDS-NBS 30, 1969, within a few K).
        let pressure = |t| constant(t, &[("CaO", 1.0), ("CaCO3", -1.0)], &[("CO2", 1.0)]);
        assert!(pressure(1160.0) < 1.0 && pressure(1176.0) > 1.0);
    }

    #[test]
    fn wustite_and_iron_have_their_equilibrium_where_it_was_measured() {
        // 900 degrees: 68 % CO in CO and CO2 (Darken and Gurry, J. Am. Chem. Soc. 67 (1945) 1398,
        // doi 10.1021/ja01224a050), so K = 0.47.
        let solids = [("Fe", 0.947), ("Fe0.947O", -1.0)];
        let k = constant(1173.15, &solids, &[("CO2", 1.0), ("CO", -1.0)]);
        assert!((k - 0.47).abs() < 0.03, "{k}");
    }

    #[test]
    fn water_evaporates_with_the_heat_of_steam_tables() {
        // IAPWS-IF97: 2441.7 kJ/kg at 25 °C, 2256.4 at 100 °C; vapour as an ideal gas takes 0.1 and 0.6 % more.
        let (water, vapour) = (solid("H2O(l)"), Species::built_in("H2O").unwrap());
        for (kelvin, expected, within) in [(298.15, 2441.7e3, 2e-3), (373.15, 2256.4e3, 7e-3)] {
            let formed = water.formation_enthalpy() / water.molar_mass();
            let found = vapour.formation_enthalpy() - formed + vapour.enthalpy(kelvin)
                - water.enthalpy(kelvin);
            assert!((found / expected - 1.0).abs() < within, "{kelvin}: {found}");
        }
        // Its vapour pressure by Gibbs' energies: 1 bar at 99.6 °C.
        let pressure = constant(372.75, &[("H2O(l)", -1.0)], &[("H2O", 1.0)]);
        assert!((pressure - 1.0).abs() < 0.02, "{pressure}");
    }

    #[test]
    fn rust_burns_with_the_heat_of_its_formation() {
        let heat = solid("Fe2O3").formation_enthalpy();
        assert!((heat + 825.5e3).abs() < 1e3);
        assert!(SolidSpecies::built_in("FeS2").is_err());
    }
}
