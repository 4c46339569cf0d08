//! The Volume Fraction Smoother (requirements VFS-1..8) as part of the operator W = F S W₀ that
//! carries whatever the solid has to the cells, and whose transpose shows particles the gas.

mod diffusion;
mod graph;
mod obstacle;
mod operator;
mod sweeps;

use std::sync::Arc;

use calcine_physics::Vec3;
use thiserror::Error;

pub use operator::Operator;

use crate::mapping::Weights;
use crate::mesh::Mesh;
use diffusion::Diffusion;
use graph::Graph;
use sweeps::Sweeps;

/// What is asked of the smoother.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Solid volume fraction α_max that no cell may exceed, between 0 and 1.
    pub max_solid_fraction: f64,
    /// Excess that may stay: as a share of the bed's solid volume in all, and as a solid fraction
    /// beyond α_max in each cell.
    pub tolerance: f64,
    /// Length ℓ of the diffusion F in m; `None` for no diffusion.
    pub diffusion_length: Option<f64>,
}

impl Default for Settings {
    /// Random close packing, 0.64, and an excess of 1e-4 (requirements VFS-1, VFS-4).
    fn default() -> Self {
        Self {
            max_solid_fraction: 0.64,
            tolerance: 1e-4,
            diffusion_length: None,
        }
    }
}

/// A bed that cannot be smoothed, or a smoother that cannot be.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SmootherError {
    /// α_max outside its range.
    #[error("the largest solid fraction is {0}; it must lie between 0 and 1")]
    MaxSolidFraction(f64),
    /// A tolerance that would leave no gas, or ask for the impossible.
    #[error(
        "the smoother's tolerance is {tolerance}; it must be above 0 and below {below}, the gas \
         fraction of a full cell"
    )]
    Tolerance {
        /// The tolerance.
        tolerance: f64,
        /// 1 − α_max.
        below: f64,
    },
    /// A diffusion length that is no length.
    #[error("the diffusion length is {0} m; it must be finite and not negative")]
    NoLength(f64),
    /// A diffusion length that is far longer than cells.
    #[error("a diffusion length of {length} m needs {steps} steps on this mesh; at most {most}")]
    DiffusionLength {
        /// The length in m.
        length: f64,
        /// Steps that it would take.
        steps: f64,
        /// Steps allowed.
        most: u32,
    },
    /// Lists of different lengths.
    #[error("{given} {what}, but {expected} expected")]
    Lengths {
        /// What is counted.
        what: &'static str,
        /// How many were given.
        given: usize,
        /// How many were expected.
        expected: usize,
    },
    /// A solid volume that is negative or not finite.
    #[error("particle {particle} has a solid volume of {volume} m^3")]
    SolidVolume {
        /// Index of the particle.
        particle: usize,
        /// Its solid volume in m³.
        volume: f64,
    },
    /// A bed that does not fit below α_max (requirements VFS-5).
    #[error(
        "the bed does not fit: {left_over} m^3 of solid are left over above a solid fraction of \
         {max_solid_fraction} in a region of {cells} cells with centres between \
         ({}, {}, {}) and ({}, {}, {}) m; its mean solid fraction is {mean}{}",
        lower.x, lower.y, lower.z, upper.x, upper.y, upper.z,
        sweeps.map_or(String::new(), |n| format!(", and {n} sweeps did not settle it"))
    )]
    DoesNotFit {
        /// Solid volume left over in m³.
        left_over: f64,
        /// α_max.
        max_solid_fraction: f64,
        /// Cells of the connected region.
        cells: usize,
        /// Lowest coordinates of the region's cell centres in m.
        lower: Vec3,
        /// Highest coordinates of the region's cell centres in m.
        upper: Vec3,
        /// Mean solid fraction of the region.
        mean: f64,
        /// Sweeps done in vain; `None` where no number of sweeps would help.
        sweeps: Option<u32>,
    },
}

/// The smoother of a mesh.
#[derive(Clone, Debug)]
pub struct Smoother {
    settings: Settings,
    graph: Arc<Graph>,
    diffusion: Option<Diffusion>,
    centre: Vec<Vec3>,
    region: Vec<usize>,
    regions: usize,
    /// α_max V of each cell in m³.
    capacity: Vec<f64>,
}

impl Smoother {
    /// Most sweeps that a bed may need before it is refused.
    pub const MOST_SWEEPS: u32 = 20_000;

    /// The smoother of a mesh without excluded zones.
    pub fn new(mesh: &Mesh, settings: Settings) -> Result<Self, SmootherError> {
        Self::with_excluded(mesh, settings, &vec![false; mesh.cells()])
    }

    /// The smoother of a mesh; nothing is moved into or out of the cells marked as excluded
    /// (burner ducts, walls).
    pub fn with_excluded(
        mesh: &Mesh,
        settings: Settings,
        excluded: &[bool],
    ) -> Result<Self, SmootherError> {
        let Settings {
            max_solid_fraction: most,
            tolerance,
            diffusion_length,
        } = settings;
        if !(0.0 < most && most < 1.0) {
            return Err(SmootherError::MaxSolidFraction(most));
        }
        if !(0.0 < tolerance && tolerance < 1.0 - most) {
            let below = 1.0 - most;
            return Err(SmootherError::Tolerance { tolerance, below });
        }
        if let Some(length) = diffusion_length
            && !(length >= 0.0 && length.is_finite())
        {
            return Err(SmootherError::NoLength(length));
        }
        same_length("marks of excluded cells", excluded.len(), mesh.cells())?;
        let graph = Arc::new(Graph::new(mesh, excluded));
        let diffusion = diffusion_length
            .map(|length| {
                let made = Diffusion::new(graph.clone(), length);
                made.map_err(|steps| SmootherError::DiffusionLength {
                    length,
                    steps,
                    most: Diffusion::MOST_STEPS,
                })
            })
            .transpose()?;
        let (region, regions) = graph.regions();
        Ok(Self {
            capacity: graph.volume.iter().map(|volume| most * volume).collect(),
            centre: mesh.cell_centre().to_vec(),
            settings,
            graph,
            diffusion,
            region,
            regions,
        })
    }

