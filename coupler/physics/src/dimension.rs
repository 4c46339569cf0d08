//! Physical dimensions, with the words and SI units in which they are stated.

use std::fmt;

/// A physical dimension: exponents of m, kg, s, K and mol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dimension(pub [i8; 5]);

macro_rules! dimensions {
    ($($name:ident = [$($e:expr),*], $words:literal, $unit:literal, $example:literal;)*) => {
        impl Dimension {
            $(#[doc = concat!("Of ", $words, ".")] pub const $name: Dimension = Dimension([$($e),*]);)*

            /// The dimension in words with its article, for messages.
            pub fn words(self) -> String {
                match self {
                    $(Dimension::$name => $words.into(),)*
                    other => format!("{other}"),
                }
            }

            /// Its SI unit; empty for a plain number.
            pub fn unit(self) -> String {
                match self {
                    $(Dimension::$name => $unit.into(),)*
                    other => format!("{other}"),
                }
            }

            /// An example of a value, for messages.
            pub fn example(self) -> &'static str {
                match self { $(Dimension::$name => $example,)* _ => "1" }
            }
        }
    };
}

dimensions! {
    NONE = [0, 0, 0, 0, 0], "a plain number", "", "0.6";
    LENGTH = [1, 0, 0, 0, 0], "a length", "m", "2 mm";
    AREA = [2, 0, 0, 0, 0], "an area", "m^2", "20 cm^2";
    TIME = [0, 0, 1, 0, 0], "a time", "s", "10 min";
    MASS = [0, 1, 0, 0, 0], "a mass", "kg", "5 mg";
    TEMPERATURE = [0, 0, 0, 1, 0], "a temperature", "K", "300 K";
    VELOCITY = [1, 0, -1, 0, 0], "a velocity", "m/s", "0.5 m/s";
    ACCELERATION = [1, 0, -2, 0, 0], "an acceleration", "m/s^2", "9.81 m/s^2";
    PRESSURE = [-1, 1, -2, 0, 0], "a pressure", "Pa", "1 atm";
    PRESSURE_GRADIENT = [-2, 1, -2, 0, 0], "a pressure gradient", "Pa/m", "1.2 Pa/m";
    DENSITY = [-3, 1, 0, 0, 0], "a density", "kg/m^3", "2500 kg/m^3";
    HEAT_CAPACITY = [2, 0, -2, -1, 0], "a specific heat capacity", "J/kg/K", "840 J/kg/K";
    CONDUCTIVITY = [1, 1, -3, -1, 0], "a thermal conductivity", "W/m/K", "1.1 W/m/K";
    VISCOSITY = [-1, 1, -1, 0, 0], "a dynamic viscosity", "Pa s", "18.5e-6 Pa s";
    MASS_FLOW = [0, 1, -1, 0, 0], "a mass flow", "kg/s", "1 kg/h";
    HEAT_FLUX = [0, 1, -3, 0, 0], "a heat flux", "W/m^2", "1 kW/m^2";
    HEAT_TRANSFER = [0, 1, -3, -1, 0], "a heat transfer coefficient", "W/m^2/K", "10 W/m^2/K";
    HEATING_RATE = [0, 0, -1, 1, 0], "a heating rate", "K/s", "5 K/min";
    ANGULAR_VELOCITY = [0, 0, -1, 0, 0], "an angular velocity", "rad/s", "3 rad/s";
    FORCE = [1, 1, -2, 0, 0], "a force", "N", "50 mN";
    STIFFNESS = [0, 1, -2, 0, 0], "a stiffness or an energy per area", "N/m", "1 kN/m";
    ENERGY = [2, 1, -2, 0, 0], "an energy", "J", "2 mJ";
    POWER = [2, 1, -3, 0, 0], "a power", "W", "10 W";
    MOLAR_MASS = [0, 1, 0, 0, -1], "a molar mass", "kg/mol", "28.96 g/mol";
    MOLAR_ENERGY = [2, 1, -2, 0, -1], "a molar energy", "J/mol", "70 kJ/mol";
    MOLAR_ENTROPY = [2, 1, -2, -1, -1], "a molar entropy", "J/mol/K", "57.6 J/mol/K";
    ENERGY_OF_MASS = [2, 0, -2, 0, 0], "an energy per mass", "m^2/s^2", "0.01 m^2/s^2";
    DIFFUSIVITY = [2, 0, -1, 0, 0], "a diffusivity", "m^2/s", "1e-5 m^2/s";
}

impl Dimension {
    /// Of permeabilities, which are areas.
    pub const PERMEABILITY: Self = Self::AREA;

    /// Of energies per area.
    pub const SURFACE_ENERGY: Self = Self::STIFFNESS;
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = ["m", "kg", "s", "K", "mol"];
        let parts: Vec<String> = names
            .iter()
            .zip(self.0)
            .filter(|(_, exponent)| *exponent != 0)
            .map(|(name, exponent)| {
                if exponent == 1 {
                    (*name).into()
                } else {
                    format!("{name}^{exponent}")
                }
            })
            .collect();
        if parts.is_empty() {
            f.write_str("no unit")
        } else {
            f.write_str(&parts.join(" "))
        }
    }
}
