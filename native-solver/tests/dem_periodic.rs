//! Moving spheres in a domain that repeats itself: what leaves through one plane comes in through the other, and contacts
//! across the planes are as any other.

use calcine_coupler::motion::{
    ContactForce, Contacts, NewParticle, ParticleChanges, Rolling, WallMotion, WallShape,
};
use calcine_coupler::part::{Part, Particles};
use calcine_coupler::periodicity::{PeriodicSpan, Periodicity};
use calcine_coupler::physics::Vec3;

use crate::grains::*;

const RADIUS: f64 = 1e-3;

/// Periods of these lengths in m from the origin; 0 for none.
fn periodic(contacts: Contacts, lengths: [f64; 3]) -> Contacts {
    let span = |length: f64| {
        (length > 0.0).then_some(PeriodicSpan {
            low: 0.0,
            high: length,
        })
    };
    let (mut low, mut high) = contacts.bounds;
    for axis in 0..3 {
        if lengths[axis] > 0.0 {
            (low[axis], high[axis]) = (0.0, lengths[axis]);
        }
    }
    Contacts {
        bounds: (low, high),
        periodicity: Periodicity {
            axes: lengths.map(span),
        },
        ..contacts
    }
}

#[test]
fn a_lone_sphere_flies_as_if_there_were_no_planes_and_its_place_is_wrapped() {
    let flight = |contacts: Contacts| {
        let velocity = Vec3::new(1.3, -0.7, 0.2);
        let start = sphere(1, Vec3::new(9e-3, 1e-3, 5e-3), velocity, RADIUS);
        let mut bed = Bed::new(contacts, &[start]);
        for _ in 0..10 {
            bed.run(2503);
        }
        (bed.place(0), bed.velocity(0))
    };
    let mut rules = contacts(1e-5);
    rules.gravity = Vec3::new(0.5, 0.1, -1.0);
    let (free, speed) = flight(Contacts {
        bounds: (Vec3::repeat(-9.0), Vec3::repeat(9.0)),
        ..rules.clone()
    });
    let rules = periodic(rules, [0.01, 0.012, 0.02]);
    let (place, wrapped) = flight(rules.clone());
    assert!((wrapped - speed).norm() < 1e-12);
    let off = place - rules.periodicity.wrap(free);
    assert!(off.norm() < 1e-12, "{off}");
    assert_eq!(place, rules.periodicity.wrap(place));
    // It went around along all three, more than thirty times along x.
    assert!(free.x > 0.3 && free.y < -0.05 && free.z > 0.02);
}

/// Two spheres that meet obliquely around a place, spinning; their velocities and rotations after that.
fn impact(rules: Contacts, at: Vec3) -> [Vec3; 4] {
    let apart = 1.1 * RADIUS;
    let wrap = |place: Vec3| rules.periodicity.wrap(place);
    let aside = Vec3::y() * (0.4 * RADIUS);
    let spheres = [
        sphere(
            1,
            wrap(at - Vec3::x() * apart),
            Vec3::new(0.5, 0.1, 0.0),
            RADIUS,
        ),
        sphere(
            2,
            wrap(at + Vec3::x() * apart + aside),
            Vec3::new(-0.4, 0.0, 0.2),
            0.8 * RADIUS,
        ),
    ];
    let mut bed = Bed::new(rules, &spheres).spun(0, Vec3::new(30.0, -80.0, 20.0));
    bed.run(400);
    bed.run(3600);
    [bed.velocity(0), bed.velocity(1), bed.spin(0), bed.spin(1)]
}

