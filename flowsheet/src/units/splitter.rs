//! A splitter.

use crate::{PlantError, ProcessUnit, SignalKind, StreamLayout, UnitView};

/// Divides a stream into streams of the same composition.
#[derive(Clone, Debug)]
pub struct Splitter {
    /// Share of each outlet ("out1", "out2", …); they sum to 1.
    pub shares: Vec<f64>,
    /// Controller whose output is the share of the first outlet; the others divide the rest as their shares are.
    pub controller: Option<String>,
}

impl Splitter {
    /// A splitter of fixed shares.
    pub fn new(shares: Vec<f64>) -> Self {
        Self {
            shares,
            controller: None,
        }
    }

    /// Shares, where the first one is set.
    fn set(&self, first: f64) -> Vec<f64> {
        let first = first.clamp(0.0, 1.0);
        let rest: f64 = self.shares[1..].iter().sum();
        let scale = if rest > 0.0 {
            (1.0 - first) / rest
        } else {
            0.0
        };
        let others = self.shares[1..].iter().map(|share| scale * share);
        std::iter::once(first).chain(others).collect()
    }
}

impl ProcessUnit for Splitter {
    fn inlets(&self) -> Vec<String> {
        vec!["in".into()]
    }

    fn outlets(&self) -> Vec<String> {
        (1..=self.shares.len()).map(|k| format!("out{k}")).collect()
    }

    fn prepare(&mut self, _layout: &StreamLayout, name: &str) -> Result<(), PlantError> {
        let place = || format!("splitter \"{name}\"");
        let inside = |share: &&f64| !(0.0..=1.0).contains(*share);
        if let Some(share) = self.shares.iter().find(inside) {
            return Err(PlantError::Value {
                place: place(),
                quantity: "share",
                value: *share,
                allowed: "it is 0 to 1",
            });
        }
        let sum: f64 = self.shares.iter().sum();
        if (sum - 1.0).abs() > 1e-12 {
            return Err(PlantError::Value {
                place: place(),
                quantity: "sum of the shares",
                value: sum,
                allowed: "it is 1",
            });
        }
        let rest: f64 = self.shares[1..].iter().sum();
        if self.controller.is_some() && rest == 0.0 {
            return Err(PlantError::Value {
                place: place(),
                quantity: "sum of the shares behind the first",
                value: rest,
                allowed: "a controller needs one that takes the rest",
            });
        }
        Ok(())
    }

    fn listens_to(&self) -> Vec<(String, SignalKind)> {
        let name = self.controller.iter();
        name.map(|name| (name.clone(), SignalKind::Setting))
            .collect()
    }

    fn produce(&self, view: &UnitView<'_>, out: &mut [f64]) -> Result<(), PlantError> {
        let width = view.layout.width();
        let set = self
            .controller
            .as_ref()
            .map(|_| self.set(view.signal(0)[0]));
        let shares = set.as_ref().unwrap_or(&self.shares);
        for (out, share) in out.chunks_exact_mut(width).zip(shares) {
            out.iter_mut()
                .zip(view.inlet(0))
                .for_each(|(o, s)| *o = share * s);
        }
        Ok(())
    }
}
