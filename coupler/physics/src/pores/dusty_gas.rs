//! Flows of the gases of a mixture through pores.

use calcine_numerics::Lanes;

use crate::gas::GAS_CONSTANT;

/// Most gases whose flows are found.
pub const MOST_GASES: usize = 8;

/// The diffusive part of the dusty gas: flows n in mol/m²/s through pores of the porosity over tortuosity ψ,
///
/// n_i/D_K,i + Σ_j (x_j n_i − x_i n_j)/D_ij = −ψ/(R T) ∂p_i,
///
/// of gases of partial pressures p = x p, Knudsen diffusivities D_K and pair diffusivities D_ij. What flows by the gradient of
/// pressure (Darcy), −p_i K/(μ R T) ∂p, comes on top: the whole is the dusty gas model. At one pressure Σ n_i √M_i = 0 (Graham).
///
/// Source: Mason and Malinauskas, Gas Transport in Porous Media: The Dusty-Gas Model (1983), ISBN 0-444-42190-4, equation 152;
/// Jackson, Transport in Porous Catalysts (1977), ISBN 0-444-41593-0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DustyGas;

impl DustyGas {
    /// Fills the matrix of n_i = −ψ Σ_k m_ik ∂p_k, in mol/m/s/Pa, row by row, of mixtures side by side: at mole fractions x, with Knudsen
    /// diffusivities and the pair diffusivities `pair(i, j)`, all in m²/s, and temperatures in K. Not finite where there is none.
    #[inline(always)]
    pub fn fill<const N: usize>(
        self,
        fractions: &[Lanes<N>],
        knudsen: &[Lanes<N>],
        pair: impl Fn(usize, usize) -> Lanes<N>,
        temperature: Lanes<N>,
        out: &mut [Lanes<N>],
    ) {
        let n = fractions.len();
        let a = &mut out[..n * n];
        for i in 0..n {
            a[i * n + i] = knudsen[i].inverse();
        }
        for i in 0..n {
            for j in i + 1..n {
                let resistance = pair(i, j).inverse();
                let (own, other) = (fractions[i] * resistance, fractions[j] * resistance);
                a[i * n + i] += other;
                a[j * n + j] += own;
                a[i * n + j] = -own;
                a[j * n + i] = -other;
            }
        }
        // Columns are dominated by their diagonal, 1/D_K + Σ x_j/D_ij against the same sum without walls: inverted in place
        // without pivots.
        for k in 0..n {
            let inverse = a[k * n + k].inverse();
            a[k * n + k] = inverse;
            for j in 0..n {
                if j != k {
                    a[k * n + j] = a[k * n + j] * inverse;
                }
            }
            for i in 0..n {
                if i == k {
                    continue;
                }
                let share = a[i * n + k];
                a[i * n + k] = -(share * inverse);
                for j in 0..n {
                    if j != k {
                        let pivot = a[k * n + j];
                        a[i * n + j] -= share * pivot;
                    }
                }
            }
        }
        let scale = (temperature * GAS_CONSTANT).inverse();
        for value in a {
            *value = *value * scale;
        }
    }

