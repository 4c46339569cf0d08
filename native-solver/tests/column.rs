//! The gas in a duct with a bed in it, one cell wide: verification against exact solutions.

mod common;

use calcine_coupler::physics::Vec3;
pub use calcine_coupler::part::Gas as _;
use common::*;

const SIZE: [f64; 3] = [0.01, 0.01, 0.12];
const CELLS: usize = 12;

fn column(velocity: f64, temperature: f64) -> Driver {
    let mesh = duct(SIZE, [1, 1, CELLS]);
    Driver::new(
        &mesh,
        &setup(&[
            ("bottom", inlet(velocity, temperature)),
            ("top", outlet()),
            ("side", slip()),
        ]),
    )
}

#[test]
fn flow_through_a_jump_of_void_fraction_keeps_the_superficial_velocity() {
    let mut column = column(0.5, 300.0);
    for cell in 3..9 {
        column.bed.void_fraction[cell] = 0.4;
        column.exchange.drag_coefficient[cell] = 1e-4;
    }
    let windows = column.settle(1e-3, 1.0, 3000);
    println!("steady after {windows} windows");
    for cell in 0..CELLS {
        let velocity = column.gas.fields().velocity[cell];
        let superficial = column.bed.void_fraction[cell] * velocity.z;
        println!("{cell} {superficial} {} {}", velocity.z, column.gas.fields().pressure[cell]-ATMOSPHERE);
        assert!((superficial / 0.5 - 1.0).abs() < 1e-9, "{superficial} m/s");
        assert!(velocity.xy().norm() < 1e-15);
    }
}

#[test]
fn timing() {
    let mut column = column(0.5, 400.0);
    for cell in 1..11 {
        column.bed.void_fraction[cell] = 0.476;
        column.exchange.drag_coefficient[cell] = 1e-5;
        column.exchange.heat_coefficient[cell] = 0.01;
        column.exchange.heat_source[cell] = 0.01*300.0;
    }
    for _ in 0..20 { let c = column.window(1e-3, 1.0); println!("{c:?}"); println!("{:e} {:e} {:e}", closure(&column.received.mass), closure(&column.received.energy), closure(&column.received.momentum[2])); }
    println!("{:?}", column.gas.fields().temperature);
    let begun = std::time::Instant::now();
    let mut it = 0;
    for w in 0..10000 { 
        for cell in 1..11 { column.exchange.heat_source[cell] = 0.01*(300.0+1e-4*w as f64); }
        it += column.window(1e-3, 1.0).outer_iterations; }
    println!("{:?} per window, {} outer", begun.elapsed()/10000, it as f64/1e4);
    let _ = Vec3::zeros();
}
