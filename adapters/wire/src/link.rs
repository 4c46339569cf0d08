//! One rank's link: messages with columns or texts over any transport, checked on arrival.

use std::time::{Duration, Instant};

use crate::catalogue::{Catalogue, Field};
use crate::column_set::ColumnSet;
use crate::error::WireError;
use crate::failure::SolverFailure;
use crate::hello::Hello;
use crate::process::Process;
use crate::record::{Header, MAGIC, MessageKind, VERSION};
use crate::transport::Transport;
use crate::words;

/// How long a process that fails may take to say so.
const LAST_WORD: Duration = Duration::from_secs(2);

/// Between two tries to reach an end that is not there yet.
const NOBODY_YET: Duration = Duration::from_millis(2);

/// One end of one rank's link.
pub struct Link {
    transport: Box<dyn Transport + Send>,
    run: u64,
    rank: u32,
    catalogue: Catalogue,
    /// Who is at the other end, once it has introduced itself.
    peer: Option<Process>,
    /// Header of the reserved message, and which of its columns were asked for.
    reserved: Option<(Header, Vec<bool>)>,
}

impl Link {
    /// A link without a catalogue; the handshake brings it.
    pub fn new(transport: Box<dyn Transport + Send>, run: u64, rank: u32) -> Self {
        Self {
            transport,
            run,
            rank,
            catalogue: Catalogue::default(),
            peer: None,
            reserved: None,
        }
    }

    /// The solver's rank.
    pub fn rank(&self) -> u32 {
        self.rank
    }

    /// The columns that both ends agreed on.
    pub fn catalogue(&self) -> &Catalogue {
        &self.catalogue
    }

    /// The process at the other end, as it introduced itself.
    pub fn peer(&self) -> Option<&Process> {
        self.peer.as_ref()
    }

    /// Solver's side of the handshake: introduces itself as soon as the coordinator's end is there, waits,
    /// compares.
    pub fn greet(&mut self, ours: &Hello, patience: Duration) -> Result<Hello, WireError> {
        let begun = Instant::now();
        loop {
            match self.send_text(Header::of(MessageKind::Hello), &introduction(ours)) {
                Err(WireError::NotDelivered { receivers: 0 }) if begun.elapsed() < patience => {
                    std::thread::sleep(NOBODY_YET);
                }
                sent => break sent?,
            }
        }
        loop {
            let left = patience.saturating_sub(begun.elapsed());
            if let Some(header) = self.receive(left)? {
                self.expect(
                    &header,
                    MessageKind::Hello,
                    "the coordinator's introduction",
                )?;
                let theirs = Hello::from_text(self.text()?)?;
                ours.agree(&theirs)?;
                self.catalogue = ours.catalogue.clone();
                return Ok(theirs);
            }
            if left.is_zero() {
                return Err(WireError::Silent {
                    seconds: patience.as_secs_f64(),
                    what: "the coordinator's introduction",
                });
            }
        }
    }

    /// Coordinator's side of the handshake, once a message arrived: compares, answers, and gives the
    /// solver's introduction. A mismatch is told to the solver too.
    pub fn answer_greeting(&mut self, ours: &Hello) -> Result<Hello, WireError> {
        self.answer_offer(ours, &[])
    }

    /// The same where the solver may have further columns beside ours: those of `optional` that it names belong to the
    /// link.
    pub fn answer_offer(&mut self, ours: &Hello, optional: &[Field]) -> Result<Hello, WireError> {
        self.peer = self.text().ok().and_then(Process::in_text);
        let mut ours = ours.clone();
        let greeting = self.read_greeting(&mut ours, optional);
        match &greeting {
            Ok(_) => self.send_text(Header::of(MessageKind::Hello), &introduction(&ours))?,
            Err(error) => {
                let header = Header::of(MessageKind::Failed);
                self.send_words(
                    header,
                    SolverFailure::InvalidInput as u64,
                    &error.to_string(),
                )?;
            }
        }
        self.catalogue = ours.catalogue;
        greeting
    }

    fn read_greeting(&self, ours: &mut Hello, optional: &[Field]) -> Result<Hello, WireError> {
        let header = self.header()?;
        self.expect(&header, MessageKind::Hello, "the solver's introduction")?;
        let theirs = Hello::from_text(self.text()?)?;
        let own = std::mem::take(&mut ours.catalogue);
        ours.catalogue = own.with_further(&theirs.catalogue, optional);
        ours.agree(&theirs)?;
        Ok(theirs)
    }

    fn expect(
        &self,
        header: &Header,
        kind: MessageKind,
        expected: &'static str,
    ) -> Result<(), WireError> {
        if header.kind() == Some(kind) {
            return Ok(());
        }
        Err(WireError::Unexpected {
            found: header.kind,
            expected,
        })
    }

    /// Sends a message without columns or text.
    pub fn send_plain(&mut self, header: Header) -> Result<(), WireError> {
        self.send_text(header, "")
    }

    /// Sends a text.
    pub fn send_text(&mut self, header: Header, text: &str) -> Result<(), WireError> {
        self.send_words(header, 0, text)
    }

    fn send_words(&mut self, header: Header, count: u64, text: &str) -> Result<(), WireError> {
        self.reserved = None;
        let header = self.addressed(header, count, text.len() as u64);
        let payload = self.transport.loan(header, text.len().div_ceil(8))?;
        words::bytes_mut(payload)[..text.len()].copy_from_slice(text.as_bytes());
        self.transport.send()
    }

    /// Tells the other end why this process ends, and stays until it has heard, 2 s at most.
    pub fn send_last_word(
        &mut self,
        header: Header,
        kind: SolverFailure,
        text: &str,
    ) -> Result<(), WireError> {
        self.send_words(header, kind as u64, text)?;
        self.transport.settle(LAST_WORD)
    }

