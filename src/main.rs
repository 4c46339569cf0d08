//! The command line of Calcine.

use std::process::ExitCode;

fn main() -> ExitCode {
    calcine::commands::main()
}
