//! What every transport must do, written once. A transport joins by giving two connected ends.

use std::time::{Duration, Instant};

use calcine_wire::hello::NEW;
use calcine_wire::{
    Catalogue, Header, Hello, Link, MessageKind, RunDirectory, Transport, WireError,
};

const SOON: Duration = Duration::from_secs(5);

/// Two connected ends, and what keeps them alive.
pub struct Ends {
    pub coordinator: Box<dyn Transport + Send>,
    pub solver: Box<dyn Transport + Send>,
    pub number: u64,
    pub run: Option<RunDirectory>,
}

fn hello(name: &str) -> Hello {
    Hello {
        role: "gas".into(),
        name: name.into(),
        version: "1".into(),
        case_hash: "c".into(),
        mesh_hash: "m".into(),
        origin: NEW.into(),
        count: 4,
        ranks: 1,
        catalogue: Catalogue::standard("gas").unwrap(),
    }
}

/// Two links after their handshake.
fn connected(ends: Ends) -> (Link, Link, Option<RunDirectory>) {
    let mut coordinator = Link::new(ends.coordinator, ends.number, 0);
    let mut solver = Link::new(ends.solver, ends.number, 0);
    let solver = std::thread::spawn(move || {
        solver.greet(&hello("solver"), SOON).unwrap();
        solver
    });
    coordinator.receive(SOON).unwrap().unwrap();
    let theirs = coordinator.answer_greeting(&hello("coordinator")).unwrap();
    assert_eq!(theirs.name, "solver");
    (coordinator, solver.join().unwrap(), ends.run)
}

pub fn a_message_arrives_with_its_header_and_aligned_words(mut ends: Ends) {
    for words in [0usize, 1, 100, 1 << 20, 3] {
        let header = Header {
            window: words as u64,
            ..Header::of(MessageKind::Start)
        };
        let payload = ends.coordinator.loan(header, words).unwrap();
        for (index, word) in payload.iter_mut().enumerate() {
            *word = index as u64;
        }
        ends.coordinator.send().unwrap();
        assert!(ends.solver.receive(SOON).unwrap());
        let (received, payload) = ends.solver.received().unwrap();
        assert_eq!(received.window, words as u64);
        assert!(payload.len() >= words);
        assert!((0..words).all(|index| payload[index] == index as u64));
        assert_eq!(payload.as_ptr() as usize % 64, 0);
    }
}

/// A solver holds a message until it asks for the next; meanwhile the next is written, larger than any before or
/// as large. Measured against 255, the segments that iceoryx2 may ever make for a link.
pub fn messages_grow_while_the_last_is_held_and_then_go_on(mut ends: Ends) {
    for count in 0..600_u32 {
        let words = 2000_usize << (count / 20).min(9);
        let payload = ends.coordinator.loan(Header::of(MessageKind::Start), words);
        let payload = payload.unwrap_or_else(|error| panic!("message {count}: {error}"));
        payload[words - 1] = u64::from(count);
        ends.coordinator.send().unwrap();
        assert!(ends.solver.receive(SOON).unwrap());
        assert_eq!(
            ends.solver.received().unwrap().1[words - 1],
            u64::from(count)
        );
    }
}

pub fn nothing_arrives_within_the_patience_and_no_earlier(mut ends: Ends) {
    let begun = Instant::now();
    assert!(!ends.solver.receive(Duration::from_millis(120)).unwrap());
    assert!(begun.elapsed() >= Duration::from_millis(120));
    assert!(!ends.coordinator.receive(Duration::ZERO).unwrap());
}

pub fn a_commit_and_the_next_start_may_wait_together_in_order(ends: Ends) {
    let (mut coordinator, mut solver, _run) = connected(ends);
    coordinator
        .send_plain(Header::of(MessageKind::Commit))
        .unwrap();
    coordinator
        .send_text(Header::of(MessageKind::Checkpoint), "/x")
        .unwrap();
    let first = solver.receive(SOON).unwrap().unwrap();
    let second = solver.receive(SOON).unwrap().unwrap();
    assert_eq!(first.kind(), Some(MessageKind::Commit));
    assert_eq!(second.kind(), Some(MessageKind::Checkpoint));
    assert_eq!(solver.text().unwrap(), "/x");
}

pub fn a_full_buffer_fails_instead_of_hanging(mut ends: Ends) {
    let begun = Instant::now();
    let mut sent = 0;
    while begun.elapsed() < SOON {
        ends.coordinator
            .loan(Header::of(MessageKind::Commit), 0)
            .unwrap();
        match ends.coordinator.send() {
            Ok(()) => sent += 1,
            Err(_) => break,
        }
    }
    assert!(sent >= 2 && begun.elapsed() < SOON, "{sent} messages");
}

pub fn a_message_with_an_unfilled_column_stays(ends: Ends) {
    let (mut coordinator, mut solver, _run) = connected(ends);
    coordinator.loan(Header::of(MessageKind::Start), 4).unwrap();
    coordinator.column_mut("void_fraction").unwrap().fill(1.0);
    let error = coordinator.send().unwrap_err();
    assert!(error.to_string().contains("drag_coefficient"), "{error}");
    assert!(solver.receive(Duration::from_millis(20)).unwrap().is_none());
}

pub fn a_message_of_another_run_is_refused(ends: Ends) {
    let (mut coordinator, mut solver) = (ends.coordinator, Link::new(ends.solver, 1, 0));
    coordinator
        .loan(Header::of(MessageKind::Commit), 0)
        .unwrap();
    coordinator.send().unwrap();
    let error = solver.receive(SOON).unwrap_err();
    assert!(
        matches!(error, WireError::Foreign { what: "run", .. }),
        "{error}"
    );
}

pub fn a_failure_arrives_as_an_error_with_its_words(ends: Ends) {
    let (mut coordinator, mut solver, _run) = connected(ends);
    solver
        .send_text(Header::of(MessageKind::Failed), "ε fell to 0.05")
        .unwrap();
    let error = coordinator.receive(SOON).unwrap_err();
    assert_eq!(error.to_string(), "ε fell to 0.05");
}

/// Each law as a test of each transport.
macro_rules! conformance {
    ($transport:ident) => {
        conformance!($transport:
            a_message_arrives_with_its_header_and_aligned_words,
            messages_grow_while_the_last_is_held_and_then_go_on,
            nothing_arrives_within_the_patience_and_no_earlier,
            a_commit_and_the_next_start_may_wait_together_in_order,
            a_full_buffer_fails_instead_of_hanging,
            a_message_with_an_unfilled_column_stays,
            a_message_of_another_run_is_refused,
            a_failure_arrives_as_an_error_with_its_words,
        );
    };
    ($transport:ident: $($law:ident),+ $(,)?) => {
        mod of_transport {
            $(#[test]
            fn $law() {
                crate::laws::$law(super::$transport());
            })+
        }
    };
}
