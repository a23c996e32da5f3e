//! The page's server: on the loopback address, for whoever knows the token.

use std::{
    io::{BufReader, Write},
    net::{SocketAddr, TcpListener, TcpStream},
    path::PathBuf,
    sync::Arc,
    time::Duration,
};

use serde::Deserialize;

use super::{
    board::{Board, Wanted},
    knobs::{knobs, with_value},
    page::page,
    request::{Asked, Request},
};
use crate::{cli::arguments::text_of, show::player};
use slipfit_system::files;

/// How long a browser may take to send a request or to take an answer.
const PATIENCE: Duration = Duration::from_secs(10);
/// How often a stream that has no news says that it lives.
const HEARTBEAT: Duration = Duration::from_secs(5);
/// Nothing from elsewhere is loaded, and no other page shows this one.
const HEADERS: &str = "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n\
                       Cross-Origin-Resource-Policy: same-origin\r\nContent-Security-Policy: default-src 'none'; script-src 'self'; \
                       style-src 'unsafe-inline'; connect-src 'self'; img-src data:; frame-ancestors 'none'; base-uri 'none'; \
                       form-action 'none'\r\n";

/// A server that listens.
pub struct Server {
    listener: TcpListener,
    address: SocketAddr,
    shared: Arc<Shared>,
}

struct Shared {
    token: String,
    scene: PathBuf,
    board: Arc<Board>,
}

/// A value to be written into the scene.
#[derive(Deserialize)]
struct Writing {
    name: String,
    value: f64,
}

impl Server {
    /// On the loopback address, at this `port` or at a free one if it is 0.
    ///
    /// # Errors
    /// If the port is taken, or the system has no random numbers.
    pub fn bind(port: u16, scene: PathBuf, board: Arc<Board>) -> std::io::Result<Self> {
        let listener = TcpListener::bind(SocketAddr::from(([127, 0, 0, 1], port)))?;
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes).map_err(|error| std::io::Error::other(error.to_string()))?;
        let token = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Self { address: listener.local_addr()?, listener, shared: Arc::new(Shared { token, scene, board }) })
    }

    /// The page's address.
    pub fn url(&self) -> String {
        format!("http://{}/{}/", self.address, self.shared.token)
    }

    /// Answers requests in threads of its own, for as long as the process lives.
    pub fn start(self) {
        std::thread::spawn(move || {
            for stream in self.listener.incoming().flatten() {
                let (shared, address) = (self.shared.clone(), self.address);
                // Without a thread the connection closes, and the browser tries again.
                let _ = std::thread::Builder::new().spawn(move || {
                    // An answer that nobody waits for is dropped.
                    let _ = shared.answer(stream, address);
                });
            }
        });
    }
}

impl Shared {
    fn answer(&self, mut stream: TcpStream, address: SocketAddr) -> std::io::Result<()> {
        stream.set_read_timeout(Some(PATIENCE))?;
        stream.set_write_timeout(Some(PATIENCE))?;
        stream.set_nodelay(true)?;
        let Some(request) = Request::read(&mut BufReader::new(&stream)) else {
            return send(&mut stream, "400 Bad Request", "text/plain", "400 Bad Request\n");
        };
        let asked = match request.asked(address, &self.token) {
            Ok(asked) => asked,
            Err(refused) => return send(&mut stream, refused.0, "text/plain", &format!("{refused}\n")),
        };
        let done = |result: Result<(), String>, stream: &mut TcpStream| match result {
            Ok(()) => send(stream, "200 OK", "text/plain", ""),
            Err(why) => send(stream, "409 Conflict", "text/plain", &why),
        };
        match asked {
            Asked::Page => send(&mut stream, "200 OK", "text/html", &page(&self.scene).into_string()),
            Asked::Script => send(&mut stream, "200 OK", "text/javascript", include_str!("watch.js")),
            Asked::Player => send(&mut stream, "200 OK", "text/javascript", player::SCRIPT.0),
            Asked::Events => self.stream_events(&mut stream),
            Asked::Set => done(self.set(&request.body), &mut stream),
            Asked::Write => done(self.write(&request.body), &mut stream),
        }
    }

    /// Server-sent events: a section each, as JSON.
    fn stream_events(&self, stream: &mut TcpStream) -> std::io::Result<()> {
        write!(
            stream,
            "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nConnection: close\r\n{HEADERS}\r\nretry: 500\n\n"
        )?;
        let mut since = 0;
        loop {
            let (version, news) = self.board.news(since, HEARTBEAT);
            since = version;
            let mut text = String::from(":\n\n");
            for (name, value) in news {
                text += &format!("event: {name}\ndata: {value}\n\n");
            }
            stream.write_all(text.as_bytes())?;
        }
    }

    /// Takes over another level or other values, for names that the scene has.
    fn set(&self, body: &[u8]) -> Result<(), String> {
        let mut wanted: Wanted = serde_json::from_slice(body).map_err(|error| error.to_string())?;
        if !wanted.is_finite() {
            return Err("only finite numbers can be set".into());
        }
        let mut state = self.board.state();
        let known = knobs(state.text.as_deref().unwrap_or_default());
        wanted.set.retain(|name, _| known.iter().any(|knob| knob.name == *name));
        state.wanted = wanted;
        Ok(())
    }

    /// Writes a value into the scene, if its file still is what the page shows.
    fn write(&self, body: &[u8]) -> Result<(), String> {
        let Writing { name, value } = serde_json::from_slice(body).map_err(|error| error.to_string())?;
        if !value.is_finite() {
            return Err("only finite numbers can be written".into());
        }
        // Held to the end, so that two pages do not write at once.
        let mut state = self.board.state();
        let shown = state.text.clone().ok_or("the scene cannot be read")?;
        // The bytes of the file: a text with a mark of its encoding, or in another one, is not written.
        let text = std::fs::read_to_string(&self.scene).map_err(|error| error.to_string())?;
        if text != shown {
            let why = match text_of(&self.scene) {
                Ok(text) if text == shown => "only plain UTF-8 can be written back, without a byte order mark",
                _ => "the file has changed meanwhile: look at the new values first",
            };
            return Err(why.into());
        }
        let known = knobs(&text);
        let knob =
            known.iter().find(|knob| knob.name == name).ok_or_else(|| format!("the scene has no number {name}"))?;
        files::write(&self.scene, with_value(&text, knob, value).as_bytes()).map_err(|error| error.to_string())?;
        state.wanted.set.remove(&name);
        Ok(())
    }
}

fn send(stream: &mut TcpStream, status: &str, kind: &str, body: &str) -> std::io::Result<()> {
    let length = body.len();
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}; charset=utf-8\r\nContent-Length: {length}\r\nConnection: close\r\n{HEADERS}\r\n{body}"
    )
}
