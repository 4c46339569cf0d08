//! Particles with shells as the coordinator sees them.

use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::sphere;
use calcine_physics::thermo::Element;

use super::Radial;
use super::columns::{RadialColumn, kinds};
use super::material::ShellResolution;
use super::physics::RadialError;
use super::state::{RowLayout, TellLayout};
use crate::column::{ColumnKind, ColumnShape, Ragged, StateColumn};
use crate::error::ModelError;
use crate::model::{
    At, Bodies, Channel, GasLines, Inventory, NetworkHeat, Newcomer, ParticleModel, SurfaceLine,
    SurfaceMean, Surroundings, Transfer,
};
use crate::thin::TEMPERATURE;

impl ParticleModel for Radial {
    fn columns(&self) -> &[StateColumn] {
        &self.columns
    }

    fn read(&self, column: usize, out: &mut Ragged) {
        out.reset(ColumnKind::Real);
        let Some(&kind) = kinds(&self.physics).get(column) else {
            return;
        };
        let mut values = Vec::new();
        for p in 0..self.count() {
            values.clear();
            self.values(kind, self.row(p), &mut values);
            out.push_reals(&values);
        }
    }

    fn load(&mut self, from: &[Ragged]) -> Result<(), ModelError> {
        self.resolved.clear();
        let rows = self.count();
        let kinds = kinds(&self.physics);
        let columns = self.columns.clone();
        // How many shells a particle has is in the temperatures of its shells.
        for order in [true, false] {
            for ((kind, column), values) in kinds.iter().zip(&columns).zip(from) {
                if !column.is_state() || (*kind == RadialColumn::Shells) != order {
                    continue;
                }
                if column.shape == ColumnShape::Scalar {
                    values.to_scalars(&column.name, rows)?;
                }
                for p in 0..rows {
                    self.take(*kind, column, p, values.reals(p))?;
                }
            }
        }
        self.begin();
        Ok(())
    }

