//! One window of particles with shells, with the gas about them held.

use calcine_numerics::batch::each_chunk;
use calcine_physics::pores::dusty_gas::MOST_GASES;

use super::Radial;
use super::attempt::{RadialCourse, RadialOutcome, RadialStalled};
use super::material::ShellResolution;
use super::resolve::hidden;
use super::side_by_side::{LANES, Wide};
use super::state::{RowLayout, TellLayout};
use super::transport::{Outside, OutsideLanes};
use super::workspace::RadialWorkspace;
use crate::error::ModelError;
use crate::model::{NetworkHeat, SurfaceMean, Surroundings};

/// Particles that a thread takes at a time.
const CHUNK: usize = 8 * LANES;

impl Radial {
    /// Follows every particle over a process span in s, each by itself, with the network's heat, or beside what it leads to. Those of one shell that hide too
    /// much get their shells, and are followed anew from the start of the window.
    pub(super) fn react(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        network: &[NetworkHeat],
    ) -> Result<(), ModelError> {
        self.follow(around, span, network, None)?;
        let hiding = self.hiding(&self.attempt);
        if hiding.is_empty() {
            return Ok(());
        }
        hiding.iter().for_each(|&p| self.resolve(p));
        self.follow(around, span, network, Some(&hiding))
    }

    /// Follows every particle, or some in ascending order, as they are.
    pub(super) fn follow(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        network: &[NetworkHeat],
        some: Option<&[usize]>,
    ) -> Result<(), ModelError> {
        let width = self.tell.end();
        let mut rows = std::mem::take(&mut self.attempt);
        rows.resize(self.count() * width, 0.0);
        let done = each_chunk(
            &mut rows,
            (width, CHUNK),
            || RadialScratch::new(self),
            |from, rows, scratch| {
                let seen = SeenByChunk {
                    around,
                    span,
                    network,
                    from,
                    some,
                };
                let RadialScratch { all, one } = scratch;
                let all = self.react_some(&seen, rows, all);
                let one = match self.layout.shells {
                    1 => None,
                    _ => self.react_some(&seen, rows, one),
                };
                let failed = [all, one].into_iter().flatten();
                failed.min_by_key(|(row, _)| *row)
            },
        );
        let last = self.layout.shells as u64;
        let followed = rows.chunks_exact(width).enumerate();
        for (_, row) in followed.filter(|(p, _)| among(some, *p)) {
            let tell = &row[self.tell.from..];
            let steps = tell[TellLayout::STEPS] as u64;
            let shells = if self.shells_of(row) == 1 { 1 } else { last };
            self.work[0] += steps;
            self.work[1] += steps * shells;
            self.work[2] += tell[TellLayout::FALLEN] as u64;
            self.work[3] += tell[TellLayout::ROUNDS] as u64;
        }
        self.attempt = rows;
        self.tried = true;
        self.last_span = span;
        done.map_err(|(row, cause)| ModelError::Particle {
            row,
            cause: Box::new(cause),
        })
    }

    /// The particles of a chunk that have as many shells as the workspace: one in each lane, the next one where one is done. What each
    /// comes to is a function of its committed state and its surroundings. The first that cannot be followed, if any.
    fn react_some(
        &self,
        seen: &SeenByChunk<'_>,
        rows: &mut [f64],
        ws: &mut RadialWorkspace,
    ) -> Option<(usize, RadialStalled)> {
        let width = self.tell.end();
        let count = rows.len() / width;
        let shells = ws.shells;
        let mut waiting = (0..count).filter(|k| {
            let p = seen.from + k;
            among(seen.some, p) && self.shells_of(self.row(p)) == shells
        });
        let mut outside: OutsideLanes<'_> = [None; LANES];
        let mut courses: [Option<(usize, RadialCourse)>; LANES] = Default::default();
        let mut failed: Option<(usize, RadialStalled)> = None;
        loop {
            let mut busy = false;
            for lane in 0..LANES {
                if courses[lane].is_none()
                    && let Some(k) = waiting.next()
                {
                    let about = self.outside(seen.from + k, seen);
                    self.load_lane(seen.from + k, lane, ws);
                    let course = self.physics.send(lane, &about, seen.span, ws);
                    (outside[lane], courses[lane]) = (Some(about), Some((k, course)));
                }
                busy |= courses[lane].is_some();
            }
            if !busy {
                return failed;
            }
            self.physics.round(&outside, ws);
            for lane in 0..LANES {
                let (Some(about), Some((k, course))) = (&outside[lane], &mut courses[lane]) else {
                    continue;
                };
                let Some(done) = self.physics.advance(lane, about, course, ws) else {
                    continue;
                };
                let k = *k;
                match done {
                    Ok(()) => {
                        let out = course.clone().end(lane, ws);
                        let row = &mut rows[k * width..(k + 1) * width];
                        self.store_lane((seen.from + k, lane), seen, (about, &out, ws), row);
                    }
                    Err(cause) => {
                        let row = seen.from + k;
                        if failed.is_none_or(|(first, _)| row < first) {
                            failed = Some((row, cause));
                        }
                    }
                }
                (outside[lane], courses[lane]) = (None, None);
            }
        }
    }

