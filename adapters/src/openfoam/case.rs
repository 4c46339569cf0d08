//! The OpenFOAM case that calcineGasFoam runs in.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::mesh::{Mesh, polymesh};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::setup::{GasPatch, GasSetup, GasStart};
use calcine_wire::Catalogue;

use super::names::{NAME, SOLVER};
use super::start_fields::StartFields;
use super::stock::{self, StockSolver};
use super::{chemistry, decompose, dictionaries, species, turbulence};
use crate::launch::without_blanks;

/// What an OpenFOAM case is made from.
#[derive(Clone, Copy, Debug)]
pub struct OpenfoamCase<'a> {
    /// The gas.
    pub setup: &'a GasSetup,
    /// The mesh of the undecomposed domain.
    pub mesh: &'a Mesh,
    /// A folder whose files are taken over where the case does not speak.
    pub template: Option<&'a Path>,
    /// A time directory that OpenFOAM wrote on the same mesh, whose fields the gas starts from.
    pub start: Option<&'a Path>,
    /// Fields of a gas of another solver that the gas starts from, in place of the directory's.
    pub gas: Option<&'a GasStart>,
    /// Which program computes the gas.
    pub solver: StockSolver,
    /// The library that a stock solver opens.
    pub library: &'a Path,
    /// Hash of the case, compared in the handshake.
    pub case_hash: &'a str,
    /// Number of ranks; how the mesh is divided among more than one is written too.
    pub ranks: u32,
}

