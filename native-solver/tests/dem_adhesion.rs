//! Contacts that adhere by Johnson, Kendall and Roberts (docs/theory.md, COR-46): the force, where it tears off, what is lost, and that
//! memories survive.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::f64::consts::PI;

use calcine_coupler::motion::{Cohesion, ContactForce, Contacts, Rolling, WallMotion};
use calcine_coupler::part::Part;
use calcine_coupler::physics::Vec3;

use crate::dem_beds::drum_with;
use crate::dem_restart::{box_with, goes_on_alike};
use crate::grains::*;

const RADIUS: f64 = 1e-3;
/// E* in Pa of two bodies of 10 MPa and a Poisson's ratio of 0.25.
const YOUNG: f64 = 1e7 / (2.0 * (1.0 - 0.0625));
/// Work of adhesion in J/m².
const WORK: f64 = 0.2;

/// Elastic contacts that adhere.
fn sticky(step: f64, work: f64) -> Contacts {
    let mut contacts = contacts(step);
    contacts.law.cohesion = Cohesion::Jkr;
    contacts.pairs[0].work_of_adhesion = work;
    contacts.pairs[0].restitution = 1.0;
    contacts
}

/// a_t in m: a_t³ = π w R*²/(8 E*).
fn torn(radius: f64) -> f64 {
    torn_by(WORK, radius)
}

/// The same of a work of adhesion in J/m².
fn torn_by(work: f64, radius: f64) -> f64 {
    (PI * work * radius * radius / (8.0 * YOUNG)).cbrt()
}

/// Force in N that pushes apart at an overlap in m, by bisection of δ = a²/R* − √(2π w a/E*) beyond its minimum.
fn exact(overlap: f64, radius: f64) -> f64 {
    let (mut low, mut high) = (torn(radius), 0.5 * radius);
    for _ in 0..200 {
        let a = 0.5 * (low + high);
        let found = a * a / radius - (2.0 * PI * WORK * a / YOUNG).sqrt();
        if found < overlap { low = a } else { high = a }
    }
    4.0 / 3.0 * YOUNG * low.powi(3) / radius - (8.0 * PI * WORK * YOUNG * low.powi(3)).sqrt()
}

/// The force along z in N of all contacts on the particle of a row, as the next kick takes it.
fn force(bed: &Bed, row: usize) -> f64 {
    bed.particles.engine().unwrap().state().load[row][0].z
}

/// A sphere so heavy that no contact slows it, which goes straight down on one that is held, or on a plane, and up again.
struct Pull {
    bed: Bed,
    radius: f64,
}

impl Pull {
    fn new(work: f64, plane_below: bool) -> Self {
        let mut contacts = sticky(1e-6, work);
        contacts.material_of = vec![0; 2];
        contacts.held = vec![false, true];
        let mut mover = sphere(1, Vec3::z() * RADIUS, Vec3::zeros(), RADIUS);
        mover.density = 1e20;
        let mut spheres = vec![mover];
        if plane_below {
            contacts.walls = vec![plane(Vec3::zeros(), Vec3::z())];
        } else {
            let mut held = sphere(2, Vec3::z() * -3.0 * RADIUS, Vec3::zeros(), 3.0 * RADIUS);
            held.population = 1;
            spheres.push(held);
        }
        let radius = if plane_below { RADIUS } else { 0.75 * RADIUS };
        spheres[0].position.z += 1e-9;
        Self {
            bed: Bed::new(contacts, &spheres),
            radius,
        }
    }

    fn overlap(&self) -> f64 {
        RADIUS - self.bed.place(0).z
    }

    /// Goes by a distance in m in so many steps of their own window.
    fn go(&mut self, distance: f64, steps: u64, mut look: impl FnMut(f64, f64)) {
        let folder = tempfile::tempdir().unwrap();
        self.bed.particles.checkpoint(folder.path()).unwrap();
        let path = folder.path().join("particles.state");
        let mut state = calcine_coupler::checkpoint::StateFile::read(&path).unwrap();
        let mut velocity = state.f64s("velocity").unwrap().to_vec();
        velocity[2] = distance / (steps as f64 * self.bed.step);
        state.set_f64s("velocity", &velocity);
        state.write(&path).unwrap();
        self.bed.particles.restore(folder.path()).unwrap();
        for _ in 0..steps {
            self.bed.run(1);
            look(self.overlap(), force(&self.bed, 0));
        }
    }
}