    /// Reserves a message with columns for `count` items; the header's kind decides which.
    pub fn loan(&mut self, header: Header, count: usize) -> Result<(), WireError> {
        let columns = header.kind().and_then(ColumnSet::of);
        let words = match columns {
            None => 0,
            Some(record) => self
                .catalogue
                .words(record, count)
                .filter(|&words| words < usize::MAX / 16)
                .ok_or(WireError::Order {
                    what: "that many cells or particles do not fit the memory",
                })?,
        };
        let fields = columns.map_or(0, |record| self.catalogue.of(record).count());
        let header = self.addressed(header, count as u64, 8 * words as u64);
        self.reserved = None;
        self.transport.loan(header, words)?;
        self.reserved = Some((header, vec![false; fields]));
        Ok(())
    }

    /// A column of the reserved message, to be filled in place.
    pub fn column_words_mut(&mut self, name: &str) -> Result<&mut [u64], WireError> {
        let order = || WireError::Order {
            what: "there is no reserved message with columns",
        };
        let (header, filled) = self.reserved.as_mut().ok_or_else(order)?;
        let record = header.kind().and_then(ColumnSet::of).ok_or_else(order)?;
        let (index, range) = self.catalogue.column(record, name, header.count as usize)?;
        filled[index] = true;
        let payload = self.transport.loaned().ok_or_else(order)?;
        payload.get_mut(range).ok_or_else(order)
    }

    /// The same, as doubles.
    pub fn column_mut(&mut self, name: &str) -> Result<&mut [f64], WireError> {
        Ok(words::doubles_mut(self.column_words_mut(name)?))
    }

    /// Sends the reserved message, once every column of it was asked for.
    pub fn send(&mut self) -> Result<(), WireError> {
        let (header, filled) = self.reserved.take().ok_or(WireError::Order {
            what: "there is no reserved message to send",
        })?;
        if let Some(record) = header.kind().and_then(ColumnSet::of) {
            let mut fields = self.catalogue.of(record).zip(&filled);
            if let Some((field, _)) = fields.find(|(_, filled)| !**filled) {
                return Err(WireError::Unfilled {
                    name: field.name.clone(),
                });
            }
        }
        self.transport.send()
    }

    /// Waits at most `patience` for the next message and checks it. What the other end reports as
    /// its failure is an error here.
    pub fn receive(&mut self, patience: Duration) -> Result<Option<Header>, WireError> {
        if !self.transport.receive(patience)? {
            return Ok(None);
        }
        let header = self.header()?;
        self.check(&header)?;
        if header.kind() == Some(MessageKind::Failed) {
            return Err(WireError::Failed {
                kind: SolverFailure::from_number(header.count),
                text: self.text()?.to_owned(),
            });
        }
        Ok(Some(header))
    }

    /// Header of the message received last.
    pub fn header(&self) -> Result<Header, WireError> {
        let message = self.transport.received().ok_or(NOTHING)?;
        Ok(*message.0)
    }

    /// Payload of the message received last.
    pub fn payload(&self) -> Result<&[u64], WireError> {
        Ok(self.transport.received().ok_or(NOTHING)?.1)
    }

    /// A column of the message received last, in place.
    pub fn column_words(&self, name: &str) -> Result<&[u64], WireError> {
        let (header, payload) = self.transport.received().ok_or(NOTHING)?;
        let record = header.kind().and_then(ColumnSet::of).ok_or(NOTHING)?;
        let (_, range) = self.catalogue.column(record, name, header.count as usize)?;
        payload.get(range).ok_or(NOTHING)
    }

    /// The same, as doubles.
    pub fn column(&self, name: &str) -> Result<&[f64], WireError> {
        Ok(words::doubles(self.column_words(name)?))
    }

    /// The text of the message received last.
    pub fn text(&self) -> Result<&str, WireError> {
        let (header, payload) = self.transport.received().ok_or(NOTHING)?;
        let bytes = words::bytes(payload, header.bytes as usize);
        std::str::from_utf8(bytes).map_err(|error| WireError::Text {
            detail: error.to_string(),
        })
    }

    fn addressed(&self, header: Header, count: u64, bytes: u64) -> Header {
        Header {
            magic: MAGIC,
            version: VERSION,
            run: self.run,
            rank: self.rank,
            count,
            bytes,
            ..header
        }
    }

    fn check(&self, header: &Header) -> Result<(), WireError> {
        let same = |what, found, expected| {
            if found == expected {
                return Ok(());
            }
            Err(WireError::Foreign {
                what,
                found,
                expected,
            })
        };
        same("mark", header.magic, MAGIC)?;
        same("version", header.version.into(), VERSION.into())?;
        same("run", header.run, self.run)?;
        same("rank", header.rank.into(), self.rank.into())?;
        let held = 8 * self.payload()?.len() as u64;
        let kind = header.kind().ok_or(WireError::Unexpected {
            found: header.kind,
            expected: "a known kind",
        })?;
        match ColumnSet::of(kind) {
            None => same(
                "length (at most held)",
                header.bytes.min(held),
                header.bytes,
            ),
            Some(record) => {
                let words = usize::try_from(header.count)
                    .ok()
                    .and_then(|count| self.catalogue.words(record, count));
                let bytes = words.map_or(u64::MAX, |words| 8 * words as u64);
                same("length", header.bytes, bytes)?;
                same(
                    "length (at most held)",
                    header.bytes.min(held),
                    header.bytes,
                )
            }
        }
    }
}

/// What an end says of itself: the solver, and its process.
fn introduction(ours: &Hello) -> String {
    ours.to_text() + &Process::own().line()
}

const NOTHING: WireError = WireError::Order {
    what: "no message was received that has this",
};
