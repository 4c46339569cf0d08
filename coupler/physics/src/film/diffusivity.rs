//! The diffusivities by which gases pass the film about a particle.

use crate::thermo::Mixture;

/// Diffusivity of a gas from one value, D = D₀ (T/T₀)ⁿ p₀/p.
///
/// Kinetic theory of dilute gases has n = 3/2 for hard spheres, and the correlation of Fuller, Schettler and Giddings
/// (doi 10.1021/ie50677a007) 1.75.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceDiffusivity {
    /// D₀ in m²/s.
    pub value: f64,
    /// T₀ in K.
    pub at: f64,
    /// p₀ in Pa.
    pub pressure: f64,
    /// n.
    pub exponent: f64,
}

impl ReferenceDiffusivity {
    /// D in m²/s at a pressure in Pa and a temperature in K.
    pub fn of(&self, pressure: f64, temperature: f64) -> f64 {
        self.value * (temperature / self.at).powf(self.exponent) * self.pressure / pressure
    }
}

/// The state of the gas in a film.
#[derive(Clone, Copy, Debug)]
pub struct FilmState<'a> {
    /// Pressure in Pa.
    pub pressure: f64,
    /// Temperature in K.
    pub temperature: f64,
    /// Density in kg/m³.
    pub density: f64,
    /// Viscosity in Pa s.
    pub viscosity: f64,
    /// Mass fraction of each species.
    pub composition: &'a [f64],
}

/// By which diffusivities D gases pass the film about a particle that reacts.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum FilmDiffusivity {
    /// Mixture-averaged ones, with those of pairs by Fuller, Schettler and Giddings ([`crate::thermo::diffusion`]).
    #[default]
    Fuller,
    /// One of all species, μ/(ρ Sc) with this Schmidt number.
    Schmidt(f64),
    /// One value each, in the order of the species; mixture-averaged where there is none.
    Stated(Vec<Option<ReferenceDiffusivity>>),
}

impl FilmDiffusivity {
    /// Diffusivities in m²/s of all species of a mixture in a film. Allocates nothing.
    pub fn fill(&self, mixture: &Mixture, state: &FilmState<'_>, diffusivities: &mut [f64]) {
        let FilmState {
            pressure,
            temperature,
            ..
        } = *state;
        if let Self::Schmidt(schmidt) = self {
            diffusivities.fill(state.viscosity / (state.density * schmidt));
            return;
        }
        mixture.diffusivities(pressure, temperature, state.composition, diffusivities);
        if let Self::Stated(values) = self {
            for (diffusivity, value) in diffusivities.iter_mut().zip(values) {
                if let Some(value) = value {
                    *diffusivity = value.of(pressure, temperature);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(law: &FilmDiffusivity) -> [f64; 2] {
        let air = Mixture::new(["O2", "N2"]).unwrap();
        let composition = [0.2, 0.8];
        let state = FilmState {
            pressure: 2e5,
            temperature: 500.0,
            density: 1.4,
            viscosity: 2.6e-5,
            composition: &composition,
        };
        let mut found = [0.0; 2];
        law.fill(&air, &state, &mut found);
        found
    }

    #[test]
    fn a_stated_value_follows_temperature_and_pressure() {
        // 1.9e-5 (500/288.15)^1.81 101325/2e5 in Python.
        let value = ReferenceDiffusivity {
            value: 1.9e-5,
            at: 288.15,
            pressure: 101_325.0,
            exponent: 1.81,
        };
        let expected = 2.610_154_508_692_683e-5;
        let found = value.of(2e5, 500.0);
        assert!((found / expected - 1.0).abs() < 1e-13, "{found:e}");
        assert_eq!(value.of(101_325.0, 288.15), 1.9e-5);
    }

    #[test]
    fn one_schmidt_number_is_that_of_every_species() {
        // 2.6e-5/(1.4 · 0.7)
        for found in filled(&FilmDiffusivity::Schmidt(0.7)) {
            assert!((found / 2.653_061_224_489_796e-5 - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn species_without_a_value_are_mixture_averaged() {
        let value = ReferenceDiffusivity {
            value: 3e-5,
            at: 500.0,
            pressure: 1e5,
            exponent: 1.75,
        };
        let found = filled(&FilmDiffusivity::Stated(vec![Some(value), None]));
        assert_eq!(found[0], 1.5e-5);
        // Fuller's formula of O2 and N2 in Python at 500 K and 2 bar.
        assert!(
            (found[1] / 2.577_223_990_083_82e-5 - 1.0).abs() < 1e-9,
            "{:e}",
            found[1]
        );
        assert_eq!(found[1], filled(&FilmDiffusivity::Fuller)[1]);
    }
}
