//! Mixtures of ideal gases.

use calcine_numerics::Lanes;

use super::diffusion::MixtureAveraged;
use super::wilke::Wilke;
use super::{Element, Species, ThermoError, eucken, inverse};
use crate::gas::GAS_CONSTANT;

/// Most species of a mixture: what the transport properties need for each lies on the stack.
pub const MOST_SPECIES: usize = 32;
/// Bounds in K of the temperature of an enthalpy. They are wider than the polynomials' range: a solver may
/// pass it on its way, and c_p stays what it is beyond.
const BOUNDS: (f64, f64) = (1.0, 2e4);

/// A mixture of ideal gases. A composition is the mass fractions Y in the order of its species.
///
/// 1/M = Σ Y_i/M_i;  ρ = p M/(R T);  c_p = Σ Y_i c_p,i;  h = Σ Y_i h_i;  viscosity and conductivity by
/// [`super::wilke`], diffusivities by [`super::diffusion`].
///
/// The mass fractions are taken as they are: those of a solver sum to one but for round-off, and the
/// sums above are linear in them. Nothing that is asked in a cell allocates.
#[derive(Clone, Debug, PartialEq)]
pub struct Mixture {
    species: Vec<Species>,
    names: Vec<String>,
    /// 1/M_i in mol/kg.
    moles: Vec<f64>,
    interaction: Wilke,
    diffusion: MixtureAveraged,
    range: (f64, f64),
}

/// Viscosity and conductivity of a gas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransportProperties {
    /// Dynamic viscosity in Pa s.
    pub viscosity: f64,
    /// Thermal conductivity in W/m/K.
    pub conductivity: f64,
}

