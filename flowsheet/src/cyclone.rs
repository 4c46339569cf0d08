//! Muschelknautz' model of gas cyclones.

use std::f64::consts::PI;

use crate::PlantError;

/// A cyclone with a rectangular slot, by Muschelknautz' model with separation at its entry beyond the gas' load limit, in the
/// main and in the secondary stream.
///
/// With the load μ = ṁ_s/ṁ_g, friction λ = λ₀ (1 + 2 √μ) (3 in place of 2 above μ = 1), contraction α, tangential speeds
/// u_o at the wall, u_f at the vortex finder, the cut size of the inner vortex is
///
/// d* = √(18 η 0.9 V̇/((ρ_s − ρ_g) u_f² 2π h_sep)),
///
/// a size d is separated there by η(d/d*) = ½ (1 + cos(π/2 (1 − ln(d/d*)/ln D))) between 1/D and D, and above the load limit
/// μ_lim = K (d*_e/d₅₀) (10 μ)^k a share 1 − μ_lim/μ of all sizes falls out at the entry. A secondary stream along the lid
/// has a share of the gas that follows from the vortex' exponent.
///
/// Sources: Muschelknautz and Trefz, Pressure drop and separation efficiency in cyclones, in VDI Heat Atlas, 2nd ed.
/// (2010), part L; as the unit "Cyclone Muschelknautz" of Dyssol (SoftwareX 12 (2020) 100572, doi 10.1016/j.softx.2020.100572).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MuschelknautzCyclone {
    /// Diameter in m.
    pub diameter: f64,
    /// Height in m, and of its cylindrical part.
    pub height: f64,
    /// Height of the cylindrical part in m.
    pub cylinder_height: f64,
    /// Diameter of the vortex finder in m.
    pub finder_diameter: f64,
    /// Depth of the vortex finder in m.
    pub finder_depth: f64,
    /// Diameter of the exit of particles in m.
    pub exit_diameter: f64,
    /// Width of the slot in m.
    pub slot_width: f64,
    /// Height of the slot in m.
    pub slot_height: f64,
    /// Wall friction coefficient λ₀ of pure gas.
    pub wall_friction: f64,
    /// Width D of the separation curve: 2 for long thin cyclones to 4 for wide squat ones.
    pub curve_width: f64,
    /// Constant K of the load limit: 0.02 for fine particles to 0.03 for coarse ones.
    pub load_constant: f64,
}

/// What flows into a cyclone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycloneFlow {
    /// Gas in m³/s.
    pub gas: f64,
    /// Density of the gas in kg/m³.
    pub gas_density: f64,
    /// Viscosity of the gas in Pa s.
    pub viscosity: f64,
    /// Density of particles in kg/m³.
    pub solid_density: f64,
    /// Solids in kg per kg of gas.
    pub load: f64,
    /// Median diameter by mass in m.
    pub median: f64,
}

/// What a cyclone does with a flow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycloneState {
    width: f64,
    /// Share of the gas in the main stream.
    pub main_share: f64,
    /// Cut sizes in m of the inner vortex, and of the secondary stream at the vortex finder.
    pub cuts: [f64; 2],
    /// Shares of all sizes that fall out at the entry, of both streams.
    pub falls: [f64; 2],
}

impl MuschelknautzCyclone {
    /// Refuses what is no cyclone.
    pub fn check(&self, place: &str) -> Result<(), PlantError> {
        let above = "it is above zero";
        for (quantity, value, allowed) in [
            ("vortex finder's depth", self.finder_depth, above),
            ("diameter of the vortex finder", self.finder_diameter, above),
            ("diameter of the exit", self.exit_diameter, above),
            ("width of the slot", self.slot_width, above),
            ("height of the slot", self.slot_height, above),
            ("height of the cylinder", self.cylinder_height, above),
            (
                "height of the cone",
                self.height - self.cylinder_height,
                above,
            ),
            (
                "gap beside the vortex finder",
                self.diameter - self.finder_diameter,
                above,
            ),
            (
                "gap beside the exit",
                self.diameter - self.exit_diameter,
                above,
            ),
            (
                "room beside the slot",
                0.5 * self.diameter - self.slot_width,
                above,
            ),
            (
                "height below the vortex finder",
                self.height - self.finder_depth,
                above,
            ),
            ("wall friction", self.wall_friction, above),
            ("width of the curve less 1", self.curve_width - 1.0, above),
            ("constant of the load", self.load_constant, above),
        ] {
            if !(value.is_finite() && value > 0.0) {
                let place = place.to_owned();
                return Err(PlantError::Value {
                    place,
                    quantity,
                    value,
                    allowed,
                });
            }
        }
        Ok(())
    }

