//! What the columns of a gas' link mean.

use calcine_coupler::extreme::larger;
use calcine_coupler::gas_columns::GasColumns;
use calcine_coupler::part::{
    Backflow, Balance, Bed, CellExchange, CellReceived, Convergence, PatchFlow,
};
use calcine_coupler::physics::Vec3;
use calcine_wire::{ColumnSet, Link, WireError};

/// Column of what comes back in through outlets.
const BACKFLOW: &str = "backflow";
/// Column of what passes the patches.
const PATCH_FLOWS: &str = "patch_flows";
/// Column of a commit's answer.
const TURBULENCE_RESIDUAL: &str = "turbulence_residual";

/// The links of all ranks, and the cells of the whole mesh that each has.
#[derive(Clone, Copy)]
pub struct GasRanks<'a> {
    /// One link a rank.
    pub links: &'a [Link],
    /// By rank, in the order of its columns.
    pub owned: &'a [Vec<usize>],
    /// Cells of the whole mesh; each is on one rank.
    pub cells: usize,
}

impl GasRanks<'_> {
    /// Joins a column of all ranks.
    fn copy(self, name: &str, to: &mut Vec<f64>) -> Result<(), WireError> {
        to.resize(self.cells, 0.0);
        for (link, cells) in self.links.iter().zip(self.owned) {
            for (&cell, &value) in cells.iter().zip(link.column(name)?) {
                to[cell] = value;
            }
        }
        Ok(())
    }

    /// The same for so many numbers a cell.
    fn copy_items(self, name: &str, items: usize, to: &mut Vec<f64>) -> Result<(), WireError> {
        to.resize(self.cells * items, 0.0);
        for (link, cells) in self.links.iter().zip(self.owned) {
            let values = link.column(name)?.chunks_exact(items);
            for (&cell, values) in cells.iter().zip(values) {
                to[cell * items..][..items].copy_from_slice(values);
            }
        }
        Ok(())
    }

    /// The same for vectors.
    fn copy_vectors(self, name: &str, to: &mut Vec<Vec3>) -> Result<(), WireError> {
        to.resize(self.cells, Vec3::zeros());
        for (link, cells) in self.links.iter().zip(self.owned) {
            let triples = link.column(name)?.as_chunks::<3>().0;
            for (&cell, &[x, y, z]) in cells.iter().zip(triples) {
                to[cell] = Vec3::new(x, y, z);
            }
        }
        Ok(())
    }

    /// The first rank's link: what ranks have summed up stands in each of them.
    fn first(&self) -> Result<&Link, WireError> {
        self.links.first().ok_or(WireError::Order {
            what: "a solver has at least one link",
        })
    }
}

/// Takes the state, of so many species, of a turbulent gas or not, out of the messages that the links hold.
pub fn read_state(
    ranks: GasRanks<'_>,
    species: usize,
    turbulent: bool,
    to: &mut GasColumns,
) -> Result<(), WireError> {
    ranks.copy("temperature", &mut to.temperature)?;
    ranks.copy("pressure", &mut to.pressure)?;
    ranks.copy("density", &mut to.density)?;
    if species > 0 {
        ranks.copy_items("composition", species, &mut to.composition)?;
    }
    if turbulent {
        ranks.copy("turbulent_energy", &mut to.turbulent_energy)?;
        ranks.copy("dissipation", &mut to.dissipation)?;
        ranks.copy("eddy_viscosity", &mut to.eddy_viscosity)?;
    }
    ranks.copy_vectors("velocity", &mut to.velocity)?;
    ranks.copy_vectors("pressure_gradient", &mut to.pressure_gradient)
}

