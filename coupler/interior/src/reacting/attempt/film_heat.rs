//! Heat through a film that gases pass (docs/theory.md, RXN-3).

use calcine_numerics::Dual;
use calcine_physics::film::{StefanFlow, bernoulli};

use crate::reacting::chemistry::SolidChemistry;
use crate::reacting::passage::ParticleSurroundings;

/// What exchanged gases do to the heat that the film of a particle conducts. With a and b the heat capacities in W/K of the
/// flows that reactions use and make, the energy that passes the film leaves the gas at its own temperature and
/// reaches a surface at T_p as
///
/// Q = (T_gas − T_p) [h A φ/(e^φ − 1) − a],   φ = (b − a)/(h A),
///
/// beside what is used, at the temperature of the gas, and what is made, at that of the particle.
///
/// Source: Ackermann, VDI-Forschungsheft 382 (1937); Bird, Stewart and Lightfoot, Transport Phenomena, 2nd ed. (2002),
/// section 22.8.
#[derive(Clone, Debug, Default)]
pub(super) struct FilmHeat {
    /// Heat capacities in J/K of what a mole of each reaction uses and makes; empty where they do not count.
    each: Vec<[f64; 2]>,
}

impl FilmHeat {
    /// That of a particle of a temperature in K at the start of a window.
    pub fn begin(
        &mut self,
        chemistry: &SolidChemistry,
        around: &ParticleSurroundings<'_>,
        temperature: f64,
    ) {
        self.each.clear();
        let Some(gas) = &chemistry.gas else {
            return;
        };
        if around.theory.stefan_flow == StefanFlow::None {
            return;
        }
        let mean = 0.5 * (temperature + around.temperature);
        let of = |sign: f64, gases: &[(usize, f64)]| -> f64 {
            let kept = gases.iter().filter(|one| sign * one.1 > 0.0);
            let each = kept.map(|&(g, n)| {
                let species = &gas.species()[g];
                n.abs() * species.molar_mass() * species.heat_capacity(mean)
            });
            each.sum()
        };
        let reactions = chemistry.reactions.iter();
        self.each
            .extend(reactions.map(|one| [of(-1.0, &one.gases), of(1.0, &one.gases)]));
    }

    /// What passes of a difference of temperatures in W/K at rates in mol/s, of a film that conducts `own` in W/K about the
    /// particle at the start, which is `shrinkage` times as large; and the change of that with it.
    pub fn conductance(&self, own: f64, shrinkage: f64, rates: &[f64]) -> (f64, f64) {
        let film = own * shrinkage;
        if self.each.is_empty() || film <= 0.0 {
            return (film, own);
        }
        let (used, number) = self.flows(film, rates);
        let factor = bernoulli(Dual::<1>::along(number, 0));
        let slope = own * (factor.value - number * factor.slope[0]);
        (film * factor.value - used, slope)
    }

    /// The change of that with the rate of a reaction, in J/mol/K.
    pub fn slope(&self, own: f64, shrinkage: f64, rates: &[f64], reaction: usize) -> f64 {
        let film = own * shrinkage;
        let Some(&[used, made]) = self.each.get(reaction).filter(|_| film > 0.0) else {
            return 0.0;
        };
        let number = self.flows(film, rates).1;
        bernoulli(Dual::<1>::along(number, 0)).slope[0] * (made - used) - used
    }

    /// Heat capacity in W/K of what is used, and φ.
    fn flows(&self, film: f64, rates: &[f64]) -> (f64, f64) {
        let pairs = self.each.iter().zip(rates);
        let (used, made) = pairs.fold((0.0, 0.0), |(used, made), (each, rate)| {
            (used + rate * each[0], made + rate * each[1])
        });
        (used, (made - used) / film)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heat_that_reaches_the_surface_is_that_of_the_film_s_own_equation() {
        // d/dy (λ dT/dy − n c_p T) = 0 between T_p and T_gas: λ dT/dy at the surface is h φ/(e^φ − 1) (T_gas − T_p); what is used
        // brings its a (T_gas − T_p) apart.
        let (own, rate) = (0.03, 2e-4);
        for (used, made) in [(0.0, 60.0), (50.0, 0.0), (30.0, 55.0), (40.0, 40.0)] {
            let heat = FilmHeat {
                each: vec![[used, made]],
            };
            let phi: f64 = rate * (made - used) / own;
            let surface = if phi == 0.0 {
                own
            } else {
                own * phi / phi.exp_m1()
            };
            let (found, _) = heat.conductance(own, 1.0, &[rate]);
            let all = found + rate * used;
            assert!((all / surface - 1.0).abs() < 1e-13, "{used} {made}: {all}");
        }
    }

    #[test]
    fn slopes_are_difference_quotients_and_a_film_without_conductance_brings_nothing() {
        let heat = FilmHeat {
            each: vec![[30.0, 55.0], [10.0, 0.0]],
        };
        let (own, rates, h) = (0.03, [2e-4, 5e-4], 1e-8);
        let at = |shrinkage: f64, rates: &[f64]| heat.conductance(own, shrinkage, rates).0;
        let by_size = (at(0.7 + 1e-6, &rates) - at(0.7 - 1e-6, &rates)) / 2e-6;
        assert!((heat.conductance(own, 0.7, &rates).1 / by_size - 1.0).abs() < 1e-7);
        for j in 0..2 {
            let mut varied = [rates; 2];
            varied[0][j] -= h;
            varied[1][j] += h;
            let quotient = (at(0.7, &varied[1]) - at(0.7, &varied[0])) / (2.0 * h);
            let slope = heat.slope(own, 0.7, &rates, j);
            assert!(
                (slope / quotient - 1.0).abs() < 1e-6,
                "{j}: {slope} {quotient}"
            );
        }
        assert_eq!(heat.conductance(0.0, 0.7, &rates).0, 0.0);
        assert_eq!(heat.slope(0.0, 0.7, &rates, 0), 0.0);
    }
}
