//! The live page: what the server lets in, what it shows after saves of every kind, and what a person does with it.

mod browser;

use std::{
    io::{BufRead, BufReader, Read, Write},
    net::TcpStream,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

const SCENE: &str = include_str!("../../scenes/cd-rom-slide.toml");
/// What no machine needs so long for.
const PATIENCE: Duration = Duration::from_secs(120);

/// A running program and its page. It ends with its owner.
pub struct Watched {
    child: Child,
    /// Address of the page.
    pub url: String,
    /// The file.
    pub scene: PathBuf,
    _folder: tempfile::TempDir,
}

impl Drop for Watched {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Watched {
    /// Watches a new file with this `text`.
    pub fn start(text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("scene.toml");
        std::fs::write(&scene, text).unwrap();
        let mut child = Command::new(env!("CARGO_BIN_EXE_slipfit"))
            .args(["watch".as_ref(), scene.as_os_str()])
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut url = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut url).unwrap();
        Self { child, url: url.trim().to_owned(), scene, _folder: folder }
    }

    fn host(&self) -> &str {
        self.url.strip_prefix("http://").unwrap().split('/').next().unwrap()
    }

    fn token(&self) -> &str {
        self.url.trim_end_matches('/').rsplit('/').next().unwrap()
    }

    /// The answer to a request with this first line and these fields.
    fn answer(&self, head: &str, body: &str) -> String {
        let mut stream = TcpStream::connect(self.host()).unwrap();
        write!(stream, "{head}\r\nContent-Length: {}\r\n\r\n{body}", body.len()).unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer
    }

    fn post(&self, path: &str, body: &str) -> String {
        let (host, token) = (self.host(), self.token());
        self.answer(&format!("POST /{token}/{path} HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}"), body)
    }

    fn events(&self) -> Events {
        let mut stream = TcpStream::connect(self.host()).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        write!(stream, "GET /{}/events HTTP/1.1\r\nHost: {}\r\n\r\n", self.token(), self.host()).unwrap();
        Events(BufReader::new(stream))
    }

    /// Saves as editors do that rename.
    fn replace(&self, text: &str) {
        let new = self.scene.with_extension("new");
        std::fs::write(&new, text).unwrap();
        std::fs::rename(&new, &self.scene).unwrap();
    }

    /// Processes that the program has started and that still are there.
    fn workers(&self) -> usize {
        let tasks = format!("/proc/{}/task", self.child.id());
        let children = std::fs::read_dir(tasks)
            .unwrap()
            .filter_map(|task| std::fs::read_to_string(task.unwrap().path().join("children")).ok());
        children.map(|list| list.split_whitespace().count()).sum()
    }
}

/// A stream of sections.
struct Events(BufReader<TcpStream>);

impl Events {
    fn next(&mut self) -> (String, String) {
        let mut name = String::new();
        loop {
            let mut line = String::new();
            assert!(self.0.read_line(&mut line).unwrap() > 0, "the stream has ended");
            if let Some(event) = line.strip_prefix("event: ") {
                name = event.trim().to_owned();
            } else if let Some(data) = line.strip_prefix("data: ") {
                return (name, data.trim().to_owned());
            }
        }
    }

    /// The first section `name` with these words.
    #[track_caller]
    fn until(&mut self, name: &str, words: &str) -> String {
        let start = Instant::now();
        loop {
            let (section, data) = self.next();
            if section == name && data.contains(words) {
                return data;
            }
            assert!(start.elapsed() < PATIENCE, "no {words} in {name}, but {section}: {data:.300}");
        }
    }
}

fn with_friction(coefficient: f64) -> String {
    let changed = SCENE.replace("coefficient = 0.3", &format!("coefficient = {coefficient}"));
    assert!(coefficient == 0.3 || changed != SCENE);
    changed
}

#[test]
fn foreign_requests_are_refused() {
    let page = Watched::start(SCENE);
    let (host, token) = (page.host(), page.token());
    let status = |head: &str| page.answer(head, "").lines().next().unwrap_or_default().to_owned();
    assert_eq!(status(&format!("GET /{token}/ HTTP/1.1\r\nHost: {host}")), "HTTP/1.1 200 OK");
    for head in [
        format!("GET / HTTP/1.1\r\nHost: {host}"),
        format!("GET /{}/ HTTP/1.1\r\nHost: {host}", "0".repeat(token.len())),
        format!("GET /{token}/ HTTP/1.1\r\nHost: evil.example"),
        format!("GET /{token}/events HTTP/1.1\r\nHost: {host}\r\nOrigin: http://evil.example"),
        format!("POST /{token}/set HTTP/1.1\r\nHost: {host}"),
        format!("POST /{token}/write HTTP/1.1\r\nHost: {host}\r\nOrigin: http://evil.example"),
    ] {
        assert_eq!(status(&head), "HTTP/1.1 403 Forbidden", "{head}");
    }
    for path in ["../scene.toml", "scene.toml", "%2e%2e/scene.toml", "../../etc/passwd"] {
        assert_eq!(
            status(&format!("GET /{token}/{path} HTTP/1.1\r\nHost: {host}")),
            "HTTP/1.1 404 Not Found",
            "{path}"
        );
    }
    assert!(page.host().starts_with("127.0.0.1:"));
}

#[test]
fn broken_long_and_deleted_scenes_are_reported_and_survived() {
    let page = Watched::start(SCENE);
    let mut events = page.events();
    events.until("unit", ">jammed<");
    std::fs::write(&page.scene, SCENE.replace("coefficient = 0.3", "coefficient = -0.3")).unwrap();
    let line = SCENE.lines().position(|line| line.starts_with("coefficient = 0.3")).unwrap() + 1;
    let error = events.until("problem", "friction.coefficient");
    assert!(error.contains(&format!("scene.toml:{line}:")) && error.contains("coefficient = -0.3"), "{error}");
    std::fs::remove_file(&page.scene).unwrap();
    events.until("problem", "cannot read the scene");
    std::fs::write(&page.scene, format!("{SCENE}\n# {}", "x".repeat(10 << 20))).unwrap();
    events.until("problem", "longer than");
    std::fs::create_dir(page.scene.with_extension("folder")).unwrap();
    std::fs::remove_file(&page.scene).unwrap();
    std::fs::rename(page.scene.with_extension("folder"), &page.scene).unwrap();
    events.until("problem", "cannot read the scene");
    std::fs::remove_dir(&page.scene).unwrap();
    page.replace(&with_friction(0.1));
    events.until("unit", ">runs<");
}

#[test]
fn a_thousand_saves_leave_the_last_ones_result_and_one_worker() {
    let page = Watched::start(SCENE);
    let mut events = page.events();
    events.until("unit", ">jammed<");
    for i in 0..1000 {
        let text = with_friction(if i % 2 == 0 { 0.31 } else { 0.29 + f64::from(i) * 1e-5 });
        if i % 3 == 0 { page.replace(&text) } else { std::fs::write(&page.scene, text).unwrap() }
    }
    page.replace(&with_friction(0.1));
    events.until("unit", ">runs<");
    assert!(page.workers() <= 1, "stale work goes on");
    // A page that is opened now shows the same.
    page.events().until("unit", ">runs<");
}

#[test]
fn from_saving_to_the_verdict() {
    let page = Watched::start(SCENE);
    let mut events = page.events();
    events.until("unit", ">jammed<");
    let mut times: Vec<_> = (0..20)
        .map(|i| {
            let start = Instant::now();
            let runs = i % 2 == 0;
            page.replace(&with_friction(if runs { 0.1 } else { 0.3 }));
            events.until("unit", if runs { ">runs<" } else { ">jammed<" });
            start.elapsed()
        })
        .collect();
    times.sort();
    println!("from saving to the verdict: median {:?}, longest {:?}", times[10], times[19]);
}

#[test]
fn values_are_tried_and_written_back_with_comments_kept() {
    let page = Watched::start(SCENE);
    let mut events = page.events();
    events.until("unit", ">jammed<");
    let answer = page.post("set", "{\"n\": 0, \"set\": {\"friction.coefficient\": 0.1}}");
    assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    events.until("unit", ">runs<");
    assert_eq!(std::fs::read_to_string(&page.scene).unwrap(), SCENE);
    let write = "{\"name\": \"friction.coefficient\", \"value\": 0.1}";
    assert!(page.post("write", write).starts_with("HTTP/1.1 200"));
    assert_eq!(std::fs::read_to_string(&page.scene).unwrap(), with_friction(0.1));
    events.until("unit", ">runs<");
    assert!(page.post("write", "{\"name\": \"include\", \"value\": 1}").contains("has no number"));
    for wrong in ["{\"n\": 1e999, \"set\": {}}", "", "{\"n\": 0, \"set\": {}, \"path\": \"/etc\"}"] {
        assert!(page.post("set", wrong).starts_with("HTTP/1.1 409"), "{wrong}");
    }
    // Not over what somebody else has saved meanwhile: either the program has seen that before, or it refuses.
    let refusals = (0..50).filter(|i| {
        let theirs = with_friction(0.25 + f64::from(*i) * 1e-3);
        std::fs::write(&page.scene, &theirs).unwrap();
        let refused = page.post("write", write).contains("changed meanwhile");
        let now = std::fs::read_to_string(&page.scene).unwrap();
        assert_eq!(now, if refused { theirs } else { with_friction(0.1) });
        refused
    });
    assert!(refusals.count() > 0, "nothing was refused");
}

#[test]
fn an_interrupt_ends_it() {
    use nix::{sys::signal, unistd::Pid};
    let mut page = Watched::start(SCENE);
    page.events().until("unit", ">jammed<");
    signal::kill(Pid::from_raw(page.child.id() as i32), signal::Signal::SIGINT).unwrap();
    let start = Instant::now();
    while page.child.try_wait().unwrap().is_none() {
        assert!(start.elapsed() < PATIENCE, "it goes on");
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(TcpStream::connect(page.host()).is_err());
}

#[test]
fn mechanisms_and_products_have_pages_too() {
    for (name, words) in
        [("slider-crank", ">runs<"), ("woodpecker-toy", "figure"), ("three-part-stack", "nothing to move")]
    {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.toml"));
        let page = Watched::start(&std::fs::read_to_string(path).unwrap());
        page.events().until("unit", words);
    }
}
