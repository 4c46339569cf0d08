//! What a generated OpenFOAM case says of reactions of the gas: a mechanism as OpenFOAM's own chemistry has it.
//!
//! calcineGasFoam gives it a thermophysical model of its own, of the phase `chemistry`.

use std::fmt::Write;

use calcine_coupler::gas_chemistry::{Combustion, ReactingGas};
use calcine_coupler::physics::gas::GAS_CONSTANT;
use calcine_coupler::physics::kinetics::MechanismReaction;
use calcine_coupler::physics::kinetics::RateConstant;
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::GasSetup;
use thiserror::Error;

use super::foam_file::{field, header, zero_gradient};

/// A reaction that OpenFOAM's chemistry cannot take.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum UnsupportedReaction {
    /// A pressure-dependent rate.
    #[error(
        "the reaction \"{reaction}\" has a rate between a low and a high pressure limit, which Calcine does not hand \
         over to OpenFOAM; use the native gas"
    )]
    Falloff {
        /// Its name.
        reaction: String,
    },
    /// An order of a species that stands on the other side, or nowhere.
    #[error(
        "the rate of the reaction \"{reaction}\" {way} is of order {order} in {species}, and OpenFOAM knows orders of \
         a side's own species alone, zero or above; use the native gas, or state another order"
    )]
    Order {
        /// Its name.
        reaction: String,
        /// "forth" or "back".
        way: &'static str,
        /// The order.
        order: f64,
        /// The species.
        species: String,
    },
}

/// The files of a gas that reacts, by their paths in the case.
pub fn files(
    setup: &GasSetup,
    mixture: &Mixture,
    gas: &ReactingGas,
) -> Result<Vec<(&'static str, String)>, UnsupportedReaction> {
    // What species without fields of their own start from: OpenFOAM brings their sum to one, calcineGasFoam sets them.
    let about = ("volScalarField", "Ydefault", "[0 0 0 0 0 0 0]", "1");
    Ok(vec![
        (
            "constant/thermophysicalProperties.chemistry",
            thermophysical(),
        ),
        ("constant/thermo.chemistry", species(mixture)),
        (
            "constant/reactions",
            reactions(mixture, gas.mechanism.steps())?,
        ),
        (
            "constant/chemistryProperties.chemistry",
            properties(mixture, gas),
        ),
        (
            "0/Ydefault.chemistry",
            field(about, setup, |_| zero_gradient()),
        ),
    ])
}

fn thermophysical() -> String {
    header("dictionary", "thermophysicalProperties.chemistry")
        + "thermoType\n{\n    type            hePsiThermo;\n    mixture         reactingMixture;\n    \
           transport       sutherland;\n    thermo          janaf;\n    energy          sensibleEnthalpy;\n    \
           equationOfState perfectGas;\n    specie          specie;\n}\n\n\
           chemistryReader foamChemistryReader;\n\
           foamChemistryFile \"$FOAM_CASE/constant/reactions\";\n\
           foamChemistryThermoFile \"$FOAM_CASE/constant/thermo.chemistry\";\n"
}

// Numbers are written with `e`, which prints the shortest digits that read back to the same bits.
// Writing into a String cannot fail, so the results of write! below carry nothing.

fn species(mixture: &Mixture) -> String {
    let mut text = header("dictionary", "thermo.chemistry");
    for one in mixture.species() {
        let polynomial = one.polynomial();
        let (lowest, highest) = polynomial.range();
        let [low, high] = polynomial.coefficients().map(|list| {
            let words: Vec<_> = list.iter().map(|a| format!("{a:e}")).collect();
            format!("({})", words.join(" "))
        });
        let viscosity = one.sutherland();
        let _ = write!(
            text,
            "{}\n{{\n    specie {{ molWeight {:e}; }}\n    thermodynamics\n    {{\n        Tlow {lowest:e}; Tcommon \
             {:e}; Thigh {highest:e};\n        lowCpCoeffs {low};\n        highCpCoeffs {high};\n    }}\n    transport \
             {{ As {:e}; Ts {:e}; }}\n}}\n\n",
            one.name(),
            one.molar_mass() * 1e3,
            polynomial.common_temperature(),
            viscosity.coefficient,
            viscosity.temperature
        );
    }
    text
}

