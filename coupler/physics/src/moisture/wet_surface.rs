//! A wet surface in a gas stream: its temperature and the rate of evaporation, boiling and condensation included.

use super::antoine::boiling_temperature;
use crate::film::bernoulli;

/// A surface that gives water to a gas, or takes it, through one film, quasi-steady.
///
/// With φ = ṁ/k, k = ρ β A, the film theory of [`crate::film::StefanFlow`] gives the vapour at the surface,
///
/// 1 − Y_s = (1 − Y_g) e^(−φ),
///
/// its partial pressure the temperature, a p_sat(T_s) = X_s p, and the balance of heat the rate,
///
/// h A B(ψ) (T_g − T_s) + Q = ṁ Δh(T_s),   ψ = ṁ c_pv/(h A),   B(ψ) = ψ/(e^ψ − 1).
///
/// With φ as the unknown nothing is singular: towards the boiling point φ grows without bound and T_s approaches it, and
/// in pure vapour T_s is the boiling point at any rate. Negative φ is condensation.
///
/// Source: Bird, Stewart and Lightfoot, Transport Phenomena, 2nd ed. (2002), section 22.8, ISBN 0-471-41077-2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WetSurface {
    /// Conductance h A of the film without net flow in W/K, positive.
    pub conductance: f64,
    /// Mass transfer k = ρ β A of the film without net flow in kg/s, positive.
    pub mass_transfer: f64,
    /// Specific heat capacity c_pv of the vapour in the film in J/kg/K.
    pub vapour_heat_capacity: f64,
    /// Temperature T_g of the gas in K.
    pub gas_temperature: f64,
    /// Mass fraction Y_g of vapour in the gas, 0 to 1.
    pub vapour_fraction: f64,
    /// Molar mass of water over the mean molar mass of the gas without vapour.
    pub molar_mass_ratio: f64,
    /// Pressure p in Pa.
    pub pressure: f64,
    /// Water activity a of the surface, above 0 and at most 1 ([`super::isotherm::water_activity`]).
    pub activity: f64,
    /// Other heat Q into the surface in W: radiation, contacts, less what warms the particle.
    pub heat: f64,
}

/// The state of a [`WetSurface`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WetState {
    /// Temperature T_s in K.
    pub temperature: f64,
    /// Rate of evaporation ṁ in kg/s, negative where vapour condenses.
    pub evaporation: f64,
    /// Heat from the gas into the surface in W.
    pub heat: f64,
}

/// Steps of the search for φ; bisection of the widest interval of doubles needs some 1100, Newton's method some ten.
const STEPS: usize = 2000;

impl WetSurface {
    /// Temperature in K of the surface where ṁ = φ k.
    pub fn temperature(&self, phi: f64) -> f64 {
        let rest = (1.0 - self.vapour_fraction) * (-phi).exp();
        let vapour = 1.0 - rest;
        let mole_fraction = vapour / (vapour + rest * self.molar_mass_ratio);
        boiling_temperature(mole_fraction * self.pressure / self.activity)
    }

    /// The state at ṁ = φ k, whether or not its heat balances.
    fn state(&self, phi: f64) -> WetState {
        let temperature = self.temperature(phi);
        let evaporation = phi * self.mass_transfer;
        let psi = evaporation * self.vapour_heat_capacity / self.conductance;
        WetState {
            temperature,
            evaporation,
            heat: self.conductance * bernoulli(psi) * (self.gas_temperature - temperature),
        }
    }

    /// The state at which heat balances, with the heat Δh(T) in J/kg that a kilogram of vapour takes from the surface at
    /// T in K, positive: evaporation and, below fibre saturation, sorption.
    ///
    /// `None` where there is none: gas without vapour at a surface that is cooled below all temperatures at which water
    /// has a vapour pressure.
    pub fn balance(&self, taken: impl Fn(f64) -> f64) -> Option<WetState> {
        let surplus = |phi: f64| {
            let state = self.state(phi);
            state.heat + self.heat - state.evaporation * taken(state.temperature)
        };
        // The surplus falls with φ. Its least value: no vapour at the surface.
        let least = (1.0 - self.vapour_fraction).ln();
        let (mut low, mut high) = self.bracket(least, &surplus)?;
        let mut phi = 0.5 * (low + high);
        for _ in 0..STEPS {
            let value = surplus(phi);
            if value > 0.0 {
                low = phi;
            } else {
                high = phi;
            }
            let width = 1e-6 * phi.abs().max(1e-9);
            let slope = (surplus(phi + width) - value) / width;
            let newton = phi - value / slope;
            let next = if newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
            let last = (next - phi).abs() <= 4.0 * f64::EPSILON * phi.abs();
            phi = next;
            if last || high - low <= 4.0 * f64::EPSILON * phi.abs() {
                break;
            }
        }
        Some(self.state(phi))
    }

