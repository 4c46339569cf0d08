//! Laws of parcels that move by the multiphase particle-in-cell method (MP-PIC), one a file: the stress of the solid
//! ([`harris_crighton`]) and the time scales of collisions ([`collisions`]).

pub mod collisions;
pub mod harris_crighton;

pub use collisions::CollisionTimes;
pub use harris_crighton::HarrisCrighton;
