use std::collections::HashMap;
use std::f64::consts::PI;

use super::*;
use crate::mesh::block::{BoxSpec, box_mesh};
use crate::mesh::cylinder::{CylinderSpec, cylinder_mesh};
use crate::mesh::refine::{Refinement, refine};
use crate::mesh::zone::Zone;
use crate::mesh::{Patch, Topology, grading};
use crate::packing::random::SplitMix64;

/// 4 x 4 x 4 unit cells, their points moved by `shift`.
fn moved(shift: impl Fn(Vec3) -> Vec3) -> Mesh {
    let spec = BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::repeat(4.0),
        cells: [4; 3],
        patches: ["x-", "x+", "y-", "y+", "z-", "z+"].map(String::from),
    };
    let mut topology = box_mesh(&spec).unwrap().topology().clone();
    for point in &mut topology.points {
        *point += shift(*point);
    }
    Mesh::new(topology).unwrap()
}

fn hexahedra() -> Mesh {
    moved(|_| Vec3::zeros())
}

/// Parallelepipeds: plane faces, but no right angles.
fn sheared() -> Mesh {
    moved(|p| Vec3::new(0.3 * p.y - 0.2 * p.z, 0.25 * p.z, 0.1 * p.x))
}

fn warped() -> Mesh {
    moved(|p| {
        let bump = p.iter().map(|x| x * (4.0 - x) / 4.0).product::<f64>();
        Vec3::new((3.0 * p.y).sin(), (2.0 * p.z).cos(), (p.x + p.y).sin()) * 0.12 * bump
    })
}

fn refined() -> Mesh {
    let zone = Zone::Box {
        low: Vec3::repeat(0.9),
        high: Vec3::new(3.1, 2.1, 4.1),
    };
    refine(&hexahedra(), &[Refinement { zone, levels: 1 }]).unwrap()
}

/// A cylinder of edge-on plane cells, about as wide and high as the boxes.
fn cylinder() -> Mesh {
    cylinder_mesh(&CylinderSpec {
        origin: Vec3::new(2.0, 2.0, 0.0),
        diameter: 4.0,
        length: 4.0,
        cells_across: 5,
        along: grading::uniform(5),
        patches: ["all"; 3].map(String::from),
    })
    .unwrap()
}

/// Six tetrahedra around the diagonal of each of 3 x 3 x 3 cubes that fill the box (H. Freudenthal, Ann. Math. 43
/// (1942) 580).
fn tetrahedra() -> Mesh {
    const ALONG: usize = 3;
    let at = |[i, j, k]: [usize; 3]| (i + (ALONG + 1) * (j + (ALONG + 1) * k)) as u32;
    let mut points = Vec::new();
    for n in 0..(ALONG + 1).pow(3) {
        let place = [
            n % (ALONG + 1),
            n / (ALONG + 1) % (ALONG + 1),
            n / (ALONG + 1).pow(2),
        ];
        points.push(Vec3::from(place.map(|i| 4.0 * i as f64 / ALONG as f64)));
    }
    // Faces by their points, with their cells; turned outwards below.
    let mut faces: HashMap<[u32; 3], Vec<u32>> = HashMap::new();
    let mut centres: Vec<Vec3> = Vec::new();
    for n in 0..ALONG.pow(3) {
        let corner = [n % ALONG, n / ALONG % ALONG, n / ALONG.pow(2)];
        for path in [
            [0, 1, 2],
            [0, 2, 1],
            [1, 0, 2],
            [1, 2, 0],
            [2, 0, 1],
            [2, 1, 0],
        ] {
            let mut place = corner;
            let mut cell = vec![at(place)];
            for axis in path {
                place[axis] += 1;
                cell.push(at(place));
            }
            for left in 0..4 {
                let mut face: Vec<u32> = cell.clone();
                face.remove(left);
                face.sort_unstable();
                let key = [face[0], face[1], face[2]];
                faces.entry(key).or_default().push(centres.len() as u32);
            }
            centres.push(cell.iter().map(|&p| points[p as usize]).sum::<Vec3>() / 4.0);
        }
    }
    let mut sorted: Vec<_> = faces.into_iter().collect();
    sorted.sort_unstable_by_key(|(points, cells)| (cells.len() == 1, cells.clone(), *points));
    let internal = sorted.iter().filter(|(_, cells)| cells.len() == 2).count();
    let mut topology = Topology {
        patches: vec![Patch {
            name: "all".into(),
            start: internal,
            count: sorted.len() - internal,
        }],
        face_offsets: vec![0],
        ..Topology::default()
    };
    for (mut face, cells) in sorted {
        let [a, b, c] = face.map(|p| points[p as usize]);
        if (b - a)
            .cross(&(c - a))
            .dot(&(a - centres[cells[0] as usize]))
            < 0.0
        {
            face.swap(1, 2);
        }
        topology.face_points.extend(face);
        topology
            .face_offsets
            .push(topology.face_points.len() as u32);
        topology.owner.push(cells[0]);
        topology.neighbour.extend(cells.get(1));
    }
    topology.points = points;
    Mesh::new(topology).unwrap()
}

