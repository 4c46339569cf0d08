//! The host that runs Debian's LIGGGHTS as a library: it runs a script, then advances in windows as the
//! coordinator asks, and sends back what the particles became.
//!
//! `calcine-liggghts SCRIPT CASE-HASH [RESTART-FILE]`, started by Calcine in the script's folder.

mod drag;
mod error;
mod host;
#[allow(unsafe_code)]
mod library;
#[allow(unsafe_code)]
mod parent;
mod population_update;
mod pushed_force;
mod rank_particles;

use std::path::PathBuf;

use error::HostError;
use host::{Host, HostStart};

fn main() {
    let outcome = run();
    if let Err(error) = &outcome {
        eprintln!("calcine-liggghts: {error}");
        library::report(error.failure(), &error.to_string());
    }
    library::end(i32::from(outcome.is_err()));
}

fn run() -> Result<(), HostError> {
    let mut words = std::env::args_os().skip(1);
    let start = HostStart {
        script: words.next().map(PathBuf::from).ok_or(HostError::Usage)?,
        case_hash: words
            .next()
            .and_then(|word| word.into_string().ok())
            .ok_or(HostError::Usage)?,
        restart: words.next().map(PathBuf::from),
    };
    Host::begin(start)?.serve()
}
