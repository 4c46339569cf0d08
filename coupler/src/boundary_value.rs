//! Conditions of the gas that are set while a run goes on.
//!
//! A value replaces the case's schedule of one condition at one patch from the start of the next window on. It
//! never changes what kind of patch it is: a wall stays a wall.

use std::fmt;

use thiserror::Error;

use crate::setup::{CompositionSchedule, GasPatch, InletFlow, PatchGas, Schedule, WallHeat};

/// Mass fractions must sum to one within this.
const SUM: f64 = 1e-9;

/// A condition with its value.
#[derive(Clone, Debug, PartialEq)]
pub enum BoundaryQuantity {
    /// Temperature in K of an inlet's or an opening's gas or of what comes back in at an outlet, where the case gives it,
    /// or of a wall whose temperature the case gives.
    Temperature(f64),
    /// Superficial velocity in m/s into the domain, of an inlet.
    SuperficialVelocity(f64),
    /// Mass flow in kg/s into the domain through the whole patch, of an inlet.
    MassFlow(f64),
    /// Mass fractions of an inlet's or an opening's gas or of what comes back in at an outlet, in the order of the mixture's species.
    Composition(Vec<f64>),
    /// Absolute pressure in Pa of an outlet or an opening.
    Pressure(f64),
    /// Heat flux in W/m² into the gas, of a wall whose flux the case gives.
    HeatFlux(f64),
    /// Overall heat transfer coefficient in W/m²/K, of a wall that exchanges heat with surroundings.
    HeatTransferCoefficient(f64),
    /// Temperature in K of the surroundings of such a wall.
    Ambient(f64),
}

/// A condition at a patch.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryValue {
    /// Name of the patch.
    pub patch: String,
    /// The condition and its value.
    pub quantity: BoundaryQuantity,
}

/// A condition that cannot be set.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum BoundaryValueError {
    /// There is no such patch.
    #[error("the gas has no patch `{patch}`; it has {present}")]
    NoPatch {
        /// The name that was given.
        patch: String,
        /// Those that are there.
        present: String,
    },
    /// The patch has no such condition.
    #[error("patch `{patch}` has no {quantity}: {remedy}")]
    NotThere {
        /// The patch.
        patch: String,
        /// The condition.
        quantity: &'static str,
        /// Which patches have one.
        remedy: &'static str,
    },
    /// A value that means nothing.
    #[error("patch `{patch}`: a {quantity} of {value} {unit}; it must be {rule}")]
    Value {
        /// The patch.
        patch: String,
        /// The condition.
        quantity: &'static str,
        /// The value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// What is allowed.
        rule: &'static str,
    },
    /// Mass fractions of another number of species, or that do not sum to one.
    #[error(
        "patch `{patch}`: {found} mass fractions with a sum of {sum}; {expected} are needed, each from 0 to 1, \
         with a sum of 1"
    )]
    Fractions {
        /// The patch.
        patch: String,
        /// How many there are.
        found: usize,
        /// How many the mixture has.
        expected: usize,
        /// Their sum.
        sum: f64,
    },
}

impl BoundaryQuantity {
    /// Its name, one word, as it stands in logs and on the wire.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Temperature(_) => "temperature",
            Self::SuperficialVelocity(_) => "superficial_velocity",
            Self::MassFlow(_) => "mass_flow",
            Self::Composition(_) => "composition",
            Self::Pressure(_) => "pressure",
            Self::HeatFlux(_) => "heat_flux",
            Self::HeatTransferCoefficient(_) => "heat_transfer_coefficient",
            Self::Ambient(_) => "ambient",
        }
    }

    /// Its values, one but for a composition.
    pub fn values(&self) -> &[f64] {
        match self {
            Self::Composition(fractions) => fractions,
            Self::Temperature(value)
            | Self::SuperficialVelocity(value)
            | Self::MassFlow(value)
            | Self::Pressure(value)
            | Self::HeatFlux(value)
            | Self::HeatTransferCoefficient(value)
            | Self::Ambient(value) => std::slice::from_ref(value),
        }
    }

    /// The condition of a name, as [`BoundaryQuantity::name`] has it, and its values.
    pub fn parse(name: &str, values: &[f64]) -> Option<Self> {
        if name == "composition" {
            return Some(Self::Composition(values.to_vec()));
        }
        let &[value] = values else { return None };
        Some(match name {
            "temperature" => Self::Temperature(value),
            "superficial_velocity" => Self::SuperficialVelocity(value),
            "mass_flow" => Self::MassFlow(value),
            "pressure" => Self::Pressure(value),
            "heat_flux" => Self::HeatFlux(value),
            "heat_transfer_coefficient" => Self::HeatTransferCoefficient(value),
            "ambient" => Self::Ambient(value),
            _ => return None,
        })
    }

    fn words(&self) -> &'static str {
        match self {
            Self::Temperature(_) => "temperature",
            Self::SuperficialVelocity(_) => "superficial velocity",
            Self::MassFlow(_) => "mass flow",
            Self::Composition(_) => "composition",
            Self::Pressure(_) => "pressure",
            Self::HeatFlux(_) => "heat flux",
            Self::HeatTransferCoefficient(_) => "heat transfer coefficient",
            Self::Ambient(_) => "ambient temperature",
        }
    }

    /// Which patches have it.
    fn remedy(&self) -> &'static str {
        match self {
            Self::Temperature(_) => {
                "inlets and openings have one, outlets with `backflow`, and walls whose `heat` the case gives as a \
                 temperature"
            }
            Self::SuperficialVelocity(_) | Self::MassFlow(_) => "inlets have one",
            Self::Composition(_) => {
                "inlets, openings and outlets with `backflow` of a mixture have one"
            }
            Self::Pressure(_) => "outlets and openings have one",
            Self::HeatFlux(_) => "walls have one whose `heat` the case gives as a flux",
            Self::HeatTransferCoefficient(_) | Self::Ambient(_) => {
                "walls have one whose `heat` the case gives by coefficient and ambient"
            }
        }
    }

    /// The value with its unit and rule where it breaks the rule.
    fn wrong(&self) -> Option<(f64, &'static str, &'static str)> {
        let positive = |value: f64, unit| {
            (!(value.is_finite() && value > 0.0)).then_some((value, unit, "positive"))
        };
        let not_negative = |value: f64, unit| {
            (!(value.is_finite() && value >= 0.0)).then_some((value, unit, "zero or positive"))
        };
        match *self {
            Self::Temperature(value) | Self::Ambient(value) => positive(value, "K"),
            Self::SuperficialVelocity(value) => not_negative(value, "m/s"),
            Self::MassFlow(value) => not_negative(value, "kg/s"),
            Self::Pressure(value) => positive(value, "Pa"),
            Self::HeatFlux(value) => (!value.is_finite()).then_some((value, "W/m^2", "finite")),
            Self::HeatTransferCoefficient(value) => not_negative(value, "W/m^2/K"),
            Self::Composition(_) => None,
        }
    }
}

