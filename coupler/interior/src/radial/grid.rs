//! The shells of a particle as a grid of finite volumes.

use std::f64::consts::PI;

use calcine_numerics::Lanes;
use calcine_physics::sphere;

/// How a sphere is cut into shells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShellGrid {
    /// Number of shells.
    pub shells: usize,
    /// How their thicknesses follow from each other.
    pub grading: ShellGrading,
}

/// How shells get thinner towards the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShellGrading {
    /// A geometric series; how many times as thick as the outermost shell the innermost one is.
    Ratio(f64),
    /// For a layer below the surface in which concentrations fall as exp(-φ s/R) at the depth s, by its Thiele number φ. Shells of second
    /// order have errors of h² exp(-φ s/R), which are alike where they get thicker as exp(φ s/(2 R)); an eleventh of the shells lies
    /// evenly along the radius.
    Thiele(f64),
}

impl ShellGrid {
    /// The share of each shell in the volume, from the centre outwards.
    pub fn shares(&self) -> Vec<f64> {
        let mut inner = 0.0;
        let share = |outer: f64| {
            let share = outer.powi(3) - f64::powi(inner, 3);
            inner = outer;
            share
        };
        self.faces().into_iter().map(share).collect()
    }

    /// What these shells let a first-order reaction of a Thiele number R √(k/D) take, over what it takes: the effectiveness by finite
    /// volumes over 3 (φ coth φ − 1)/φ², of numbers above zero (Thiele, Ind. Eng. Chem. 31 (1939) 916).
    pub fn share_of_layer(&self, thiele: f64) -> f64 {
        let shares = self.shares();
        let square = thiele * thiele;
        // Conductance and storage of shells with a gas of concentration one at the surface, from the centre outwards: what a shell and all
        // within it take is proportional to the concentration at the next node.
        let (mut taking, mut within, mut inner) = (0.0, 0.0, 0.0);
        for (share, node) in shares.iter().zip(mean_squares(&shares)) {
            if within > 0.0 {
                let passes = 2.0 * f64::powi(inner, 3) / (node - f64::powi(inner, 2) + within);
                taking = taking * passes / (taking + passes);
            }
            taking += square * share / 3.0;
            inner = f64::cbrt(f64::powi(inner, 3) + share);
            within = inner * inner - node;
        }
        taking = taking * (2.0 / within) / (taking + 2.0 / within);
        taking / (thiele / thiele.tanh() - 1.0)
    }

    /// Outer face of each shell over the radius of the surface, from the centre outwards.
    fn faces(&self) -> Vec<f64> {
        let last = self.shells.saturating_sub(1);
        let mut faces: Vec<f64> = match self.grading {
            ShellGrading::Ratio(grading) => {
                let ratio = grading.powf(-1.0 / last.max(1) as f64);
                let thickness = (0..self.shells).map(|k| ratio.powi(k as i32));
                let all: f64 = thickness.clone().sum();
                let mut inner = 0.0;
                let outer = |own: f64| {
                    inner += own / all;
                    inner
                };
                thickness.map(outer).collect()
            }
            ShellGrading::Thiele(number) => {
                let outside = |k: usize| (last - k) as f64 / self.shells as f64;
                let face = |k| 1.0 - depth(number, outside(k));
                (0..self.shells).map(face).collect()
            }
        };
        if let Some(surface) = faces.last_mut() {
            *surface = 1.0;
        }
        faces
    }
}

