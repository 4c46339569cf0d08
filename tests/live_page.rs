//! `calcine watch`: the page of a run on this machine's own address, and what flows a run tells.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use calcine::results::Summary;
use calcine::results::flows::{FlowAmount, PatchAmounts};
use calcine::results::read::Series;
use rustix::process::{Pid, Signal, kill_process};

use crate::support::program::shipped;

/// Runs the heated column for a while.
fn column(out: &Path) {
    let case = shipped("heated-column");
    let words = [
        "run",
        case.to_str().unwrap(),
        "--quiet",
        "--set",
        "time.end=20 s",
        "--out",
    ];
    let output = Command::new(env!("CARGO_BIN_EXE_calcine"))
        .args(words)
        .arg(out)
        .output()
        .unwrap();
    let code = output.status.code();
    // Quantities are expected at the end of the whole run.
    assert!([Some(0), Some(5)].contains(&code), "{output:?}");
}

/// A watch with its port.
struct Watch(Child, u16);

impl Watch {
    fn start(folder: &Path) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_calcine"))
            .args(["watch", "--port", "0"])
            .arg(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.as_mut().unwrap())
            .read_line(&mut line)
            .unwrap();
        let port = line
            .trim()
            .strip_prefix("http://127.0.0.1:")
            .and_then(|rest| rest.strip_suffix('/'));
        let port = port.unwrap_or_else(|| panic!("{line}")).parse().unwrap();
        Self(child, port)
    }

    /// Head and body of an answer.
    fn ask(&self, first: &str, host: &str) -> (String, String) {
        let mut stream = TcpStream::connect(("127.0.0.1", self.1)).unwrap();
        let request = format!("{first} HTTP/1.1\r\nHost: {host}\r\n\r\n");
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        let answer = String::from_utf8_lossy(&answer).into_owned();
        let (head, body) = answer.split_once("\r\n\r\n").unwrap();
        (head.to_owned(), body.to_owned())
    }

    fn get(&self, path: &str) -> (String, String) {
        self.ask(&format!("GET {path}"), &format!("127.0.0.1:{}", self.1))
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn a_run_is_shown_on_the_loopback_address_until_ctrl_c() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    column(&out);
    let mut watch = Watch::start(&out);
    let (head, page) = watch.get("/");
    assert!(head.starts_with("HTTP/1.1 200 OK"), "{head}");
    assert!(
        head.contains("Content-Security-Policy: default-src 'none'"),
        "{head}"
    );
    assert!(page.contains("<section id=\"live\"") && page.contains("Over time"));
    let (_, live) = watch.get("/live.json");
    let live: serde_json::Value = serde_json::from_str(&live).unwrap();
    assert_eq!(live["state"], "complete");
    assert_eq!(live["done"], 1.0);
    assert!(live["log"].as_str().unwrap().contains("heated-column"));
    let stamp = live["stamp"].as_str().unwrap();
    assert!(page.contains(&format!("data-stamp=\"{stamp}\"")));
    // What changes the results changes the stamp.
    let series = out.join("series.csv");
    let text = fs::read_to_string(&series).unwrap();
    fs::write(&series, text.clone() + text.lines().last().unwrap() + "\n").unwrap();
    let (_, live) = watch.get("/live.json");
    assert!(!live.contains(stamp));
    let (head, csv) = watch.get("/series.csv");
    assert!(head.contains("text/csv") && csv.starts_with("process_time [s],"));
    // Nothing else of the machine, and nothing for names that others may have given it.
    for path in [
        "/command.json",
        "/../case.toml",
        "/log/calcine.log",
        "/etc/passwd",
    ] {
        assert!(watch.get(path).0.starts_with("HTTP/1.1 404"), "{path}");
    }
    let foreign = watch.ask("GET /", "example.org");
    assert!(foreign.0.starts_with("HTTP/1.1 403"), "{}", foreign.0);
    let own = format!("localhost:{}", watch.1);
    assert!(watch.ask("POST /", &own).0.starts_with("HTTP/1.1 405"));
    let (head, body) = watch.ask("HEAD /", &own);
    assert!(head.starts_with("HTTP/1.1 200") && body.is_empty());
    assert!(watch.ask("nonsense", &own).0.starts_with("HTTP/1.1 400"));
    assert_eq!(listening(watch.1), ["0100007F"]);
    let pid = Pid::from_raw(watch.0.id().cast_signed()).unwrap();
    kill_process(pid, Signal::INT).unwrap();
    assert_eq!(watch.0.wait().unwrap().code(), Some(0));
}

