//! LIGGGHTS' C interface (library.h of 3.8.0) and the little of MPI that it needs. Everything unsafe
//! is here.
//!
//! LIGGGHTS meets an error inside a command by printing and ending the process. Its error functions
//! are replaced here by ones that tell the coordinator first: the dynamic linker prefers the
//! executable's symbols over the library's. There is no way back from an error, so the process ends.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::ptr;
use std::sync::{Mutex, MutexGuard, PoisonError};

use calcine_wire::{Header, Link, MessageKind, SolverFailure};

#[allow(non_camel_case_types)]
type MPI_Comm = *mut c_void;

unsafe extern "C" {
    // Open MPI's MPI_COMM_WORLD, MPI_UINT64_T, MPI_SUM and MPI_MAX are the addresses of these objects.
    static mut ompi_mpi_comm_world: c_void_object;
    static mut ompi_mpi_uint64_t: c_void_object;
    static mut ompi_mpi_op_sum: c_void_object;
    static mut ompi_mpi_op_max: c_void_object;

    fn MPI_Init(argc: *mut c_int, argv: *mut *mut *mut c_char) -> c_int;
    fn MPI_Finalize() -> c_int;
    fn MPI_Comm_rank(world: MPI_Comm, rank: *mut c_int) -> c_int;
    fn MPI_Comm_size(world: MPI_Comm, size: *mut c_int) -> c_int;
    fn MPI_Allreduce(
        send: *const c_void,
        receive: *mut c_void,
        count: c_int,
        kind: *mut c_void,
        operation: *mut c_void,
        world: MPI_Comm,
    ) -> c_int;
    fn lammps_open(argc: c_int, argv: *mut *mut c_char, world: MPI_Comm, out: *mut *mut c_void);
    fn lammps_command(lammps: *mut c_void, line: *const c_char) -> *mut c_char;
    fn lammps_extract_global(lammps: *mut c_void, name: *const c_char) -> *mut c_void;
    fn lammps_extract_atom(lammps: *mut c_void, name: *const c_char) -> *mut c_void;
    fn lammps_extract_fix(
        lammps: *mut c_void,
        name: *const c_char,
        style: c_int,
        kind: c_int,
        i: c_int,
        j: c_int,
    ) -> *mut c_void;
    fn _exit(status: c_int) -> !;
}

/// An object of which only the address is used.
#[allow(non_camel_case_types)]
#[repr(C)]
struct c_void_object {
    _opaque: [u8; 0],
}

/// The link, where an error hook can reach it. Locked for messages only, never during a command.
static LINK: Mutex<Option<Link>> = Mutex::new(None);

/// Puts the link where errors are reported through.
pub fn keep_link(link: Link) {
    *LINK.lock().unwrap_or_else(PoisonError::into_inner) = Some(link);
}

/// Works with the link; LIGGGHTS must not be called meanwhile. `None` before there is one.
pub fn with_link<T>(work: impl FnOnce(&mut Link) -> T) -> Option<T> {
    let mut link = LINK.lock().unwrap_or_else(PoisonError::into_inner);
    link.as_mut().map(work)
}

/// Tells the coordinator of a failure, if there is a link that can.
pub fn report(failure: SolverFailure, text: &str) {
    if let Ok(mut link) = LINK.try_lock()
        && let Some(link) = link.as_mut()
    {
        // Whoever started this process sees its end, even if the link is what failed.
        let _ = link.send_last_word(Header::of(MessageKind::Failed), failure, text);
    }
}

/// Ends the process; where all is well, MPI first.
pub fn end(status: c_int) -> ! {
    if status == 0 {
        // SAFETY: MPI_Finalize is called once, after MPI_Init, with no communication under way.
        unsafe { MPI_Finalize() };
    }
    // SAFETY: takes any status. LIGGGHTS' own destructors are known to crash, so they do not run.
    unsafe { _exit(status) }
}

/// A text of C, or nothing where there is none.
fn words(text: *const c_char) -> String {
    if text.is_null() {
        return String::new();
    }
    // SAFETY: LIGGGHTS passes texts that end with a zero and live during the call.
    unsafe { CStr::from_ptr(text) }
        .to_string_lossy()
        .into_owned()
}

fn fail(file: *const c_char, line: c_int, parts: [*const c_char; 2]) -> ! {
    let message = parts.map(words).join(" ");
    let text = format!("LIGGGHTS: {} ({}:{line})", message.trim(), words(file));
    eprintln!("ERROR: {text}");
    report(SolverFailure::Other, &text);
    end(1)
}

type Text = *const c_char;

