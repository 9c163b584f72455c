//! What happens where memory is at an end: the process says so and ends with exit code 8, in place of a core dump.
//!
//! Code that can do without asks first (`try_reserve`). Elsewhere the standard library ends the process by `abort` when an
//! allocation fails. The allocator notes the size of the last one that failed, and the handler of SIGABRT, where there is
//! one, reports it with the size of the process and exits. Only the current increment is lost: checkpoints are on the disk.
//!
//! Sources: `signal-safety(7)`: a handler may open, read, write and exit, and little else; `proc(5)`: `/proc/self/statm` starts
//! with the size of the process in pages.
#![allow(unsafe_code)]

use super::console::Console;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Bytes of the last allocation that failed; 0: none has.
static FAILED: AtomicUsize = AtomicUsize::new(0);

/// Bytes below which a failure is one of reporting an earlier one, where there is one.
const SMALL: usize = 64 << 10;

/// Bytes of a page.
static PAGE: AtomicUsize = AtomicUsize::new(4096);

/// Notes the size of an allocation where there is no place for it.
pub fn note(place: *const u8, size: usize) {
    if place.is_null() && (size >= SMALL || FAILED.load(Ordering::Relaxed) == 0) {
        FAILED.store(size, Ordering::Relaxed);
    }
}

/// The exit code.
pub const CODE: u8 = 8;

const SAYS: &str = "error[S0802]: out of memory: ";
const HELPS: &str = "\n = what has converged is on disk up to the last checkpoint\n = help: go on with  \
    signorini resume DIR  with a higher limit (ulimit -v), fewer threads (-j 1) or on a larger machine; or use fewer \
    unknowns\n";

/// Says what there was no room for.
pub fn say(what: &str) {
    Console::stderr().text(&format!("{SAYS}{what}{HELPS}"));
}

/// From now on the process ends with exit code 8 where memory is at an end.
#[cfg(target_os = "linux")]
pub fn watch() {
    let handler = on_abort as extern "C" fn(libc::c_int);
    // SAFETY: the first call only reads; the handler calls nothing but what signal handlers may call, and lives as long as the
    // process.
    let page = unsafe {
        libc::signal(libc::SIGABRT, handler as libc::sighandler_t);
        libc::sysconf(libc::_SC_PAGESIZE)
    };
    if let Ok(page @ 1..) = usize::try_from(page) {
        PAGE.store(page, Ordering::Relaxed);
    }
}

#[cfg(not(target_os = "linux"))]
pub const fn watch() {}

/// Reports how much memory the process has and needs, and ends it; aborts of another cause go on.
#[cfg(target_os = "linux")]
extern "C" fn on_abort(signal: libc::c_int) {
    let more = FAILED.load(Ordering::Relaxed);
    if more == 0 {
        // SAFETY: both calls may be made in a handler; the second does not come back from the default action.
        unsafe {
            libc::signal(signal, libc::SIG_DFL);
            libc::raise(signal);
        }
        return;
    }
    let has = size_of_process();
    let numbers = [has, more, has.saturating_add(more)].map(megabytes);
    let mut places = [[0u8; 20]; 3];
    let [a, b, c] = &mut places;
    let [has, more, all] = numbers;
    for part in [
        SAYS.as_bytes(),
        b"the process has ",
        in_digits(has, a),
        b" MB and asked for ",
        in_digits(more, b),
        b" MB more, so that at least ",
        in_digits(all, c),
        b" MB are needed",
        HELPS.as_bytes(),
    ] {
        // SAFETY: the part is as long as is said, and `write` may be called in a handler.
        unsafe {
            libc::write(2, part.as_ptr().cast(), part.len());
        }
    }
    // SAFETY: `_exit` may be called in a handler.
    unsafe { libc::_exit(i32::from(CODE)) }
}

/// Bytes of address space that this process has; 0 where the system does not say. A handler may call it.
#[cfg(target_os = "linux")]
fn size_of_process() -> usize {
    let mut text = [0u8; 20];
    // SAFETY: the path ends with a zero, the place is as long as is said, and all calls may be made in a handler.
    let count = unsafe {
        let file = libc::open(c"/proc/self/statm".as_ptr(), libc::O_RDONLY);
        let count = libc::read(file, text.as_mut_ptr().cast(), text.len());
        libc::close(file);
        count
    };
    let read = usize::try_from(count).ok().and_then(|n| text.get(..n));
    let digits = read.unwrap_or_default().iter();
    let pages = digits
        .take_while(|c| c.is_ascii_digit())
        .fold(0usize, |n, c| {
            n.saturating_mul(10).saturating_add(usize::from(c - b'0'))
        });
    pages.saturating_mul(PAGE.load(Ordering::Relaxed))
}

/// Megabytes, rounded up.
const fn megabytes(bytes: usize) -> usize {
    bytes.div_ceil(1_000_000)
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

    #[cfg(target_os = "linux")]
    #[test]
    fn the_size_of_the_process_grows_with_what_it_takes() {
        let before = size_of_process();
        let size = 300 << 20;
        let more = Vec::<u8>::with_capacity(size);
        let after = size_of_process();
        // other tests free some of theirs
        let others = 1 << 20;
        assert!(
            before > 1 << 20 && after + others >= before + size,
            "{before} {after}"
        );
        drop(more);
    }

    #[test]
    fn megabytes_are_rounded_up() {
        assert_eq!([0, 1, 1_000_000, 1_000_001].map(megabytes), [0, 1, 1, 2]);
    }

    #[test]
    fn what_the_system_does_not_give_is_noted_and_left_to_who_asked() {
        let mut list: Vec<u8> = Vec::new();
        let size = isize::MAX as usize - 4096;
        assert!(list.try_reserve_exact(size).is_err());
        // what fails while that is reported does not take its place
        note(std::ptr::null(), SMALL - 1);
        assert_eq!(FAILED.swap(0, Ordering::Relaxed), size);
    }
}