impl OpenfoamCase<'_> {
    /// Writes the case into a folder, which is made if it is not there.
    pub fn write(&self, folder: &Path) -> Result<(), PartError> {
        self.check()?;
        let catalogue = self.catalogue();
        make(folder)?;
        if let Some(template) = self.template {
            copy(template, folder)?;
        }
        for (name, text) in self.solver.defaults() {
            if self.template.is_none_or(|own| !own.join(name).is_file()) {
                let text = dictionaries::schemes(text, self.setup.controls.convection);
                put(&folder.join(name), &suited(&text, self.mesh))?;
            }
        }
        let setup = self.setup;
        let names = setup.properties.species();
        let start = match (self.gas, self.start) {
            (Some(gas), _) => StartFields::of(gas, names),
            (None, Some(folder)) => StartFields::read(folder, names, self.mesh.cells())?,
            (None, None) => StartFields::default(),
        };
        if self.solver.is_stock() {
            self.write_stock(folder, &start)?;
        } else {
            self.write_own(folder, &start)?;
        }
        for (name, text) in [
            (
                "constant/thermophysicalProperties",
                dictionaries::thermophysical(setup, self.solver),
            ),
            ("constant/g", dictionaries::gravity(setup)),
            (
                "constant/calcineGas",
                dictionaries::calcine(setup, self.case_hash, &catalogue),
            ),
            ("constant/calcineCells", dictionaries::cells(self.mesh)),
        ] {
            put(&folder.join(name), &text)?;
        }
        for (k, name) in names.iter().enumerate() {
            let fraction = start.applied(name, species::fraction(setup, k, name));
            put(&folder.join("0").join(name), &fraction)?;
        }
        self.write_chemistry(folder)?;
        if self.ranks > 1 {
            self.divide(folder)?;
        }
        let poly_mesh = folder.join("constant/polyMesh");
        polymesh::write_with(self.mesh, &poly_mesh, |name| self.kind(name)).map_err(|error| {
            let message = format!("the mesh cannot be written to {}", poly_mesh.display());
            PartError::new(NAME, FailureKind::Io, message).caused_by(error)
        })
    }

    /// Columns of the link. calcineGasFoam reports how it solved the equations of turbulence, be they the case's or a
    /// template's.
    pub(super) fn catalogue(&self) -> Catalogue {
        let turbulent = !self.setup.turbulence.is_laminar();
        let species = self.setup.properties.species().len();
        let mut catalogue = Catalogue::gas(species, turbulent);
        if self.setup.turbulence.is_in_bed() {
            catalogue = catalogue.with_bed_eddies();
        }
        if !self.solver.is_stock() && dictionaries::tells_backflow(self.setup) {
            catalogue = catalogue.with_backflow_report();
        }
        if !self.solver.is_stock() {
            catalogue = catalogue.with_patch_report(species, self.mesh.patches().len());
        }
        let models = |folder: &Path| folder.join("constant/turbulenceProperties").is_file();
        match !self.solver.is_stock() && (turbulent || self.template.is_some_and(models)) {
            true => catalogue.with_turbulence_report(),
            false => catalogue,
        }
    }

    fn write_own(&self, folder: &Path, start: &StartFields) -> Result<(), PartError> {
        let setup = self.setup;
        let control = dictionaries::control(SOLVER, &self.beside(folder, "system/controlDict")?);
        for (name, text) in [
            ("system/controlDict", control),
            ("0/U", start.applied("U", dictionaries::velocity(setup))),
            ("0/T", start.applied("T", dictionaries::temperature(setup))),
            ("0/p", start.applied("p", dictionaries::pressure(setup))),
        ] {
            put(&folder.join(name), &text)?;
        }
        if setup.turbulence.is_laminar() {
            return Ok(());
        }
        let options = self.beside(folder, "constant/fvOptions")?;
        for (name, text) in turbulence::files(setup, &options) {
            put(&folder.join(name), &text)?;
        }
        Ok(())
    }

    /// Reactions of the gas, for calcineGasFoam alone.
    fn write_chemistry(&self, folder: &Path) -> Result<(), PartError> {
        let setup = self.setup;
        let GasModel::Mixture(mixture) = &setup.properties else {
            return Ok(());
        };
        let Some(gas) = setup.chemistry.reacting() else {
            return Ok(());
        };
        let files = chemistry::files(setup, mixture, gas)
            .map_err(|error| PartError::new(NAME, FailureKind::Refused, error.to_string()))?;
        for (name, text) in files {
            put(&folder.join(name), &text)?;
        }
        Ok(())
    }

    fn write_stock(&self, folder: &Path, start: &StartFields) -> Result<(), PartError> {
        let setup = self.setup;
        let include = self.beside(folder, "system/controlDict")?;
        let library = without_blanks(self.library, folder).map_err(|error| {
            let message = "its library cannot be linked in its folder";
            PartError::new(NAME, FailureKind::Io, message).caused_by(error)
        })?;
        let control = stock::control(self.solver, &include, &library.to_string_lossy());
        let options = stock::options(&self.beside(folder, "constant/fvOptions")?);
        let velocity = start.applied("U", stock::velocity(setup));
        let temperature = start.applied("T", stock::temperature(setup));
        for (name, text) in [
            ("system/controlDict", control),
            ("constant/fvOptions", options),
            ("0/U", velocity),
            ("0/T", temperature),
        ] {
            put(&folder.join(name), &text)?;
        }
        for (name, text) in stock::pressures(self.solver, setup) {
            put(&folder.join("0").join(name), &start.applied(name, text))?;
        }
        if self.solver == StockSolver::ReactingFoam {
            for (name, text) in stock::reacting(setup) {
                put(&folder.join(name), &text)?;
            }
        }
        let turbulence = folder.join("constant/turbulenceProperties");
        if !turbulence.is_file() {
            put(&turbulence, &stock::laminar())?;
        }
        Ok(())
    }

    /// OpenFOAM's wall functions ask for patches of the type `wall`.
    fn kind(&self, patch: &str) -> &'static str {
        let condition = self.setup.patches.iter().find(|(name, _)| name == patch);
        match condition {
            Some((_, GasPatch::Wall { .. })) => "wall",
            Some((_, GasPatch::Empty)) => "empty",
            Some((_, GasPatch::Wedge)) => "wedge",
            _ => "patch",
        }
    }

    /// A template's own file of a dictionary that we write goes beside ours; the words by which ours includes
    /// it, so that its `libs` (or fvOptions) stay, and what the coordinator drives is ours.
    fn beside(&self, folder: &Path, name: &str) -> Result<String, PartError> {
        let own = self.template.map(|template| template.join(name));
        let Some(own) = own.filter(|path| path.is_file()) else {
            return Ok(String::new());
        };
        let beside = format!("{name}.template");
        fs::copy(&own, folder.join(&beside)).map_err(failed(&own, "copied"))?;
        let file = Path::new(&beside).file_name().unwrap_or_default();
        Ok(format!("#include \"{}\"\n\n", file.to_string_lossy()))
    }

    /// How the mesh is divided: Calcine's own way, or as a template's `decomposeParDict` says.
    fn divide(&self, folder: &Path) -> Result<(), PartError> {
        let cells = self.mesh.cells();
        if self.ranks as usize > cells {
            let ranks = self.ranks;
            let message = format!("{ranks} ranks cannot share {cells} cells; use fewer ranks");
            return Err(PartError::new(NAME, FailureKind::NotStarted, message));
        }
        let own = |template: &Path| template.join(decompose::DICTIONARY).is_file();
        if self.template.is_some_and(own) {
            return Ok(());
        }
        put(
            &folder.join(decompose::DICTIONARY),
            &dictionaries::decompose(self.ranks),
        )?;
        let mut ranks = decompose::divide(self.mesh.cell_centre(), self.ranks);
        decompose::keep_pairs(self.mesh, &mut ranks);
        put(
            &folder.join("constant").join(decompose::DATA),
            &dictionaries::labels(decompose::DATA, &ranks),
        )
    }

    /// Every patch of the mesh needs its condition, and every condition its patch; the program must have what the
    /// gas needs, whichever clock it runs by.
    fn check(&self) -> Result<(), PartError> {
        let refuse = |message: String| Err(PartError::new(NAME, FailureKind::Refused, message));
        if self.solver.is_stock()
            && let Some(why) = stock::refusal(self.solver, self.setup, false)
        {
            let name = self.solver.name();
            return refuse(format!("{name} cannot compute this gas: {why}"));
        }
        for (name, _) in &self.setup.patches {
            if self.mesh.patch(name).is_none() {
                return refuse(format!("the mesh has no patch `{name}`"));
            }
            if odd_name(name) {
                return refuse(format!("OpenFOAM cannot have a patch named `{name}`"));
            }
        }
        for patch in self.mesh.patches() {
            if !self
                .setup
                .patches
                .iter()
                .any(|(name, _)| *name == patch.name)
            {
                return refuse(format!("patch `{}` has no boundary condition", patch.name));
            }
        }
        Ok(())
    }
}