#[test]
fn spheres_that_meet_across_a_plane_part_as_they_do_elsewhere() {
    let linear = ContactForce::Linear {
        characteristic_speed: 1.0,
    };
    for (rolling, force) in [
        (Rolling::ElasticPlastic, ContactForce::HertzMindlin),
        (Rolling::ConstantTorque, ContactForce::SpringSliderDashpot),
        (Rolling::None, linear),
    ] {
        let mut rules = contacts(1e-6);
        rules.law.rolling = rolling;
        rules.law.force = force;
        let rules = periodic(rules, [0.012, 0.01, 0.008]);
        let within = impact(rules.clone(), Vec3::new(5e-3, 5e-3, 4e-3));
        // They did meet, with friction.
        assert!(within[0].x < 0.2 && within[3].norm() > 1.0, "{within:?}");
        for across in [
            Vec3::new(0.0, 5e-3, 4e-3),
            Vec3::new(0.4e-3, 5e-3, 4e-3),
            Vec3::new(0.0, -0.2e-3, 4e-3),
            Vec3::new(0.2e-3, 0.1e-3, 0.0),
            Vec3::new(5e-3, -0.2e-3, 0.0),
        ] {
            let found = impact(rules.clone(), across);
            for (found, wanted) in found.iter().zip(&within) {
                let off = (found - wanted).norm() / wanted.norm();
                assert!(off < 1e-11, "{across}: {off:e}");
            }
        }
    }
}

#[test]
fn a_contact_that_crosses_a_plane_keeps_its_spring() {
    // A pair that is pressed together and sheared goes through the plane within the contact; elsewhere a pair that does not.
    let pair = |x: f64, speed: f64| {
        let rules = periodic(contacts(1e-6), [0.012, 0.01, 0.0]);
        let wrap = |place| rules.periodicity.wrap(place);
        let velocity = Vec3::x() * speed;
        let up = Vec3::z() * (1.98 * RADIUS);
        let spheres = [
            sphere(1, wrap(Vec3::new(x, 5e-3, 0.0)), velocity, RADIUS),
            sphere(2, wrap(Vec3::new(x, 5e-3, 0.0) + up), velocity, RADIUS),
        ];
        let mut bed = Bed::new(rules, &spheres);
        bed.push.force = vec![Vec3::new(1e-3, 0.0, 0.2), Vec3::new(-1e-3, 0.0, -0.2)];
        for _ in 0..20 {
            bed.run(97);
        }
        let relative = bed.velocity(1) - bed.velocity(0);
        (relative, bed.spin(0), bed.place(0).x)
    };
    let (still, spin, _) = pair(5e-3, 0.0);
    let (moving, turned, place) = pair(11.4e-3, 1.0);
    assert!(place < 4e-3, "{place}");
    assert!(
        (still - moving).norm() < 1e-9 * still.norm(),
        "{still} {moving}"
    );
    assert!(
        (spin - turned).norm() < 1e-9 * spin.norm(),
        "{spin} {turned}"
    );
}

/// A granular gas of so many spheres along each axis of a box that repeats along all three, moved by a shift in m before.
fn gas(step: f64, count: usize, shift: Vec3) -> Bed {
    let length = 2.6e-3 * count as f64;
    let rules = periodic(contacts(step), [length; 3]);
    let mut spheres = loose([count; 3], 2.6e-3, RADIUS, 1.0);
    for (index, sphere) in spheres.iter_mut().enumerate() {
        sphere.radius = RADIUS * (1.0 - 0.3 * (index % 7) as f64 / 7.0);
        sphere.position = rules.periodicity.wrap(sphere.position + shift);
    }
    Bed::new(rules, &spheres)
}

fn momentum(bed: &Bed) -> Vec3 {
    let fields = bed.particles.fields();
    let each = fields.mass.iter().zip(fields.velocity);
    each.map(|(mass, velocity)| *mass * velocity).sum()
}

#[test]
fn a_gas_of_spheres_keeps_its_momentum_and_its_energy_budget_closes_with_the_order_of_the_step() {
    let error = |step: f64, steps: u64| {
        let mut bed = gas(step, 8, Vec3::zeros());
        bed.particles.count_energy(true);
        let (start, before) = (momentum(&bed), bed.particles.energy());
        bed.run(steps);
        let after = bed.particles.energy();
        let mass: f64 = bed.particles.fields().mass.iter().sum();
        let off = (momentum(&bed) - start).norm() / mass;
        assert!(off < 1e-12, "{off:e} m/s");
        assert!(after.lost() > 0.3 * before.stored());
        (after.balance() - before.balance()).abs() / after.lost()
    };
    let (coarse, fine) = (error(5e-6, 2000), error(1.25e-6, 8000));
    assert!(coarse < 0.05 && fine < 0.35 * coarse, "{coarse:e} {fine:e}");
}

