//! Laws of reactive granular beds as pure functions of local state, one law a file.
#![warn(missing_docs)]

pub mod bed_conductivity;
pub mod conduction;
pub mod contact;
pub mod dimension;
pub mod drag;
pub mod figures;
pub mod film;
pub mod flow_range;
pub mod gas;
pub mod gas_model;
pub mod heat_transfer;
pub mod inertial_number;
pub mod kinetics;
pub mod law;
pub mod local;
pub mod mass_transfer;
pub mod moisture;
pub mod numbers;
pub mod parcels;
pub mod points;
pub mod pores;
pub mod pressure_drop;
pub mod quadrature;
pub mod radiation;
pub mod reaction;
pub mod solid;
pub mod solids;
pub mod sphere;
pub mod thermo;
pub mod turbulence;

/// A vector in space.
pub type Vec3 = nalgebra::Vector3<f64>;
