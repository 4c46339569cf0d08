//! The OpenFOAM case that calcineParcelFoam runs in.

use std::fmt::Write;
use std::path::Path;

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::mesh::{Mesh, polymesh};
use calcine_coupler::motion::{Motion, WallMotion};
use calcine_coupler::parcels::{ParcelMotion, ParcelPacking, ParcelWall};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::parcels::HarrisCrighton;
use calcine_coupler::setup::ParticleSetup;
use calcine_wire::Catalogue;

use super::case::{odd_name, put};
use super::dictionaries;
use super::foam_file::{fixed, header, turning, vector};
use super::names::{PARCEL_PROGRAM as PROGRAM, PARCELS as NAME};

/// Least solid fraction, and density in kg/m³, that the implicit packing takes for a cell: those of OpenFOAM's own cases.
const LEAST: [f64; 2] = [1e-4, 1.0];
/// `motion.parcels.floor` of the implicit packing at least, that of OpenFOAM's own cases: a smaller one makes its corrections of
/// velocity swing about close packing, and a bed boils.
const LEAST_FLOOR: f64 = 1e-2;
/// `system/fvSchemes`, for the implicit packing.
const SCHEMES: &str = "ddtSchemes { default Euler; }\ngradSchemes { default Gauss linear; }\ndivSchemes { default none; }\n\
                       laplacianSchemes { default Gauss linear corrected; }\ninterpolationSchemes { default linear; }\n\
                       snGradSchemes { default corrected; }\n";
/// `system/fvSolution`: the solid fraction of the implicit packing is solved to round-off.
const SOLUTION: &str = "solvers\n{\n    \"parcels:alpha\"\n    {\n        solver          PCG;\n        preconditioner  DIC;\n        \
                        tolerance       1e-10;\n        relTol          0;\n    }\n}\n";

/// What the case is made from.
#[derive(Clone, Copy, Debug)]
pub struct ParcelCase<'a> {
    /// The parcels.
    pub setup: &'a ParticleSetup,
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Whether drag comes by coefficient and gas velocity.
    pub moving_drag: bool,
    /// Hash of the case, compared in the handshake.
    pub case_hash: &'a str,
    /// Number of ranks.
    pub ranks: u32,
}

