//! What goes in comes out, is held, or is heat.

use super::topology::Plant;

/// One balance: of a unit or the plant, of a compound, of all mass or of enthalpy, in kg or J since the start.
#[derive(Clone, Debug, PartialEq)]
pub struct LedgerLine {
    /// Unit, or "plant".
    pub place: String,
    /// Compound, "mass" or "enthalpy".
    pub what: String,
    /// What came in.
    pub enters: f64,
    /// What went out.
    pub leaves: f64,
    /// By how much what is held grew.
    pub stored: f64,
    /// Heat from drives and heaters.
    pub heat: f64,
    /// enters + heat − leaves − stored.
    pub missing: f64,
    /// |missing| relative to the sum of the terms and of what is held.
    pub relative_error: f64,
}

/// All balances.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlantLedger {
    /// Lines, unit by unit, then of the plant.
    pub lines: Vec<LedgerLine>,
    /// Each tear stream with its largest difference from itself over all evaluations that were kept, relative to its flow.
    pub tears: Vec<(String, f64)>,
}

impl PlantLedger {
    /// Largest difference of a tear stream from itself.
    pub fn closure(&self) -> f64 {
        self.tears.iter().map(|tear| tear.1).fold(0.0, f64::max)
    }

    /// Largest relative error.
    pub fn worst(&self) -> f64 {
        self.lines
            .iter()
            .map(|line| line.relative_error)
            .fold(0.0, f64::max)
    }
}

impl Plant {
    /// What each unit holds, by kinds.
    pub(super) fn held(&self, y: &[f64]) -> Vec<Vec<f64>> {
        let hold = |unit: &super::PlantUnit| {
            let mut held = vec![0.0; self.layout.width()];
            unit.unit
                .held(&self.layout, &y[unit.state.clone()], &mut held);
            let mut kinds = vec![0.0; self.layout.compounds().len() + 1];
            self.layout.kinds(&held, &mut kinds);
            kinds
        };
        self.units.iter().map(hold).collect()
    }

    /// The ledger since the start: what was held then and is held now, and totals.
    pub(super) fn ledger(
        &self,
        before: &[Vec<f64>],
        now: &[Vec<f64>],
        totals: &[f64],
        closures: &[f64],
    ) -> PlantLedger {
        let compounds = self.layout.compounds();
        let kinds = compounds.len() + 1;
        let (of_streams, heats) = totals.split_at(self.names.len() * kinds);
        let total = |stream: usize, kind: usize| of_streams[stream * kinds + kind];
        let mut lines = Vec::new();
        // Of the plant: enters, leaves, stored, held; compound by compound, then enthalpy.
        let mut plant = vec![[0.0; 5]; kinds];
        for (index, unit) in self.units.iter().enumerate() {
            let mut sums = vec![[0.0; 5]; kinds];
            for (kind, sum) in sums.iter_mut().enumerate() {
                let enters: f64 = unit.inlets.iter().map(|s| total(*s, kind)).sum();
                let leaves: f64 = unit.outlets.clone().map(|s| total(s, kind)).sum();
                let heat = if kind == compounds.len() {
                    heats[index]
                } else {
                    0.0
                };
                let (old, new) = (before[index][kind], now[index][kind]);
                *sum = [enters, leaves, new - old, heat, old.abs() + new.abs()];
                let whole = &mut plant[kind];
                let (first, last) = (unit.inlets.is_empty(), unit.outlets.is_empty());
                whole[0] += if first { leaves } else { 0.0 };
                whole[1] += if last { enters } else { 0.0 };
                for place in [2, 3, 4] {
                    whole[place] += sum[place];
                }
            }
            // What enters and leaves the plant is made and ended there.
            if !unit.inlets.is_empty() && !unit.outlets.is_empty() {
                self.add_lines(&unit.name, &sums, &mut lines);
            }
        }
        self.add_lines("plant", &plant, &mut lines);
        let tears = self.tears().into_iter().zip(closures);
        PlantLedger {
            lines,
            tears: tears.map(|(name, own)| (name.to_owned(), *own)).collect(),
        }
    }

    fn add_lines(&self, place: &str, sums: &[[f64; 5]], lines: &mut Vec<LedgerLine>) {
        let compounds = self.layout.compounds();
        let mut add = |what: &str, sum: &[f64; 5]| {
            let [enters, leaves, stored, heat, held] = *sum;
            let missing = enters + heat - leaves - stored;
            let size = enters.abs() + leaves.abs() + heat.abs() + held;
            lines.push(LedgerLine {
                place: place.to_owned(),
                what: what.to_owned(),
                enters,
                leaves,
                stored,
                heat,
                missing,
                relative_error: if missing == 0.0 {
                    0.0
                } else {
                    missing.abs() / size
                },
            });
        };
        let mut mass = [0.0; 5];
        for (compound, sum) in compounds.iter().zip(sums) {
            add(&compound.name, sum);
            mass.iter_mut().zip(sum).for_each(|(m, s)| *m += s);
        }
        add("mass", &mass);
        add("enthalpy", &sums[compounds.len()]);
    }
}
