//! Units that are simulated block by block, counted, and told to who else wants them.

use std::{
    ops::Range,
    sync::{Mutex, PoisonError},
};

use slipfit_system::files::WriteError;
use slipfit_tolerance::counting::{
    file::{Found as _, Part},
    run::{RunError, Work},
};

use crate::dynamics::simulate::SimulateError;

use super::{
    Unit,
    part::Settings,
    production::Production,
    simulate_units,
    subject::Subject,
    tally::{Counter, Tally},
};

/// Where units go one by one, beside being counted: in order, each once.
pub struct Listener<'a> {
    /// The first unit that it has not heard of.
    next: u64,
    hear: Hear<'a>,
}

/// What a [`Listener`] does with some units.
pub type Hear<'a> = Box<dyn FnMut(&[Unit]) -> Result<(), WriteError> + Send + 'a>;

impl<'a> Listener<'a> {
    /// That does this with units, one thread at a time.
    pub fn new(hear: Hear<'a>) -> Mutex<Self> {
        Mutex::new(Self { next: 0, hear })
    }
}

/// Units to be simulated.
pub struct Simulation<'a> {
    /// What they are units of.
    pub subject: &'a dyn Subject,
    /// What varies in it.
    pub production: &'a Production<'a>,
    /// Which units.
    pub settings: Settings,
    /// What counts them.
    pub counter: Counter<'a>,
    /// Who else wants them.
    pub listener: Option<Mutex<Listener<'a>>>,
}

impl From<SimulateError> for RunError {
    fn from(error: SimulateError) -> Self {
        match error {
            SimulateError::Interrupted => Self::Interrupted { saved: None },
            error => Self::Work(error.into()),
        }
    }
}

impl Simulation<'_> {
    /// Simulates the units `numbers`, counts them and lets the listener know of those that it has not heard of.
    fn counted(&self, numbers: Range<u64>, done: &(impl Fn(u64) + Sync)) -> Result<Tally, RunError> {
        let mut tally = self.counter.nothing();
        let mut heard = Ok(());
        let mut listener =
            self.listener.as_ref().map(|listener| listener.lock().unwrap_or_else(PoisonError::into_inner));
        simulate_units(self.subject, self.production, numbers, done, |drawn, units| {
            self.counter.add(&mut tally, units);
            if let Some(listener) = listener.as_mut().filter(|listener| listener.next == drawn.numbers.start)
                && heard.is_ok()
            {
                heard = (listener.hear)(units);
                listener.next = drawn.numbers.end;
            }
        })?;
        Ok(heard.map(|()| tally)?)
    }

    /// Lets the listener know of the units before `end` that it has not heard of: of those that an interrupted run counted.
    ///
    /// # Errors
    /// As [`Work::add`].
    pub fn catch_up(&self, end: u64) -> Result<(), RunError> {
        let heard = |listener: &Mutex<Listener>| listener.lock().unwrap_or_else(PoisonError::into_inner).next;
        match self.listener.as_ref().map(heard) {
            Some(next) if next < end => self.counted(next..end, &|_| ()).map(drop),
            _ => Ok(()),
        }
    }
}

impl Work for Simulation<'_> {
    type Found = Tally;

    fn settings(&self) -> Settings {
        self.settings
    }

    fn empty(&self) -> Tally {
        self.counter.nothing()
    }

    fn fits(&self, part: &Part<Tally>) -> bool {
        part.tallies.fits(&self.counter.nothing())
    }

    fn add(&self, blocks: Range<u64>, found: &mut Tally, done: &(impl Fn(u64) + Sync)) -> Result<(), RunError> {
        let numbers = self.settings.units_in(&blocks);
        self.catch_up(numbers.start)?;
        found.join(self.counted(numbers, done)?);
        Ok(())
    }
}
