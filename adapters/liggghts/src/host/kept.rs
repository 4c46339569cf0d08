//! Forces across a checkpoint.
//!
//! LIGGGHTS' restart files hold no forces: its setup evaluates them anew, with the velocities of whole steps, where the run
//! would have gone on with those of the half step. So they are written into the restart file by a fix of their own, and
//! stand in place of what the setup found once that file is read.

use super::Host;
use crate::drag;
use crate::error::HostError;

/// The fix; it is there only while a restart file is written or read.
const KEPT: &str = "calcine_kept";
/// Arrays of particles that are kept, beside the forces of walls that are counted.
const ARRAYS: [&str; 2] = ["f", "torque"];

impl Host {
    /// Numbers of each particle.
    fn kept_numbers(&self) -> usize {
        3 * (ARRAYS.len() + self.walls.len())
    }

    /// Makes the fix; where a restart file has been read, it takes up what that holds.
    pub(super) fn make_kept(&mut self) {
        let zeros = " 0.".repeat(self.kept_numbers());
        self.liggghts.command(&format!(
            "fix {KEPT} all property/atom {KEPT} vector yes no no{zeros}"
        ));
    }

    /// Makes the fix and writes forces without drag, torques and the forces of counted walls into it.
    pub(super) fn keep_forces(&mut self) -> Result<(), HostError> {
        drag::take_off(&mut self.liggghts);
        self.make_kept();
        let mut columns = Vec::new();
        for name in ARRAYS {
            let found = self.liggghts.vectors(name);
            columns.push(found.ok_or(HostError::Missing { name })?.to_vec());
        }
        for wall in &self.walls {
            let found = self.liggghts.fix_vectors_mut(wall);
            columns.push(found.unwrap_or_default().to_vec());
        }
        let numbers = self.kept_numbers();
        let rows = self.liggghts.fix_rows_mut(KEPT, numbers);
        let rows = rows.ok_or(HostError::Missing { name: KEPT })?;
        for (place, row) in rows.chunks_exact_mut(numbers).enumerate() {
            for (column, values) in row.chunks_exact_mut(3).zip(&columns) {
                values
                    .chunks_exact(3)
                    .skip(place)
                    .take(1)
                    .for_each(|own| column.copy_from_slice(own));
            }
        }
        Ok(())
    }

    /// Puts them in place of what the setup found, and takes the fix away.
    pub(super) fn take_kept(&mut self) -> Result<(), HostError> {
        let numbers = self.kept_numbers();
        let rows = self.liggghts.fix_rows_mut(KEPT, numbers);
        let rows = rows.ok_or(HostError::Missing { name: KEPT })?.to_vec();
        let column = |k: usize| {
            let own = rows.chunks_exact(numbers);
            own.flat_map(move |row| row[3 * k..3 * k + 3].iter().copied())
        };
        for (k, name) in ARRAYS.into_iter().enumerate() {
            let found = self.liggghts.vectors_mut(name);
            let found = found.ok_or(HostError::Missing { name })?;
            found
                .iter_mut()
                .zip(column(k))
                .for_each(|(to, value)| *to = value);
        }
        for (k, wall) in self.walls.iter().enumerate() {
            let found = self.liggghts.fix_vectors_mut(wall).unwrap_or_default();
            let kept = column(ARRAYS.len() + k);
            found
                .iter_mut()
                .zip(kept)
                .for_each(|(to, value)| *to = value);
        }
        self.liggghts.command(&format!("unfix {KEPT}"));
        Ok(())
    }
}
