use super::*;
use crate::motion::WallShape;
use crate::packing::{Fill, RandomSpec, Sizes, random_in_box};

fn plane(point: Vec3, normal: Vec3, absorbs: Option<(usize, f64)>) -> RadiationWall {
    RadiationWall {
        surface: WallSurface::new(&WallShape::Plane { point, normal }),
        absorbs,
    }
}

fn rows(views: &ExchangeAreas) -> Vec<f64> {
    let shares = views.own.iter().zip(&views.surface);
    let mut row: Vec<f64> = shares.map(|(own, surface)| own / surface).collect();
    for &([a, b], area) in &views.pairs {
        row[a] += area / views.surface[a];
        row[b] += area / views.surface[b];
    }
    for &([p, _], area) in &views.reservoirs {
        row[p] += area / views.surface[p];
    }
    row
}

/// View factor of a pair.
fn factor(views: &ExchangeAreas, a: usize, b: usize) -> f64 {
    let found = views.pairs.iter().find(|pair| pair.0 == [a, b]);
    found.map_or(0.0, |pair| pair.1 / views.surface[a])
}

const RAYS: ViewFactors = ViewFactors::Rays {
    rays: 20_000,
    range: 3.0,
};

#[test]
fn two_spheres_in_the_open_see_each_other_as_tabulated_and_the_rest_is_beyond() {
    // Requirements COR-11.
    for (s, tabulated) in [
        (2.0, 0.075_587),
        (2.5, 0.044_119),
        (4.0, 0.016_156),
        (6.0, 0.007_044),
    ] {
        let centres = [Vec3::zeros(), Vec3::new(0.3, -0.5, 0.8).normalize() * s];
        let scene = RadiationScene {
            radii: &[1.0; 2],
            centres: &centres,
            emissivity: &[1.0; 1000],
            walls: &[],
            reservoirs: 0,
            beyond: Some(0),
        };
        let views = views(&scene, RAYS);
        let made = factor(&views, 0, 1);
        assert!((made - tabulated).abs() < 1e-3, "{s}: {made}");
        for row in rows(&views) {
            assert!((row - 1.0).abs() < 1e-12, "{row}");
        }
    }
}

#[test]
fn a_sphere_between_two_others_hides_them_from_each_other() {
    // In a row, touching: the outer ones see of each other what passes the middle one's edge. The shadow of
    // an equal sphere half way is whole: every line between the outer two that misses it would have to leave
    // their common cylinder.
    let centres = [0.0, 2.0, 4.0].map(|x| Vec3::new(x, 0.0, 0.0));
    let scene = RadiationScene {
        radii: &[1.0; 3],
        centres: &centres,
        emissivity: &[1.0; 1000],
        walls: &[],
        reservoirs: 0,
        beyond: Some(0),
    };
    let hidden = views(&scene, RAYS);
    assert_eq!(factor(&hidden, 0, 2), 0.0);
    // A small one leaves 0.865 of the open view, by plain Monte Carlo apart from Calcine (1.5e6 rays).
    let radii = [1.0, 0.2, 1.0];
    let partly = views(
        &RadiationScene {
            radii: &radii,
            ..scene
        },
        RAYS,
    );
    let open = sphere_to_sphere(1.0, 1.0, 4.0);
    let left = factor(&partly, 0, 2) / open;
    assert!((left - 0.865).abs() < 0.03, "{left}");
}

#[test]
fn a_sphere_over_a_floor_sees_the_half_of_it_and_the_half_of_the_sky() {
    let floor = plane(Vec3::zeros(), Vec3::z(), Some((0, 1.0)));
    let scene = RadiationScene {
        radii: &[1.0],
        centres: &[Vec3::new(0.0, 0.0, 3.0)],
        emissivity: &[1.0; 1000],
        walls: std::slice::from_ref(&floor),
        reservoirs: 1,
        beyond: Some(1),
    };
    let made = views(&scene, RAYS);
    // An endless plane takes half of all directions, whatever the distance.
    let share =
        |k: usize| made.reservoirs.iter().find(|one| one.0[1] == k).unwrap().1 / made.surface[0];
    assert!((share(0) - 0.5).abs() < 1e-3 && (share(1) - 0.5).abs() < 1e-3);
}

