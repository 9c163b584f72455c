//! The threads of a run: one pool, made once.

use super::ranks;
use signorini::threads::{STACK, count_of_one};
use std::thread::{sleep, yield_now};
use std::time::{Duration, Instant};

/// How long a thread without work looks for some all the time. Parallel loops of an iteration follow each other within
/// fractions of it, and a thread that sleeps takes as long to wake up as some of them last.
const ALERT: Duration = Duration::from_millis(1);
/// How long it rests then before it looks again, at first and at most: each rest is twice as long as the one before.
const REST: [Duration; 2] = [Duration::from_micros(50), Duration::from_millis(1)];

/// Makes the pool and returns its size: as many threads as the command line, else the case, else
/// `OMP_NUM_THREADS`, else the machine says, whose cores are shared among the ranks on it.
pub fn make(command_line: Option<u64>, case: Option<u64>) -> usize {
    let wanted = count_of_one(command_line.or(case), ranks::on_this_machine());
    // a second pool is refused: then the first one is what there is; the calling thread works, too, so that nothing is
    // handed over where there is only one
    let made = rayon::ThreadPoolBuilder::new()
        .num_threads(wanted)
        .use_current_thread()
        .stack_size(STACK)
        .build_global();
    // other systems cannot rest as briefly
    if made.is_ok() && cfg!(unix) {
        keep_awake();
    }
    rayon::current_num_threads()
}

/// Keeps all threads of a new pool awake but the calling one, until the process ends. They have nothing to do yet, so that
/// nobody waits for what they were about to do.
fn keep_awake() {
    let caller = rayon::current_thread_index();
    rayon::spawn_broadcast(move |thread| {
        if Some(thread.index()) == caller {
            return;
        }
        let [first, longest] = REST;
        let (mut worked, mut rest) = (Instant::now(), first);
        loop {
            if rayon::yield_now() == Some(rayon::Yield::Executed) {
                (worked, rest) = (Instant::now(), first);
            } else if worked.elapsed() < ALERT {
                yield_now();
            } else {
                sleep(rest);
                rest = longest.min(2 * rest);
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;

    #[test]
    fn threads_that_stay_awake_work() {
        // as in a run, the calling thread is one of them
        let caller = std::thread::spawn(|| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(3)
                .use_current_thread()
                .build();
            pool.unwrap().install(|| {
                keep_awake();
                for pause in [Duration::ZERO, 3 * ALERT] {
                    sleep(pause);
                    // each waits for the two others
                    let barrier = std::sync::Barrier::new(3);
                    let leaders = (0..3).into_par_iter().with_max_len(1);
                    let leaders = leaders.filter(|_| barrier.wait().is_leader());
                    assert_eq!(leaders.count(), 1);
                    let heard = rayon::broadcast(|thread| thread.index());
                    assert_eq!(heard, [0, 1, 2]);
                    let nested = (0..100u64).into_par_iter().map(|n| {
                        let (a, b) = rayon::join(|| n, || (0..n).into_par_iter().sum::<u64>());
                        a + b
                    });
                    let expected = (0..100).map(|n| n * (n + 1) / 2).sum::<u64>();
                    assert_eq!(nested.sum::<u64>(), expected);
                }
            });
        });
        caller.join().unwrap();
    }
}
