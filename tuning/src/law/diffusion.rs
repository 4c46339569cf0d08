use calcine_physics::law::LawEntry;

use super::conversion::KineticLaw;

/// Diffusion through the product: α and its derivatives follow from the integral form g(α) by its inverse,
/// dα/dx = 1/g′, d²α/dx² = −g″/g′³. At x = 0 the slope is infinite.
///
/// - `D1`, one direction: g = α²
/// - `D2`, cylinder: g = (1 − α) ln(1 − α) + α
/// - `D3`, sphere, Jander: g = (1 − (1 − α)^⅓)²
/// - `D4`, sphere, Ginstling and Brounshtein: g = 1 − ⅔ α − (1 − α)^⅔
///
/// Source: Khawam and Flanagan, J. Phys. Chem. B 110 (2006) 17315, doi 10.1021/jp062746a, table 1.
#[derive(Clone, Copy, Debug)]
struct ProductDiffusion {
    name: &'static str,
    geometry: Geometry,
}

#[derive(Clone, Copy, Debug)]
enum Geometry {
    Plane,
    Cylinder,
    Jander,
    GinstlingBrounshtein,
}

/// Relative width of the bracket at which the inverse ends.
const EXACT: f64 = 4.0 * f64::EPSILON;
/// Below this conversion the forms that cancel are replaced by their series to the fourth power.
const SERIES: f64 = 1e-3;

impl ProductDiffusion {
    /// g, g′, g″ at a conversion below one.
    fn integral(&self, a: f64) -> [f64; 3] {
        let left = 1.0 - a;
        match self.geometry {
            Geometry::Plane => [a * a, 2.0 * a, 2.0],
            Geometry::Cylinder => {
                let logarithm = (-a).ln_1p();
                let g = match a < SERIES {
                    true => a * a * (0.5 + a * (1.0 / 6.0 + a * (1.0 / 12.0 + a * 0.05))),
                    false => left * logarithm + a,
                };
                [g, -logarithm, 1.0 / left]
            }
            Geometry::Jander => {
                let depth = -((-a).ln_1p() / 3.0).exp_m1();
                let slope = (1.0 - depth).powi(-2) / 3.0;
                let bend = 2.0 / 3.0 * slope / left;
                [
                    depth * depth,
                    2.0 * depth * slope,
                    2.0 * (slope * slope + depth * bend),
                ]
            }
            Geometry::GinstlingBrounshtein => {
                let g = match a < SERIES {
                    true => {
                        a * a / 9.0 * (1.0 + a * (4.0 / 9.0 + a * (7.0 / 27.0 + a * 14.0 / 81.0)))
                    }
                    false => 1.0 - 2.0 / 3.0 * a - left.powf(2.0 / 3.0),
                };
                let slope = 2.0 / 3.0 * (-(-a).ln_1p() / 3.0).exp_m1();
                [g, slope, 2.0 / 9.0 * left.powf(-4.0 / 3.0)]
            }
        }
    }

    /// g at α = 1, where the law ends.
    fn end(&self) -> f64 {
        match self.geometry {
            Geometry::Plane | Geometry::Cylinder | Geometry::Jander => 1.0,
            Geometry::GinstlingBrounshtein => 1.0 / 3.0,
        }
    }

    /// The conversion at which g is x: Newton's iteration inside a bracket, bisection where it would leave it.
    fn inverse(&self, x: f64) -> f64 {
        if let Geometry::Plane = self.geometry {
            return x.sqrt();
        }
        if let Geometry::Jander = self.geometry {
            return -(3.0 * (-x.sqrt()).ln_1p()).exp_m1();
        }
        let (mut low, mut high) = (0.0, 1.0);
        // The start of all of them is a square root.
        let mut a = (x / self.end()).sqrt();
        for _ in 0..200 {
            let [g, slope, _] = self.integral(a);
            if g > x {
                high = a;
            } else {
                low = a;
            }
            let next = a - (g - x) / slope;
            let next = match next > low && next < high {
                true => next,
                false => 0.5 * (low + high),
            };
            if (next - a).abs() <= EXACT * next {
                return next;
            }
            a = next;
        }
        a
    }
}

impl KineticLaw for ProductDiffusion {
    fn name(&self) -> &'static str {
        self.name
    }

    fn at(&self, x: f64) -> [f64; 3] {
        if x >= self.end() {
            return [1.0, 0.0, 0.0];
        }
        if x == 0.0 {
            return [0.0; 3];
        }
        let a = self.inverse(x);
        if a >= 1.0 {
            return [1.0, 0.0, 0.0];
        }
        let [_, slope, bend] = self.integral(a);
        [a, 1.0 / slope, -bend / slope.powi(3)]
    }

    fn reduced_time(&self, conversion: f64) -> f64 {
        self.integral(conversion)[0]
    }
}

macro_rules! diffusion {
    ($entry:ident, $name:literal, $geometry:ident, $summary:literal) => {
        #[doc = concat!("`", $name, "`: ", $summary)]
        pub static $entry: LawEntry<dyn KineticLaw> = LawEntry {
            name: $name,
            summary: $summary,
            source: "Khawam and Flanagan, J. Phys. Chem. B 110 (2006) 17315, doi 10.1021/jp062746a",
            parameters: &[],
            tables: &[],
            make: |_| {
                Box::new(ProductDiffusion {
                    name: $name,
                    geometry: Geometry::$geometry,
                })
            },
        };
    };
}

diffusion!(
    DIFFUSION_1,
    "D1",
    Plane,
    "Diffusion in one direction: g = a^2."
);
diffusion!(
    DIFFUSION_2,
    "D2",
    Cylinder,
    "Diffusion in a cylinder: g = (1 - a) ln(1 - a) + a."
);
diffusion!(
    DIFFUSION_3,
    "D3",
    Jander,
    "Diffusion in a sphere after Jander: g = [1 - (1 - a)^(1/3)]^2."
);
diffusion!(
    DIFFUSION_4,
    "D4",
    GinstlingBrounshtein,
    "Diffusion in a sphere after Ginstling and Brounshtein: g = 1 - 2a/3 - (1 - a)^(2/3)."
);

#[cfg(test)]
mod tests {
    use crate::law::default_law;

    #[test]
    fn integral_forms_agree_with_independent_evaluations() {
        // At α = 0.488: (1 − α)^⅓ = 0.8. D2: 0.512 ln 0.512 + 0.488.
        let x = |name: &str| default_law(name).unwrap().reduced_time(0.488);
        assert!((x("D1") - 0.238_144).abs() < 1e-12);
        assert!(
            (x("D2") - 0.145_251_505_181_373_8).abs() < 1e-14,
            "{}",
            x("D2")
        );
        assert!((x("D3") - 0.04).abs() < 1e-14);
        assert!((x("D4") - (1.0 - 0.976 / 3.0 - 0.64)).abs() < 1e-14);
    }

    #[test]
    fn series_and_closed_forms_meet() {
        for name in ["D2", "D4"] {
            let law = default_law(name).unwrap();
            let (below, above) = (
                law.reduced_time(0.000_999_999),
                law.reduced_time(0.001_000_001),
            );
            assert!((above / below - 1.0 - 4e-6).abs() < 1e-7, "{name}");
        }
    }
}
