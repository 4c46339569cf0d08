//! How deep the hardest impact presses the particles of a case.

use calcine_coupler::motion::{ContactForce, Elastic};
use calcine_coupler::part::DEEP_CONTACT;
use calcine_coupler::physics::contact::time_step;
use calcine_coupler::physics::sphere;
use calcine_coupler::setup::ParticleSetup;

use super::model::{Case, FreeMotion};
use super::moving::{MovingSpheres, moving_spheres};

/// The hardest impacts of a case, over the radius of the smaller particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Impacts {
    /// Of two particles that meet in flight.
    pub free: f64,
    /// Of a particle that lies on a wall, or on others, under one that falls on it.
    pub lying: f64,
    /// Speed in m/s.
    pub speed: f64,
}

/// The largest overlap by the force of the case of any two populations that move, smallest particle against largest, at
/// a speed in m/s; `None` where nothing that moves has elastic constants.
pub(super) fn hardest(
    case: &Case,
    motion: &FreeMotion,
    setup: &ParticleSetup,
    speed: f64,
) -> Option<Impacts> {
    let moving: Vec<MovingSpheres> = moving_spheres(case, setup).collect();
    let pairs = moving
        .iter()
        .flat_map(|one| moving.iter().map(move |other| (one, other)));
    let overlaps = pairs.map(|(one, other)| {
        let [small, large] = [one.radius[0], other.radius[1]];
        let [light, heavy] =
            [(small, one), (large, other)].map(|(radius, of)| sphere::mass(radius, of.density));
        let compliance = |Elastic { young, poisson }: Elastic| (1.0 - poisson * poisson) / young;
        let pair = ImpactPair {
            radius: small * large / (small + large),
            mass: light * heavy / (light + heavy),
            young: 1.0 / (compliance(one.elastic) + compliance(other.elastic)),
        };
        [pair.mass, heavy].map(|mass| pair.overlap(motion.law.force, mass, speed) / small)
    });
    let [free, lying] = overlaps.reduce(|all, one| [all[0].max(one[0]), all[1].max(one[1])])?;
    Some(Impacts { free, lying, speed })
}

/// Two spheres that meet: effective radius in m, mass in kg and Young's modulus in Pa.
struct ImpactPair {
    radius: f64,
    mass: f64,
    young: f64,
}

impl ImpactPair {
    /// Overlap in m where a mass in kg comes with a speed in m/s: by the law of Hertz, or by the linear spring that overlaps
    /// as much at its characteristic speed, δ = v √(m/k).
    fn overlap(&self, force: ContactForce, mass: f64, speed: f64) -> f64 {
        let hertz = |mass, speed| time_step::hertz_overlap(self.radius, mass, self.young, speed);
        match force {
            ContactForce::Linear {
                characteristic_speed,
            } => {
                let there = hertz(self.mass, characteristic_speed);
                there * speed / characteristic_speed * (mass / self.mass).sqrt()
            }
            ContactForce::LinearSprings { stiffness, .. } => speed * (mass / stiffness).sqrt(),
            ContactForce::HertzMindlin
            | ContactForce::SpringSliderDashpot
            | ContactForce::OpenfoamSpringSliderDashpot => hertz(mass, speed),
        }
    }
}

impl Impacts {
    /// Lines of `check`.
    pub(super) fn lines(&self) -> String {
        let [free, lying] = [self.free, self.lying].map(|share| 100.0 * share);
        format!(
            "    largest overlap at {:.3} m/s: {free:.1} % of the smaller radius, smallest against largest particle; {lying:.1} % where \
             the smallest lies on a wall; a run tells of more than {:.0} %\n",
            self.speed,
            100.0 * DEEP_CONTACT
        )
    }

    /// What is to be warned of.
    pub(super) fn warning(&self) -> Option<String> {
        (self.lying > 1.0).then(|| {
            "the largest particle can press the smallest through a wall, or through another; raise `young` of their material, or \
             check the speed and the sizes"
                .to_owned()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(set: &[&str], speed: f64) -> Impacts {
        let path =
            std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/moving.toml");
        let set: Vec<String> = set.iter().map(|one| (*one).to_owned()).collect();
        let case = crate::case::read(&path, &set).unwrap();
        let setup = crate::case::particles(&case, &Default::default())
            .unwrap()
            .setup;
        let motion = case.motion.clone().unwrap();
        hardest(&case, &motion, &setup, speed).unwrap()
    }

    /// Glass of 2500 kg/m³, 5 GPa, 0.25 and a radius of 1 mm, evaluated apart: (15 m v²/(16 E* √R*))^0.4 with
    /// R* = 0.5 mm and E* = 2.666667 GPa.
    #[test]
    fn the_overlaps_are_those_of_hertz() {
        let found = of(&[], 1.0);
        // m* = 5.235988e-6 kg, at the characteristic speed; twice the mass on the same spring, or by Hertz' law.
        assert!((found.free / 5.837_225e-3 - 1.0).abs() < 1e-6, "{found:?}");
        let hertz = r#"motion.contact={ law = "hertz-mindlin" }"#;
        for (set, lying, faster) in [
            (&[][..], 2f64.sqrt(), 32.0),
            (&[hertz][..], 2f64.powf(0.4), 16.0),
        ] {
            let one = of(set, 1.0);
            assert!(
                (one.lying / one.free / lying - 1.0).abs() < 1e-12,
                "{one:?}"
            );
            let ratio = of(set, 32.0).free / one.free;
            assert!((ratio / faster - 1.0).abs() < 1e-12, "{ratio}");
        }
    }

    #[test]
    fn what_may_be_pressed_through_a_wall_is_warned_of() {
        assert_eq!(of(&[], 1.0).warning(), None);
        let through = Impacts {
            free: 0.3,
            lying: 1.001,
            speed: 1.0,
        };
        assert!(through.warning().unwrap().contains("through a wall"));
        let pressed = Impacts {
            lying: 0.999,
            ..through
        };
        assert_eq!(pressed.warning(), None);
    }
}