#[test]
fn the_force_is_the_papers_from_first_touch_to_the_tear_off_and_none_before_it_is_made_again() {
    for plane_below in [false, true] {
        let mut pull = Pull::new(WORK, plane_below);
        let radius = pull.radius;
        let (tear, pull_off) = (
            3.0 * torn(radius).powi(2) / radius,
            1.5 * PI * WORK * radius,
        );
        let (mut made, mut lowest) = (false, 0.0f64);
        pull.go(-4.0 * tear, 400, |overlap, force| {
            made |= overlap > 0.0;
            let wanted = if made { exact(overlap, radius) } else { 0.0 };
            assert!(
                (force - wanted).abs() < 1e-8 * pull_off,
                "{overlap}: {force} {wanted}"
            );
        });
        // Up, beyond first touch, where the contact holds, in steps of 1e-3 of the tear-off distance.
        let (mut last, mut broken) = (0.0, false);
        pull.go(6.0 * tear, 6000, |overlap, force| {
            broken |= overlap < -tear;
            let wanted = if broken { 0.0 } else { exact(overlap, radius) };
            assert!(
                (force - wanted).abs() < 1e-6 * pull_off,
                "{overlap}: {force} {wanted}"
            );
            if force != 0.0 {
                last = overlap;
            }
            lowest = lowest.min(force);
        });
        assert!(
            broken && last > -tear && last < -0.998 * tear,
            "{last} {tear}"
        );
        assert!(
            (lowest / -pull_off - 1.0).abs() < 1e-6,
            "{lowest} {pull_off}"
        );
        // Back into the gap: nothing until it touches.
        pull.go(-1.9 * tear, 190, |overlap, force| {
            assert!(overlap < 0.0);
            assert_eq!(force, 0.0);
        });
    }
}

#[test]
fn a_contact_tears_off_at_its_distance_to_one_part_in_a_million() {
    let mut pull = Pull::new(WORK, true);
    let tear = 3.0 * torn(RADIUS).powi(2) / RADIUS;
    pull.go(-0.5 * tear, 50, |_, _| {});
    let to = tear * (1.0 - 1e-5) + pull.overlap();
    pull.go(to, 1000, |_, _| {});
    let mut last = 0.0;
    pull.go(2e-5 * tear, 100, |overlap, force| {
        if force != 0.0 {
            last = overlap;
        }
    });
    assert!((last / -tear - 1.0).abs() < 1e-6, "{}", last / -tear);
    assert_eq!(force(&pull.bed, 0), 0.0);
}

/// Two equal spheres that meet head on at a speed in m/s, in so many steps of a step in s; kinetic energy in J after over before, the
/// energy budget's error and what was lost.
fn impact(speed: f64, step: f64, steps: u64) -> [f64; 3] {
    let half = Vec3::z() * (0.5 * speed);
    let spheres = [
        sphere(1, Vec3::z() * 1.001 * RADIUS, -half, RADIUS),
        sphere(2, Vec3::z() * -1.001 * RADIUS, half, RADIUS),
    ];
    let mut bed = Bed::new(sticky(step, WORK), &spheres);
    bed.particles.count_energy(true);
    bed.run(1);
    let before = bed.particles.energy();
    bed.run(steps);
    let after = bed.particles.energy();
    [
        after.kinetic - before.kinetic,
        after.balance() - before.balance(),
        after.lost(),
    ]
}

#[test]
fn an_impact_loses_what_a_contact_made_and_broken_does_and_sticks_below() {
    // 8/15 (6 + 9 · 4^(4/3)) E* a_t⁵/R*² = 7.09 (w⁵ R*⁴/E*²)^(1/3)
    let radius = 0.5 * RADIUS;
    let made = 6.0 + 9.0 * 4f64.powf(4.0 / 3.0);
    let lost = 8.0 / 15.0 * made * YOUNG * torn(radius).powi(5) / (radius * radius);
    let published = 7.09 * (WORK.powi(5) * radius.powi(4) / YOUNG.powi(2)).cbrt();
    assert!((lost / published - 1.0).abs() < 1e-3);
    let mass = 4.0 / 3.0 * PI * RADIUS.powi(3) * 2500.0;
    // ½ m* V² = lost
    let speed = (4.0 * lost / mass).sqrt();
    let error = |step: f64| {
        let [kinetic, balance, counted] = impact(2.0 * speed, step, (2e-3 / step) as u64);
        assert!((counted / lost - 1.0).abs() < 1e-9, "{}", counted / lost);
        assert!(
            (balance / lost).abs() < 40.0 * step / 1e-7 * 1e-3,
            "{}",
            balance / lost
        );
        -kinetic / lost - 1.0
    };
    let (coarse, fine) = (error(2e-7), error(2e-8));
    // The force jumps as contact is made and torn: first order in the step.
    assert!(fine.abs() < 2e-3, "{fine}");
    assert!(coarse.abs() < 2e-2, "{coarse}");
    let stuck = impact(0.97 * speed, 1e-7, 20_000);
    assert!(stuck[2].abs() < 1e-12 * lost, "{stuck:?}");
    let free = impact(1.03 * speed, 1e-7, 20_000);
    assert!((free[2] / lost - 1.0).abs() < 1e-9, "{free:?}");
}

