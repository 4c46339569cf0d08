//! Words of 8 bytes seen as numbers or text, in place. Every bit pattern is a value of each type
//! used here, and their alignments do not exceed a word's.

use iceoryx2::prelude::ipc_threadsafe::Service;
use iceoryx2::sample_mut::SampleMut;
use iceoryx2::sample_mut_uninit::SampleMutUninit;
use rustix::mm::{Advice, madvise};

use crate::record::Header;

/// Words in a line of memory: 64 bytes, the alignment of columns.
pub const LINE: usize = 8;

/// A line of memory.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub struct CacheLine([u64; LINE]);

const _: () = assert!(size_of::<CacheLine>() == 8 * LINE);

/// Lines as words.
pub fn of_lines(lines: &[CacheLine]) -> &[u64] {
    // SAFETY: a line is exactly eight words without padding, and its alignment exceeds theirs.
    unsafe { std::slice::from_raw_parts(lines.as_ptr().cast(), LINE * lines.len()) }
}

/// Lines as words, to be written.
pub fn of_lines_mut(lines: &mut [CacheLine]) -> &mut [u64] {
    // SAFETY: as above; every bit pattern is a word.
    unsafe { std::slice::from_raw_parts_mut(lines.as_mut_ptr().cast(), LINE * lines.len()) }
}

/// Where the first line begins in a payload with room for it: the same number in both processes, as memory is
/// mapped by whole pages.
pub fn line_start(payload: &[u64]) -> usize {
    payload
        .as_ptr()
        .align_offset(align_of::<CacheLine>())
        .min(payload.len())
}

/// A reserved message of the shared-memory transport.
pub type ReservedMessage = SampleMutUninit<Service, [std::mem::MaybeUninit<u64>], Header>;
type Filled = SampleMut<Service, [u64], Header>;

/// Words as doubles.
pub fn doubles(words: &[u64]) -> &[f64] {
    // SAFETY: u64 and f64 have the same size and alignment, and every bit pattern is an f64.
    unsafe { std::slice::from_raw_parts(words.as_ptr().cast(), words.len()) }
}

/// Words as doubles, to be written.
pub fn doubles_mut(words: &mut [u64]) -> &mut [f64] {
    // SAFETY: as above; and every f64 is a u64, so writing cannot make a word invalid.
    unsafe { std::slice::from_raw_parts_mut(words.as_mut_ptr().cast(), words.len()) }
}

/// The first `length` bytes of words; fewer where there are no more.
pub fn bytes(words: &[u64], length: usize) -> &[u8] {
    let length = length.min(size_of_val(words));
    // SAFETY: `length` bytes lie within the slice, and a byte has no alignment.
    unsafe { std::slice::from_raw_parts(words.as_ptr().cast(), length) }
}

/// All bytes of words, to be written.
pub fn bytes_mut(words: &mut [u64]) -> &mut [u8] {
    // SAFETY: the bytes are those of the slice, and every byte pattern is a u64.
    unsafe { std::slice::from_raw_parts_mut(words.as_mut_ptr().cast(), size_of_val(words)) }
}

/// Memory of a fresh loan as words. It is mapped shared memory: zeros of the kernel or the bytes of
/// an earlier message.
pub fn mapped(words: &mut [std::mem::MaybeUninit<u64>]) -> &mut [u64] {
    // SAFETY: the slice lies in a mapping shared with another process, whose every byte has a value;
    // every bit pattern is a u64; size and alignment are equal.
    unsafe { std::slice::from_raw_parts_mut(words.as_mut_ptr().cast(), words.len()) }
}

/// Has the kernel put memory behind words of a shared mapping: an error where there is none left, in place of the
/// SIGBUS that writing would bring. A kernel before Linux 5.14 does not know how, and leaves it at that.
pub fn back(words: &mut [std::mem::MaybeUninit<u64>]) -> rustix::io::Result<()> {
    const PAGE: usize = 4096;
    let start = words.as_mut_ptr() as usize;
    let end = start + size_of_val(words);
    let first = start - start % PAGE;
    // SAFETY: only pages that hold some of the words, which are mapped; what they hold does not change.
    let done = unsafe { madvise(first as *mut _, end - first, Advice::LinuxPopulateWrite) };
    match done {
        Err(rustix::io::Errno::INVAL) => Ok(()),
        done => done,
    }
}

/// A loan whose content counts as written.
pub fn filled(loan: ReservedMessage) -> Filled {
    // SAFETY: as in `mapped`, every byte of the loan has a value and every value is a u64.
    unsafe { loan.assume_init() }
}