impl ParcelCase<'_> {
    /// Refuses what OpenFOAM's cloud cannot do.
    pub fn check(&self) -> Result<(), PartError> {
        self.motion().map(|_| ())
    }

    /// How the parcels move.
    fn motion(&self) -> Result<&ParcelMotion, PartError> {
        let refuse = |message: &str| Err(PartError::new(NAME, FailureKind::Refused, message));
        let Motion::Parcels(motion) = &self.setup.motion else {
            return refuse(
                "the particles are no parcels, and OpenFOAM's cloud has neither contacts between particles nor particles that are \
                 held: write [motion.parcels] and motion = \"parcels\", or run them natively (`--particles native`) or by LIGGGHTS \
                 (`--particles liggghts`)",
            );
        };
        if motion.friction.is_some() {
            return refuse(
                "OpenFOAM's cloud has no friction within the bed: leave `motion.parcels.friction` out, or move the parcels natively \
                 (`--particles native`)",
            );
        }
        if motion.resistance.is_some() {
            return refuse(
                "OpenFOAM's cloud has no resistance against a wall: leave `motion.parcels.resistance` out, or move the parcels \
                 natively (`--particles native`)",
            );
        }
        if let ParcelPacking::Implicit(law) = &motion.packing
            && law.floor < LEAST_FLOOR
        {
            let message = format!(
                "`motion.parcels.floor` is {:e}, and the implicit packing of OpenFOAM's cloud throws parcels about close packing with less \
                 than {LEAST_FLOOR:e}: write floor = {LEAST_FLOOR} (native parcels stay below close packing with any)",
                law.floor
            );
            return refuse(&message);
        }
        if self.ranks > 1 {
            return refuse(
                "OpenFOAM's parcels are coupled on one rank only: leave `--ranks-particles` out",
            );
        }
        for patch in self.mesh.patches() {
            if odd_name(&patch.name) {
                let message = format!("OpenFOAM cannot have a patch named `{}`", patch.name);
                return refuse(&message);
            }
        }
        Ok(motion)
    }

    /// Columns of the link.
    pub fn catalogue(&self) -> Catalogue {
        Catalogue::particles_with(!self.setup.weight.is_empty(), self.moving_drag)
    }

    /// Writes the case into a folder, which is made if it is not there.
    pub fn write(&self, folder: &Path) -> Result<(), PartError> {
        let motion = self.motion()?;
        for (name, text) in [
            ("system/controlDict", dictionaries::control(PROGRAM, "")),
            (
                "system/fvSchemes",
                header("dictionary", "fvSchemes") + SCHEMES,
            ),
            (
                "system/fvSolution",
                header("dictionary", "fvSolution") + SOLUTION,
            ),
            ("constant/calcineParcels", self.calcine(motion)),
            ("constant/calcineCells", dictionaries::cells(self.mesh)),
            ("constant/calcineParcelRows", self.rows()),
            ("constant/parcelsProperties", cloud(motion)),
            ("0/U", self.walls(motion)),
        ] {
            put(&folder.join(name), &text)?;
        }
        let poly_mesh = folder.join("constant/polyMesh");
        // Parcels rebound from every patch, those through which gas flows too.
        polymesh::write_with(self.mesh, &poly_mesh, |_| "wall").map_err(|error| {
            let message = format!("the mesh cannot be written to {}", poly_mesh.display());
            PartError::new(NAME, FailureKind::Io, message).caused_by(error)
        })
    }

    /// `constant/calcineParcels`: what only calcineParcelFoam reads.
    fn calcine(&self, motion: &ParcelMotion) -> String {
        let mut text = header("dictionary", "calcineParcels");
        let _ = write!(
            text,
            "caseHash        \"{}\";\n\
             // Gravity in m/s^2.\ngravity         {};\n\n\
             // Columns of the link to Calcine.\ncatalogue\n(\n",
            self.case_hash,
            vector(motion.gravity)
        );
        for column in self.catalogue().fields() {
            let _ = writeln!(text, "    \"{column}\"");
        }
        text + ");\n"
    }

    /// `constant/calcineParcelRows`: ids, populations, positions, velocities, diameters, densities, weights.
    fn rows(&self) -> String {
        let setup = self.setup;
        let rows = || 0..setup.id.len();
        let velocity = |row: usize| setup.velocity.get(row).copied().unwrap_or_default();
        let columns: [Vec<String>; 7] = [
            rows().map(|row| setup.id[row].to_string()).collect(),
            rows()
                .map(|row| setup.population[row].to_string())
                .collect(),
            rows()
                .map(|row| exact_vector(setup.position[row]))
                .collect(),
            rows().map(|row| exact_vector(velocity(row))).collect(),
            rows().map(|row| exact(2.0 * setup.radius[row])).collect(),
            rows().map(|row| exact(setup.density[row])).collect(),
            rows().map(|row| exact(setup.weight_of(row))).collect(),
        ];
        let mut text = String::new();
        for column in columns {
            let _ = writeln!(text, "{}\n(\n{}\n)", column.len(), column.join("\n"));
        }
        text
    }

    /// `0/U`: the velocities of walls.
    fn walls(&self, motion: &ParcelMotion) -> String {
        let mut text = header("volVectorField", "U");
        text += "dimensions      [0 1 -1 0 0 0 0];\n\ninternalField   uniform (0 0 0);\n\nboundaryField\n{\n";
        for patch in self.mesh.patches() {
            let wall = motion.walls.iter().find(|wall| wall.patch == patch.name);
            let condition = match wall.map(|wall| &wall.motion) {
                Some(WallMotion::Translating(velocity)) => fixed(&vector(*velocity)),
                Some(WallMotion::Rotating {
                    point,
                    angular_velocity,
                }) => turning(*point, *angular_velocity),
                Some(_) => fixed("(0 0 0)"),
                None => "type            cyclic;".to_owned(),
            };
            let _ = writeln!(
                text,
                "    {}\n    {{\n        {condition}\n    }}",
                patch.name
            );
        }
        text + "}\n"
    }
}

