//! Heat and mass in and out of a run in W and g/s, as tables and as a Sankey picture.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use calcine_coupler::ledger::PRESCRIBED_HEAT;

use super::colour;
use super::number::{figure, span};
use super::page::{escape, table};
use crate::results::Summary;
use crate::results::flows::{FlowAmount, FlowSummary, PatchAmounts};

/// Ways of energy and of mass by their names in the summary, and in words.
const ENERGY: [(&str, &str); 9] = [
    ("boundary", "gas through the boundary"),
    ("particles", "particles"),
    ("gas_storage", "stored in the gas"),
    ("walls", "walls and surroundings"),
    ("sources", "sources in the gas"),
    (PRESCRIBED_HEAT, "prescribed temperatures"),
    ("reservoir", "reservoir of the held gas"),
    ("radiated", "surroundings of bodies"),
    ("body_storage", "stored in bodies"),
];
const MASS: [(&str, &str); 5] = [
    ("boundary", "gas through the boundary"),
    ("reservoir", "reservoir of the held gas"),
    ("sources", "sources of gas"),
    ("particles", "particles to gas, gas to particles"),
    ("storage", "stored as gas"),
];
/// Share of all below which a way is left out.
const NEGLIGIBLE: f64 = 1e-6;
const WIDTH: f64 = 560.0;
/// Room for the words on either side.
const WORDS: f64 = 190.0;
/// Thickness of all flows of a side together, and the least room of each for its words.
const THICK: f64 = 150.0;
const ROW: f64 = 36.0;
/// Half the width of the bar in the middle.
const BAR: f64 = 6.0;

/// A way with its mean flows.
struct Way<'a> {
    words: &'a str,
    inward: f64,
    outward: f64,
}

/// Tables and picture; empty where nothing passed.
pub(super) fn render(summary: &Summary) -> String {
    let flows = &summary.flows;
    if flows.over_s <= 0.0 {
        return String::new();
    }
    let mean = |name: &str, of: &BTreeMap<String, FlowAmount>, scale: f64| {
        let amount = of.get(name).copied().unwrap_or_default();
        [amount.inward, amount.outward].map(|sum| scale * sum / flows.over_s)
    };
    let energy = ways(&ENERGY, |name| mean(name, &flows.energy_j, 1.0));
    let mut mass = ways(&MASS, |name| mean(name, &flows.mass_kg, 1e3));
    let species = flows.species_kg.keys();
    let species: Vec<(String, [f64; 2])> = species
        .map(|name| (format!("of it {name}"), mean(name, &flows.species_kg, 1e3)))
        .collect();
    let at = usize::from(mass.first().is_some_and(|way| way.words == MASS[0].1));
    let species = species.iter().map(|(words, [inward, outward])| Way {
        words,
        inward: *inward,
        outward: *outward,
    });
    if at == 1 {
        mass.splice(1..1, species.filter(|way| way.inward + way.outward > 0.0));
    }
    let passed = &summary.passed;
    let all = |kg: f64| 1e3 * kg / flows.over_s;
    let particles = [
        ("particles from feeds", all(passed.fed.mass_kg), 0.0),
        ("particles to outlets", 0.0, all(passed.discharged.mass_kg)),
        ("particles used up", 0.0, all(passed.used_up.mass_kg)),
        ("particles lost", 0.0, all(passed.lost.mass_kg)),
    ];
    mass.extend(particles.into_iter().filter(|one| one.1 + one.2 > 0.0).map(
        |(words, inward, outward)| Way {
            words,
            inward,
            outward,
        },
    ));
    if energy.is_empty() && mass.is_empty() {
        return String::new();
    }
    format!(
        "{}{}{}{}",
        sankey(&energy),
        tabled("heat", "W", &energy),
        tabled("mass", "g/s", &mass),
        by_patch(flows)
    ) + &format!(
        "<p class=\"note\">Means over {} of process time. Enthalpy of gas counts from 298.15 K, so that only \
         differences of what the gas brings and takes are heat; energy of particles counts from the elements.</p>",
        span(flows.over_s)
    )
}

/// The ways that something passed.
fn ways<'a>(names: &[(&str, &'a str)], mean: impl Fn(&str) -> [f64; 2]) -> Vec<Way<'a>> {
    let ways = names.iter().map(|(name, words)| {
        let [inward, outward] = mean(name);
        Way {
            words,
            inward,
            outward,
        }
    });
    let ways: Vec<Way> = ways.collect();
    let most = ways.iter().map(|way| way.inward.max(way.outward));
    let least = NEGLIGIBLE * most.fold(0.0, f64::max);
    let told = |way: &Way| way.inward.max(way.outward) > least;
    ways.into_iter().filter(told).collect()
}