impl Mixture {
    /// A mixture of built-in species.
    pub fn new<'n>(names: impl IntoIterator<Item = &'n str>) -> Result<Self, ThermoError> {
        let species = names.into_iter().map(Species::built_in);
        Self::of(species.collect::<Result<_, _>>()?)
    }

    /// A mixture of these species.
    pub fn of(species: Vec<Species>) -> Result<Self, ThermoError> {
        if species.is_empty() || species.len() > MOST_SPECIES {
            return Err(ThermoError::Count {
                count: species.len(),
                most: MOST_SPECIES,
            });
        }
        for (k, one) in species.iter().enumerate() {
            if species[..k].iter().any(|other| other.name() == one.name()) {
                return Err(ThermoError::RepeatedSpecies {
                    name: one.name().to_owned(),
                });
            }
        }
        let ranges = || species.iter().map(|one| one.polynomial().range());
        let lowest = ranges().map(|range| range.0).fold(0.0, f64::max);
        let highest = ranges().map(|range| range.1).fold(f64::INFINITY, f64::min);
        if lowest >= highest {
            return Err(ThermoError::NoCommonRange { lowest, highest });
        }
        let molar_masses: Vec<f64> = species.iter().map(Species::molar_mass).collect();
        Ok(Self {
            names: species.iter().map(|one| one.name().to_owned()).collect(),
            moles: molar_masses.iter().map(|mass| 1.0 / mass).collect(),
            interaction: Wilke::new(&molar_masses),
            diffusion: MixtureAveraged::new(&species),
            range: (lowest, highest),
            species,
        })
    }

    /// Dry air of N2, O2 and Ar, with its mass fractions. Mole fractions 0.78084, 0.209476 and 0.00934
    /// (US Standard Atmosphere 1976, table 3), brought to a sum of one for what is left out.
    ///
    /// [`crate::gas::GasProperties::air`] is the same as one gas of constant heat capacity.
    pub fn air() -> Result<(Self, [f64; 3]), ThermoError> {
        let air = Self::new(["N2", "O2", "Ar"])?;
        let mut composition = [0.78084, 0.209476, 0.00934];
        air.weigh_amounts(&mut composition);
        Ok((air, composition))
    }

    /// Its species.
    pub fn species(&self) -> &[Species] {
        &self.species
    }

    /// Names of its species.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Lowest and highest temperature in K at which all its polynomials hold.
    pub fn range(&self) -> (f64, f64) {
        self.range
    }

    /// Σ Y_i f_i.
    fn sum(&self, composition: &[f64], of: impl Fn(&Species) -> f64) -> f64 {
        debug_assert_eq!(composition.len(), self.species.len());
        let parts = self.species.iter().zip(composition);
        parts.map(|(species, y)| y * of(species)).sum()
    }

    /// Molar mass in kg/mol.
    #[inline]
    pub fn molar_mass(&self, composition: &[f64]) -> f64 {
        let moles = self.moles.iter().zip(composition);
        1.0 / moles.map(|(n, y)| n * y).sum::<f64>()
    }

    /// Specific gas constant R/M in J/kg/K.
    pub fn specific_gas_constant(&self, composition: &[f64]) -> f64 {
        GAS_CONSTANT / self.molar_mass(composition)
    }

    /// Density in kg/m³ at a pressure in Pa and a temperature in K.
    #[inline]
    pub fn density(&self, pressure: f64, temperature: f64, composition: &[f64]) -> f64 {
        pressure * self.molar_mass(composition) / (GAS_CONSTANT * temperature)
    }

    /// Specific heat capacity c_p in J/kg/K.
    #[inline]
    pub fn heat_capacity(&self, temperature: f64, composition: &[f64]) -> f64 {
        self.sum(composition, |one| one.heat_capacity(temperature))
    }

    /// dc_p/dT at constant composition in J/kg/K².
    pub fn heat_capacity_slope(&self, temperature: f64, composition: &[f64]) -> f64 {
        self.sum(composition, |one| {
            one.polynomial().heat_capacity_slope(temperature) / one.molar_mass()
        })
    }

    /// Sensible enthalpy in J/kg, zero at 298.15 K.
    #[inline]
    pub fn enthalpy(&self, temperature: f64, composition: &[f64]) -> f64 {
        self.sum(composition, |one| one.enthalpy(temperature))
    }

    /// Enthalpy of formation at 298.15 K in J/kg.
    pub fn formation_enthalpy(&self, composition: &[f64]) -> f64 {
        self.sum(composition, Species::formation_enthalpy)
    }

    /// Sensible enthalpy of a species in J/kg, zero at 298.15 K.
    #[inline]
    pub fn species_enthalpy(&self, species: usize, temperature: f64) -> f64 {
        self.species[species].enthalpy(temperature)
    }

    /// Temperature in K of a sensible enthalpy in J/kg; `guess` in K is near it. It may lie beyond the
    /// polynomials' range, where c_p stays what it is at its end.
    pub fn temperature(
        &self,
        enthalpy: f64,
        composition: &[f64],
        guess: f64,
    ) -> Result<f64, ThermoError> {
        inverse::temperature(enthalpy, "J/kg", BOUNDS, guess, |t| {
            (
                self.enthalpy(t, composition),
                self.heat_capacity(t, composition),
            )
        })
    }

    /// Mole fractions of a composition.
    pub fn mole_fractions(&self, composition: &[f64], mole_fractions: &mut [f64]) {
        let molar_mass = self.molar_mass(composition);
        for ((x, y), n) in mole_fractions.iter_mut().zip(composition).zip(&self.moles) {
            *x = y * n * molar_mass;
        }
    }

    /// Composition of amounts of substance in any unit, mole fractions among them.
    pub fn mass_fractions(&self, amounts: &[f64]) -> Vec<f64> {
        let mut composition = amounts.to_vec();
        self.weigh_amounts(&mut composition);
        composition
    }

    /// Makes mass fractions of amounts of substance in place.
    fn weigh_amounts(&self, amounts: &mut [f64]) {
        for (amount, one) in amounts.iter_mut().zip(&self.species) {
            *amount *= one.molar_mass();
        }
        let total: f64 = amounts.iter().sum();
        amounts.iter_mut().for_each(|y| *y /= total);
    }

    /// Each element that is there with its mass in a unit mass of each species.
    pub fn elements(&self) -> Vec<(String, Vec<f64>)> {
        let share = |element: Element| {
            let parts = self.species.iter().zip(&self.moles);
            parts
                .map(|(one, n)| one.atoms()[element as usize] * element.molar_mass() * n)
                .collect::<Vec<_>>()
        };
        Element::ALL
            .into_iter()
            .map(|element| (element.symbol().to_owned(), share(element)))
            .filter(|(_, shares)| shares.iter().any(|share| *share > 0.0))
            .collect()
    }

    /// Mass fractions of the elements, in the order of [`Element::ALL`].
    pub fn element_fractions(&self, composition: &[f64]) -> [f64; Element::COUNT] {
        let mut fractions = [0.0; Element::COUNT];
        for ((one, y), n) in self.species.iter().zip(composition).zip(&self.moles) {
            for (k, atoms) in one.atoms().iter().enumerate() {
                fractions[k] += y * n * atoms * Element::ALL[k].molar_mass();
            }
        }
        fractions
    }

    /// Dynamic viscosity in Pa s.
    pub fn viscosity(&self, temperature: f64, composition: &[f64]) -> f64 {
        let (weights, viscosities) = self.weigh(temperature, composition);
        self.sum_of(&weights, |k| viscosities[k])
    }

    /// Dynamic viscosities in Pa s side by side, of gases in amounts of any scale, eight at most.
    #[inline(always)]
    pub fn viscosity_lanes<const N: usize>(
        &self,
        temperature: Lanes<N>,
        amounts: &[Lanes<N>],
    ) -> Lanes<N> {
        let (mut values, mut roots) = ([Lanes::default(); 8], [Lanes::default(); 8]);
        for (k, one) in self.species.iter().enumerate().take(amounts.len()) {
            values[k] = one.sutherland().lanes(temperature);
            roots[k] = values[k].sqrt();
        }
        self.interaction.lanes(amounts, (&values, &roots))
    }

    /// Thermal conductivity in W/m/K.
    pub fn conductivity(&self, temperature: f64, composition: &[f64]) -> f64 {
        self.transport(temperature, composition).conductivity
    }

    /// Viscosity and conductivity at once, for the price of one.
    pub fn transport(&self, temperature: f64, composition: &[f64]) -> TransportProperties {
        let (weights, viscosities) = self.weigh(temperature, composition);
        let conductivity = |k: usize| {
            let one = &self.species[k];
            let heat_capacity = one.heat_capacity(temperature);
            eucken::conductivity(viscosities[k], heat_capacity, one.specific_gas_constant())
        };
        TransportProperties {
            viscosity: self.sum_of(&weights, |k| viscosities[k]),
            conductivity: self.sum_of(&weights, conductivity),
        }
    }

    /// Wilke's weights and the species' viscosities.
    fn weigh(
        &self,
        temperature: f64,
        composition: &[f64],
    ) -> ([f64; MOST_SPECIES], [f64; MOST_SPECIES]) {
        let count = self.species.len();
        let mut amounts = [0.0; MOST_SPECIES];
        let mut viscosities = [0.0; MOST_SPECIES];
        let mut roots = [0.0; MOST_SPECIES];
        for (k, one) in self.species.iter().enumerate() {
            amounts[k] = composition[k] * self.moles[k];
            viscosities[k] = one.viscosity(temperature);
            roots[k] = viscosities[k].sqrt();
        }
        let mut weights = [0.0; MOST_SPECIES];
        let (amounts, roots) = (&amounts[..count], &roots[..count]);
        self.interaction
            .weights(amounts, roots, &mut weights[..count]);
        (weights, viscosities)
    }

    /// Σ w_k f_k over the species that are there.
    fn sum_of(&self, weights: &[f64; MOST_SPECIES], of: impl Fn(usize) -> f64) -> f64 {
        (0..self.species.len())
            .filter(|k| weights[*k] != 0.0)
            .map(|k| weights[k] * of(k))
            .sum()
    }

    /// Diffusivity in m²/s of a pair of species.
    pub fn pair_diffusivity(&self, pair: (usize, usize), pressure: f64, temperature: f64) -> f64 {
        self.diffusion.pair(pair.0, pair.1, pressure, temperature)
    }

    /// Mixture-averaged diffusivities in m²/s such that j_i = −ρ D_i ∇Y_i.
    pub fn diffusivities(
        &self,
        pressure: f64,
        temperature: f64,
        composition: &[f64],
        diffusivities: &mut [f64],
    ) {
        let mut moles = [0.0; MOST_SPECIES];
        let moles = &mut moles[..self.species.len()];
        self.mole_fractions(composition, moles);
        self.diffusion
            .diffusivities(pressure, temperature, moles, composition, diffusivities);
    }
}

#[cfg(test)]
mod tests;