impl BoundaryValue {
    /// Puts the value in place of the schedule of its condition.
    pub fn apply(&self, patches: &mut [(String, GasPatch)]) -> Result<(), BoundaryValueError> {
        if let Some((value, unit, rule)) = self.quantity.wrong() {
            return Err(BoundaryValueError::Value {
                patch: self.patch.clone(),
                quantity: self.quantity.words(),
                value,
                unit,
                rule,
            });
        }
        let present = || {
            let names: Vec<&str> = patches.iter().map(|(name, _)| name.as_str()).collect();
            names.join(", ")
        };
        let Some(at) = patches.iter().position(|(name, _)| *name == self.patch) else {
            return Err(BoundaryValueError::NoPatch {
                patch: self.patch.clone(),
                present: present(),
            });
        };
        self.replace(&mut patches[at].1)
    }

    fn replace(&self, patch: &mut GasPatch) -> Result<(), BoundaryValueError> {
        use BoundaryQuantity as Q;
        match (patch, &self.quantity) {
            (
                GasPatch::Inlet { temperature, .. }
                | GasPatch::Opening {
                    gas: PatchGas { temperature, .. },
                    ..
                }
                | GasPatch::Outlet {
                    backflow: Some(PatchGas { temperature, .. }),
                    ..
                },
                Q::Temperature(value),
            ) => {
                *temperature = Schedule::constant(*value);
            }
            (GasPatch::Inlet { flow, .. }, Q::SuperficialVelocity(value)) => {
                *flow = InletFlow::SuperficialVelocity(Schedule::constant(*value));
            }
            (GasPatch::Inlet { flow, .. }, Q::MassFlow(value)) => {
                *flow = InletFlow::MassFlow(Schedule::constant(*value));
            }
            (
                GasPatch::Inlet {
                    composition: Some(composition),
                    ..
                }
                | GasPatch::Opening {
                    gas:
                        PatchGas {
                            composition: Some(composition),
                            ..
                        },
                    ..
                }
                | GasPatch::Outlet {
                    backflow:
                        Some(PatchGas {
                            composition: Some(composition),
                            ..
                        }),
                    ..
                },
                Q::Composition(fractions),
            ) => {
                self.check_fractions(fractions, composition)?;
                *composition = CompositionSchedule(vec![(0.0, fractions.clone())]);
            }
            (
                GasPatch::Outlet { pressure, .. } | GasPatch::Opening { pressure, .. },
                Q::Pressure(value),
            ) => {
                *pressure = Schedule::constant(*value);
            }
            (GasPatch::Wall { heat, .. }, quantity) => return self.replace_heat(heat, quantity),
            _ => return Err(self.not_there()),
        }
        Ok(())
    }

