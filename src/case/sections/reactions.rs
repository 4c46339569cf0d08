//! `[[reactions]]`, and what materials are made of.

use calcine_adapters::openfoam::stock::StockSolver;
use calcine_coupler::interior::reacting::{Rate, Reaction, SolidChemistry};
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::reaction::equilibrium::GibbsLine;
use calcine_coupler::physics::reaction::{Equation, Equilibrium, PowerLaw, RateLaw, imbalance};
use calcine_coupler::physics::solid::HeatCapacity;
use calcine_coupler::physics::solids::SolidSpecies;
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::{GasPatch, GasSetup};

use super::{drying, rate_constants};
use crate::case::model::{Laws, ReactionSpec};
use crate::case::table::TableReader;

/// How far a stated heat may be from that of the enthalpies.
const HEAT: f64 = 0.02;

/// The heat capacity of a mixture of solids, at points 50 K apart.
pub(super) fn mixed(fractions: &[f64], solids: &[SolidSpecies]) -> HeatCapacity {
    let at = |temperature: f64| {
        let parts = fractions.iter().zip(solids);
        parts
            .map(|(y, solid)| y * solid.heat_capacity(temperature))
            .sum()
    };
    let points = (4..40).map(|k| f64::from(k) * 50.0);
    HeatCapacity::table(points.map(|t| (t, at(t))).collect())
}

fn names(solids: &[SolidSpecies]) -> String {
    let names: Vec<&str> = solids.iter().map(SolidSpecies::name).collect();
    names.join(", ")
}

/// True where each reaction of the file was made.
pub(super) fn are_all(root: &TableReader<'_>, made: &[Reaction]) -> bool {
    let unread = made.is_empty() && root.has("reactions");
    !unread && root.tables("reactions").len() == made.len()
}

/// What a reaction may name.
struct Known<'a> {
    solids: &'a [SolidSpecies],
    gas: Option<&'a Mixture>,
    setup: Option<&'a GasSetup>,
}

pub(super) fn reactions(
    root: &TableReader<'_>,
    solids: &[SolidSpecies],
    setup: Option<&GasSetup>,
) -> Vec<Reaction> {
    let gas = setup.and_then(|setup| match &setup.properties {
        GasModel::Mixture(mixture) => Some(mixture),
        _ => None,
    });
    let known = Known { solids, gas, setup };
    let mut made: Vec<Reaction> = Vec::new();
    let tables = root.tables("reactions");
    for table in &tables {
        let Some(reaction) = reaction(table, &known) else {
            continue;
        };
        if made.iter().any(|other| other.name == reaction.name) {
            let rule = format!("is \"{}\" a second time", reaction.name);
            table.fail("name", rule, "names of reactions must differ");
        }
        made.push(reaction);
    }
    if made.len() == tables.len()
        && let Err(error) = SolidChemistry::new(solids.to_vec(), gas.cloned(), made.clone())
    {
        let help = "write law = \"power-law\", or change the equation";
        root.fail(
            "reactions",
            format!("make no shrinking core: {error}"),
            help,
        );
    }
    made
}

fn reaction(table: &TableReader<'_>, known: &Known<'_>) -> Option<Reaction> {
    let name = table.text("name");
    let text = table.text("equation");
    let law = table.law_here(&table.laws().rate);
    let equation = text.and_then(|text| equation(table, text, known));
    let rate = law.and_then(|law| rate(table, *law.make(), known, equation.as_ref()));
    let equation = equation.filter(|(_, parts)| {
        !parts.solids.is_empty() || rate.as_ref().is_some_and(|rate| is_catalysed(table, rate))
    });
    // Known, even where the equation could not be read.
    table.has("equilibrium");
    let equilibrium = equation
        .as_ref()
        .and_then(|(equation, parts)| equilibrium(table, equation, parts, known));
    let heat = table.number("heat");
    table.finish();
    if let Some(rate) = &rate {
        rate_constants::possible(table, rate);
    }
    let (equation, parts) = equation?;
    let made = Reaction {
        name: name?.into(),
        solids: parts.solids,
        gases: parts.gases,
        rate: rate?,
        equilibrium: equilibrium?,
    };
    if !equation.reversible && matches!(made.rate, Rate::Core { .. }) {
        let sets_free = made.gases.iter().all(|gas| gas.1 > 0.0);
        if sets_free {
            let help = "write <=>: the gas that is set free holds such a core back";
            table.fail("equation", "sets gas free and goes one way", help);
            return None;
        }
    }
    let names = known.gas.map_or(&[][..], |gas| gas.names());
    if !drying::suits(table, &made, known.solids, names) {
        return None;
    }
    heat.is_none_or(|heat| agrees(table, heat, &made, known))
        .then_some(made)
}

/// True where the rate of an equation of gases alone follows the amount of a solid, their catalyst; else an error.
fn is_catalysed(table: &TableReader<'_>, rate: &Rate) -> bool {
    let found = rate.followed_solids().next().is_some();
    if !found {
        let help = "reactions among gases alone go into [gas.chemistry]; one on a catalyst goes by law = \"power-law\", with an order above zero of its \
                    solid, such as orders = { CO = 1, Fe3O4 = 1 }";
        table.fail("equation", "has no solid, and no catalyst", help);
    }
    found
}

