//! Many trials at once.

use crate::rng::Rng;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

/// The generator of one trial: the same for the same seed and number, whatever ran before.
pub fn trial_rng(seed: u64, trial: u64) -> Rng {
    // Two rounds, so that neither near seeds nor near numbers give near states.
    let seeded = Rng::new(seed).next_u64();
    Rng::new(Rng::new(seeded ^ trial.wrapping_mul(0xd134_2543_de82_ef95)).next_u64())
}

/// Runs `count` trials on `threads` threads; the results come in the order of their numbers. `done` is called after
/// each.
///
/// ```
/// use activecell::sim::trials;
/// let run = |threads| trials(100, threads, 7, &|| {}, &|rng| rng.next_u64());
/// assert_eq!(run(1), run(3));
/// ```
///
/// # Panics
/// If a trial panics.
pub fn trials<T: Send>(
    count: u64,
    threads: usize,
    seed: u64,
    done: &(dyn Fn() + Sync),
    trial: &(dyn Fn(&mut Rng) -> T + Sync),
) -> Vec<T> {
    let next = AtomicU64::new(0);
    let work = || {
        let mut results = Vec::new();
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= count {
                return results;
            }
            results.push((number, trial(&mut trial_rng(seed, number))));
            done();
        }
    };
    let mut results = thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(work)).collect();
        let mut results = work();
        for other in others {
            match other.join() {
                Ok(more) => results.extend(more),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        results
    });
    results.sort_unstable_by_key(|&(number, _)| number);
    results.into_iter().map(|(_, result)| result).collect()
}
