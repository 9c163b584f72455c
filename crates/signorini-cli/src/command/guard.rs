//! The last line of defence: an error of the program itself ends with exit code 70 and a text worth sending.

use super::console::Console;
use super::{exhausted, stack};
use std::panic::{self, AssertUnwindSafe};
use std::sync::{Arc, Mutex, PoisonError};

/// What the standard library says where a thread has no room for its stack.
const NO_THREAD: &str = "failed to spawn thread";

/// The exit code for an error of the program.
const INTERNAL: u8 = 70;

/// The stack of the thread that works, in bytes, where it is one of its own.
const STACK: usize = 16 << 20;

/// What the first thread must be allowed, to work itself: about what the other threads of a run have.
const ENOUGH: u64 = 8 << 20;

/// Runs the program, in a thread of its own where the shell leaves the first one too little stack, and turns a panic into a
/// message.
pub fn guarded(program: impl FnOnce() -> u8 + Send + 'static) -> u8 {
    let seen: Arc<Mutex<Option<String>>> = Arc::default();
    let keep = Arc::clone(&seen);
    panic::set_hook(Box::new(move |info| {
        let mut first = keep.lock().unwrap_or_else(PoisonError::into_inner);
        first.get_or_insert_with(|| info.to_string());
    }));
    let outcome = if stack::first_may_take(ENOUGH) {
        Ok(panic::catch_unwind(AssertUnwindSafe(program)))
    } else {
        let thread = std::thread::Builder::new()
            .name("signorini".into())
            .stack_size(STACK);
        thread.spawn(program).map(std::thread::JoinHandle::join)
    };
    match outcome {
        Ok(Ok(code)) => code,
        Ok(Err(_)) => {
            let what = seen.lock().unwrap_or_else(PoisonError::into_inner).take();
            let what = what.unwrap_or_else(|| "a panic".into());
            if what.contains(NO_THREAD) {
                exhausted::say("a thread could not be started");
                exhausted::CODE
            } else {
                report(&what);
                INTERNAL
            }
        }
        Err(error) => {
            exhausted::say(&format!("a thread could not be started: {error}"));
            exhausted::CODE
        }
    }
}

fn report(what: &str) {
    let console = Console::stderr();
    console.line("internal error: this is a bug of signorini, not of your case");
    console.line(&format!("  {what}"));
    console.line(&format!(
        "  signorini {} on {}-{}",
        signorini::VERSION,
        std::env::consts::ARCH,
        std::env::consts::OS
    ));
    console.line(
        "  please send these lines with the case and its mesh; what had converged is on disk",
    );
}
