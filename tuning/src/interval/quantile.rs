/// Quantile of the standard normal distribution for a probability between zero and one, to 1.2e-9.
///
/// Source: Acklam's rational approximations (2003), see Wichura, Appl. Stat. 37 (1988) 477, doi 10.2307/2347330, for a
/// comparison of such.
pub fn normal_quantile(probability: f64) -> f64 {
    const A: [f64; 6] = [
        -3.969_683_028_665_376e1,
        2.209_460_984_245_205e2,
        -2.759_285_104_469_687e2,
        1.383_577_518_672_69e2,
        -3.066_479_806_614_716e1,
        2.506_628_277_459_239,
    ];
    const B: [f64; 6] = [
        -5.447_609_879_822_406e1,
        1.615_858_368_580_409e2,
        -1.556_989_798_598_866e2,
        6.680_131_188_771_972e1,
        -1.328_068_155_288_572e1,
        1.0,
    ];
    const C: [f64; 6] = [
        -7.784_894_002_430_293e-3,
        -3.223_964_580_411_365e-1,
        -2.400_758_277_161_838,
        -2.549_732_539_343_734,
        4.374_664_141_464_968,
        2.938_163_982_698_783,
    ];
    const D: [f64; 5] = [
        7.784_695_709_041_462e-3,
        3.224_671_290_700_398e-1,
        2.445_134_137_142_996,
        3.754_408_661_907_416,
        1.0,
    ];
    /// Below it and above one less it the tails begin.
    const TAIL: f64 = 0.02425;
    let row = |coefficients: &[f64], x: f64| coefficients.iter().fold(0.0, |sum, c| sum * x + c);
    if probability < TAIL {
        let q = (-2.0 * probability.ln()).sqrt();
        row(&C, q) / row(&D, q)
    } else if probability > 1.0 - TAIL {
        -normal_quantile(1.0 - probability)
    } else {
        let q = probability - 0.5;
        q * row(&A, q * q) / row(&B, q * q)
    }
}

/// Quantile of Student's distribution, by the expansion of Cornish and Fisher to the third order: to 3e-3 at five degrees of
/// freedom, 2e-4 from ten on (Abramowitz and Stegun 26.7.5).
pub fn student_quantile(probability: f64, freedom: f64) -> f64 {
    let z = normal_quantile(probability);
    let (z2, z3) = (z * z, z * z * z);
    let first = (z3 + z) / 4.0;
    let second = (5.0 * z2 * z3 + 16.0 * z3 + 3.0 * z) / 96.0;
    let third = (3.0 * z2 * z2 * z3 + 19.0 * z2 * z3 + 17.0 * z3 - 15.0 * z) / 384.0;
    z + first / freedom + second / freedom.powi(2) + third / freedom.powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_tables() {
        for (probability, expected) in [
            (0.5, 0.0),
            (0.975, 1.959_963_985),
            (0.01, -2.326_347_874),
            (0.995, 2.575_829_304),
        ] {
            assert!((normal_quantile(probability) - expected).abs() < 1e-8);
        }
        // 97.5 % of Student's distribution with 5, 10 and 100 degrees of freedom.
        for (freedom, expected, within) in [
            (5.0, 2.5706, 3e-3),
            (10.0, 2.2281, 2e-4),
            (100.0, 1.9840, 1e-4),
        ] {
            let found = student_quantile(0.975, freedom);
            assert!((found - expected).abs() < within, "{freedom}: {found}");
        }
    }
}
