//! The Volume Fraction Smoother (docs/theory.md, VFS-1..8) as part of the operator W = F S W₀ that
//! carries whatever the solid has to the cells, and whose transpose shows particles the gas.
//!
//! In three steps: how much of the solid must pass through each cell so that none stays above α_max is
//! an obstacle problem (`obstacle`), found by sweeps or, where these would be many, by active sets
//! and multigrid; what passes and what stays makes a linear operator (`kernel`), applied by sweeps or
//! by multigrid; F is a diffusion over a short length (`diffusion`).
//!
//! A bed is refused where a connected region holds more than fits it (VFS-5), and only there: close
//! to the threshold it costs no more. On two cores, columns of 10 x 10 x 200 cells with spiky base mappings
//! took 0.15 to 0.3 s from solid volumes to S at every mean from 0.60 to 0.63999 (α_max 0.64), and one
//! application of S or Sᵀ 10 to 20 ms, in place of 14,000 to 219,000 sweeps (VFS-4). In a region that is
//! full to within a quarter of the tolerance, the threshold is raised by less than half the tolerance.

mod cascade;
mod diffusion;
mod error;
mod graph;
mod kernel;
mod multigrid;
mod obstacle;
mod operator;
pub mod packing_density;
mod scratch;
mod sparse;
mod sweeps;

use std::sync::{Arc, OnceLock};

use calcine_numerics::parallel;
use calcine_physics::Vec3;

pub use error::SmootherError;
pub use operator::Operator;

use crate::mapping::Weights;
use crate::mesh::Mesh;
use cascade::Cascade;
use diffusion::Diffusion;
use graph::Graph;
use kernel::Kernel;
use obstacle::Care;

/// What is asked of the smoother.
#[derive(Clone, Debug, PartialEq)]
pub struct SmootherSettings {
    /// Solid volume fraction α_max that no cell may exceed, between 0 and 1.
    pub max_solid_fraction: f64,
    /// Excess that may stay: as a share of the bed's solid volume in all, and as a solid fraction
    /// beyond α_max in each cell.
    pub tolerance: f64,
    /// Length ℓ of the diffusion F in m; `None` for no diffusion.
    pub diffusion_length: Option<f64>,
}

impl Default for SmootherSettings {
    /// Random close packing, 0.64, and an excess of 1e-4 (docs/theory.md, VFS-1, VFS-4).
    fn default() -> Self {
        Self {
            max_solid_fraction: 0.64,
            tolerance: 1e-4,
            diffusion_length: None,
        }
    }
}

/// The smoother of a mesh. Takes about 130 bytes per cell of a hexahedral mesh, and 40 more from the
/// first bed that needs more than sweeps.
#[derive(Clone, Debug)]
pub struct Smoother {
    settings: SmootherSettings,
    graph: Arc<Graph>,
    cascade: Arc<OnceLock<Cascade>>,
    diffusion: Option<Diffusion>,
    centre: Vec<Vec3>,
    region: Vec<u32>,
    regions: usize,
    /// α_max V of each cell in m³.
    capacity: Vec<f64>,
}

impl Smoother {
    /// Most sweeps that S is applied with; beyond, multigrid does the same for less.
    pub const MOST_SWEEPS: u32 = 150;

    /// The smoother of a mesh without excluded zones.
    pub fn new(mesh: &Mesh, settings: SmootherSettings) -> Result<Self, SmootherError> {
        Self::with_excluded(mesh, settings, &vec![false; mesh.cells()])
    }

