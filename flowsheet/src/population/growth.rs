//! Growth and wear by conservative finite volumes.

use crate::SizeGrid;

/// How the number density at the face between two classes follows from the classes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GrowthScheme {
    /// That of the class that particles come from: first order, very diffusive.
    Upwind,
    /// Second order with van Leer's limiter, whose slope is smooth: Newton's iteration converges with it.
    VanLeer,
    /// Third order where smooth, with Koren's limiter, whose slope has kinks.
    Koren,
    /// Dyssol's transport of the mass density, for comparison: it does not conserve mass ([`super::dyssol_growth`]).
    Dyssol,
}

/// Number fluxes between size classes (docs/theory.md, PBM-5).
///
/// Number is conserved as what leaves a class enters the next. Class i stands for particles of mass m_i, so particles that
/// pass from i to i + 1 gain m_(i+1) − m_i each: Σ J (m_(i+1) − m_i) is the mass gained, exactly, and growth that is scaled
/// by it has the spray's.
///
/// Source of the limiter: van Leer, J. Comput. Phys. 14 (1974) 361, doi 10.1016/0021-9991(74)90019-9; Koren, in Numerical
/// Methods for Advection–Diffusion Problems (1993) 117.
#[derive(Clone, Debug)]
pub struct SizeFluxes {
    scheme: GrowthScheme,
    widths: Vec<f64>,
    /// 1/distance between the middles of classes.
    inverse_gaps: Vec<f64>,
}

impl SizeFluxes {
    /// Fluxes over size classes.
    pub fn new(grid: &SizeGrid, scheme: GrowthScheme) -> Self {
        let widths = (0..grid.classes()).map(|k| grid.width(k)).collect();
        let gaps = grid.diameters().windows(2);
        let inverse_gaps = gaps.map(|d| 1.0 / (d[1] - d[0])).collect();
        Self {
            scheme,
            widths,
            inverse_gaps,
        }
    }

    /// Slope of the number density in a class, limited; `forward` where particles grow.
    fn slope(&self, densities: &[f64], class: usize, forward: bool) -> f64 {
        if class == 0 || class + 1 == densities.len() || self.scheme == GrowthScheme::Upwind {
            return 0.0;
        }
        let before = (densities[class] - densities[class - 1]) * self.inverse_gaps[class - 1];
        let after = (densities[class + 1] - densities[class]) * self.inverse_gaps[class];
        if before * after <= 0.0 {
            return 0.0;
        }
        if self.scheme == GrowthScheme::Koren {
            // The slope between upwind neighbours weighs one third.
            let (up, down) = if forward {
                (before, after)
            } else {
                (after, before)
            };
            let size = (2.0 * up.abs())
                .min((up.abs() + 2.0 * down.abs()) / 3.0)
                .min(2.0 * down.abs());
            return size.copysign(before);
        }
        2.0 * before * after / (before + after)
    }

    /// Number density in 1/m of each class.
    pub fn densities(&self, numbers: &[f64]) -> Vec<f64> {
        let pairs = numbers.iter().zip(&self.widths);
        pairs.map(|(number, width)| number / width).collect()
    }

    /// Number density in 1/m at the face above each class but the last, as growing particles bring it.
    pub fn growing(&self, numbers: &[f64], faces: &mut [f64]) {
        let densities = self.densities(numbers);
        for (class, face) in faces.iter_mut().enumerate() {
            let half = 0.5 * self.widths[class];
            *face = densities[class] + half * self.slope(&densities, class, true);
        }
    }

    /// The same, as shrinking particles bring it.
    pub fn shrinking(&self, numbers: &[f64], faces: &mut [f64]) {
        let densities = self.densities(numbers);
        for (below, face) in faces.iter_mut().enumerate() {
            let class = below + 1;
            let half = 0.5 * self.widths[class];
            *face = densities[class] - half * self.slope(&densities, class, false);
        }
    }
}
