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

/// Fields that were sampled last, with what particles saw of them. Within a window and from one to the next some fields
/// stay as they are, to the bit: a void fraction while the bed does.
#[derive(Debug, Default)]
pub(super) struct Recent {
    fields: Mutex<Vec<[Vec<f64>; 2]>>,
}

/// A copy of an operator starts without.
impl Clone for Recent {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Recent {
    /// Fields that are kept: temperature, density and void fraction take turns.
    const KEPT: usize = 3;

    /// Sets what particles see of a field, by `sample` where it is none of the last ones.
    pub fn sample(&self, field: &[f64], seen: &mut [f64], sample: impl FnOnce(&[f64], &mut [f64])) {
        let lock = || self.fields.lock().unwrap_or_else(PoisonError::into_inner);
        let is_same = |[kept, _]: &[Vec<f64>; 2]| {
            let mut pairs = kept.iter().zip(field);
            kept.len() == field.len() && pairs.all(|(a, b)| a.to_bits() == b.to_bits())
        };
        let mut fields = lock();
        if let Some(place) = fields.iter().position(is_same) {
            let found = fields.remove(place);
            seen.copy_from_slice(&found[1]);
            fields.push(found);
            return;
        }
        let mut oldest = match fields.len() {
            Self::KEPT.. => fields.remove(0),
            _ => Default::default(),
        };
        drop(fields);
        sample(field, seen);
        for (kept, new) in oldest.iter_mut().zip([field, seen]) {
            kept.clear();
            kept.extend_from_slice(new);
        }
        lock().push(oldest);
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

    #[test]
    fn a_field_is_sampled_once_until_it_changes_by_a_bit() {
        let recent = Recent::default();
        let mut count = 0;
        let mut sample = |field: &[f64]| {
            let mut seen = [0.0];
            recent.sample(field, &mut seen, |field, seen| {
                count += 1;
                seen[0] = field.iter().sum();
            });
            (seen[0], count)
        };
        assert_eq!(sample(&[1.0, 2.0]), (3.0, 1));
        assert_eq!(sample(&[1.0, 4.0]), (5.0, 2));
        assert_eq!(sample(&[1.0, 2.0]), (3.0, 2));
        assert_eq!(sample(&[1.0, 2.0f64.next_up()]), (3.0f64.next_up(), 3));
        assert_eq!(sample(&[0.0, 3.0]), (3.0, 4));
        // The first but one is gone: it was used before the others.
        assert_eq!(sample(&[1.0, 4.0]), (5.0, 5));
        assert_eq!(sample(&[0.0, 3.0]), (3.0, 5));
    }
}