    /// What it does with a flow of gas that carries solids.
    pub fn state(&self, flow: &CycloneFlow) -> CycloneState {
        let (r_o, r_f, r_exit) = (
            0.5 * self.diameter,
            0.5 * self.finder_diameter,
            0.5 * self.exit_diameter,
        );
        let (b, h_e, v) = (self.slot_width, self.slot_height, flow.gas);
        let r_cone = 0.5 * (r_exit + r_o);
        let r_exit_eff = r_exit.max(r_f);
        let h_cone = self.height - self.cylinder_height;
        let h_cone_eff = (r_o - r_exit_eff) / (r_o - r_exit) * h_cone;
        let h_sep = self.cylinder_height + h_cone_eff - self.finder_depth;
        // Areas of friction: in all, down to the middle of the cone, on the first half of the entry.
        let cylinder = 2.0 * PI * r_o * self.cylinder_height;
        let cone = PI * (r_o + r_exit_eff) * (r_o - r_exit_eff).hypot(h_cone_eff);
        let lid = PI * (r_o * r_o - r_f * r_f);
        let all = cylinder + cone + 2.0 * PI * r_f * self.finder_depth + lid;
        let upper = cylinder + PI * (r_o + r_cone) * (r_o - r_cone).hypot(0.5 * h_cone);
        let entry = PI * r_o * h_e;
        let mu = flow.load;
        let lambda = self.wall_friction * (1.0 + if mu <= 1.0 { 2.0 } else { 3.0 } * mu.sqrt());
        let beta = b / r_o;
        let inner = 1.0 - (1.0 - beta * beta) / (1.0 + mu) * (2.0 * beta - beta * beta);
        let under = 1.0 + 4.0 * ((0.5 * beta).powi(2) - 0.5 * beta) * inner.sqrt();
        let alpha = (1.0 - under.sqrt()) / beta;
        let (r_e, r_mean) = (r_o - 0.5 * b, r_o - 0.5 * alpha * b);
        let r_z = (r_mean * r_cone).sqrt();
        let u_o = v / (h_e * b) * r_e / (r_o * alpha);
        // The speed at a radius after friction on an area, by a share of the gas.
        let speed = |r: f64, area: f64, share: f64| {
            let friction = 0.5 * lambda * area / (share * v) * u_o * (r_o / r).sqrt();
            u_o * (r_o / r) / (1.0 + friction)
        };
        let (u_f, u_e) = (speed(r_f, all, 1.0), speed(r_mean, entry, 0.9));
        let u_cone = speed(r_cone, upper, 0.9);
        let n = (u_f / u_o).ln() / (r_o / r_f).ln();
        let secondary = 0.0497 + 0.0684 * n + 0.0949 * n * n;
        let density = flow.solid_density - flow.gas_density;
        let cut = |gas: f64, u: f64, h: f64| {
            (18.0 * flow.viscosity * gas / (density * u * u * 2.0 * PI * h)).sqrt()
        };
        let sinking = 0.5 * 0.9 * v / upper;
        let pull = u_e * u_cone / r_z;
        let entry_cut = (sinking * 18.0 * flow.viscosity / (density * pull)).sqrt();
        let power = load_power(mu);
        let limit = self.load_constant * entry_cut / flow.median * (10.0 * mu).powf(power);
        let falls = |limit: f64| (1.0 - limit / mu).max(0.0);
        CycloneState {
            width: self.curve_width,
            main_share: 1.0 - secondary,
            cuts: [
                cut(0.9 * v, u_f, h_sep),
                cut(secondary * v, 2.0 / 3.0 * u_f, self.finder_depth),
            ],
            falls: [falls(limit), falls(6.0 * limit)],
        }
    }
}

