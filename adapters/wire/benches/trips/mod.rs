//! What a message costs by any transport: the same measurements for each, between two processes.
//!
//! The coordinator sends a message of some size, the solver answers with the time at which it had it, so that
//! what is measured is one way: from before `loan` to where the solver may read the payload in place. In
//! `filled and read` the payload is copied in by one and copied out by the other, as solvers do; beside it stands
//! a copy of as many bytes within one process.

use std::hint::black_box;
use std::time::{Duration, Instant};

use calcine_wire::{Header, MessageKind, Transport};
use criterion::{BenchmarkId, Criterion, Throughput};
use rustix::time::{ClockId, clock_gettime};

/// Payloads in bytes.
const SIZES: [usize; 3] = [8, 1_000_000, 100_000_000];
/// Longest silence, after which a benchmark ends.
const PATIENCE: Duration = Duration::from_secs(60);
/// What the solver is to do with a message, in its header's attempt.
const WAIT: u32 = 0;
const SPIN: u32 = 1;
const READ: u32 = 2;

/// Nanoseconds of the clock that all processes of a machine share.
fn now() -> u64 {
    let time = clock_gettime(ClockId::Monotonic);
    time.tv_sec as u64 * 1_000_000_000 + time.tv_nsec as u64
}

/// Waits for a message; spinning it looks again at once.
fn receive(end: &mut dyn Transport, spins: bool) {
    let begun = Instant::now();
    let slice = if spins { Duration::ZERO } else { PATIENCE };
    while !end.receive(slice).unwrap() {
        assert!(begun.elapsed() < PATIENCE, "nothing came");
    }
}

/// The solver's part: introduces itself, then answers each message with the time at which it was there, until
/// a goodbye.
pub fn answer(mut end: Box<dyn Transport + Send>) {
    end.loan(Header::of(MessageKind::Hello), 0).unwrap();
    end.send().unwrap();
    let mut copy = Vec::new();
    let mut spins = false;
    loop {
        receive(&mut *end, spins);
        let (header, payload) = end.received().unwrap();
        let order = header.attempt;
        if header.kind() == Some(MessageKind::Bye) {
            return;
        }
        if order == READ {
            copy.clear();
            copy.extend_from_slice(payload);
            black_box(&copy);
        }
        let there = now();
        end.loan(Header::of(MessageKind::Finished), 1).unwrap()[0] = there;
        end.send().unwrap();
        // How the next one is waited for.
        spins = order == SPIN;
    }
}

/// One message and its answer; how long it was under way.
fn trip(end: &mut dyn Transport, words: usize, order: u32, data: &[u64]) -> Duration {
    let header = Header {
        attempt: order,
        ..Header::of(MessageKind::Start)
    };
    let begun = now();
    let payload = end.loan(header, words).unwrap();
    if order == READ {
        payload[..words].copy_from_slice(data);
    }
    end.send().unwrap();
    receive(end, order == SPIN);
    let there = end.received().unwrap().1[0];
    Duration::from_nanos(there.saturating_sub(begun))
}

/// Measures a transport from the coordinator's end and tells the solver to end.
pub fn measure(name: &str, mut end: Box<dyn Transport + Send>, criterion: &mut Criterion) {
    receive(&mut *end, false);
    let mut group = criterion.benchmark_group(name);
    group.sample_size(20);
    group.warm_up_time(Duration::from_millis(500));
    group.measurement_time(Duration::from_secs(2));
    for bytes in SIZES {
        let words = bytes / 8;
        let data: Vec<u64> = (0..words as u64).collect();
        let mut copy = vec![0u64; words];
        group.throughput(Throughput::Bytes(bytes as u64));
        let id = |what: &str| BenchmarkId::new(what, bytes);
        group.bench_function(id("a copy within a process"), |bench| {
            bench.iter(|| black_box(&mut copy).copy_from_slice(black_box(&data)));
        });
        for (what, order) in [
            ("handed over, waiting", WAIT),
            ("handed over, spinning", SPIN),
            ("filled and read, waiting", READ),
        ] {
            // The solver learns by one message how it waits for the next.
            trip(&mut *end, words, order, &data);
            group.bench_function(id(what), |bench| {
                bench.iter_custom(|trips| {
                    (0..trips)
                        .map(|_| trip(&mut *end, words, order, &data))
                        .sum()
                });
            });
        }
    }
    group.finish();
    end.loan(Header::of(MessageKind::Bye), 0).unwrap();
    end.send().unwrap();
    end.settle(Duration::from_secs(2)).unwrap();
}
