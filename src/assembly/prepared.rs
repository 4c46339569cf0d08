//! Mesh, particles and smoother of a case.

use std::sync::Arc;

use calcine_coupler::coordinator::{Origin, RunError};
use calcine_coupler::mapping::{Mapper, MappingError, Method};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::periodic::axis_name;
use calcine_coupler::mesh::zone::Zone;
use calcine_coupler::physics::{Vec3, sphere};
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::smoother::packing_density::median_solid_fraction;
use calcine_coupler::smoother::{Smoother, SmootherSettings as Smoothing};

use super::error::AssemblyError;
use crate::case::model::{Case, MappingSpec, Population};
use crate::case::packed::BedPacking;
use crate::case::sizes;
use crate::case::{InitialParticles, PlaceError, in_wall, mesh_of, parcels, particles};

/// Diameter over the narrowest width of a mesh that only a slip of units gives: slices of a bed may be thinner than its
/// particles, which are pressed together.
const FAR: f64 = 2.0;

/// Mean diameters about a cell over which the density of the packing is looked at.
const REACH: f64 = 2.0;

/// What does not change during a run, made from a case: mesh and particles at the start.
#[derive(Clone, Debug)]
pub struct PreparedCase {
    /// The gas mesh.
    pub mesh: Arc<Mesh>,
    /// The particles at the start.
    pub particles: ParticleSetup,
    /// Their temperatures in K.
    pub temperature: Vec<f64>,
    /// What files of particles state that does not count.
    pub notes: Vec<String>,
    /// Mean diameter in m of the case's particles.
    mean_diameter: f64,
}

impl PreparedCase {
    /// Generates or reads the mesh and places the particles.
    pub fn new(case: &Case) -> Result<Self, AssemblyError> {
        sizes::fits(case)?;
        let mesh = Arc::new(mesh_of(case)?);
        let periodic = mesh.periodicity().axes.iter().position(Option::is_some);
        if let Some(axis) = periodic.filter(|_| case.laws.radiation.is_some()) {
            let axis = axis_name(axis);
            return Err(AssemblyError::PeriodicRadiation { axis });
        }
        let InitialParticles {
            mut setup,
            temperature,
            notes,
        } = particles(case, mesh.periodicity())?;
        fit_between_walls(case, &mesh, &setup)?;
        setup.motion = parcels::motion_of(case, &mesh, &setup)?;
        in_wall::check(case, &setup)?;
        let radii = &setup.radius;
        Ok(Self {
            mesh,
            // Zero without particles.
            mean_diameter: 2.0 * radii.iter().sum::<f64>() / radii.len().max(1) as f64,
            particles: setup,
            temperature,
            notes,
        })
    }

    /// The same with the particles that another run left.
    pub(super) fn continued(&self, case: &Case, origin: &Origin) -> Result<Self, AssemblyError> {
        let species = case.gas.properties.species();
        let material = |one: &Population| &case.materials[one.material];
        let reacting = case
            .particles
            .iter()
            .map(|one| !case.chemistry.reactions.is_empty() && material(one).composition.is_some());
        let reacting: Vec<bool> = reacting.collect();
        let names: Vec<String> = case.particles.iter().map(|one| one.name.clone()).collect();
        let mut taken =
            origin.take_particles(&self.mesh, species, &names, &self.particles, &reacting)?;
        taken.motion = parcels::motion_of(case, &self.mesh, &taken)?;
        Ok(Self {
            particles: taken,
            ..self.clone()
        })
    }

    /// The bed at the start, mapped and smoothed as in a run.
    pub fn packing(&self, case: &Case) -> Result<BedPacking, AssemblyError> {
        let particles = &self.particles;
        let radii = particles.radius.iter().enumerate();
        let volumes: Vec<f64> = radii
            .map(|(row, &radius)| particles.weight_of(row) * sphere::volume(radius))
            .collect();
        let mapper = Mapper::new(&*self.mesh);
        let weights = mapper
            .fill(method(case), &particles.position, &particles.radius)
            .map_err(|error| self.outside(case, error))?;
        if volumes.is_empty() {
            return Ok(BedPacking::NONE);
        }
        let solid_fraction =
            median_solid_fraction(&self.mesh, &weights, &volumes, REACH * self.mean_diameter);
        let smoother = smoother(case, self)?;
        let operator = smoother
            .operator(weights, &volumes)
            .map_err(RunError::from)?;
        let mut seen = vec![0.0; volumes.len()];
        operator.sample(operator.solid_fraction(), &mut seen);
        Ok(BedPacking {
            void_fraction: 1.0 - seen.iter().sum::<f64>() / seen.len() as f64,
            solid_fraction,
            moved_share: operator.moved_share(),
        })
    }

