//! Kapur's two powers.

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};
use calcine_physics::sphere::volume_of_diameter;

use super::aggregation_kernel::AggregationKernel;

/// Powers of the sum and of the product of volumes, to be fitted.
///
/// β = β₀ (x + y)^a/(x y)^b,   x, y the volumes relative to that of a reference diameter
///
/// Source: Kapur, Chem. Eng. Sci. 27 (1972) 1863, doi 10.1016/0009-2509(72)85048-6.
#[derive(Clone, Copy, Debug)]
pub struct KapurKernel {
    /// β₀ in 1/s.
    pub rate: f64,
    /// Reference diameter in m.
    pub reference: f64,
    /// a.
    pub sum: f64,
    /// b.
    pub product: f64,
}

impl AggregationKernel for KapurKernel {
    fn rate(&self, u: f64, v: f64) -> f64 {
        let unit = volume_of_diameter(self.reference);
        let (u, v) = (u / unit, v / unit);
        self.rate * (u + v).powf(self.sum) / (u * v).powf(self.product)
    }
}

/// Its entry in a case file.
pub(super) static KAPUR: LawEntry<dyn AggregationKernel> = LawEntry {
    name: "kapur",
    summary: "Powers of the sum and of the product of the volumes, to be fitted.",
    source: "Kapur, Chem. Eng. Sci. 27 (1972) 1863, doi 10.1016/0009-2509(72)85048-6",
    parameters: &[
        LawParameter {
            name: "rate",
            dimension: Dimension([0, 0, -1, 0, 0]),
            bound: Bound::NotNegative,
            default: None,
            needed_with: None,
            meaning: "Rate where the sum and the product of the volumes are those of the reference diameter and its square.",
            example: "\"1e-9 1/s\"",
        },
        LawParameter {
            name: "reference",
            dimension: Dimension([1, 0, 0, 0, 0]),
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Reference diameter.",
            example: "\"1 mm\"",
        },
        LawParameter {
            name: "sum",
            dimension: Dimension([0, 0, 0, 0, 0]),
            bound: Bound::Any,
            default: None,
            needed_with: None,
            meaning: "Power of the sum.",
            example: "0.71",
        },
        LawParameter {
            name: "product",
            dimension: Dimension([0, 0, 0, 0, 0]),
            bound: Bound::Any,
            default: None,
            needed_with: None,
            meaning: "Power of the product, by which is divided.",
            example: "0.06",
        },
    ],
    tables: &[],
    make: |values| {
        Box::new(KapurKernel {
            rate: values[0],
            reference: values[1],
            sum: values[2],
            product: values[3],
        })
    },
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_the_sum_kernel_and_the_inverse_product_in_its_limits() {
        let law = |sum, product| KapurKernel {
            rate: 2.0,
            reference: 1e-3,
            sum,
            product,
        };
        let unit = volume_of_diameter(1e-3);
        assert!((law(1.0, 0.0).rate(unit, 3.0 * unit) / 8.0 - 1.0).abs() < 1e-14);
        assert!((law(0.0, 1.0).rate(unit, 3.0 * unit) * 3.0 / 2.0 - 1.0).abs() < 1e-14);
    }
}