/// k of the load limit.
fn load_power(mu: f64) -> f64 {
    let (low, middle, high) = (2.2e-5, 0.015, 0.1);
    if mu < low {
        0.81
    } else if mu < middle {
        0.15 + 0.66 * (-((mu - low) / (middle - low)).powf(0.6)).exp()
    } else if mu < high {
        let bend = ((high - middle) / (high - mu)).powf(0.1);
        0.15 + 0.66 * (-bend * (mu / middle).powf(0.6)).exp()
    } else {
        0.15
    }
}

impl CycloneState {
    /// Share of a diameter in m that is separated.
    pub fn separated(&self, d: f64) -> f64 {
        // The secondary stream has a curve of width 3.
        let curve = |d_star: f64, width: f64| {
            let ratio = d / d_star;
            if ratio <= 1.0 / width {
                0.0
            } else if ratio >= width {
                1.0
            } else {
                0.5 * (1.0 + (0.5 * PI * (1.0 - ratio.ln() / width.ln())).cos())
            }
        };
        let of = |fall: f64, curve: f64| fall + (1.0 - fall) * curve;
        let main = of(self.falls[0], curve(self.cuts[0], self.width));
        let other = of(self.falls[1], curve(self.cuts[1], 3.0));
        self.main_share * main + (1.0 - self.main_share) * other
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CYCLONE: MuschelknautzCyclone = MuschelknautzCyclone {
        diameter: 5.0,
        height: 8.0,
        cylinder_height: 3.0,
        finder_diameter: 1.7,
        finder_depth: 2.25,
        exit_diameter: 1.5,
        slot_width: 1.0,
        slot_height: 2.25,
        wall_friction: 0.01,
        curve_width: 3.0,
        load_constant: 0.025,
    };

    /// Dyssol's test `Unit_Cyclone_Muschelknautz`: shares of the main stream at loads of 1, 7/3 and 9.
    #[test]
    fn the_main_stream_has_dyssols_share() {
        for (load, gas, expected) in [
            (1.0, 5.0, 0.935_743),
            (7.0 / 3.0, 3.0, 0.958_488),
            (9.0, 1.0, 0.960_588),
        ] {
            let flow = CycloneFlow {
                gas: gas / 1.16,
                gas_density: 1.16,
                viscosity: 1.85e-5,
                solid_density: 2650.0,
                load,
                median: 5e-4,
            };
            let found = CYCLONE.state(&flow).main_share;
            assert!(
                (found - expected).abs() < 2e-6,
                "{load}: {found} {expected}"
            );
        }
        CYCLONE.check("test").unwrap();
    }

    #[test]
    fn coarse_particles_are_separated_and_the_finest_by_load_alone() {
        let flow = |load| CycloneFlow {
            gas: 4.0,
            gas_density: 1.16,
            viscosity: 1.85e-5,
            solid_density: 2650.0,
            load,
            median: 5e-4,
        };
        let heavy = CYCLONE.state(&flow(1.0));
        assert_eq!(heavy.separated(1e-2), 1.0);
        let [main, other] = heavy.falls;
        let expected = heavy.main_share * main + (1.0 - heavy.main_share) * other;
        assert!((heavy.separated(1e-9) - expected).abs() < 1e-15 && main > 0.9);
        // So fine that the gas carries it all.
        let light = CYCLONE.state(&CycloneFlow {
            median: 5e-6,
            ..flow(1e-6)
        });
        assert_eq!(light.falls, [0.0, 0.0]);
        assert_eq!(light.separated(1e-9), 0.0);
        // One half at the cut size of the main stream; the secondary one cuts near it.
        let at = light.separated(light.cuts[0]);
        assert!((at - 0.5).abs() < 0.1, "{at}");
    }

    #[test]
    fn the_power_of_the_load_is_continuous() {
        for place in [2.2e-5, 0.015, 0.1] {
            let (below, above) = (load_power(place * (1.0 - 1e-9)), load_power(place));
            assert!((below - above).abs() < 2e-3, "{place}: {below} {above}");
        }
    }
}
