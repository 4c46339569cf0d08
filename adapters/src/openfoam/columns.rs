//! What the columns of a gas' link mean.

use calcine_coupler::part::{Balance, Bed, CellExchange, CellReceived, Convergence, GasFields};
use calcine_coupler::physics::Vec3;
use calcine_wire::{Link, WireError};

/// The gas as the solver sent it last, one value per cell.
#[derive(Clone, Debug, Default)]
pub struct State {
    temperature: Vec<f64>,
    pressure: Vec<f64>,
    density: Vec<f64>,
    /// Mass fractions, species by species within each cell; empty for a single gas.
    composition: Vec<f64>,
    velocity: Vec<Vec3>,
    pressure_gradient: Vec<Vec3>,
}

fn copy(link: &Link, name: &str, to: &mut Vec<f64>) -> Result<(), WireError> {
    let column = link.column(name)?;
    to.clear();
    to.extend_from_slice(column);
    Ok(())
}

fn copy_vectors(link: &Link, name: &str, to: &mut Vec<Vec3>) -> Result<(), WireError> {
    let triples = link.column(name)?.as_chunks::<3>().0;
    to.clear();
    to.extend(triples.iter().map(|&[x, y, z]| Vec3::new(x, y, z)));
    Ok(())
}

impl State {
    /// Takes the state, of so many species, out of the message that a link holds.
    pub fn read(&mut self, link: &Link, species: usize) -> Result<(), WireError> {
        copy(link, "temperature", &mut self.temperature)?;
        copy(link, "pressure", &mut self.pressure)?;
        copy(link, "density", &mut self.density)?;
        if species > 0 {
            copy(link, "composition", &mut self.composition)?;
        }
        copy_vectors(link, "velocity", &mut self.velocity)?;
        copy_vectors(link, "pressure_gradient", &mut self.pressure_gradient)
    }

    /// As the coordinator sees it.
    pub fn fields(&self) -> GasFields<'_> {
        GasFields {
            temperature: &self.temperature,
            pressure: &self.pressure,
            density: &self.density,
            composition: &self.composition,
            velocity: &self.velocity,
            pressure_gradient: &self.pressure_gradient,
        }
    }
}

/// Fills the columns of a start.
pub fn write(link: &mut Link, bed: &Bed, exchange: &CellExchange) -> Result<(), WireError> {
    for (name, values) in [
        ("void_fraction", &bed.void_fraction),
        ("drag_coefficient", &exchange.drag_coefficient),
        ("heat_coefficient", &exchange.heat_coefficient),
        ("heat_source", &exchange.heat_source),
    ] {
        link.column_mut(name)?.copy_from_slice(values);
    }
    let places = link.column_mut("drag_source")?.as_chunks_mut::<3>().0;
    for (place, source) in places.iter_mut().zip(&exchange.drag_source) {
        *place = [source.x, source.y, source.z];
    }
    Ok(())
}

/// Reads what an attempt received, and how it went.
pub fn read(link: &Link, received: &mut CellReceived) -> Result<Convergence, WireError> {
    copy(link, "heat", &mut received.heat)?;
    copy_vectors(link, "drag", &mut received.drag)?;
    let mut balances = link
        .column("balances")?
        .as_chunks::<7>()
        .0
        .iter()
        .map(|&numbers| balance(numbers));
    let mut next = || balances.next().unwrap_or_default();
    received.mass = next();
    received.energy = next();
    received.momentum = [next(), next(), next()];
    received.species.clear();
    received.species.extend(balances);
    let numbers = link.column("convergence")?;
    let [outer, linear, residual, volume, converged] = *numbers else {
        return Err(WireError::Order {
            what: "the column `convergence` has not five numbers",
        });
    };
    Ok(Convergence {
        // Counts come as doubles, exact far beyond any of them.
        outer_iterations: outer as u32,
        linear_iterations: linear as u32,
        residual,
        volume_residual: volume,
        converged: converged != 0.0,
    })
}

fn balance(numbers: [f64; 7]) -> Balance {
    let [
        stored,
        stored_magnitude,
        boundary,
        boundary_magnitude,
        exchange,
        source,
        source_magnitude,
    ] = numbers;
    Balance {
        stored,
        stored_magnitude,
        boundary,
        boundary_magnitude,
        exchange,
        source,
        source_magnitude,
    }
}