    fn bodies(&self, at: At) -> Bodies<'_> {
        let bodies = match at {
            At::Attempt => &self.bodies[0],
            At::Commit => &self.bodies[1],
        };
        Bodies {
            temperature: &bodies.temperature,
            mass: &bodies.mass,
            radius: &bodies.radius,
        }
    }

    fn channels(&self) -> &[Channel] {
        &self.channels
    }

    fn elements(&self) -> Vec<Element> {
        if self.is_inert() {
            return Vec::new();
        }
        let chemistry = &self.physics.chemistry;
        let solids = chemistry.solids.iter().map(|one| *one.atoms());
        let gases = chemistry.gas.iter().flat_map(|gas| gas.species());
        let atoms: Vec<[f64; Element::COUNT]> =
            solids.chain(gases.map(|one| *one.atoms())).collect();
        let held = |one: &Element| atoms.iter().any(|atoms| atoms[*one as usize] > 0.0);
        Element::ALL.into_iter().filter(held).collect()
    }

    fn temperature_range(&self) -> (f64, f64) {
        let ranges = self.physics.chemistry.solids.iter().map(|one| one.range());
        ranges.fold((0.0, f64::INFINITY), |(low, high), (from, to)| {
            (from.max(low), to.min(high))
        })
    }

    fn surface(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        _at: &[f64],
        out: &mut [SurfaceLine],
    ) -> Result<(), ModelError> {
        if !self.tried {
            // Without the heat of the network nothing is told of what one shell hides.
            self.follow(around, span, &[], None)?;
        }
        for (p, line) in out.iter_mut().enumerate() {
            let row = self.attempted(p);
            let tell = &row[self.tell.from..];
            let by_heat = tell[TellLayout::SURFACE_BY_HEAT];
            let warmer = around.temperature[p] - tell[TellLayout::GAS_TEMPERATURE];
            let free = tell[TellLayout::SURFACE_MEAN] + tell[TellLayout::SURFACE_SLOPE] * warmer
                - tell[TellLayout::NETWORK] * by_heat;
            *line = SurfaceLine {
                conductance: 1.0 / by_heat,
                temperature: free,
                stored: 0.0,
            };
        }
        Ok(())
    }

    fn respond(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        network: &[NetworkHeat],
        out: &mut GasLines,
    ) -> Result<(), ModelError> {
        self.follows_network = network.first().is_some_and(|one| one.beside.is_some());
        self.react(around, span, network)?;
        let g = self.layout.gases;
        for p in 0..self.count() {
            let row = self.attempted(p);
            let tell = &row[self.tell.from..];
            let (heat, slope) = (tell[TellLayout::HEAT], tell[TellLayout::HEAT_SLOPE]);
            let gas = around.temperature[p];
            out.conductance[p] = slope.max(0.0);
            out.temperature[p] = if slope > 0.0 { gas - heat / slope } else { gas };
            out.released[p] = tell[TellLayout::RELEASED];
            let composition = around
                .composition
                .get(p * g..(p + 1) * g)
                .unwrap_or_default();
            for (k, channel) in self.channels.iter().enumerate() {
                let place = p * g + k;
                let owed = row[self.layout.owed_gas().start + k];
                let rate = row[self.tell.flow().start + k] + owed / span;
                let Some(key) = channel.key else {
                    out.offset[place] = -rate;
                    continue;
                };
                let by_mass = self.fraction_by_mass(composition, key);
                let slope = (row[self.tell.slope().start + k] * by_mass).min(0.0);
                out.slope[place] = slope;
                out.offset[place] = slope * composition[key] - rate;
                // A cell gives no more than its share of the gas that is used.
                let used = rate < 0.0 && composition[key] > 0.0;
                let proportional = if used { rate / composition[key] } else { 0.0 };
                out.local_slope[place] = slope.min(proportional);
            }
        }
        Ok(())
    }

    fn surface_mean(&self, row: usize) -> Option<SurfaceMean> {
        self.follows_network.then(|| self.mean_of(row))
    }

    /// What was exchanged otherwise than the particle said is owed to it.
    fn settle(&mut self, took: &Transfer<'_>, span: f64) -> Result<(), ModelError> {
        let (layout, width, g) = (self.layout, self.tell.end(), self.layout.gases);
        let mut rows = std::mem::take(&mut self.attempt);
        for (p, row) in rows.chunks_exact_mut(width).enumerate() {
            let before = self.row(p);
            let mut energy = before[layout.owed_heat()]
                + (took.heat[p] + took.network[p] + took.carried[p]) * span;
            for k in 0..g {
                let exchanged = took.rates[p * g + k] * span;
                let formation = self.physics.gas_formation[k];
                let place = layout.owed_gas().start + k;
                let given = row[self.tell.flow().start + k] * span;
                row[place] = before[place] + given - exchanged;
                energy -= (exchanged + row[place] - before[place]) * formation;
            }
            let [formed, sensible] = self.warmed(before, row);
            row[layout.owed_heat()] = energy - formed - sensible;
        }
        self.attempt = rows;
        self.show_attempt();
        Ok(())
    }

    fn changed(&self, rows: &[usize]) -> Inventory {
        let mut all = Inventory::default();
        if self.attempt.len() == self.count() * self.tell.end() {
            rows.iter().for_each(|&p| self.change_of(p, &mut all));
        }
        all
    }

    fn held(&self, rows: &[usize]) -> Inventory {
        let mut all = Inventory::default();
        rows.iter().for_each(|&p| self.holding_of(p, &mut all));
        all
    }

    fn begin_again(&mut self) {
        self.forget_resolved();
        self.begin();
    }

    fn commit(&mut self) -> Vec<usize> {
        let (width, told) = (self.layout.width(), self.tell.end());
        if self.attempt.len() == self.count() * told {
            for (p, row) in self.attempt.chunks_exact(told).enumerate() {
                self.committed[p * width..(p + 1) * width].copy_from_slice(&row[..width]);
            }
        }
        self.resolved.clear();
        self.begin();
        let solids = |p: &usize| {
            let row = self.row(*p);
            let shells = 0..self.shells_of(row);
            let mass: f64 = shells
                .map(|k| self.physics.chemistry.mass(self.shell_amounts(row, k)))
                .sum();
            mass <= self.used_up * row[self.layout.first_mass()]
        };
        (0..self.count()).filter(solids).collect()
    }

    fn change(&mut self, gone: &[usize], new: &[Newcomer<'_>]) -> Result<(), ModelError> {
        self.forget_resolved();
        let width = self.layout.width();
        let places: Vec<usize> = gone
            .iter()
            .flat_map(|row| row * width..(row + 1) * width)
            .collect();
        crate::without(&mut self.committed, &places);
        for one in new {
            one.only(&[TEMPERATURE])?;
            let kelvin = one.scalar(TEMPERATURE)?;
            let row = self.count();
            let made = self.newcomer(one, kelvin);
            self.committed
                .extend(made.map_err(|cause| ModelError::Particle {
                    row,
                    cause: Box::new(cause),
                })?);
        }
        self.begin();
        Ok(())
    }
}

