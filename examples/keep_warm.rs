//! The program of docs/how-to/drive-from-a-program.md: an inlet that follows the hottest gas.
#![allow(clippy::print_stdout)]

use std::error::Error;

use calcine::simulation::{BoundaryQuantity, Simulation};

fn main() -> Result<(), Box<dyn Error>> {
    let mut simulation = Simulation::open("bed.toml")
        .out("results/kept-warm")
        .start()?;
    let mut inlet = 400.0;
    while simulation.time() < 60.0 {
        let hottest = simulation
            .gas()
            .temperature
            .iter()
            .copied()
            .fold(0.0, f64::max);
        inlet += 0.1 * (450.0 - hottest);
        simulation.set_boundary("bottom", BoundaryQuantity::Temperature(inlet))?;
        if simulation.step()?.is_some() {
            break;
        }
        println!("{:8.3} s {inlet:8.2} K {hottest:8.2} K", simulation.time());
    }
    simulation.stop()?;
    Ok(())
}
