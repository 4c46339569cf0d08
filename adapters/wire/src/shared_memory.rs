//! The shared-memory transport: iceoryx2, one pair of publish-subscribe services and one pair of event
//! services per link, in a configuration that is private to the run.

use std::os::unix::ffi::OsStrExt;
use std::time::{Duration, Instant};

use iceoryx2::port::BackpressureAction;
use iceoryx2::port::listener::{Listener, ListenerWaitError};
use iceoryx2::port::notifier::Notifier;
use iceoryx2::port::publisher::Publisher;
use iceoryx2::port::subscriber::Subscriber;
use iceoryx2::prelude::*;
use iceoryx2::sample::Sample;

use crate::error::WireError;
use crate::record::Header;
use crate::run::LinkAddress;
use crate::transport::Transport;
use crate::watch::Watch;
use crate::words::{self, LINE, ReservedMessage};

type Ipc = ipc_threadsafe::Service;

/// Messages that may wait unread: a commit, and the start that follows it.
const BUFFER: usize = 2;
/// Slots of a segment: waiting, read, being written, and one that iceoryx2 adds.
const SLOTS: u64 = BUFFER as u64 + 3;
/// Bytes of shared memory that must be free where an end is opened: its first segment and what iceoryx2 keeps.
const MARGIN: u64 = 1 << 20;
/// How long a full buffer may stay full before sending fails.
const FULL_FOR: Duration = Duration::from_millis(500);
/// How long a solver waits before it looks at the coordinator again.
const LOOK: Duration = Duration::from_millis(50);

/// Which end of a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinkEnd {
    /// Asks.
    Coordinator,
    /// Answers, and watches the coordinator's life.
    Solver,
}

/// Ports of one end; dropped in this order, the node last.
struct Ports {
    loan: Option<ReservedMessage>,
    words: usize,
    /// Where payloads lay and how many words of them are known to have memory behind them.
    backed: Vec<(usize, usize)>,
    received: Option<Sample<Ipc, [u64], Header>>,
    publisher: Publisher<Ipc, [u64], Header>,
    subscriber: Subscriber<Ipc, [u64], Header>,
    notifier: Notifier<Ipc>,
    listener: Listener<Ipc>,
    _node: Node<Ipc>,
}

/// One end of a link in shared memory.
pub struct SharedMemory {
    ports: Option<Ports>,
    address: LinkAddress,
    peer: Option<Watch>,
}

/// An error of the layer below as ours; its errors are plain enums that only print.
fn failed<E: std::fmt::Debug>(doing: &'static str) -> impl FnOnce(E) -> WireError {
    move |error| WireError::SharedMemory {
        doing,
        detail: format!("{error:?}"),
    }
}

impl SharedMemory {
    /// Opens one end of a rank's link, whoever comes first.
    pub fn open(address: &LinkAddress, rank: u32, end: LinkEnd) -> Result<Self, WireError> {
        set_log_level(LogLevel::Fatal);
        check_room(MARGIN)?;
        let peer = match end {
            LinkEnd::Coordinator => None,
            LinkEnd::Solver => Some(Watch::living(address)?),
        };
        let prefix = format!("{}_", address.name);
        let mut config = Config::default();
        config.global.prefix =
            FileName::new(prefix.as_bytes()).map_err(failed("naming the run"))?;
        let root = Path::new(address.root.as_os_str().as_bytes())
            .map_err(failed("naming the run's directory"))?;
        config.global.set_root_path(&root);
        let node = NodeBuilder::new()
            .config(&config)
            .signal_handling_mode(SignalHandlingMode::Disabled)
            .create::<Ipc>()
            .map_err(failed("joining the run"))?;
        address.make_private();
        let ports = Ports::open(node, address, rank, end)?;
        Ok(Self {
            ports: Some(ports),
            address: address.clone(),
            peer,
        })
    }

    fn ports(&mut self) -> Result<&mut Ports, WireError> {
        let pid = self.peer.as_ref().map_or(0, Watch::pid);
        self.ports.as_mut().ok_or(WireError::PeerDead { pid })
    }

    /// Leaves the run of a dead coordinator and removes its files.
    fn bury(&mut self, pid: u32) -> WireError {
        self.ports = None;
        self.address.remove_files();
        WireError::PeerDead { pid }
    }

