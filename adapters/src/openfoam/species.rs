//! What a generated OpenFOAM case says of the species of a mixture.

use std::fmt::Write;

use calcine_coupler::physics::thermo::{Mixture, Species};
use calcine_coupler::setup::{CompositionSchedule, GasPatch, GasSetup, Schedule};

use super::foam_file::{field, fixed, header, table, zero_gradient};

// Writing into a String cannot fail, so the results of write! below carry nothing.

/// `constant/thermophysicalProperties` of a mixture: the coefficients of the coordinator's own laws, which
/// calcineGasFoam evaluates in the same way (OpenFOAM's reacting mixtures mix Sutherland coefficients, where
/// Wilke's formula mixes viscosities).
pub fn thermophysical(name: &str, mixture: &Mixture) -> String {
    let mut text = header("dictionary", "thermophysicalProperties");
    let names = mixture.names().join(" ");
    let _ = write!(
        text,
        "// {name}: NASA-7 polynomials of c_p/R and h/R in K, Sutherland's law in SI, Wilke's mixing, kg/mol.\n\
         thermoType      calcineMixture;\nspecies         ({names});\n"
    );
    for species in mixture.species() {
        let _ = write!(text, "\n{}\n{{\n{}}}\n", species.name(), entries(species));
    }
    text
}

fn entries(species: &Species) -> String {
    let polynomial = species.polynomial();
    let (lowest, highest) = polynomial.range();
    let [low, high] = polynomial.coefficients();
    let numbers = |list: &[f64; 7]| {
        let words: Vec<_> = list.iter().map(|a| format!("{a:e}")).collect();
        format!("({})", words.join(" "))
    };
    let viscosity = species.sutherland();
    let number = |value: f64| format!("{value:e}");
    let mut text = String::new();
    for (key, value) in [
        ("molarMass", number(species.molar_mass())),
        ("Tlow", number(lowest)),
        ("Tcommon", number(polynomial.common_temperature())),
        ("Thigh", number(highest)),
        ("lowCpCoeffs", numbers(low)),
        ("highCpCoeffs", numbers(high)),
        ("As", number(viscosity.coefficient)),
        ("Ts", number(viscosity.temperature)),
    ] {
        let _ = writeln!(text, "    {key:<15} {value};");
    }
    text
}

/// Tables over process time of an inlet's mass fractions, as a dictionary.
pub fn tables(composition: &CompositionSchedule, names: &[String]) -> String {
    let mut text = String::from("{");
    for (k, name) in names.iter().enumerate() {
        let one = Schedule(composition.0.iter().map(|(t, y)| (*t, y[k])).collect());
        let _ = write!(text, " {name} {};", table(&one));
    }
    text + " }"
}

/// The field of a species in `0/`.
pub fn fraction(setup: &GasSetup, k: usize, name: &str) -> String {
    let start = format!("{:e}", setup.composition.get(k).copied().unwrap_or(0.0));
    let about = ("volScalarField", name, "[0 0 0 0 0 0 0]", &*start);
    field(about, setup, |patch| match patch {
        GasPatch::Inlet {
            composition: Some(composition),
            ..
        } => fixed(&format!("{:e}", composition.at(0.0)[k])),
        _ => zero_gradient(),
    })
}