    /// The operator W of a bed: base weights and solid volume in m³ by particle.
    pub fn operator(
        &self,
        weights: Weights,
        solid_volume: &[f64],
    ) -> Result<Operator, SmootherError> {
        same_length("cells of the weights", weights.cells(), self.graph.cells())?;
        same_length("solid volumes", solid_volume.len(), weights.particles())?;
        for (particle, &volume) in solid_volume.iter().enumerate() {
            if !(volume >= 0.0 && volume.is_finite()) {
                return Err(SmootherError::SolidVolume { particle, volume });
            }
        }
        let mut solid = vec![0.0; weights.cells()];
        weights.spread(solid_volume, &mut solid);
        let sweeps = self.smooth(&solid)?;
        Ok(Operator::new(
            weights,
            sweeps,
            self.diffusion.clone(),
            &self.graph.volume,
            solid_volume,
        ))
    }

    /// The sweeps that bring the solid volume of each cell, in m³, below α_max; `None` if it is.
    fn smooth(&self, solid: &[f64]) -> Result<Option<Sweeps>, SmootherError> {
        if solid.iter().zip(&self.capacity).all(|(a, c)| a <= c) {
            return Ok(None);
        }
        self.refuse_overfull(solid)?;
        let allowed = self.settings.tolerance * solid.iter().sum::<f64>();
        let within = |cells: &[f64], share: f64| self.is_within(cells, share);
        // Half the tolerance for the settled bed, the rest for what sweeps leave moving.
        let half = 0.5 * self.settings.tolerance;
        let obstacle = obstacle::solve(
            &self.graph,
            &self.capacity,
            solid,
            Self::MOST_SWEEPS,
            |excess, cells| excess <= 0.5 * allowed && within(cells, half),
        );
        if !obstacle.settled {
            return Err(self.refused(&obstacle.solid, None));
        }
        let mut sweeps = Sweeps::new(&self.graph, &obstacle.solid, &obstacle.moved);
        let settled = sweeps.settle(solid, Self::MOST_SWEEPS, |moving, cells| {
            moving <= 0.5 * allowed && within(cells, self.settings.tolerance)
        });
        match settled {
            true if sweeps.count() == 0 => Ok(None),
            true => Ok(Some(sweeps)),
            false => Err(self.refused(&obstacle.solid, None)),
        }
    }

    /// Whether no cell lies above α_max by more than a solid fraction.
    fn is_within(&self, solid: &[f64], beyond: f64) -> bool {
        let volume = &self.graph.volume;
        (0..solid.len()).all(|cell| solid[cell] <= self.capacity[cell] + beyond * volume[cell])
    }

    /// Refuses beds that hold more solid in a connected region than fits it (VFS-5).
    fn refuse_overfull(&self, solid: &[f64]) -> Result<(), SmootherError> {
        let mut room = vec![0.0; self.regions];
        for (cell, &region) in self.region.iter().enumerate() {
            room[region] += self.capacity[cell] - solid[cell];
        }
        let allowed = |region: usize| {
            let members = self.members(region);
            0.5 * self.settings.tolerance * members.map(|cell| solid[cell]).sum::<f64>()
        };
        let overfull = (0..self.regions)
            .filter(|&region| room[region] < 0.0 && -room[region] > allowed(region))
            .min_by(|&a, &b| room[a].total_cmp(&room[b]));
        match overfull {
            Some(region) => Err(self.refused(solid, Some(region))),
            None => Ok(()),
        }
    }

    fn members(&self, region: usize) -> impl Iterator<Item = usize> + '_ {
        (0..self.region.len()).filter(move |&cell| self.region[cell] == region)
    }

    /// The refusal of an overfull region, or of the region of the fullest cell after all sweeps.
    fn refused(&self, solid: &[f64], overfull: Option<usize>) -> SmootherError {
        let excess = |cell: usize| (solid[cell] - self.capacity[cell]).max(0.0);
        let fullest = (0..solid.len()).max_by(|&a, &b| excess(a).total_cmp(&excess(b)));
        let region = overfull.unwrap_or(fullest.map_or(0, |cell| self.region[cell]));
        let sum = |of: &[f64]| self.members(region).map(|cell| of[cell]).sum::<f64>();
        let infinity = Vec3::repeat(f64::INFINITY);
        let centres = || self.members(region).map(|cell| self.centre[cell]);
        SmootherError::DoesNotFit {
            left_over: match overfull {
                Some(_) => sum(solid) - sum(&self.capacity),
                None => self.members(region).map(excess).sum(),
            },
            max_solid_fraction: self.settings.max_solid_fraction,
            cells: self.members(region).count(),
            lower: centres().fold(infinity, |low, centre| low.inf(&centre)),
            upper: centres().fold(-infinity, |high, centre| high.sup(&centre)),
            mean: sum(solid) / sum(&self.graph.volume),
            sweeps: overfull.is_none().then_some(Self::MOST_SWEEPS),
        }
    }
}

fn same_length(what: &'static str, given: usize, expected: usize) -> Result<(), SmootherError> {
    if given == expected {
        return Ok(());
    }
    Err(SmootherError::Lengths {
        what,
        given,
        expected,
    })
}
