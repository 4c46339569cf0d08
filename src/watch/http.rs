//! As much of HTTP/1.1 as a page on this machine needs: GET and HEAD, one request a connection.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Bytes of a request's head at most.
const HEAD: u64 = 16_384;
/// A request that takes longer is given up.
const DEADLINE: Duration = Duration::from_secs(10);
/// What a page may load: nothing but what it asks this server for.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; connect-src 'self'; \
                      base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// What is sent.
pub(super) enum Body {
    /// A text.
    Text(String),
    /// A file.
    File(PathBuf),
}

/// An answer.
pub(super) struct Answer {
    status: &'static str,
    kind: &'static str,
    body: Body,
}

impl Answer {
    /// What was asked for.
    pub fn ok(kind: &'static str, body: Body) -> Self {
        Self {
            status: "200 OK",
            kind,
            body,
        }
    }

    /// There is no such thing.
    pub fn missing() -> Self {
        Self::told("404 Not Found", "there is nothing here")
    }

    fn told(status: &'static str, text: &str) -> Self {
        Self {
            status,
            kind: "text/plain; charset=utf-8",
            body: Body::Text(format!("{text}\n")),
        }
    }

    fn send(self, stream: &mut TcpStream, whole: bool) -> io::Result<()> {
        let file = match &self.body {
            Body::Text(_) => None,
            Body::File(path) => Some(File::open(path)?),
        };
        let length = match (&self.body, &file) {
            (Body::Text(text), _) => text.len() as u64,
            (_, Some(file)) => file.metadata()?.len(),
            _ => 0,
        };
        let head = format!(
            "HTTP/1.1 {}\r\nContent-Type: {}\r\nContent-Length: {length}\r\nCache-Control: no-store\r\n\
             X-Content-Type-Options: nosniff\r\nContent-Security-Policy: {POLICY}\r\nConnection: close\r\n\r\n",
            self.status, self.kind
        );
        stream.write_all(head.as_bytes())?;
        match (self.body, file) {
            _ if !whole => {}
            (Body::Text(text), _) => stream.write_all(text.as_bytes())?,
            // No more than was told: a run may add to it.
            (_, Some(file)) => {
                io::copy(&mut file.take(length), stream)?;
            }
            _ => {}
        }
        stream.flush()
    }
}

/// The media type of a file by its ending.
pub(super) fn kind_of(path: &Path) -> &'static str {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("csv") => "text/csv; charset=utf-8",
        Some("json") => "application/json",
        Some("toml") => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}

/// A request, as far as it matters.
struct Request {
    method: String,
    path: String,
    host: String,
}

/// Reads a request and sends what `find` gives for its path.
pub(super) fn answer(
    mut stream: TcpStream,
    port: u16,
    find: impl FnOnce(&str) -> Answer,
) -> io::Result<()> {
    stream.set_read_timeout(Some(DEADLINE))?;
    stream.set_write_timeout(Some(DEADLINE))?;
    let Some(request) = request(&stream)? else {
        return Answer::told("400 Bad Request", "this is no request").send(&mut stream, true);
    };
    let whole = request.method != "HEAD";
    let answer = if !["GET", "HEAD"].contains(&request.method.as_str()) {
        Answer::told("405 Method Not Allowed", "only GET and HEAD are answered")
    } else if !is_own(&request.host, port) {
        // A page from elsewhere whose name leads to this machine.
        Answer::told("403 Forbidden", "this page is for this machine only")
    } else {
        find(request.path.split(['?', '#']).next().unwrap_or_default())
    };
    answer.send(&mut stream, whole)
}

/// True of the names that this machine calls itself by.
fn is_own(host: &str, port: u16) -> bool {
    ["127.0.0.1", "localhost"]
        .iter()
        .any(|name| host == format!("{name}:{port}") || port == 80 && host == *name)
}

/// Reads a head to its end, so that nothing is left unread where the answer closes the connection; `None` where it is none.
fn request(stream: &TcpStream) -> io::Result<Option<Request>> {
    let lines = BufReader::new(stream.take(HEAD)).lines();
    let mut head = Vec::new();
    for line in lines {
        let line = line?;
        if line.is_empty() {
            break;
        }
        head.push(line);
    }
    let mut head = head.iter();
    let words: Vec<&str> = head
        .next()
        .map_or(Vec::new(), |first| first.split_whitespace().collect());
    let [method, path, version] = words[..] else {
        return Ok(None);
    };
    if !version.starts_with("HTTP/1.") {
        return Ok(None);
    }
    let named = head.filter_map(|line| line.split_once(':'));
    let mut hosts = named.filter(|(name, _)| name.eq_ignore_ascii_case("host"));
    Ok(Some(Request {
        method: method.into(),
        path: path.into(),
        host: hosts
            .next()
            .map_or(String::new(), |(_, host)| host.trim().into()),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_this_machine_are_answered() {
        assert!(is_own("127.0.0.1:8137", 8137) && is_own("localhost:8137", 8137));
        for other in [
            "",
            "127.0.0.1",
            "127.0.0.1:80",
            "example.org:8137",
            "localhost.example.org:8137",
        ] {
            assert!(!is_own(other, 8137), "{other}");
        }
    }
}