impl Radial {
    /// The row of a particle that comes in.
    fn newcomer(&self, one: &Newcomer<'_>, kelvin: f64) -> Result<Vec<f64>, RadialError> {
        let layout = self.layout;
        let mut row = vec![0.0; layout.width()];
        let shells = match self.physics.numerics.resolution {
            ShellResolution::All => layout.shells,
            ShellResolution::One | ShellResolution::Beyond { .. } => 1,
        };
        row[RowLayout::SURFACE] = kelvin;
        row[layout.first_mass()] = one.mass;
        row[layout.first_volume()] = sphere::volume(one.radius);
        row[layout.count()] = shells as f64;
        for shell in 0..shells {
            let share = self.share(&row, shell);
            row[layout.temperatures().start + shell] = kelvin;
            for (k, per_mass) in self.composition.iter().enumerate() {
                row[layout.amounts().start + shell * layout.solids + k] =
                    share * per_mass * one.mass;
            }
            let volume = self.shell_volume(&row, shell);
            let filled = self.physics.filled(self.shell_amounts(&row, shell));
            if layout.gases > 0 && filled >= volume {
                return Err(RadialError::Porosity {
                    filled: filled / volume,
                });
            }
            let pores = &self.physics.pore_gas;
            let moles = pores.pressure * (volume - filled) / (GAS_CONSTANT * kelvin);
            for (k, fraction) in pores.fractions.iter().enumerate() {
                row[layout.gas().start + shell * layout.gases + k] = fraction * moles;
            }
        }
        Ok(row)
    }

    /// What follows from the committed rows, before any attempt.
    pub(super) fn begin(&mut self) {
        (self.tried, self.follows_network) = (false, false);
        self.attempt.clear();
        let mut bodies = std::mem::take(&mut self.bodies[1]);
        bodies.clear();
        for p in 0..self.count() {
            bodies.push(self, self.row(p));
        }
        self.bodies[0].clone_from(&bodies);
        self.bodies[1] = bodies;
    }

    /// What follows from the rows of the attempt.
    fn show_attempt(&mut self) {
        let mut bodies = std::mem::take(&mut self.bodies[0]);
        bodies.clear();
        for p in 0..self.count() {
            bodies.push(self, self.attempted(p));
        }
        self.bodies[0] = bodies;
    }

    /// Change of the mole fraction of a gas with its mass fraction, the others in their proportions.
    fn fraction_by_mass(&self, composition: &[f64], key: usize) -> f64 {
        let moles = |k: usize| composition[k] / self.physics.gas_mass[k];
        let (all, own) = (
            (0..composition.len()).map(moles).sum::<f64>(),
            1.0 / self.physics.gas_mass[key],
        );
        let others = composition.len().saturating_sub(1).max(1);
        let rest = 1.0 - composition[key];
        let other = if rest > 1e-9 {
            (all - moles(key)) / rest
        } else {
            // A pure gas: the others as they are one by one.
            let each = (0..composition.len()).filter(|k| *k != key);
            each.map(|k| 1.0 / self.physics.gas_mass[k]).sum::<f64>() / others as f64
        };
        own * other / (all * all)
    }

