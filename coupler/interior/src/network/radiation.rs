//! Views as bonds whose conductance follows temperature.

use calcine_physics::radiation::linear;

use super::Views;

/// Exchange areas between surfaces, and emissivities.
#[derive(Debug, Default)]
pub(super) struct Radiation {
    views: Views,
    emissivity: Vec<f64>,
    /// True where some surface is not black, so that each has a radiosity of its own.
    grey: bool,
}

impl Radiation {
    /// Views and the emissivity of each particle.
    pub fn new(views: &Views, emissivity: Vec<f64>) -> Self {
        Self {
            views: views.clone(),
            grey: views.radiosity && emissivity.iter().any(|e| *e < 1.0),
            emissivity,
        }
    }

    /// True where nothing radiates.
    pub fn is_empty(&self) -> bool {
        self.views.pairs.is_empty() && self.views.reservoirs.is_empty()
    }

    /// Number of nodes that radiosities add.
    pub fn radiosities(&self) -> usize {
        if self.grey && !self.is_empty() {
            self.emissivity.len()
        } else {
            0
        }
    }

    /// Appends the bonds and ties of an iterate: temperatures of all nodes and of reservoirs in K.
    ///
    /// A black surface in a bed with grey ones keeps its radiosity node: its own bond is then so strong, 1e6
    /// of its surface, that both are one.
    pub fn linearise(
        &self,
        kelvin: &[f64],
        reservoirs: &[f64],
        bonds: &mut Vec<([usize; 2], f64)>,
        ties: &mut Vec<([usize; 2], f64)>,
    ) {
        let shift = self.radiosities();
        for &([i, j], area) in &self.views.pairs {
            let ends = [i + shift, j + shift];
            bonds.push((ends, area * linear(kelvin[ends[0]], kelvin[ends[1]])));
        }
        for &([i, reservoir], area) in &self.views.reservoirs {
            let node = i + shift;
            let h = linear(kelvin[node], reservoirs[reservoir]);
            ties.push(([node, reservoir], area * h));
        }
        for i in 0..shift {
            let e = self.emissivity[i];
            let factor = if e < 1.0 {
                (e / (1.0 - e)).min(BLACK)
            } else {
                BLACK
            };
            let h = linear(kelvin[i], kelvin[i + shift]);
            bonds.push(([i, i + shift], self.views.surface[i] * factor * h));
        }
    }
}

/// e/(1 − e) above which a surface counts as black.
const BLACK: f64 = 1e6;
