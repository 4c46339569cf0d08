//! The film of gas about a particle that reacts (docs/theory.md, RXN-3).

use calcine_numerics::Number;
use calcine_physics::film::{FilmCoefficient, FilmTheory, StefanFlow, bernoulli};

use super::size::SizeChange;

/// The surroundings of one particle, fixed over a window.
#[derive(Clone, Copy, Debug)]
pub struct ParticleSurroundings<'a> {
    /// Temperature of the gas in K.
    pub temperature: f64,
    /// Its pressure in Pa.
    pub pressure: f64,
    /// Mole fractions.
    pub fractions: &'a [f64],
    /// Mass transfer coefficient of each species in m/s over the temperature of the film, about a particle of the radius.
    pub film: &'a [FilmCoefficient],
    /// How transfer through the film is computed.
    pub theory: FilmTheory,
    /// Radius of the particle in m at the start, which stays where its diameter does.
    pub radius: f64,
    /// How it takes up room.
    pub size: &'a SizeChange,
}

/// The net flow through a film, as the transfer of each gas depends on it.
#[derive(Clone, Copy, Debug)]
pub struct FilmFlow<N> {
    /// Velocity of the net flow towards the particle in m/s ([`StefanFlow`]).
    pub velocity: N,
    /// Molar mass of the gas beyond the film over that at the surface; one where flows are of moles.
    pub lightening: N,
}

impl<N: Number> FilmFlow<N> {
    /// None.
    pub fn still() -> Self {
        Self {
            velocity: N::constant(0.0),
            lightening: N::constant(1.0),
        }
    }
}

/// How a gas passes a film, over concentrations at the temperature of the particle: A k (g c_gas − c_surface) in mol/s.
#[derive(Clone, Copy, Debug)]
pub struct FilmPassage<N> {
    /// k in m/s.
    pub coefficient: N,
    /// g.
    pub gain: N,
}

impl ParticleSurroundings<'_> {
    /// How much smaller than at the start a particle of a radius in m is; one where its diameter stays.
    pub fn shrinkage<N: Number>(&self, radius: N) -> Option<N> {
        let changes = self.size.volumes().is_some() && self.radius > 0.0;
        changes.then(|| radius.times(1.0 / self.radius))
    }

    /// Temperature in K of the film of a particle of a temperature in K.
    pub(super) fn film_temperature<N: Number>(&self, temperature: N) -> N {
        self.theory.temperature.of(temperature, self.temperature)
    }

    /// β of a species in m/s in a film of a temperature in K about a particle of a radius in m. The Sherwood number is that
    /// of the start of the window.
    pub(super) fn coefficient<N: Number>(&self, species: usize, radius: N, film: N) -> N {
        let coefficient = self.film[species].of(film);
        match self.shrinkage(radius) {
            Some(shrinkage) => coefficient / shrinkage,
            None => coefficient,
        }
    }

    /// How a species passes the film of a particle of a radius in m and a temperature in K. What passes is
    /// (p/R T_film) [β⁺ X_gas − β⁻ m X_surface], m the molar mass of the gas over that at the surface: both ends in the gas
    /// of the film, whose coefficients they are.
    pub(super) fn passage<N: Number>(
        &self,
        species: usize,
        radius: N,
        temperature: N,
        flow: FilmFlow<N>,
    ) -> FilmPassage<N> {
        let film = self.film_temperature(temperature);
        let coefficient = self.coefficient(species, radius, film);
        let warmer = temperature / film;
        if self.theory.stefan_flow == StefanFlow::None || coefficient.value() <= 0.0 {
            return FilmPassage {
                coefficient: coefficient * warmer,
                gain: N::constant(1.0),
            };
        }
        let flow_number = flow.velocity / coefficient;
        FilmPassage {
            coefficient: coefficient * bernoulli(flow_number) * flow.lightening * warmer,
            gain: flow_number.exp() / flow.lightening,
        }
    }
}
