//! Cells gathered into aggregates, the unknowns of the next coarser level.

use super::super::sparse::Sparse;

/// The aggregate of each cell, or that it belongs to none.
pub(in super::super) struct Aggregates {
    pub of: Vec<u32>,
    pub count: usize,
}

impl Aggregates {
    /// In no aggregate.
    pub const NONE: u32 = u32::MAX;

    /// Aggregates of strongly joined neighbours (P. Vaněk, J. Mandel, M. Brezina, Computing 56
    /// (1996) 179, DOI 10.1007/BF02238511): first whole neighbourhoods that are disjoint, then each
    /// cell left joins the neighbour it is most strongly joined to, then what is left stays among
    /// itself. Cells that are not `wanted` belong to none.
    pub fn new(
        joined: &Sparse,
        strong: impl Fn(usize, usize, f64) -> bool,
        wanted: &[bool],
    ) -> Self {
        let cells = joined.rows();
        let mut of = vec![Self::NONE; cells];
        let mut count = 0;
        let neighbours = |cell: usize| {
            let strong = &strong;
            let row = joined.row(cell);
            row.filter(move |&(other, value)| wanted[other] && strong(cell, other, value))
        };
        for cell in (0..cells).filter(|&cell| wanted[cell]) {
            if of[cell] != Self::NONE || neighbours(cell).any(|(other, _)| of[other] != Self::NONE)
            {
                continue;
            }
            of[cell] = count;
            neighbours(cell).for_each(|(other, _)| of[other] = count);
            count += 1;
        }
        let seeds = of.clone();
        for cell in (0..cells).filter(|&cell| wanted[cell] && seeds[cell] == Self::NONE) {
            let taken = neighbours(cell).filter(|&(other, _)| seeds[other] != Self::NONE);
            if let Some((other, _)) = taken.max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs())) {
                of[cell] = seeds[other];
            }
        }
        for cell in (0..cells).filter(|&cell| wanted[cell]) {
            if of[cell] != Self::NONE {
                continue;
            }
            of[cell] = count;
            for (other, _) in neighbours(cell) {
                if of[other] == Self::NONE {
                    of[other] = count;
                }
            }
            count += 1;
        }
        Self {
            of,
            count: count as usize,
        }
    }
}
