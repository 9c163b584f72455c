//! The threads of a run: one pool, made once.

/// Bytes of stack for each thread, whatever limit the shell has set.
const STACK: usize = 8 << 20;

/// Makes the pool and returns its size: as many threads as the command line, else the case, else
/// `OMP_NUM_THREADS`, else the machine says.
pub fn make(command_line: Option<u64>, case: Option<u64>) -> usize {
    let environment = || std::env::var("OMP_NUM_THREADS").ok()?.trim().parse().ok();
    let machine = || std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
    let wanted = command_line
        .or(case)
        .or_else(environment)
        .filter(|n| *n > 0)
        .unwrap_or_else(machine);
    let wanted = usize::try_from(wanted.min(4096)).unwrap_or(1);
    // a second pool is refused: then the first one is what there is; the calling thread works, too, so that nothing is
    // handed over where there is only one
    let _ = rayon::ThreadPoolBuilder::new()
        .num_threads(wanted)
        .use_current_thread()
        .stack_size(STACK)
        .build_global();
    rayon::current_num_threads()
}
