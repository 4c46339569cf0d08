//! Rates at which two particles aggregate. One law a file.

mod aggregation_kernel;
mod brownian;
mod constant;
mod equipartition;
mod kapur;
mod product;
mod settling;
mod shear;
mod sum;
mod table;

use calcine_physics::law::LawEntry;

pub use aggregation_kernel::AggregationKernel;
pub use brownian::BrownianKernel;
pub use constant::ConstantKernel;
pub use equipartition::EquipartitionKernel;
pub use kapur::KapurKernel;
pub use product::ProductKernel;
pub use settling::SettlingKernel;
pub use shear::ShearKernel;
pub use sum::SumKernel;
pub use table::TabulatedKernel;

/// The kernels of aggregation that a case may choose. A new one is declared and listed here.
pub static AGGREGATION_LAWS: &[&LawEntry<dyn AggregationKernel>] = &[
    &constant::CONSTANT,
    &sum::SUM,
    &product::PRODUCT,
    &brownian::BROWNIAN,
    &shear::SHEAR,
    &settling::SETTLING,
    &equipartition::EQUIPARTITION,
    &kapur::KAPUR,
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever the order of the particles, and by the degree of homogeneity that the law has in volume.
    #[test]
    fn kernels_are_symmetric_and_have_their_degrees() {
        let laws: [(Box<dyn AggregationKernel>, f64); 8] = [
            (Box::new(ConstantKernel { rate: 2.0 }), 0.0),
            (Box::new(SumKernel { rate: 2.0 }), 1.0),
            (Box::new(ProductKernel { rate: 2.0 }), 2.0),
            (Box::new(BrownianKernel { rate: 2.0 }), 0.0),
            (Box::new(ShearKernel { rate: 2.0 }), 1.0),
            (Box::new(SettlingKernel { rate: 2.0 }), 4.0 / 3.0),
            (
                Box::new(EquipartitionKernel {
                    rate: 2.0,
                    reference: 1e-3,
                }),
                1.0 / 6.0,
            ),
            (
                Box::new(KapurKernel {
                    rate: 2.0,
                    reference: 1e-3,
                    sum: 0.71,
                    product: 0.06,
                }),
                0.71 - 2.0 * 0.06,
            ),
        ];
        for (law, degree) in laws {
            let (one, other) = (law.rate(3e-10, 5e-9), law.rate(5e-9, 3e-10));
            assert!((one / other - 1.0).abs() < 1e-14);
            let found = (law.rate(6e-10, 1e-8) / one).log2();
            assert!((found - degree).abs() < 1e-12, "{found} {degree}");
        }
    }
}
