//! Dives of several kinds, on several threads.

use super::dive::dive_from;
use super::local::Local;
use super::spread::Ways;
use super::{Dive, Guide, Problem};
use activecell::Rng;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc;

/// What dives may take.
pub(crate) struct Budget<S> {
    /// Threads.
    pub(crate) threads: usize,
    /// Memory of all of them together, in bytes.
    pub(crate) bytes: usize,
    /// Whether to stop, asked at every step of every dive.
    pub(crate) stop: S,
}

/// Robots times steps of the way of the one that has farthest to go, above which only the cheapest kinds pay.
const HUGE: u64 = 2_000_000;

/// The kinds to try, the most promising first. Measured, see `docs/fleet.md`.
fn kinds(distances: &[u32]) -> Vec<Guide> {
    let longest = distances.iter().copied().max().unwrap_or(0);
    if u64::from(longest) * distances.len() as u64 > HUGE {
        return vec![Guide::Local(7), Guide::Local(10)];
    }
    vec![Guide::Spread(10), Guide::Local(10)]
}

/// Makes a dive of each kind, for robots that have so many steps to go, and gives `found` those that are better than
/// `best` and all before them, in the order of the kinds. Which these are does not depend on the threads.
pub(crate) fn dives(
    problem: Problem<'_>,
    distances: &[u32],
    seed: u64,
    best: u64,
    budget: &Budget<impl Fn() -> bool + Sync>,
    mut found: impl FnMut(Dive),
) {
    let kinds = kinds(distances);
    let mut rng = Rng::new(seed);
    let seeds: Vec<u64> = kinds.iter().map(|_| rng.next_u64()).collect();
    let threads = budget.threads.clamp(1, kinds.len());
    // What each dive comes to; later ones need not come to more.
    let costs: Vec<AtomicU64> = kinds.iter().map(|_| AtomicU64::new(u64::MAX)).collect();
    let taken = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            let sender = sender.clone();
            let (kinds, seeds, costs, taken) = (&kinds, &seeds, &costs, &taken);
            scope.spawn(move || {
                loop {
                    let number = taken.fetch_add(1, Ordering::Relaxed);
                    let Some(&kind) = kinds.get(number) else { return };
                    let before = || costs[..number].iter().map(|cost| cost.load(Ordering::Relaxed)).min();
                    // As if all ran at once, so that the number of threads changes nothing.
                    let room = bytes(problem, distances, kind) <= budget.bytes / kinds.len();
                    let stop = |bound| bound >= best.min(before().unwrap_or(best)) || (budget.stop)();
                    let dive =
                        if room { dive_from(problem, distances, kind, seeds[number], &stop) } else { None };
                    if let Some(dive) = &dive {
                        costs[number].store(dive.sum_of_costs, Ordering::Relaxed);
                    }
                    if sender.send((number, dive)).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        let mut best = best;
        in_order(receiver, |dive: Dive| {
            if dive.sum_of_costs < best {
                best = dive.sum_of_costs;
                found(dive);
            }
        });
    });
}

/// Passes on what comes in any order in the order of the numbers, from 0 on without gaps.
fn in_order<T>(items: impl IntoIterator<Item = (usize, Option<T>)>, mut pass: impl FnMut(T)) {
    let mut early = std::collections::BTreeMap::new();
    let mut due = 0;
    for (number, item) in items {
        early.insert(number, item);
        while let Some(item) = early.remove(&due) {
            item.into_iter().for_each(&mut pass);
            due += 1;
        }
    }
}

/// The memory that a dive of this kind takes, in bytes; its plan by what the longest way asks for, and half more.
fn bytes(problem: Problem<'_>, distances: &[u32], kind: Guide) -> usize {
    let longest = distances.iter().copied().max().unwrap_or(0);
    let rows = longest as usize * distances.len() * size_of::<u32>();
    let guide = match kind {
        Guide::Plain => 0,
        Guide::Local(window) => Local::bytes(problem, window),
        Guide::Spread(window) => Local::bytes(problem, window) + Ways::bytes(problem, distances),
    };
    guide + rows + rows / 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_comes_in_any_order_is_passed_on_in_order() {
        let mut passed = Vec::new();
        in_order([(2, Some('c')), (0, Some('a')), (3, None), (1, None), (4, Some('e'))], |item| {
            passed.push(item);
        });
        assert_eq!(passed, ['a', 'c', 'e']);
    }
}