/// `Error::all(file, line, message)`.
#[unsafe(no_mangle)]
extern "C" fn _ZN9LAMMPS_NS5Error3allEPKciS2_(_: *mut c_void, file: Text, line: c_int, text: Text) {
    fail(file, line, [ptr::null(), text])
}

/// `Error::one(file, line, message)`.
#[unsafe(no_mangle)]
extern "C" fn _ZN9LAMMPS_NS5Error3oneEPKciS2_(_: *mut c_void, file: Text, line: c_int, text: Text) {
    fail(file, line, [ptr::null(), text])
}

/// `Error::fix_error(file, line, fix, message)`.
#[unsafe(no_mangle)]
extern "C" fn _ZN9LAMMPS_NS5Error9fix_errorEPKciPNS_3FixES2_(
    _: *mut c_void,
    file: Text,
    line: c_int,
    _fix: *mut c_void,
    text: Text,
) {
    fail(file, line, [ptr::null(), text])
}

/// `Error::fix_error(file, line, fix, style, message)`.
#[unsafe(no_mangle)]
extern "C" fn _ZN9LAMMPS_NS5Error9fix_errorEPKciPNS_3FixES2_S2_(
    _: *mut c_void,
    file: Text,
    line: c_int,
    _fix: *mut c_void,
    style: Text,
    text: Text,
) {
    fail(file, line, [style, text])
}

/// What is done at each step.
pub type StepWork = Box<dyn FnMut(&mut Liggghts) + Send>;

/// The open handle.
struct Handle(*mut c_void);

// SAFETY: LIGGGHTS is used by one thread, that which runs its commands and from which it calls.
unsafe impl Send for Handle {}

/// Work at each step with its number, in the order in which it came. Taken out while it is done.
static HOOKS: Mutex<Vec<(u64, Handle, StepWork)>> = Mutex::new(Vec::new());

/// Keeps the work at each step alive.
pub struct StepHook(u64);

impl Drop for StepHook {
    fn drop(&mut self) {
        hooks().retain(|(number, ..)| *number != self.0);
    }
}

fn hooks() -> MutexGuard<'static, Vec<(u64, Handle, StepWork)>> {
    HOOKS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// `FixExternal::post_force(step)`, of the fix that stands last in the script: it is called at each step when all of the script's
/// forces are there, and once with LIGGGHTS' setup.
#[unsafe(no_mangle)]
extern "C" fn _ZN9LAMMPS_NS11FixExternal10post_forceEi(_fix: *mut c_void, _: c_int) {
    let mut taken = std::mem::take(&mut *hooks());
    for (_, handle, work) in &mut taken {
        work(&mut Liggghts { handle: handle.0 });
    }
    *hooks() = taken;
}

/// Velocities and forces of this rank's particles with the numbers of a fix, in LIGGGHTS' order, interleaved.
pub struct ForceRows<'a> {
    /// Velocities in m/s.
    pub velocity: &'a [f64],
    /// Forces in N.
    pub force: &'a mut [f64],
    /// The numbers of the fix.
    pub fix: &'a mut [f64],
}

/// Starts MPI; rank and number of ranks.
pub fn start_mpi() -> (u32, u32) {
    let (mut rank, mut size) = (0, 1);
    // SAFETY: MPI allows NULL for both arguments; the results are places of the right type.
    unsafe {
        MPI_Init(ptr::null_mut(), ptr::null_mut());
        MPI_Comm_rank(world(), &mut rank);
        MPI_Comm_size(world(), &mut size);
    }
    (rank.unsigned_abs(), size.unsigned_abs())
}

fn world() -> MPI_Comm {
    (&raw mut ompi_mpi_comm_world).cast()
}

/// The sum of every rank's value, wrapping; all ranks must call it.
pub fn sum_over_ranks(value: u64) -> u64 {
    let mut sum = [value];
    add_over_ranks(&mut sum);
    sum[0]
}

/// The sums of every rank's values, wrapping, in their place; all ranks must call it with as many.
pub fn add_over_ranks(values: &mut [u64]) {
    reduce(values, (&raw mut ompi_mpi_op_sum).cast());
}

/// The largest of every rank's value; all ranks must call it.
pub fn largest_over_ranks(value: u64) -> u64 {
    let mut largest = [value];
    reduce(&mut largest, (&raw mut ompi_mpi_op_max).cast());
    largest[0]
}

/// Replaces values by what an operation of MPI makes of those of all ranks.
fn reduce(values: &mut [u64], operation: *mut c_void) {
    let own = values.to_vec();
    for (from, to) in own.chunks(1 << 20).zip(values.chunks_mut(1 << 20)) {
        // SAFETY: as many values of the stated type at either place, in the world that all ranks are in.
        unsafe {
            MPI_Allreduce(
                from.as_ptr().cast(),
                to.as_mut_ptr().cast(),
                from.len() as c_int,
                (&raw mut ompi_mpi_uint64_t).cast(),
                operation,
                world(),
            );
        }
    }
}

