//! A plant's run from its case to its results folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use calcine_coupler::supervisor::Interrupts;
use calcine_flowsheet::{CoupledBed, PlantError, PlantRun};

use super::bed::{self, BedOfPlant, PlantBed, SharedBed};
use super::checkpoint::{PlantCheckpoint, Written};
use super::error::PlantRunError;
use super::files::{
    Table, TimeTable, distribution_head, distribution_rows, series_head, write_streams,
};
use super::measure::{Column, columns, row};
use super::progress::PlantProgress;
use super::quantities::{Measured, results, verdict};
use super::summary::{KIND, PlantLedgerSummary, PlantSummary};
use super::{steady, store};
use crate::case::plant::{PlantCase, PlantField};
use crate::results::files::{DISTRIBUTIONS, SERIES, STREAMS};
use crate::results::sheet::number;
use crate::results::summary::{CaseName, RunFailure};
use crate::results::{CASE, CaseIdentity, ResultsError, SUMMARY, Verdict, files, kind, same_case};
use crate::simulation::claim;
use crate::standard_error::tell_line;

/// How a run begins, and what it shows.
pub struct PlantStart<'a> {
    /// Results folder.
    pub out: &'a Path,
    /// Continues from the checkpoint in it, or begins where there is none yet.
    pub resume: bool,
    /// Results folder of another run whose last state it begins from.
    pub from: Option<&'a Path>,
    /// The command by which it is resumed, kept in the folder where that is new.
    pub command: Option<String>,
    /// It is the last of a tuning, whose folder this is.
    pub tuned: bool,
    /// Shows a progress bar.
    pub progress: bool,
    /// One leaves a checkpoint after the row of the series that is computed.
    pub interrupts: Interrupts,
}

/// How a run ended.
#[derive(Debug)]
pub enum PlantEnding {
    /// At its end.
    Finished(Box<PlantSummary>),
    /// It had come to its end before.
    Complete(Box<PlantSummary>),
    /// With a checkpoint in this file.
    Checkpointed(PathBuf),
}

/// A run under way.
struct Driven<'a> {
    case: &'a PlantCase,
    out: &'a Path,
    run: PlantRun<'a>,
    columns: Vec<Column>,
    series: Table,
    distributions: Table,
    /// Rows of the series.
    rows: u64,
    next_distributions: f64,
    /// Wall time of the stretches before in s.
    before: f64,
    begun: Instant,
    from: Option<String>,
    /// Beds that are cases of their own, in the order of the case.
    beds: Vec<SharedBed>,
}

/// Gives a run its beds.
fn couple(run: &mut PlantRun<'_>, beds: Vec<PlantBed>) -> Result<Vec<SharedBed>, PlantError> {
    let beds: Vec<SharedBed> = beds
        .into_iter()
        .map(|bed| Arc::new(Mutex::new(bed)))
        .collect();
    if !beds.is_empty() {
        let own = beds
            .iter()
            .map(|bed| -> Box<dyn CoupledBed> { Box::new(BedOfPlant(Arc::clone(bed))) });
        run.couple(own.collect())?;
    }
    Ok(beds)
}

/// Follows a plant to the end of its case, or to an interrupt.
pub fn run_plant(case: &PlantCase, start: &PlantStart<'_>) -> Result<PlantEnding, PlantRunError> {
    let out = start.out;
    if let Some(summary) = occupied(out, case, start.resume)? {
        return Ok(PlantEnding::Complete(Box::new(summary)));
    }
    let fresh = !out.join(SUMMARY).exists();
    let claimed = claim(out, start.resume || start.tuned)?;
    // Before the run: a kill leaves what `--resume` needs.
    if let Some(command) = start.command.as_ref().filter(|_| fresh) {
        files::replace(&out.join(files::COMMAND), command.as_bytes())?;
    }
    let mut driven = begin(case, start)?;
    let _lock = claimed.keep();
    files::replace(&out.join(CASE), case.effective.as_bytes())?;
    let mut progress = PlantProgress::new(out, driven.run.time(), case.end, start.progress);
    driven.summary(Verdict::Running)?.replace(out)?;
    match driven.follow(start, &mut progress) {
        Ok(true) => {}
        Ok(false) => {
            let path = driven.checkpoint()?;
            driven.end_beds()?;
            driven.summary(Verdict::Stopped)?.replace(out)?;
            progress.show(driven.run.time(), "stopped")?;
            return Ok(PlantEnding::Checkpointed(path));
        }
        Err(error) => {
            let mut summary = driven.summary(Verdict::Stopped)?;
            summary.failure = Some(RunFailure {
                code: error.exit_code(),
                message: error.to_string(),
            });
            summary.replace(out)?;
            progress.show(driven.run.time(), "stopped")?;
            return Err(error);
        }
    }
    driven.checkpoint()?;
    driven.end_beds()?;
    let summary = driven.finish();
    let summary = summary.inspect_err(|_| {
        // The error is the one to tell; the state at the end is kept.
        let _ = driven
            .summary(Verdict::Stopped)
            .map(|summary| summary.replace(out));
    })?;
    progress.show(driven.run.time(), "complete")?;
    Ok(PlantEnding::Finished(Box::new(summary)))
}