#[test]
fn a_mirror_shows_the_bed_again() {
    // A sphere between a mirror and a black wall: all it sends to the mirror comes back to itself or goes to
    // the wall. Its own image at 2 h takes F(COR-11), which it does not see as another.
    let walls = [
        plane(Vec3::zeros(), Vec3::z(), None),
        plane(Vec3::new(0.0, 0.0, 5.0), -Vec3::z(), Some((0, 1.0))),
    ];
    let centres = [Vec3::new(0.0, 0.0, 1.5), Vec3::new(3.0, 0.0, 1.5)];
    let scene = RadiationScene {
        radii: &[1.0; 2],
        centres: &centres,
        emissivity: &[1.0; 1000],
        walls: &walls,
        reservoirs: 1,
        beyond: None,
    };
    let grid = SphereGrid::new(scene.radii, scene.centres);
    let seen = look(&scene, &grid, 0, &[1], 200_000, 100.0);
    let mirrored: f64 = seen.others.iter().map(|one| one.1).sum();
    let image = sphere_to_sphere(1.0, 1.0, (9.0_f64 + 9.0).sqrt());
    assert!((mirrored - image).abs() < 1e-3, "{mirrored} {image}");
    assert!(seen.own > 0.0);
    let own = 1.0 - mirrored - seen.reservoirs[0] - f64::from(seen.direct[0].2) / 200_000.0;
    let itself = sphere_to_sphere(1.0, 1.0, 3.0);
    assert!((own - itself).abs() < 1e-3, "{own} {itself}");
    // A grey wall takes its share, and mirrors the rest.
    let grey = [
        walls[0].clone(),
        plane(Vec3::new(0.0, 0.0, 5.0), -Vec3::z(), Some((0, 0.3))),
    ];
    let views = views(
        &RadiationScene {
            walls: &grey,
            ..scene
        },
        RAYS,
    );
    assert!(rows(&views).iter().all(|row| (row - 1.0).abs() < 1e-12));
}

/// Spheres of 10 mm in a box of six black walls.
fn bed() -> (Vec<Vec3>, Vec<RadiationWall>) {
    let size = Vec3::new(0.07, 0.07, 0.1);
    let spec = RandomSpec {
        sizes: Sizes::Equal(0.01),
        fill: Fill::Height {
            height: size.z,
            solid_fraction: 0.56,
        },
        seed: 3,
        size_seed: 1,
        periodicity: Default::default(),
    };
    let packing = random_in_box(Vec3::zeros(), [size.x, size.y], &spec).unwrap();
    let mut walls = Vec::new();
    for axis in 0..3 {
        let mut normal = Vec3::zeros();
        normal[axis] = 1.0;
        walls.push(plane(Vec3::zeros(), normal, Some((2 * axis, 1.0))));
        walls.push(plane(size, -normal, Some((2 * axis + 1, 1.0))));
    }
    (packing.centres, walls)
}

const SHARES: ViewFactors = ViewFactors::Distance { range: 4.0 };

#[test]
fn in_a_closed_bed_rows_sum_to_one_and_pairs_of_the_middle_see_what_the_fit_says() {
    let (centres, walls) = bed();
    let radii = vec![5e-3; centres.len()];
    let scene = RadiationScene {
        radii: &radii,
        centres: &centres,
        emissivity: &[1.0; 1000],
        walls: &walls,
        reservoirs: 6,
        beyond: None,
    };
    let rays = ViewFactors::Rays {
        rays: 512,
        range: 4.0,
    };
    let (traced, fitted) = (views(&scene, rays), views(&scene, SHARES));
    for views in [&traced, &fitted] {
        for row in rows(views) {
            assert!((row - 1.0).abs() < 1e-12, "{row}");
        }
    }
    // How far radiation goes: Σ F s² of a particle in the middle, which sets the bed's conductivity.
    let inner = |c: &Vec3| (0..3).all(|k| (0.025..[0.045, 0.045, 0.075][k]).contains(&c[k]));
    let moment = |views: &ExchangeAreas| {
        let of = |&([a, b], area): &([usize; 2], f64)| {
            let ends =
                f64::from(u8::from(inner(&centres[a]))) + f64::from(u8::from(inner(&centres[b])));
            ends * area * (centres[b] - centres[a]).norm_squared()
        };
        views.pairs.iter().map(of).sum::<f64>()
    };
    let ratio = moment(&fitted) / moment(&traced);
    // The fit is of a larger bed, which is looser in its middle.
    assert!((ratio - 1.0).abs() < 0.12, "{ratio}");
}

