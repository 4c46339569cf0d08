//! Particles with `inside = "auto"` that get their shells (docs/theory.md, XDP-18).

use super::Radial;
use super::grid::mean_squares;
use super::material::ShellResolution;
use super::state::{RowLayout, TellLayout};
use super::transport::Outside;
use super::workspace::RadialWorkspace;

/// The mean of r² over a sphere, as a share of that of its surface.
const MEAN_SQUARE: f64 = 0.6;
/// The difference between centre and surface of a parabola over that between its mean and its surface.
const WHOLE: f64 = 1.0 / (1.0 - MEAN_SQUARE);
/// Share of its mean below which a profile does not begin: what steady heating has is not steeper at any tolerance of use.
const LEAST_TEMPERATURE: f64 = 0.5;
/// Share of the pressure below which no gas matters.
const TRACE: f64 = 1e-6;
/// Rounds of Newton's method that move a profile to its enthalpy.
const ROUNDS: usize = 4;

impl Radial {
    /// Particles of one shell that hide more at the end of an attempt than the tolerances, in ascending order.
    pub(super) fn hiding(&self, rows: &[f64]) -> Vec<usize> {
        let ShellResolution::Beyond {
            temperature,
            pressure,
        } = self.physics.numerics.resolution
        else {
            return Vec::new();
        };
        let rows = rows.chunks_exact(self.tell.end()).enumerate();
        let beyond = rows.filter(|(_, row)| {
            let tell = &row[self.tell.from..];
            tell[TellLayout::HIDDEN] > temperature || tell[TellLayout::HIDDEN + 1] > pressure
        });
        beyond.map(|(p, _)| p).collect()
    }

    /// Gives a committed particle of one shell all of them until the window is given up. One shell stands for the parabola that steady
    /// heating has between its mean temperature and its surface: the shells get it, moved as a whole to the enthalpy that there is; what
    /// round-off leaves of that is owed. Solids are as they were everywhere, and gases at one pressure.
    pub(super) fn resolve(&mut self, p: usize) {
        let layout = self.layout;
        let before = self.row(p);
        let mut row = before.to_vec();
        let (t, n, g) = (
            layout.temperatures().start,
            layout.amounts().start,
            layout.gas().start,
        );
        row[layout.count()] = layout.shells as f64;
        let (mean, surface) = (before[t], before[RowLayout::SURFACE]);
        let least = (LEAST_TEMPERATURE - 1.0) * mean;
        let rise = (WHOLE * (mean - surface)).max(least / MEAN_SQUARE);
        let squares = mean_squares(&self.physics.shares);
        for (kelvin, square) in row[t..].iter_mut().zip(&squares) {
            *kelvin = mean + rise * (MEAN_SQUARE - square);
        }
        // Pores hold of each gas by 1/T.
        let shares = self.physics.shares.iter().zip(&row[t..]);
        let held: Vec<f64> = shares.map(|(share, kelvin)| share / kelvin).collect();
        let all: f64 = held.iter().sum();
        for (shell, (share, held)) in self.physics.shares.iter().zip(&held).enumerate() {
            for k in 0..layout.solids {
                row[n + shell * layout.solids + k] = share * before[n + k];
            }
            for k in 0..layout.gases {
                row[g + shell * layout.gases + k] = held / all * before[g + k];
            }
        }
        let enthalpy = |row: &[f64]| -> f64 {
            let shells = 0..self.shells_of(row);
            shells.map(|shell| self.sensible(row, shell)).sum()
        };
        let moved = |row: &[f64], by: f64| {
            let mut moved = row.to_vec();
            let shells = moved[t..t + layout.shells].iter_mut();
            shells.for_each(|kelvin| *kelvin += by);
            moved
        };
        let whole = enthalpy(before);
        for _ in 0..ROUNDS {
            let now = enthalpy(&row);
            let capacity = enthalpy(&moved(&row, 1.0)) - now;
            row = moved(&row, (whole - now) / capacity);
        }
        row[layout.owed_heat()] += whole - enthalpy(&row);
        let width = layout.width();
        let own = &mut self.committed[p * width..(p + 1) * width];
        let before = own.to_vec();
        own.copy_from_slice(&row);
        self.resolved.push((p, before));
    }

    /// Takes the shells from the particles that got them since the last commit.
    pub(super) fn forget_resolved(&mut self) {
        let width = self.layout.width();
        for (p, before) in std::mem::take(&mut self.resolved) {
            self.committed[p * width..(p + 1) * width].copy_from_slice(&before);
        }
    }
}

/// What one shell hides: the difference in K between centre and surface of a parabola with the heat that passes the surface, and that of
/// the partial pressure of a gas with the flow that does, of the gas for which it is largest: over the pressure of a gas that comes out,
/// and over that of the gas itself at the surface of one that goes in, since what uses it follows it however lean it is.
pub(super) fn hidden(lane: usize, ws: &RadialWorkspace, outside: &Outside<'_>) -> [f64; 2] {
    let now = &ws.start;
    let kelvin = WHOLE * (now.temperature[0][lane] - now.temperature[1][lane]).abs();
    let g = ws.gases;
    let shares = (0..g).map(|k| {
        let [inside, surface] = [k, g + k].map(|row| now.pressure[row][lane]);
        share_of(inside, surface, outside.pressure)
    });
    [kelvin, WHOLE * shares.fold(0.0, f64::max)]
}

/// The difference of the partial pressures in Pa inside and at the surface of a gas, as a share.
fn share_of(inside: f64, surface: f64, pressure: f64) -> f64 {
    match surface > inside {
        true => (surface - inside) / surface.max(TRACE * pressure),
        false => (inside - surface) / pressure,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lean_gas_that_is_used_counts_by_itself_and_one_that_is_made_by_the_pressure() {
        assert_eq!(share_of(500.0, 1000.0, 1e5), 0.5);
        assert_eq!(share_of(2000.0, 1000.0, 1e5), 0.01);
        // A trace, and what is nowhere.
        assert_eq!(share_of(0.0, 1e-3, 1e5), 0.01);
        assert_eq!(share_of(0.0, 0.0, 1e5), 0.0);
    }
}
