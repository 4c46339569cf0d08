//! Reports and live pages as Chromium shows them at 1400, 800 and 500 px: no error in its console, nothing cut off, all spheres drawn,
//! 3 MB at most. Needs `chromium` (Debian package of that name); it is not among the packages that `cargo xtask setup` installs.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::Duration;

use crate::{run as calcine, shipped};

/// Looks at a page from within.
const PROBE: &str = include_str!("page_probe.js");
/// Widths in px at which pages are read.
const WIDTHS: [u32; 3] = [1400, 800, 500];
/// Largest page in bytes.
const LARGEST: usize = 3_000_000;
/// Beads of the large bed.
const BEADS: usize = 100_000;

/// How long the probe is held while the page works.
const HOLD: Duration = Duration::from_millis(500);
/// An answer without a page.
const EMPTY: &[u8] = b"HTTP/1.1 204 No Content\r\nConnection: close\r\n\r\n";

/// What Chromium found in a page.
struct Found {
    spheres: usize,
    complaints: Vec<String>,
}

pub fn run() {
    if Command::new("chromium").arg("--version").output().is_err() {
        println!("  Chromium is not here: apt-get install chromium");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    the_probe_notices(folder.path());
    println!("  | page | size kB | spheres | at {WIDTHS:?} px |");
    for (name, end) in [
        ("lime-burning", "time.end=30 min"),
        ("wet-drum", "time.end=0.2 s"),
        ("ore-reduction", "time.end=2 min"),
        ("calcining-stone", "time.end=10 min"),
        ("rotating-drum", "time.end=0.1 s"),
        ("heated-column", "time.end=200 s"),
        ("pipe", "time.end=6 s"),
    ] {
        let (out, _) = calcine(&shipped(name), folder.path(), name, &[end.into()]);
        let report = fs::read(out.join("report.html")).unwrap();
        look(name, &report, None, folder.path());
        let watch = Watch::start(&out);
        let page = watch.get("/");
        look(&format!("{name}, live"), &page, Some(&watch), folder.path());
    }
    let case = folder.path().join("beads.toml");
    fs::write(&case, BED).unwrap();
    let (out, _) = calcine(&case, folder.path(), "beads", &[]);
    let report = fs::read(out.join("report.html")).unwrap();
    let spheres = look(&format!("{BEADS} beads"), &report, None, folder.path());
    assert_eq!(spheres, BEADS);
}

/// A page is looked at in every width; how many spheres it draws.
fn look(name: &str, page: &[u8], watch: Option<&Watch>, folder: &Path) -> usize {
    let found = WIDTHS.map(|width| probe(page, watch, width, folder));
    let spheres = found.iter().map(|one| one.spheres).min().unwrap();
    let told: Vec<String> = WIDTHS
        .iter()
        .zip(&found)
        .flat_map(|(width, one)| {
            one.complaints
                .iter()
                .map(move |what| format!("{width} px: {what}"))
        })
        .collect();
    let verdict = if told.is_empty() {
        "clean"
    } else {
        "see below"
    };
    println!(
        "  | {name} | {} | {spheres} | {verdict} |",
        page.len() / 1000
    );
    assert!(told.is_empty(), "{name}:\n{}", told.join("\n"));
    assert!(page.len() <= LARGEST, "{name} has {} bytes", page.len());
    spheres
}

/// A page that must be found fault with.
fn the_probe_notices(folder: &Path) {
    let page = b"<!doctype html><html><head></head><body><main><table style='width:3000px'><tr><td>wide</td></tr></table>\
        <svg width=50 height=20><text x=40 y=15>long label</text></svg><script>missing()</script></main></body></html>";
    let found = probe(page, None, 800, folder).complaints.join("\n");
    for word in [
        "page of",
        "over the edge",
        "outside of its picture",
        "error",
    ] {
        assert!(found.contains(word), "{word}: {found}");
    }
}

/// Has Chromium open a page with the probe in it.
fn probe(page: &[u8], watch: Option<&Watch>, width: u32, folder: &Path) -> Found {
    let page = String::from_utf8(page.to_vec()).unwrap();
    let head = page.find("<head>").unwrap() + "<head>".len();
    let page = format!("{}<script>{PROBE}</script>{}", &page[..head], &page[head..]);
    let server = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = server.local_addr().unwrap().port();
    let behind = watch.map(|one| one.port);
    thread::spawn(move || {
        for stream in server.incoming().flatten() {
            let page = page.clone();
            thread::spawn(move || serve(stream, &page, behind));
        }
    });
    let output = Command::new("chromium")
        .args(["--headless", "--no-sandbox", "--dump-dom"])
        .args(["--use-gl=angle", "--use-angle=swiftshader"])
        .arg("--enable-unsafe-swiftshader")
        .arg("--virtual-time-budget=20000")
        .arg(format!("--window-size={width},900"))
        .arg(format!(
            "--user-data-dir={}",
            folder.join("chromium").display()
        ))
        .arg(format!("http://127.0.0.1:{port}/"))
        .output()
        .unwrap();
    let dom = String::from_utf8_lossy(&output.stdout);
    let told = dom
        .split_once("id=\"found\">")
        .and_then(|(_, rest)| rest.split_once("</script>"))
        .unwrap_or_else(|| panic!("{}", String::from_utf8_lossy(&output.stderr)))
        .0;
    let mut lines = told.lines().filter(|line| !line.is_empty());
    let spheres = lines.next().unwrap().strip_prefix("spheres ").unwrap();
    Found {
        spheres: spheres.parse().unwrap(),
        complaints: lines.map(ToOwned::to_owned).collect(),
    }
}

/// Answers with the page, or with what the watch behind it says.
fn serve(mut stream: TcpStream, page: &str, behind: Option<u16>) {
    let mut first = String::new();
    if BufReader::new(&stream).read_line(&mut first).is_err() {
        return;
    }
    let path = first.split(' ').nth(1).unwrap_or("/");
    if path == "/hold" {
        thread::sleep(HOLD);
        let _ = stream.write_all(EMPTY);
        return;
    }
    let answer = match behind {
        _ if path == "/" => {
            let kind = "text/html; charset=utf-8";
            let head = format!("Content-Type: {kind}\r\nContent-Length: {}", page.len());
            format!("HTTP/1.1 200 OK\r\n{head}\r\nConnection: close\r\n\r\n{page}").into_bytes()
        }
        Some(port) => ask(port, path),
        None => EMPTY.to_vec(),
    };
    let _ = stream.write_all(&answer);
}

/// The whole answer of a watch.
fn ask(port: u16, path: &str) -> Vec<u8> {
    let mut answer = Vec::new();
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    let request = format!("GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n");
    stream.write_all(request.as_bytes()).unwrap();
    stream.read_to_end(&mut answer).unwrap();
    answer
}

/// `calcine watch` of a results folder.
struct Watch {
    child: Child,
    port: u16,
}

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
        let port = line.trim().trim_end_matches('/').rsplit(':').next();
        let port = port.unwrap().parse().unwrap();
        Self { child, port }
    }

    fn get(&self, path: &str) -> Vec<u8> {
        let answer = ask(self.port, path);
        let body = answer.windows(4).position(|four| four == b"\r\n\r\n");
        answer[body.unwrap() + 4..].to_vec()
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A bed of 50 × 50 × 40 beads that stand in a flow, for one window.
const BED: &str = r#"
format = 1
title = "Beads that stand in a flow"

[time]
end = "2 s"
motion_window = "20 ms"
acceleration = 100
gas_storage = "process"

[mesh]
box = { size = "100 100 80 mm", cells = [10, 10, 8] }

[materials.glass]
density = "2500 kg/m^3"
heat_capacity = "840 J/kg/K"

[gas]
mixture = "air"
initial = { temperature = "300 K", pressure = "1 atm" }

[gas.patch.bottom]
inlet = { superficial_velocity = "0.5 m/s", temperature = "400 K" }

[gas.patch.top]
outlet = { pressure = "1 atm" }

[gas.patch.side]
wall = { velocity = "slip", heat = "adiabatic" }

[[particles]]
name = "beads"
material = "glass"
diameter = "1.9 mm"
motion = "frozen"
place = { grid = { first = "1 1 1 mm", spacing = "2 2 2 mm", counts = [50, 50, 40] } }
temperature = "300 K"

[laws]
drag = { law = "ergun-wen-yu" }
heat_transfer = { law = "gunn" }
conduction = { law = "none" }
radiation = { law = "none" }

[coupling]
mapping = "overlap"
smoother = { max_solid_fraction = 0.64 }

[output]
every = "2 s"
particles = ["temperature"]
"#;
