//! The obstacle problem on coarser and coarser graphs, from which finer ones start.

use super::graph::Graph;
use super::multigrid::aggregate::Aggregates;
use super::obstacle;
use super::sparse::Sparse;

/// Coarser graphs of a graph, the finest first. Aggregates of cells are joined by the sum of the
/// conductances between them; where no cell's excess passes its aggregate's border, none appears
/// on the coarser graph.
#[derive(Debug)]
pub(super) struct Cascade {
    levels: Vec<Coarse>,
}

#[derive(Debug)]
struct Coarse {
    /// Aggregate of each cell of the next finer graph.
    of: Vec<u32>,
    graph: Graph,
}

impl Cascade {
    /// A graph with no more cells is not made coarser.
    const FEW: usize = 50;
    /// Neighbours are joined strongly above this share of the best that either has.
    const STRONG: f64 = 0.3;

    pub fn new(graph: &Graph) -> Self {
        let mut levels: Vec<Coarse> = Vec::new();
        loop {
            let finer = levels.last().map_or(graph, |coarse| &coarse.graph);
            if finer.cells() <= Self::FEW {
                return Self { levels };
            }
            let coarse = Coarse::new(finer);
            if 2 * coarse.graph.cells() > finer.cells() {
                return Self { levels };
            }
            levels.push(coarse);
        }
    }

    /// A potential to start from on the finest graph, for an excess b = A₀ − C by cell.
    pub fn start(&self, excess: &[f64]) -> Vec<f64> {
        let mut excesses: Vec<Vec<f64>> = Vec::new();
        for coarse in &self.levels {
            let finer = excesses.last().map_or(excess, Vec::as_slice);
            excesses.push(coarse.sums(finer));
        }
        let mut potential = vec![0.0; excesses.last().map_or(excess, Vec::as_slice).len()];
        for (coarse, excess) in self.levels.iter().zip(&excesses).rev() {
            obstacle::settle(&coarse.graph, excess, &mut potential, obstacle::Care::Rough);
            potential = coarse.prolonged(&potential);
        }
        potential
    }
}

impl Coarse {
    fn new(finer: &Graph) -> Self {
        let best: Vec<f64> = (0..finer.cells())
            .map(|cell| {
                finer
                    .conductance
                    .row(cell)
                    .map(|(_, g)| g)
                    .fold(0.0, f64::max)
            })
            .collect();
        let strong = |a: usize, b: usize, g: f64| g > Cascade::STRONG * best[a].min(best[b]);
        let wanted: Vec<bool> = best.iter().map(|&best| best > 0.0).collect();
        let Aggregates { of, count } = Aggregates::new(&finer.conductance, strong, &wanted);
        let members = Sparse::from_entries(count, |entry| {
            for (cell, &aggregate) in of.iter().enumerate() {
                if aggregate != Aggregates::NONE {
                    entry(aggregate, cell as u32, 1.0);
                }
            }
        });
        let mut joined = Sparse::with_capacity(count, 16 * count);
        let mut place = vec![None; count];
        for aggregate in 0..count {
            let first = joined.columns.len();
            for (cell, _) in members.row(aggregate) {
                for (other, g) in finer.conductance.row(cell) {
                    let other = of[other] as usize;
                    if other == aggregate {
                        continue;
                    }
                    let place = place[other].get_or_insert_with(|| {
                        joined.push(other as u32, 0.0);
                        joined.columns.len() - 1
                    });
                    joined.values[*place] += g;
                }
            }
            joined.end_row();
            for &column in &joined.columns[first..] {
                place[column as usize] = None;
            }
        }
        let volume = (0..count).map(|a| members.gather(a, &finer.volume));
        Self {
            graph: Graph::of(joined, volume.collect()),
            of,
        }
    }

    fn sums(&self, finer: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.graph.cells()];
        for (&aggregate, &value) in self.of.iter().zip(finer) {
            if aggregate != Aggregates::NONE {
                sums[aggregate as usize] += value;
            }
        }
        sums
    }

    /// Sums of conductances between aggregates conduct better than the cells in series do, by about
    /// the width of an aggregate in cells, so that potentials are lower by as much.
    fn prolonged(&self, coarser: &[f64]) -> Vec<f64> {
        const WIDTH: f64 = 2.0;
        let of = |&aggregate: &u32| match aggregate {
            Aggregates::NONE => 0.0,
            aggregate => WIDTH * coarser[aggregate as usize],
        };
        self.of.iter().map(of).collect()
    }
}