/// One LIGGGHTS; there must be no second in a process.
pub struct Liggghts {
    handle: *mut c_void,
}

impl Liggghts {
    /// Opens LIGGGHTS with its output in a file. MPI must have been started.
    pub fn open(log: &str) -> Self {
        // Without a screen (`none`) its walls of triangles write to a null pointer.
        let arguments = ["liggghts", "-screen", "/dev/null", "-log", log].map(c_text);
        let mut pointers = arguments.each_ref().map(|text| text.as_ptr().cast_mut());
        let mut handle = ptr::null_mut();
        // SAFETY: the texts live during the call and LIGGGHTS copies what it keeps; it does not
        // write into them.
        unsafe {
            let count = pointers.len() as c_int;
            lammps_open(count, pointers.as_mut_ptr(), world(), &mut handle);
        }
        Self { handle }
    }

    /// Runs one line of script; an error ends the process.
    pub fn command(&mut self, line: &str) {
        let line = c_text(line);
        // SAFETY: the handle is open and the text lives during the call.
        unsafe { lammps_command(self.handle, line.as_ptr()) };
    }

    fn global<T: Copy>(&self, name: &str) -> Option<T> {
        let name = c_text(name);
        // SAFETY: the handle is open; a known name gives a pointer to a value of T, which the
        // callers below choose as library.cpp has it; an unknown one NULL.
        unsafe {
            let value: *const T = lammps_extract_global(self.handle, name.as_ptr()).cast();
            value.as_ref().copied()
        }
    }

    /// The time step in s.
    pub fn step(&self) -> Option<f64> {
        self.global("dt")
    }

    /// Particles on all ranks.
    pub fn particles(&self) -> Option<u64> {
        self.global::<i64>("natoms").map(i64::unsigned_abs)
    }

    fn local(&self) -> usize {
        self.global::<c_int>("nlocal")
            .map_or(0, |count| count.unsigned_abs() as usize)
    }

    /// Integers of this rank's particles, for example "id" and "type".
    pub fn integers(&self, name: &str) -> Option<&[c_int]> {
        self.column(name, 1)
    }

    /// Scalars of this rank's particles, for example "radius" and "rmass".
    pub fn scalars(&self, name: &str) -> Option<&[f64]> {
        self.column(name, 1)
    }

    /// Vectors of this rank's particles, interleaved, for example "x", "v", "omega".
    pub fn vectors(&self, name: &str) -> Option<&[f64]> {
        let count = self.local();
        if count == 0 {
            return Some(&[]);
        }
        let name = c_text(name);
        // SAFETY: the handle is open; a per-atom array is a table of row pointers whose rows are
        // contiguous, at least `nlocal` of them; it lives until the next command, which needs
        // `&mut self`.
        unsafe {
            let rows: *const *const f64 = lammps_extract_atom(self.handle, name.as_ptr()).cast();
            let first = *rows.as_ref()?;
            (!first.is_null()).then(|| std::slice::from_raw_parts(first, 3 * count))
        }
    }

    /// The same, to be written.
    pub fn vectors_mut(&mut self, name: &str) -> Option<&mut [f64]> {
        let count = self.vectors(name)?.len();
        if count == 0 {
            return Some(&mut []);
        }
        let name = c_text(name);
        // SAFETY: as for `vectors`, which found `count` numbers; borrowed mutably, alone.
        unsafe {
            let rows: *const *mut f64 = lammps_extract_atom(self.handle, name.as_ptr()).cast();
            Some(std::slice::from_raw_parts_mut(*rows.as_ref()?, count))
        }
    }

    /// Vectors of a `fix property/atom`, one for each of this rank's particles, to be written;
    /// `None` where there is no such fix.
    pub fn fix_vectors_mut(&mut self, fix: &str) -> Option<&mut [f64]> {
        self.fix_rows_mut(fix, 3)
    }

    /// Rows of so many numbers of a `fix property/atom`, one for each of this rank's particles, to be written; `None`
    /// where there is no such fix.
    pub fn fix_rows_mut(&mut self, fix: &str, numbers: usize) -> Option<&mut [f64]> {
        let count = self.local();
        let name = c_text(fix);
        // SAFETY: the handle is open; style 1 and kind 2 ask for per-atom vectors, a table of row
        // pointers whose rows are contiguous, at least `nlocal` of them; an unknown fix gives NULL. The
        // callers give the number that the script makes the fix with.
        unsafe {
            let rows: *const *mut f64 =
                lammps_extract_fix(self.handle, name.as_ptr(), 1, 2, 0, 0).cast();
            let first = *rows.as_ref()?;
            if count == 0 || first.is_null() {
                return Some(&mut []);
            }
            Some(std::slice::from_raw_parts_mut(first, numbers * count))
        }
    }

