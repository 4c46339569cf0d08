//! CHEMKIN's thermodynamics: NASA's seven coefficients in fixed columns.

use calcine_coupler::physics::thermo::{Element, Nasa7};

use super::fault::{Fault, fault};
use super::file::Thermo;
use crate::fortran;

/// Columns of the elements on the first card.
const ELEMENTS: [(usize, usize); 5] = [(24, 29), (29, 34), (34, 39), (39, 44), (73, 78)];

/// Reads the cards of a file of thermodynamics, or of the section THERMO of a mechanism, whose first line follows
/// `section` lines above.
pub fn parse(text: &str, section: Option<usize>) -> Result<Vec<Thermo>, Fault> {
    let before = section.unwrap_or(0);
    let lines = text
        .lines()
        .enumerate()
        .map(|(k, line)| (before + k + 1, line));
    let mut common = None;
    let mut found = Vec::new();
    let mut cards: Vec<(usize, &str)> = Vec::new();
    for (number, line) in lines {
        let bare = line.split('!').next().unwrap_or("").trim_end();
        let upper = bare.trim().to_ascii_uppercase();
        if upper.is_empty() || upper.starts_with("THERMO") {
            continue;
        }
        if upper == "END" {
            break;
        }
        let temperatures = temperatures(bare);
        if cards.is_empty() && temperatures.is_some() && common.is_none() {
            common = temperatures;
            continue;
        }
        cards.push((number, line));
        if cards.len() < 4 {
            continue;
        }
        if let Some(thermo) = species(&cards, common)? {
            found.push(thermo);
        }
        cards.clear();
    }
    match cards.first() {
        Some((line, _)) => fault(*line, "a species has not four lines of thermodynamics"),
        None => Ok(found),
    }
}

/// The common temperature of a line of three temperatures.
fn temperatures(line: &str) -> Option<f64> {
    let numbers: Option<Vec<f64>> = line
        .split_whitespace()
        .map(|word| word.parse().ok().filter(|number: &f64| number.is_finite()))
        .collect();
    match numbers?[..] {
        [_, common, _] => Some(common),
        _ => None,
    }
}

/// Characters of a card; columns beyond its end are empty.
fn columns(card: &str, from: usize, to: usize) -> String {
    card.chars().skip(from).take(to - from).collect()
}

/// A number of a species that is read for this.
pub(super) fn number(text: &str, line: usize, name: &str, what: &str) -> Result<f64, Fault> {
    // Blanks stand within numbers such as "1.0E 02".
    let bare: String = text.chars().filter(|c| !c.is_whitespace()).collect();
    match fortran::number(&bare) {
        Some(number) => Ok(number),
        None => fault(
            line,
            format!("{name} has \"{text}\" for {what}, which is not a number"),
        ),
    }
}

/// A species of four cards; `None` where it has elements that Calcine does not have.
fn species(cards: &[(usize, &str)], common: Option<f64>) -> Result<Option<Thermo>, Fault> {
    let (line, first) = cards[0];
    let name = columns(first, 0, 18);
    let Some(name) = name.split_whitespace().next().map(str::to_owned) else {
        return fault(line, "a species without name");
    };
    for (k, (line, card)) in cards.iter().enumerate() {
        let digit = columns(card, 79, 80);
        if digit != (k + 1).to_string() {
            return fault(
                *line,
                format!("{name} has \"{digit}\" in column 80, not {}", k + 1),
            );
        }
    }
    let mut atoms = [0.0; Element::COUNT];
    for (from, to) in ELEMENTS {
        let symbol = columns(first, from, from + 2);
        let symbol = symbol.trim();
        let count = columns(first, from + 2, to);
        if symbol.is_empty() || symbol == "0" || ["", "0", "0."].contains(&count.trim()) {
            continue;
        }
        let Some(element) = Element::by_symbol(symbol) else {
            return Ok(None);
        };
        atoms[element as usize] += number(&count, line, &name, "a number of atoms")?;
    }
    if columns(first, 44, 45).trim() != "G" {
        return Ok(None);
    }
    let lowest = number(
        &columns(first, 45, 55),
        line,
        &name,
        "the lowest temperature",
    )?;
    let highest = number(
        &columns(first, 55, 65),
        line,
        &name,
        "the highest temperature",
    )?;
    let middle = columns(first, 65, 73);
    let middle = match (middle.trim(), common) {
        ("", Some(common)) => common,
        _ => number(&middle, line, &name, "the common temperature")?,
    };
    let mut all = [0.0; 15];
    for (k, value) in all.iter_mut().enumerate().take(14) {
        let (line, card) = cards[1 + k / 5];
        let from = 15 * (k % 5);
        *value = number(
            &columns(card, from, from + 15),
            line,
            &name,
            "a coefficient",
        )?;
    }
    let seven = |from: usize| -> [f64; 7] {
        let mut row = [0.0; 7];
        row.copy_from_slice(&all[from..from + 7]);
        // CHEMKIN's standard pressure is 1 atm: to the entropy at 1 bar.
        row[6] += 1.013_25_f64.ln();
        row
    };
    let polynomial = Nasa7::new([lowest, middle, highest], seven(7), seven(0))
        .map_err(|error| (Some(line), format!("{name}: {error}")))?;
    Ok(Some(Thermo {
        name,
        line,
        atoms,
        polynomial,
        potential: None,
    }))
}