/// Depth below the surface, over the radius, outside of which a share of the shells lies: their density is exp(-φ s/2) + 0.2/φ, found by
/// bisection.
fn depth(thiele: f64, share: f64) -> f64 {
    let outside = |s: f64| (1.0 - (-0.5 * thiele * s).exp()) * 2.0 + 0.2 * s;
    let sought = share * outside(1.0);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..f64::MANTISSA_DIGITS {
        let middle = 0.5 * (low + high);
        if outside(middle) < sought {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Where the shells of a particle lie.
///
/// Values of a shell stand at the radius whose square is the mean of r² over the shell, and gradients are taken in r²,
/// ∂f/∂r = 2 r ∂f/∂(r²): a parabola, which is what steady conduction with a source has, is then exact, and a single shell has the
/// resistance R/5 between its mean and its surface.
#[derive(Clone, Debug, Default)]
pub(super) struct ShellGeometry<const N: usize> {
    /// Radius of the outer face of each shell in m.
    pub face: Vec<Lanes<N>>,
    /// Area of that face in m².
    pub area: Vec<Lanes<N>>,
    /// Distance in m from the value of each shell to its outer face, as resistances count it.
    pub outwards: Vec<Lanes<N>>,
    /// Distance in m from that face to the value of the next shell; zero of the last one, whose face is the surface.
    pub beyond: Vec<Lanes<N>>,
}

impl<const N: usize> ShellGeometry<N> {
    /// Makes room for so many shells.
    pub fn resize(&mut self, shells: usize) {
        for list in [
            &mut self.face,
            &mut self.area,
            &mut self.outwards,
            &mut self.beyond,
        ] {
            list.resize(shells, Lanes::default());
        }
    }

    /// Finds it from the volumes of the shells in m³.
    #[inline(always)]
    pub fn measure(&mut self, volumes: &[Lanes<N>]) {
        let (mut within, mut inner) = (Lanes::default(), Lanes::default());
        for (k, volume) in volumes.iter().enumerate() {
            within += *volume;
            let outer = within.map(sphere::radius_of);
            // 4 π/5 (b⁵ − a⁵) over the volume; of a thin shell between its faces without a difference.
            let square = mean_square(inner, outer);
            self.face[k] = outer;
            self.area[k] = outer * outer * (4.0 * PI);
            self.outwards[k] = (outer * outer - square) / outer * 0.5;
            self.beyond[k] = Lanes::default();
            if k > 0 {
                self.beyond[k - 1] = (square - inner * inner) / inner * 0.5;
            }
            inner = outer;
        }
    }

    /// Radius of the surface in m.
    pub fn radius(&self) -> Lanes<N> {
        self.face.last().copied().unwrap_or_default()
    }
}

/// The mean of r² of each shell over that of the surface, by the shares of the shells in the volume.
pub(super) fn mean_squares(shares: &[f64]) -> Vec<f64> {
    let (mut within, mut inner) = (0.0, 0.0);
    let one = |share: &f64| {
        within += share;
        let outer = f64::cbrt(within);
        let [square] = mean_square(Lanes([inner]), Lanes([outer])).0;
        inner = outer;
        square
    };
    shares.iter().map(one).collect()
}

/// Radius in m at which the value of a shell between two radii in m stands.
pub fn node_of_shell(inner: f64, outer: f64) -> f64 {
    let [square] = mean_square(Lanes([inner]), Lanes([outer])).0;
    square.sqrt()
}

/// The mean of r² over a shell between two radii in m: 3/5 (b⁵ − a⁵)/(b³ − a³).
#[inline(always)]
fn mean_square<const N: usize>(a: Lanes<N>, b: Lanes<N>) -> Lanes<N> {
    let fifth = (((a + b) * a + b * b) * a + b * b * b) * a + b * b * b * b;
    let third = b * b + b * a + a * a;
    fifth / third * 0.6
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_fill_the_sphere_and_are_graded_as_asked() {
        let grid = ShellGrid {
            shells: 20,
            grading: ShellGrading::Ratio(4.0),
        };
        let shares: [f64; 20] = grid.shares().try_into().unwrap();
        assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        let mut geometry = ShellGeometry::<1>::default();
        geometry.resize(20);
        geometry.measure(&shares.map(|share| Lanes([share])));
        let thick = |k: usize| {
            let inner = if k == 0 { 0.0 } else { geometry.face[k - 1][0] };
            geometry.face[k][0] - inner
        };
        assert!((thick(0) / thick(19) - 4.0).abs() < 1e-9);
        let squares = mean_squares(&shares).into_iter().zip(shares);
        assert!((squares.map(|(square, share)| square * share).sum::<f64>() - 0.6).abs() < 1e-14);
    }

    #[test]
    fn shells_by_a_thiele_number_lie_in_its_layer() {
        for number in [1.0, 30.0, 1000.0] {
            let grid = ShellGrid {
                shells: 40,
                grading: ShellGrading::Thiele(number),
            };
            let faces = grid.faces();
            assert_eq!(faces[39], 1.0);
            let thick = |k: usize| faces[k] - if k == 0 { 0.0 } else { faces[k - 1] };
            assert!((1..40).all(|k| thick(k) < thick(k - 1) && thick(k) > 0.0));
            // Ten parts of the shells lie as exp(-φ s/2) goes, one part evenly.
            for (k, face) in faces.iter().enumerate() {
                let depth = 1.0 - face;
                let layer = |s: f64| -f64::exp_m1(-0.5 * number * s);
                let share = (10.0 * layer(depth) + depth) / (10.0 * layer(1.0) + 1.0);
                assert!(
                    (share * 40.0 - (39 - k) as f64).abs() < 1e-9,
                    "{number} {k}"
                );
            }
        }
    }

    #[test]
    fn the_share_of_a_layer_is_that_of_catalyst_spheres() {
        let geometric = |ratio| ShellGrid {
            shells: 40,
            grading: ShellGrading::Ratio(ratio),
        };
        // A separate elimination in Python of the same finite volumes, in millionths off one.
        for (thiele, ratio, off) in [
            (5.0, 10.0, -213.0),
            (30.0, 4.0, -13826.0),
            (30.0, 100.0, -1287.0),
        ] {
            let found = (geometric(ratio).share_of_layer(thiele) - 1.0) * 1e6;
            assert!((found - off).abs() < 1.0, "{thiele} {ratio}: {found}");
        }
    }

    #[test]
    fn one_shell_has_the_resistance_of_a_fifth_of_its_radius() {
        let mut geometry = ShellGeometry::<1>::default();
        geometry.resize(1);
        geometry.measure(&[Lanes([sphere::volume(3.0)])]);
        assert!((geometry.outwards[0][0] - 0.6).abs() < 1e-14);
    }

    #[test]
    fn the_mean_square_is_the_integral() {
        // ∫ r⁴ dr/∫ r² dr from 1 to 2: (31/5)/(7/3).
        let mean_square = |a, b| mean_square(Lanes([a]), Lanes([b]))[0];
        assert!((mean_square(1.0, 2.0) - 31.0 / 5.0 * 3.0 / 7.0).abs() < 1e-14);
        assert!((mean_square(0.0, 1.0) - 0.6).abs() < 1e-15);
    }
}
