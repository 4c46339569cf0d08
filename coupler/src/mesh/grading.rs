//! Where the layers of a generated mesh lie along an axis: regions of their own cell sizes.

use super::MeshError;

/// A stretch of an axis with its own cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Its share of the whole length; shares of all regions are scaled to sum to 1.
    pub share: f64,
    /// Number of its cells.
    pub cells: usize,
    /// Size of its last cell over that of its first, as in `blockMesh`; sizes grow geometrically.
    pub expansion: f64,
}

/// A region by its shares, as the multi-grading of `blockMesh` has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Its share of the length; shares of all regions are scaled to sum to 1.
    pub length_share: f64,
    /// Its share of the cells, likewise.
    pub cell_share: f64,
    /// Size of its last cell over that of its first.
    pub expansion: f64,
}

/// Regions of `cells` cells in all, at least one each: whole parts of the shares first, then the
/// largest remainders. Without a stretch, one region of equal cells.
pub fn shared(cells: usize, stretches: &[Stretch]) -> Result<Vec<Region>, MeshError> {
    if stretches.is_empty() {
        return Ok(uniform(cells));
    }
    let wrong = |text: String| Err(MeshError::Inconsistent(text));
    if stretches.len() > cells {
        return wrong(format!("{} regions of {cells} cells", stretches.len()));
    }
    let total: f64 = stretches.iter().map(|stretch| stretch.cell_share).sum();
    let is_bad = |share: f64| share.is_nan() || share <= 0.0;
    if let Some(bad) = stretches.iter().find(|s| is_bad(s.cell_share / total)) {
        return wrong(format!(
            "a region has a share of the cells of {}; it must be above 0",
            bad.cell_share
        ));
    }
    // The share first: it is at most 1, however large the numbers are.
    let exact = |stretch: &Stretch| cells as f64 * (stretch.cell_share / total);
    let mut counts: Vec<usize> = stretches
        .iter()
        .map(|s| (exact(s) as usize).max(1))
        .collect();
    // How far a region is below its share; the first of equals comes first.
    let missing = |counts: &[usize], i: usize| exact(&stretches[i]) - counts[i] as f64;
    let all = 0..stretches.len();
    while counts.iter().sum::<usize>() < cells {
        let most = all
            .clone()
            .rev()
            .max_by(|&a, &b| missing(&counts, a).total_cmp(&missing(&counts, b)));
        counts[most.unwrap_or(0)] += 1;
    }
    while counts.iter().sum::<usize>() > cells {
        let spare = all.clone().filter(|&i| counts[i] > 1);
        let least = spare.min_by(|&a, &b| missing(&counts, a).total_cmp(&missing(&counts, b)));
        counts[least.unwrap_or(0)] -= 1;
    }
    let regions = stretches.iter().zip(counts);
    Ok(regions
        .map(|(stretch, cells)| Region {
            share: stretch.length_share,
            cells,
            expansion: stretch.expansion,
        })
        .collect())
}

/// One region of equal cells.
pub fn uniform(cells: usize) -> Vec<Region> {
    vec![Region {
        share: 1.0,
        cells,
        expansion: 1.0,
    }]
}

/// The `cells + 1` levels from `start` to `start + length`, in m.
pub fn levels(start: f64, length: f64, regions: &[Region]) -> Result<Vec<f64>, MeshError> {
    let wrong = |text: String| Err(MeshError::Inconsistent(text));
    if !(start.is_finite() && length.is_finite() && length > 0.0) {
        return wrong(format!("an axis of {length} m from {start} m"));
    }
    if regions.is_empty() {
        return wrong("an axis of 0 regions; it needs at least 1".into());
    }
    for (index, region) in regions.iter().enumerate() {
        let number = |x: f64| x.is_finite() && x > 0.0;
        if !(number(region.share) && number(region.expansion)) {
            return wrong(format!(
                "region {index} has a share of {} and an expansion of {}; both must be above 0",
                region.share, region.expansion
            ));
        }
        if region.cells == 0 || region.cells > u32::MAX as usize {
            return wrong(format!(
                "region {index} has {} cells; it needs 1 to {}",
                region.cells,
                u32::MAX
            ));
        }
    }
    let total: f64 = regions.iter().map(|region| region.share).sum();
    let mut levels = vec![start];
    let mut below = 0.0;
    for region in regions {
        for cell in 1..=region.cells {
            levels.push(start + length * (below + region.share * within(region, cell)) / total);
        }
        below += region.share;
    }
    if let Some(last) = levels.last_mut() {
        *last = start + length;
    }
    Ok(levels)
}

/// Part of a region below the upper end of its `cell`-th cell, counted from 1.
fn within(region: &Region, cell: usize) -> f64 {
    let uniform = cell as f64 / region.cells as f64;
    if region.expansion == 1.0 || region.cells == 1 {
        return uniform;
    }
    // Sizes 1, r, r², …; r^n − 1 by exp_m1 keeps its digits where r is near 1.
    let log_ratio = region.expansion.ln() / (region.cells - 1) as f64;
    (cell as f64 * log_ratio).exp_m1() / (region.cells as f64 * log_ratio).exp_m1()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_shared_however_large_the_shares_are() {
        let counts = |shares: [f64; 2]| {
            let stretch = |cell_share| Stretch {
                length_share: 0.5,
                cell_share,
                expansion: 1.0,
            };
            shared(10, &shares.map(stretch))
                .map(|regions| [regions[0].cells, regions[1].cells])
                .map_err(|error| error.to_string())
        };
        assert_eq!(counts([3e-300, 7e-300]), Ok([3, 7]));
        assert_eq!(counts([0.5, 1e308]), Ok([1, 9]));
        let error = counts([1e308, 1e308]).unwrap_err();
        assert!(error.contains("share of the cells of 1"), "{error}");
    }
}
