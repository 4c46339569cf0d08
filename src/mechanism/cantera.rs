//! Cantera's YAML: species with NASA's seven coefficients; elementary, three-body and falloff reactions (Lindemann, Troe).

use calcine_coupler::physics::kinetics::{Broadening, Collider, RateConstant, ReactionStatement};
use calcine_coupler::physics::reaction::{Arrhenius, Equation};
use calcine_coupler::physics::thermo::{Element, LennardJones, Nasa7};

use super::equation::{self, ThirdBody};
use super::fault::{Fault, fault};
use super::file::{self, MechanismFile, ParsedReaction, Thermo};
use super::units::{self, MechanismUnits};
use super::yaml::{self, YamlNode, YamlValue};
use crate::fortran;

/// Keys of every reaction that are read.
const REACTION: &[&str] = &[
    "equation",
    "type",
    "efficiencies",
    "default-efficiency",
    "orders",
    "nonreactant-orders",
    "negative-orders",
    "negative-A",
    "duplicate",
    "id",
    "note",
];
/// Keys of a falloff besides.
const FALLOFF: &[&str] = &["low-P-rate-constant", "high-P-rate-constant", "Troe"];
/// Keys of every other reaction besides.
const ONE_RATE: &[&str] = &["rate-constant"];

/// Reads a file.
pub fn parse(text: &str) -> Result<MechanismFile, Fault> {
    let root = yaml::parse(text)?;
    root.map("the file")?;
    let units = match root.get("units") {
        Some(node) => self::units(node)?,
        None => MechanismUnits::CANTERA,
    };
    let mut file = MechanismFile {
        thermo: species(&root)?,
        ..MechanismFile::default()
    };
    for (name, node) in root.map("the file")? {
        // Phases may name lists of reactions of their own.
        if name.ends_with("reactions") {
            for one in node.list("reactions")? {
                file.reactions.push(reaction(one, &units)?);
            }
        }
    }
    Ok(file)
}

/// Reads the species of a file, whatever its reactions are.
pub fn parse_species(text: &str) -> Result<Vec<Thermo>, Fault> {
    let root = yaml::parse(text)?;
    root.map("the file")?;
    species(&root)
}

fn species(root: &YamlNode) -> Result<Vec<Thermo>, Fault> {
    let Some(species) = root.get("species") else {
        return Ok(Vec::new());
    };
    let all = species.list("species")?.iter();
    all.filter_map(|node| thermo(node).transpose()).collect()
}

fn units(node: &YamlNode) -> Result<MechanismUnits, Fault> {
    let mut made = MechanismUnits::CANTERA;
    let mut energy = None;
    for (key, value) in node.map("units")? {
        let name = value.text(key)?;
        let found = match key.as_str() {
            "length" => units::length(name).map(|unit| made.length = unit),
            "time" => units::time(name).map(|unit| made.time = unit),
            "quantity" => units::quantity(name).map(|unit| made.quantity = unit),
            "activation-energy" => units::activation_energy(name).map(|unit| energy = Some(unit)),
            // Of nothing that is read.
            "mass" | "pressure" | "energy" | "temperature" | "current" => Some(()),
            _ => None,
        };
        if found.is_none() {
            return fault(value.line, format!("units: {key} in {name} is not read"));
        }
    }
    match energy {
        Some(unit) => made.activation_energy = unit,
        None if node.get("energy").is_some() || node.get("quantity").is_some() => {
            // Cantera's rule: energy over quantity.
            let energy = node
                .get("energy")
                .map_or(Ok("J"), |node| node.text("energy"))?;
            let joules = units::activation_energy(&format!("{energy}/mol"));
            let Some(joules) = joules else {
                return fault(node.line, format!("units: energy in {energy} is not read"));
            };
            made.activation_energy = joules / made.quantity;
        }
        None => {}
    }
    Ok(made)
}

