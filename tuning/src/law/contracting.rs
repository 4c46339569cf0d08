use calcine_physics::law::LawEntry;

use super::conversion::KineticLaw;

/// A front that moves at a constant speed through a disc or cylinder (n = 2, `R2`) or a sphere (n = 3, `R3`):
/// α = 1 − (1 − x)^n up to x = 1, f = n (1 − α)^(1 − 1/n).
///
/// Source: Khawam and Flanagan, J. Phys. Chem. B 110 (2006) 17315, doi 10.1021/jp062746a, table 1. As in most fits of
/// thermogravimetry the factor n belongs to f, so that k is the speed of the front over the radius.
#[derive(Clone, Copy, Debug)]
struct ContractingBody {
    name: &'static str,
    dimensions: i32,
}

impl KineticLaw for ContractingBody {
    fn name(&self) -> &'static str {
        self.name
    }

    fn at(&self, x: f64) -> [f64; 3] {
        let (n, left) = (self.dimensions, 1.0 - x);
        if left <= 0.0 {
            return [1.0, 0.0, 0.0];
        }
        let count = f64::from(n);
        [
            // 1 − (1 − x)^n without the loss of digits at small x.
            -(count * (-x).ln_1p()).exp_m1(),
            count * left.powi(n - 1),
            -count * (count - 1.0) * left.powi(n - 2),
        ]
    }

    fn reduced_time(&self, conversion: f64) -> f64 {
        -((-conversion).ln_1p() / f64::from(self.dimensions)).exp_m1()
    }
}

/// Contracting area, `R2`.
pub static CONTRACTING_AREA: LawEntry<dyn KineticLaw> = LawEntry {
    name: "R2",
    summary: "Contracting area: f = 2 (1 - a)^(1/2).",
    source: "Khawam and Flanagan, J. Phys. Chem. B 110 (2006) 17315, doi 10.1021/jp062746a",
    parameters: &[],
    tables: &[],
    make: |_| {
        Box::new(ContractingBody {
            name: "R2",
            dimensions: 2,
        })
    },
};

/// Contracting volume, `R3`.
pub static CONTRACTING_VOLUME: LawEntry<dyn KineticLaw> = LawEntry {
    name: "R3",
    summary: "Contracting volume: f = 3 (1 - a)^(2/3).",
    source: "Khawam and Flanagan, J. Phys. Chem. B 110 (2006) 17315, doi 10.1021/jp062746a",
    parameters: &[],
    tables: &[],
    make: |_| {
        Box::new(ContractingBody {
            name: "R3",
            dimensions: 3,
        })
    },
};

#[cfg(test)]
mod tests {
    use crate::law::default_law;

    #[test]
    fn agrees_with_independent_evaluations() {
        let at = |name: &str, x: f64| default_law(name).unwrap().at(x);
        // 1 − 0.7² and 2·0.7; 1 − 0.7³ and 3·0.49.
        let (area, volume) = (at("R2", 0.3), at("R3", 0.3));
        assert!((area[0] - 0.51).abs() < 1e-15 && (area[1] - 1.4).abs() < 1e-15);
        assert!((volume[0] - 0.657).abs() < 1e-15 && (volume[1] - 1.47).abs() < 1e-15);
        // f(α) as tables have it: 2 (1 − α)^(1/2), 3 (1 − α)^(2/3).
        assert!((area[1] - 2.0 * 0.49f64.sqrt()).abs() < 1e-14);
        assert!((volume[1] - 3.0 * 0.343f64.powf(2.0 / 3.0)).abs() < 1e-14);
    }
}
