//! Kinetic analysis without a law: energies from several heating rates.

mod isoconversional;
mod kissinger;
mod line;
mod smoothed;

pub use isoconversional::{ConversionEnergy, friedman, ozawa_flynn_wall};
pub use kissinger::{KissingerResult, kissinger, kissinger_temperature};
pub use line::FittedLine;
pub use smoothed::SmoothedRun;
