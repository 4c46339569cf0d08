//! The native particles: spheres that stay where they are. Their support takes up the impulse of
//! the gas.

use std::f64::consts::PI;
use std::path::Path;

use calcine_coupler::checkpoint::StateFile;
use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::motion::Change;
use calcine_coupler::part::{
    About, Part, ParticleEvent, ParticleFields, ParticlePush, ParticleReceived, Particles,
};
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::supervisor::Supervisor;
use calcine_coupler::time::Window;

pub use crate::gas::NativeError;
use crate::gas::{flat, vectors};

/// Name of the state file in a checkpoint's folder.
const STATE: &str = "particles.state";

/// A frozen bed.
#[derive(Debug)]
pub struct NativeParticles {
    about: About,
    id: Vec<u64>,
    population: Vec<u32>,
    position: Vec<Vec3>,
    velocity: Vec<Vec3>,
    angular_velocity: Vec<Vec3>,
    radius: Vec<f64>,
    mass: Vec<f64>,
    started: Option<Window>,
    impulse: Vec<Vec3>,
}

impl NativeParticles {
    /// The bed of a setup; masses are 4/3 π r³ ρ.
    pub fn new(setup: &ParticleSetup) -> Result<Self, NativeError> {
        check(setup)?;
        let count = setup.id.len();
        let spheres = setup.radius.iter().zip(&setup.density);
        Ok(Self {
            about: About {
                name: "native particles".into(),
                version: env!("CARGO_PKG_VERSION").into(),
                ranks: 1,
            },
            id: setup.id.clone(),
            population: setup.population.clone(),
            position: setup.position.clone(),
            velocity: vec![Vec3::zeros(); count],
            angular_velocity: vec![Vec3::zeros(); count],
            radius: setup.radius.clone(),
            mass: spheres
                .map(|(radius, density)| 4.0 / 3.0 * PI * radius.powi(3) * density)
                .collect(),
            started: None,
            impulse: vec![Vec3::zeros(); count],
        })
    }

    /// Takes up the state that a checkpoint left in a folder.
    pub fn restore(&mut self, directory: &Path) -> Result<(), NativeError> {
        let file = StateFile::read(&directory.join(STATE))?;
        let count = self.id.len();
        let id = file.u64s("id")?;
        if id.len() != count {
            return Err(length("the state's list of ids", id.len(), count));
        }
        self.id.copy_from_slice(id);
        self.population = file
            .u64s("population")?
            .iter()
            .map(|&population| population as u32)
            .collect();
        self.position = vectors(file.f64s_of("position", 3 * count)?);
        self.velocity = vectors(file.f64s_of("velocity", 3 * count)?);
        self.angular_velocity = vectors(file.f64s_of("angular_velocity", 3 * count)?);
        self.radius = file.f64s_of("radius", count)?.to_vec();
        self.mass = file.f64s_of("mass", count)?.to_vec();
        Ok(())
    }

    fn state(&self) -> StateFile {
        let population: Vec<u64> = self.population.iter().map(|&p| u64::from(p)).collect();
        let mut file = StateFile::new();
        file.set_u64s("id", &self.id);
        file.set_u64s("population", &population);
        file.set_f64s("position", &flat(&self.position));
        file.set_f64s("velocity", &flat(&self.velocity));
        file.set_f64s("angular_velocity", &flat(&self.angular_velocity));
        file.set_f64s("radius", &self.radius);
        file.set_f64s("mass", &self.mass);
        file
    }

    fn failure(&self, kind: FailureKind, message: impl Into<String>) -> PartError {
        PartError::new(self.about.name.clone(), kind, message)
    }
}

impl Part for NativeParticles {
    fn about(&self) -> &About {
        &self.about
    }

    fn commit(&mut self) -> Result<(), PartError> {
        Ok(())
    }

    fn checkpoint(&mut self, directory: &Path) -> Result<(), PartError> {
        let failed = |part: &Self, error: NativeError| {
            part.failure(FailureKind::Io, error.to_string())
                .caused_by(error)
        };
        self.state()
            .write(&directory.join(STATE))
            .map_err(|error| failed(self, error.into()))?;
        self.restore(directory).map_err(|error| failed(self, error))
    }

    fn finish_run(&mut self, _supervisor: &Supervisor) -> Result<(), PartError> {
        Ok(())
    }
}

impl Particles for NativeParticles {
    fn fields(&self) -> ParticleFields<'_> {
        ParticleFields {
            id: &self.id,
            population: &self.population,
            position: &self.position,
            velocity: &self.velocity,
            angular_velocity: &self.angular_velocity,
            radius: &self.radius,
            mass: &self.mass,
        }
    }

    fn events(&self) -> &[ParticleEvent] {
        &[]
    }

    fn change(&mut self, _supervisor: &Supervisor, change: &Change) -> Result<(), PartError> {
        if change.is_empty() {
            return Ok(());
        }
        Err(self.failure(
            FailureKind::Protocol,
            "a frozen bed takes no particles in or out",
        ))
    }

    fn start(&mut self, window: &Window, push: &ParticlePush) -> Result<(), PartError> {
        if push.force.len() != self.id.len() {
            let message = length("the push", push.force.len(), self.id.len()).to_string();
            return Err(self
                .failure(FailureKind::Protocol, message)
                .in_window(window));
        }
        let span = window.span.motion.seconds();
        for (impulse, force) in self.impulse.iter_mut().zip(&push.force) {
            *impulse = force * span;
        }
        self.started = Some(*window);
        Ok(())
    }

    fn finish(
        &mut self,
        _supervisor: &Supervisor,
        received: &mut ParticleReceived,
    ) -> Result<(), PartError> {
        if self.started.take().is_none() {
            return Err(self.failure(FailureKind::Protocol, "finished without a start"));
        }
        received.impulse.clone_from(&self.impulse);
        Ok(())
    }
}

fn length(field: &'static str, found: usize, expected: usize) -> NativeError {
    NativeError::Length {
        field,
        found,
        expected,
        of: "particles",
    }
}

fn check(setup: &ParticleSetup) -> Result<(), NativeError> {
    let count = setup.id.len();
    for (field, found) in [
        ("the list of populations", setup.population.len()),
        ("the list of positions", setup.position.len()),
        ("the list of radii", setup.radius.len()),
        ("the list of densities", setup.density.len()),
    ] {
        if found != count {
            return Err(length(field, found, count));
        }
    }
    if !setup.motion.is_frozen() && count > 0 {
        return Err(NativeError::Moving);
    }
    for i in 0..count {
        for (field, value, unit) in [
            ("the radius", setup.radius[i], "m"),
            ("the density", setup.density[i], "kg/m^3"),
        ] {
            if !(value.is_finite() && value > 0.0) {
                return Err(NativeError::Value {
                    field,
                    place: format!("particle {}", setup.id[i]),
                    value,
                    unit,
                    rule: "positive",
                });
            }
        }
    }
    Ok(())
}