/// Thermodynamics of a species; `None` where it has elements that Calcine does not have.
fn thermo(node: &YamlNode) -> Result<Option<Thermo>, Fault> {
    let name = node.required("name", "a species")?.text("name")?.to_owned();
    let mut atoms = [0.0; Element::COUNT];
    for (symbol, count) in node
        .required("composition", &name)?
        .numbers("composition")?
    {
        let Some(element) = Element::by_symbol(&symbol) else {
            return Ok(None);
        };
        atoms[element as usize] += count;
    }
    let thermo = node.required("thermo", &name)?;
    let model = thermo.required("model", &name)?;
    let model_name = model.text("model")?;
    if model_name != "NASA7" {
        return fault(
            model.line,
            format!("{name} has a thermo model {model_name}, which is not read; NASA7 is"),
        );
    }
    let mut range = Vec::new();
    let ranges = thermo.required("temperature-ranges", &name)?;
    for one in ranges.list("temperature-ranges")? {
        range.push(one.number("temperature-ranges")?);
    }
    let data = thermo.required("data", &name)?;
    let mut rows = Vec::new();
    for row in data.list("data")? {
        let numbers = row.list("data")?.iter().map(|one| one.number("data"));
        let numbers = numbers.collect::<Result<Vec<f64>, Fault>>()?;
        let Ok(seven) = <[f64; 7]>::try_from(numbers) else {
            return fault(row.line, format!("{name} has not seven coefficients"));
        };
        rows.push(seven);
    }
    let (range, low, high) = match (&range[..], &rows[..]) {
        (&[lowest, common, highest], &[low, high]) => ([lowest, common, highest], low, high),
        // One range: it counts as two.
        (&[lowest, highest], &[one]) => ([lowest, 0.5 * (lowest + highest), highest], one, one),
        _ => {
            let what = format!("{name} has not two ranges of temperature with their coefficients");
            return fault(data.line, what);
        }
    };
    let pressure = match thermo.get("reference-pressure") {
        Some(node) => pressure(node)?,
        None => 101_325.0,
    };
    // To the entropy at 1 bar.
    let shift = (pressure / 1e5).ln();
    let shifted = |mut row: [f64; 7]| {
        row[6] += shift;
        row
    };
    let polynomial = Nasa7::new(range, shifted(low), shifted(high));
    let polynomial = polynomial.map_err(|error| (Some(ranges.line), format!("{name}: {error}")))?;
    Ok(Some(Thermo {
        name,
        line: node.line,
        atoms,
        polynomial,
        potential: potential(node)?,
    }))
}

/// Transport data of a species, σ in Å and ε/k in K as Cantera has them.
fn potential(species: &YamlNode) -> Result<Option<LennardJones>, Fault> {
    let Some(transport) = species.get("transport") else {
        return Ok(None);
    };
    let positive = |key: &str| -> Result<f64, Fault> {
        let node = transport.required(key, "transport")?;
        match node.number(key)? {
            number if number > 0.0 => Ok(number),
            number => fault(
                node.line,
                format!("{key} is {number}, but must be positive"),
            ),
        }
    };
    Ok(Some(LennardJones {
        diameter: 1e-10 * positive("diameter")?,
        well_depth: positive("well-depth")?,
    }))
}

/// A pressure such as `1 bar` in Pa.
fn pressure(node: &YamlNode) -> Result<f64, Fault> {
    let text = node.text("reference-pressure")?;
    let (number, unit) = text.split_once(' ').unwrap_or((text, "Pa"));
    let unit = match unit.trim() {
        "Pa" => 1.0,
        "kPa" => 1e3,
        "bar" => 1e5,
        "atm" => 101_325.0,
        other => {
            return fault(
                node.line,
                format!("a reference-pressure in {other} is not read"),
            );
        }
    };
    match number.parse::<f64>() {
        Ok(number) if number > 0.0 && number.is_finite() => Ok(number * unit),
        _ => fault(
            node.line,
            format!("the reference-pressure {text} is no pressure"),
        ),
    }
}

fn reaction(node: &YamlNode, units: &MechanismUnits) -> Result<ParsedReaction, Fault> {
    let stated = node.required("equation", "a reaction")?;
    let text = stated.text("equation")?;
    let name = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let kind = node.get("type").map_or(Ok(""), |node| node.text("type"))?;
    if !["", "elementary", "Arrhenius", "three-body", "falloff"].contains(&kind) {
        return fault(
            node.line,
            format!(
                "{name} is of the type {kind}, which is not read; elementary, three-body and falloff are"
            ),
        );
    }
    let (equation, body) =
        equation::parse(text).map_err(|what| (Some(stated.line), what.to_string()))?;
    let falloff = matches!(body, ThirdBody::Falloff(_));
    if (kind == "falloff") != falloff {
        return fault(
            node.line,
            format!("{name} is a falloff in one of its type and equation only"),
        );
    }
    if kind == "three-body" && body != ThirdBody::Three {
        return fault(
            node.line,
            format!("{name} is a three-body reaction without M"),
        );
    }
    let own = if falloff { FALLOFF } else { ONE_RATE };
    node.only(&[REACTION, own].concat(), &name)?;
    let stated = orders(node, &equation, &name)?;
    let orders = equation::with_orders(&equation, &stated);
    let order: f64 = orders.iter().map(|(_, n)| n).sum();
    let law = |key: &str, order: f64| -> Result<Arrhenius, Fault> {
        arrhenius(node.required(key, &name)?, units, order, &name)
    };
    let rate = if falloff {
        RateConstant::Falloff {
            high: law("high-P-rate-constant", order)?,
            low: law("low-P-rate-constant", order + 1.0)?,
            broadening: broadening(node)?,
        }
    } else {
        RateConstant::Arrhenius(law("rate-constant", order + body.bodies())?)
    };
    let negative = node.get("negative-A");
    if let RateConstant::Arrhenius(law) = &rate
        && law.factor < 0.0
        && !negative.map_or(Ok(false), |node| node.truth("negative-A"))?
    {
        return fault(
            node.line,
            format!("{name} has a negative A without negative-A"),
        );
    }
    let collider = collider(node, body, &name)?;
    let duplicate = node
        .get("duplicate")
        .map_or(Ok(false), |node| node.truth("duplicate"))?;
    Ok(ParsedReaction {
        statement: ReactionStatement {
            name,
            equation,
            orders: (!stated.is_empty()).then_some(orders),
            rate,
            collider,
        },
        line: node.line,
        duplicate,
    })
}

