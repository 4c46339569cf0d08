//! The surface of grains that gives off a gas below its equilibrium pressure.

/// r = k S (p_eq − p) in mol/s, with the surface S = 6 V₀ w^2/3/d of spherical grains that shrink, V₀ the volume of the solid
/// itself at the start.
///
/// Source: the surface decomposition of CaCO3 of Borgwardt, AIChE J. 31 (1985) 103, doi 10.1002/aic.690310112, with the pressure that
/// lacks, as Silcox, Kramlich and Pershing, Ind. Eng. Chem. Res. 28 (1989) 155, doi 10.1021/ie00086a005, have it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrainSurface {
    /// Diameter d of the grains at the start in m.
    pub diameter: f64,
}

impl GrainSurface {
    /// The surface in m² of grains of a volume in m³ at the start, of which nothing has reacted.
    pub fn at_start(&self, volume: f64) -> f64 {
        6.0 * volume / self.diameter
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_has_its_own_surface() {
        let ball = GrainSurface { diameter: 2.0 };
        let pi = std::f64::consts::PI;
        assert!((ball.at_start(4.0 / 3.0 * pi) - 4.0 * pi).abs() < 1e-14);
    }
}
