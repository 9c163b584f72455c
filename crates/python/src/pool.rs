//! Pools of threads: one for each run at a time, made once and used again.

use rayon::{ThreadPool, ThreadPoolBuilder};
use signorini::threads::{STACK, count};
use std::sync::{Mutex, PoisonError};

/// Pools without a run.
static IDLE: Mutex<Vec<ThreadPool>> = Mutex::new(Vec::new());

/// Does something on a pool of threads of its own: of as many as wanted, else as `SIGNORINI_THREADS` says, else as
/// [`count`] does. Where no threads can be had, it is done on the calling one.
pub fn with<R: Send>(wanted: Option<u64>, work: impl FnOnce() -> R + Send) -> R {
    let environment = || std::env::var("SIGNORINI_THREADS").ok()?.trim().parse().ok();
    let count = count(wanted.or_else(environment));
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
