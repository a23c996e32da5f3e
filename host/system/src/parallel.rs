//! Work of many equal parts on all threads of the current pool.
//!
//! A function for all kinds of work: a parallel iterator is compiled anew for each.

use std::sync::{
    Mutex,
    atomic::{AtomicUsize, Ordering},
};

use rayon::prelude::*;

use crate::interrupt;

/// What `of` makes of each number below `count`, in order. What it makes does not depend on the number of threads.
pub fn each<T: Send>(count: usize, of: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let made: Vec<Mutex<Option<T>>> = (0..count).map(|_| Mutex::new(None)).collect();
    spread(count, &|i| {
        let one = of(i);
        *made[i].lock().expect("no other thread has it") = Some(one);
    });
    made.into_iter().map(|one| one.into_inner().ok().flatten().expect("every part is done")).collect()
}

/// What `of` makes of each of the `items`, in order.
pub fn map<'a, I: Sync, T: Send>(items: &'a [I], of: impl Fn(&'a I) -> T + Sync) -> Vec<T> {
    each(items.len(), |i| of(&items[i]))
}

/// The same where it may fail.
///
/// # Errors
/// The first one in the order of `items`. What comes after it is not begun.
pub fn try_map<'a, I: Sync, T: Send, E: Send>(
    items: &'a [I],
    of: impl Fn(&'a I) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    let failed = AtomicUsize::new(usize::MAX);
    let made = each(items.len(), |i| {
        if failed.load(Ordering::Relaxed) < i {
            return None;
        }
        let one = of(&items[i]);
        if one.is_err() {
            failed.fetch_min(i, Ordering::Relaxed);
        }
        Some(one)
    });
    made.into_iter().flatten().collect()
}

/// Does `part` for each number below `count`, a part at a time on each thread. What stops this thread stops all.
fn spread(count: usize, part: &(dyn Fn(usize) + Sync)) {
    let stop = interrupt::current();
    (0..count).into_par_iter().with_max_len(1).for_each(|i| interrupt::within(stop.clone(), || part(i)));
}

#[cfg(test)]
mod tests {
    use super::{each, map, try_map};

    #[test]
    fn parts_come_in_order_and_the_first_error_counts() {
        let squares = each(1000, |i| i * i);
        assert!(squares.iter().enumerate().all(|(i, square)| *square == i * i));
        assert_eq!(map(&["a", "bc"], |text| text.len()), [1, 2]);
        assert!(map(&[] as &[u8], |_| 0).is_empty());
        let odd = |i: &usize| if i % 2 == 1 { Err(*i) } else { Ok(*i) };
        assert_eq!(try_map(&[0, 2, 3, 4, 5], odd), Err(3));
        assert_eq!(try_map(&[0, 2], odd), Ok(vec![0, 2]));
    }
}
