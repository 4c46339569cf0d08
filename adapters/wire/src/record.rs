//! The record that stands before every payload, the same bytes in Rust, C and C++.

use iceoryx2::prelude::ZeroCopySend;

/// Marks a header of this wire: "calcine" and a one.
pub const MAGIC: u64 = u64::from_le_bytes(*b"calcine\x01");
/// Version of the protocol; both ends must have the same.
pub const VERSION: u32 = 4;

/// What a message is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum MessageKind {
    /// Who is there, with versions, hashes and catalogue (text); both ways, first.
    Hello = 1,
    /// The solver's state at the start of the run (columns).
    State = 2,
    /// Start an attempt (columns): the exchange of the gas, or the push on particles.
    Start = 3,
    /// The attempt is finished (columns): what was received, and the state.
    Finished = 4,
    /// Take the last attempt as the start of the next; without an answer unless the catalogue has columns "committed".
    Commit = 5,
    /// Write a checkpoint into a directory (text) and re-initialise from it.
    Checkpoint = 6,
    /// The checkpoint is written; the state after re-initialisation (columns).
    Checkpointed = 7,
    /// The sender cannot go on; why, in words (text), and of which kind (a `SolverFailure`, in the header's count).
    Failed = 8,
    /// The run ends; asked by the coordinator, answered by the solver.
    Bye = 9,
    /// Which cells of the whole mesh the rank of a gas has, in the order of all its columns; sent
    /// once, after the handshake (columns).
    Owned = 10,
    /// Particles that go and come between two windows (text, see the host's `change`).
    Change = 11,
    /// The change is made; the state after it (columns).
    Changed = 12,
    /// Conditions of a gas' patches from the next window on (text: a line each of patch, condition and values);
    /// answered by the same kind without a payload.
    Boundary = 13,
    /// The attempt is taken; what a gas computed as it was (columns).
    Committed = 14,
}

impl MessageKind {
    /// All kinds.
    pub const ALL: [MessageKind; 14] = [
        MessageKind::Hello,
        MessageKind::State,
        MessageKind::Start,
        MessageKind::Finished,
        MessageKind::Commit,
        MessageKind::Checkpoint,
        MessageKind::Checkpointed,
        MessageKind::Failed,
        MessageKind::Bye,
        MessageKind::Owned,
        MessageKind::Change,
        MessageKind::Changed,
        MessageKind::Boundary,
        MessageKind::Committed,
    ];

    /// Its name, as the C header has it behind `CALCINE_`.
    pub fn name(self) -> &'static str {
        match self {
            MessageKind::Hello => "HELLO",
            MessageKind::State => "STATE",
            MessageKind::Start => "START",
            MessageKind::Finished => "FINISHED",
            MessageKind::Commit => "COMMIT",
            MessageKind::Checkpoint => "CHECKPOINT",
            MessageKind::Checkpointed => "CHECKPOINTED",
            MessageKind::Failed => "FAILED",
            MessageKind::Bye => "BYE",
            MessageKind::Owned => "OWNED",
            MessageKind::Change => "CHANGE",
            MessageKind::Boundary => "BOUNDARY",
            MessageKind::Changed => "CHANGED",
            MessageKind::Committed => "COMMITTED",
        }
    }

    /// The kind of a number on the wire.
    pub fn from_number(number: u32) -> Option<MessageKind> {
        Self::ALL.into_iter().find(|&kind| kind as u32 == number)
    }
}

/// What stands before the columns of a message. Times in ticks of 1 ps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ZeroCopySend)]
#[repr(C)]
pub struct Header {
    /// [`MAGIC`].
    pub magic: u64,
    /// [`VERSION`].
    pub version: u32,
    /// A [`MessageKind`] as its number.
    pub kind: u32,
    /// The run that the message belongs to.
    pub run: u64,
    /// The solver's rank.
    pub rank: u32,
    /// Zero for the first attempt of a window.
    pub attempt: u32,
    /// Number of windows committed before this one.
    pub window: u64,
    /// Motion clock at the start of the window.
    pub start_motion: i64,
    /// Process clock at the start of the window.
    pub start_process: i64,
    /// How far the motion clock moves.
    pub span_motion: i64,
    /// How far the process clock moves.
    pub span_process: i64,
    /// Span over which the gas stores mass, enthalpy and species.
    pub storage_span: i64,
    /// Cells or particles in the columns; of `Failed` the kind of failure.
    pub count: u64,
    /// Bytes of the payload: columns, or a text in UTF-8.
    pub bytes: u64,
}

// The C header states the same struct; these hold it to the same layout.
const _: () = assert!(size_of::<Header>() == 96);
const _: () = assert!(align_of::<Header>() == 8);
const _: () = assert!(std::mem::offset_of!(Header, window) == 32);
const _: () = assert!(std::mem::offset_of!(Header, count) == 80);

/// Words of 8 bytes in a header.
pub const HEADER_WORDS: usize = size_of::<Header>() / 8;

/// Two numbers in one word, the first in the lower half.
fn word(low: u32, high: u32) -> u64 {
    u64::from(low) | u64::from(high) << 32
}

fn halves(word: u64) -> (u32, u32) {
    (word as u32, (word >> 32) as u32)
}

impl Header {
    /// The header as words, for a transport that moves nothing else.
    pub fn to_words(&self) -> [u64; HEADER_WORDS] {
        [
            self.magic,
            word(self.version, self.kind),
            self.run,
            word(self.rank, self.attempt),
            self.window,
            self.start_motion.cast_unsigned(),
            self.start_process.cast_unsigned(),
            self.span_motion.cast_unsigned(),
            self.span_process.cast_unsigned(),
            self.storage_span.cast_unsigned(),
            self.count,
            self.bytes,
        ]
    }

    /// Reads what [`Header::to_words`] gave, from the first words of a message.
    pub fn from_words(words: &[u64]) -> Option<Self> {
        let words: &[u64; HEADER_WORDS] = words.first_chunk()?;
        let (version, kind) = halves(words[1]);
        let (rank, attempt) = halves(words[3]);
        Some(Self {
            magic: words[0],
            version,
            kind,
            run: words[2],
            rank,
            attempt,
            window: words[4],
            start_motion: words[5].cast_signed(),
            start_process: words[6].cast_signed(),
            span_motion: words[7].cast_signed(),
            span_process: words[8].cast_signed(),
            storage_span: words[9].cast_signed(),
            count: words[10],
            bytes: words[11],
        })
    }

    /// A header of a kind, everything else zero; a link fills in run, rank and sizes.
    pub fn of(kind: MessageKind) -> Self {
        Self {
            magic: MAGIC,
            version: VERSION,
            kind: kind as u32,
            ..Self::default()
        }
    }

    /// The same window, attempt and clocks, as another kind.
    pub fn answer(&self, kind: MessageKind) -> Self {
        Self {
            kind: kind as u32,
            count: 0,
            bytes: 0,
            ..*self
        }
    }

    /// The kind, if the number is one.
    pub fn kind(&self) -> Option<MessageKind> {
        MessageKind::from_number(self.kind)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_survives_its_words() {
        let header = Header {
            run: 3,
            rank: 4,
            attempt: 5,
            window: 6,
            start_motion: -7,
            start_process: 8,
            span_motion: 9,
            span_process: 10,
            storage_span: 11,
            count: 12,
            bytes: 13,
            ..Header::of(MessageKind::Finished)
        };
        assert_eq!(Header::from_words(&header.to_words()), Some(header));
        assert_eq!(Header::from_words(&[0; 11]), None);
    }
}
