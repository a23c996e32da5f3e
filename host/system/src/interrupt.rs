//! A request to stop: long work looks at it now and then, so that nothing is left half written.

use std::{
    cell::RefCell,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread::LocalKey,
};

/// Ctrl-C, which stops all work of the process.
static CTRL_C: AtomicBool = AtomicBool::new(false);

thread_local! {
    /// What stops the work of this thread alone.
    static CURRENT: RefCell<Option<Stop>> = const { RefCell::new(None) };
}

/// What stops one piece of work, on all threads that work on it.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Asks that work to stop.
    pub fn request(&self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// What stops the work of this thread; `None` if Ctrl-C alone does.
pub fn current() -> Option<Stop> {
    CURRENT.with_borrow(Clone::clone)
}

/// Does `work`, which `stop` stops.
pub fn within<T>(stop: Option<Stop>, work: impl FnOnce() -> T) -> T {
    with(&CURRENT, stop, work)
}

/// Does `work` while `local` has this `value` in this thread.
pub fn with<L, T>(local: &'static LocalKey<RefCell<L>>, value: L, work: impl FnOnce() -> T) -> T {
    /// Puts the earlier value back, also if the work panics.
    struct Restore<L: 'static>(&'static LocalKey<RefCell<L>>, Option<L>);
    impl<L> Drop for Restore<L> {
        fn drop(&mut self) {
            if let Some(earlier) = self.1.take() {
                self.0.set(earlier);
            }
        }
    }
    let _restore = Restore(local, Some(local.replace(value)));
    work()
}

/// Whether the work of this thread is asked to stop.
pub fn requested() -> bool {
    let stopped = |stop: &Stop| stop.0.load(Ordering::Relaxed);
    CTRL_C.load(Ordering::Relaxed) || CURRENT.with_borrow(|stop| stop.as_ref().is_some_and(stopped))
}

/// From now on the first Ctrl-C only asks to stop; a second one ends the process at once.
///
/// # Errors
/// If the system refuses the handler.
pub fn install() -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(|| {
        if CTRL_C.swap(true, Ordering::Relaxed) {
            std::process::exit(1);
        }
    })
}

#[cfg(test)]
mod tests {
    use super::{Stop, current, requested, within};
    use crate::parallel::each;

    #[test]
    fn a_stop_reaches_all_threads_of_its_work_and_no_other() {
        let [one, other] = [(); 2].map(|()| Stop::default());
        one.request();
        let stopped = |stop: &Stop| within(Some(stop.clone()), || each(64, |_| each(4, |_| requested())));
        let both = each(16, |i| (i % 2 == 0, stopped(if i % 2 == 0 { &one } else { &other })));
        assert!(both.into_iter().all(|(asked, parts)| parts.into_iter().flatten().all(|stopped| stopped == asked)));
        assert!(current().is_none() && !requested());
    }
}