/// Fills the columns of a start for a rank that has these cells.
pub fn write(
    link: &mut Link,
    owned: &[usize],
    bed: &Bed,
    exchange: &CellExchange,
    species: usize,
) -> Result<(), WireError> {
    let given = &exchange.species;
    if species > 0 {
        for (name, items, values) in [
            ("species_source", species, &given.source),
            ("species_coefficient", species, &given.coefficient),
            ("species_taken", species, &given.taken),
            ("species_heat", 1, &given.heat),
        ] {
            let places = link.column_mut(name)?.chunks_exact_mut(items);
            for (place, &cell) in places.zip(owned) {
                match values.get(cell * items..(cell + 1) * items) {
                    Some(values) => place.copy_from_slice(values),
                    // No particle exchanges gas.
                    None => place.fill(0.0),
                }
            }
        }
    }
    let eddies = &exchange.eddies;
    for (name, values) in [
        ("eddy_energy", &eddies.energy),
        ("eddy_dissipation", &eddies.dissipation),
        ("eddy_growth", &eddies.growth),
    ] {
        if link.catalogue().has(ColumnSet::Start, name) {
            let places = link.column_mut(name)?.iter_mut();
            for (place, &cell) in places.zip(owned) {
                // Nothing is told of a bed without particles.
                *place = values.get(cell).copied().unwrap_or(0.0);
            }
        }
    }
    for (name, values) in [
        ("void_fraction", &bed.void_fraction),
        ("drag_coefficient", &exchange.drag_coefficient),
        ("heat_coefficient", &exchange.heat_coefficient),
        ("heat_source", &exchange.heat_source),
    ] {
        let places = link.column_mut(name)?.iter_mut();
        for (place, &cell) in places.zip(owned) {
            *place = values[cell];
        }
    }
    let places = link.column_mut("drag_source")?.as_chunks_mut::<3>().0;
    for (place, &cell) in places.iter_mut().zip(owned) {
        let source = exchange.drag_source[cell];
        *place = [source.x, source.y, source.z];
    }
    Ok(())
}

/// Reads what an attempt received, and how it went.
pub fn read(ranks: GasRanks<'_>, received: &mut CellReceived) -> Result<Convergence, WireError> {
    ranks.copy("heat", &mut received.heat)?;
    ranks.copy_vectors("drag", &mut received.drag)?;
    let link = ranks.first()?;
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
    let [x, y, z] = *link.column("storage_clock")? else {
        return Err(WireError::Order {
            what: "the column `storage_clock` has not three numbers",
        });
    };
    received.storage_clock = Vec3::new(x, y, z);
    received.patches.clear();
    if link.catalogue().has(ColumnSet::State, PATCH_FLOWS) {
        let of_patches = link
            .column(PATCH_FLOWS)?
            .chunks_exact(5 + received.species.len());
        received.patches.extend(of_patches.filter_map(patch_flow));
    }
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

/// What came back in through outlets, of all ranks; `None` where nothing did, or the gas does not say.
pub fn backflow(links: &[Link]) -> Result<Option<Backflow>, WireError> {
    let mut all: Option<Backflow> = None;
    for link in links {
        if !link.catalogue().has(ColumnSet::State, BACKFLOW) {
            continue;
        }
        let &[faces, velocity, cell] = link.column(BACKFLOW)? else {
            return Err(WireError::Order {
                what: "the column `backflow` has not three numbers",
            });
        };
        if faces > 0.0 {
            // Counts and numbers of cells come as doubles, exact far beyond any of them.
            let own = Backflow {
                faces: faces as u64,
                velocity,
                cell: cell as usize,
            };
            let faces = own.faces + all.map_or(0, |other| other.faces);
            let worst = all
                .filter(|other| other.velocity >= velocity)
                .unwrap_or(own);
            all = Some(Backflow { faces, ..worst });
        }
    }
    Ok(all)
}

/// The largest relative residual at which a rank's equations of turbulence ended above their tolerance, from the answers
/// to a commit; NaN where one is NaN.
pub fn turbulence_residual(links: &[Link]) -> Result<Option<f64>, WireError> {
    let mut worst = None;
    for link in links {
        if !link
            .catalogue()
            .has(ColumnSet::Committed, TURBULENCE_RESIDUAL)
        {
            continue;
        }
        for &residual in link.column(TURBULENCE_RESIDUAL)? {
            if residual != 0.0 {
                worst = Some(worst.map_or(residual, |other| larger(other, residual)));
            }
        }
    }
    Ok(worst)
}

fn patch_flow(numbers: &[f64]) -> Option<PatchFlow> {
    let (&[heat, mass, x, y, z], species) = numbers.split_first_chunk::<5>()?;
    Some(PatchFlow {
        heat,
        mass,
        momentum: Vec3::new(x, y, z),
        species: species.to_vec(),
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
        ..Balance::default()
    }
}
