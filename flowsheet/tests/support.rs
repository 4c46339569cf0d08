//! Plants that several tests have.

use calcine_flowsheet::{Compound, SizeGrid, StreamLayout};

pub fn solid(name: &str) -> Compound {
    Compound {
        name: name.into(),
        volatile: false,
        solid_heat_capacity: 1500.0,
        liquid_heat_capacity: 2000.0,
        vapour_heat_capacity: 1000.0,
        evaporation_heat: 0.0,
    }
}

pub fn water() -> Compound {
    Compound {
        name: "water".into(),
        volatile: true,
        solid_heat_capacity: 2000.0,
        liquid_heat_capacity: 4200.0,
        vapour_heat_capacity: 1900.0,
        evaporation_heat: 2.5e6,
    }
}

pub fn air() -> Compound {
    Compound {
        name: "air".into(),
        volatile: true,
        solid_heat_capacity: 1000.0,
        liquid_heat_capacity: 1000.0,
        vapour_heat_capacity: 1006.0,
        evaporation_heat: 0.0,
    }
}

/// One solid over a grid.
pub fn plain(grid: SizeGrid) -> StreamLayout {
    StreamLayout::new(grid, Vec::new(), vec![solid("urea")]).unwrap()
}

/// Solids of the first compound with shares by size class, kg/s, at 300 K.
pub fn solids(layout: &StreamLayout, shares: &[f64], flow: f64) -> Vec<f64> {
    let mut stream = vec![0.0; layout.width()];
    for (class, share) in shares.iter().enumerate() {
        stream[class * layout.inner()] = flow * share;
    }
    layout.set_temperature(&mut stream, 300.0);
    stream
}