fn meshes() -> [(&'static str, Mesh); 6] {
    [
        ("hexahedra", hexahedra()),
        ("sheared", sheared()),
        ("warped", warped()),
        ("refined", refined()),
        ("cylinder", cylinder()),
        ("tetrahedra", tetrahedra()),
    ]
}

/// Spheres of all sizes in a mesh: anywhere, and with centres in or a hair beside planes, edges and corners.
fn spheres(mesh: &Mesh, count: usize) -> Vec<(Vec3, f64)> {
    let locator = Locator::new(mesh);
    let mut random = SplitMix64(11);
    let mut spheres = Vec::new();
    let points = &mesh.topology().points;
    while spheres.len() < count {
        let pick = |share: f64, of: usize| ((share * of as f64) as usize).min(of - 1);
        let face = pick(random.unit(), mesh.faces());
        let corners = mesh.face_points(face);
        let corner = pick(random.unit(), corners.len());
        let [a, b] = [corner, (corner + 1) % corners.len()].map(|k| points[corners[k] as usize]);
        let share = random.unit();
        let near = [
            Vec3::from_fn(|_, _| 4.0 * random.unit()),
            mesh.face_centre()[face] * share + a * (1.0 - share),
            a * share + b * (1.0 - share),
            a,
        ][spheres.len() % 4];
        let beside = Vec3::from_fn(|_, _| random.unit() - 0.5);
        let hair = [0.0, 1e-13, 1e-9, 1e-4, 0.3][pick(random.unit(), 5)];
        let centre = near + beside * hair;
        let radius = 10f64.powf(3.5 * random.unit() - 3.0);
        if locator.cell_at(centre).is_some() {
            spheres.push((centre, radius));
        }
    }
    spheres
}

/// Shares by the general overlap alone, of cells found by their bounding boxes.
fn general(mapper: &Mapper<&Mesh>, (centre, radius): (Vec3, f64)) -> HashMap<usize, f64> {
    let mut cells = Vec::new();
    mapper.locator.cells_near(centre, radius, &mut cells);
    let mut scratch = Scratch::default();
    let mesh = mapper.locator.mesh();
    let volumes = mapper
        .overlap
        .volumes(mesh, &cells, centre, radius, &mut scratch);
    let total: f64 = volumes.iter().sum();
    let shares = cells.iter().zip(volumes);
    shares
        .map(|(&cell, volume)| (cell as usize, volume / total))
        .collect()
}

#[test]
fn closed_forms_and_lanes_agree_with_the_general_overlap_of_any_sphere_in_any_mesh() {
    for (name, mesh) in meshes() {
        let mapper = Mapper::new(&mesh);
        let spheres = spheres(&mesh, 2000);
        let (centres, radii): (Vec<_>, Vec<_>) = spheres.iter().copied().unzip();
        let weights = mapper.fill(Method::Overlap, &centres, &radii).unwrap();
        for (particle, &sphere) in spheres.iter().enumerate() {
            let mut wanted = general(&mapper, sphere);
            let mut total = 0.0;
            for (cell, share) in weights.of_particle(particle) {
                total += share;
                let wanted = wanted.remove(&cell).unwrap_or(0.0);
                // Next to a corner a solid angle is known to the coordinates' round-off, some 1e-15, over the height,
                // a thousandth of the radius at least; a share to 1/4π of that.
                let tolerance = 1e-14 + 1e-13 / sphere.1;
                assert!(
                    (share - wanted).abs() < tolerance,
                    "{name}, {sphere:?}: cell {cell} has {share}, not {wanted}"
                );
            }
            assert!((total - 1.0).abs() < 1e-14, "{name}, {sphere:?}: {total}");
            for (cell, missed) in wanted {
                assert!(
                    missed < 1e-14 + 1e-13 / sphere.1,
                    "{name}, {sphere:?}: {missed} in cell {cell}"
                );
            }
        }
    }
}

#[test]
fn the_parts_of_a_sphere_within_the_mesh_sum_to_its_volume_before_they_are_scaled() {
    for (name, mesh) in meshes() {
        let mapper = Mapper::new(&mesh);
        let mut taken = 0;
        for (centre, radius) in spheres(&mesh, 2000) {
            let beyond = |face: usize| {
                let away = mesh.face_centre()[face] - centre;
                mapper.locator.normal(face).dot(&away) < radius
            };
            let home = mapper.locator.cell_at(centre).unwrap();
            if (mesh.internal_faces()..mesh.faces()).any(beyond) {
                continue;
            }
            let mut parts = Parts::default();
            let sphere = (centre, radius);
            if mapper
                .passage
                .gather(&mesh, &mapper.overlap, home, sphere, &mut parts)
            {
                parts.finish(&mesh);
                let total: f64 = parts.volumes.iter().sum();
                let whole = 4.0 / 3.0 * PI * radius.powi(3);
                assert!(
                    (total / whole - 1.0).abs() < 1e-13,
                    "{name}, {sphere:?}: {total} of {whole}"
                );
                taken += 1;
            }
        }
        assert!(taken > 100 || name == "warped", "{name}: {taken}");
    }
}

#[test]
fn a_row_does_not_depend_on_the_other_particles() {
    for (name, mesh) in meshes() {
        let mapper = Mapper::new(&mesh);
        let (centres, radii): (Vec<_>, Vec<_>) = spheres(&mesh, 600).into_iter().unzip();
        let all = mapper.fill(Method::Overlap, &centres, &radii).unwrap();
        for particle in (0..600).step_by(7) {
            let own = [&centres[particle..=particle], &centres[..1]].concat();
            let alone = mapper
                .fill(Method::Overlap, &own, &[radii[particle], 0.5])
                .unwrap();
            let bits = |weights: &Weights, particle| -> Vec<(usize, u64)> {
                let row = weights.of_particle(particle);
                row.map(|(cell, share)| (cell, share.to_bits())).collect()
            };
            assert_eq!(bits(&all, particle), bits(&alone, 0), "{name}: {particle}");
        }
    }
}

#[test]
fn domains_are_known_to_be_convex_or_not() {
    let is_convex = |mesh: &Mesh| Mapper::new(mesh).passage.is_convex();
    assert!(is_convex(&hexahedra()) && is_convex(&sheared()) && is_convex(&cylinder()));
    assert!(is_convex(&tetrahedra()));
    // Two bars that meet at right angles: the middle of a cross is missing two corners.
    let bump = moved(|p| {
        if p.z == 4.0 && p.x < 2.0 {
            Vec3::new(0.0, 0.0, 0.5)
        } else {
            Vec3::zeros()
        }
    });
    assert!(!is_convex(&bump));
}

/// A mesh that repeats itself along some axes.
fn repeated(mesh: &Mesh, axes: &[&str]) -> Mesh {
    let pairs: Vec<_> = axes
        .iter()
        .map(|axis| [format!("{axis}-"), format!("{axis}+")])
        .collect();
    mesh.clone().with_periodic(&pairs).unwrap()
}

/// Spheres of all kinds over a mesh that repeats itself along x and z, and the same moved by whole cells.
#[test]
fn a_sphere_across_a_periodic_plane_keeps_its_volume_and_moves_with_the_cells() {
    let mesh = repeated(&hexahedra(), &["x", "z"]);
    let periodicity = *mesh.periodicity();
    let mapper = Mapper::new(&mesh);
    let cell = |cell: usize| [cell % 4, cell / 4 % 4, cell / 16];
    let mut random = SplitMix64(3);
    for method in [
        Method::Overlap,
        Method::Divided,
        Method::Centroid,
        Method::Linear,
    ] {
        for _ in 0..200 {
            let radius = 0.1 + 1.5 * random.unit();
            let high = radius + (4.0 - 2.0 * radius) * random.unit();
            let centre = Vec3::new(1.0 + random.unit(), high, 1.0 + random.unit());
            let row = |shift: [usize; 2]| {
                let moved = centre + Vec3::new(shift[0] as f64, 0.0, shift[1] as f64);
                let weights = mapper.fill(method, &[periodicity.wrap(moved)], &[radius]);
                let mut share = [0.0; 64];
                for (at, value) in weights.unwrap().of_particle(0) {
                    let [i, j, k] = cell(at);
                    let back = (i + 4 - shift[0]) % 4 + 4 * j + 16 * ((k + 4 - shift[1]) % 4);
                    share[back] += value;
                }
                share
            };
            let wanted = row([0, 0]);
            assert!((wanted.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            for shift in [[2, 0], [3, 0], [0, 2], [2, 3], [3, 2]] {
                for (found, wanted) in row(shift).iter().zip(&wanted) {
                    assert!(
                        (found - wanted).abs() < 1e-13,
                        "{method:?} {centre} {radius}"
                    );
                }
            }
        }
    }
}

#[test]
fn what_a_sphere_shares_with_cells_across_a_plane_is_its_volume_there() {
    let mesh = warped();
    // The points of the boundary of this mesh stand in their planes.
    let periodic = repeated(&mesh, &["x"]);
    let (centre, radius) = (Vec3::new(0.2, 2.1, 1.9), 0.9);
    let weights = Mapper::new(&periodic).fill(Method::Overlap, &[centre], &[radius]);
    let beyond: f64 = weights
        .unwrap()
        .of_particle(0)
        .filter(|(cell, _)| mesh.cell_centre()[*cell].x > 2.0)
        .map(|(_, share)| share)
        .sum();
    // Cap of height R − 0.2: π h² (3 R − h)/3 over 4/3 π R³.
    let high: f64 = 0.7;
    let wanted = high * high * (2.7 - high) / (4.0 * radius.powi(3));
    assert!((beyond - wanted).abs() < 1e-3, "{beyond} {wanted}");
    // Without images it is put back among the others.
    let weights = Mapper::new(&mesh).fill(Method::Overlap, &[centre], &[radius]);
    let weights = weights.unwrap();
    assert!(
        weights
            .of_particle(0)
            .all(|(cell, _)| mesh.cell_centre()[cell].x < 2.0)
    );
}
