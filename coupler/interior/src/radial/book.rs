//! What particles with shells hold, and what it follows from.

use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::sphere;
use calcine_physics::thermo::Element;

use super::Radial;
use crate::model::{Inventory, Tally};

impl Radial {
    /// Volume in m³ of a shell of a row.
    pub(super) fn shell_volume(&self, row: &[f64], shell: usize) -> f64 {
        let first = row[self.layout.first_volume()];
        let share = self.share(row, shell);
        self.physics
            .volume(self.shell_amounts(row, shell), share * first, share)
    }

    /// Share of a shell in the volume with which its particle came.
    pub(super) fn share(&self, row: &[f64], shell: usize) -> f64 {
        match self.shells_of(row) {
            1 => 1.0,
            _ => self.physics.shares[shell],
        }
    }

    /// Amounts in mol of the solids in a shell.
    pub(super) fn shell_amounts<'a>(&self, row: &'a [f64], shell: usize) -> &'a [f64] {
        let (from, s) = (self.layout.amounts().start, self.layout.solids);
        &row[from + shell * s..from + (shell + 1) * s]
    }

    /// Amounts in mol of the gases in a shell.
    pub(super) fn shell_gas<'a>(&self, row: &'a [f64], shell: usize) -> &'a [f64] {
        let (from, g) = (self.layout.gas().start, self.layout.gases);
        &row[from + shell * g..from + (shell + 1) * g]
    }

    /// Temperature in K of a shell.
    pub(super) fn shell_temperature(&self, row: &[f64], shell: usize) -> f64 {
        row[self.layout.temperatures().start + shell]
    }

    /// Radius in m.
    pub(super) fn radius(&self, row: &[f64]) -> f64 {
        let shells = 0..self.shells_of(row);
        sphere::radius_of(shells.map(|k| self.shell_volume(row, k)).sum::<f64>())
    }

    /// Pressure in Pa in the pores of a shell.
    pub(super) fn shell_pressure(&self, row: &[f64], shell: usize) -> f64 {
        let amounts = self.shell_amounts(row, shell);
        let pores = self.shell_volume(row, shell) - self.physics.filled(amounts);
        let moles: f64 = self.shell_gas(row, shell).iter().sum();
        moles * GAS_CONSTANT * self.shell_temperature(row, shell) / pores
    }

    /// Porosity of a shell.
    pub(super) fn shell_porosity(&self, row: &[f64], shell: usize) -> f64 {
        1.0 - self.physics.filled(self.shell_amounts(row, shell)) / self.shell_volume(row, shell)
    }

    /// Mass in kg, with the gas in its pores.
    pub(super) fn mass(&self, row: &[f64]) -> f64 {
        let mut mass = 0.0;
        for shell in 0..self.shells_of(row) {
            mass += self.physics.chemistry.mass(self.shell_amounts(row, shell));
            let gas = self
                .shell_gas(row, shell)
                .iter()
                .zip(&self.physics.gas_mass);
            mass += gas.map(|(n, molar)| n * molar).sum::<f64>();
        }
        mass
    }

    /// Share of the first reaction's solid that is converted: of a shell, or of the whole.
    pub(super) fn conversion(&self, row: &[f64], shell: Option<usize>) -> f64 {
        let Some(&solid) = self.physics.reactant.first() else {
            return 0.0;
        };
        let shells = match shell {
            Some(one) => one..one + 1,
            None => 0..self.shells_of(row),
        };
        let first = self.composition[solid] * row[self.layout.first_mass()];
        let (mut left, mut all) = (0.0, 0.0);
        for k in shells {
            left += self.shell_amounts(row, k)[solid];
            all += first * self.share(row, k);
        }
        if all > 0.0 { 1.0 - left / all } else { 0.0 }
    }

    /// Sensible enthalpy in J of a shell of a row.
    pub(super) fn sensible(&self, row: &[f64], shell: usize) -> f64 {
        let kelvin = self.shell_temperature(row, shell);
        let chemistry = &self.physics.chemistry;
        let solids = chemistry.enthalpy(self.shell_amounts(row, shell), kelvin);
        let Some(gas) = &chemistry.gas else {
            return solids;
        };
        let parts = self.shell_gas(row, shell).iter().zip(gas.species());
        let gases = parts.map(|(n, one)| n * one.molar_mass() * one.enthalpy(kelvin));
        solids + gases.sum::<f64>()
    }

    /// Change of enthalpy in J between two rows of as many shells, what is owed apart: of formation, and sensible.
    pub(super) fn warmed(&self, before: &[f64], now: &[f64]) -> [f64; 2] {
        let (mut formed, mut sensible) = (0.0, 0.0);
        for shell in 0..self.shells_of(before) {
            sensible += self.sensible(now, shell) - self.sensible(before, shell);
            let pairs = self
                .shell_amounts(now, shell)
                .iter()
                .zip(self.shell_amounts(before, shell));
            for ((now, before), solid) in pairs.zip(&self.physics.chemistry.solids) {
                formed += (now - before) * solid.formation_enthalpy();
            }
            let pairs = self
                .shell_gas(now, shell)
                .iter()
                .zip(self.shell_gas(before, shell));
            for ((now, before), formation) in pairs.zip(&self.physics.gas_formation) {
                formed += (now - before) * formation;
            }
        }
        [formed, sensible]
    }

    /// Adds what the amounts of shells are, or differ by, to an inventory.
    fn count_amounts(
        &self,
        shell: usize,
        (now, before): (&[f64], Option<&[f64]>),
        all: &mut Inventory,
    ) {
        let chemistry = &self.physics.chemistry;
        let less = |list: Option<&[f64]>, k: usize| list.map_or(0.0, |list| list[k]);
        let amounts = self.shell_amounts(now, shell);
        let others = before.map(|row| self.shell_amounts(row, shell));
        for (k, (n, solid)) in amounts.iter().zip(&chemistry.solids).enumerate() {
            self.add_amount(all, n - less(others, k), solid.molar_mass(), solid.atoms());
        }
        let gases = before.map(|row| self.shell_gas(row, shell));
        for (k, n) in self.shell_gas(now, shell).iter().enumerate() {
            self.count_gas(all, k, n - less(gases, k));
        }
    }

    fn count_gas(&self, all: &mut Inventory, k: usize, amount: f64) {
        if let Some(gas) = &self.physics.chemistry.gas {
            let one = &gas.species()[k];
            self.add_amount(all, amount, one.molar_mass(), one.atoms());
        }
    }

    fn add_amount(
        &self,
        all: &mut Inventory,
        amount: f64,
        molar_mass: f64,
        atoms: &[f64; Element::COUNT],
    ) {
        all.mass.add(molar_mass * amount);
        if self.is_inert() {
            return;
        }
        let each = all.elements.iter_mut().zip(atoms).zip(Element::ALL);
        for ((sum, atoms), element) in each.filter(|((_, atoms), _)| **atoms != 0.0) {
            sum.add(atoms * element.molar_mass() * amount);
        }
    }

    /// True where nothing reacts and no gas is in pores: what it is made of does not count.
    pub(super) fn is_inert(&self) -> bool {
        self.physics.reactions() == 0 && self.layout.gases == 0
    }

    /// What the last attempt changed in a row.
    pub(super) fn change_of(&self, p: usize, all: &mut Inventory) {
        let (before, now) = (self.row(p), self.attempted(p));
        for shell in 0..self.shells_of(before) {
            self.count_amounts(shell, (now, Some(before)), all);
        }
        let [formed, sensible] = self.warmed(before, now);
        let owed = self.layout.owed_heat();
        let mut energy = formed + sensible + (now[owed] - before[owed]);
        for (k, place) in self.layout.owed_gas().enumerate() {
            let change = now[place] - before[place];
            self.count_gas(all, k, change);
            energy += change * self.physics.gas_formation[k];
        }
        all.energy += Tally {
            sum: energy,
            magnitude: sensible.abs() + self.reaction_heat(before, now),
        };
    }

    /// Heat in J of what solids changed, by their formation: about that of the reactions.
    fn reaction_heat(&self, before: &[f64], now: &[f64]) -> f64 {
        let mut sum = 0.0;
        let (solids, gases) = (&self.physics.chemistry.solids, &self.physics.gas_formation);
        for shell in 0..self.shells_of(before) {
            let pairs = self
                .shell_amounts(now, shell)
                .iter()
                .zip(self.shell_amounts(before, shell));
            for ((now, before), solid) in pairs.zip(solids) {
                sum += (now - before) * solid.formation_enthalpy();
            }
        }
        for (k, formation) in gases.iter().enumerate() {
            sum += self.made_of(k, before, now) * formation;
        }
        sum.abs()
    }

    /// Moles of a gas that the solids' changes make, by the gas that left and what pores hold.
    fn made_of(&self, k: usize, before: &[f64], now: &[f64]) -> f64 {
        let flow = now
            .get(self.tell.flow().start + k)
            .copied()
            .unwrap_or_default();
        let span = self.last_span;
        let mut made = flow * span;
        for shell in 0..self.shells_of(before) {
            made += self.shell_gas(now, shell)[k] - self.shell_gas(before, shell)[k];
        }
        made
    }

    /// What a row holds at the last commit.
    pub(super) fn holding_of(&self, p: usize, all: &mut Inventory) {
        let row = self.row(p);
        let mut energy = row[self.layout.owed_heat()];
        for shell in 0..self.shells_of(row) {
            self.count_amounts(shell, (row, None), all);
            energy += self.sensible(row, shell);
            let solids = self
                .shell_amounts(row, shell)
                .iter()
                .zip(&self.physics.chemistry.solids);
            energy += solids
                .map(|(n, solid)| n * solid.formation_enthalpy())
                .sum::<f64>();
            let gases = self
                .shell_gas(row, shell)
                .iter()
                .zip(&self.physics.gas_formation);
            energy += gases.map(|(n, formation)| n * formation).sum::<f64>();
        }
        for (k, place) in self.layout.owed_gas().enumerate() {
            self.count_gas(all, k, row[place]);
            energy += row[place] * self.physics.gas_formation[k];
        }
        all.energy.add(energy);
    }
}