    /// Two φ between which the surplus changes its sign, the lower one first; `least` is the φ of a surface without vapour.
    fn bracket(&self, least: f64, surplus: &impl Fn(f64) -> f64) -> Option<(f64, f64)> {
        let mut reach = 1e-3;
        if surplus(0.0) > 0.0 {
            while surplus(reach) > 0.0 {
                reach *= 2.0;
                if !reach.is_finite() {
                    return None;
                }
            }
            return Some((0.0, reach));
        }
        loop {
            let low = (-reach).max(least);
            if surplus(low) > 0.0 {
                return Some((low, 0.0));
            }
            if low == least {
                return None;
            }
            reach *= 2.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::thermo::Mixture;

    /// Molar mass of water and of dry air in kg/mol.
    const WATER: f64 = 18.015e-3;
    const AIR: f64 = 28.96e-3;

    /// Heat of evaporation by the enthalpies of vapour and liquid, 2441.7 kJ/kg at 25 °C, in J/kg.
    fn evaporation_heat(temperature: f64) -> f64 {
        2.4417e6 - 2320.0 * (temperature - 298.15)
    }

    /// A drop of a millimetre at rest in humid air of a relative humidity, its film at a temperature.
    fn drop(celsius: f64, humidity: f64, film_temperature: f64) -> WetSurface {
        let diameter = 1e-3;
        let area = std::f64::consts::PI * diameter * diameter;
        let gas_temperature = celsius + 273.15;
        let pressure = 101_325.0;
        let mole = humidity * super::super::antoine::vapour_pressure(gas_temperature) / pressure;
        let vapour_fraction = mole * WATER / (mole * WATER + (1.0 - mole) * AIR);
        let mixture = Mixture::new(["N2", "O2", "H2O"]).unwrap();
        let dry = 1.0 - vapour_fraction;
        let composition = [0.767 * dry, 0.233 * dry, vapour_fraction];
        let conductivity = mixture.conductivity(film_temperature, &composition);
        let diffusivity = mixture.pair_diffusivity((0, 2), pressure, film_temperature);
        let density = mixture.density(pressure, film_temperature, &composition);
        WetSurface {
            conductance: 2.0 * conductivity / diameter * area,
            mass_transfer: 2.0 * density * diffusivity / diameter * area,
            vapour_heat_capacity: 1864.0,
            gas_temperature,
            vapour_fraction,
            molar_mass_ratio: WATER / AIR,
            pressure,
            activity: 1.0,
            heat: 0.0,
        }
    }

    /// Its wet-bulb temperature in °C, the film by the two-thirds rule.
    fn wet_bulb(celsius: f64, humidity: f64) -> f64 {
        let mut surface = celsius;
        for _ in 0..20 {
            let film = (2.0 * surface + celsius) / 3.0 + 273.15;
            let state = drop(celsius, humidity, film)
                .balance(evaporation_heat)
                .unwrap();
            surface = state.temperature - 273.15;
        }
        surface
    }

    #[test]
    fn the_wet_bulb_of_a_drop_is_that_of_a_published_case() {
        // docs/theory.md, DRY-8: 30 °C, 50 % relative humidity, drop of 1 mm: 21.76 °C.
        let found = wet_bulb(30.0, 0.5);
        assert!((found - 21.76).abs() < 0.5, "{found}");
    }

    #[test]
    fn saturated_gas_leaves_the_surface_at_its_own_temperature() {
        let found = wet_bulb(30.0, 1.0);
        assert!((found - 30.0).abs() < 1e-9, "{found}");
    }

    #[test]
    fn the_balance_holds_to_round_off_from_cold_to_hot_and_from_dry_to_steam() {
        for celsius in [5.0, 30.0, 90.0, 400.0, 1500.0] {
            for vapour in [0.0, 1e-4, 0.3, 0.99, 1.0] {
                for heat in [-1e-3, 0.0, 0.05, 5.0] {
                    let surface = WetSurface {
                        gas_temperature: celsius + 273.15,
                        vapour_fraction: vapour,
                        heat,
                        ..drop(30.0, 0.5, 300.0)
                    };
                    let Some(state) = surface.balance(evaporation_heat) else {
                        panic!("{celsius} {vapour} {heat}");
                    };
                    let latent = state.evaporation * evaporation_heat(state.temperature);
                    let scale = state.heat.abs() + heat.abs() + latent.abs();
                    let off = (state.heat + heat - latent).abs();
                    // In pure steam the temperature is the same at all rates, so that Newton's method ends exactly.
                    assert!(
                        off <= 1e-9 * scale,
                        "{celsius} {vapour} {heat}: {off:e} {state:?}"
                    );
                    assert!(state.temperature <= boiling_temperature(101_325.0) + 1e-9);
                }
            }
        }
    }

    #[test]
    fn in_steam_the_surface_boils_and_the_heat_sets_the_rate() {
        let surface = WetSurface {
            gas_temperature: 500.0,
            vapour_fraction: 1.0,
            vapour_heat_capacity: 1e-9,
            heat: 0.002,
            ..drop(30.0, 0.5, 400.0)
        };
        let state = surface.balance(|_| 2.6e6).unwrap();
        let boiling = boiling_temperature(101_325.0);
        let expected = (surface.conductance * (500.0 - boiling) + 0.002) / 2.6e6;
        assert!((state.temperature - boiling).abs() < 1e-9);
        assert!((state.evaporation / expected - 1.0).abs() < 1e-9);
        // The vapour that leaves holds the heat off: ln(1 + c ΔT/Δh)/(c ΔT/Δh) of it.
        let cooled = WetSurface {
            vapour_heat_capacity: 2000.0,
            heat: 0.0,
            ..surface
        };
        let transfer: f64 = 2000.0 * (500.0 - boiling) / 2.6e6;
        let rate = cooled.conductance / 2000.0 * transfer.ln_1p();
        let found = cooled.balance(|_| 2.6e6).unwrap().evaporation;
        assert!((found / rate - 1.0).abs() < 1e-8, "{found:e} {rate:e}");
    }

    #[test]
    fn the_rate_is_continuous_towards_pure_steam() {
        let hot = |vapour_fraction: f64| WetSurface {
            gas_temperature: 500.0,
            vapour_fraction,
            ..drop(30.0, 0.5, 400.0)
        };
        let steam = hot(1.0).balance(evaporation_heat).unwrap();
        for away in [1e-3, 1e-6, 1e-9] {
            let near = hot(1.0 - away).balance(evaporation_heat).unwrap();
            let off = (near.evaporation / steam.evaporation - 1.0).abs();
            assert!(off < 2.0 * away, "{away:e}: {off:e}");
        }
    }

    #[test]
    fn a_cold_surface_in_steam_condenses() {
        let surface = WetSurface {
            gas_temperature: 380.0,
            vapour_fraction: 1.0,
            heat: -0.1,
            ..drop(30.0, 0.5, 370.0)
        };
        let state = surface.balance(evaporation_heat).unwrap();
        assert!(state.evaporation < 0.0 && state.heat > 0.0, "{state:?}");
    }

    #[test]
    fn bound_water_leaves_more_slowly_from_a_warmer_surface() {
        let free = drop(60.0, 0.1, 310.0);
        let bound = WetSurface {
            activity: 0.5,
            ..free
        };
        let (free, bound) = (
            free.balance(evaporation_heat).unwrap(),
            bound.balance(evaporation_heat).unwrap(),
        );
        assert!(bound.temperature > free.temperature);
        assert!(bound.evaporation < free.evaporation);
    }

    #[test]
    fn slow_evaporation_is_by_the_difference_of_concentrations() {
        // φ → 0: ṁ = k (Y_s − Y_g)/(1 − Y), the Stefan flow drops out.
        let surface = drop(10.0, 0.9, 283.0);
        let state = surface.balance(evaporation_heat).unwrap();
        let pressure = super::super::antoine::vapour_pressure(state.temperature);
        let y = |p: f64| p * WATER / (p * WATER + (101_325.0 - p) * AIR);
        let linear = surface.mass_transfer * (y(pressure) - surface.vapour_fraction);
        assert!(
            (state.evaporation / linear - 1.0).abs() < 0.01,
            "{state:?} {linear:e}"
        );
    }
}