    /// Velocities, forces and the numbers of a fix of this rank's particles, all interleaved; `None` where LIGGGHTS lacks a
    /// part of it.
    pub fn forces_with(&mut self, fix: &str, numbers: usize) -> Option<ForceRows<'_>> {
        let velocity = self.vectors("v")?;
        let velocity = (velocity.as_ptr(), velocity.len());
        let force = self.vectors_mut("f")?;
        let force = (force.as_mut_ptr(), force.len());
        let fix = self.fix_rows_mut(fix, numbers)?;
        // SAFETY: arrays of their own, of the lengths that were found, which live until the next command; borrowed with
        // `self`. Those of no rows are empty slices.
        unsafe {
            Some(ForceRows {
                velocity: std::slice::from_raw_parts(velocity.0, velocity.1),
                force: std::slice::from_raw_parts_mut(force.0, force.1),
                fix,
            })
        }
    }

    /// Has a function called at each step from now on, when all other forces of the step are there, for as long as what is
    /// given back lives.
    pub fn at_each_step(&mut self, work: StepWork) -> StepHook {
        let mut hooks = hooks();
        let number = hooks.last().map_or(0, |(last, ..)| last + 1);
        hooks.push((number, Handle(self.handle), work));
        StepHook(number)
    }

    /// Scalars of a `fix property/atom`, one for each of this rank's particles; `None` where there is no such fix.
    pub fn fix_scalars(&self, fix: &str) -> Option<&[f64]> {
        let (values, count) = (self.fix_scalar(fix), self.local());
        if count == 0 {
            return Some(&[]);
        }
        // SAFETY: a scalar per atom is an array of at least `nlocal` numbers; it lives until the next command, which
        // needs `&mut self`.
        (!values.is_null()).then(|| unsafe { std::slice::from_raw_parts(values, count) })
    }

    /// The same, to be written.
    pub fn fix_scalars_mut(&mut self, fix: &str) -> Option<&mut [f64]> {
        let (values, count) = (self.fix_scalar(fix), self.local());
        if count == 0 {
            return Some(&mut []);
        }
        // SAFETY: as for `fix_scalars`; borrowed mutably, alone.
        (!values.is_null()).then(|| unsafe { std::slice::from_raw_parts_mut(values, count) })
    }

    fn fix_scalar(&self, fix: &str) -> *mut f64 {
        let name = c_text(fix);
        // SAFETY: the handle is open; style 1 and kind 1 ask for a scalar per atom; an unknown fix gives NULL.
        unsafe { lammps_extract_fix(self.handle, name.as_ptr(), 1, 1, 0, 0).cast() }
    }

    /// A scalar of this rank's particle at a place, to be written.
    pub fn scalars_mut(&mut self, name: &str) -> Option<&mut [f64]> {
        let count = self.scalars(name)?.len();
        if count == 0 {
            return Some(&mut []);
        }
        let name = c_text(name);
        // SAFETY: as for `scalars`, which found `count` numbers; borrowed mutably, alone.
        unsafe {
            let values: *mut f64 = lammps_extract_atom(self.handle, name.as_ptr()).cast();
            Some(std::slice::from_raw_parts_mut(values, count))
        }
    }

    /// Tags of this rank's particles, to be written.
    pub fn tags_mut(&mut self) -> Option<&mut [c_int]> {
        let count = self.integers("id")?.len();
        if count == 0 {
            return Some(&mut []);
        }
        let name = c_text("id");
        // SAFETY: as for `integers`, which found `count` numbers; borrowed mutably, alone.
        unsafe {
            let values: *mut c_int = lammps_extract_atom(self.handle, name.as_ptr()).cast();
            Some(std::slice::from_raw_parts_mut(values, count))
        }
    }

    /// This rank's particles.
    pub fn here(&self) -> usize {
        self.local()
    }

    fn column<T>(&self, name: &str, components: usize) -> Option<&[T]> {
        let count = self.local();
        if count == 0 {
            return Some(&[]);
        }
        let name = c_text(name);
        // SAFETY: as for vectors, but the array itself; the two callers fix T.
        unsafe {
            let values: *const T = lammps_extract_atom(self.handle, name.as_ptr()).cast();
            (!values.is_null()).then(|| std::slice::from_raw_parts(values, components * count))
        }
    }
}

/// A text for C; a zero inside it ends it.
fn c_text(text: &str) -> CString {
    let end = text.find('\0').unwrap_or(text.len());
    CString::new(&text[..end]).unwrap_or_default()
}