#[test]
fn without_work_of_adhesion_the_bits_are_those_of_hertz_law() {
    let run = |cohesion: Cohesion, attractive: bool| {
        let mut bed = drum_with(Rolling::None, ContactForce::HertzMindlin, |contacts| {
            contacts.law.cohesion = cohesion;
            contacts.law.attractive_damping = attractive;
        });
        bed.run(1000);
        bed.bits()
    };
    for attractive in [true, false] {
        assert_eq!(
            run(Cohesion::Jkr, attractive),
            run(Cohesion::None, attractive)
        );
    }
    for rolling in [Rolling::ElasticPlastic, Rolling::ConstantTorque] {
        let run = |cohesion: Cohesion| {
            let mut bed = drum_with(rolling, ContactForce::SpringSliderDashpot, |contacts| {
                contacts.law.cohesion = cohesion;
            });
            bed.run(600);
            bed.bits()
        };
        assert_eq!(run(Cohesion::Jkr), run(Cohesion::None));
    }
}

/// A sphere that hangs from one that is held, with a share of the pull-off force as its weight, for 0.2 s; how far it sank in radii.
fn hang(share: f64, coated: bool) -> f64 {
    let mut contacts = sticky(2e-6, 0.0);
    contacts.material_of = vec![0, 1];
    contacts.materials = vec![contacts.materials[0]; 2];
    contacts.held = vec![false, true];
    let mut pair = contacts.pairs[0];
    pair.restitution = 0.3;
    contacts.pairs = vec![pair; 4];
    if coated {
        for mixed in [1, 2] {
            contacts.pairs[mixed].work_of_adhesion = WORK;
        }
    }
    let mass = 4.0 / 3.0 * PI * RADIUS.powi(3) * 2500.0;
    let pull_off = 1.5 * PI * WORK * 0.5 * RADIUS;
    contacts.gravity = Vec3::z() * -(share * pull_off / mass);
    // As deep as its weight leaves it: where the force of the contact is −weight.
    let (mut low, mut high) = (-2.0 * torn(0.5 * RADIUS).powi(2) / RADIUS, 0.1 * RADIUS);
    for _ in 0..200 {
        let overlap = 0.5 * (low + high);
        if exact(overlap, 0.5 * RADIUS) < -share.min(0.99) * pull_off {
            low = overlap;
        } else {
            high = overlap;
        }
    }
    let mut spheres = [
        sphere(
            1,
            Vec3::z() * -(2.0 * RADIUS - low.max(1e-9)),
            Vec3::zeros(),
            RADIUS,
        ),
        sphere(2, Vec3::zeros(), Vec3::zeros(), RADIUS),
    ];
    spheres[1].population = 1;
    let start = spheres[0].position.z;
    let mut bed = Bed::new(contacts, &spheres);
    bed.run(20_000);
    (start - bed.place(0).z) / RADIUS
}

#[test]
fn a_coated_pair_hangs_and_falls_where_the_weight_is_more_than_the_pull_off_force() {
    assert!(hang(0.5, true) < 0.02, "{}", hang(0.5, true));
    assert!(hang(0.8, true) < 0.02, "{}", hang(0.8, true));
    assert!(hang(1.02, true) > 0.5);
    assert!(hang(0.5, false) > 0.5);
}

#[test]
fn a_slowly_rising_force_tears_a_contact_off_at_the_pull_off_force() {
    let mut contacts = sticky(5e-6, WORK);
    contacts.pairs[0].restitution = 0.1;
    contacts.walls = vec![plane(Vec3::zeros(), Vec3::z())];
    let mut bed = Bed::new(
        contacts,
        &[sphere(
            1,
            Vec3::z() * (RADIUS - 1e-9),
            Vec3::zeros(),
            RADIUS,
        )],
    );
    bed.run(20_000);
    let pull_off = 1.5 * PI * WORK * RADIUS;
    let mut held = 0.0;
    for k in 0..=1100 {
        let pull = pull_off * f64::from(k) / 1000.0;
        bed.push.force[0] = Vec3::z() * pull;
        bed.run(500);
        if bed.place(0).z > 1.01 * RADIUS {
            break;
        }
        held = pull;
    }
    // Steps of 1e-3; beyond the pull-off force the sphere leaves slowly at first.
    let share = held / pull_off;
    assert!((0.999..1.005).contains(&share), "{share}");
}