    /// Parts such a matrix into what a gas does by itself and by the others that drag it along: n_i = −ψ (a_i ∂p_i + x_i Σ_k d_ik ∂p_k) with
    /// a_i = 1/(R T (1/D_K,i + Σ_j x_j/D_ij)). The drag has the form of convection, x_i times what all gases do, and stays finite where
    /// there is none of a gas. The matrix becomes that of d.
    #[inline(always)]
    pub fn part<const N: usize>(
        self,
        fractions: &[Lanes<N>],
        knudsen: &[Lanes<N>],
        pair: impl Fn(usize, usize) -> Lanes<N>,
        temperature: Lanes<N>,
        matrix: &mut [Lanes<N>],
        own: &mut [Lanes<N>],
    ) {
        let n = fractions.len();
        let mut flows = [[Lanes::default(); MOST_GASES]; MOST_GASES];
        for (i, row) in flows.iter_mut().enumerate().take(n) {
            row[..n].copy_from_slice(&matrix[i * n..(i + 1) * n]);
        }
        let scale = (temperature * GAS_CONSTANT).inverse();
        for i in 0..n {
            let mut resistance = knudsen[i].inverse();
            let drags = &mut matrix[i * n..(i + 1) * n];
            drags.fill(Lanes::default());
            for j in (0..n).filter(|j| *j != i) {
                let over = pair(i, j).inverse();
                resistance += fractions[j] * over;
                for (drag, flow) in drags.iter_mut().zip(&flows[j]) {
                    *drag += *flow * over;
                }
            }
            let alone = resistance.inverse();
            for drag in drags {
                *drag = *drag * alone;
            }
            own[i] = alone * scale;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pores::knudsen;

    const MASSES: [f64; 2] = [0.044_009_5, 0.028_013_4];

    /// Flows of CO2 and N2 at one pressure by opposite gradients of 1 Pa/m.
    fn counter(pore: f64, between: f64) -> [f64; 2] {
        let walls = MASSES.map(|mass| knudsen::diffusivity(pore, 1000.0, mass));
        let mut matrix = [Lanes([0.0]); 4];
        let (fractions, walls) = ([0.4, 0.6].map(Lanes::all), walls.map(Lanes::all));
        let pair = |_, _| Lanes::all(between);
        DustyGas.fill(&fractions, &walls, pair, Lanes([1000.0]), &mut matrix);
        let matrix = matrix.map(|value| value[0]);
        [matrix[0] - matrix[1], matrix[2] - matrix[3]]
    }

    #[test]
    fn gases_that_change_places_at_one_pressure_go_as_the_roots_of_their_masses() {
        // Graham: |N_CO2/N_N2| = √(M_N2/M_CO2) = 0.797 83, in narrow and in wide pores (requirements XDP-14).
        for (pore, between) in [(1e-9, 1e-4), (1e-7, 1e-4), (1e-5, 1e-4)] {
            let [one, other] = counter(pore, between);
            assert!(
                (one / other + 0.797_829).abs() < 1e-6,
                "{pore}: {}",
                one / other
            );
        }
    }

    #[test]
    fn the_parts_of_a_flow_are_the_flow() {
        let between = [[0.0, 1e-4, 2e-4], [1e-4, 0.0, 3e-4], [2e-4, 3e-4, 0.0]];
        let pair = |i: usize, j: usize| Lanes::all(between[i][j]);
        for (fractions, pore) in [([0.2, 0.3, 0.5], 1e-7), ([0.0, 0.4, 0.6], 1e-5)] {
            let fractions = fractions.map(Lanes::<1>::all);
            let masses = [0.002, 0.028, 0.044];
            let walls = masses.map(|mass| Lanes::all(knudsen::diffusivity(pore, 900.0, mass)));
            let mut whole = [Lanes([0.0]); 9];
            DustyGas.fill(&fractions, &walls, pair, Lanes([900.0]), &mut whole);
            let (mut drags, mut own) = (whole, [Lanes([0.0]); 3]);
            DustyGas.part(
                &fractions,
                &walls,
                pair,
                Lanes([900.0]),
                &mut drags,
                &mut own,
            );
            for i in 0..3 {
                for j in 0..3 {
                    let alone = if i == j { own[i][0] } else { 0.0 };
                    let found = alone + fractions[i][0] * drags[3 * i + j][0];
                    let exact = whole[3 * i + j][0];
                    assert!((found - exact).abs() < 1e-12 * whole[4 * i][0], "{i} {j}");
                }
            }
        }
    }

    #[test]
    fn narrow_pores_are_knudsen_s_and_wide_ones_of_two_gases_have_the_pair_s_diffusivity() {
        let one = 1.0 / (GAS_CONSTANT * 1000.0);
        let [narrow, _] = counter(1e-12, 1e-4);
        assert!(
            (narrow / (one * knudsen::diffusivity(1e-12, 1000.0, MASSES[0])) - 1.0).abs() < 1e-5
        );
        // Wide: n_1 (x_2 + x_1 √(M_1/M_2)) = −D/(RT) ∂p_1 with Graham's n_2.
        let [wide, _] = counter(1e-2, 1e-4);
        let expected = one * 1e-4 / (0.6 + 0.4 * (MASSES[0] / MASSES[1]).sqrt());
        assert!((wide / expected - 1.0).abs() < 1e-4, "{}", wide / expected);
    }

    #[test]
    fn a_single_gas_meets_walls_alone() {
        let mut one = [Lanes([0.0])];
        let pair = |_, _| Lanes([1e-4]);
        DustyGas.fill(
            &[Lanes([1.0])],
            &[Lanes([2e-5])],
            pair,
            Lanes([500.0]),
            &mut one,
        );
        assert!((one[0][0] / (2e-5 / (GAS_CONSTANT * 500.0)) - 1.0).abs() < 1e-14);
    }
}
