//! What comes over the network: which requests are let in, and what they ask for.

use std::{
    io::{BufRead, Read},
    net::SocketAddr,
};

/// The longest head and the longest body (bytes).
const HEAD_MOST: u64 = 16 << 10;
const BODY_MOST: u64 = 256 << 10;

/// A request that was read.
#[derive(Debug, Default, PartialEq)]
pub struct Request {
    method: String,
    target: String,
    host: Option<String>,
    origin: Option<String>,
    length: u64,
    /// What was sent with it.
    pub body: Vec<u8>,
}

/// What a request asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Asked {
    /// The page.
    Page,
    /// Its script.
    Script,
    /// The player's script.
    Player,
    /// What changes, as it changes.
    Events,
    /// Another level or other values.
    Set,
    /// A value to be written into the scene.
    Write,
}

/// Why a request is refused: an HTTP status.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct Refused(pub &'static str);

impl Request {
    /// Reads a request; `None` if it is not one, or too long.
    pub fn read(from: &mut impl BufRead) -> Option<Self> {
        let mut head = from.by_ref().take(HEAD_MOST);
        let mut line = || {
            let mut line = String::new();
            head.read_line(&mut line).ok()?;
            line.strip_suffix('\n').map(|line| line.trim_end_matches('\r').to_owned())
        };
        let first = line()?;
        let mut words = first.split(' ');
        let mut request = Self { method: words.next()?.into(), target: words.next()?.into(), ..Self::default() };
        loop {
            let field = line()?;
            if field.is_empty() {
                break;
            }
            let (name, value) = field.split_once(':')?;
            let value = value.trim().to_owned();
            match name.to_ascii_lowercase().as_str() {
                // Twice the same is nothing that a browser sends.
                "host" if request.host.replace(value.clone()).is_some() => return None,
                "origin" if request.origin.replace(value.clone()).is_some() => return None,
                "content-length" => request.length = value.parse().ok()?,
                "transfer-encoding" => return None,
                _ => {}
            }
        }
        if request.length > BODY_MOST {
            return None;
        }
        from.take(request.length).read_to_end(&mut request.body).ok()?;
        Some(request)
    }

    /// What it asks of the server at `address`, if it knows the `token` and comes from its own page.
    ///
    /// # Errors
    /// [`Refused`]: another host or origin, another token, another path.
    pub fn asked(&self, address: SocketAddr, token: &str) -> Result<Asked, Refused> {
        let hosts = [address.to_string(), format!("localhost:{}", address.port())];
        let is_own = |host: &str| hosts.iter().any(|own| own == host);
        if !self.host.as_deref().is_some_and(is_own) {
            return Err(Refused("403 Forbidden"));
        }
        let origin = self.origin.as_deref().map(|origin| origin.strip_prefix("http://").is_some_and(is_own));
        // A browser states the origin of whatever changes something.
        if !origin.unwrap_or(self.method == "GET") {
            return Err(Refused("403 Forbidden"));
        }
        let path =
            self.target.strip_prefix('/').and_then(|path| path.strip_prefix(token)).ok_or(Refused("403 Forbidden"))?;
        match (self.method.as_str(), path) {
            ("GET", "/") => Ok(Asked::Page),
            ("GET", "/watch.js") => Ok(Asked::Script),
            ("GET", "/player.js") => Ok(Asked::Player),
            ("GET", "/events") => Ok(Asked::Events),
            ("POST", "/set") => Ok(Asked::Set),
            ("POST", "/write") => Ok(Asked::Write),
            _ => Err(Refused("404 Not Found")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(head: &str) -> Result<Asked, Refused> {
        let text = format!("{}\r\n\r\n", head.replace('\n', "\r\n"));
        let request = Request::read(&mut text.as_bytes()).unwrap();
        request.asked(SocketAddr::from(([127, 0, 0, 1], 4000)), "secret")
    }

    #[test]
    fn own_requests_are_let_in() {
        assert_eq!(asked("GET /secret/ HTTP/1.1\nHost: 127.0.0.1:4000"), Ok(Asked::Page));
        assert_eq!(asked("GET /secret/events HTTP/1.1\nhost: localhost:4000"), Ok(Asked::Events));
        let own = "POST /secret/set HTTP/1.1\nHost: 127.0.0.1:4000\nOrigin: http://127.0.0.1:4000";
        assert_eq!(asked(own), Ok(Asked::Set));
    }

    #[test]
    fn others_are_refused() {
        for head in [
            "GET / HTTP/1.1\nHost: 127.0.0.1:4000",
            "GET /other/ HTTP/1.1\nHost: 127.0.0.1:4000",
            "GET /secret/ HTTP/1.1",
            "GET /secret/ HTTP/1.1\nHost: evil.example",
            "GET /secret/ HTTP/1.1\nHost: 127.0.0.1:4000\nOrigin: http://evil.example",
            "GET /secret/ HTTP/1.1\nHost: 127.0.0.1:4000\nOrigin: null",
            "POST /secret/set HTTP/1.1\nHost: 127.0.0.1:4000",
        ] {
            assert_eq!(asked(head), Err(Refused("403 Forbidden")), "{head}");
        }
        for path in ["../etc/passwd", "..", "%2e%2e/x", "scene.toml", "/"] {
            let head = format!("GET /secret/{path} HTTP/1.1\nHost: 127.0.0.1:4000");
            assert_eq!(asked(&head), Err(Refused("404 Not Found")), "{path}");
        }
    }

    #[test]
    fn what_is_no_request_or_too_long_is_not_read() {
        for text in [
            "",
            "GET\r\n\r\n",
            "GET / HTTP/1.1\r\nHost: a\r\n",
            "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n",
            "POST / HTTP/1.1\r\nContent-Length: 999999999\r\n\r\n",
        ] {
            assert_eq!(Request::read(&mut text.as_bytes()), None, "{text}");
        }
        let long = format!("GET /{} HTTP/1.1\r\n\r\n", "a".repeat(HEAD_MOST as usize));
        assert_eq!(Request::read(&mut long.as_bytes()), None);
    }
}