/// What calcineGasFoam's chemistry model, OpenFOAM's with rates that go on to where a reactant ends, integrates with and over.
fn properties(mixture: &Mixture, gas: &ReactingGas) -> String {
    let mut text = header("dictionary", "chemistryProperties.chemistry");
    let (relative, negligible) = (gas.tolerances.relative, gas.tolerances.negligible);
    let (fraction, steps) = (gas.tolerances.fraction, gas.tolerances.steps);
    let _ = write!(
        text,
        "chemistry       on;\n\
         // What each integration tries first is the span of the window.\ninitialChemicalTimeStep 1e-7;\n\
         // Change of a mass fraction over that span below which nothing reacts.\nnegligible      {negligible:e};\n\nodeCoeffs\n{{\n    solver          rodas34;\n    \
         absTol          {fraction:e};\n    relTol          {relative:e};\n    maxSteps        {steps};\n}}\n"
    );
    text += "\n// Mass of each element in a unit mass of each species, in the order of calcineGasFoam's own.\nelementShares\n(\n";
    for (element, shares) in mixture.elements() {
        let shares: Vec<_> = shares.iter().map(|share| format!("{share:e}")).collect();
        let _ = writeln!(text, "    ({}) // {element}", shares.join(" "));
    }
    text += ");\n";
    if let Combustion::Pasr { mixing_constant } = gas.combustion {
        let _ = write!(
            text,
            "\n// Of the partially stirred reactor.\nmixingConstant  {mixing_constant:e};\n"
        );
    }
    text
}

fn reactions(
    mixture: &Mixture,
    steps: &[MechanismReaction],
) -> Result<String, UnsupportedReaction> {
    let mut text = header("dictionary", "reactions");
    let _ = write!(
        text,
        "// kmol, m^3, s, K.\nspecies ({});\n\nreactions\n{{\n",
        mixture.names().join(" ")
    );
    for (i, step) in steps.iter().enumerate() {
        text += &reaction(i + 1, step, mixture.names())?;
    }
    Ok(text + "}\n")
}

/// A reaction as a dictionary.
fn reaction(
    number: usize,
    step: &MechanismReaction,
    names: &[String],
) -> Result<String, UnsupportedReaction> {
    let RateConstant::Arrhenius(law) = &step.rate else {
        return Err(UnsupportedReaction::Falloff {
            reaction: step.name.clone(),
        });
    };
    let left = side(step, "forth", &step.left, &step.orders, names)?;
    // A reaction that goes one way has no rate back.
    let back = step.back.as_ref().unwrap_or(&step.right);
    let right = side(step, "back", &step.right, back, names)?;
    let way = match step.back {
        Some(_) => "reversible",
        None => "irreversible",
    };
    let body = match step.collider {
        Some(_) => "ThirdBody",
        None => "",
    };
    // A third body counts as one more order.
    let bodies = f64::from(u8::from(step.collider.is_some()));
    let order: f64 = step.orders.iter().map(|(_, order)| order).sum();
    let factor = law.factor * 1000f64.powf(order + bodies - 1.0);
    let mut text = format!(
        "    // {}\n    r{number}\n    {{\n        type            {way}{body}ArrheniusReaction;\n        \
         reaction        \"{left} = {right}\";\n        A               {factor:e};\n        \
         beta            {:e};\n        Ta              {:e};\n",
        step.name,
        law.exponent,
        law.activation_energy / GAS_CONSTANT
    );
    if let Some(efficiencies) = &step.collider {
        let all = names.iter().zip(efficiencies);
        let all: Vec<_> = all.map(|(name, e)| format!("({name} {e:e})")).collect();
        let _ = writeln!(text, "        coeffs          ({});", all.join(" "));
    }
    Ok(text + "    }\n")
}

