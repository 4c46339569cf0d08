//! `[gas.chemistry]`: reactions of the gas with itself.

use std::path::{Path, PathBuf};

use calcine_coupler::gas_chemistry::{Combustion, GasChemistry, ReactingGas};
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::kinetics::{
    Collider, KineticsError, Mechanism, MechanismReaction, RateConstant, ReactionStatement,
    Tolerances,
};
use calcine_coupler::physics::reaction::{Arrhenius, Equation};
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::GasPatch;

use super::common::existing;
use super::rate_constants::{impossible, possible_in_gas};
use super::reactions::{heat_agrees, lacking};
use crate::case::table::{TableReader, nearest};
use crate::case::words::CombustionModel;
use crate::mechanism;

/// Gas at the start and at the boundary, in which species may be missing.
pub(super) struct Around<'a> {
    pub gas: Option<&'a GasModel>,
    /// Mass fractions at the start.
    pub initial: &'a [f64],
    pub patches: &'a [(String, GasPatch)],
}

/// What the gas does by itself, and the files that say so.
pub(super) fn chemistry(
    gas: &TableReader<'_>,
    around: &Around<'_>,
    folder: &Path,
) -> Option<(GasChemistry, Vec<PathBuf>)> {
    let Some(table) = gas.table("chemistry") else {
        return Some((GasChemistry::None, Vec::new()));
    };
    let combustion = combustion(&table);
    let tolerances = tolerances(&table);
    let named = table.has("mechanism");
    let Some(GasModel::Mixture(mixture)) = around.gas else {
        if around.gas.is_some() {
            let help = "state `gas.species`, those that do not react too";
            table.fail_whole("stands beside a single gas", help);
        }
        return None;
    };
    let found = match table.exactly_one() {
        Some("mechanism") => file(&table, mixture, folder),
        Some(_) if table.has("thermo") => {
            let help = "remove it: the case's own reactions take Calcine's thermodynamics";
            table.fail("thermo", "stands beside reactions of the case's own", help);
            None
        }
        Some(_) => reactions(&table, mixture, around).map(|made| (made, Vec::new())),
        None => None,
    };
    table.finish();
    let (mechanism, files) = found?;
    let key = if named { "mechanism" } else { "reactions" };
    if !last_rests(&table, key, &mechanism) {
        return None;
    }
    for step in mechanism.steps().iter().filter(|_| named) {
        let constants = match &step.rate {
            RateConstant::Arrhenius(constant) => vec![constant],
            RateConstant::Falloff { high, low, .. } => vec![high, low],
        };
        if let Some(what) = constants.into_iter().find_map(impossible) {
            let rule = format!("has {} with {what}", step.name);
            table.fail(key, rule, "correct the file, or the units that it states");
            return None;
        }
    }
    for step in mechanism.steps() {
        // Those of the case's own reactions are told at their orders.
        for &(k, order) in step.orders.iter().filter(|_| named) {
            if order < 0.0
                && let Some(why) = absent(k, &step.net, around)
            {
                let name = &mixture.names()[k];
                let rule = format!(
                    "has {}, whose order of {name} is {order}, but {name} {why}: the rate would be infinite",
                    step.name
                );
                table.fail(key, rule, "use a mechanism without negative orders");
                return None;
            }
        }
    }
    let reacting = ReactingGas {
        mechanism,
        tolerances,
        combustion: combustion?,
    };
    Some((GasChemistry::Reacting(Box::new(reacting)), files))
}

fn combustion(table: &TableReader<'_>) -> Option<Combustion> {
    let model: CombustionModel = table.choice("model")?;
    if model == CombustionModel::Pasr {
        return Some(Combustion::Pasr {
            mixing_constant: table.number("mixing_constant")?,
        });
    }
    if table.has("mixing_constant") {
        let help = "write model = \"pasr\", or remove it";
        table.fail("mixing_constant", "stands beside the laminar model", help);
        return None;
    }
    Some(Combustion::Laminar)
}

fn tolerances(table: &TableReader<'_>) -> Tolerances {
    let default = Tolerances::default();
    let number = |key| table.number(key);
    Tolerances {
        relative: number("tolerance").unwrap_or(default.relative),
        fraction: number("fraction_tolerance").unwrap_or(default.fraction),
        negligible: number("negligible").unwrap_or(default.negligible),
        ..default
    }
}

