//! One window of particles with shells, with the gas about them held.

use calcine_numerics::batch::each_row;

use super::Radial;
use super::attempt::{RadialOutcome, RadialStalled};
use super::material::ShellResolution;
use super::state::{RowLayout, TellLayout};
use super::transport::Outside;
use super::workspace::RadialWorkspace;
use crate::error::ModelError;
use crate::model::Surroundings;
use crate::reacting::passage::ParticleSurroundings;

impl Radial {
    /// Follows every particle over a process span in s, each by itself, with the network's heat in W.
    pub(super) fn react(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        network: &[f64],
    ) -> Result<(), ModelError> {
        let width = self.tell.end();
        let mut rows = std::mem::take(&mut self.attempt);
        rows.resize(self.count() * width, 0.0);
        let done = each_row(
            &mut rows,
            width,
            || RadialScratch::new(self),
            |p, row, scratch| {
                let heat = network.get(p).copied().unwrap_or_default();
                self.react_one(p, around, (span, heat), row, scratch)
                    .map_err(|cause| (p, cause))
            },
        );
        let last = self.layout.shells as u64;
        for row in rows.chunks_exact(width) {
            let tell = &row[self.tell.from..];
            let steps = tell[TellLayout::STEPS] as u64;
            let shells = if self.shells_of(row) == 1 { 1 } else { last };
            self.work[0] += steps;
            self.work[1] += steps * shells;
            self.work[2] += tell[TellLayout::FALLEN] as u64;
        }
        self.attempt = rows;
        self.tried = true;
        self.last_span = span;
        done.map_err(|(row, cause)| ModelError::Particle {
            row,
            cause: Box::new(cause),
        })
    }

    /// One particle; a function of its committed state and its surroundings.
    fn react_one(
        &self,
        p: usize,
        around: &Surroundings<'_>,
        (span, heat): (f64, f64),
        row: &mut [f64],
        scratch: &mut RadialScratch,
    ) -> Result<(), RadialStalled> {
        let layout = self.layout;
        let committed = self.row(p);
        row[..committed.len()].copy_from_slice(committed);
        let shells = self.shells_of(committed);
        let g = layout.gases;
        scratch.see(self, p, around);
        let RadialScratch {
            all,
            one,
            outcome,
            fractions,
        } = scratch;
        let ws = if shells == 1 { one } else { all };
        ws.start.temperature[shells] = committed[RowLayout::SURFACE];
        let (t, n, gas) = (layout.temperatures(), layout.amounts(), layout.gas());
        ws.start.temperature[..shells].copy_from_slice(&committed[t.start..t.start + shells]);
        let s = layout.solids;
        ws.start
            .amount
            .copy_from_slice(&committed[n.start..n.start + shells * s]);
        ws.start_gas
            .copy_from_slice(&committed[gas.start..gas.start + shells * g]);
        let first_mass = committed[layout.first_mass()];
        for shell in 0..shells {
            let share = self.share(committed, shell);
            ws.first_volume[shell] = share * committed[layout.first_volume()];
            for (k, per_mass) in self.composition.iter().enumerate() {
                ws.unreacted[shell * s + k] = share * per_mass * first_mass;
            }
        }
        let radius = around.radius.get(p).copied().unwrap_or_default();
        let outside = Outside {
            around: ParticleSurroundings {
                temperature: around.temperature[p],
                pressure: around.pressure.get(p).copied().unwrap_or_default(),
                fractions,
                film: around.film.get(p * g..(p + 1) * g).unwrap_or_default(),
                theory: around.theory,
                radius,
                size: &self.physics.solid.size,
            },
            conductance: around.conductance[p],
            heat: heat + committed[layout.owed_heat()] / span,
        };
        self.physics.follow(&outside, span, ws, outcome)?;
        row[RowLayout::SURFACE] = ws.start.temperature[shells];
        row[t.start..t.start + shells].copy_from_slice(&ws.start.temperature[..shells]);
        row[n.start..n.start + shells * s].copy_from_slice(&ws.start.amount);
        row[gas.start..gas.start + shells * g].copy_from_slice(&ws.start_gas);
        let hidden = match self.physics.numerics.resolution {
            ShellResolution::Beyond { .. } if shells == 1 => hidden(ws, &outside),
            _ => [0.0; 2],
        };
        let flow = self.tell.flow();
        row[flow].copy_from_slice(&outcome.flow);
        let slope = self.tell.slope();
        row[slope].copy_from_slice(&outcome.flow_slope);
        let tell = &mut row[self.tell.from..];
        tell[TellLayout::HEAT] = outcome.heat;
        tell[TellLayout::HEAT_SLOPE] = outcome.heat_slope;
        tell[TellLayout::SURFACE_SLOPE] = outcome.surface_slope;
        tell[TellLayout::SURFACE_BY_HEAT] = outcome.surface_by_heat;
        tell[TellLayout::RELEASED] = outcome.released;
        tell[TellLayout::GAS_TEMPERATURE] = around.temperature[p];
        tell[TellLayout::NETWORK] = heat;
        tell[TellLayout::STEPS] = outcome.steps as f64;
        tell[TellLayout::FALLEN] = outcome.fallen_back as f64;
        tell[TellLayout::HIDDEN] = hidden[0];
        tell[TellLayout::HIDDEN + 1] = hidden[1];
        Ok(())
    }

