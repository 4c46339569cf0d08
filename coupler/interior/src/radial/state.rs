//! Where the values of a particle stand in its row.

use std::ops::Range;

/// The row of a particle: temperature of the surface; of the shells temperatures in K, amounts of solids and of gases in mol; what is
/// owed to it of heat in J and of gases in mol; mass and volume with which it came; its number of shells. A particle of one shell leaves
/// the room of the others zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RowLayout {
    pub shells: usize,
    pub solids: usize,
    pub gases: usize,
}

impl RowLayout {
    pub const SURFACE: usize = 0;

    pub fn temperatures(&self) -> Range<usize> {
        1..1 + self.shells
    }

    pub fn amounts(&self) -> Range<usize> {
        let from = self.temperatures().end;
        from..from + self.shells * self.solids
    }

    pub fn gas(&self) -> Range<usize> {
        let from = self.amounts().end;
        from..from + self.shells * self.gases
    }

    pub fn owed_heat(&self) -> usize {
        self.gas().end
    }

    pub fn owed_gas(&self) -> Range<usize> {
        let from = self.owed_heat() + 1;
        from..from + self.gases
    }

    pub fn first_mass(&self) -> usize {
        self.owed_gas().end
    }

    pub fn first_volume(&self) -> usize {
        self.first_mass() + 1
    }

    pub fn count(&self) -> usize {
        self.first_mass() + 2
    }

    pub fn width(&self) -> usize {
        self.first_mass() + 3
    }
}

/// What an attempt says beside the state at its end, behind it in the row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TellLayout {
    /// Where it begins.
    pub from: usize,
    pub gases: usize,
}

impl TellLayout {
    pub const HEAT: usize = 0;
    pub const HEAT_SLOPE: usize = 1;
    pub const SURFACE_SLOPE: usize = 2;
    pub const SURFACE_BY_HEAT: usize = 3;
    pub const RELEASED: usize = 4;
    pub const GAS_TEMPERATURE: usize = 5;
    pub const NETWORK: usize = 6;
    pub const STEPS: usize = 7;
    pub const FALLEN: usize = 8;
    /// Difference of temperature in K and of partial pressures over the pressure that a particle of one shell hides.
    pub const HIDDEN: usize = 9;
    pub const ROUNDS: usize = 11;
    /// Means of the temperature of the surface in K and of its fourth power in K⁴.
    pub const SURFACE_MEAN: usize = 12;
    const FLOWS: usize = 14;

    pub fn flow(&self) -> Range<usize> {
        let from = self.from + Self::FLOWS;
        from..from + self.gases
    }

    pub fn slope(&self) -> Range<usize> {
        let from = self.flow().end;
        from..from + self.gases
    }

    pub fn end(&self) -> usize {
        self.slope().end
    }
}