/// A figure, or a dash for nothing.
fn number(value: f64) -> String {
    if value == 0.0 {
        "–".into()
    } else {
        figure(value, 4)
    }
}

/// What passed each patch: gas, each of its species, heat; without what is negligible beside the most of its kind.
fn by_patch(flows: &FlowSummary) -> String {
    let least = |of: fn(&PatchAmounts) -> FlowAmount| {
        let amounts = flows.patches.iter().map(of);
        let largest = amounts.map(|one| one.inward.max(one.outward));
        NEGLIGIBLE * largest.fold(0.0, f64::max)
    };
    let (mass, heat) = (least(|one| one.mass_kg), least(|one| one.heat_j));
    let shown = |amount: &FlowAmount, least: f64, unit: f64| {
        let told = |sum: f64| if sum > least { sum } else { 0.0 };
        [amount.inward, amount.outward].map(|sum| unit * told(sum) / flows.over_s)
    };
    let mut rows: Vec<Vec<String>> = Vec::new();
    for one in &flows.patches {
        let (gas, warmth) = (
            shown(&one.mass_kg, mass, 1e3),
            shown(&one.heat_j, heat, 1.0),
        );
        if [gas, warmth].concat().iter().all(|value| *value == 0.0) {
            continue;
        }
        let mut row = vec![format!("<code>{}</code>", escape(&one.patch))];
        row.extend([gas, warmth].concat().into_iter().map(number));
        rows.push(row);
        for (name, amount) in &one.species_kg {
            let [inward, outward] = shown(amount, mass, 1e3);
            if inward + outward > 0.0 {
                let words = format!("of it {}", escape(name));
                rows.push(vec![
                    words,
                    number(inward),
                    number(outward),
                    String::new(),
                    String::new(),
                ]);
            }
        }
    }
    if rows.is_empty() {
        return String::new();
    }
    let head = [
        "patch",
        "#gas in, g/s",
        "#gas out, g/s",
        "#heat in, W",
        "#heat out, W",
    ];
    format!(
        "<h3>By patch</h3>{}<p class=\"note\">Net of each window; heat flows with the gas and by conduction.</p>",
        table(&head, &rows)
    )
}

