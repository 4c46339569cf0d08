//! Where the units of a plant stand in a drawing of it.

use calcine_flowsheet::Plant;

/// Columns of units: each stands right of all that flow into it, but for streams that flow back.
pub(super) struct Places {
    /// Column and row of each unit.
    pub at: Vec<(usize, usize)>,
    /// Number of columns and of rows.
    pub size: (usize, usize),
    /// True of each stream that flows back to a unit at its left or in its column.
    pub back: Vec<bool>,
}

impl Places {
    /// Places of a plant's units. Torn streams flow back, and of other circles the stream that closes them.
    pub fn of(plant: &Plant) -> Self {
        let (units, streams) = (plant.units().len(), plant.streams().len());
        let tears = plant.tears();
        let names = plant.streams().iter();
        let mut forward: Vec<bool> = names.map(|name| !tears.contains(&name.as_str())).collect();
        let mut state = vec![0u8; units];
        let roots = (0..units).filter(|unit| plant.units()[*unit].entering().is_empty());
        for root in roots.chain(0..units) {
            visit(plant, root, &mut state, &mut forward);
        }
        let mut column = vec![0usize; units];
        for _ in 0..units {
            for (stream, forward) in forward.iter().enumerate() {
                let (from, to) = plant.ends_of(stream);
                if *forward && from != to {
                    column[to] = column[to].max(column[from] + 1);
                }
            }
        }
        // What only feeds one unit stands beside it.
        for unit in 0..units {
            let own = &plant.units()[unit];
            if own.entering().is_empty() {
                let next = own.leaving().map(|stream| column[plant.ends_of(stream).1]);
                column[unit] = next.min().unwrap_or(1).saturating_sub(1);
            }
        }
        let columns = 1 + column.iter().copied().max().unwrap_or(0);
        let mut filled = vec![0usize; columns];
        let mut at = Vec::new();
        for own in &column {
            at.push((*own, filled[*own]));
            filled[*own] += 1;
        }
        let back = (0..streams).map(|stream| {
            let (from, to) = plant.ends_of(stream);
            column[to] <= column[from]
        });
        Self {
            back: back.collect(),
            size: (columns, filled.iter().copied().max().unwrap_or(1)),
            at,
        }
    }
}

/// Follows streams in depth; those that close a circle flow back.
fn visit(plant: &Plant, unit: usize, state: &mut [u8], forward: &mut [bool]) {
    if state[unit] != 0 {
        return;
    }
    state[unit] = 1;
    for stream in plant.units()[unit].leaving() {
        let to = plant.ends_of(stream).1;
        if !forward[stream] {
            continue;
        }
        match state[to] {
            0 => visit(plant, to, state, forward),
            1 => forward[stream] = false,
            _ => {}
        }
    }
    state[unit] = 2;
}
