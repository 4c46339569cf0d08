//! The part of the C header that follows from the protocol: numbers of messages and failures, and what every
//! message and column holds. A test compares the header with it.

use std::fmt::Write;

use crate::column_set::ColumnSet;
use crate::columns::{
    ColumnComponents, ColumnPresence, GAS, NUMBERS_OF_BALANCE, PARTICLES, ProtocolColumn,
};
use crate::failure::SolverFailure;
use crate::record::{MessageKind, VERSION};

/// Begins the generated part of the header.
pub const BEGIN: &str = "/* Generated from the catalogue: adapters/wire/src/reference.rs. */\n";
/// Ends it.
pub const END: &str = "/* End of the generated part. */\n";

/// Longest line of the header.
const WIDTH: usize = 118;

/// Who sends it, what it carries, when, and what is answered.
type About = (&'static str, &'static str, &'static str);

fn about(kind: MessageKind) -> About {
    match kind {
        MessageKind::Hello => (
            "solver, then coordinator",
            "text; calcine_link_handshake sends and reads it",
            "first",
        ),
        MessageKind::State => (
            "solver",
            "columns \"state\"",
            "once: a gas after OWNED, particles after the handshake. Heat, drag, impulse, balances and convergence \
             are 0",
        ),
        MessageKind::Start => (
            "coordinator",
            "columns \"start\"; the header has window, attempt and clocks",
            "asks for one attempt at a window, always from the last commit. A gas gets several in a window, \
             particles one. Answer: FINISHED",
        ),
        MessageKind::Finished => (
            "solver",
            "columns \"state\": the state at the end of the window, and what the attempt took",
            "answers START",
        ),
        MessageKind::Commit => (
            "coordinator",
            "nothing",
            "makes the last attempt the start of the next. Answer: COMMITTED where the link has columns \"committed\"; \
             else none, and the next request may follow at once",
        ),
        MessageKind::Checkpoint => (
            "coordinator",
            "text: an existing folder, absolute",
            "after a commit: write what is committed into the folder, to last, and go on from what was written. \
             Answer: CHECKPOINTED",
        ),
        MessageKind::Checkpointed => (
            "solver",
            "columns \"state\", as with STATE",
            "answers CHECKPOINT",
        ),
        MessageKind::Failed => (
            "either",
            "text; the header's count is a calcine_failure. calcine_link_failed sends it",
            "in place of any answer; the sender then ends",
        ),
        MessageKind::Bye => (
            "coordinator, then solver",
            "nothing",
            "the run ends. Answer: BYE; then close the link and exit with 0",
        ),
        MessageKind::Owned => ("a gas", "columns \"owned\"", "once, after the handshake"),
        MessageKind::Change => (
            "coordinator, to particles",
            "text, one line each: \"rest\" (all come to rest where they are), \"remove ID\", \
             \"insert ID TYPE X Y Z VX VY VZ RADIUS DENSITY\" (TYPE: population from 1; behind it \
             WEIGHT where the link has weights), \"resize ID RADIUS MASS\"",
            "between a commit and the next START. Answer: CHANGED",
        ),
        MessageKind::Boundary => (
            "coordinator, to a gas, then the gas",
            "text, one line each: \"PATCH CONDITION VALUE...\", the conditions as in the case file \
             (superficial_velocity, mass_flow, temperature, composition, pressure, heat_flux, \
             heat_transfer_coefficient, ambient), in SI; nothing back",
            "between a commit and the next START, from which on it holds; after a resume it comes again. \
             Answer: BOUNDARY, or FAILED with CALCINE_FAILURE_UNSUPPORTED",
        ),
        MessageKind::Changed => (
            "particles",
            "columns \"state\", as with STATE",
            "answers CHANGE",
        ),
        MessageKind::Committed => (
            "a gas with columns \"committed\"",
            "these columns",
            "answers COMMIT",
        ),
    }
}

/// The generated part, with its marks.
pub fn header_part() -> String {
    let mut text = String::from(BEGIN);
    let _ = write!(
        text,
        "\n/* Version of the protocol; both sides must have the same. */\n\
         #define CALCINE_WIRE_VERSION {VERSION}u\n\n/* What a message is. */\ntypedef enum calcine_kind {{\n"
    );
    enumerate(
        &mut text,
        MessageKind::ALL.map(|kind| {
            (
                format!("CALCINE_{}", kind.name()),
                kind as u32,
                String::new(),
            )
        }),
    );
    text.push_str(
        "} calcine_kind;\n\n/* Why a solver cannot go on. */\ntypedef enum calcine_failure {\n",
    );
    enumerate(
        &mut text,
        SolverFailure::ALL.map(|kind| {
            let (name, meaning) = kind.about();
            (
                format!("CALCINE_FAILURE_{name}"),
                kind as u32,
                meaning.into(),
            )
        }),
    );
    text.push_str("} calcine_failure;\n\n/* Messages: who sends them, with what, when.\n *\n");
    for kind in MessageKind::ALL {
        let (sender, payload, when) = about(kind);
        let name = kind.name();
        wrapped(
            &mut text,
            &format!("{name:<13}"),
            &format!("{sender}: {payload}; {when}."),
        );
    }
    text.push_str(" */\n\n");
    for (role, item, table) in [("gas", "cell", GAS), ("particles", "particle", PARTICLES)] {
        columns(&mut text, role, item, table);
    }
    text.push_str(END);
    text
}

/// The lines of an enum; the last one has no comma.
fn enumerate<const N: usize>(text: &mut String, entries: [(String, u32, String); N]) {
    for (index, (name, number, meaning)) in entries.into_iter().enumerate() {
        let comma = if index + 1 < N { "," } else { "" };
        let entry = format!("    {name} = {number}{comma}");
        let _ = match meaning.is_empty() {
            true => writeln!(text, "{entry}"),
            false => writeln!(text, "{entry:<40} /* {meaning} */"),
        };
    }
}

/// The columns of a role, record by record.
fn columns(text: &mut String, role: &str, item: &str, table: &[ProtocolColumn]) {
    let _ = writeln!(
        text,
        "/* Columns of the role \"{role}\": name, numbers a {item} [unit], what it holds."
    );
    for (record, with) in [
        (ColumnSet::Owned, "with OWNED"),
        (ColumnSet::Start, "with START"),
        (
            ColumnSet::State,
            "with STATE, FINISHED, CHECKPOINTED, CHANGED",
        ),
        (ColumnSet::Committed, "with COMMITTED"),
    ] {
        let mut own = table
            .iter()
            .filter(|column| column.record == record)
            .peekable();
        if own.peek().is_none() {
            continue;
        }
        let _ = writeln!(text, " *\n * \"{}\", {with}:", record.name());
        own.for_each(|column| one(text, column));
    }
    text.push_str(" */\n\n");
}

fn one(text: &mut String, column: &ProtocolColumn) {
    let numbers = match column.components {
        ColumnComponents::Fixed(count) => count.to_string(),
        ColumnComponents::Species => "N".into(),
        ColumnComponents::Balances => format!("{NUMBERS_OF_BALANCE} (5 + N)"),
        ColumnComponents::PatchFlow => "(5 + N) a patch".into(),
    };
    let extent = if column.per_item { "" } else { ", once a rank" };
    let presence = match column.presence {
        ColumnPresence::Always => "",
        ColumnPresence::ForeignInputs => " Where `mesh_hash` is NULL.",
        ColumnPresence::Species => " Of a gas of N species.",
        ColumnPresence::Turbulent => " Of a turbulent gas.",
        ColumnPresence::BedEddies => " Of a gas whose eddies go on in the bed.",
        ColumnPresence::PatchReport => " Of a gas whose catalogue has it.",
        ColumnPresence::BackflowReport => " Of a gas whose catalogue has it.",
        ColumnPresence::TurbulenceReport => " Of a gas that answers COMMIT.",
        ColumnPresence::MovingDrag => " Where drag is pushed as a coefficient.",
        ColumnPresence::Weights => " Where rows may stand for several particles.",
    };
    let head = format!("  {} {numbers} [{}]{extent}: ", column.name, column.unit);
    wrapped(text, &head, &format!("{}.{presence}", column.about));
}

/// Lines of a comment: a head, and words that go on indented.
fn wrapped(text: &mut String, head: &str, words: &str) {
    let mut line = format!(" * {head}");
    let mut fresh = true;
    for word in words.split(' ') {
        if !fresh && line.len() + 1 + word.len() > WIDTH {
            let _ = writeln!(text, "{}", line.trim_end());
            line = " *     ".into();
            fresh = true;
        }
        if !fresh {
            line.push(' ');
        }
        line.push_str(word);
        fresh = false;
    }
    let _ = writeln!(text, "{}", line.trim_end());
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::path::Path;

    /// With the variable CALCINE_UPDATE it writes the header instead.
    #[test]
    fn the_header_is_that_of_the_catalogue() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("include/calcine_wire.h");
        let header = fs::read_to_string(&path).unwrap();
        let (before, rest) = header.split_once(BEGIN).unwrap();
        let (_, after) = rest.split_once(END).unwrap();
        let due = format!("{before}{}{after}", header_part());
        if std::env::var_os("CALCINE_UPDATE").is_some() {
            fs::write(&path, due).unwrap();
            return;
        }
        assert!(
            header == due,
            "the header is not that of the catalogue; write it with CALCINE_UPDATE=1 cargo test -p calcine-wire \
             --lib reference"
        );
    }

    #[test]
    fn lines_fit_and_every_column_is_described_once() {
        let text = header_part();
        assert!(text.lines().all(|line| line.len() <= WIDTH));
        for column in GAS.iter().chain(PARTICLES) {
            assert!(
                text.contains(&format!("   {} ", column.name)),
                "{}",
                column.name
            );
            assert!(!column.about.is_empty());
        }
    }
}