#[test]
fn views_do_not_depend_on_the_number_of_threads() {
    let (centres, walls) = bed();
    let radii = vec![5e-3; centres.len()];
    let scene = RadiationScene {
        radii: &radii,
        centres: &centres,
        emissivity: &[1.0; 1000],
        walls: &walls,
        reservoirs: 6,
        beyond: None,
    };
    let rays = ViewFactors::Rays {
        rays: 64,
        range: 3.0,
    };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| views(&scene, rays))
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn grey_spheres_exchange_what_is_left_after_reflections() {
    // Two spheres in the open: e₁ e₂ F, and of second order what goes to and fro.
    let centres = [Vec3::zeros(), Vec3::new(2.5, 0.0, 0.0)];
    let grey = RadiationScene {
        radii: &[1.0; 2],
        centres: &centres,
        emissivity: &[0.5, 0.8],
        walls: &[],
        reservoirs: 0,
        beyond: Some(0),
    };
    let made = views(&grey, RAYS);
    let area = made.pairs[0].1 / (4.0 * PI);
    assert!((area / (0.4 * 0.044_119) - 1.0).abs() < 0.02, "{area}");
    // Each row sums to the emissivity.
    assert!((made.surface[0] / (2.0 * PI) - 1.0).abs() < 1e-14);
    assert!(rows(&made).iter().all(|row| (row - 1.0).abs() < 1e-12));
    // Of what the second reflects, 0.5 · 0.2 F, less than a half comes back; the first absorbs a half of that.
    let own = made.own[0] / (4.0 * PI);
    assert!(own > 0.0 && own < 0.25 * 0.5 * 0.2 * 0.044_119, "{own}");
}

const NEIGHBOURS: ViewFactors = ViewFactors::Neighbours { range: 3.0 };

#[test]
fn neighbours_share_what_equal_spheres_see_evenly_and_the_rest_is_not_seen() {
    // Four that see each other, emissivity 0.9: a third of it each. Another one is out of their reach.
    let mut centres: Vec<Vec3> = [[0.0, 0.0], [2.1, 0.0], [0.0, 2.1], [2.1, 2.1]]
        .iter()
        .map(|at| Vec3::new(at[0], at[1], 0.0))
        .collect();
    centres.push(Vec3::new(0.0, 0.0, 20.0));
    let scene = RadiationScene {
        radii: &[1.0; 5],
        centres: &centres,
        emissivity: &[0.9; 5],
        walls: &[plane(Vec3::new(0.0, 0.0, -1.0), Vec3::z(), Some((0, 1.0)))],
        reservoirs: 1,
        beyond: None,
    };
    let made = views(&scene, NEIGHBOURS);
    assert!(!made.radiosity && made.reservoirs.is_empty());
    assert_eq!(made.pairs.len(), 6);
    for &(_, area) in &made.pairs {
        assert!(
            (area / (0.9 * 4.0 * PI / 3.0) - 1.0).abs() < 1e-12,
            "{area}"
        );
    }
    assert_eq!(rows(&made)[4], 0.0);
}

#[test]
fn neighbours_of_several_sizes_see_all_of_their_surface_and_each_other_alike() {
    // Surfaces of 3, 4 and 5: the one symmetric matrix without a diagonal of these sums has (3 + 4 − 5)/2 = 1, 2 and 3.
    let radii = [3.0_f64, 4.0, 5.0].map(|surface| (surface / (4.0 * PI)).sqrt());
    let centres = [0.0, 1.4, 2.8].map(|x| Vec3::new(x, 0.0, 0.0));
    let scene = RadiationScene {
        radii: &radii,
        centres: &centres,
        emissivity: &[1.0; 3],
        walls: &[],
        reservoirs: 0,
        beyond: None,
    };
    let made = views(&scene, NEIGHBOURS);
    for (ends, exact) in [([0, 1], 1.0), ([0, 2], 2.0), ([1, 2], 3.0)] {
        let found = made.pairs.iter().find(|pair| pair.0 == ends);
        let area = found.map_or(0.0, |pair| pair.1);
        assert!((area - exact).abs() < 1e-10, "{ends:?}: {area}");
    }
}
