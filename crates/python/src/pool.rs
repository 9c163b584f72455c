//! Pools of threads: one for each run at a time, made once and used again.

use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::{Mutex, PoisonError};

/// Bytes of stack for each thread, as in the command.
const STACK: usize = 8 << 20;

/// Pools without a run.
static IDLE: Mutex<Vec<ThreadPool>> = Mutex::new(Vec::new());

/// How many threads a run has: as many as wanted, else as `SIGNORINI_THREADS`, `OMP_NUM_THREADS` or the machine say.
fn count(wanted: Option<usize>) -> usize {
    let environment = |name: &str| std::env::var(name).ok()?.trim().parse().ok();
    let machine = || std::thread::available_parallelism().map_or(1, usize::from);
    wanted
        .or_else(|| environment("SIGNORINI_THREADS"))
        .or_else(|| environment("OMP_NUM_THREADS"))
        .filter(|&count| count > 0)
        .unwrap_or_else(machine)
        .min(4096)
}

/// Does something on a pool of threads of its own. Where no threads can be had, it is done on the calling one.
pub fn with<R: Send>(wanted: Option<usize>, work: impl FnOnce() -> R + Send) -> R {
    let count = count(wanted);
    let idle = || {
        let mut pools = IDLE.lock().unwrap_or_else(PoisonError::into_inner);
        let at = pools
            .iter()
            .position(|pool| pool.current_num_threads() == count)?;
        Some(pools.swap_remove(at))
    };
    let make = || {
        ThreadPoolBuilder::new()
            .num_threads(count)
            .stack_size(STACK)
            .build()
    };
    let Some(pool) = idle().or_else(|| make().ok()) else {
        return work();
    };
    let result = pool.install(work);
    IDLE.lock()
        .unwrap_or_else(PoisonError::into_inner)
        .push(pool);
    result
}
