//! Bond's law.

use std::fmt::Display;

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawParameter};

use crate::PlantError;

/// Key of the work index, for mills by this law.
pub(super) const WORK_INDEX: LawParameter = LawParameter {
    name: "work_index",
    dimension: Dimension::ENERGY_OF_MASS,
    bound: Bound::Positive,
    default: None,
    needed_with: None,
    meaning: "Work index; literature has it in kWh per (short) ton.",
    example: "\"7.5 kWh/t\"",
};

/// Key of the power.
pub(super) const POWER: LawParameter = LawParameter {
    name: "power",
    dimension: Dimension::POWER,
    bound: Bound::Positive,
    default: None,
    needed_with: None,
    meaning: "Power drawn.",
    example: "\"0.8 kW\"",
};

/// Length by which Bond's law divides sizes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BondLength {
    /// 1 µm, as Bond has it.
    Micrometre,
    /// 1 mm, as Dyssol has it (`bond-mm`): the same work mills much less finely.
    Millimetre,
}

/// Bond's law: the work by which 80 % of the mass gets below a size.
///
/// W = 10 W_i (1/√(x₈₀,out/ℓ) − 1/√(x₈₀,in/ℓ)),   ℓ = 1 µm
///
/// W is the power divided by the flow of solids. The index W_i is usually given in kWh per (short) ton.
///
/// Source: Bond, Trans. AIME 193 (1952) 484.
#[derive(Clone, Debug, PartialEq)]
pub struct BondLaw {
    /// Work index W_i in J/kg (1 kWh/t = 3600 J/kg).
    pub work_index: f64,
    /// Power in W.
    pub power: f64,
    /// ℓ.
    pub length: BondLength,
}

impl BondLaw {
    /// x₈₀ of what comes out in m, of a feed in kg/s with an x₈₀ in m.
    pub fn product_size(&self, feed_size: f64, flow: f64) -> f64 {
        let unit = match self.length {
            BondLength::Micrometre => 1e-6,
            BondLength::Millimetre => 1e-3,
        };
        let work = self.power / flow;
        let root = work / (10.0 * self.work_index) + (unit / feed_size).sqrt();
        unit / (root * root)
    }

    /// Refuses numbers that the law cannot have.
    pub(super) fn check(&self, place: &dyn Display) -> Result<(), PlantError> {
        let numbers = [("work index", self.work_index), ("power", self.power)];
        for (quantity, value) in numbers {
            if !(value.is_finite() && value > 0.0) {
                return Err(PlantError::Value {
                    place: place.to_string(),
                    quantity,
                    value,
                    allowed: "it is above zero",
                });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation_in_both_lengths() {
        let law = |length| BondLaw {
            work_index: 7.5 * 3600.0,
            power: 800.0,
            length,
        };
        // 0.8 kW at 0.18 t/h (0.05 kg/s) are 4.444 kWh/t; feed 2.5 mm.
        let by_millimetre = law(BondLength::Millimetre).product_size(2.5e-3, 0.05);
        // 1/(4.44444/75 + 1/√2.5)² mm = 1/(0.0592593 + 0.6324555)² mm.
        assert!(
            (by_millimetre - 2.089_99e-3).abs() < 1e-8,
            "{by_millimetre}"
        );
        // 1/(0.0592593 + 1/√2500)² µm = 1/0.0792593² µm.
        let by_micrometre = law(BondLength::Micrometre).product_size(2.5e-3, 0.05);
        assert!((by_micrometre - 159.183e-6).abs() < 1e-8, "{by_micrometre}");
    }
}
