//! The eight impacts of Chung and Ooi 2011 (Granular Matter 13, 643, doi 10.1007/s10035-011-0277-0): normal,
//! damped, oblique and spinning ones of a sphere on a plane and of two spheres.
//!
//! What is exact: Hertz' depth, force and duration; the restitution; the impulse μ (1 + e) m* V of a contact
//! that slides all the time, where nothing damps it (the law's tangential dashpot is not limited by friction: at
//! e = 0.5 it adds up to a tenth); a contact that sticks to a linear spring. In between, the equations of one
//! contact are integrated apart (`apart` below).
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::f64::consts::PI;

use calcine_coupler::motion::{ContactForce, Contacts, Rolling};
use calcine_coupler::part::DEEP_CONTACT;
use calcine_coupler::physics::Vec3;

use crate::grains::*;

/// A material: Young's modulus in Pa, Poisson's ratio, density in kg/m³.
#[derive(Clone, Copy)]
struct CellProperties {
    young: f64,
    poisson: f64,
    density: f64,
}

/// The paper's materials.
const GLASS: CellProperties = CellProperties {
    young: 4.8e10,
    poisson: 0.2,
    density: 2800.0,
};
const LIMESTONE: CellProperties = CellProperties {
    young: 2.5e10,
    poisson: 0.2,
    density: 2500.0,
};
const ALUMINIUM_OXIDE: CellProperties = CellProperties {
    young: 3.8e11,
    poisson: 0.23,
    density: 4000.0,
};
const STEEL: CellProperties = CellProperties {
    young: 2.08e11,
    poisson: 0.3,
    density: 7850.0,
};
const ALUMINIUM_ALLOY: CellProperties = CellProperties {
    young: 7e10,
    poisson: 0.33,
    density: 2700.0,
};

impl CellProperties {
    /// E/(2 (1 − ν²)) and E/(4 (1 + ν)(2 − ν)), of two bodies of this material, in Pa.
    fn moduli(&self) -> [f64; 2] {
        let nu = self.poisson;
        [
            self.young / (2.0 * (1.0 - nu * nu)),
            self.young / (4.0 * (1.0 + nu) * (2.0 - nu)),
        ]
    }

    fn mass(&self, radius: f64) -> f64 {
        4.0 / 3.0 * PI * radius.powi(3) * self.density
    }
}

/// An impact: a sphere on a plane, or on a second sphere.
#[derive(Clone, Copy)]
struct Impact {
    material: CellProperties,
    radius: f64,
    /// Radius in m of the sphere that it meets; none for a plane.
    other: Option<f64>,
    restitution: f64,
    friction: f64,
    /// Speed of approach in m/s.
    normal: f64,
    /// Speed of the surfaces past each other in m/s.
    slip: f64,
    force: ContactForce,
}

impl Impact {
    /// Effective radius in m and mass in kg.
    fn effective(&self) -> (f64, f64) {
        let mass = self.material.mass(self.radius);
        self.other.map_or((self.radius, mass), |other| {
            let second = self.material.mass(other);
            (
                self.radius * other / (self.radius + other),
                mass * second / (mass + second),
            )
        })
    }

    /// Duration in s of the elastic impact: 2.943 275 δ_max/V (Landau and Lifshitz, § 9, problem 1).
    fn duration(&self) -> f64 {
        2.943_275_18 * self.depth() / self.normal
    }

    /// Deepest overlap in m of the elastic impact, by ½ m* V² = 8/15 E* √R* δ^2.5.
    fn depth(&self) -> f64 {
        let (radius, mass) = self.effective();
        let [young, _] = self.material.moduli();
        (15.0 * mass * self.normal.powi(2) / (16.0 * young * radius.sqrt())).powf(0.4)
    }

    /// The impulse in N s that friction exchanges where the contact slides from first to last.
    fn sliding_impulse(&self) -> f64 {
        self.friction * (1.0 + self.restitution) * self.effective().1 * self.normal
    }

    fn contacts(&self, steps: f64) -> Contacts {
        let mut contacts = contacts(self.duration() / steps);
        contacts.materials[0].young = self.material.young;
        contacts.materials[0].poisson = self.material.poisson;
        contacts.pairs[0].restitution = self.restitution;
        contacts.pairs[0].friction = self.friction;
        contacts.law.force = self.force;
        if self.other.is_none() {
            contacts.walls = vec![plane(Vec3::zeros(), Vec3::z())];
        }
        contacts
    }

