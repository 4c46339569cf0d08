//! A bed that is computed elsewhere.

use crate::coupled_bed::{BedCoupling, BedExchange};
use crate::{PlantError, ProcessUnit, SignalKind, StreamLayout, UnitView};

/// A coupled bed as a unit (docs/theory.md, FLS-8). Port in: `feed`; out: `product`.
///
/// Exchanges fall on the multiples of an interval. What flowed in since the exchange before is fed to the bed, which then
/// follows that interval; what left the bed in it leaves the unit evenly over the interval that follows. So what comes out
/// is one interval late, and the unit opens a recycle. It holds what waits, what is in the bed, and what is about to leave:
/// balances close at any time. The heat that the bed's gas and walls gave is booked with the exchange.
#[derive(Clone, Debug, PartialEq)]
pub struct CoupledBedUnit {
    /// Interval, feeds and kernel.
    pub coupling: BedCoupling,
}

/// Rows of the layout among the unknowns: what waits, what the bed holds, what is about to leave, and how fast.
const WAITING: usize = 0;
const BED: usize = 1;
const LEAVING: usize = 2;
const FLOW: usize = 3;
const ROWS: usize = 4;

impl CoupledBedUnit {
    fn row(layout: &StreamLayout, row: usize) -> std::ops::Range<usize> {
        row * layout.width()..(row + 1) * layout.width()
    }

    /// Places of what feeds owe, and of the kernel.
    fn tail(&self, layout: &StreamLayout) -> [std::ops::Range<usize>; 2] {
        let start = ROWS * layout.width();
        let middle = start + self.coupling.feeds;
        let kernel = self.coupling.diameters.len().pow(2);
        [start..middle, middle..middle + kernel]
    }
}

impl ProcessUnit for CoupledBedUnit {
    fn inlets(&self) -> Vec<String> {
        vec!["feed".into()]
    }

    fn outlets(&self) -> Vec<String> {
        vec!["product".into()]
    }

    fn prepare(&mut self, _layout: &StreamLayout, name: &str) -> Result<(), PlantError> {
        let interval = self.coupling.interval;
        match interval > 0.0 && interval.is_finite() {
            true => Ok(()),
            false => Err(PlantError::Value {
                place: format!("bed \"{name}\""),
                quantity: "interval in s",
                value: interval,
                allowed: "it is above zero",
            }),
        }
    }

    fn unknowns(&self, layout: &StreamLayout) -> usize {
        self.tail(layout)[1].end
    }

    fn passes_through(&self) -> bool {
        false
    }

    fn produce(&self, view: &UnitView<'_>, out: &mut [f64]) -> Result<(), PlantError> {
        out.copy_from_slice(&view.state[Self::row(view.layout, FLOW)]);
        Ok(())
    }

    fn rates(&self, view: &UnitView<'_>, out: &[f64], rates: &mut [f64]) -> Result<(), PlantError> {
        rates[Self::row(view.layout, WAITING)].copy_from_slice(view.inlet(0));
        let leaving = &mut rates[Self::row(view.layout, LEAVING)];
        leaving.iter_mut().zip(out).for_each(|(rate, o)| *rate = -o);
        Ok(())
    }

    fn held(&self, layout: &StreamLayout, state: &[f64], held: &mut [f64]) {
        for row in [WAITING, BED, LEAVING] {
            let own = &state[Self::row(layout, row)];
            held.iter_mut().zip(own).for_each(|(h, s)| *h += s);
        }
    }

    fn scales(&self, layout: &StreamLayout, scales: &mut [f64]) {
        for row in scales[..ROWS * layout.width()].chunks_exact_mut(layout.width()) {
            row[layout.enthalpy()] *= 1e5;
        }
    }

    fn next_break(&self, time: f64) -> Option<f64> {
        Some(self.coupling.next(time))
    }

    fn signals(&self) -> Option<(SignalKind, usize)> {
        let count = self.coupling.diameters.len();
        (count > 0).then_some((SignalKind::Kernel, count + count * count))
    }

    fn signal(&self, layout: &StreamLayout, state: &[f64], out: &mut [f64]) {
        let diameters = &self.coupling.diameters;
        if diameters.is_empty() {
            return;
        }
        let (first, rates) = out.split_at_mut(diameters.len());
        first.copy_from_slice(diameters);
        rates.copy_from_slice(&state[self.tail(layout)[1].clone()]);
    }

    fn coupling(&self) -> Option<BedCoupling> {
        Some(self.coupling.clone())
    }

    fn waiting(&self, layout: &StreamLayout, state: &[f64]) -> [Vec<f64>; 2] {
        let [due, _] = self.tail(layout);
        [Self::row(layout, WAITING), due].map(|places| state[places].to_vec())
    }

    fn fill(&self, layout: &StreamLayout, content: &[f64], state: &mut [f64]) {
        state[Self::row(layout, BED)].copy_from_slice(content);
    }

    fn exchanged(&self, layout: &StreamLayout, done: &BedExchange, state: &mut [f64]) {
        let [due, kernel] = self.tail(layout);
        for (places, values) in [
            (Self::row(layout, WAITING), &done.waiting),
            (Self::row(layout, BED), &done.held),
            (due, &done.due),
            (kernel, &done.kernel),
        ] {
            state[places].copy_from_slice(values);
        }
        // What round-off left of the interval before leaves with the rest.
        let leaving = &mut state[Self::row(layout, LEAVING)];
        leaving
            .iter_mut()
            .zip(&done.left)
            .for_each(|(own, left)| *own += left);
        let interval = self.coupling.interval;
        let flow: Vec<f64> = leaving.iter().map(|own| own / interval).collect();
        state[Self::row(layout, FLOW)].copy_from_slice(&flow);
    }
}
