//! Chemical elements.

/// An element that gases and solids here are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Element {
    /// Hydrogen.
    H,
    /// Carbon.
    C,
    /// Nitrogen.
    N,
    /// Oxygen.
    O,
    /// Argon.
    Ar,
    /// Iron.
    Fe,
    /// Calcium.
    Ca,
    /// Silicon.
    Si,
    /// Aluminium.
    Al,
    /// Magnesium.
    Mg,
    /// Sulfur.
    S,
}

impl Element {
    /// How many elements there are.
    pub const COUNT: usize = 11;
    /// All of them, in the order of every list of element amounts.
    pub const ALL: [Self; Self::COUNT] = [
        Self::H,
        Self::C,
        Self::N,
        Self::O,
        Self::Ar,
        Self::Fe,
        Self::Ca,
        Self::Si,
        Self::Al,
        Self::Mg,
        Self::S,
    ];

    /// The element of a symbol in capital or small letters, `AR` or `Ar`; `None` where it is none of these.
    pub fn by_symbol(symbol: &str) -> Option<Self> {
        let own = |one: &Self| one.symbol().eq_ignore_ascii_case(symbol);
        Self::ALL.into_iter().find(own)
    }

    /// Its symbol.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::H => "H",
            Self::C => "C",
            Self::N => "N",
            Self::O => "O",
            Self::Ar => "Ar",
            Self::Fe => "Fe",
            Self::Ca => "Ca",
            Self::Si => "Si",
            Self::Al => "Al",
            Self::Mg => "Mg",
            Self::S => "S",
        }
    }

    /// Molar mass in kg/mol: the abridged standard atomic weights (Prohaska et al., Pure Appl. Chem.
    /// 94 (2022) 573, doi 10.1515/pac-2019-0603).
    pub fn molar_mass(self) -> f64 {
        match self {
            Self::H => 1.008e-3,
            Self::C => 12.011e-3,
            Self::N => 14.007e-3,
            Self::O => 15.999e-3,
            Self::Ar => 39.95e-3,
            Self::Fe => 55.845e-3,
            Self::Ca => 40.078e-3,
            Self::Si => 28.085e-3,
            Self::Al => 26.982e-3,
            Self::Mg => 24.305e-3,
            Self::S => 32.06e-3,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_has_every_element_once_in_its_own_place() {
        for (k, element) in Element::ALL.into_iter().enumerate() {
            assert_eq!(element as usize, k, "{}", element.symbol());
            let capital = element.symbol().to_ascii_uppercase();
            assert_eq!(Element::by_symbol(&capital), Some(element));
        }
        assert_eq!(Element::by_symbol("He"), None);
    }

    #[test]
    fn methane_and_air_s_gases_have_the_molar_masses_of_the_handbooks() {
        // NIST Chemistry WebBook, g/mol: CH4 16.0425, O2 31.9988, CO2 44.0095.
        let [h, c, _, o, ..] = Element::ALL.map(Element::molar_mass);
        assert!((c + 4.0 * h - 16.0425e-3).abs() < 1e-6);
        assert!((2.0 * o - 31.9988e-3).abs() < 1e-6);
        assert!((c + 2.0 * o - 44.0095e-3).abs() < 1e-6);
    }
}
