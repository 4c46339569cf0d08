//! How the heat of a particle follows its gas where a network of contacts and radiation leads to it (docs/theory.md, TSM-9).
//!
//! A particle alone takes K = F c/(F + c) from the gas, F = h A being its film and c what it stores over the window, while its heat from
//! the network stays what it is. The next look at the network takes that heat anew: with a conductance G to neighbours, those that swing
//! against each other give back 2 G of what F/(F + c + 2 G) of a change of their gas warms them by, and a gas that itself hardly holds
//! heat moves by −s of that change,
//!
//! s = 2 G F/((F + c + 2 G) c).
//!
//! Above 1 attempts diverge: for F, G ≫ c they do wherever contacts conduct a fraction of the film, grains with fast films and
//! long windows. The line gets the slope K_G = F (c + G)/(F + c + G) there, that of neighbours that stay as they are. The splitting is
//! regular then (no entry of what is left of the matrix is negative), and attempts converge whatever F, G and c.

/// Share up to which a line may be off by the network: attempts end quickly by themselves.
const SOFT: f64 = 0.5;

/// The slope in W/K that a line gets in place of its `own`, F being the `film` and G the conductance of the network, all in W/K; `None`
/// where its own does.
pub(super) fn slope_beside_network(film: f64, own: f64, network: f64) -> Option<f64> {
    if own >= film || own.is_nan() {
        return None;
    }
    let stores = film * own / (film - own);
    let holds = film + stores;
    let swings = own > 0.0 && 2.0 * network * film > SOFT * stores * (holds + 2.0 * network);
    // A network that conducts as well as film and store together holds the particle: its heat follows the gas by its film.
    let held = network > SOFT * holds;
    (held || swings).then(|| film * (stores + network) / (holds + network))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By how much an attempt multiplies a deviation of the gas: two particles of film and store, each beside a gas that holds
    /// `rest` W/K, joined by `network`; both gases deviate alike (`sign` 1), or against each other (−1).
    fn factor(film: f64, stores: f64, network: f64, rest: f64, sign: f64) -> f64 {
        let alone = film * stores / (film + stores);
        let slope = slope_beside_network(film, alone, network).unwrap_or(alone);
        // Surfaces that the network solves beside a gas that is one warmer: F (1 − T) = c T + G (T − ±T).
        let surface = film / (film + stores + network * (1.0 - sign));
        let heat = film * (1.0 - surface);
        // The gas beside the line of that heat at that gas: slope (T − 1) + heat + rest T = 0.
        (slope - heat) / (slope + rest)
    }

    #[test]
    fn attempts_contract_whatever_film_store_and_network() {
        for film in [1e-3, 0.1, 1.0, 16.0, 200.0, 1e4] {
            for network in [1e-3, 0.1, 0.4, 1.0, 5.0, 16.0, 100.0, 1e4] {
                for sign in [1.0, -1.0] {
                    let by = factor(film, 1.0, network, 0.0, sign);
                    assert!(by.abs() < 1.0, "{film} {network} {sign}: {by}");
                }
            }
        }
    }

    #[test]
    fn a_line_keeps_its_slope_where_the_network_hardly_moves_it() {
        // F = 0.4 c, G = 0.3 c.
        assert_eq!(slope_beside_network(0.4, 0.4 / 1.4, 0.3), None);
        // A particle that follows nothing, and one without a network.
        assert_eq!(slope_beside_network(1.0, 1.0, 10.0), None);
        assert_eq!(slope_beside_network(16.0, 16.0 / 17.0, 0.0), None);
    }

    #[test]
    fn a_line_beside_a_network_has_the_slope_of_neighbours_that_stay() {
        // F = 16, c = 1, G = 4: 16 · 5/21.
        let slope = slope_beside_network(16.0, 16.0 / 17.0, 4.0).unwrap();
        assert!((slope - 80.0 / 21.0).abs() < 1e-14, "{slope}");
    }
}
