//! The transport of messages that something else carries, such as MPI between machines: the rules of a link
//! (what may wait, what must not hang) over whatever moves words.

use std::time::{Duration, Instant};

use crate::error::WireError;
use crate::record::{HEADER_WORDS, Header};
use crate::run::LinkAddress;
use crate::transport::Transport;
use crate::watch::Watch;
use crate::words::{self, CacheLine, LINE};

/// Messages that may wait unread: a commit, and the start that follows it.
const BUFFER: usize = 2;
/// How long a full buffer may stay full before sending fails.
const FULL_FOR: Duration = Duration::from_millis(500);
/// Words that a carrier passes on at once (Open MPI's TCP: 64 kB, header of its own included). More moves
/// only while both ends call the carrier.
const AT_ONCE: usize = 4096;
/// How long a sender stays with a larger message, and with a GB more, so that it is out of the way before
/// the sender computes.
const COURTESY: Duration = Duration::from_millis(20);
const COURTESY_PER_GB: f64 = 4.0;
/// First and longest pause between two looks for a message.
const PAUSES: (Duration, Duration) = (Duration::from_micros(10), Duration::from_micros(200));

/// A whole message: header and payload, both at multiples of 64 bytes.
#[derive(Debug)]
pub struct Message {
    lines: Vec<CacheLine>,
}

/// Moves whole messages between two processes, in order. Nothing in it may block.
pub trait Carrier: Send {
    /// Begins to send; the message lives until the other end has taken it.
    fn post(&mut self, message: Message) -> Result<(), WireError>;

    /// Moves on what was posted; how many messages the other end has not taken yet.
    fn pending(&mut self) -> Result<usize, WireError>;

    /// Words of the next message that waits here, if one does.
    fn arrived(&mut self) -> Result<Option<usize>, WireError>;

    /// Takes the message that waits into as many words.
    fn take(&mut self, words: &mut [u64]) -> Result<(), WireError>;
}

impl Message {
    /// Room for a payload of some words.
    fn new(header: &Header, payload: usize) -> Self {
        let lines = HEADER_WORDS.div_ceil(LINE) + payload.div_ceil(LINE);
        let mut message = Self {
            lines: vec![CacheLine::default(); lines],
        };
        words::of_lines_mut(&mut message.lines)[..HEADER_WORDS].copy_from_slice(&header.to_words());
        message
    }

    /// All words, to be sent.
    pub fn words(&self) -> &[u64] {
        words::of_lines(&self.lines)
    }

    fn payload(&self) -> &[u64] {
        &self.words()[HEADER_WORDS.next_multiple_of(LINE)..]
    }

    fn payload_mut(&mut self) -> &mut [u64] {
        &mut words::of_lines_mut(&mut self.lines)[HEADER_WORDS.next_multiple_of(LINE)..]
    }
}

/// One end of a carried link.
pub struct CarriedTransport<C> {
    carrier: C,
    loan: Option<Message>,
    received: Option<(Header, Message)>,
    /// Memory of the message received before, for the next: large ones cost as much to make as to move.
    spare: Vec<CacheLine>,
    coordinator: Option<(Watch, LinkAddress)>,
}

impl<C: Carrier> CarriedTransport<C> {
    /// The coordinator's end.
    pub fn new(carrier: C) -> Self {
        Self {
            carrier,
            loan: None,
            received: None,
            spare: Vec::new(),
            coordinator: None,
        }
    }

    /// A solver's end, which watches the coordinator where that is on the same machine.
    pub fn of_solver(carrier: C, address: &LinkAddress) -> Result<Self, WireError> {
        let mut end = Self::new(carrier);
        if address.is_here() {
            end.coordinator = Some((Watch::living(address)?, address.clone()));
        }
        Ok(end)
    }

    /// Waits until at most `left` messages are pending; false where that took too long.
    fn drain(&mut self, left: usize, patience: Duration) -> Result<bool, WireError> {
        let begun = Instant::now();
        let mut pause = PAUSES.0;
        while self.carrier.pending()? > left {
            if begun.elapsed() > patience {
                return Ok(false);
            }
            std::thread::sleep(pause);
            pause = (2 * pause).min(PAUSES.1);
        }
        Ok(true)
    }
}

impl<C: Carrier> Transport for CarriedTransport<C> {
    fn loan(&mut self, header: Header, words: usize) -> Result<&mut [u64], WireError> {
        let loan = self.loan.insert(Message::new(&header, words));
        Ok(loan.payload_mut())
    }

    fn loaned(&mut self) -> Option<&mut [u64]> {
        Some(self.loan.as_mut()?.payload_mut())
    }

    fn send(&mut self) -> Result<(), WireError> {
        let message = self.loan.take().ok_or(WireError::Order {
            what: "there is no reserved message to send",
        })?;
        if !self.drain(BUFFER - 1, FULL_FOR)? {
            return Err(WireError::NotDelivered { receivers: 0 });
        }
        let words = message.words().len();
        self.carrier.post(message)?;
        if words > AT_ONCE {
            let more = Duration::from_secs_f64(COURTESY_PER_GB * 8e-9 * words as f64);
            self.drain(0, COURTESY + more)?;
        }
        Ok(())
    }

    fn receive(&mut self, patience: Duration) -> Result<bool, WireError> {
        let begun = Instant::now();
        if let Some((_, message)) = self.received.take() {
            self.spare = message.lines;
        }
        let mut pause = PAUSES.0;
        loop {
            // Looked at before the queue, so that a last word of the dead is still heard.
            let dead = self
                .coordinator
                .as_ref()
                .filter(|(watch, _)| watch.is_dead());
            let dead = dead.map(|(watch, address)| (watch.pid(), address.clone()));
            if let Some(count) = self.carrier.arrived()? {
                let mut lines = std::mem::take(&mut self.spare);
                lines.resize(count.div_ceil(LINE), CacheLine::default());
                self.carrier
                    .take(&mut words::of_lines_mut(&mut lines)[..count])?;
                let message = Message { lines };
                let header = Header::from_words(message.words()).ok_or(WireError::Order {
                    what: "a message arrived that is shorter than a header",
                })?;
                self.received = Some((header, message));
                return Ok(true);
            }
            if let Some((pid, address)) = dead {
                address.remove_files();
                return Err(WireError::PeerDead { pid });
            }
            // What was sent moves on while an answer is waited for.
            self.carrier.pending()?;
            let left = patience.saturating_sub(begun.elapsed());
            if left.is_zero() {
                return Ok(false);
            }
            std::thread::sleep(pause.min(left));
            pause = (pause + pause / 2).min(PAUSES.1);
        }
    }

    fn settle(&mut self, patience: Duration) -> Result<(), WireError> {
        self.drain(0, patience).map(|_| ())
    }

    fn received(&self) -> Option<(&Header, &[u64])> {
        let (header, message) = self.received.as_ref()?;
        Some((header, message.payload()))
    }
}