    fn dead_peer(&self) -> Option<u32> {
        let peer = self.peer.as_ref()?;
        peer.is_dead().then_some(peer.pid())
    }
}

impl Ports {
    fn open(
        node: Node<Ipc>,
        address: &LinkAddress,
        rank: u32,
        end: LinkEnd,
    ) -> Result<Self, WireError> {
        let name = |direction: &str| {
            ServiceName::new(&format!("{}-{rank}-{direction}", address.role))
                .map_err(failed("naming a link"))
        };
        let (ours, theirs) = match end {
            LinkEnd::Coordinator => (name("down")?, name("up")?),
            LinkEnd::Solver => (name("up")?, name("down")?),
        };
        // With words' own alignment: asked for lines, iceoryx2 0.10 pads each word to a line and loses a slot of
        // the segment whenever it grows.
        let messages = |name: &ServiceName| {
            node.service_builder(name)
                .publish_subscribe::<[u64]>()
                .user_header::<Header>()
                .max_publishers(1)
                .max_subscribers(1)
                .subscriber_max_buffer_size(BUFFER)
                .subscriber_max_borrowed_samples(1)
                .history_size(0)
                .enable_safe_overflow(false)
                .open_or_create()
                .map_err(failed("opening a link"))
        };
        let events = |name: &ServiceName| {
            node.service_builder(name)
                .event()
                .max_notifiers(1)
                .max_listeners(1)
                .open_or_create()
                .map_err(failed("opening a link's events"))
        };
        let subscriber = messages(&theirs)?
            .subscriber_builder()
            .create()
            .map_err(failed("connecting to a link"))?;
        let listener = events(&theirs)?
            .listener_builder()
            .create()
            .map_err(failed("listening to a link"))?;
        let publisher = messages(&ours)?
            .publisher_builder()
            .initial_max_slice_len(1024)
            .max_loaned_samples(1)
            .allocation_strategy(AllocationStrategy::PowerOfTwo)
            .set_backpressure_handler(|info| {
                if info.elapsed_time > FULL_FOR {
                    return BackpressureAction::DiscardDataAndFail;
                }
                std::thread::sleep(Duration::from_micros(50));
                BackpressureAction::Retry
            })
            .create()
            .map_err(failed("writing to a link"))?;
        let notifier = events(&ours)?
            .notifier_builder()
            .create()
            .map_err(failed("notifying a link"))?;
        Ok(Self {
            loan: None,
            words: publisher.initial_max_slice_len(),
            backed: Vec::new(),
            received: None,
            publisher,
            subscriber,
            notifier,
            listener,
            _node: node,
        })
    }

    /// A segment larger than the memory is granted and then kills the process by SIGBUS when it is
    /// filled, so the room for a larger one is checked before it is asked for.
    fn make_room(&mut self, words: usize) -> Result<(), WireError> {
        if words <= self.words {
            return Ok(());
        }
        let segment = words.checked_next_power_of_two().unwrap_or(usize::MAX);
        check_room((segment as u64).saturating_mul(8 * SLOTS))?;
        self.words = segment;
        // A new segment has other places.
        self.backed.clear();
        Ok(())
    }

    /// Makes sure, once for each place and length, that a payload has memory behind it: other ranks may have
    /// taken what was free when the room was checked.
    fn back(&mut self, loan: &mut ReservedMessage) -> Result<(), WireError> {
        let payload = loan.payload_mut();
        let (place, words) = (payload.as_ptr() as usize, payload.len());
        let known = self.backed.iter_mut().find(|known| known.0 == place);
        if known.as_ref().is_some_and(|known| known.1 >= words) {
            return Ok(());
        }
        words::back(payload).map_err(|_| WireError::SharedMemoryFull {
            free: free_memory().unwrap_or(0),
            needed: 8 * words as u64,
        })?;
        match known {
            Some(known) => known.1 = words,
            None => self.backed.push((place, words)),
        }
        Ok(())
    }

    fn send(&mut self) -> Result<(), WireError> {
        let loan = self.loan.take().ok_or(WireError::Order {
            what: "there is no reserved message to send",
        })?;
        let receivers = words::filled(loan)
            .send()
            .map_err(failed("sending a message"))?;
        if receivers != 1 {
            return Err(WireError::NotDelivered { receivers });
        }
        self.notifier
            .notify()
            .map_err(failed("waking the other end"))?;
        Ok(())
    }
}