    /// The native solver after the impact, with the slip as a velocity along x of the first sphere or as its
    /// rotation; speeds and rotations of both spheres.
    fn native(&self, spins: bool) -> Vec<(Vec3, Vec3)> {
        let steps = 10_000.0;
        let contacts = self.contacts(steps);
        let along = if spins { 0.0 } else { self.slip };
        let mut first = sphere(1, Vec3::z() * self.radius, Vec3::zeros(), self.radius);
        let mut spheres = Vec::new();
        match self.other {
            None => first.velocity = Vec3::new(along, 0.0, -self.normal),
            Some(other) => {
                first.velocity = Vec3::new(along, 0.0, -0.5 * self.normal);
                let second = Vec3::z() * (0.5 * self.normal);
                spheres.push(sphere(2, Vec3::z() * -other, second, other));
            }
        }
        spheres.insert(0, first);
        for sphere in &mut spheres {
            sphere.density = self.material.density;
        }
        let mut bed = Bed::new(contacts, &spheres);
        if spins {
            // The surface below goes by with −ω R along x: ω about −y.
            bed = bed.spun(0, Vec3::y() * (-self.slip / self.radius));
        }
        bed.run((3.0 * steps) as u64);
        (0..spheres.len())
            .map(|row| (bed.velocity(row), bed.spin(row)))
            .collect()
    }

    /// The tangential impulse in N s that the first sphere loses, by native: of its motion and of its rotation.
    fn native_impulse(&self, spins: bool) -> [f64; 2] {
        let after = self.native(spins)[0];
        let mass = self.material.mass(self.radius);
        let (before, turned) = match spins {
            true => (0.0, -self.slip / self.radius),
            false => (self.slip, 0.0),
        };
        [
            mass * (before - after.0.x),
            0.4 * mass * self.radius * (after.1.y - turned),
        ]
    }
}

/// What an impact exchanges, integrated apart, with the line of centres where it stays: the overlap, the velocity
/// along the surface and both rotations, m* δ'' = −F_n, m* v' = −F_t, I ω' = a F_t with the arms a = R − δ/2.
/// Leapfrog in 40 000 steps; the laws in their papers' letters (docs/theory.md, COR-12). Gives the tangential
/// impulse in N s and what of it turns the first sphere: the angular impulse over its radius.
fn apart(impact: &Impact) -> [f64; 2] {
    let (radius, mass) = impact.effective();
    let [young, shear] = impact.material.moduli();
    let log = impact.restitution.ln();
    let beta = -log / (log * log + PI * PI).sqrt();
    let damping = |stiffness: f64| 2.0 * (5.0f64 / 6.0).sqrt() * beta * (stiffness * mass).sqrt();
    let step = impact.duration() / 40_000.0;
    let inertia = |radius: f64| 0.4 * impact.material.mass(radius) * radius * radius;
    let spheres = [Some(impact.radius), impact.other].map(|one| one.map(|r| (r, inertia(r))));
    let (mut overlap, mut speed) = (0.0f64, impact.normal);
    let (mut along, mut spins) = (impact.slip, [0.0; 2]);
    let (mut spring, mut impulses) = (0.0f64, [0.0; 2]);
    for _ in 0..160_000 {
        overlap += 0.5 * step * speed;
        if overlap < 0.0 {
            break;
        }
        let normal_stiffness = 2.0 * young * (radius * overlap).sqrt();
        let tangential_stiffness = 8.0 * shear * (radius * overlap).sqrt();
        let elastic = 4.0 / 3.0 * young * radius.sqrt() * overlap.powf(1.5);
        let push = elastic + damping(normal_stiffness) * speed;
        let arms = spheres.map(|one| one.map_or(0.0, |(radius, _)| radius - 0.5 * overlap));
        let slip = along - arms[0] * spins[0] - arms[1] * spins[1];
        spring += step * slip;
        let most = impact.friction * push.abs();
        let mut force = tangential_stiffness * spring;
        if force.abs() > most {
            force = most * force.signum();
            spring = force / tangential_stiffness;
        } else {
            force += damping(tangential_stiffness) * slip;
        }
        speed -= step * push / mass;
        along -= step * force / mass;
        for ((spin, arm), one) in spins.iter_mut().zip(arms).zip(spheres) {
            *spin += one.map_or(0.0, |(_, inertia)| step * arm * force / inertia);
        }
        impulses[0] += step * force;
        impulses[1] += step * force * arms[0] / impact.radius;
        overlap += 0.5 * step * speed;
    }
    impulses
}