/// Refuses a folder with another run's results; the summary where the run to resume is complete.
fn occupied(
    out: &Path,
    case: &PlantCase,
    resume: bool,
) -> Result<Option<PlantSummary>, PlantRunError> {
    if !out.join(SUMMARY).is_file() {
        return Ok(None);
    }
    if kind(out) != KIND {
        return Err(PlantRunError::Results(ResultsError::Content {
            path: out.join(SUMMARY),
            fact: "it holds the results of a bed: name another folder with `--out`".into(),
        }));
    }
    let summary = PlantSummary::read(out)?;
    if !resume {
        return Err(PlantRunError::Results(ResultsError::Occupied {
            path: out.to_owned(),
            case: summary.case.name,
            state: match summary.verdict {
                Verdict::Running => "running",
                Verdict::Stopped => "stopped",
                _ => "complete",
            },
            time: summary.time_s,
        }));
    }
    same_case(out, &summary.case.hash, identity(case))?;
    if !summary.is_complete() {
        return Ok(None);
    }
    for name in [SERIES, DISTRIBUTIONS, STREAMS] {
        let path = out.join(name);
        if !path.is_file() {
            let fact = "is missing".into();
            return Err(ResultsError::Spoilt { path, fact }.into());
        }
    }
    Ok(Some(summary))
}

/// The case of a plant, of which no files are kept.
fn identity(case: &PlantCase) -> CaseIdentity<'_> {
    CaseIdentity {
        effective: &case.effective,
        hash: &case.hash,
        files: None,
    }
}

/// The run at its start, or where its checkpoint stands.
fn begin<'a>(case: &'a PlantCase, start: &PlantStart<'a>) -> Result<Driven<'a>, PlantRunError> {
    let (plant, out) = (&case.plant, start.out);
    let columns = columns(plant);
    let (integrator, tolerance) = (case.method.integrator, case.method.tolerance);
    let saved = match start.resume {
        true => PlantCheckpoint::recover(out)?,
        false => None,
    };
    if let Some((saved, told)) = saved {
        if let Some(told) = told {
            tell_line(format_args!("warning: {told}"));
        }
        same_case(out, &saved.case_hash, identity(case))?;
        let mut run = PlantRun::new(plant, integrator, tolerance)?;
        // Nothing is cut where another is not as it was.
        saved.series.check(&out.join(SERIES))?;
        saved.distributions.check(&out.join(DISTRIBUTIONS))?;
        let series = Table::resume(out, SERIES, &saved.series)?;
        let distributions = Table::resume(out, DISTRIBUTIONS, &saved.distributions)?;
        let (rows, next, wall) = (saved.rows, saved.next_distributions, saved.wall);
        let from = saved.from.clone();
        let beds = couple(&mut run, bed::resume(case, out, saved.beds())?)?;
        run.resume(saved.step());
        return Ok(Driven {
            case,
            out,
            run,
            columns,
            series,
            distributions,
            rows,
            next_distributions: next,
            before: wall,
            begun: Instant::now(),
            from,
            beds,
        });
    }
    if let (Some(_), Some(bed)) = (start.from, case.beds.first()) {
        return Err(PlantRunError::FromWithBed(bed.unit.clone()));
    }
    let mut run = match start.from {
        None => PlantRun::new(plant, integrator, tolerance)?,
        Some(folder) => {
            let (state, told) =
                PlantCheckpoint::read(folder)?.ok_or_else(|| ResultsError::NoResults {
                    path: folder.to_owned(),
                    fact: "it holds no checkpoint of a plant",
                })?;
            if let Some(told) = told {
                tell_line(format_args!(
                    "warning: {told}; the run begins from the checkpoint before it"
                ));
            }
            let (found, own) = (state.unknowns().len(), plant.unknowns());
            if found != own {
                return Err(PlantRunError::OtherPlant {
                    folder: folder.display().to_string(),
                    found,
                    own,
                });
            }
            PlantRun::from(plant, state.unknowns().to_vec(), integrator, tolerance)?
        }
    };
    let beds = match case.beds.is_empty() {
        true => Vec::new(),
        false => couple(&mut run, bed::begin(case, out)?)?,
    };
    let mut driven = Driven {
        case,
        out,
        run,
        series: Table::create(out, SERIES, &series_head(&columns))?,
        columns,
        distributions: Table::create(out, DISTRIBUTIONS, &distribution_head(plant))?,
        rows: 0,
        next_distributions: 0.0,
        before: 0.0,
        begun: Instant::now(),
        from: start.from.map(|folder| folder.display().to_string()),
        beds,
    };
    driven.record()?;
    Ok(driven)
}

