//! What passes into and out of gas and particles in a window, way by way: the terms of the ledger's balances of mass and
//! energy (docs/theory.md, CON-2) by themselves.

/// What went one way and the other, both positive, over a window.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TwoWayFlow {
    /// Into the balance.
    pub inward: f64,
    /// Out of it.
    pub outward: f64,
}

impl TwoWayFlow {
    /// That of flows whose net sum inwards and whose sum of magnitudes are known.
    pub fn of_flows(net: f64, magnitude: f64) -> Self {
        Self {
            inward: (0.5 * (magnitude + net)).max(0.0),
            outward: (0.5 * (magnitude - net)).max(0.0),
        }
    }

    /// That of one amount, inwards where it is positive.
    pub fn of_net(net: f64) -> Self {
        Self::of_flows(net, net.abs())
    }

    /// What came in more than went out.
    pub fn net(self) -> f64 {
        self.inward - self.outward
    }
}

/// The ways of a window. Those of each balance sum up to what the ledger has as its drift.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WindowFlows {
    /// Gas mass in kg.
    pub mass: Vec<(&'static str, TwoWayFlow)>,
    /// Energy of gas and particles in J.
    pub energy: Vec<(&'static str, TwoWayFlow)>,
    /// Mass in kg of each species of a mixture through the boundary, in the order of the mixture.
    pub species: Vec<TwoWayFlow>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flows_are_parted_by_their_net_sum_and_their_magnitude() {
        // 5 in, 2 out.
        let passage = TwoWayFlow::of_flows(3.0, 7.0);
        assert_eq!((passage.inward, passage.outward), (5.0, 2.0));
        assert_eq!(passage.net(), 3.0);
        let out = TwoWayFlow::of_net(-4.0);
        assert_eq!((out.inward, out.outward), (0.0, 4.0));
    }
}
