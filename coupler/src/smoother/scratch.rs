//! Scratch memory of operators that are applied over and over.

use std::sync::{Mutex, PoisonError};

use calcine_physics::Vec3;

use crate::mapping::Amount;

/// Buffers by kind of amount. Each application takes what it needs and puts it back, so that only
/// the first applications allocate, and applications may run at the same time.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    numbers: Mutex<Vec<Vec<f64>>>,
    vectors: Mutex<Vec<Vec<Vec3>>>,
}

/// A copy of an operator starts with no buffers of its own.
impl Clone for Scratch {
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// Amounts for which there are buffers.
pub(super) trait Kept: Amount {
    fn shelf(scratch: &Scratch) -> &Mutex<Vec<Vec<Self>>>;
}

impl Kept for f64 {
    fn shelf(scratch: &Scratch) -> &Mutex<Vec<Vec<Self>>> {
        &scratch.numbers
    }
}

impl Kept for Vec3 {
    fn shelf(scratch: &Scratch) -> &Mutex<Vec<Vec<Self>>> {
        &scratch.vectors
    }
}

impl Scratch {
    /// Calls with a buffer of at least this length, whose contents are arbitrary.
    pub fn with<T: Kept, R>(&self, length: usize, work: impl FnOnce(&mut [T]) -> R) -> R {
        let shelf = T::shelf(self);
        let lock = || shelf.lock().unwrap_or_else(PoisonError::into_inner);
        let mut buffer = lock().pop().unwrap_or_default();
        if buffer.len() < length {
            buffer.resize(length, T::ZERO);
        }
        let result = work(&mut buffer[..length]);
        lock().push(buffer);
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_buffer_is_used_again_and_not_allocated_anew() {
        let scratch = Scratch::default();
        let first = scratch.with(100, |buffer: &mut [f64]| buffer.as_ptr());
        let second = scratch.with(50, |buffer: &mut [f64]| buffer.as_ptr());
        assert_eq!(first, second);
    }
}
