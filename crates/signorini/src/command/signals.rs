//! Ctrl-C and `kill`: the first asks the run to stop, a second one stops the process.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize};

/// A number that becomes that of the signal when one comes.
///
/// Where signals cannot be caught they end the process, as they do by default.
pub fn watched() -> Arc<AtomicUsize> {
    let seen = Arc::new(AtomicUsize::new(0));
    let again = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        // in this order: the second signal finds what the first one set
        let _ = flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(&again));
        let _ = flag::register(signal, Arc::clone(&again));
        let _ = flag::register_usize(signal, Arc::clone(&seen), signal as usize);
    }
    seen
}