/// A side of an equation with its orders, as OpenFOAM writes it: `0.5O2^1.25`.
fn side(
    step: &MechanismReaction,
    way: &'static str,
    side: &[(usize, f64)],
    orders: &[(usize, f64)],
    names: &[String],
) -> Result<String, UnsupportedReaction> {
    let of = |list: &[(usize, f64)], k: usize| {
        let own = list.iter().find(|(other, _)| *other == k);
        own.map_or(0.0, |(_, number)| *number)
    };
    for &(k, order) in orders {
        if order < 0.0 || (of(side, k) == 0.0 && order != 0.0) {
            return Err(UnsupportedReaction::Order {
                reaction: step.name.clone(),
                way,
                order,
                species: names[k].clone(),
            });
        }
    }
    let term = |&(k, number): &(usize, f64)| {
        let (name, order) = (&names[k], of(orders, k));
        let coefficient = match number == 1.0 {
            true => String::new(),
            false => number.to_string(),
        };
        match order == number {
            true => format!("{coefficient}{name}"),
            false => format!("{coefficient}{name}^{order}"),
        }
    };
    Ok(side.iter().map(term).collect::<Vec<_>>().join(" + "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_coupler::physics::kinetics::Mechanism;

    fn mixture() -> Mixture {
        Mixture::new(["CH4", "O2", "CO", "H2", "H2O", "CO2", "N2"]).unwrap()
    }

    fn texts(steps: &[MechanismReaction]) -> Vec<String> {
        let one = |step: &MechanismReaction| reaction(1, step, mixture().names()).unwrap();
        steps.iter().map(one).collect()
    }

    fn number(text: &str, key: &str) -> f64 {
        let mut lines = text.lines().map(str::trim);
        let line = lines.find(|line| line.starts_with(key)).unwrap();
        let value = line.trim_end_matches(';').split_whitespace().nth(1);
        value.unwrap().parse().unwrap()
    }

    #[test]
    fn the_refined_steps_are_those_of_the_table_in_kmol() {
        let mechanism = Mechanism::jones_lindstedt(&mixture()).unwrap();
        let texts = texts(mechanism.steps());
        for (text, equation, factor, temperature) in [
            (
                &texts[0],
                "CH4^0.5 + 0.5O2^1.25 = CO + 2H2",
                4.4e11,
                15_154.0,
            ),
            (&texts[1], "CH4 + H2O = CO + 3H2", 3.0e8, 15_154.0),
            (&texts[2], "H2 + 0.5O2 = H2O", 5.69e11, 17_620.0),
            (&texts[3], "CO + H2O = CO2 + H2", 2.75e9, 10_055.0),
        ] {
            assert!(text.contains(&format!("\"{equation}\"")), "{text}");
            assert!((number(text, "A ") / factor - 1.0).abs() < 1e-12, "{text}");
            // E/R of the table's J/kmol by hand, to its digits.
            assert!(
                (number(text, "Ta") / temperature - 1.0).abs() < 1e-4,
                "{text}"
            );
        }
        assert!(texts[0].contains("irreversibleArrheniusReaction"));
        assert!(texts[2].contains(" reversibleArrheniusReaction"));
    }

    #[test]
    fn an_order_of_the_other_side_is_refused_with_its_reaction() {
        // Back, the original third step is of order 0.25 − 1 in H2.
        let mechanism = Mechanism::jones_lindstedt_original(&mixture()).unwrap();
        let error = reactions(&mixture(), mechanism.steps()).unwrap_err();
        let words = error.to_string();
        assert!(words.contains("H2 + 0.5 O2 <=> H2O"), "{words}");
        assert!(words.contains("back is of order -0.75 in H2"), "{words}");
    }

    #[test]
    fn a_third_body_is_one_more_order_and_names_every_species() {
        let mechanism = Mechanism::jones_lindstedt(&mixture()).unwrap();
        let mut steps = mechanism.steps()[3..].to_vec();
        let plain = number(&texts(&steps)[0], "A ");
        steps[0].collider = Some(vec![1.0, 1.0, 1.0, 1.0, 6.0, 1.0, 1.0]);
        let text = &texts(&steps)[0];
        assert!(text.contains(" reversibleThirdBodyArrheniusReaction"));
        assert!(
            text.contains("(CH4 1e0)") && text.contains("(H2O 6e0)"),
            "{text}"
        );
        assert!((number(text, "A ") / plain / 1e3 - 1.0).abs() < 1e-12);
    }
}
