//! What external solvers say as they end, what it means, and what helps.
//!
//! Solvers fail in words of their own: the error shows the end of their log, and these sentences add what a user of the case can do. The
//! fixtures in `adapters/tests/last_words` are ends of such logs.

use calcine_coupler::error::{FailureKind, PartError};

/// Words in the log of a solver, with what they mean and what helps.
struct Saying {
    /// All of them stand in the error's message or in the end of the log, in any case of letters.
    words: &'static [&'static str],
    /// What it means, and what helps.
    remedy: &'static str,
}

/// What OpenFOAM says; the first that fits counts.
const OPENFOAM: &[Saying] = &[
    Saying {
        words: &["bad_alloc"],
        remedy: "the machine has too little memory for this mesh: take fewer cells, or more ranks on more machines",
    },
    Saying {
        words: &["foam fatal", "unknown ", "valid "],
        remedy: "a dictionary asks for a model that this OpenFOAM does not have; the log lists those that it has: write one of them in the template",
    },
    Saying {
        words: &["foam fatal io error", "not found in dictionary"],
        remedy: KEY,
    },
    Saying {
        words: &["foam fatal io error", "is undefined in dictionary"],
        remedy: "a dictionary lacks the key that the log names: of a template of yours (`openfoam.template`) add it there; else write the inputs with \
                 `calcine prepare` and look at that file",
    },
    Saying {
        words: &["foam fatal io error"],
        remedy: "OpenFOAM cannot read the file that the log names: of a template of yours (`openfoam.template`) mend it there; else look at what \
                 `calcine prepare` writes",
    },
    Saying {
        words: &["maximum number of iterations exceeded"],
        remedy: "OpenFOAM finds no temperature for the enthalpy of a cell: the gas left the range of its data; shorten `time.motion_window`, and see \
                 where `calcine check` warns of temperatures",
    },
    Saying {
        words: &["cannot find file"],
        remedy: "a file that OpenFOAM needs is not there: of a template of yours (`openfoam.template`) add it; a checkpoint that lost files is left out \
                 with --resume in favour of the one before",
    },
    Saying {
        words: &["sigfpe::sighandler"],
        remedy: DIVERGED,
    },
    Saying {
        words: &["signal: floating point exception"],
        remedy: DIVERGED,
    },
    Saying {
        words: &["no space left on device"],
        remedy: FULL,
    },
    Saying {
        words: &["foam fatal error"],
        remedy: "the log says what OpenFOAM stumbled over; where a number left what is physical, a shorter `time.motion_window` helps, and \
                 --gas native runs the same case without OpenFOAM",
    },
];

/// What LIGGGHTS says.
const LIGGGHTS: &[Saying] = &[
    Saying {
        words: &["left the box"],
        remedy: LOST,
    },
    Saying {
        words: &["lost atoms"],
        remedy: LOST,
    },
    Saying {
        words: &["out of range atoms"],
        remedy: LOST,
    },
    Saying {
        words: &["non-numeric"],
        remedy: LOST,
    },
    Saying {
        words: &["neighbor list overflow"],
        remedy: "more particles are near one than LIGGGHTS' lists hold: many lie within each other, or sizes are very different; look at \
                 `calcine check`, or raise `neigh_modify one` and `page` in a script of your own (`liggghts.template`)",
    },
    Saying {
        words: &["failed to allocate"],
        remedy: "the machine has too little memory: take fewer particles, or more ranks on more machines",
    },
    Saying {
        words: &["failed to reallocate"],
        remedy: "the machine has too little memory: take fewer particles, or more ranks on more machines",
    },
    Saying {
        words: &["cannot open"],
        remedy: "LIGGGHTS cannot open the file that the log names: paths of a script (`liggghts.template`) are relative to it",
    },
    Saying {
        words: &["mesh", "elements"],
        remedy: "LIGGGHTS refuses the surface that the log names: mend the STL file of that wall (triangles that are duplicates, needles or overlap), \
                 or run with --particles native, which takes it",
    },
    Saying {
        words: &["error: invalid"],
        remedy: UNKNOWN,
    },
    Saying {
        words: &["illegal", "command"],
        remedy: "LIGGGHTS does not take a line of the script: the log names it; see the manual of LIGGGHTS-PUBLIC 3.8",
    },
    Saying {
        words: &["error: unknown"],
        remedy: UNKNOWN,
    },
    Saying {
        words: &["no space left on device"],
        remedy: FULL,
    },
];

const KEY: &str = "a dictionary lacks the key that the log names: of a template of yours (`openfoam.template`) add it there; else write the inputs with \
                   `calcine prepare` and look at that file";
const DIVERGED: &str = "OpenFOAM divided by zero or overflowed: the gas diverged; shorten `time.motion_window` or refine it where it flows fastest, see the \
                        Courant number that `calcine check` prints, and go on from the last checkpoint with --resume";
const LOST: &str = "particles left LIGGGHTS' space between two searches for neighbours: the step is too long for the contacts, two particles began \
                    inside each other, no wall closes the mesh there, or a wall has a hole; see walls, overlaps and step in `calcine check`, lower \
                    `motion.motion_step`, and go on from the last checkpoint with --resume; motion.lost = \"take-out\" takes such particles out and goes on";
const UNKNOWN: &str = "LIGGGHTS does not know a word of the script, which the log names: see the manual of LIGGGHTS-PUBLIC 3.8";
const FULL: &str = "the disk is full: make room, and go on from the last checkpoint with --resume";

/// Endings without words of the solver.
const ENDINGS: &[Saying] = &[
    Saying {
        words: &["signal 9"],
        remedy: "somebody killed it, as Linux does where memory runs out (see `dmesg`); go on from the last checkpoint with --resume",
    },
    Saying {
        words: &["signal 8"],
        remedy: DIVERGED,
    },
    Saying {
        words: &["signal 7"],
        remedy: "a bus error: as a rule shared memory is full (`df /dev/shm`); see `calcine doctor`, or run with --transport mpi",
    },
];

/// What helps against the failure of an external solver; nothing where its words say nothing that is known, or it is no external one.
pub fn remedy(error: &PartError) -> Option<&'static str> {
    let own = match error.who.split_whitespace().next() {
        Some("OpenFOAM") => OPENFOAM,
        Some("LIGGGHTS") => LIGGGHTS,
        _ => return None,
    };
    let text = [&error.message]
        .into_iter()
        .chain(&error.log_end)
        .map(|line| line.to_lowercase())
        .collect::<Vec<_>>()
        .join("\n");
    let fits = |saying: &&Saying| saying.words.iter().all(|word| text.contains(word));
    let endings = ENDINGS.iter().filter(|_| error.kind == FailureKind::Died);
    let mut sayings = own.iter().chain(endings);
    sayings.find(fits).map(|saying| saying.remedy)
}