/// A few thousand adhesive spheres in a turning drum.
fn adhesive_drum() -> Bed {
    drum_with(
        Rolling::ElasticPlastic,
        ContactForce::HertzMindlin,
        |contacts| {
            contacts.law.cohesion = Cohesion::Jkr;
            contacts.pairs[0].work_of_adhesion = 0.3;
        },
    )
}

#[test]
fn adhesive_contacts_give_the_same_bits_on_one_and_two_threads_and_after_a_checkpoint() {
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut bed = adhesive_drum();
            bed.run(1500);
            bed.bits()
        })
    };
    assert_eq!(run(1), run(2));
    goes_on_alike(adhesive_drum, 1000);
    goes_on_alike(
        || {
            box_with(|contacts| {
                contacts.law.cohesion = Cohesion::Jkr;
                contacts.pairs[0].work_of_adhesion = 0.3;
            })
        },
        2000,
    );
}

/// A checkpoint while surfaces have parted and adhesion holds them.
#[test]
fn a_contact_that_has_parted_survives_a_checkpoint_and_a_search_with_a_thin_skin() {
    // The second is held beyond the thinnest skin, 0.04 radii.
    for (work, plane_below) in [(WORK, false), (WORK, true), (60.0, false), (60.0, true)] {
        let mut pull = Pull::new(work, plane_below);
        let tear = 3.0 * torn_by(work, pull.radius).powi(2) / pull.radius;
        assert_eq!(work == 60.0, 0.6 * tear > 0.04 * RADIUS);
        pull.go(-0.5 * tear, 50, |_, _| {});
        let to = pull.overlap() + 0.6 * tear;
        pull.go(to, 100, |_, _| {});
        assert!(pull.overlap() < -0.5 * tear);
        let held = force(&pull.bed, 0);
        assert!(held < 0.0);
        // At rest there, over restarts, through searches: the skin is halved each 500 steps.
        for _ in 0..4 {
            pull.go(0.0, 1, |_, _| {});
            pull.bed.run(1500);
            assert_eq!(force(&pull.bed, 0).to_bits(), held.to_bits());
        }
    }
}

/// What adheres to triangles adheres as to a plane, and to a wall that turns away overhead.
#[test]
fn a_sphere_hangs_below_a_plane_and_below_triangles() {
    let hang = |triangles: bool, share: f64| {
        let mut contacts = sticky(2e-6, WORK);
        contacts.pairs[0].restitution = 0.3;
        let mass = 4.0 / 3.0 * PI * RADIUS.powi(3) * 2500.0;
        contacts.gravity = Vec3::z() * -(share * 1.5 * PI * WORK * RADIUS / mass);
        contacts.walls = vec![if triangles {
            wall(calcine_coupler::motion::WallShape::Mesh {
                triangles: vec![
                    [
                        Vec3::new(-5e-3, -5e-3, 0.0),
                        Vec3::new(5e-3, -5e-3, 0.0),
                        Vec3::new(5e-3, 5e-3, 0.0),
                    ],
                    [
                        Vec3::new(-5e-3, -5e-3, 0.0),
                        Vec3::new(5e-3, 5e-3, 0.0),
                        Vec3::new(-5e-3, 5e-3, 0.0),
                    ],
                ],
            })
        } else {
            plane(Vec3::zeros(), -Vec3::z())
        }];
        contacts.walls[0].motion = WallMotion::Still;
        let start = Vec3::new(1e-3, -2e-3, -RADIUS + 1e-9);
        let mut bed = Bed::new(contacts, &[sphere(1, start, Vec3::zeros(), RADIUS)]);
        bed.run(20_000);
        bed.place(0)
    };
    let (below, beside) = (hang(false, 0.5), hang(true, 0.5));
    assert!((below.z + RADIUS).abs() < 0.02 * RADIUS, "{below}");
    assert!((below - beside).norm() < 1e-9 * RADIUS, "{below} {beside}");
    assert!(hang(true, 1.1).z < -1.5 * RADIUS);
}

#[test]
fn a_linear_law_and_a_negative_work_of_adhesion_are_refused() {
    let refused = |change: fn(&mut Contacts)| {
        let mut contacts = sticky(1e-6, WORK);
        change(&mut contacts);
        let spheres = [sphere(1, Vec3::zeros(), Vec3::zeros(), RADIUS)];
        Bed::try_new(contacts, &spheres).err().unwrap().to_string()
    };
    let linear = refused(|contacts| {
        contacts.law.force = ContactForce::Linear {
            characteristic_speed: 1.0,
        }
    });
    assert!(linear.contains("0 with a linear contact law"), "{linear}");
    let negative = refused(|contacts| contacts.pairs[0].work_of_adhesion = -0.1);
    assert!(negative.contains("the work of adhesion"), "{negative}");
}
