//! What the smoother refuses: beds that do not fit, settings out of range (docs/theory.md, VFS-4, VFS-5).

#![allow(clippy::unwrap_used)]

use calcine_coupler::mapping::Weights;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::physics::Vec3;
use calcine_coupler::smoother::{Smoother, SmootherError, SmootherSettings};

/// A box of cubes of 1 mm.
fn cubes(cells: [usize; 3]) -> Mesh {
    box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(cells[0] as f64, cells[1] as f64, cells[2] as f64) * 1e-3,
        cells,
        patches: ["all"; 6].map(String::from),
    })
    .unwrap()
}

const CUBE: f64 = 1e-9;

fn settings() -> SmootherSettings {
    SmootherSettings::default()
}

#[test]
fn a_bed_that_does_not_fit_is_refused_with_the_volume_left_over() {
    let mesh = cubes([3, 3, 3]);
    let smoother = Smoother::new(&mesh, settings()).unwrap();
    let weights = Weights::new(27, vec![vec![(0, 1.0)]]).unwrap();
    let error = smoother.operator(weights, &[20.0 * CUBE]).unwrap_err();
    // 27 cells hold 17.28 cell volumes.
    let SmootherError::DoesNotFit {
        left_over,
        cells,
        lower,
        upper,
        mean,
        unsettled,
        ..
    } = error
    else {
        panic!("{error}");
    };
    assert!((left_over / (2.72 * CUBE) - 1.0).abs() < 1e-12);
    assert_eq!((cells, unsettled), (27, false));
    assert!((lower - Vec3::repeat(0.5e-3)).norm() < 1e-15);
    assert!((upper - Vec3::repeat(2.5e-3)).norm() < 1e-15);
    assert!((mean - 20.0 / 27.0).abs() < 1e-12);
}

#[test]
fn nothing_is_moved_into_excluded_cells() {
    let mesh = cubes([7, 7, 7]);
    let middle = 3 + 7 * (3 + 7 * 3);
    // The upper neighbours of the middle are a duct.
    let excluded: Vec<bool> = (0..343).map(|cell| cell / 49 == 4).collect();
    let smoother = Smoother::with_excluded(&mesh, settings(), &excluded).unwrap();
    let weights = Weights::new(343, vec![vec![(middle, 1.0)]]).unwrap();
    let operator = smoother.operator(weights, &[5.0 * CUBE]).unwrap();
    let alpha = operator.solid_fraction();
    assert!((196..343).all(|cell| alpha[cell] == 0.0));
    assert!((alpha.iter().sum::<f64>() - 5.0).abs() < 5e-14);
    // Solid in an excluded cell has nowhere to go.
    let weights = Weights::new(343, vec![vec![(200, 1.0)]]).unwrap();
    let error = smoother.operator(weights, &[0.8 * CUBE]).unwrap_err();
    assert!(matches!(error, SmootherError::DoesNotFit { cells: 1, .. }));
}

#[test]
fn the_defaults_are_random_close_packing_and_an_excess_of_one_in_ten_thousand() {
    let expected = SmootherSettings {
        max_solid_fraction: 0.64,
        tolerance: 1e-4,
        diffusion_length: None,
    };
    assert_eq!(SmootherSettings::default(), expected);
}

#[test]
fn settings_outside_their_range_are_refused() {
    let mesh = cubes([2, 2, 2]);
    let refused = |change: fn(&mut SmootherSettings)| {
        let mut settings = settings();
        change(&mut settings);
        Smoother::new(&mesh, settings).unwrap_err()
    };
    let error = refused(|s| s.max_solid_fraction = 1.0);
    assert_eq!(error, SmootherError::MaxSolidFraction(1.0));
    assert!(matches!(
        refused(|s| s.tolerance = 0.4),
        SmootherError::Tolerance { .. }
    ));
    assert!(matches!(
        refused(|s| s.tolerance = f64::NAN),
        SmootherError::Tolerance { .. }
    ));
    let with_length = |length: f64| {
        let diffusion_length = Some(length);
        Smoother::new(
            &mesh,
            SmootherSettings {
                diffusion_length,
                ..settings()
            },
        )
        .unwrap_err()
    };
    for length in [-1.0, f64::INFINITY, f64::NAN] {
        assert!(matches!(with_length(length), SmootherError::NoLength(_)));
    }
    // A kilometre over cells of 1 mm: 2 l^2 times the conductances of 3 faces over the volume.
    let SmootherError::DiffusionLength { steps, .. } = with_length(1e3) else {
        panic!("{}", with_length(1e3));
    };
    assert!((steps / 6e12 - 1.0).abs() < 1e-9, "{steps}");
    let smoother = Smoother::new(&mesh, settings()).unwrap();
    let weights = || Weights::new(8, vec![vec![(0, 1.0)]]).unwrap();
    let error = smoother.operator(weights(), &[-1.0]).unwrap_err();
    assert_eq!(
        error,
        SmootherError::SolidVolume {
            particle: 0,
            volume: -1.0
        }
    );
    assert!(smoother.operator(weights(), &[]).is_err());
}

/// A region that is full to within a quarter of the tolerance is smoothed, one beyond is refused:
/// VFS-5 leaves out no bed that fits.
#[test]
fn a_bed_fits_until_it_is_full_to_within_a_quarter_of_the_tolerance() {
    let mesh = cubes([6, 6, 40]);
    let smoother = Smoother::new(&mesh, settings()).unwrap();
    let attempt = |mean: f64| {
        let rows = (0..mesh.cells()).map(|cell| vec![(cell as u32, 1.0)]);
        let weights = Weights::new(mesh.cells(), rows.collect()).unwrap();
        // The lower half holds three times as much as the upper.
        let of = |cell| if cell < 720 { 1.5 } else { 0.5 };
        let solid: Vec<f64> = (0..mesh.cells())
            .map(|cell| of(cell) * mean * CUBE)
            .collect();
        smoother.operator(weights, &solid)
    };
    for mean in [0.639, 0.64, 0.64 * (1.0 + 0.2e-4)] {
        let operator = attempt(mean).unwrap();
        let alpha = operator.solid_fraction();
        let highest = alpha.iter().copied().fold(0.0, f64::max);
        assert!(highest <= 0.64 + 1e-4, "{mean}: {highest}");
    }
    let error = attempt(0.64 * (1.0 + 0.3e-4)).unwrap_err();
    let SmootherError::DoesNotFit { left_over, .. } = error else {
        panic!("{error}");
    };
    let expected = 0.64 * 0.3e-4 * 1440.0 * CUBE;
    assert!((left_over / expected - 1.0).abs() < 1e-6, "{left_over}");
}