/// Bytes of shared memory that are free.
fn free_memory() -> Result<u64, WireError> {
    let memory = rustix::fs::statvfs("/dev/shm").map_err(failed("measuring /dev/shm"))?;
    Ok(memory.f_bavail * memory.f_frsize)
}

fn check_room(needed: u64) -> Result<(), WireError> {
    let free = free_memory()?;
    if free < needed {
        return Err(WireError::SharedMemoryFull { free, needed });
    }
    Ok(())
}

impl Transport for SharedMemory {
    fn loan(&mut self, header: Header, words: usize) -> Result<&mut [u64], WireError> {
        let ports = self.ports()?;
        ports.loan = None;
        // Room to begin at a line, which also gives an empty message a place of its own in a segment.
        let words = words.saturating_add(LINE - 1);
        ports.make_room(words)?;
        let mut loan = ports
            .publisher
            .loan_slice_uninit(words)
            .map_err(failed("reserving a message"))?;
        *loan.user_header_mut() = header;
        ports.back(&mut loan)?;
        let payload = words::mapped(ports.loan.insert(loan).payload_mut());
        let start = words::line_start(payload);
        Ok(&mut payload[start..])
    }

    fn loaned(&mut self) -> Option<&mut [u64]> {
        let loan = self.ports.as_mut()?.loan.as_mut()?;
        let payload = words::mapped(loan.payload_mut());
        let start = words::line_start(payload);
        Some(&mut payload[start..])
    }

    fn send(&mut self) -> Result<(), WireError> {
        let sent = self.ports().and_then(Ports::send);
        match (sent, self.dead_peer()) {
            // Nobody else may be left to remove the files.
            (Err(_), Some(pid)) => Err(self.bury(pid)),
            (sent, _) => sent,
        }
    }

    fn receive(&mut self, patience: Duration) -> Result<bool, WireError> {
        let begun = Instant::now();
        // Dropped before the next is taken: only one may be held.
        self.ports()?.received = None;
        loop {
            // Looked at before the queue, so that a last word of the dead is still heard.
            let dead = self.dead_peer();
            let ports = self.ports()?;
            let message = ports.subscriber.receive();
            if let Some(message) = message.map_err(failed("receiving a message"))? {
                ports.received = Some(message);
                return Ok(true);
            }
            if let Some(pid) = dead {
                return Err(self.bury(pid));
            }
            let left = patience.saturating_sub(begun.elapsed());
            if left.is_zero() {
                return Ok(false);
            }
            match ports.listener.timed_wait(|_| {}, left.min(LOOK)) {
                // A signal, such as Ctrl-C, is dealt with elsewhere; the wait goes on.
                Ok(_) | Err(ListenerWaitError::InterruptSignal) => {}
                Err(error) => return Err(failed("waiting for a message")(error)),
            }
        }
    }

    fn received(&self) -> Option<(&Header, &[u64])> {
        let message = self.ports.as_ref()?.received.as_ref()?;
        let payload = message.payload();
        Some((
            message.user_header(),
            &payload[words::line_start(payload)..],
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::MessageKind;
    use crate::run::RunDirectory;

    #[test]
    fn a_message_larger_than_the_memory_is_refused_with_both_numbers() {
        let run = RunDirectory::create().unwrap();
        let mut end = SharedMemory::open(&run.address("gas"), 0, LinkEnd::Coordinator).unwrap();
        let header = Header::of(MessageKind::Start);
        // 2^44 words in 5 slots, the first line of each included.
        let error = end
            .loan(header, (1 << 44) - 8)
            .map(|_| ())
            .unwrap_err()
            .to_string();
        assert!(error.contains("703687441776640 bytes"), "{error}");
        assert!(end.loan(header, usize::MAX).is_err());
        assert!(end.loan(header, 1000).is_ok());
    }

    #[test]
    fn a_message_that_nobody_waits_for_is_an_error() {
        let run = RunDirectory::create().unwrap();
        let mut end = SharedMemory::open(&run.address("gas"), 0, LinkEnd::Coordinator).unwrap();
        end.loan(Header::of(MessageKind::Commit), 0).unwrap();
        let error = end.send().unwrap_err().to_string();
        assert!(error.contains("0 of 1 receivers"), "{error}");
    }
}
