//! How deep the stack of the first thread may grow.
//!
//! In glibc, memory of the first thread comes from one heap, that of others from heaps of 64 MiB each, which large arrays
//! fill badly: where its stack is deep enough, a run takes less memory and time on the first thread.
//!
//! Source: `mallopt(3)`, `getrlimit(2)`.
#![allow(unsafe_code)]

/// Whether the stack of the first thread may take so many bytes; no, where that is not known.
pub fn first_may_take(bytes: u64) -> bool {
    limit().is_some_and(|limit| limit >= bytes)
}

/// The limit of the stack of the first thread, which grows up to it; arguments and environment are in it.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn limit() -> Option<u64> {
    let mut limit = libc::rlimit64 {
        rlim_cur: 0,
        rlim_max: 0,
    };
    // SAFETY: the call writes to the place that it is given, which is one of this type, and to nothing else.
    let done = unsafe { libc::getrlimit64(libc::RLIMIT_STACK, &raw mut limit) };
    (done == 0).then_some(limit.rlim_cur)
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
const fn limit() -> Option<u64> {
    None
}

#[cfg(all(test, target_os = "linux", target_env = "gnu"))]
mod tests {
    use super::*;

    #[test]
    fn the_limit_is_that_of_the_shell() {
        let mut shell = std::process::Command::new("sh");
        let said = shell.args(["-c", "ulimit -s"]).output().unwrap();
        let said = String::from_utf8(said.stdout).unwrap();
        let wanted = match said.trim() {
            "unlimited" => u64::MAX,
            kibibytes => 1024 * kibibytes.parse::<u64>().unwrap(),
        };
        assert_eq!(limit(), Some(wanted));
        assert!(first_may_take(wanted) && (wanted == u64::MAX || !first_may_take(wanted + 1)));
    }
}
