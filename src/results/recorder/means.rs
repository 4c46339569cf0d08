//! Means over time of a run: begun, added to, written when their interval is over.

use calcine_coupler::observer::CommittedState;

use super::Recorder;
use crate::results::means::FieldMeans;
use crate::results::{ResultsError, files, resume, vtk};

impl Recorder {
    /// Begins means over time, or takes them up again.
    pub(super) fn begin_means(&mut self, moment: &CommittedState<'_>) -> Result<(), ResultsError> {
        let Some(spec) = &self.case.output.means else {
            return Ok(());
        };
        let species = self.case.gas.properties.species();
        let mut means = FieldMeans::new(spec, species, moment);
        if let Some(checkpoint) = &self.resumed_from {
            means.restore(checkpoint)?;
        }
        if !means.is_over(moment.clocks.process) {
            // Those of a run that had come further, or that begins again.
            resume::remove(&self.directory.join(files::MEANS))?;
        }
        self.means = Some(means);
        Ok(())
    }

    /// Adds a window to the means over time; when their interval is over, they are written.
    pub(super) fn average(&mut self, moment: &CommittedState<'_>) -> Result<(), ResultsError> {
        let Some(means) = &mut self.means else {
            return Ok(());
        };
        let Some(window) = moment.window else {
            return Ok(());
        };
        means.add(self.case.gas.properties.species(), moment);
        let was_over = means.is_over(window.start.process);
        if was_over || !means.is_over(moment.clocks.process) {
            return Ok(());
        }
        let (Some(means), Some(open)) = (&self.means, &mut self.open) else {
            return Ok(());
        };
        let path = self.directory.join(files::MEANS);
        let interval = means.interval();
        means.with_fields(moment.mesh, |fields| {
            vtk::write_gas(&path, moment.mesh, &open.cells, interval[1], fields)?;
            open.store.means(interval, fields)
        })
    }
}