    /// The smoother of a mesh; nothing is moved into or out of the cells marked as excluded
    /// (burner ducts, walls).
    pub fn with_excluded(
        mesh: &Mesh,
        settings: SmootherSettings,
        excluded: &[bool],
    ) -> Result<Self, SmootherError> {
        let SmootherSettings {
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
            cascade: Arc::default(),
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
        let kernel = self.smooth(&solid)?;
        Ok(Operator::new(
            weights,
            kernel,
            self.diffusion.clone(),
            &self.graph.volume,
            solid,
        ))
    }

    /// The kernel that brings the solid volume of each cell, in m³, below α_max; `None` if it is.
    fn smooth(&self, solid: &[f64]) -> Result<Option<Kernel>, SmootherError> {
        if solid.iter().zip(&self.capacity).all(|(a, c)| a <= c) {
            return Ok(None);
        }
        let excess = self.excess(solid)?;
        let allowed = self.settings.tolerance * solid.iter().sum::<f64>();
        // Half the tolerance for the settled bed, the rest for what sweeps leave moving.
        let enough = sweeps::Enough {
            total: 0.5 * allowed,
            largest: 0.5 * self.settings.tolerance,
        };
        let swept = sweeps::sweep(&self.graph, &excess, &enough);
        if swept.settled && swept.sweeps == 0 {
            return Ok(None);
        }
        let mut potential = swept.potential;
        let mut after = vec![0.0; solid.len()];
        if swept.settled {
            self.graph.excess(solid, &potential, &mut after);
        } else {
            let cascade = self.cascade.get_or_init(|| Cascade::new(&self.graph));
            let start = cascade.start(&excess);
            for (potential, start) in potential.iter_mut().zip(start) {
                *potential = potential.max(start);
            }
            let steps = obstacle::settle(&self.graph, &excess, &mut potential, Care::Full);
            if steps.is_none() && !self.is_little(&excess, &potential, &enough) {
                return Err(self.refused(solid, None));
            }
            // Active cells are full.
            parallel::fill(&mut after, |cell| solid[cell] - excess[cell]);
        }
        let mut kernel = Kernel::new(&self.graph, &after, &potential);
        kernel.settle(solid, 0.5 * allowed, Self::MOST_SWEEPS, |cells| {
            self.is_within(cells, self.settings.tolerance)
        });
        Ok(Some(kernel))
    }

    /// Whether no more than `enough` stays in excess where solid moves by a potential.
    fn is_little(&self, excess: &[f64], potential: &[f64], enough: &sweeps::Enough) -> bool {
        let mut left = vec![0.0; excess.len()];
        self.graph.excess(excess, potential, &mut left);
        let total = parallel::sum(left.len(), |cell| left[cell].max(0.0));
        let largest = parallel::largest(left.len(), |cell| left[cell] / self.graph.volume[cell])
            .1
            .max(0.0);
        total <= enough.total && largest <= enough.largest
    }

    /// Whether no cell lies above α_max by more than a solid fraction.
    fn is_within(&self, solid: &[f64], beyond: f64) -> bool {
        let volume = &self.graph.volume;
        (0..solid.len()).all(|cell| solid[cell] <= self.capacity[cell] + beyond * volume[cell])
    }

    /// A₀ − C, what each cell has above its capacity (below 0: its room). Refuses beds that hold more
    /// solid in a connected region than fits it (VFS-5). In a region that is full to within a quarter
    /// of the tolerance, capacities are raised until as much room is left, so that excess has
    /// somewhere to go.
    fn excess(&self, solid: &[f64]) -> Result<Vec<f64>, SmootherError> {
        let spare = 0.25 * self.settings.tolerance;
        let mut held = vec![0.0; self.regions];
        let mut volume = vec![0.0; self.regions];
        for (cell, &region) in self.region.iter().enumerate() {
            held[region as usize] += solid[cell];
            volume[region as usize] += self.graph.volume[cell];
        }
        let beyond =
            |region: usize| held[region] - self.settings.max_solid_fraction * volume[region];
        let overfull = (0..self.regions)
            .filter(|&region| beyond(region) > spare * held[region])
            .max_by(|&a, &b| beyond(a).total_cmp(&beyond(b)));
        if let Some(region) = overfull {
            return Err(self.refused(solid, Some((region, beyond(region)))));
        }
        let raised: Vec<f64> = (0..self.regions)
            .map(|region| (beyond(region) / volume[region] + spare).max(0.0))
            .collect();
        let excess = |cell: usize| {
            let raised = raised[self.region[cell] as usize] * self.graph.volume[cell];
            solid[cell] - self.capacity[cell] - raised
        };
        Ok((0..solid.len()).map(excess).collect())
    }

    /// The refusal of an overfull region with what is left over, or of the fullest cell's region.
    fn refused(&self, solid: &[f64], overfull: Option<(usize, f64)>) -> SmootherError {
        let excess = |cell: usize| (solid[cell] - self.capacity[cell]).max(0.0);
        let fullest = (0..solid.len()).max_by(|&a, &b| excess(a).total_cmp(&excess(b)));
        let region = match overfull {
            Some((region, _)) => region as u32,
            None => fullest.map_or(0, |cell| self.region[cell]),
        };
        let members: Vec<usize> = (0..solid.len())
            .filter(|&cell| self.region[cell] == region)
            .collect();
        let sum = |of: &dyn Fn(usize) -> f64| members.iter().map(|&cell| of(cell)).sum::<f64>();
        let centres = || members.iter().map(|&cell| self.centre[cell]);
        let infinity = Vec3::repeat(f64::INFINITY);
        SmootherError::DoesNotFit {
            left_over: overfull.map_or_else(|| sum(&excess), |(_, left_over)| left_over),
            max_solid_fraction: self.settings.max_solid_fraction,
            cells: members.len(),
            lower: centres().fold(infinity, |low, centre| low.inf(&centre)),
            upper: centres().fold(-infinity, |high, centre| high.sup(&centre)),
            mean: sum(&|cell| solid[cell]) / sum(&|cell| self.graph.volume[cell]),
            unsettled: overfull.is_none(),
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