fn tabled(what: &str, unit: &str, ways: &[Way<'_>]) -> String {
    let [inward, outward] = [format!("#in, {unit}"), format!("#out, {unit}")];
    let rows: Vec<Vec<String>> = ways
        .iter()
        .map(|way| vec![escape(way.words), number(way.inward), number(way.outward)])
        .collect();
    table(&[what, &inward, &outward], &rows)
}

/// What comes in on the left, what goes out on the right.
fn sankey(ways: &[Way<'_>]) -> String {
    let sides = [
        ways.iter()
            .map(|way| (way.words, way.inward))
            .collect::<Vec<_>>(),
        ways.iter().map(|way| (way.words, way.outward)).collect(),
    ];
    let total = sides
        .iter()
        .map(|side| side.iter().map(|one| one.1).sum::<f64>())
        .fold(0.0, f64::max);
    let thick = |value: f64| THICK * value / total;
    // Thin flows stand in the table alone.
    let sides = sides.map(|side| {
        let seen = side.into_iter().filter(|one| one.1 > 1e-3 * total);
        seen.collect::<Vec<_>>()
    });
    if total <= 0.0 || sides.iter().any(Vec::is_empty) {
        return String::new();
    }
    let rooms = sides.each_ref().map(|side| {
        let rooms = side.iter().map(|one| ROW.max(thick(one.1) + 8.0));
        rooms.sum::<f64>()
    });
    let height = rooms.iter().copied().fold(THICK, f64::max) + 8.0;
    let middle = WIDTH / 2.0;
    let mut svg = format!(
        "<figure class=\"sankey\"><figcaption>Heat in and out</figcaption>\
         <svg viewBox=\"0 0 {WIDTH} {height:.0}\" role=\"img\" aria-label=\"Heat in and out\">"
    );
    for (number, side) in sides.iter().enumerate() {
        let left = number == 0;
        let edge = if left { WORDS } else { WIDTH - WORDS };
        let bar = middle + if left { -BAR } else { BAR };
        let all: f64 = side.iter().map(|one| thick(one.1)).sum();
        let (mut row, mut at) = ((height - rooms[number]) / 2.0, (height - all) / 2.0);
        for (words, value) in side {
            let (room, wide) = (ROW.max(thick(*value) + 8.0), thick(*value).max(0.8));
            let (from, to) = (row + (room - wide) / 2.0, at);
            let (from_end, to_end) = (from + wide, to + wide);
            let place = ENERGY.iter().position(|one| one.1 == *words).unwrap_or(0);
            let half = (edge + bar) / 2.0;
            let (anchor, x) = if left {
                ("end", edge - 8.0)
            } else {
                ("start", edge + 8.0)
            };
            // Writing to a String cannot fail.
            let _ = write!(
                svg,
                "<path fill=\"{}\" fill-opacity=\".55\" d=\"M{edge:.1} {from:.1}C{half:.1} {from:.1} {half:.1} {to:.1} {bar:.1} {to:.1}\
                 V{to_end:.1}C{half:.1} {to_end:.1} {half:.1} {from_end:.1} {edge:.1} {from_end:.1}Z\"/>\
                 <text text-anchor=\"{anchor}\" x=\"{x:.1}\" y=\"{:.1}\">{}</text>\
                 <text class=\"label\" text-anchor=\"{anchor}\" x=\"{x:.1}\" y=\"{:.1}\">{}</text>",
                colour::line(place),
                row + room / 2.0 - 3.0,
                escape(words),
                row + room / 2.0 + 12.0,
                power(*value)
            );
            row += room;
            at += thick(*value);
        }
    }
    let _ = write!(
        svg,
        "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{THICK:.1}\" rx=\"2\" fill=\"var(--faint)\"/></svg></figure>",
        middle - BAR,
        (height - THICK) / 2.0,
        2.0 * BAR
    );
    svg
}

/// A heat flow with the prefix that suits it.
fn power(watt: f64) -> String {
    let (scale, unit) = match watt.abs() {
        w if w >= 1e6 => (1e-6, "MW"),
        w if w >= 1e3 => (1e-3, "kW"),
        w if w >= 1.0 => (1.0, "W"),
        w if w >= 1e-3 => (1e3, "mW"),
        _ => (1e6, "µW"),
    };
    format!("{} {unit}", figure(watt * scale, 4))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sankey_has_as_thick_flows_as_they_are_large() {
        let way = |words, inward, outward| Way {
            words,
            inward,
            outward,
        };
        let ways = [
            way("gas through the boundary", 100.0, 75.0),
            way("particles", 0.0, 25.0),
        ];
        let svg = sankey(&ways);
        // From "M x top C …" to "… x bottom Z" at its outer end.
        let widths: Vec<f64> = svg
            .split(" d=\"M")
            .skip(1)
            .map(|rest| {
                let path = rest.split('Z').next().unwrap();
                let top = path.split([' ', 'C']).nth(1).unwrap();
                let bottom = path.rsplit(' ').next().unwrap();
                bottom.parse::<f64>().unwrap() - top.parse::<f64>().unwrap()
            })
            .collect();
        let close = |(found, sought): (&f64, f64)| (found - sought).abs() < 0.11;
        assert_eq!(widths.len(), 3);
        assert!(
            widths.iter().zip([THICK, 112.5, 37.5]).all(close),
            "{widths:?}"
        );
        assert!(svg.contains(">100 W<") && svg.contains(">75 W<") && svg.contains(">25 W<"));
        assert_eq!(sankey(&[way("bodies", 0.0, 0.0)]), "");
    }

    #[test]
    fn patches_are_told_with_means_and_without_those_that_nothing_passed() {
        let amount = |inward, outward| FlowAmount { inward, outward };
        let patch = |name: &str, mass_kg, heat_j, species: &[(&str, FlowAmount)]| PatchAmounts {
            patch: name.into(),
            mass_kg,
            heat_j,
            species_kg: species
                .iter()
                .map(|(name, of)| ((*name).into(), *of))
                .collect(),
        };
        let none = FlowAmount::default();
        let flows = FlowSummary {
            over_s: 2.0,
            patches: vec![
                patch(
                    "inlet",
                    amount(0.5, 0.0),
                    amount(0.0, 30.0),
                    &[("N2", amount(0.4, 0.0)), ("O2", none)],
                ),
                patch("wall", none, amount(7.0, 0.0), &[]),
                patch("side", amount(1e-12, 0.0), none, &[]),
            ],
            ..FlowSummary::default()
        };
        let html = by_patch(&flows);
        for there in [
            "<code>inlet</code>",
            ">250<",
            ">15<",
            "of it N2",
            ">200<",
            "<code>wall</code>",
            ">3.5<",
        ] {
            assert!(html.contains(there), "{there}: {html}");
        }
        assert!(!html.contains("side") && !html.contains("O2"), "{html}");
        assert_eq!(by_patch(&FlowSummary::default()), "");
    }

    #[test]
    fn ways_that_nothing_passed_are_left_out() {
        let names = [("a", "one"), ("b", "two"), ("c", "three")];
        let found = ways(&names, |name| match name {
            "a" => [5.0, 0.0],
            "b" => [1e-9, 0.0],
            _ => [0.0, 4.0],
        });
        let words: Vec<&str> = found.iter().map(|way| way.words).collect();
        assert_eq!(words, ["one", "three"]);
    }
}
