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

    /// Slope of the number density in a class, limited; `forward` where particles grow. Of the differences to its neighbours the
    /// `jumps` are taken away first, by which the density rises over the class before and the class after.
    fn slope(&self, densities: &[f64], jumps: [f64; 2], class: usize, forward: bool) -> f64 {
        if class == 0 || class + 1 == densities.len() {
            return 0.0;
        }
        let [below, above] = jumps;
        let before =
            (densities[class] - densities[class - 1] - below) * self.inverse_gaps[class - 1];
        let after = (densities[class + 1] - densities[class] - above) * self.inverse_gaps[class];
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
    ///
    /// `births` are the particles that come into each class, over their growth, in 1/m: B_i/G_i. Where they stay the density
    /// rises by so much over the class, G ∂n/∂d = B/Δ, which is no slope between neighbours: particles that come into an empty
    /// class stand at its middle, and have half of it before them. They raise it by no more than twice the density of the class, which then
    /// lies in its upper half.
    pub fn growing(&self, numbers: &[f64], births: &[f64], faces: &mut [f64]) {
        let densities = self.densities(numbers);
        if self.scheme == GrowthScheme::Upwind {
            faces.copy_from_slice(&densities[..faces.len()]);
            return;
        }
        let rises: Vec<f64> = births
            .iter()
            .zip(&densities)
            .map(|(birth, density)| limited(*birth, 2.0 * density.max(0.0)))
            .collect();
        let half = |class: usize| 0.5 * rises[class];
        for (class, face) in faces.iter_mut().enumerate() {
            let mut slope = 0.0;
            if class > 0 {
                let jumps = [half(class - 1) + half(class), half(class) + half(class + 1)];
                slope = self.slope(&densities, jumps, class, true);
            }
            let there = densities[class] + 0.5 * self.widths[class] * slope + half(class);
            // Births on both sides could turn it.
            *face = there.max(0.0);
        }
    }

    /// The same, as shrinking particles bring it.
    pub fn shrinking(&self, numbers: &[f64], faces: &mut [f64]) {
        let densities = self.densities(numbers);
        for (below, face) in faces.iter_mut().enumerate() {
            let class = below + 1;
            let half = 0.5 * self.widths[class];
            let slope = match self.scheme {
                GrowthScheme::Upwind => 0.0,
                _ => self.slope(&densities, [0.0; 2], class, false),
            };
            *face = densities[class] - half * slope;
        }
    }
}

/// `x` as long as it is well below `most`, and no more than that: x + r⁴ (most − x) with r = x/most, whose slope is zero at `most`.
fn limited(x: f64, most: f64) -> f64 {
    if x <= 0.0 || most <= 0.0 {
        return 0.0;
    }
    if x >= most {
        return most;
    }
    let square = (x / most).powi(2);
    x + square * square * (most - x)
}
