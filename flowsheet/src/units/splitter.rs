//! A splitter.

use crate::{PlantError, ProcessUnit, StreamLayout, UnitView};

/// Divides a stream into streams of the same composition.
#[derive(Clone, Debug)]
pub struct Splitter {
    /// Share of each outlet ("out1", "out2", …); they sum to 1.
    pub shares: Vec<f64>,
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
        Ok(())
    }

    fn produce(&self, view: &UnitView<'_>, out: &mut [f64]) -> Result<(), PlantError> {
        let width = view.layout.width();
        for (out, share) in out.chunks_exact_mut(width).zip(&self.shares) {
            out.iter_mut()
                .zip(view.inlet(0))
                .for_each(|(o, s)| *o = share * s);
        }
        Ok(())
    }
}