impl Driven<'_> {
    /// Row by row to the end: true; false where it was interrupted.
    fn follow(
        &mut self,
        start: &PlantStart<'_>,
        progress: &mut PlantProgress,
    ) -> Result<bool, PlantRunError> {
        if self.beds.is_empty() {
            let interrupts = start.interrupts.clone();
            self.run.stop_when(move || interrupts.count() > 0);
        }
        let mut last = (self.run.time(), Instant::now());
        progress.show(self.run.time(), "running")?;
        while self.run.time() < self.case.end {
            if start.interrupts.count() > 0 {
                return Ok(false);
            }
            let next = (self.rows as f64 * self.case.row_every).min(self.case.end);
            // The last interval is not cut into one that only round-off makes.
            let next = match self.case.end - next < 1e-9 * self.case.row_every {
                true => self.case.end,
                false => next,
            };
            // Beds cannot go back to the last row.
            let row = self.beds.is_empty().then(|| self.run.checkpoint());
            let advanced = match &self.case.method.waveform {
                None => self.run.advance(next),
                Some(windows) => self.run.advance_by_windows(next, windows),
            };
            if let (Err(PlantError::Interrupted(_)), Some(row)) = (&advanced, row) {
                self.run.resume(row);
                return Ok(false);
            }
            advanced?;
            self.record()?;
            let due = |every: Option<f64>| {
                every.is_some_and(|every| self.run.time() - last.0 >= every * (1.0 - 1e-12))
            };
            let wall = self.case.checkpoint_wall;
            let late = wall.is_some_and(|wall: Duration| last.1.elapsed() >= wall);
            if due(self.case.checkpoint_every) || late {
                self.checkpoint()?;
                last = (self.run.time(), Instant::now());
            }
            progress.show(self.run.time(), "running")?;
        }
        Ok(true)
    }

    /// Writes the row of this moment, and distributions where they are due.
    fn record(&mut self) -> Result<(), PlantRunError> {
        let values = row(&self.run, &self.case.plant, &self.columns);
        // After the time.
        let mut temperatures = self.columns.iter().zip(&values[1..]);
        let frozen = temperatures
            .find(|(column, value)| column.field == PlantField::Temperature && **value <= 0.0);
        if let Some((column, value)) = frozen {
            return Err(PlantError::Frozen {
                place: column.name.clone(),
                time: self.run.time(),
                temperature: *value,
            }
            .into());
        }
        let words: Vec<String> = values.into_iter().map(number).collect();
        self.series.append(&words)?;
        self.rows += 1;
        let time = self.run.time();
        let every = self.case.distributions_every.unwrap_or(f64::INFINITY);
        let ended = time >= self.case.end;
        if ended || time >= self.next_distributions - 1e-9 * self.case.row_every {
            for words in distribution_rows(&self.run, &self.case.plant) {
                self.distributions.append(&words)?;
            }
            while self.next_distributions <= time + 1e-9 * self.case.row_every {
                self.next_distributions += every;
            }
        }
        Ok(())
    }

    fn checkpoint(&mut self) -> Result<PathBuf, PlantRunError> {
        let mut beds = Vec::new();
        // Before the plant's own: where a run ends in between, a bed goes on from its checkpoint before.
        for bed in &self.beds {
            let mut bed = bed.lock().unwrap_or_else(PoisonError::into_inner);
            bed.checkpoint()?;
            beds.push(bed.windows());
        }
        let written = Written {
            rows: self.rows,
            series: self.series.mark()?,
            distributions: self.distributions.mark()?,
            // JSON has no infinity.
            next_distributions: self.next_distributions.min(f64::MAX),
            wall: self.wall(),
            beds,
        };
        let state = self.run.checkpoint();
        let kept = PlantCheckpoint::new(&self.case.hash, &written, self.from.clone(), state);
        kept.write(self.out)
    }

    /// Beds end with their plant.
    fn end_beds(&mut self) -> Result<(), PlantRunError> {
        for bed in &self.beds {
            bed.lock().unwrap_or_else(PoisonError::into_inner).stop()?;
        }
        Ok(())
    }

    fn wall(&self) -> f64 {
        self.before + self.begun.elapsed().as_secs_f64()
    }

    /// The tables of the end, steady states, quantities, the HDF5 file.
    fn finish(&self) -> Result<PlantSummary, PlantRunError> {
        write_streams(self.out, &self.run, &self.case.plant)?;
        let mut summary = self.summary(Verdict::Running)?;
        if let Some(spec) = self.case.steady {
            match steady::steady(self.case, spec, self.run.unknowns()) {
                Ok(found) => {
                    summary.stability = found.modes.first().copied();
                    summary.steady = Some(found);
                }
                Err(error) => summary.not_steady = Some(error.to_string()),
            }
        }
        if let Some(spec) = &self.case.continuation {
            match steady::continuation(self.case, spec) {
                Ok(found) => summary.continuation = Some(found),
                Err(error) => summary.not_steady = Some(error.to_string()),
            }
        }
        let series = TimeTable::series(self.out)?;
        let measured = Measured {
            series: &series,
            columns: &self.columns,
            steady: summary.steady.as_ref(),
            continuation: summary.continuation.as_ref(),
        };
        summary.quantities = results(self.case, &measured, self.run.time(), true);
        summary.verdict = verdict(&summary.quantities);
        store::write(self.out, self.case, &self.columns, &series)?;
        summary.wall_time_s = self.wall();
        summary.replace(self.out)?;
        Ok(summary)
    }

    /// The summary of this moment.
    fn summary(&self, verdict: Verdict) -> Result<PlantSummary, PlantError> {
        let case = self.case;
        let plant = &case.plant;
        let [steps, repeated] = self.run.steps();
        let nothing = TimeTable {
            names: Vec::new(),
            columns: Vec::new(),
        };
        let measured = Measured {
            series: &nothing,
            columns: &self.columns,
            steady: None,
            continuation: None,
        };
        Ok(PlantSummary {
            format: 1,
            calcine: env!("CARGO_PKG_VERSION").into(),
            kind: KIND.into(),
            case: CaseName {
                name: case.name.clone(),
                title: case.title.clone(),
                hash: case.hash.clone(),
                files: BTreeMap::new(),
            },
            from: self.from.clone(),
            verdict,
            recycles: case.method.recycles().into(),
            integrator: case.method.integrator().into(),
            tolerance: case.method.tolerance,
            time_s: self.run.time(),
            end_s: case.end,
            classes: plant.layout().grid().classes(),
            unknowns: plant.unknowns(),
            tears: plant.tears().into_iter().map(str::to_owned).collect(),
            steps,
            repeated_steps: repeated,
            rounds: self.run.rounds(),
            ledger: PlantLedgerSummary::of(&self.run.ledger()),
            quantities: results(case, &measured, self.run.time(), false),
            steady: None,
            not_steady: None,
            stability: None,
            continuation: None,
            tuning: None,
            wall_time_s: self.wall(),
            failure: None,
        })
    }
}
