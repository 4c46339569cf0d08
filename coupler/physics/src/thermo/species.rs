//! Built-in species.

use super::Nasa7;

/// A gas species.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Species {
    /// Name.
    pub name: &'static str,
    /// Atoms of each element in a molecule.
    pub elements: &'static [(&'static str, f64)],
    /// Viscosity.
    pub viscosity: Sutherland,
    /// Heat capacity, enthalpy, entropy.
    pub thermo: Nasa7,
}

/// Sutherland's law, μ = μ₀ √(T/T₀) (1 + T_s/T₀)/(1 + T_s/T), the form A_s √T/(1 + T_s/T) of requirement
/// COR-7 with A_s from one known viscosity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sutherland {
    /// μ₀ in Pa s.
    pub viscosity: f64,
    /// T₀ in K.
    pub at: f64,
    /// T_s in K.
    pub temperature: f64,
}

const fn sutherland(viscosity: f64, at: f64, temperature: f64) -> Sutherland {
    Sutherland {
        viscosity,
        at,
        temperature,
    }
}
impl Sutherland {
    /// Dynamic viscosity in Pa s at a temperature in K.
    #[inline]
    pub fn viscosity(&self, temperature: f64) -> f64 {
        let growth = (1.0 + self.temperature / self.at) / (1.0 + self.temperature / temperature);
        self.viscosity * (temperature / self.at).sqrt() * growth
    }
}

/// Standard atomic mass of an element in kg/mol (IUPAC 2021, abridged).
pub fn atomic_mass(element: &str) -> Option<f64> {
    let grams = match element {
        "H" => 1.008,
        "C" => 12.011,
        "N" => 14.007,
        "O" => 15.999,
        "Ar" => 39.948,
        _ => return None,
    };
    Some(grams * 1e-3)
}

impl Species {
    /// Molar mass in kg/mol.
    pub fn molar_mass(&self) -> f64 {
        let one =
            |&(element, count): &(&str, f64)| count * atomic_mass(element).unwrap_or(f64::NAN);
        self.elements.iter().map(one).sum()
    }
}

/// A built-in species by its name.
pub fn species(name: &str) -> Option<&'static Species> {
    SPECIES.iter().find(|species| species.name == name)
}

/// Names of the built-in species.
pub fn species_names() -> impl Iterator<Item = &'static str> {
    SPECIES.iter().map(|species| species.name)
}