/// A built-in mechanism, or that of a file.
fn file(
    table: &TableReader<'_>,
    mixture: &Mixture,
    folder: &Path,
) -> Option<(Mechanism, Vec<PathBuf>)> {
    let name = table.text("mechanism")?;
    let built_in = match name {
        "jones-lindstedt" => Some(Mechanism::jones_lindstedt(mixture)),
        "jones-lindstedt-original" => Some(Mechanism::jones_lindstedt_original(mixture)),
        _ => None,
    };
    if let Some(made) = built_in {
        if table.has("thermo") {
            let help = "remove it: a built-in mechanism takes Calcine's own";
            table.fail("thermo", "stands beside a built-in mechanism", help);
        }
        return match made {
            Ok(made) => Some((made, Vec::new())),
            Err(error) => {
                let help = "add the species to `gas.species`";
                table.fail("mechanism", format!("is refused: {error}"), help);
                None
            }
        };
    }
    let known = ["jones-lindstedt", "jones-lindstedt-original"];
    if !folder.join(name).exists() && !name.contains(['/', '.']) {
        let hint = nearest(name, known.into_iter());
        let hint = hint.map_or(String::new(), |near| format!("; did you mean \"{near}\"?"));
        let help = format!(
            "built in are \"{}\"; a file of Cantera (.yaml) or CHEMKIN is named relative to the case file{hint}",
            known.join("\" and \"")
        );
        let rule = format!("is \"{name}\", which is neither built in nor a file");
        table.fail("mechanism", rule, help);
        return None;
    }
    let path = existing(table, "mechanism", folder);
    let thermo = match table.has("thermo") {
        true => Some(existing(table, "thermo", folder)?),
        false => None,
    };
    let path = path?;
    let read = mechanism::read(&path, thermo.as_deref()).and_then(|file| file.over(mixture));
    match read {
        Ok(made) => Some((made, [path].into_iter().chain(thermo).collect())),
        Err(error) => {
            let place = error.file.file_name().unwrap_or_default().to_string_lossy();
            let line = error
                .line
                .map_or(String::new(), |line| format!(", line {line}"));
            let rule = format!("is refused: {place}{line}: {}", error.what);
            let help =
                "docs/reference/case-file.md says what of Cantera's and CHEMKIN's files is read";
            table.fail("mechanism", rule, help);
            None
        }
    }
}

fn reactions(table: &TableReader<'_>, mixture: &Mixture, around: &Around<'_>) -> Option<Mechanism> {
    let tables = table.tables("reactions");
    let mut statements: Vec<ReactionStatement> = Vec::new();
    for table in &tables {
        let Some(made) = reaction(table, mixture, around) else {
            continue;
        };
        if statements.iter().any(|other| other.name == made.name) {
            let rule = format!("is \"{}\" a second time", made.name);
            table.fail("name", rule, "names of reactions must differ");
        }
        statements.push(made);
    }
    if statements.len() < tables.len() {
        return None;
    }
    match Mechanism::new(mixture, &statements) {
        Ok(made) if !statements.is_empty() => Some(made),
        Ok(_) => {
            table.fail("reactions", "is an empty list", "remove [gas.chemistry]");
            None
        }
        Err(error) => {
            let help = "correct the reactions";
            table.fail("reactions", format!("are refused: {error}"), help);
            None
        }
    }
}

/// Factor, exponent and activation energy of a rate constant.
fn arrhenius(table: &TableReader<'_>) -> Option<Arrhenius> {
    let factor = table.number("factor");
    let exponent = table.number("exponent");
    let energy = table.number("activation_energy");
    Some(Arrhenius {
        factor: factor?,
        exponent: exponent?,
        activation_energy: energy?,
    })
}

