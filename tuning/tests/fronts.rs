//! NSGA-II on problems whose fronts are known.
//!
//! Problems: Zitzler, Deb and Thiele, Evol. Comput. 8 (2000) 173, doi 10.1162/106365600568202; Deb, Thiele, Laumanns and
//! Zitzler, CEC 2002, doi 10.1109/CEC.2002.1007032.

use calcine_tuning::nsga::{ArchivedPoint, Nsga2, ParetoArchive, VariationSettings, hypervolume};

fn zdt(x: &[f64], shape: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let mean = x[1..].iter().sum::<f64>() / (x.len() - 1) as f64;
    let g = 1.0 + 9.0 * mean;
    vec![x[0], g * shape(x[0], g)]
}

fn zdt1(x: &[f64]) -> Vec<f64> {
    zdt(x, |f, g| 1.0 - (f / g).sqrt())
}

fn zdt2(x: &[f64]) -> Vec<f64> {
    zdt(x, |f, g| 1.0 - (f / g).powi(2))
}

fn zdt3(x: &[f64]) -> Vec<f64> {
    let wave = |f: f64| (10.0 * std::f64::consts::PI * f).sin();
    zdt(x, |f, g| 1.0 - (f / g).sqrt() - f / g * wave(f))
}

/// Three objectives, twelve genes: a sphere of radius one.
fn dtlz2(x: &[f64]) -> Vec<f64> {
    let g: f64 = x[2..].iter().map(|x| (x - 0.5).powi(2)).sum();
    let angle = |k: usize| std::f64::consts::FRAC_PI_2 * x[k];
    let r = 1.0 + g;
    vec![
        r * angle(0).cos() * angle(1).cos(),
        r * angle(0).cos() * angle(1).sin(),
        r * angle(0).sin(),
    ]
}

struct Search {
    genes: usize,
    size: usize,
    generations: usize,
    seed: u64,
}

impl Search {
    /// The front of all evaluations, and all objectives in their order.
    fn run(&self, f: impl Fn(&[f64]) -> Vec<f64>) -> (ParetoArchive, Vec<Vec<f64>>) {
        let mut search = Nsga2::new(
            self.genes,
            self.size,
            VariationSettings::default(),
            self.seed,
        );
        let (mut archive, mut all) = (ParetoArchive::default(), Vec::new());
        for _ in 0..self.generations {
            let asked = search.ask().to_vec();
            let told: Vec<Vec<f64>> = asked.iter().map(|genes| f(genes)).collect();
            for (genes, objectives) in asked.into_iter().zip(&told) {
                archive.offer(ArchivedPoint {
                    evaluation: all.len(),
                    genes,
                    objectives: objectives.clone(),
                });
                all.push(objectives.clone());
            }
            search.tell(told);
        }
        (archive, all)
    }

    fn share(&self, f: impl Fn(&[f64]) -> Vec<f64>, reference: &[f64], exact: f64) -> f64 {
        let (archive, _) = self.run(f);
        let front = archive.front();
        let points: Vec<&[f64]> = front.iter().map(|one| &one.objectives[..]).collect();
        hypervolume(&points, reference) / exact
    }
}

const TWO: [f64; 2] = [1.1, 1.1];

/// Area below the reference over the front y(x) of ZDT3: its five pieces are where sin makes it fall to new depths.
fn zdt3_exact() -> f64 {
    let count = 2_000_000;
    let (mut area, mut ceiling) = (0.0, 1.1f64);
    let mut before: f64 = 0.0;
    for k in 0..=count {
        let x = f64::from(k) / f64::from(count);
        area += (x - before) * (1.1 - ceiling);
        let y = 1.0 - x.sqrt() - x * (10.0 * std::f64::consts::PI * x).sin();
        ceiling = ceiling.min(y);
        before = x;
    }
    area + 0.1 * (1.1 - ceiling)
}

#[test]
fn zdt_problems_are_solved_to_one_percent_of_their_hypervolume() {
    for seed in [1, 2, 3] {
        let search = Search {
            genes: 30,
            size: 100,
            generations: 250,
            seed,
        };
        // 1.21 − ∫ (1 − √x) dx = 1.21 − 1/3 and 1.21 − ∫ (1 − x²) dx = 1.21 − 2/3.
        for share in [
            search.share(zdt1, &TWO, 1.21 - 1.0 / 3.0),
            search.share(zdt2, &TWO, 1.21 - 2.0 / 3.0),
            search.share(zdt3, &TWO, zdt3_exact()),
        ] {
            assert!(share > 0.99 && share < 1.0 + 1e-5, "seed {seed}: {share}");
        }
    }
}

#[test]
fn the_sphere_of_dtlz2_is_filled_to_one_percent_of_its_hypervolume() {
    let search = Search {
        genes: 12,
        size: 100,
        generations: 1000,
        seed: 1,
    };
    // The cube of side 1.1 less an eighth of the unit sphere. Seeds 2 and 3 come to 0.9918 and 0.9917.
    let exact = 1.331 - std::f64::consts::PI / 6.0;
    let share = search.share(dtlz2, &[1.1; 3], exact);
    assert!(share > 0.99 && share < 1.0, "{share}");
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_one_others() {
    let run = |seed| {
        let search = Search {
            genes: 5,
            size: 20,
            generations: 30,
            seed,
        };
        search.run(zdt1).1
    };
    assert_eq!(run(7), run(7));
    assert_ne!(run(7), run(8));
}

#[test]
fn a_search_goes_on_past_sets_that_cannot_be_evaluated() {
    let search = Search {
        genes: 2,
        size: 20,
        generations: 40,
        seed: 3,
    };
    let half = |x: &[f64]| match x[0] < 0.5 {
        true => vec![f64::INFINITY; 2],
        false => vec![x[0] + x[1], 1.5 - x[0] + x[1]],
    };
    let best = search.run(half).0;
    assert!(best.best(0).unwrap().objectives[0] < 0.51);
}
