//! How drag acts on particles that move within a window, and what the gas owes where it follows them.

use calcine_physics::Vec3;

use crate::smoother::Operator;

/// How drag acts on particles that move within a window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WindowDrag {
    /// A constant force, the mean over the window (docs/theory.md, DRG-2).
    #[default]
    Constant,
    /// By coefficient and gas velocity, following each particle's own velocity step by step (docs/theory.md, DRG-3).
    Following,
}

impl WindowDrag {
    /// True where drag follows the particles.
    pub fn follows(self) -> bool {
        self == Self::Following
    }
}

/// The impulse of drag that the particles got beyond what the gas of a window gave them: the gas gives it in the next
/// window (docs/theory.md, DRG-3).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DragCarry {
    /// In N s, by cell; empty where nothing is owed.
    owed: Vec<Vec3>,
    /// Their sum at the end of the window before.
    before: Vec3,
}

impl DragCarry {
    /// What is owed in N s, by cell; empty where nothing is.
    pub fn owed(&self) -> &[Vec3] {
        &self.owed
    }

    /// What is owed in N s by all cells together.
    pub fn total(&self) -> Vec3 {
        self.owed.iter().sum()
    }

    /// What is owed at the end of the last window less what was at its start, in N s: what the particles got in it and the
    /// gas did not give.
    pub fn change(&self) -> Vec3 {
        self.total() - self.before
    }

    /// The gas has given what it owed.
    pub fn settle(&mut self) {
        self.before = self.total();
        self.owed.clear();
    }

    /// The particles got these impulses in N s beyond what the gas gave in the window; after [`DragCarry::settle`].
    pub fn carry(&mut self, operator: &Operator, beyond: &[Vec3]) {
        self.owed.resize(operator.cells(), Vec3::zeros());
        operator.spread_vectors(beyond, &mut self.owed);
    }

    /// Takes up what is owed as a checkpoint has it.
    pub fn restore(&mut self, owed: Vec<Vec3>) {
        self.owed = owed;
    }
}
