//! Many rows on threads.

use rayon::prelude::*;

/// Rows that a thread takes at a time.
pub const CHUNK: usize = 16;

/// Works on every row of `width` values in fixed chunks on the threads at hand, with scratch memory that no result
/// may depend on: each row is computed by itself, so that bits depend neither on the number of threads nor on the
/// rows beside it. The error is that of the first row that fails, whichever came first.
pub fn each_row<W, E: Send>(
    values: &mut [f64],
    width: usize,
    scratch: impl Fn() -> W + Sync + Send,
    work: impl Fn(usize, &mut [f64], &mut W) -> Result<(), E> + Sync + Send,
) -> Result<(), E> {
    each_chunk(values, (width, CHUNK), scratch, |from, values, scratch| {
        let mut rows = values.chunks_exact_mut(width).enumerate();
        rows.find_map(|(k, values)| {
            let error = work(from + k, values, scratch).err()?;
            Some((from + k, error))
        })
    })
    .map_err(|(_, error)| error)
}

/// Works on chunks of so many rows of `width` values, such as those that are computed side by side: `work` has the first row of a chunk,
/// its values and scratch memory, and names the first row of it that fails. The error is that of the first row of all.
pub fn each_chunk<W, E: Send>(
    values: &mut [f64],
    (width, rows): (usize, usize),
    scratch: impl Fn() -> W + Sync + Send,
    work: impl Fn(usize, &mut [f64], &mut W) -> Option<(usize, E)> + Sync + Send,
) -> Result<(), (usize, E)> {
    if width == 0 {
        return Ok(());
    }
    let chunks = values.par_chunks_mut(rows * width).enumerate();
    let failed = chunks.map_init(scratch, |scratch, (chunk, values)| {
        work(chunk * rows, values, scratch)
    });
    match failed.flatten().min_by_key(|(row, _)| *row) {
        Some(failed) => Err(failed),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rosenbrock::IntegrationAccuracy;
    use crate::rosenbrock::tests::Robertson;
    use crate::{DenseMatrix, Rosenbrock, RosenbrockTableau};

    fn pool(threads: usize) -> rayon::ThreadPool {
        let builder = rayon::ThreadPoolBuilder::new().num_threads(threads);
        builder.build().unwrap()
    }

    fn one(k: usize, row: &mut [f64], method: &mut Rosenbrock<DenseMatrix>) -> Result<(), usize> {
        let mut system = Robertson::of(1.0 + 0.01 * k as f64);
        let span = 10f64.powi(k as i32 % 7 - 2);
        let accuracy = IntegrationAccuracy::absolute(&[1e-7, 1e-11, 1e-7]);
        let done = method.integrate(&mut system, row, span, accuracy);
        done.map(|_| ()).map_err(|_| k)
    }

    fn method() -> Rosenbrock<DenseMatrix> {
        Rosenbrock::new(&RosenbrockTableau::RODAS4, DenseMatrix::new(3))
    }

    #[test]
    fn a_row_has_the_same_bits_alone_among_others_and_on_any_number_of_threads() {
        let start = [1.0, 0.0, 0.0];
        let run = |threads: usize| {
            let mut rows = start.repeat(333);
            let done = pool(threads).install(|| each_row(&mut rows, 3, method, one));
            done.unwrap();
            rows
        };
        let (single, double) = (run(1), run(2));
        assert_eq!(single, double);
        for k in [0, 17, 332] {
            let mut alone = start;
            one(k, &mut alone, &mut method()).unwrap();
            assert_eq!(alone, single[3 * k..3 * k + 3], "{k}");
        }
    }

    #[test]
    fn the_first_failing_row_is_named_whichever_came_first() {
        let fails = |k: usize, _: &mut [f64], (): &mut ()| match k % 301 {
            300 => Err(k),
            _ => Ok(()),
        };
        let mut rows = vec![0.0; 2000];
        let error = pool(2).install(|| each_row(&mut rows, 2, || (), fails));
        assert_eq!(error, Err(300));
    }
}
