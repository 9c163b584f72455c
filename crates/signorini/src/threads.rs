//! How many threads a run has, and what each of them gets.

/// Bytes of stack for each thread, whatever limit the shell has set.
pub const STACK: usize = 8 << 20;

/// More threads than any run has.
const MOST: u64 = 4096;

/// As many threads as wanted, else as `OMP_NUM_THREADS`, else as the machine has cores.
///
/// # Example
/// ```
/// use signorini::threads::count;
///
/// assert_eq!(count(Some(3)), 3);
/// // zero means nothing
/// assert!(count(Some(0)) >= 1);
/// ```
#[must_use]
pub fn count(wanted: Option<u64>) -> usize {
    count_of_one(wanted, 1)
}

/// As [`count`], for one of some processes that share the cores of this machine: each of them has at least one.
///
/// # Example
/// ```
/// use signorini::threads::{count, count_of_one};
///
/// assert_eq!(count_of_one(Some(3), 2), 3);
/// assert!((1..=count(None)).contains(&count_of_one(None, 2)));
/// ```
#[must_use]
pub fn count_of_one(wanted: Option<u64>, processes: usize) -> usize {
    let environment = || std::env::var("OMP_NUM_THREADS").ok()?.trim().parse().ok();
    let machine = || std::thread::available_parallelism().map_or(1, |n| n.get());
    let share = || (machine() / processes.max(1)).max(1) as u64;
    let wanted = wanted.or_else(environment).filter(|n| *n > 0);
    let wanted = wanted.unwrap_or_else(share);
    usize::try_from(wanted.min(MOST)).unwrap_or(1)
}
