//! Ends of logs of solvers that failed, with who it was, how it ended and what helps in their first lines: what `remedy` says of them.

use std::fs;
use std::path::Path;

use calcine_adapters::last_words::remedy;
use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::supervisor::log_end;

#[test]
fn every_end_of_a_log_gets_its_remedy() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/last_words");
    let scratch = tempfile::tempdir().unwrap();
    let mut fixtures = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let text = fs::read_to_string(&path).unwrap();
        let mut lines = text.lines();
        let [who, message, wanted] =
            [(); 3].map(|()| lines.next().unwrap().strip_prefix("# ").unwrap());
        let log = scratch.path().join("log");
        fs::write(&log, lines.collect::<Vec<_>>().join("\n")).unwrap();
        let kind = match message.starts_with("died") {
            true => FailureKind::Died,
            false => FailureKind::LostParticles,
        };
        let error = PartError::new(who, kind, message).with_log(log_end(&log));
        let found = remedy(&error).unwrap_or_default();
        assert!(found.starts_with(wanted), "{}: {found}", path.display());
        // Nobody else's words are taken for these.
        let other = PartError::new("native gas", kind, message).with_log(log_end(&log));
        assert_eq!(remedy(&other), None);
        fixtures += 1;
    }
    assert!(fixtures >= 17, "{fixtures}");
}

#[test]
fn an_error_before_a_long_trace_is_shown_with_the_end_of_the_log() {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/last_words/openfoam-temperature.log");
    let end = log_end(&path);
    assert!(end[0].contains("FOAM FATAL ERROR"), "{end:#?}");
    assert!(end[1].contains("Maximum number of iterations"), "{end:#?}");
    assert_eq!(end.last().unwrap(), "#15  ? in calcineGasFoam");
}
