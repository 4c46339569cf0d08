//! Units of mechanisms.

use calcine_coupler::physics::gas::GAS_CONSTANT;

/// Avogadro's constant in 1/mol (SI 2019).
const AVOGADRO: f64 = 6.022_140_76e23;
/// A thermochemical calorie in J.
const CALORIE: f64 = 4.184;
/// An electron volt in J (SI 2019).
const ELECTRON_VOLT: f64 = 1.602_176_634e-19;

/// Units in which a mechanism writes its rate constants, as what one of each is in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MechanismUnits {
    /// Length in m.
    pub length: f64,
    /// Time in s.
    pub time: f64,
    /// Amount in mol.
    pub quantity: f64,
    /// Activation energy in J/mol.
    pub activation_energy: f64,
}

impl MechanismUnits {
    /// Cantera's where a file does not say: m, s, kmol, J/kmol.
    pub const CANTERA: Self = Self {
        length: 1.0,
        time: 1.0,
        quantity: 1e3,
        activation_energy: 1e-3,
    };
    /// CHEMKIN's: cm, s, mol, cal/mol.
    pub const CHEMKIN: Self = Self {
        length: 1e-2,
        time: 1.0,
        quantity: 1.0,
        activation_energy: CALORIE,
    };

    /// A factor of a rate constant of this order in (mol/m³)^(1 − order)/s.
    pub fn factor(&self, stated: f64, order: f64) -> f64 {
        stated * (self.quantity / self.length.powi(3)).powf(1.0 - order) / self.time
    }
}

/// A length in m.
pub fn length(name: &str) -> Option<f64> {
    Some(match name {
        "m" => 1.0,
        "dm" => 1e-1,
        "cm" => 1e-2,
        "mm" => 1e-3,
        _ => return None,
    })
}

/// A time in s.
pub fn time(name: &str) -> Option<f64> {
    Some(match name {
        "s" => 1.0,
        "ms" => 1e-3,
        "min" => 60.0,
        "hr" => 3600.0,
        _ => return None,
    })
}

/// An amount in mol.
pub fn quantity(name: &str) -> Option<f64> {
    Some(match name.to_ascii_lowercase().as_str() {
        "mol" | "mole" | "moles" => 1.0,
        "kmol" => 1e3,
        "molec" | "molecule" | "molecules" => 1.0 / AVOGADRO,
        _ => return None,
    })
}

/// An activation energy in J/mol, by the names of both formats.
pub fn activation_energy(name: &str) -> Option<f64> {
    Some(match name.to_ascii_lowercase().as_str() {
        "cal/mol" | "cal/mole" => CALORIE,
        "kcal/mol" | "kcal/mole" => 1e3 * CALORIE,
        "j/mol" | "joules/mole" => 1.0,
        "kj/mol" | "kjoules/mole" | "kjou/mole" => 1e3,
        "j/kmol" => 1e-3,
        "kcal/kmol" => CALORIE,
        "cal/kmol" => 1e-3 * CALORIE,
        "kj/kmol" => 1.0,
        "k" | "kelvin" | "kelvins" => GAS_CONSTANT,
        "ev" | "evolts" => ELECTRON_VOLT * AVOGADRO,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_factor_of_second_order_in_cm3_per_mol_is_a_millionth_in_m3() {
        assert!((MechanismUnits::CHEMKIN.factor(3e13, 2.0) / 3e7 - 1.0).abs() < 1e-14);
        assert!((MechanismUnits::CANTERA.factor(3e8, 2.0) / 3e5 - 1.0).abs() < 1e-14);
        assert_eq!(MechanismUnits::CHEMKIN.factor(7.0, 1.0), 7.0);
        let molecules = MechanismUnits {
            quantity: quantity("molec").unwrap_or(0.0),
            ..MechanismUnits::CHEMKIN
        };
        // 1e-11 cm³/molecule/s: 6.022e12 cm³/mol/s.
        assert!((molecules.factor(1e-11, 2.0) / 6.022_140_76e6 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn one_kelvin_is_r_and_one_electron_volt_96_5_kj_per_mol() {
        assert_eq!(activation_energy("K"), Some(GAS_CONSTANT));
        let volt = activation_energy("eV").unwrap_or(0.0);
        assert!((volt / 96_485.332 - 1.0).abs() < 1e-8);
        assert_eq!(activation_energy("erg/mol"), None);
    }
}
