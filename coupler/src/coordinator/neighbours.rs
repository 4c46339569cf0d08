//! What particles meet, in checkpoints. Contacts follow from where particles are; views of before do not, because they hold
//! for a while, whoever moves, goes or changes its size meanwhile.

use calcine_interior::ExchangeAreas;

use super::interior::InteriorStage;
use crate::checkpoint::{StateFile, StateFileError};

/// How what particles meet stands at a checkpoint.
pub(super) struct NeighbourStanding {
    /// Process time in s.
    pub time: f64,
    /// True where particles of the run can move.
    pub moves: bool,
    /// True where some moved, went or changed its size after contacts were found last.
    pub moved: bool,
}

impl InteriorStage {
    /// Writes when views were found and which hold, unless the next window finds new ones, or a resumed run finds the same
    /// ones where the particles are.
    pub fn record_neighbours(&self, standing: &NeighbourStanding, state: &mut StateFile) {
        let seen_at = self.paths.seen_at().into_iter().collect::<Vec<f64>>();
        let others = standing.moves || self.changed || self.models.change_sizes();
        let renewed = standing.moved && self.paths.due(standing.time);
        let views = self.network.as_ref().map(|network| network.views());
        let views = views.filter(|_| others && !renewed && !seen_at.is_empty());
        state.set_f64s("views_seen_at", &seen_at);
        state.set_u64s("neighbours_due", &[u64::from(standing.moved)]);
        state.set_u64s("views_kept", &[u64::from(views.is_some())]);
        if let Some(views) = views {
            record(views, state);
        }
    }

    /// Takes them up, after views and contacts have been found where the particles are; true where contacts have to be found
    /// once more before the next window.
    pub fn restore_neighbours(&mut self, state: &StateFile) -> Result<bool, StateFileError> {
        self.paths
            .restore_seen_at(state.f64s("views_seen_at")?.first().copied());
        if let (Some(network), [1]) = (&mut self.network, state.u64s("views_kept")?) {
            network.set_views(&views(self.models.len(), state)?);
            self.changed = true;
        }
        Ok(state.u64s("neighbours_due")? == [1])
    }
}

/// Two indices as one number.
fn packed([a, b]: [usize; 2]) -> u64 {
    (a as u64) << 32 | b as u64
}

fn unpacked(both: u64) -> [usize; 2] {
    [(both >> 32) as usize, (both & u64::from(u32::MAX)) as usize]
}

fn record(views: &ExchangeAreas, state: &mut StateFile) {
    for (list, [ends, area]) in [
        (&views.pairs, ["view_pairs", "view_pair_areas"]),
        (
            &views.reservoirs,
            ["view_reservoirs", "view_reservoir_areas"],
        ),
    ] {
        let rows: Vec<u64> = list.iter().map(|one| packed(one.0)).collect();
        let areas: Vec<f64> = list.iter().map(|one| one.1).collect();
        state.set_u64s(ends, &rows);
        state.set_f64s(area, &areas);
    }
    state.set_f64s("view_own", &views.own);
    state.set_f64s("view_surface", &views.surface);
    state.set_u64s("view_radiosity", &[u64::from(views.radiosity)]);
}

/// Views of so many particles.
fn views(count: usize, state: &StateFile) -> Result<ExchangeAreas, StateFileError> {
    let list = |[ends, area]: [&str; 2]| -> Result<Vec<([usize; 2], f64)>, StateFileError> {
        let rows = state.u64s(ends)?;
        let areas = state.f64s_of(area, rows.len())?;
        Ok(rows
            .iter()
            .map(|&both| unpacked(both))
            .zip(areas.iter().copied())
            .collect())
    };
    // Where nothing is seen there is nothing to a particle.
    let count = if state.f64s("view_surface")?.is_empty() {
        0
    } else {
        count
    };
    Ok(ExchangeAreas {
        pairs: list(["view_pairs", "view_pair_areas"])?,
        reservoirs: list(["view_reservoirs", "view_reservoir_areas"])?,
        own: state.f64s_of("view_own", count)?.to_vec(),
        surface: state.f64s_of("view_surface", count)?.to_vec(),
        radiosity: state.u64s("view_radiosity")? == [1],
        ..ExchangeAreas::default()
    })
}
