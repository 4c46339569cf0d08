//! Search for the best compromises between several objectives.

mod archive;
mod hypervolume;
mod operators;
mod sort;

pub use archive::{ArchivedPoint, ParetoArchive};
pub use hypervolume::hypervolume;
pub use operators::VariationSettings;
pub use sort::{crowding, dominates, fronts};

use crate::random::SearchRandom;
use operators::{cross, mutate};

/// NSGA-II with simulated binary crossover and polynomial mutation, over genes from zero to one; all objectives are
/// minimised (docs/theory.md, TUN-6).
///
/// It asks for evaluations and is told their results, generation by generation: whoever evaluates may do so on threads,
/// from a cache or in other processes. The same seed and the same results give the same bits.
///
/// Sources: Deb, Pratap, Agarwal and Meyarivan, IEEE Trans. Evol. Comput. 6 (2002) 182, doi 10.1109/4235.996017; start by
/// Latin hypercube, McKay, Beckman and Conover, Technometrics 21 (1979) 239, doi 10.1080/00401706.1979.10489755.
#[derive(Clone, Debug)]
pub struct Nsga2 {
    genes: usize,
    size: usize,
    variation: VariationSettings,
    random: SearchRandom,
    parents: Vec<Individual>,
    /// Genes that are asked for.
    asked: Vec<Vec<f64>>,
    generation: usize,
}

/// Genes with their objectives, and where they stand in the population.
#[derive(Clone, Debug)]
struct Individual {
    genes: Vec<f64>,
    objectives: Vec<f64>,
    rank: usize,
    crowding: f64,
}

impl Nsga2 {
    /// A search over so many genes with a population of this size, two or more.
    pub fn new(genes: usize, size: usize, variation: VariationSettings, seed: u64) -> Self {
        let mut search = Self {
            genes,
            size: size.max(2),
            variation,
            random: SearchRandom::new(seed),
            parents: Vec::new(),
            asked: Vec::new(),
            generation: 0,
        };
        search.asked = latin_hypercube(genes, search.size, &mut search.random);
        search
    }

    /// Genes in place of the first ones of the start, for example of a known good set.
    pub fn suggest(&mut self, genes: &[Vec<f64>]) {
        for (place, one) in self.asked.iter_mut().zip(genes) {
            place.clone_from(one);
        }
    }

    /// Genes whose objectives it needs next, one generation.
    pub fn ask(&self) -> &[Vec<f64>] {
        &self.asked
    }

    /// Generations that were told; the first is the start.
    pub fn generation(&self) -> usize {
        self.generation
    }

    /// Takes the objectives of what was asked for, in the same order. A set that could not be evaluated has infinite ones.
    pub fn tell(&mut self, objectives: Vec<Vec<f64>>) {
        let asked = std::mem::take(&mut self.asked);
        let fresh = asked
            .into_iter()
            .zip(objectives)
            .map(|(genes, objectives)| Individual {
                genes,
                objectives,
                rank: 0,
                crowding: 0.0,
            });
        let mut all = std::mem::take(&mut self.parents);
        all.extend(fresh);
        self.parents = select(all, self.size);
        self.generation += 1;
        self.asked = self.offspring();
    }

    fn offspring(&mut self) -> Vec<Vec<f64>> {
        let mut children: Vec<Vec<f64>> = Vec::with_capacity(self.size);
        // A population of one point breeds copies: after so many attempts they are taken as they are.
        let mut attempts = 20 * self.size;
        while children.len() < self.size {
            let (first, second) = (self.tournament(), self.tournament());
            let parents = [&self.parents[first].genes, &self.parents[second].genes];
            let pair = cross(parents, &self.variation, &mut self.random);
            for mut child in pair {
                mutate(&mut child, &self.variation, self.genes, &mut self.random);
                attempts = attempts.saturating_sub(1);
                let known = children.contains(&child)
                    || self.parents.iter().any(|parent| parent.genes == child);
                if children.len() < self.size && (!known || attempts == 0) {
                    children.push(child);
                }
            }
        }
        children
    }

    /// The better of two: of a lower front, or of the same one and less crowded.
    fn tournament(&mut self) -> usize {
        let count = self.parents.len();
        let (a, b) = (self.random.below(count), self.random.below(count));
        let key = |k: usize| (self.parents[k].rank, -self.parents[k].crowding);
        let ((rank_a, crowd_a), (rank_b, crowd_b)) = (key(a), key(b));
        match rank_a.cmp(&rank_b).then(crowd_a.total_cmp(&crowd_b)) {
            std::cmp::Ordering::Greater => b,
            _ => a,
        }
    }
}

/// The best of a population: whole fronts, then those of the front that does not fit which are left when the most crowded
/// one goes again and again.
fn select(mut all: Vec<Individual>, size: usize) -> Vec<Individual> {
    let objectives: Vec<&[f64]> = all.iter().map(|one| &one.objectives[..]).collect();
    let mut kept: Vec<(usize, usize, f64)> = Vec::new();
    for (rank, front) in fronts(&objectives).into_iter().enumerate() {
        if kept.len() == size {
            break;
        }
        let room = size - kept.len();
        let mut members: Vec<(usize, f64)> = Vec::new();
        let mut front = front;
        loop {
            let points: Vec<&[f64]> = front.iter().map(|&k| objectives[k]).collect();
            members.clear();
            members.extend(front.iter().copied().zip(crowding(&points)));
            if front.len() <= room {
                break;
            }
            // One after the other: distances of the neighbours change with each that goes.
            let crowded = members.iter().enumerate();
            let crowded = crowded.min_by(|a, b| a.1.1.total_cmp(&b.1.1));
            front.remove(crowded.map_or(0, |(place, _)| place));
        }
        kept.extend(members.into_iter().map(|(k, crowd)| (k, rank, crowd)));
    }
    let mut best = Vec::with_capacity(kept.len());
    for (k, rank, crowding) in kept {
        let mut one = std::mem::replace(
            &mut all[k],
            Individual {
                genes: Vec::new(),
                objectives: Vec::new(),
                rank: 0,
                crowding: 0.0,
            },
        );
        (one.rank, one.crowding) = (rank, crowding);
        best.push(one);
    }
    best
}

/// Points of a Latin hypercube over zero to one: each gene takes each of `count` strata once.
pub fn latin_hypercube(genes: usize, count: usize, random: &mut SearchRandom) -> Vec<Vec<f64>> {
    let mut points = vec![vec![0.0; genes]; count];
    for gene in 0..genes {
        let mut strata: Vec<usize> = (0..count).collect();
        for k in (1..count).rev() {
            strata.swap(k, random.below(k + 1));
        }
        for (point, stratum) in points.iter_mut().zip(strata) {
            point[gene] = (stratum as f64 + random.unit()) / count as f64;
        }
    }
    points
}
