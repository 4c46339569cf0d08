//! Size classes.

use crate::PlantError;

/// Size classes of diameters: edges, and in each class the diameter that stands for it (the middle).
#[derive(Clone, Debug, PartialEq)]
pub struct SizeGrid {
    edges: Vec<f64>,
    mids: Vec<f64>,
}

impl SizeGrid {
    /// Classes between rising edges in m.
    pub fn from_edges(edges: Vec<f64>) -> Result<Self, PlantError> {
        if edges.len() < 3 {
            return Err(PlantError::Grid(format!("{} edges", edges.len())));
        }
        if let Some(bad) = edges
            .iter()
            .find(|edge| !(edge.is_finite() && **edge >= 0.0))
        {
            return Err(PlantError::Grid(format!("an edge of {bad} m")));
        }
        if let Some(pair) = edges.windows(2).find(|pair| pair[1] <= pair[0]) {
            let text = format!("{} m comes after {} m", pair[1], pair[0]);
            return Err(PlantError::Grid(text));
        }
        let mids = edges.windows(2).map(|e| 0.5 * (e[0] + e[1])).collect();
        Ok(Self { edges, mids })
    }

    /// Classes of one width between two diameters in m.
    pub fn uniform(classes: usize, from: f64, to: f64) -> Result<Self, PlantError> {
        let step = (to - from) / classes as f64;
        let edge = |k: usize| {
            if k == classes {
                to
            } else {
                from + k as f64 * step
            }
        };
        Self::from_edges((0..=classes).map(edge).collect())
    }

    /// Classes whose edges have one ratio, between two diameters in m.
    pub fn geometric(classes: usize, from: f64, to: f64) -> Result<Self, PlantError> {
        let ratio = (to / from).ln() / classes as f64;
        let edge = |k: usize| {
            if k == classes {
                to
            } else {
                from * (k as f64 * ratio).exp()
            }
        };
        Self::from_edges((0..=classes).map(edge).collect())
    }

    /// Number of classes.
    pub fn classes(&self) -> usize {
        self.mids.len()
    }

    /// Edges in m, one more than classes.
    pub fn edges(&self) -> &[f64] {
        &self.edges
    }

    /// Diameter in m that stands for each class.
    pub fn diameters(&self) -> &[f64] {
        &self.mids
    }

    /// Width of a class in m.
    pub fn width(&self, class: usize) -> f64 {
        self.edges[class + 1] - self.edges[class]
    }

    /// First and last edge in m.
    pub fn range(&self) -> (f64, f64) {
        (self.edges[0], self.edges[self.edges.len() - 1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_that_fall_or_are_not_finite_are_refused() {
        assert!(SizeGrid::from_edges(vec![0.0, 2e-3, 1e-3]).is_err());
        assert!(SizeGrid::from_edges(vec![0.0, f64::NAN, 1e-3]).is_err());
        assert!(SizeGrid::from_edges(vec![0.0, 1e-3]).is_err());
        assert!(SizeGrid::geometric(4, 0.0, 1e-3).is_err());
    }

    #[test]
    fn a_geometric_grid_has_one_ratio() {
        let grid = SizeGrid::geometric(24, 1e-3, 2e-3).unwrap();
        for pair in grid.edges().windows(2) {
            assert!((pair[1] / pair[0] - 2f64.powf(1.0 / 24.0)).abs() < 1e-14);
        }
        assert_eq!(grid.range(), (1e-3, 2e-3));
    }
}