    /// What is told of particles that cannot be mapped: of one outside the mesh, whose it is.
    fn outside(&self, case: &Case, error: MappingError) -> AssemblyError {
        let MappingError::Outside { particle, position } = error else {
            return RunError::from(error).into();
        };
        let population = self.particles.population.get(particle);
        let population = population.map_or(0, |index| *index as usize);
        PlaceError::Outside {
            id: self.particles.id.get(particle).copied().unwrap_or(0),
            index: population,
            name: case
                .particles
                .get(population)
                .map_or(String::new(), |one| one.name.clone()),
            at: position,
        }
        .into()
    }
}

/// Refuses the first particle that is far wider than the box about the mesh.
fn fit_between_walls(case: &Case, mesh: &Mesh, setup: &ParticleSetup) -> Result<(), PlaceError> {
    let [low, high] = mesh.bounds();
    let width = (high - low).min();
    let mut radii = setup.radius.iter();
    let Some(row) = radii.position(|radius| 2.0 * radius > FAR * width) else {
        return Ok(());
    };
    Err(PlaceError::TooWide {
        id: setup.id[row],
        name: case.particles[setup.population[row] as usize].name.clone(),
        diameter: 2.0 * setup.radius[row],
        width,
    })
}

/// The smoother, which leaves the case's excluded zones alone.
pub(super) fn smoother(case: &Case, prepared: &PreparedCase) -> Result<Smoother, AssemblyError> {
    let (mesh, zones) = (&prepared.mesh, &case.coupling.excluded);
    for (index, zone) in zones.iter().enumerate() {
        if !mesh.cell_centre().iter().any(|&centre| zone.holds(centre)) {
            return Err(AssemblyError::Excluded { index });
        }
    }
    let settings = smoothing(case, prepared);
    let made = Smoother::with_excluded(mesh, settings, &Zone::cells(zones, mesh));
    Ok(made.map_err(RunError::from)?)
}

/// Settings of the smoother. Where the case does not state the diffusion's length, it is half the
/// mean diameter where particles are larger than a third of the cells about them (docs/theory.md, VFS-6): without
/// it a particle that spans several cells would give heat to cells that have nothing to give.
fn smoothing(case: &Case, prepared: &PreparedCase) -> Smoothing {
    let diameter = prepared.mean_diameter;
    let large = diameter > cell_size(prepared) / 3.0;
    let length = case
        .coupling
        .diffusion_length
        .unwrap_or(if large { 0.5 * diameter } else { 0.0 });
    Smoothing {
        max_solid_fraction: case.coupling.max_solid_fraction,
        tolerance: case.coupling.smoother_tolerance,
        diffusion_length: (length > 0.0).then_some(length),
    }
}

/// Mean size in m of the cells in the box about the particles' centres, or of all where none lies there.
fn cell_size(prepared: &PreparedCase) -> f64 {
    let (mesh, centres) = (&prepared.mesh, &prepared.particles.position);
    let (mut low, mut high) = (Vec3::repeat(f64::MAX), Vec3::repeat(f64::MIN));
    for centre in centres {
        (low, high) = (low.inf(centre), high.sup(centre));
    }
    let within = |centre: &Vec3| (0..3).all(|i| (low[i]..=high[i]).contains(&centre[i]));
    let cells = mesh.cell_volume().iter().zip(mesh.cell_centre());
    let (count, volume) = cells
        .filter(|(_, centre)| within(centre))
        .fold((0.0, 0.0), |(count, sum), (volume, _)| {
            (count + 1.0, sum + volume)
        });
    if count > 0.0 {
        f64::cbrt(volume / count)
    } else {
        (mesh.cell_volume().iter().sum::<f64>() / mesh.cells() as f64).cbrt()
    }
}

pub(super) fn method(case: &Case) -> Method {
    match case.coupling.mapping {
        MappingSpec::Centroid => Method::Centroid,
        MappingSpec::Divided => Method::Divided,
        MappingSpec::Overlap => Method::Overlap,
        MappingSpec::Linear => Method::Linear,
    }
}