// Thermodynamics: GRI-Mech 3.0 (Smith et al., 1999), whose records are those of McBride, Gordon and
// Reno, NASA TM-4513 (1993), and of TPIS (Gurvich et al.).
// Viscosity: Sutherland's constants of White, Viscous Fluid Flow, table 1-2, as (viscosity at a
// temperature, T_s); for CH4, which is not in that table, fitted at 300 and 1000 K to Chapman and Enskog
// with σ = 3.746 Å, ε/k = 141.4 K of GRI-Mech 3.0 and the collision integral of Neufeld, Janzen and Aziz
// 1972, doi 10.1063/1.1678363 (within 0.6 % up to 1000 K, 3.3 % at 2000 K).
#[rustfmt::skip]
const SPECIES: &[Species] = &[
    Species {
        name: "N2",
        elements: &[("N", 2.0)],
        viscosity: sutherland(1.663e-5, 273.0, 107.0),
        thermo: Nasa7 {
            low: [3.53100528, -0.000123660988, -5.02999433e-07, 2.43530612e-09, -1.40881235e-12, -1046.97628, 2.96747038],
            high: [2.95257637, 0.0013969004, -4.92631603e-07, 7.86010195e-11, -4.60755204e-15, -923.948688, 5.87188762],
            middle: 1000.0,
        },
    },
    Species {
        name: "O2",
        elements: &[("O", 2.0)],
        viscosity: sutherland(1.919e-5, 273.0, 139.0),
        thermo: Nasa7 {
            low: [3.78245636, -0.00299673416, 9.84730201e-06, -9.68129509e-09, 3.24372837e-12, -1063.94356, 3.65767573],
            high: [3.28253784, 0.00148308754, -7.57966669e-07, 2.09470555e-10, -2.16717794e-14, -1088.45772, 5.45323129],
            middle: 1000.0,
        },
    },
    Species {
        name: "Ar",
        elements: &[("Ar", 1.0)],
        viscosity: sutherland(2.125e-5, 273.0, 144.0),
        thermo: Nasa7 {
            low: [2.5, 0.0, 0.0, 0.0, 0.0, -745.375, 4.366],
            high: [2.5, 0.0, 0.0, 0.0, 0.0, -745.375, 4.366],
            middle: 1000.0,
        },
    },
    Species {
        name: "CO2",
        elements: &[("C", 1.0), ("O", 2.0)],
        viscosity: sutherland(1.370e-5, 273.0, 222.0),
        thermo: Nasa7 {
            low: [2.35677352, 0.00898459677, -7.12356269e-06, 2.45919022e-09, -1.43699548e-13, -48371.9697, 9.90105222],
            high: [3.85746029, 0.00441437026, -2.21481404e-06, 5.23490188e-10, -4.72084164e-14, -48759.166, 2.27163806],
            middle: 1000.0,
        },
    },
    Species {
        name: "H2O",
        elements: &[("H", 2.0), ("O", 1.0)],
        viscosity: sutherland(1.12e-5, 350.0, 1064.0),
        thermo: Nasa7 {
            low: [4.19864056, -0.0020364341, 6.52040211e-06, -5.48797062e-09, 1.77197817e-12, -30293.7267, -0.849032208],
            high: [3.03399249, 0.00217691804, -1.64072518e-07, -9.7041987e-11, 1.68200992e-14, -30004.2971, 4.9667701],
            middle: 1000.0,
        },
    },
    Species {
        name: "CO",
        elements: &[("C", 1.0), ("O", 1.0)],
        viscosity: sutherland(1.657e-5, 273.0, 136.0),
        thermo: Nasa7 {
            low: [3.57953347, -0.00061035368, 1.01681433e-06, 9.07005884e-10, -9.04424499e-13, -14344.086, 3.50840928],
            high: [2.71518561, 0.00206252743, -9.98825771e-07, 2.30053008e-10, -2.03647716e-14, -14151.8724, 7.81868772],
            middle: 1000.0,
        },
    },
    Species {
        name: "H2",
        elements: &[("H", 2.0)],
        viscosity: sutherland(8.411e-6, 273.0, 97.0),
        thermo: Nasa7 {
            low: [2.34433112, 0.00798052075, -1.9478151e-05, 2.01572094e-08, -7.37611761e-12, -917.935173, 0.683010238],
            high: [3.3372792, -4.94024731e-05, 4.99456778e-07, -1.79566394e-10, 2.00255376e-14, -950.158922, -3.20502331],
            middle: 1000.0,
        },
    },
    Species {
        name: "CH4",
        elements: &[("C", 1.0), ("H", 4.0)],
        viscosity: sutherland(1.145009e-5, 300.0, 161.289),
        thermo: Nasa7 {
            low: [5.14987613, -0.0136709788, 4.91800599e-05, -4.84743026e-08, 1.66693956e-11, -10246.6476, -4.64130376],
            high: [0.074851495, 0.0133909467, -5.73285809e-06, 1.22292535e-09, -1.0181523e-13, -9468.34459, 18.437318],
            middle: 1000.0,
        },
    },

];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn molar_masses_are_those_of_the_tables() {
        for (name, grams) in [
            ("N2", 28.014),
            ("O2", 31.998),
            ("CO2", 44.009),
            ("H2O", 18.015),
        ] {
            let found = species(name).unwrap().molar_mass();
            assert!((found - grams * 1e-3).abs() < 1e-9, "{name}: {found}");
        }
    }

    #[test]
    fn viscosities_agree_with_measured_ones() {
        // NIST, Pa s at 1 atm: 300 K and 600 K; White states 2 to 4 % for his constants.
        for (name, cold, hot) in [
            ("N2", 17.9e-6, 29.6e-6),
            ("O2", 20.6e-6, 34.7e-6),
            ("CO2", 15.0e-6, 28.0e-6),
            ("H2", 8.94e-6, 14.4e-6),
            ("CH4", 11.1e-6, 19.4e-6),
            ("Ar", 22.7e-6, 38.9e-6),
        ] {
            let law = species(name).unwrap().viscosity;
            for (t, expected) in [(300.0, cold), (600.0, hot)] {
                let found = law.viscosity(t);
                assert!(
                    (found / expected - 1.0).abs() < 0.045,
                    "{name} {t}: {found:e}"
                );
            }
        }
    }
}