const ON_PLANE: Impact = Impact {
    material: ALUMINIUM_OXIDE,
    radius: 2.5e-3,
    other: None,
    restitution: 0.98,
    friction: 0.092,
    normal: 3.9,
    slip: 0.0,
    force: ContactForce::HertzMindlin,
};

/// Tests 1 and 2: force over time and over overlap, against Hertz.
#[test]
fn elastic_normal_impacts_follow_hertz_force_over_overlap_and_time() {
    for (material, radius, other, normal) in [
        (GLASS, 0.01, Some(0.01), 20.0),
        (LIMESTONE, 0.01, Some(0.01), 20.0),
        (GLASS, 0.1, None, 0.2),
        (LIMESTONE, 0.1, None, 0.2),
    ] {
        let impact = Impact {
            material,
            radius,
            other,
            restitution: 1.0,
            normal,
            ..ON_PLANE
        };
        let steps = 4000.0;
        let mut spheres = vec![sphere(1, Vec3::z() * radius, Vec3::zeros(), radius)];
        match other {
            None => spheres[0].velocity.z = -normal,
            Some(other) => {
                spheres[0].velocity.z = -0.5 * normal;
                let up = Vec3::z() * (0.5 * normal);
                spheres.push(sphere(2, Vec3::z() * -other, up, other));
            }
        }
        for sphere in &mut spheres {
            sphere.density = material.density;
        }
        let contacts = impact.contacts(steps);
        let step = contacts.step;
        let mut bed = Bed::new(contacts, &spheres);
        let (radius_star, _) = impact.effective();
        let [young, _] = material.moduli();
        let mass = material.mass(radius);
        let (mut deepest, mut strongest, mut last) = (0.0f64, 0.0f64, 0);
        let mut worst = 0.0f64;
        for k in 1..=5000 {
            let before = bed.velocity(0).z;
            let overlap = |bed: &Bed| match other {
                None => radius - bed.place(0).z,
                Some(other) => radius + other - (bed.place(0).z - bed.place(1).z),
            };
            let ahead = overlap(&bed);
            bed.run(1);
            // The mean force of a step against the mean of Hertz' at its ends: both of second order.
            let force = mass * (bed.velocity(0).z - before) / step;
            let hertz =
                |overlap: f64| 4.0 / 3.0 * young * radius_star.sqrt() * overlap.max(0.0).powf(1.5);
            worst = worst.max((force - 0.5 * (hertz(ahead) + hertz(overlap(&bed)))).abs());
            deepest = deepest.max(overlap(&bed));
            strongest = strongest.max(force);
            if overlap(&bed) > 0.0 {
                last = k;
            }
        }
        let peak = 4.0 / 3.0 * young * radius_star.sqrt() * impact.depth().powf(1.5);
        assert!((deepest / impact.depth() - 1.0).abs() < 3e-6, "{deepest}");
        assert!((strongest / peak - 1.0).abs() < 3e-6, "{strongest} {peak}");
        assert!(worst < 1e-9 * peak, "{worst} of {peak}");
        assert!((f64::from(last) / steps - 1.0).abs() < 1e-3, "{last}");
    }
}

/// Test 3.
#[test]
fn every_restitution_comes_out_of_a_normal_impact() {
    for k in 1..=20 {
        let restitution = 0.05 * f64::from(k);
        let impact = Impact {
            restitution,
            ..ON_PLANE
        };
        let found = impact.native(false)[0].0.z / impact.normal;
        assert!((found - restitution).abs() < 2e-3, "{restitution}: {found}");
    }
}

