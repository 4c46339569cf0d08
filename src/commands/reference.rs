//! The page of the command line in the docs is made from the options themselves.

use std::fmt::Write as _;
use std::path::Path;

use clap::{Arg, Command, CommandFactory};

use super::Arguments;

const HEAD: &str = "\
# Command line

Generated from the help texts of the program; `calcine SUBCOMMAND --help` prints the same. From a clone,
`cargo xtask run …` and `cargo xtask calcine SUBCOMMAND …` install and build what a command needs first.
";

const EXIT_CODES: &str = "
## Exit codes

| code | meaning |
|---|---|
| 0 | success; `calcine watch` ended by Ctrl-C |
| 1 | any failure without a code of its own |
| 2 | the case or the command line is wrong, or a folder holds no run |
| 3 | a solver diverged, the inside of a particle could not be integrated, or a law has no value for the state that it got |
| 4 | a solver died, was silent, or could not be started |
| 5 | a quantity lies outside its band, or a solver breaks a law of `calcine conform` |
| 6 | with `--strict`: complete and within all bands, but with [warnings](results.md#warnings), of `check` too |
| 75 | stopped with a checkpoint; `--resume` continues |
| 130 | interrupted before the run began, or a second time, and ended at once; `--resume` continues from the last checkpoint, where there is one |
";

/// Text of a cell of a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

/// The row of an option or positional argument.
fn row(argument: &Arg) -> String {
    let names = argument.get_value_names().unwrap_or_default();
    let values: Vec<&str> = names.iter().map(|name| name.as_str()).collect();
    let head = match argument.get_long() {
        None => values.join(" "),
        Some(long) if argument.get_action().takes_values() => {
            format!("--{long} {}", values.join(" "))
        }
        Some(long) => format!("--{long}"),
    };
    let mut help = argument
        .get_help()
        .map(ToString::to_string)
        .unwrap_or_default();
    if !help.ends_with('.') {
        help.push('.');
    }
    let choices: Vec<String> = argument
        .get_possible_values()
        .iter()
        .filter(|_| argument.get_action().takes_values())
        .map(|value| {
            let meaning = value.get_help().map(|help| format!(" ({help})"));
            format!("`{}`{}", value.get_name(), meaning.unwrap_or_default())
        })
        .collect();
    if !choices.is_empty() {
        let _ = write!(help, " One of {}.", choices.join(", "));
    }
    let default = argument.get_default_values().first();
    if let Some(default) = default.filter(|_| argument.get_action().takes_values()) {
        let _ = write!(help, " Default: `{}`.", default.to_string_lossy());
    }
    if argument.is_required_set() && argument.get_long().is_some() {
        help.push_str(" Required.");
    }
    format!("| `{head}` | {} |\n", cell(&help))
}

fn section(command: &Command) -> String {
    let name = command.get_name();
    let text = |about: Option<&clap::builder::StyledStr>| about.map(ToString::to_string);
    let about = text(command.get_long_about().or(command.get_about())).unwrap_or_default();
    let about = about.trim_end();
    let stop = if about.ends_with('.') { "" } else { "." };
    let mut page = format!("\n## `calcine {name}`\n\n{about}{stop}\n");
    let shown = |argument: &&Arg| {
        !argument.is_hide_set() && !["help", "version"].contains(&argument.get_id().as_str())
    };
    let positional = command.get_positionals().filter(shown);
    let options =
        command
            .get_opts()
            .chain(command.get_arguments().filter(|argument| {
                argument.get_long().is_some() && !argument.get_action().takes_values()
            }));
    let rows: String = positional.chain(options.filter(shown)).map(row).collect();
    if !rows.is_empty() {
        let _ = write!(page, "\n| argument | meaning |\n|---|---|\n{rows}");
    }
    page
}

/// `docs/reference/command-line.md`.
fn page() -> String {
    let mut command = Arguments::command();
    command.build();
    let sections = command
        .get_subcommands()
        .filter(|command| command.get_name() != "help")
        .map(section);
    HEAD.to_owned() + &sections.collect::<String>() + EXIT_CODES
}

#[test]
fn the_page_of_the_command_line_is_made_from_the_options() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/reference/command-line.md");
    if std::env::var_os("CALCINE_WRITE_DOCS").is_some() {
        std::fs::write(&path, page()).unwrap();
    }
    assert!(
        std::fs::read_to_string(&path).unwrap_or_default() == page(),
        "set CALCINE_WRITE_DOCS=1 and run this test again to write {}",
        path.display()
    );
}

#[test]
fn every_exit_code_is_on_the_page() {
    use crate::exit;
    for code in [
        exit::OK,
        exit::OTHER,
        exit::CASE,
        exit::DIVERGED,
        exit::PEER,
        exit::OUTSIDE_BANDS,
        exit::CHECKPOINTED,
        exit::INTERRUPTED,
    ] {
        assert!(EXIT_CODES.contains(&format!("| {code} |")), "{code}");
    }
}