#[test]
fn it_does_not_matter_where_the_planes_cut() {
    let run = |shift: Vec3| {
        let mut bed = gas(5e-6, 8, shift);
        // Before collisions have amplified round-off by more than some orders.
        bed.run(500);
        bed
    };
    let (one, other) = (run(Vec3::zeros()), run(Vec3::new(0.0104, 3e-3, -0.0104)));
    let speeds = one.particles.fields().velocity.iter();
    let off = speeds.zip(other.particles.fields().velocity);
    let off = off.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(off < 1e-7, "{off:e}");
    assert!(one.particles.engine().unwrap().effort().0 > 5);
}

#[test]
fn the_bits_do_not_depend_on_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let mut bed = gas(5e-6, 14, Vec3::zeros());
            bed.run(300);
            bed.bits()
        })
    };
    let alone = run(1);
    assert!(alone == run(2));
    assert!(alone == run(3));
}

#[test]
fn a_resumed_bed_goes_on_to_the_bit() {
    for before in [0, 1, 211, 640] {
        let folder = tempfile::tempdir().unwrap();
        let [mut alone, mut through, mut resumed] = [(); 3].map(|()| chute());
        if before > 0 {
            alone.run(before);
            through.run(before);
        }
        through.particles.checkpoint(folder.path()).unwrap();
        resumed.particles.restore(folder.path()).unwrap();
        resumed.clocks = through.clocks;
        assert_eq!(resumed.bits(), through.bits());
        for steps in [1, 99, 1000] {
            for bed in [&mut alone, &mut through, &mut resumed] {
                bed.run(steps);
            }
            assert_eq!(through.bits(), alone.bits());
            assert_eq!(resumed.bits(), alone.bits());
        }
    }
}

/// A square of triangles at z = 0 over a box of these sides.
fn floor(lengths: [f64; 2], n: usize) -> WallShape {
    let [a, b] = [
        Vec3::x() * (lengths[0] / n as f64),
        Vec3::y() * (lengths[1] / n as f64),
    ];
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let at = i as f64 * a + j as f64 * b;
            triangles.extend([[at, at + a, at + b], [at + a, at + a + b, at + b]]);
        }
    }
    WallShape::Mesh { triangles }
}

/// Rough spheres on a floor of triangles that ends at the planes, inclined.
fn chute() -> Bed {
    let mut rules = contacts(5e-6);
    rules.gravity = Vec3::new(5.0, 0.0, -8.0);
    rules.law.rolling = Rolling::ElasticPlastic;
    rules.walls = vec![wall(floor([0.0102, 0.0076], 3))];
    let rules = periodic(rules, [0.0102, 0.0076, 0.0]);
    let mut spheres = loose([4, 3, 5], 2.5e-3, RADIUS, 0.3);
    for sphere in &mut spheres {
        sphere.position += Vec3::new(1e-4, 0.0, 2e-4);
        sphere.velocity.x += 0.8;
    }
    Bed::new(rules, &spheres)
}

#[test]
fn triangles_that_end_at_a_plane_go_on_beyond_it() {
    let run = |shape: WallShape| {
        let mut rules = contacts(1e-6);
        rules.gravity = Vec3::new(3.0, 1.0, -9.0);
        rules.law.rolling = Rolling::ElasticPlastic;
        rules.walls = vec![wall(shape)];
        let rules = periodic(rules, [8e-3, 7e-3, 0.0]);
        let velocity = Vec3::new(0.5, -0.3, 0.0);
        let start = sphere(1, Vec3::new(5e-3, 2e-3, RADIUS), velocity, RADIUS);
        let mut bed = Bed::new(rules, &[start]);
        let mut highest = 0.0f64;
        for _ in 0..400 {
            bed.run(101);
            highest = highest.max(bed.place(0).z);
        }
        (bed.place(0), bed.velocity(0), bed.spin(0), highest)
    };
    let plane = run(WallShape::Plane {
        point: Vec3::zeros(),
        normal: Vec3::z(),
    });
    let mesh = run(floor([8e-3, 7e-3], 2));
    assert!((plane.1 - mesh.1).norm() < 1e-9, "{plane:?} {mesh:?}");
    assert!((plane.2 - mesh.2).norm() < 1e-9 * plane.2.norm());
    assert!((plane.0 - mesh.0).norm() < 1e-9);
    // It rolled over the edges without a bump.
    assert!(mesh.3 < RADIUS && mesh.2.norm() > 100.0, "{mesh:?}");
}