/// Test 4: a constant speed of 3.9 m/s at angles from the normal, aluminium oxide as Kharaz, Gorham and
/// Salman 2001 measured it (doi 10.1016/S0032-5910(01)00283-2).
#[test]
fn oblique_impacts_at_a_constant_speed_stick_slip_and_slide_as_the_angle_grows() {
    for degrees in [
        2.0f64, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 85.0,
    ] {
        let angle = degrees.to_radians();
        let impact = Impact {
            normal: 3.9 * angle.cos(),
            slip: 3.9 * angle.sin(),
            ..ON_PLANE
        };
        compare(
            &impact,
            degrees,
            false,
            3.5 * 0.092 * 1.98 < 0.9 * angle.tan(),
        );
    }
}

/// Test 5: a constant normal speed of 5 m/s; elastic spheres of steel and of an aluminium alloy, μ = 0.3.
#[test]
fn oblique_impacts_at_a_constant_normal_speed_stick_slip_and_slide_as_the_slip_grows() {
    for material in [STEEL, ALUMINIUM_ALLOY] {
        for ratio in [0.05, 0.2, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 5.0] {
            let impact = Impact {
                material,
                radius: 1e-5,
                restitution: 1.0,
                friction: 0.3,
                normal: 5.0,
                slip: 5.0 * ratio,
                ..ON_PLANE
            };
            compare(&impact, ratio, false, ratio > 2.4);
        }
    }
}

/// Test 6: a normal speed of 0.2 m/s and a rotation.
#[test]
fn a_spinning_sphere_is_thrown_aside_by_the_plane() {
    for spin in [0.175, 0.5, 1.0, 2.0, 4.0, 6.0, 10.0, 21.0] {
        for (material, restitution) in [(STEEL, 1.0), (ALUMINIUM_ALLOY, 1.0), (STEEL, 0.5)] {
            let impact = Impact {
                material,
                radius: 0.1,
                restitution,
                friction: 0.4,
                normal: 0.2,
                slip: 0.1 * spin,
                ..ON_PLANE
            };
            compare(&impact, spin, true, restitution == 1.0 && spin > 8.0);
        }
    }
}

/// Tests 7 and 8: two spheres of one size, and of two, one of which spins.
#[test]
fn a_spinning_sphere_turns_the_one_that_it_meets() {
    for (other, restitution) in [(0.1, 1.0), (0.5, 1.0), (0.1, 0.5), (0.5, 0.5)] {
        for spin in [0.175, 1.0, 4.0, 10.0, 20.0] {
            let impact = Impact {
                material: ALUMINIUM_ALLOY,
                radius: 0.1,
                other: Some(other),
                restitution,
                friction: 0.4,
                normal: 0.4,
                slip: 0.1 * spin,
                ..ON_PLANE
            };
            compare(&impact, spin, true, restitution == 1.0 && spin > 15.0);
            let after = impact.native(true);
            let [one, two] = [0.1, other].map(|radius| ALUMINIUM_ALLOY.mass(radius));
            let momentum = one * after[0].0 + two * after[1].0;
            let before = 0.5 * 0.4 * (two - one);
            assert!(momentum.x.abs() < 1e-12 * one, "{momentum}");
            assert!((momentum.z - before).abs() < 1e-12 * two, "{momentum}");
            // Equal and opposite impulses at both radii: the second turns the same way round.
            let turned = 0.4 * two * other * after[1].1.y;
            let pushed = two * after[1].0.x;
            let off = (turned - pushed) / impact.sliding_impulse();
            assert!(off.abs() < 1e-3, "{turned} {pushed}");
        }
    }
}

/// Test 7 with the rotations against each other: the surfaces roll over each other, and nothing turns.
#[test]
fn two_spheres_that_mesh_like_gears_keep_their_rotation() {
    let impact = Impact {
        material: ALUMINIUM_ALLOY,
        radius: 0.1,
        other: Some(0.1),
        restitution: 0.5,
        friction: 0.4,
        normal: 0.4,
        ..ON_PLANE
    };
    let at = |id, z: f64| {
        let mut one = sphere(id, Vec3::z() * z, Vec3::z() * (-2.0 * z), 0.1);
        one.density = ALUMINIUM_ALLOY.density;
        one
    };
    let spheres = [at(1, 0.1), at(2, -0.1)];
    let bed = Bed::new(impact.contacts(2000.0), &spheres);
    let mut bed = bed.spun(0, Vec3::y() * 7.0).spun(1, Vec3::y() * -7.0);
    bed.run(6000);
    assert!((bed.velocity(0).z / 0.1 - 1.0).abs() < 2e-3);
    for (row, spin) in [(0, 7.0), (1, -7.0)] {
        assert!((bed.spin(row).y / spin - 1.0).abs() < 1e-12);
        assert!(bed.velocity(row).x.abs() < 1e-12);
    }
}

