//! What happens where memory is at an end: the process says so and ends with exit code 8, in place of a core dump.
//!
//! Code that can do without asks first (`try_reserve`). Elsewhere the standard library ends the process by `abort` when an
//! allocation fails. The allocator notes the size of the last one that failed, and the handler of SIGABRT, where there is
//! one, says it and exits. Nothing is lost but the increment at hand: checkpoints are on the disk.
//!
//! Source: `signal-safety(7)`: a handler may write and exit, and little else.
#![allow(unsafe_code)]

use super::console::Console;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Bytes of the last allocation that failed; 0: none has.
static FAILED: AtomicUsize = AtomicUsize::new(0);

/// Notes the size of an allocation where there is no place for it.
pub fn note(place: *const u8, size: usize) {
    if place.is_null() {
        FAILED.store(size, Ordering::Relaxed);
    }
}

/// The exit code.
pub const CODE: u8 = 8;

const SAYS: &str = "error[S0802]: out of memory: ";
const HELPS: &str = "\n = what has converged is on disk up to the last checkpoint\n = help: go on with  \
    signorini resume DIR  on a larger machine, or use fewer unknowns\n";

/// Says what there was no room for.
pub fn say(what: &str) {
    Console::stderr().text(&format!("{SAYS}{what}{HELPS}"));
}

/// From now on the process ends with exit code 8 where memory is at an end.
#[cfg(unix)]
pub fn watch() {
    let handler = on_abort as extern "C" fn(libc::c_int);
    // SAFETY: the handler calls nothing but what signal handlers may call, and lives as long as the process.
    unsafe {
        libc::signal(libc::SIGABRT, handler as libc::sighandler_t);
    }
}

#[cfg(not(unix))]
pub const fn watch() {}

/// Says how much memory was asked for and ends the process; aborts of another cause go on.
#[cfg(unix)]
extern "C" fn on_abort(signal: libc::c_int) {
    let size = FAILED.load(Ordering::Relaxed);
    if size == 0 {
        // SAFETY: both calls may be made in a handler; the second does not come back from the default action.
        unsafe {
            libc::signal(signal, libc::SIG_DFL);
            libc::raise(signal);
        }
        return;
    }
    let mut digits = [0u8; 20];
    let number = in_digits(size, &mut digits);
    let more = b" bytes more were not to be had".as_slice();
    for part in [SAYS.as_bytes(), number, more, HELPS.as_bytes()] {
        // SAFETY: the part is as long as is said, and `write` may be called in a handler.
        unsafe {
            libc::write(2, part.as_ptr().cast(), part.len());
        }
    }
    // SAFETY: `_exit` may be called in a handler.
    unsafe { libc::_exit(i32::from(CODE)) }
}

/// A number in decimal digits, without an allocation.
fn in_digits(mut number: usize, digits: &mut [u8; 20]) -> &[u8] {
    let mut first = digits.len();
    for (place, digit) in digits.iter_mut().enumerate().rev() {
        *digit = b'0' + (number % 10) as u8;
        number /= 10;
        first = place;
        if number == 0 {
            break;
        }
    }
    digits.get(first..).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_digit_by_digit() {
        for number in [0, 7, 10, 1_234_567, usize::MAX] {
            let mut digits = [0; 20];
            assert_eq!(
                in_digits(number, &mut digits),
                number.to_string().as_bytes()
            );
        }
    }

    #[test]
    fn what_the_system_does_not_give_is_noted_and_left_to_who_asked() {
        let mut list: Vec<u8> = Vec::new();
        let size = isize::MAX as usize - 4096;
        assert!(list.try_reserve_exact(size).is_err());
        assert_eq!(FAILED.swap(0, Ordering::Relaxed), size);
    }
}
