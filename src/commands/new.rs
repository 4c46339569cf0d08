//! `calcine new NAME`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{Failure, say};
use crate::exit;

/// Starts a case of one's own from a shipped one, in one folder.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Name of the new case; the folder of this name must not exist.
    name: PathBuf,
    /// The shipped case to start from.
    #[arg(long, value_enum, default_value_t = Shipped::HeatedColumn)]
    like: Shipped,
}

/// Shipped cases.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Shipped {
    /// Hot air heats a column of ten spheres.
    HeatedColumn,
}

impl Shipped {
    fn text(self) -> &'static str {
        match self {
            Shipped::HeatedColumn => include_str!("../../cases/heated-column.toml"),
        }
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let folder = &arguments.name;
    let Some(stem) = folder.file_name() else {
        let message = format!("`{}` is no name for a case", folder.display());
        return Err(Failure::new(exit::CASE, message));
    };
    if folder.exists() {
        let message = format!("{} is already there: choose another name", folder.display());
        return Err(Failure::new(exit::CASE, message));
    }
    let file = folder.join(stem).with_extension("toml");
    let failed = |cause: std::io::Error| {
        Failure::new(exit::OTHER, format_args!("{}: {cause}", file.display()))
    };
    std::fs::create_dir_all(folder).map_err(failed)?;
    std::fs::write(&file, arguments.like.text()).map_err(failed)?;
    say(format_args!(
        "{}: change it, then\n  calcine check {0}\n  calcine run {0}",
        file.display()
    ));
    Ok(exit::OK)
}