/// Default schemes for a mesh: where every line between two centres, and from a centre to a face of the boundary, is normal to its face
/// and passes through the face's centre, corrections for other lines are zero and gradients by Gauss' theorem exact; leaving
/// corrections out saves a fifth of the solver's time.
fn suited(schemes: &str, mesh: &Mesh) -> String {
    if !(0..mesh.faces()).all(|face| is_straight(mesh, face)) {
        return schemes.to_owned();
    }
    [
        ("calcineLeastSquares;", "Gauss linear;"),
        ("calcineCorrected;", "orthogonal;"),
        ("corrected;", "orthogonal;"),
    ]
    .iter()
    .fold(schemes.to_owned(), |text, (oblique, straight)| {
        text.replace(oblique, straight)
    })
}

/// Whether the ways from a face's centre to those of its cells are normal to it.
fn is_straight(mesh: &Mesh, face: usize) -> bool {
    let owner = mesh.owner()[face] as usize;
    let (normal, centre) = (mesh.face_area()[face].normalize(), mesh.face_centre()[face]);
    let inner = centre - mesh.cell_centre()[owner];
    let outer = mesh.beyond(owner, face).map_or_else(Vec3::zeros, |beyond| {
        mesh.cell_centre()[beyond.cell] + beyond.shift - centre
    });
    let distance = normal.dot(&(inner + outer));
    let skew = |way: Vec3| (way - way.dot(&normal) * normal).norm();
    skew(inner).max(skew(outer)) <= 1e-9 * distance
}