    /// Values of a column of a row.
    fn values(&self, kind: RadialColumn, row: &[f64], out: &mut Vec<f64>) {
        let layout = self.layout;
        let shells = 0..self.shells_of(row);
        match kind {
            RadialColumn::Surface => out.push(row[RowLayout::SURFACE]),
            RadialColumn::Shells => out.extend(shells.map(|k| self.shell_temperature(row, k))),
            RadialColumn::Amount(s) => out.extend(shells.map(|k| self.shell_amounts(row, k)[s])),
            RadialColumn::Pore(g) => out.extend(shells.map(|k| self.shell_gas(row, k)[g])),
            RadialColumn::OwedHeat => out.push(row[layout.owed_heat()]),
            RadialColumn::OwedGas(g) => out.push(row[layout.owed_gas().start + g]),
            RadialColumn::FirstMass => out.push(row[layout.first_mass()]),
            RadialColumn::FirstVolume => out.push(row[layout.first_volume()]),
            RadialColumn::Mean => {
                let (mut sum, mut all) = (0.0, 0.0);
                for k in shells {
                    let volume = self.shell_volume(row, k);
                    sum += volume * self.shell_temperature(row, k);
                    all += volume;
                }
                out.push(sum / all);
            }
            RadialColumn::Centre => out.push(self.shell_temperature(row, 0)),
            RadialColumn::Conversion => out.push(self.conversion(row, None)),
            RadialColumn::ShellConversion => {
                out.extend(shells.map(|k| self.conversion(row, Some(k))));
            }
            RadialColumn::Radii => {
                let mut within = 0.0;
                for k in shells {
                    within += self.shell_volume(row, k);
                    out.push(sphere::radius_of(within));
                }
            }
            RadialColumn::Count => out.push(self.shells_of(row) as f64),
            RadialColumn::Pressure => out.extend(shells.map(|k| self.shell_pressure(row, k))),
            RadialColumn::Porosity => out.extend(shells.map(|k| self.shell_porosity(row, k))),
            RadialColumn::ShellFraction(s) => out.extend(shells.map(|k| {
                let amounts = self.shell_amounts(row, k);
                let chemistry = &self.physics.chemistry;
                amounts[s] * chemistry.solids[s].molar_mass() / chemistry.mass(amounts)
            })),
            RadialColumn::Fraction(s) => {
                let molar = self.physics.chemistry.solids[s].molar_mass();
                let own: f64 = shells.map(|k| self.shell_amounts(row, k)[s]).sum();
                out.push(own * molar / self.mass(row));
            }
        }
    }

    /// Takes up values of a column of a row.
    fn take(
        &mut self,
        kind: RadialColumn,
        column: &StateColumn,
        p: usize,
        values: &[f64],
    ) -> Result<(), ModelError> {
        let layout = self.layout;
        let width = layout.width();
        let row = &mut self.committed[p * width..(p + 1) * width];
        let count = row[layout.count()] as usize;
        let wrong = |expected: String| ModelError::Column {
            column: column.name.clone(),
            found: format!("{} values of a particle", values.len()),
            expected,
        };
        if kind == RadialColumn::Shells {
            if values.len() != 1 && values.len() != layout.shells {
                return Err(wrong(format!(
                    "1 or {}: a particle keeps its shells over a run, so write `radial.shells` of its material as it was when the state \
                     was written, or begin anew without --resume and --from",
                    layout.shells
                )));
            }
            row[layout.count()] = values.len() as f64;
            let from = layout.temperatures().start;
            row[from..from + values.len()].copy_from_slice(values);
            return Ok(());
        }
        if column.shape == ColumnShape::Ragged && values.len() != count {
            return Err(wrong(format!("{count}, as it has shells")));
        }
        match kind {
            RadialColumn::Surface => row[RowLayout::SURFACE] = values[0],
            RadialColumn::OwedHeat => row[layout.owed_heat()] = values[0],
            RadialColumn::OwedGas(g) => row[layout.owed_gas().start + g] = values[0],
            RadialColumn::FirstMass => row[layout.first_mass()] = values[0],
            RadialColumn::FirstVolume => row[layout.first_volume()] = values[0],
            RadialColumn::Amount(s) => {
                for (k, value) in values.iter().enumerate() {
                    row[layout.amounts().start + k * layout.solids + s] = *value;
                }
            }
            RadialColumn::Pore(g) => {
                for (k, value) in values.iter().enumerate() {
                    row[layout.gas().start + k * layout.gases + g] = *value;
                }
            }
            _ => {}
        }
        Ok(())
    }
}

impl super::RadialBodies {
    fn clear(&mut self) {
        self.temperature.clear();
        self.mass.clear();
        self.radius.clear();
    }

    fn push(&mut self, of: &Radial, row: &[f64]) {
        self.temperature.push(row[RowLayout::SURFACE]);
        if !of.is_inert() {
            self.mass.push(of.mass(row));
        }
        if of.physics.bulk_volume.is_some() {
            self.radius.push(of.radius(row));
        }
    }
}