    fn replace_heat(
        &self,
        heat: &mut WallHeat,
        quantity: &BoundaryQuantity,
    ) -> Result<(), BoundaryValueError> {
        use BoundaryQuantity as Q;
        let (schedule, value) = match (heat, quantity) {
            (WallHeat::Temperature(schedule), Q::Temperature(value))
            | (WallHeat::Flux(schedule), Q::HeatFlux(value))
            | (
                WallHeat::Convective {
                    coefficient: schedule,
                    ..
                },
                Q::HeatTransferCoefficient(value),
            )
            | (
                WallHeat::Convective {
                    ambient: schedule, ..
                },
                Q::Ambient(value),
            ) => (schedule, *value),
            _ => return Err(self.not_there()),
        };
        *schedule = Schedule::constant(value);
        Ok(())
    }

    fn check_fractions(
        &self,
        fractions: &[f64],
        before: &CompositionSchedule,
    ) -> Result<(), BoundaryValueError> {
        let expected = before.0.first().map_or(0, |entry| entry.1.len());
        let sum: f64 = fractions.iter().sum();
        let within = fractions.iter().all(|share| (0.0..=1.0).contains(share));
        if fractions.len() == expected && within && (sum - 1.0).abs() <= SUM {
            return Ok(());
        }
        Err(BoundaryValueError::Fractions {
            patch: self.patch.clone(),
            found: fractions.len(),
            expected,
            sum,
        })
    }

    fn not_there(&self) -> BoundaryValueError {
        BoundaryValueError::NotThere {
            patch: self.patch.clone(),
            quantity: self.quantity.words(),
            remedy: self.quantity.remedy(),
        }
    }

    /// The value as one line: patch, condition, numbers that are read back bit for bit.
    pub fn line(&self) -> String {
        let values = self.quantity.values().iter();
        values.fold(
            format!("{} {}", self.patch, self.quantity.name()),
            |line, value| format!("{line} {value:?}"),
        )
    }

    /// Reads a line back; `None` where it is none.
    pub fn read(line: &str) -> Option<Self> {
        let mut words = line.split_whitespace();
        let (patch, name) = (words.next()?, words.next()?);
        let values: Option<Vec<f64>> = words.map(|word| word.parse().ok()).collect();
        Some(Self {
            patch: patch.to_owned(),
            quantity: BoundaryQuantity::parse(name, &values?)?,
        })
    }
}

impl fmt::Display for BoundaryValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.line())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setup::WallVelocity;

    fn patches() -> Vec<(String, GasPatch)> {
        let inlet = GasPatch::Inlet {
            flow: InletFlow::SuperficialVelocity(Schedule::constant(0.5)),
            temperature: Schedule(vec![(0.0, 300.0), (10.0, 400.0)]),
            composition: Some(CompositionSchedule(vec![(0.0, vec![0.2, 0.8])])),
            turbulence: None,
            scalars: Default::default(),
        };
        let wall = GasPatch::Wall {
            velocity: WallVelocity::NoSlip,
            heat: WallHeat::Flux(Schedule::constant(0.0)),
        };
        let outlet = GasPatch::outlet(Schedule::constant(1e5));
        [("bottom", inlet), ("side", wall), ("top", outlet)]
            .map(|(name, patch)| (name.to_owned(), patch))
            .into()
    }

    fn value(patch: &str, quantity: BoundaryQuantity) -> BoundaryValue {
        BoundaryValue {
            patch: patch.into(),
            quantity,
        }
    }

    #[test]
    fn a_value_takes_the_place_of_the_schedule() {
        let mut all = patches();
        value("bottom", BoundaryQuantity::Temperature(350.0))
            .apply(&mut all)
            .unwrap();
        let GasPatch::Inlet { temperature, .. } = &all[0].1 else {
            unreachable!()
        };
        assert_eq!([temperature.at(0.0), temperature.at(10.0)], [350.0; 2]);
    }

    #[test]
    fn what_a_patch_does_not_have_is_refused_with_who_has_it() {
        let error = value("side", BoundaryQuantity::Temperature(300.0))
            .apply(&mut patches())
            .unwrap_err();
        let words = error.to_string();
        assert!(words.contains("`side` has no temperature"), "{words}");
        let error = value("lid", BoundaryQuantity::Pressure(1e5))
            .apply(&mut patches())
            .unwrap_err();
        assert!(error.to_string().contains("bottom, side, top"), "{error}");
    }

    #[test]
    fn numbers_out_of_range_are_refused_and_change_nothing() {
        let mut all = patches();
        for quantity in [
            BoundaryQuantity::Temperature(-1.0),
            BoundaryQuantity::SuperficialVelocity(f64::NAN),
            BoundaryQuantity::Composition(vec![0.5, 0.6]),
            BoundaryQuantity::Composition(vec![1.0]),
        ] {
            assert!(value("bottom", quantity).apply(&mut all).is_err());
        }
        assert_eq!(all, patches());
    }

    #[test]
    fn a_line_is_read_back_bit_for_bit() {
        for quantity in [
            BoundaryQuantity::Temperature(300.1 + 1e-13),
            BoundaryQuantity::Composition(vec![0.1, 1.0 - 0.1]),
        ] {
            let one = value("bottom", quantity);
            assert_eq!(BoundaryValue::read(&one.line()), Some(one));
        }
        assert_eq!(BoundaryValue::read("bottom colour 3"), None);
    }
}