/// A name that OpenFOAM does not read as one word.
pub(super) fn odd_name(name: &str) -> bool {
    let odd = |c: char| c.is_whitespace() || "\"'/;{}()".contains(c);
    name.is_empty() || name.contains(odd)
}

fn failed<'a>(path: &'a Path, doing: &'a str) -> impl Fn(io::Error) -> PartError + 'a {
    move |error| {
        let message = format!("{} cannot be {doing}", path.display());
        PartError::new(NAME, FailureKind::Io, message).caused_by(error)
    }
}

fn make(folder: &Path) -> Result<(), PartError> {
    fs::create_dir_all(folder).map_err(failed(folder, "made"))
}

pub(super) fn put(path: &Path, text: &str) -> Result<(), PartError> {
    if let Some(folder) = path.parent() {
        make(folder)?;
    }
    fs::write(path, text).map_err(failed(path, "written"))
}

/// Copies a template's files, folder by folder.
fn copy(from: &Path, to: &Path) -> Result<(), PartError> {
    make(to)?;
    let entries = fs::read_dir(from).map_err(failed(from, "read (the template)"))?;
    let mut paths: Vec<PathBuf> = Vec::new();
    for entry in entries {
        paths.push(entry.map_err(failed(from, "read (the template)"))?.path());
    }
    for path in paths {
        let Some(name) = path.file_name() else {
            continue;
        };
        let target = to.join(name);
        if path.is_dir() {
            copy(&path, &target)?;
        } else {
            fs::copy(&path, &target).map_err(failed(&path, "copied"))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
    use calcine_coupler::physics::gas::GasProperties;
    use calcine_coupler::setup::{Convection, GasControls, Schedule, WallHeat, WallVelocity};
    use calcine_coupler::time::GasStorage;

    fn mesh() -> Mesh {
        box_mesh(&BoxSpec {
            origin: Vec3::zeros(),
            size: Vec3::new(0.1, 0.1, 0.3),
            cells: [1, 1, 3],
            patches: ["side", "side", "side", "side", "bottom", "top"].map(str::to_owned),
        })
        .unwrap()
    }

    fn setup() -> GasSetup {
        let temperature = Schedule(vec![(0.0, 300.0), (10.0, 1.0 / 3e-3)]);
        let inlet = GasPatch::inlet(Schedule::constant(0.1), temperature);
        let wall = GasPatch::Wall {
            velocity: WallVelocity::Slip,
            heat: WallHeat::Adiabatic,
        };
        let outlet = GasPatch::outlet(Schedule::constant(101_325.0));
        let patches = [("side", wall), ("bottom", inlet), ("top", outlet)];
        GasSetup {
            mixture: "air".into(),
            properties: GasProperties::air().into(),
            schmidt: 1.0,
            chemistry: Default::default(),
            composition: Vec::new(),
            storage: GasStorage::Process,
            temperature: 300.0,
            pressure: 101_325.0,
            velocity: Vec3::zeros(),
            gravity: Vec3::zeros(),
            pressure_gradient: Vec3::zeros(),
            turbulence: Default::default(),
            momentum: Default::default(),
            patches: patches.map(|(name, patch)| (name.to_owned(), patch)).into(),
            controls: GasControls {
                outer_iterations: 3,
                convection: Convection::Upwind,
                pressure_corrections: 2,
                time_scheme: Default::default(),
                most_pressure_corrections: 16,
                outer_tolerance: 1e-6,
                linear_tolerance: Some(1e-10),
            },
        }
    }

    #[test]
    fn a_template_s_own_files_stay_where_the_case_does_not_speak() {
        let folder = tempfile::tempdir().unwrap();
        let template = folder.path().join("template");
        for (name, text) in [
            ("system/fvSchemes", "mine"),
            ("0/p", "mine"),
            ("extra", "mine"),
        ] {
            put(&template.join(name), text).unwrap();
        }
        let (setup, mesh) = (setup(), mesh());
        let case = OpenfoamCase {
            setup: &setup,
            mesh: &mesh,
            template: Some(&template),
            start: None,
            gas: None,
            solver: StockSolver::default(),
            library: Path::new("libcalcineFoam.so"),
            case_hash: "0a",
            ranks: 1,
        };
        let written = folder.path().join("case");
        case.write(&written).unwrap();
        let read = |name: &str| fs::read_to_string(written.join(name)).unwrap();
        assert_eq!(read("system/fvSchemes"), "mine");
        assert_eq!(read("extra"), "mine");
        assert!(read("0/p").contains("fixedValue"));
        assert!(read("system/fvSolution").contains("PBiCGStab"));
        assert!(read("constant/polyMesh/boundary").contains("bottom"));
    }

    #[test]
    fn a_box_s_schemes_are_without_the_correction_that_a_sheared_mesh_needs() {
        let text = StockSolver::default().defaults()[0].1;
        let straight = suited(text, &mesh());
        assert!(
            straight.contains("Gauss linear orthogonal;") && straight.contains(" Gauss linear;")
        );
        assert!(!straight.contains("default         calcine"));
        let mut sheared = mesh().topology().clone();
        for point in &mut sheared.points {
            point.x += 0.2 * point.z;
        }
        let sheared = Mesh::new(sheared).unwrap();
        assert_eq!(suited(text, &sheared), text);
    }

    #[test]
    fn a_mesh_for_two_ranks_is_divided_and_for_more_ranks_than_cells_refused() {
        let folder = tempfile::tempdir().unwrap();
        let (setup, mesh) = (setup(), mesh());
        let case = |ranks| OpenfoamCase {
            setup: &setup,
            mesh: &mesh,
            template: None,
            start: None,
            gas: None,
            solver: StockSolver::default(),
            library: Path::new("libcalcineFoam.so"),
            case_hash: "0a",
            ranks,
        };
        case(2).write(folder.path()).unwrap();
        let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
        assert!(read("system/decomposeParDict").contains("numberOfSubdomains 2;"));
        assert!(read("constant/cellDecomposition").ends_with("3\n(\n0\n0\n1\n)\n"));
        let error = case(4).write(folder.path()).unwrap_err().to_string();
        assert!(error.contains("4 ranks cannot share 3 cells"), "{error}");
    }

    #[test]
    fn numbers_are_written_with_all_their_bits() {
        let text = dictionaries::calcine(&setup(), "0a", &Catalogue::standard("gas").unwrap());
        let third = text
            .split_whitespace()
            .find(|word| word.starts_with("3.33"))
            .unwrap();
        let third = third.trim_end_matches([')', ';']);
        assert_eq!(third.parse::<f64>().unwrap(), 1.0 / 3e-3);
    }

    #[test]
    fn a_patch_without_a_condition_and_a_condition_without_a_patch_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let mesh = mesh();
        let refusal = |setup: &GasSetup| {
            let case = OpenfoamCase {
                setup,
                mesh: &mesh,
                template: None,
                start: None,
                gas: None,
                solver: StockSolver::default(),
                library: Path::new("libcalcineFoam.so"),
                case_hash: "0a",
                ranks: 1,
            };
            case.write(folder.path()).unwrap_err().to_string()
        };
        let mut lacking = setup();
        lacking.patches.pop();
        assert!(refusal(&lacking).contains("patch `top` has no boundary condition"));
        let mut foreign = setup();
        foreign.patches[0].0 = "lid".into();
        assert!(refusal(&foreign).contains("the mesh has no patch `lid`"));
    }
}
