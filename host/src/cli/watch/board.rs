//! What the page shows now: written by the worker, read by every open page.

use std::{
    collections::BTreeMap,
    sync::{Condvar, Mutex, MutexGuard},
    time::Duration,
};

use serde_json::Value;

/// Sections by name, each with the version at which it changed; only the latest of each is kept.
#[derive(Default)]
pub struct Board {
    state: Mutex<State>,
    changed: Condvar,
}

/// What is on the board.
#[derive(Default)]
pub struct State {
    version: u64,
    sections: BTreeMap<&'static str, (u64, Value)>,
    /// The text that the page is about; none while there is no file.
    pub text: Option<String>,
    /// Tolerance level and values of knobs that the page has asked for.
    pub wanted: Wanted,
}

/// What a page asks for beyond the scene's text.
#[derive(Clone, Debug, Default, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(deny_unknown_fields)]
pub struct Wanted {
    /// Tolerance level.
    pub n: f64,
    /// Values of knobs, by name.
    pub set: BTreeMap<String, f64>,
}

impl Wanted {
    /// Whether all numbers are finite.
    pub fn is_finite(&self) -> bool {
        self.n.is_finite() && self.set.values().all(|value| value.is_finite())
    }
}

impl Board {
    /// The state, also after a thread that held it has panicked: no value is ever half written.
    pub fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    /// Shows `value` in the section `name`.
    pub fn show(&self, name: &'static str, value: impl Into<Value>) {
        let mut state = self.state();
        state.version += 1;
        let version = state.version;
        state.sections.insert(name, (version, value.into()));
        self.changed.notify_all();
    }

    /// What has changed since version `since`, with the version now; waits for a change as long as `at_most`.
    pub fn news(&self, since: u64, at_most: Duration) -> (u64, Vec<(&'static str, Value)>) {
        let state = self.state();
        let waited = self.changed.wait_timeout_while(state, at_most, |state| state.version <= since);
        let (state, _) = waited.unwrap_or_else(std::sync::PoisonError::into_inner);
        let mut news: Vec<_> = state.sections.iter().filter(|(_, (version, _))| *version > since).collect();
        news.sort_by_key(|(_, (version, _))| *version);
        (state.version, news.into_iter().map(|(name, (_, value))| (*name, value.clone())).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_latest_of_each_section_is_news() {
        let board = Board::default();
        for i in 0..1000 {
            board.show("unit", i);
        }
        board.show("check", "fine");
        let (version, news) = board.news(0, Duration::ZERO);
        assert_eq!((version, news), (1001, vec![("unit", 999.into()), ("check", "fine".into())]));
        assert!(board.news(version, Duration::ZERO).1.is_empty());
    }
}