/// Addresses at which a port is listened on, as Linux tells them.
fn listening(port: u16) -> Vec<String> {
    let end = format!(":{port:04X}");
    let table = ["tcp", "tcp6"]
        .map(|name| fs::read_to_string(format!("/proc/net/{name}")).unwrap_or_default());
    let rows = table.iter().flat_map(|text| text.lines().skip(1));
    let rows = rows.filter_map(|row| {
        let words: Vec<&str> = row.split_whitespace().collect();
        // State 0A: listening.
        (words[3] == "0A").then(|| words[1].strip_suffix(&end).map(str::to_owned))?
    });
    rows.collect()
}

#[test]
fn a_folder_without_a_run_and_a_port_that_is_taken_are_refused() {
    let scratch = tempfile::tempdir().unwrap();
    let watch = |words: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_calcine"))
            .arg("watch")
            .args(words)
            .output()
            .unwrap();
        (
            output.status.code(),
            String::from_utf8_lossy(&output.stderr).into_owned(),
        )
    };
    let folder = scratch.path().to_str().unwrap();
    let (code, told) = watch(&[folder]);
    assert_eq!(code, Some(2));
    assert!(
        told.contains("it holds no summary.json") && told.contains("help:"),
        "{told}"
    );
    let out = scratch.path().join("out");
    column(&out);
    let first = Watch::start(&out);
    let (code, told) = watch(&[out.to_str().unwrap(), "--port", &first.1.to_string()]);
    assert_eq!(code, Some(2));
    assert!(
        told.contains("cannot be listened on") && told.contains("--port 0"),
        "{told}"
    );
}

#[test]
fn the_flows_of_a_run_close_as_its_ledger_does() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    column(&out);
    let summary = Summary::read(&out).unwrap();
    let flows = &summary.flows;
    assert!((flows.over_s - summary.process_time_s).abs() < 1e-9);
    for (ways, line) in [(&flows.mass_kg, "mass"), (&flows.energy_j, "energy")] {
        let line = &summary.ledger.lines[line];
        let net: f64 = ways.values().map(|way| way.inward - way.outward).sum();
        assert!(
            (net + line.drift).abs() < 1e-12 * line.throughput,
            "{net} {line:?}"
        );
    }
    // What passed the patches is what passed the boundary.
    let boundary = [flows.mass_kg["boundary"], flows.energy_j["boundary"]];
    let sum = |of: fn(&PatchAmounts) -> FlowAmount| {
        let amounts = flows.patches.iter().map(of);
        amounts.fold([0.0; 2], |[net, all], one| {
            [
                net + one.inward - one.outward,
                all + one.inward + one.outward,
            ]
        })
    };
    let patches = [sum(|one| one.mass_kg), sum(|one| one.heat_j)];
    for (way, [net, all]) in boundary.iter().zip(patches) {
        let off = way.inward - way.outward - net;
        assert!(all > 0.0 && off.abs() < 1e-12 * all, "{way:?} {net} {all}");
    }
    // Ten spheres of 10 mm, 2500 kg/m3 and 840 J/kg/K took what their mean temperature tells.
    let series = Series::read(&out).unwrap();
    let mean = series.column("particles.temperature_mean").last().unwrap();
    let capacity = 10.0 * std::f64::consts::PI / 6.0 * 0.01_f64.powi(3) * 2500.0 * 840.0;
    let particles = flows.energy_j["particles"];
    let heat = capacity * (mean - 300.0);
    assert!(
        heat > 1.0 && (particles.outward / heat - 1.0).abs() < 1e-9,
        "{particles:?} {heat}"
    );
    assert_eq!(particles.inward, 0.0);
}

#[test]
fn a_run_without_a_checkpoint_yet_is_told_by_the_last_row_of_its_series() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    column(&out);
    // As a run writes it at its start.
    let path = out.join("summary.json");
    let text = fs::read_to_string(&path).unwrap();
    let mut summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    summary["verdict"] = "running".into();
    summary["windows"] = 0.into();
    for quantity in summary["quantities"].as_object_mut().unwrap().values_mut() {
        quantity["value"] = serde_json::Value::Null;
        quantity["at_s"] = serde_json::Value::Null;
    }
    fs::write(&path, summary.to_string()).unwrap();
    let now = Summary::now(&out).unwrap();
    let series = Series::read(&out).unwrap();
    for (name, quantity) in &now.quantities {
        let column = series.column(&format!("quantities.{name}"));
        assert_eq!(quantity.value, column.last().copied(), "{name}");
        assert_eq!(quantity.at_s, Some(20.0), "{name}");
    }
    assert!(now.quantities.len() > 1 && now.windows > 0);
    assert!(now.wall_time_s.total.is_nan() && now.ledger.lines.is_empty());
}