/// Orders that the file states.
fn orders(node: &YamlNode, equation: &Equation, name: &str) -> Result<Vec<(String, f64)>, Fault> {
    let Some(table) = node.get("orders") else {
        return Ok(Vec::new());
    };
    if equation.reversible {
        return fault(
            table.line,
            format!("{name} goes both ways and has orders, whose way back is not defined"),
        );
    }
    let flag = |key: &str| node.get(key).map_or(Ok(false), |node| node.truth(key));
    let stated = table.numbers("orders")?;
    for (species, order) in &stated {
        if *order < 0.0 && !flag("negative-orders")? {
            let what = format!("{name} has the order {order} of {species} without negative-orders");
            return fault(table.line, what);
        }
        let reacts = equation.left.iter().any(|(_, other)| other == species);
        if !reacts && !flag("nonreactant-orders")? {
            return fault(
                table.line,
                format!(
                    "{name} has an order of {species}, which does not react, without nonreactant-orders"
                ),
            );
        }
    }
    Ok(stated)
}

fn arrhenius(
    node: &YamlNode,
    units: &MechanismUnits,
    order: f64,
    name: &str,
) -> Result<Arrhenius, Fault> {
    let (factor, exponent, energy) = match &node.value {
        YamlValue::Map(_) => {
            node.only(&["A", "b", "Ea"], name)?;
            let of = |key| node.required(key, name);
            (of("A")?, of("b")?, of("Ea")?)
        }
        YamlValue::List(list) => match &list[..] {
            [factor, exponent, energy] => (factor, exponent, energy),
            _ => return fault(node.line, format!("{name} has not three numbers A, b, Ea")),
        },
        YamlValue::Text(_) => return fault(node.line, format!("{name} has no rate constant")),
    };
    Ok(Arrhenius {
        factor: units.factor(factor.number("A")?, order),
        exponent: exponent.number("b")?,
        activation_energy: activation_energy(energy, units)?,
    })
}

/// A number in the units of the file, or one with its own unit.
fn activation_energy(node: &YamlNode, units: &MechanismUnits) -> Result<f64, Fault> {
    let text = node.text("Ea")?;
    let Some((number, unit)) = text.trim().split_once(' ') else {
        return Ok(node.number("Ea")? * units.activation_energy);
    };
    let Some(unit) = units::activation_energy(unit.trim()) else {
        return fault(node.line, format!("Ea in {unit} is not read"));
    };
    match fortran::number(number) {
        Some(number) => Ok(number * unit),
        None => fault(
            node.line,
            format!("Ea is \"{text}\", which is not a number"),
        ),
    }
}

fn broadening(node: &YamlNode) -> Result<Broadening, Fault> {
    let Some(troe) = node.get("Troe") else {
        return Ok(Broadening::Lindemann);
    };
    troe.only(&["A", "T3", "T1", "T2"], "Troe")?;
    let of = |key: &str| troe.required(key, "Troe")?.number(key);
    let second = troe.get("T2").map(|node| node.number("T2")).transpose()?;
    Ok(file::troe([of("A")?, of("T3")?, of("T1")?], second))
}

fn collider(node: &YamlNode, body: ThirdBody, name: &str) -> Result<Option<Collider>, Fault> {
    let stated = node.get("efficiencies");
    let others = node.get("default-efficiency");
    let line = stated.or(others).unwrap_or(node).line;
    let efficiencies = stated.map_or(Ok(Vec::new()), |node| node.numbers("efficiencies"))?;
    let others = others.map(|node| node.number("default-efficiency"));
    body.collider(efficiencies, others.transpose()?)
        .map_err(|what| (Some(line), format!("{name} {what}")))
}