/// Solids and gases of an equation with what a mole of the reaction makes of each.
struct Parts {
    solids: Vec<(usize, f64)>,
    gases: Vec<(usize, f64)>,
}

fn equation(table: &TableReader<'_>, text: &str, known: &Known<'_>) -> Option<(Equation, Parts)> {
    let equation = match Equation::parse(text) {
        Ok(equation) => equation,
        Err(error) => {
            let help = "for example \"CaCO3 <=> CaO + CO2\"";
            table.fail("equation", format!("cannot be read: {error}"), help);
            return None;
        }
    };
    let mut parts = Parts {
        solids: Vec::new(),
        gases: Vec::new(),
    };
    if equation.net().iter().all(|(_, n)| *n == 0.0) {
        let help = "write what is used on the left and what is made of it on the right";
        table.fail("equation", "changes nothing", help);
        return None;
    }
    for (name, n) in equation.net() {
        let solid = known.solids.iter().position(|one| one.name() == name);
        let gas = known
            .gas
            .and_then(|gas| gas.names().iter().position(|one| *one == name));
        match (solid, gas) {
            (_, Some(k)) => parts.gases.push((k, n)),
            (Some(k), None) => parts.solids.push((k, n)),
            (None, None) => {
                let gases = known
                    .gas
                    .map_or("none".into(), |gas| gas.names().join(", "));
                let help = format!(
                    "the gases are {gases} (`gas.species`); the solids are {}",
                    names(known.solids)
                );
                let rule = format!("names {name}, which is neither a gas nor a solid of the case");
                table.fail("equation", rule, help);
                return None;
            }
        }
    }
    balanced(table, &parts, known)?;
    let last = known.gas.map_or(0, |gas| gas.names().len()).wrapping_sub(1);
    if parts.gases.iter().any(|gas| gas.0 == last) {
        let name = known.gas.map_or("", |gas| &gas.names()[last]);
        let rule = format!("has {name}, the last of `gas.species`");
        let help = "the last species is what the others leave: put one last that does not react, such as N2";
        table.fail("equation", rule, help);
        return None;
    }
    Some((equation, parts))
}

fn balanced(table: &TableReader<'_>, parts: &Parts, known: &Known<'_>) -> Option<()> {
    let off = imbalance(|element| {
        let at = element as usize;
        let solids = parts.solids.iter();
        let solids = solids.map(|&(s, n)| n * known.solids[s].atoms()[at]);
        let gases = parts.gases.iter().map(|&(g, n)| {
            known
                .gas
                .map_or(0.0, |gas| n * gas.species()[g].atoms()[at])
        });
        solids.chain(gases).sum()
    });
    let Some(off) = off else {
        return Some(());
    };
    let help = "write numbers of moles by which each element is the same on both sides";
    table.fail("equation", format!("is not balanced: {off}"), help);
    None
}

/// A law of a rate with the places of its species among those of the case.
fn rate(
    table: &TableReader<'_>,
    law: RateLaw,
    known: &Known<'_>,
    equation: Option<&(Equation, Parts)>,
) -> Option<Rate> {
    match law {
        RateLaw::ShrinkingCore {
            rate_constant,
            diffusivity,
        } => Some(Rate::Core {
            rate_constant,
            diffusivity,
        }),
        RateLaw::Evaporation(law) => Some(Rate::Evaporation(law)),
        RateLaw::Devolatilisation(law) => Some(Rate::Devolatilisation(law)),
        RateLaw::EquilibriumPressure {
            rate_constant,
            grains,
        } => Some(Rate::Grains {
            rate_constant,
            grains,
        }),
        RateLaw::Conversion {
            rate_constant,
            conversion,
            orders,
        } => {
            let [solids, gases] = match orders.is_empty() {
                true => Default::default(),
                false => placed(table, orders, known, equation)?,
            };
            if let Some((s, _)) = solids.first() {
                let help = "leave it out: the law says how the rate follows its solid";
                let rule = format!("gives {} an order", known.solids[*s].name());
                table.fail("rate", rule, help);
                return None;
            }
            Some(Rate::Conversion {
                rate_constant,
                conversion,
                gases,
            })
        }
        RateLaw::PowerLaw {
            rate_constant,
            in_series,
            orders,
        } => {
            let [solids, gases] = placed(table, orders, known, equation)?;
            Some(Rate::Power(PowerLaw {
                rate_constant,
                in_series,
                solids,
                gases,
            }))
        }
    }
}

