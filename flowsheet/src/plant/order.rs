//! The order in which units are computed, and where recycles are torn.

/// Units that are computed one after the other; those of a recycle until its tear streams agree with themselves.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct UnitBlock {
    /// Units, in order.
    pub units: Vec<usize>,
    /// Streams that a recycle is torn at; none for a unit alone.
    pub tears: Vec<usize>,
}

/// Blocks of units in the order of their flows (strongly connected components by Tarjan's method). `ends` are the units that
/// each stream leaves and enters; a unit through which nothing passes at once is not part of a recycle.
///
/// Within a recycle the units stand in the order of their declaration as far as streams allow, and the tear streams are those
/// that flow against it. Streams that are chosen are torn first: units do not wait for them.
///
/// Source: Tarjan, SIAM J. Comput. 1 (1972) 146, doi 10.1137/0201010.
pub fn order(
    units: usize,
    ends: &[(usize, usize)],
    direct: &[bool],
    chosen: &[usize],
) -> Vec<UnitBlock> {
    let mut search = Search {
        next: vec![Vec::new(); units],
        index: vec![None; units],
        low: vec![0; units],
        stack: Vec::new(),
        count: 0,
        found: Vec::new(),
    };
    for (from, to) in ends {
        // What flows into a unit does not show in what flows out of it, unless it passes through.
        if direct[*to] {
            search.next[*from].push(*to);
        }
    }
    for unit in 0..units {
        if search.index[unit].is_none() {
            search.visit(unit);
        }
    }
    let mut blocks = Vec::new();
    for mut members in search.found.into_iter().rev() {
        let own = |from: usize, to: usize| direct[to] && from == to;
        let loops = members.len() > 1 || ends.iter().any(|(a, b)| *a == members[0] && own(*a, *b));
        if !loops {
            blocks.push(UnitBlock {
                units: members,
                tears: Vec::new(),
            });
            continue;
        }
        members.sort_unstable();
        blocks.push(tear(&members, ends, chosen));
    }
    blocks
}

/// Orders the units of a recycle: next is the first that waits for no other, else the one with the fewest streams to tear.
fn tear(members: &[usize], ends: &[(usize, usize)], chosen: &[usize]) -> UnitBlock {
    let inside = |unit: &usize| members.contains(unit);
    let mut left = members.to_vec();
    let mut block = UnitBlock::default();
    while !left.is_empty() {
        let waits = |unit: usize| {
            let streams = ends.iter().enumerate();
            let open = streams.filter(|(stream, (from, to))| {
                *to == unit && left.contains(from) && !chosen.contains(stream)
            });
            open.count()
        };
        let Some(next) = left
            .iter()
            .copied()
            .min_by_key(|unit| (waits(*unit), *unit))
        else {
            break;
        };
        for (stream, (from, to)) in ends.iter().enumerate() {
            if *to == next && left.contains(from) && inside(from) {
                block.tears.push(stream);
            }
        }
        left.retain(|unit| *unit != next);
        block.units.push(next);
    }
    block
}

struct Search {
    next: Vec<Vec<usize>>,
    index: Vec<Option<usize>>,
    low: Vec<usize>,
    stack: Vec<usize>,
    count: usize,
    found: Vec<Vec<usize>>,
}

impl Search {
    fn visit(&mut self, unit: usize) {
        let own = self.count;
        (self.index[unit], self.low[unit]) = (Some(own), own);
        self.count += 1;
        self.stack.push(unit);
        for to in self.next[unit].clone() {
            match self.index[to] {
                None => {
                    self.visit(to);
                    self.low[unit] = self.low[unit].min(self.low[to]);
                }
                Some(index) if self.stack.contains(&to) => {
                    self.low[unit] = self.low[unit].min(index);
                }
                Some(_) => {}
            }
        }
        if self.low[unit] == own {
            let start = self
                .stack
                .iter()
                .position(|other| *other == unit)
                .unwrap_or(0);
            self.found.push(self.stack.split_off(start));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_recycle_is_torn_once_and_what_follows_comes_after() {
        // 0 -> 1 -> 2 -> 3 -> 1, 2 -> 4.
        let ends = [(0, 1), (1, 2), (2, 3), (3, 1), (2, 4)];
        let blocks = order(5, &ends, &[true; 5], &[]);
        let units: Vec<_> = blocks.iter().map(|block| block.units.clone()).collect();
        assert_eq!(units, [vec![0], vec![1, 2, 3], vec![4]]);
        assert_eq!(blocks[1].tears, [3]);
    }

    #[test]
    fn a_recycle_is_torn_where_it_is_told() {
        let ends = [(0, 1), (1, 2), (2, 3), (3, 1), (2, 4)];
        let blocks = order(5, &ends, &[true; 5], &[1]);
        assert_eq!(blocks[1].tears, [1]);
        assert_eq!(blocks[1].units, [2, 3, 1]);
    }

    #[test]
    fn a_unit_that_holds_back_opens_the_recycle() {
        let ends = [(0, 1), (1, 2), (2, 1)];
        let blocks = order(3, &ends, &[true, true, false], &[]);
        assert!(blocks.iter().all(|block| block.tears.is_empty()));
        let place = |unit| blocks.iter().position(|block| block.units == [unit]);
        assert!(place(2) < place(1));
    }
}