#[test]
fn what_stays_keeps_its_contacts_when_others_come_and_go() {
    let run = |changes: bool| {
        let mut bed = chute();
        bed.run(700);
        let far = Vec3::new(5e-3, 4e-3, 0.5);
        let insert: Vec<NewParticle> = vec![sphere(900, far, Vec3::zeros(), RADIUS)];
        if changes {
            let change = ParticleChanges {
                insert,
                ..ParticleChanges::default()
            };
            bed.change(&change).unwrap();
        }
        bed.run(300);
        bed.particles.fields().position[..60].to_vec()
    };
    let (plain, changed) = (run(false), run(true));
    // Forces are evaluated anew where particles come, which costs round-off and the order of the step.
    let off = plain.iter().zip(&changed).map(|(a, b)| (a - b).norm());
    assert!(off.fold(0.0, f64::max) < 2e-6);
}

#[test]
fn what_does_not_repeat_is_refused_with_its_name() {
    let told = |lengths: [f64; 3], shape: Option<WallShape>, motion: WallMotion| {
        let mut rules = contacts(1e-5);
        if let Some(shape) = shape {
            rules.walls = vec![wall(shape)];
            rules.walls[0].motion = motion;
        }
        let spheres = [sphere(1, Vec3::repeat(2e-3), Vec3::zeros(), RADIUS)];
        let bed = Bed::try_new(periodic(rules, lengths), &spheres);
        bed.err().map(|error| error.to_string()).unwrap_or_default()
    };
    let plane = |normal: Vec3| {
        Some(WallShape::Plane {
            point: Vec3::zeros(),
            normal: normal.normalize(),
        })
    };
    let still = || WallMotion::Still;
    let wide = [0.01, 0.0, 0.0];
    assert_eq!(told([6e-3, 0.0, 0.0], None, still()), "");
    assert_eq!(told(wide, plane(Vec3::z()), still()), "");
    let short = told([5e-3, 0.0, 0.0], None, still());
    assert!(
        short.contains("every 0.005 m along x, which is 2.500 diameters"),
        "{short}"
    );
    let inclined = told(wide, plane(Vec3::new(0.2, 0.0, 1.0)), still());
    assert!(
        inclined.contains("wall `wall`, a plane across or inclined"),
        "{inclined}"
    );
    let tube = |axis: Vec3| {
        Some(WallShape::Cylinder {
            point: Vec3::zeros(),
            axis,
            radius: 0.01,
        })
    };
    assert_eq!(told(wide, tube(Vec3::x()), still()), "");
    assert!(told(wide, tube(Vec3::y()), still()).contains("axis across"));
    let cone = Some(WallShape::Cone {
        ends: [Vec3::zeros(), Vec3::x()],
        radii: [0.1, 0.2],
    });
    assert!(told(wide, cone, still()).contains("a cone"));
    let beyond = told(wide, Some(floor([0.011, 0.01], 1)), still());
    assert!(
        beyond.contains("beyond the periodic plane at x = 0.01 m"),
        "{beyond}"
    );
    let mesh = || Some(floor([0.01, 0.01], 1));
    let belt = |way: Vec3| told(wide, mesh(), WallMotion::Translating(way));
    assert!(belt(Vec3::x()).contains("move along"));
    assert_eq!(belt(Vec3::z()), "");
    let turning = |angular_velocity: Vec3| {
        let point = Vec3::zeros();
        let motion = WallMotion::Rotating {
            point,
            angular_velocity,
        };
        told(wide, mesh(), motion)
    };
    assert!(turning(Vec3::z()).contains("turns about another"));
    assert_eq!(turning(Vec3::x()), "");
}