/// Orders of solids and of gases by their places among those of the case.
fn placed(
    table: &TableReader<'_>,
    given: Vec<(String, f64)>,
    known: &Known<'_>,
    equation: Option<&(Equation, Parts)>,
) -> Option<[Vec<(usize, f64)>; 2]> {
    let orders = table.table("rate")?.table("orders")?;
    let mut made: [Vec<(usize, f64)>; 2] = Default::default();
    for (name, order) in given {
        let solid = known.solids.iter().position(|one| one.name() == name);
        let gas = known
            .gas
            .and_then(|gas| gas.names().iter().position(|one| *one == name));
        match (solid, gas) {
            (_, Some(k)) => made[1].push((k, order)),
            (Some(k), None) => made[0].push((k, order)),
            (None, None) => {
                let help = "name gases and solids of the case";
                orders.fail(&name, "is neither a gas nor a solid of the case", help);
                return None;
            }
        }
        if order < 0.0
            && let Some(why) = absent(known, gas, equation)
        {
            let rule = format!("is {order}, but {name} {why}: the rate would be infinite");
            let help =
                "write an order of zero or above, or see to it that the species is always there";
            orders.fail(&name, rule, help);
            return None;
        }
    }
    Some(made)
}

/// Where a species of a negative order may be missing.
fn absent(
    known: &Known<'_>,
    gas: Option<usize>,
    equation: Option<&(Equation, Parts)>,
) -> Option<&'static str> {
    let Some(k) = gas else {
        return Some("is a solid that may not be there");
    };
    if let Some((_, parts)) = equation
        && parts.gases.iter().any(|&(g, n)| g == k && n < 0.0)
    {
        return Some("is used up by the reaction");
    }
    let setup = known.setup?;
    lacking(k, &setup.composition, &setup.patches)
}

/// Where a gas of this index is missing at the start or flows in without it.
pub(super) fn lacking(
    k: usize,
    initial: &[f64],
    patches: &[(String, GasPatch)],
) -> Option<&'static str> {
    if initial.get(k).is_some_and(|y| *y <= 0.0) {
        return Some("is not in `gas.initial`");
    }
    let lacks = |patch: &GasPatch| match patch.entering() {
        Some((_, Some(composition))) => composition.0.iter().any(|(_, y)| y[k] <= 0.0),
        _ => false,
    };
    let (_, patch) = patches.iter().find(|(_, patch)| lacks(patch))?;
    Some(match patch {
        GasPatch::Opening { .. } => "is not in the gas of an opening",
        GasPatch::Outlet { .. } => "is not in the gas that comes back in at an outlet",
        _ => "is not in the gas of an inlet",
    })
}

fn equilibrium(
    table: &TableReader<'_>,
    equation: &Equation,
    parts: &Parts,
    known: &Known<'_>,
) -> Option<Equilibrium> {
    let given = table.table("equilibrium");
    if !equation.reversible {
        if given.is_some() {
            let help = "write <=> in the equation, or remove it";
            table.fail(
                "equilibrium",
                "stands beside an equation that goes one way",
                help,
            );
            return None;
        }
        return Some(Equilibrium::OneWay);
    }
    if let Some(line) = given {
        let constant = line.number("constant");
        let over = line.number("over_temperature");
        line.finish();
        return Some(Equilibrium::Line {
            constant: constant?,
            over_temperature: over?,
        });
    }
    let change = |temperature: f64| -> f64 {
        let solids = parts.solids.iter();
        let solids = solids.map(|&(s, n)| n * known.solids[s].gibbs_energy(temperature));
        let gases = parts.gases.iter().map(|&(g, n)| {
            known.gas.map_or(0.0, |gas| {
                n * gas.species()[g].polynomial().gibbs_energy(temperature)
            })
        });
        solids.chain(gases).sum()
    };
    Some(Equilibrium::Gibbs(GibbsLine::new(change)))
}

/// True where a stated heat is that of the enthalpies of formation.
fn agrees(table: &TableReader<'_>, heat: f64, made: &Reaction, known: &Known<'_>) -> bool {
    let gas = known.gas.cloned();
    let Ok(chemistry) = SolidChemistry::new(known.solids.to_vec(), gas, Vec::new()) else {
        return true;
    };
    heat_agrees(table, heat, chemistry.heat_of(made))
}

/// True where a stated heat in J/mol is that of the enthalpies.
pub(super) fn heat_agrees(table: &TableReader<'_>, heat: f64, own: f64) -> bool {
    if (heat - own).abs() <= HEAT * own.abs().max(1e3) {
        return true;
    }
    let rule = format!(
        "is {:.1} kJ/mol, but the enthalpies of formation give {:.1} kJ/mol at 298.15 K",
        heat / 1e3,
        own / 1e3
    );
    let help = "correct it, or remove it: heats follow from the enthalpies, taken up positive";
    table.fail("heat", rule, help);
    false
}

/// Errors where reactions do not go with the rest of the case.
pub(super) fn fits(
    root: &TableReader<'_>,
    chemistry: &ReactionSpec,
    laws: &Laws,
    solver: StockSolver,
) {
    if !chemistry.exchanges() {
        return;
    }
    if laws.mass_transfer.is_none() {
        let rule = "has no mass transfer, by which gas reaches particles that react";
        let help = "write mass_transfer = { law = \"gunn\" }: \"none\" is for cases whose reactions exchange no gas";
        root.fail("laws", rule, help);
    }
    if solver.is_stock() {
        let help = "leave `openfoam.solver` out: calcineGasFoam has sources of species";
        root.fail(
            "openfoam",
            "names a stock solver, which takes no gas from particles",
            help,
        );
    }
}