/// Sticking to the linear spring, which is as stiff along the surface as across it, the slip swings √(7/2)
/// times as fast as the overlap: it leaves with s cos(π √3.5).
#[test]
fn a_contact_that_sticks_to_a_linear_spring_leaves_with_the_slip_of_the_closed_form() {
    for slip in [0.02, 0.3, 2.0] {
        let impact = Impact {
            restitution: 1.0,
            friction: 1e7,
            slip,
            // So stiff that the arms are radii.
            material: CellProperties {
                young: 1e17,
                ..ALUMINIUM_OXIDE
            },
            force: ContactForce::Linear {
                characteristic_speed: 3.9,
            },
            ..ON_PLANE
        };
        let (velocity, spin) = impact.native(false)[0];
        let left = velocity.x - spin.y * impact.radius;
        let exact = slip * (PI * 3.5f64.sqrt()).cos();
        assert!((left / exact - 1.0).abs() < 2e-3, "{slip}: {left} {exact}");
    }
}

/// The impulses against the separate integration, and that against rigid sliding where the contact slides all the
/// time; slip is a velocity or a rotation.
fn compare(impact: &Impact, at: f64, spins: bool, slides: bool) {
    let scale = impact.sliding_impulse();
    let expected = apart(impact);
    if slides {
        assert!(
            (expected[0] / scale - 1.0).abs() < 3e-3,
            "{at}: {expected:?} {scale}"
        );
    }
    for (found, expected) in impact.native_impulse(spins).into_iter().zip(expected) {
        let off = (found - expected) / scale;
        assert!(off.abs() < 1e-3, "{at}, {spins}: {off}");
    }
}

/// Impacts that press in by 15 % and by 30 % of the smaller radius: of two spheres one by one (with rolling resistance) and in
/// lanes, and of a sphere on a plane.
#[test]
fn an_impact_deeper_than_a_fifth_of_the_smaller_radius_is_told_with_its_depth() {
    for (other, rolls) in [
        (Some(3e-3), false),
        (Some(1e-3), false),
        (Some(3e-3), true),
        (None, false),
    ] {
        for share in [0.15, 0.3] {
            let mut impact = Impact {
                material: GLASS,
                radius: 1e-3,
                other,
                restitution: 1.0,
                friction: 0.0,
                normal: 1.0,
                slip: 0.0,
                force: ContactForce::HertzMindlin,
            };
            // Depth grows with speed to the power 0.8.
            impact.normal = (share * impact.radius / impact.depth()).powf(1.25);
            let mut contacts = impact.contacts(1000.0);
            if rolls {
                contacts.law.rolling = Rolling::ConstantTorque;
            }
            let mut one = sphere(
                1,
                Vec3::z() * impact.radius,
                Vec3::z() * -impact.normal,
                impact.radius,
            );
            one.density = GLASS.density;
            let mut spheres = vec![one];
            if let Some(radius) = other {
                let mut second = sphere(2, Vec3::z() * -radius, Vec3::zeros(), radius);
                second.density = GLASS.density;
                spheres.push(second);
            }
            let mut bed = Bed::new(contacts, &spheres);
            bed.run(1500);
            let found = bed.received.deep_contacts.unwrap();
            if share > DEEP_CONTACT {
                assert_eq!(
                    (found.count, found.place, found.limit),
                    (1, 0, DEEP_CONTACT)
                );
                assert!((found.value / share - 1.0).abs() < 1e-4, "{found:?}");
            } else {
                assert_eq!(found.count, 0, "{found:?}");
            }
            // What was told of one window is not told of the next.
            bed.run(10);
            assert_eq!(bed.received.deep_contacts.unwrap().count, 0);
        }
    }
}