fn reaction(
    table: &TableReader<'_>,
    mixture: &Mixture,
    around: &Around<'_>,
) -> Option<ReactionStatement> {
    let name = table.text("name");
    let text = table.text("equation");
    let rate = table.table("rate");
    let (mut constant, mut orders) = (None, None);
    if let Some(rate) = &rate {
        constant = arrhenius(rate);
        if let Some(constant) = &constant {
            possible_in_gas(rate, constant);
        }
        orders = rate.by_name("orders");
        rate.finish();
    }
    let collider = match table.table("third_body") {
        Some(body) => Some(third_body(&body, mixture)?),
        None => None,
    };
    let heat = table.number("heat");
    table.finish();
    let equation = match Equation::parse(text?) {
        Ok(equation) => equation,
        Err(error) => {
            let help = "for example \"CO + H2O <=> CO2 + H2\"";
            table.fail("equation", format!("cannot be read: {error}"), help);
            return None;
        }
    };
    if equation.net().iter().all(|(_, n)| *n == 0.0) {
        let help = "write what is used on the left and what is made of it on the right";
        table.fail("equation", "changes nothing", help);
        return None;
    }
    let mut statement = ReactionStatement {
        name: name?.into(),
        equation,
        orders: None,
        rate: RateConstant::Arrhenius(constant?),
        collider,
    };
    // The equation by itself, before its orders.
    let alone = match Mechanism::new(mixture, std::slice::from_ref(&statement)) {
        Ok(alone) => alone,
        Err(error) => {
            let (key, rule, help) = statement_error(&error);
            table.fail(key, rule, help);
            return None;
        }
    };
    let net = &alone.steps().first()?.net;
    if let Some((table, numbers)) = orders {
        let numbers = numbers?;
        for (species, order) in &numbers {
            let Some(k) = mixture.names().iter().position(|one| one == species) else {
                let help = format!("the species of the gas are {}", mixture.names().join(", "));
                table.fail(species, "is no species of the gas", help);
                return None;
            };
            if *order < 0.0
                && let Some(why) = absent(k, net, around)
            {
                let rule = format!("is {order}, but {species} {why}: the rate would be infinite");
                let help = "write an order of zero or above, or see to it that the species is always there";
                table.fail(species, rule, help);
                return None;
            }
        }
        statement.orders = Some(numbers);
    }
    let species = mixture.species();
    let formation = |k: usize| species[k].formation_enthalpy() * species[k].molar_mass();
    let own: f64 = net.iter().map(|&(k, n)| n * formation(k)).sum();
    heat.is_none_or(|heat| heat_agrees(table, heat, own))
        .then_some(statement)
}

fn third_body(table: &TableReader<'_>, mixture: &Mixture) -> Option<Collider> {
    let others = table.number("others");
    let stated = table.by_name("efficiencies");
    table.finish();
    let (stated, efficiencies) = match stated {
        Some((stated, efficiencies)) => (Some(stated), efficiencies?),
        None => (None, Vec::new()),
    };
    for (species, _) in &efficiencies {
        let table = stated.as_ref()?;
        if !mixture.names().contains(species) {
            let help = format!("the species of the gas are {}", mixture.names().join(", "));
            table.fail(species, "is no species of the gas", help);
            return None;
        }
    }
    Some(Collider {
        efficiencies,
        others: others?,
    })
}

/// Where a statement of an equation, a rate that was read, and a third body is wrong, the rule, and the remedy.
fn statement_error(error: &KineticsError) -> (&'static str, String, String) {
    match error {
        KineticsError::UnknownSpecies { species, known, .. } => (
            "equation",
            format!("names {species}, which is no species of the gas"),
            format!("the species of the gas are {known} (`gas.species`)"),
        ),
        KineticsError::Unbalanced { off, .. } => (
            "equation",
            format!("is not balanced: {off}"),
            "write numbers of moles by which each element is the same on both sides".into(),
        ),
        KineticsError::Value {
            quantity, value, ..
        } => (
            "third_body",
            format!("has {quantity} of {value}"),
            "efficiencies are finite and not negative".into(),
        ),
        KineticsError::NoCollider { .. } => (
            "third_body",
            "has no gas with an efficiency above zero".into(),
            "state one above zero, or remove `third_body`".into(),
        ),
        other => (
            "equation",
            format!("is refused: {other}"),
            "correct the reaction".into(),
        ),
    }
}

/// Where a species of a negative order may be missing.
fn absent(k: usize, net: &[(usize, f64)], around: &Around<'_>) -> Option<&'static str> {
    if net.iter().any(|&(i, n)| i == k && n < 0.0) {
        return Some("is used up by the reaction");
    }
    lacking(k, around.initial, around.patches)
}

/// True where the last species, which is what the others leave, reacts in none.
fn last_rests(table: &TableReader<'_>, key: &str, mechanism: &Mechanism) -> bool {
    let last = mechanism.species() - 1;
    let reacts = |step: &&MechanismReaction| step.net.iter().any(|one| one.0 == last);
    let Some(step) = mechanism.steps().iter().find(reacts) else {
        return true;
    };
    let name = &mechanism.mixture().names()[last];
    let rule = format!("has {} with {name}, the last of `gas.species`", step.name);
    let help =
        "the last species is what the others leave: put one last that does not react, such as N2";
    table.fail(key, rule, help);
    false
}