/// A number that OpenFOAM reads as the same bits; the shortest digits may become a neighbour.
fn exact(value: f64) -> String {
    format!("{value:.19e}")
}

fn exact_vector(v: Vec3) -> String {
    format!("({} {} {})", exact(v.x), exact(v.y), exact(v.z))
}

/// `constant/parcelsProperties`: the cloud.
fn cloud(motion: &ParcelMotion) -> String {
    let times = &motion.collisions.times;
    let scale = |kind: &str| {
        format!(
            "timeScaleModel {{ type {kind}; alphaPacked {:e}; e {:e}; }}",
            times.close_packing, times.restitution
        )
    };
    let chosen = |on: bool, name: &'static str| if on { name } else { "none" };
    header("dictionary", "parcelsProperties")
        + &format!(
            "solution\n{{\n    active          yes;\n    coupled         yes;\n    transient       yes;\n    \
             cellValueSourceCorrection off;\n    maxCo           {:e};\n    \
             interpolationSchemes {{ rho cell; U cell; mu cell; }}\n    averagingMethod dual;\n    \
             integrationSchemes {{ U analytical; }}\n    sourceTerms {{ schemes {{ U semiImplicit 1; }} }}\n}}\n\n\
             constantProperties\n{{\n    rho0            1;\n}}\n\n\
             subModels\n{{\n    particleForces {{ calcinePush; }}\n    injectionModels {{}}\n    dispersionModel none;\n    \
             surfaceFilmModel none;\n    stochasticCollisionModel none;\n    \
             patchInteractionModel calcineWalls;\n    calcineWallsCoeffs\n    {{\n        patches\n        {{\n{}        }}\n    }}\n\n    \
             packingModel    {};\n\n    dampingModel    {};\n    relaxationCoeffs {{ {} }}\n\n    \
             isotropyModel   {};\n    calcineDrawnCoeffs {{ seed \"{}\"; {} }}\n}}\n\ncloudFunctions {{}}\n",
            motion.courant,
            motion.walls.iter().map(impacts).collect::<String>(),
            packing(&motion.packing),
            chosen(motion.collisions.damping, "relaxation"),
            scale("nonEquilibrium"),
            chosen(motion.collisions.isotropy, "calcineDrawn"),
            motion.collisions.seed,
            scale("isotropic"),
        )
}

fn impacts(wall: &ParcelWall) -> String {
    let list = |values: Vec<f64>| {
        let values: Vec<String> = values.iter().map(|value| format!("{value:e}")).collect();
        format!("({})", values.join(" "))
    };
    format!(
        "            {} {{ restitution {}; friction {}; }}\n",
        wall.patch,
        list(wall.impact.iter().map(|one| one.restitution).collect()),
        list(wall.impact.iter().map(|one| one.friction).collect())
    )
}

/// The packing model with its coefficients.
fn packing(packing: &ParcelPacking) -> String {
    let stress = |law: &HarrisCrighton| {
        format!(
            "particleStressModel {{ type HarrisCrighton; alphaPacked {:e}; pSolid {:e}; beta {:e}; eps {:e}; }}",
            law.close_packing, law.pressure, law.exponent, law.floor
        )
    };
    let [fraction, density] = LEAST;
    match packing {
        ParcelPacking::None => "none".into(),
        ParcelPacking::Implicit(law) => format!(
            "implicit;\n    implicitCoeffs\n    {{\n        alphaMin        {fraction:e};\n        rhoMin          {density:e};\n        \
             applyLimiting   yes;\n        applyGravity    no;\n        {}\n    }}",
            stress(law)
        ),
        ParcelPacking::Explicit {
            stress: law,
            restitution,
        } => format!(
            "explicit;\n    explicitCoeffs\n    {{\n        {}\n        correctionLimitingMethod {{ type absolute; e {restitution:e}; }}\n    }}",
            stress(law)
        ),
    }
}