    /// Gives a particle of one shell all of them, each as the one was.
    pub(super) fn resolve(&mut self, p: usize) {
        let (layout, width) = (self.layout, self.layout.width());
        let row = &mut self.committed[p * width..(p + 1) * width];
        let (t, n, g) = (
            layout.temperatures().start,
            layout.amounts().start,
            layout.gas().start,
        );
        for (shell, share) in self.physics.shares.iter().enumerate().rev() {
            row[t + shell] = row[t];
            for k in 0..layout.solids {
                row[n + shell * layout.solids + k] = share * row[n + k];
            }
            for k in 0..layout.gases {
                row[g + shell * layout.gases + k] = share * row[g + k];
            }
        }
        row[layout.count()] = layout.shells as f64;
    }
}

/// What one shell hides: the difference in K between centre and surface of a parabola with the heat that passes the surface, and that of
/// the partial pressure of a gas over the pressure, with the flow that does. The mean of a parabola lies 2/5 of it above the surface.
fn hidden(ws: &RadialWorkspace, outside: &Outside<'_>) -> [f64; 2] {
    const WHOLE: f64 = 2.5;
    let now = &ws.now;
    let kelvin = WHOLE * (now.temperature[0] - now.temperature[1]).abs();
    let g = ws.gases;
    let drops = (0..g).map(|k| (now.pressure[k] - now.pressure[g + k]).abs());
    let most = drops.fold(0.0, f64::max);
    let share = if g > 0 {
        WHOLE * most / outside.around.pressure
    } else {
        0.0
    };
    [kelvin, share]
}

/// Memory of a thread.
struct RadialScratch {
    all: RadialWorkspace,
    one: RadialWorkspace,
    outcome: RadialOutcome,
    fractions: Vec<f64>,
}

impl RadialScratch {
    fn new(of: &Radial) -> Self {
        let sizes = |shells| {
            let physics = &of.physics;
            RadialWorkspace::new([
                shells,
                physics.solids(),
                physics.gases(),
                physics.reactions(),
            ])
        };
        Self {
            all: sizes(of.layout.shells),
            one: sizes(1),
            outcome: RadialOutcome::default(),
            fractions: vec![0.0; of.layout.gases],
        }
    }

    /// Takes up the mole fractions about a particle.
    fn see(&mut self, of: &Radial, p: usize, around: &Surroundings<'_>) {
        if let Some(gas) = &of.physics.chemistry.gas {
            let g = self.fractions.len();
            gas.mole_fractions(&around.composition[p * g..(p + 1) * g], &mut self.fractions);
            self.fractions.iter_mut().for_each(|x| *x = x.max(0.0));
        }
    }
}
