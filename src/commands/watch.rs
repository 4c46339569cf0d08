//! `calcine watch DIR`.

use std::net::Ipv4Addr;
use std::path::PathBuf;

use clap::Args;

use super::console::say;
use super::failure::Failure;
use super::signals::EndSignals;
use crate::exit;
use crate::standard_error::tell_line;
use crate::watch::{ReportWriter, WatchedRun};

/// Shows a run in the browser while it goes on: its report with progress, curves and the end of its log, on this machine only;
/// Ctrl-C ends it.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The results folder.
    dir: PathBuf,
    /// Port on 127.0.0.1; 0 takes any that is free.
    #[arg(long, value_name = "PORT", default_value_t = 8137)]
    port: u16,
}

/// Serves the page that `report` writes until a signal comes.
pub(super) fn run(arguments: &Arguments, report: ReportWriter) -> Result<u8, Failure> {
    let Arguments { dir, port } = arguments;
    let watched =
        WatchedRun::new(dir, report).map_err(|error| Failure::told(exit::CASE, &error))?;
    let signals = EndSignals::catch()?;
    let address = watched.serve(*port).map_err(|cause| {
        let place = Ipv4Addr::LOCALHOST;
        Failure::new(
            exit::CASE,
            format_args!(
                "port {port} of {place} cannot be listened on ({cause}): name another with `--port`, or `--port 0` for any that is free"
            ),
        )
    })?;
    say(format_args!("http://{address}/"))?;
    tell_line(format_args!(
        "{} is shown there; Ctrl-C ends this",
        dir.display()
    ));
    signals.wait();
    Ok(exit::OK)
}