    /// What acts on a particle.
    fn outside<'a>(&self, p: usize, seen: &SeenByChunk<'a>) -> Outside<'a> {
        let SeenByChunk {
            around,
            span,
            network,
            ..
        } = *seen;
        let g = self.layout.gases;
        let mut fractions = [0.0; MOST_GASES];
        if let Some(gas) = &self.physics.chemistry.gas {
            let composition = &around.composition[p * g..(p + 1) * g];
            gas.mole_fractions(composition, &mut fractions[..g]);
            fractions.iter_mut().for_each(|x| *x = x.max(0.0));
        }
        // Without heat the network asks for lines first.
        let given = network.get(p);
        let beside = given.and_then(|one| one.beside);
        let heat = match (given, beside) {
            (Some(one), None) => one.mean,
            _ => 0.0,
        };
        Outside {
            temperature: around.temperature[p],
            pressure: around.pressure.get(p).copied().unwrap_or_default(),
            fractions,
            film: around.film.get(p * g..(p + 1) * g).unwrap_or_default(),
            theory: around.theory,
            radius: around.radius.get(p).copied().unwrap_or_default(),
            conductance: around.conductance[p],
            heat: heat + self.row(p)[self.layout.owed_heat()] / span,
            beside: beside.unwrap_or_default(),
            networked: given.is_none() || beside.is_some(),
        }
    }

    /// Means of the surface of a particle in its last attempt.
    pub(super) fn mean_of(&self, p: usize) -> SurfaceMean {
        let tell = &self.attempted(p)[self.tell.from..];
        SurfaceMean {
            temperature: tell[TellLayout::SURFACE_MEAN],
            fourth_power: tell[TellLayout::SURFACE_MEAN + 1],
        }
    }

    /// Puts the committed state of a particle into a lane.
    fn load_lane(&self, p: usize, lane: usize, ws: &mut RadialWorkspace) {
        let (layout, committed) = (self.layout, self.row(p));
        let (shells, s) = (ws.shells, layout.solids);
        let take = |to: &mut [Wide], from: usize| {
            for (to, value) in to.iter_mut().zip(&committed[from..]) {
                to[lane] = *value;
            }
        };
        take(
            &mut ws.start.temperature[..shells],
            layout.temperatures().start,
        );
        ws.start.temperature[shells][lane] = committed[RowLayout::SURFACE];
        take(&mut ws.start.amount, layout.amounts().start);
        take(&mut ws.start_gas, layout.gas().start);
        let first_mass = committed[layout.first_mass()];
        for shell in 0..shells {
            let share = self.share(committed, shell);
            ws.first_volume[shell][lane] = share * committed[layout.first_volume()];
            for (k, per_mass) in self.composition.iter().enumerate() {
                ws.unreacted[shell * s + k][lane] = share * per_mass * first_mass;
            }
        }
    }

    /// Puts what a lane came to into the row of its particle's attempt.
    fn store_lane(
        &self,
        (p, lane): (usize, usize),
        seen: &SeenByChunk<'_>,
        (outside, outcome, ws): (&Outside<'_>, &RadialOutcome, &RadialWorkspace),
        row: &mut [f64],
    ) {
        let (layout, shells, g) = (self.layout, ws.shells, ws.gases);
        let committed = self.row(p);
        row[..committed.len()].copy_from_slice(committed);
        let mut put = |from: &[Wide], to: usize| {
            for (to, value) in row[to..].iter_mut().zip(from) {
                *to = value[lane];
            }
        };
        put(&ws.start.temperature[shells..], RowLayout::SURFACE);
        put(&ws.start.temperature[..shells], layout.temperatures().start);
        put(&ws.start.amount, layout.amounts().start);
        put(&ws.start_gas, layout.gas().start);
        let hidden = match self.physics.numerics.resolution {
            ShellResolution::Beyond { .. } if shells == 1 => hidden(lane, ws, outside),
            _ => [0.0; 2],
        };
        let flow = self.tell.flow();
        row[flow].copy_from_slice(&outcome.flow[..g]);
        let slope = self.tell.slope();
        row[slope].copy_from_slice(&outcome.flow_slope[..g]);
        let tell = &mut row[self.tell.from..];
        tell[TellLayout::HEAT] = outcome.heat;
        tell[TellLayout::HEAT_SLOPE] = outcome.heat_slope;
        tell[TellLayout::SURFACE_SLOPE] = outcome.surface_slope;
        tell[TellLayout::SURFACE_BY_HEAT] = outcome.surface_by_heat;
        tell[TellLayout::RELEASED] = outcome.released;
        tell[TellLayout::GAS_TEMPERATURE] = outside.temperature;
        let [kelvin, fourth_power] = outcome.surface;
        tell[TellLayout::NETWORK] = seen.network.get(p).map_or(0.0, |given| {
            let beside = given.beside;
            beside.map_or(given.mean, |beside| beside.heat(kelvin, fourth_power))
        });
        tell[TellLayout::SURFACE_MEAN] = kelvin;
        tell[TellLayout::SURFACE_MEAN + 1] = fourth_power;
        tell[TellLayout::STEPS] = outcome.steps as f64;
        tell[TellLayout::FALLEN] = outcome.fallen_back as f64;
        tell[TellLayout::ROUNDS] = outcome.rounds as f64;
        tell[TellLayout::HIDDEN] = hidden[0];
        tell[TellLayout::HIDDEN + 1] = hidden[1];
    }
}

/// True of a particle that is to be followed: of all, or of some in ascending order.
fn among(some: Option<&[usize]>, p: usize) -> bool {
    some.is_none_or(|some| some.binary_search(&p).is_ok())
}

/// What the particles of a chunk see.
#[derive(Clone, Copy)]
struct SeenByChunk<'a> {
    around: &'a Surroundings<'a>,
    span: f64,
    network: &'a [NetworkHeat],
    /// The first of them, and which particles are followed if not all are.
    from: usize,
    some: Option<&'a [usize]>,
}

/// Memory of a thread.
struct RadialScratch {
    all: RadialWorkspace,
    one: RadialWorkspace,
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
        }
    }
}
