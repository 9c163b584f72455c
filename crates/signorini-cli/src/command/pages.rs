//! Large arrays in large pages.
//!
//! A run of 300,000 unknowns touches 250,000 pages of 4 KiB for the first time, each of which the kernel has to find and
//! clear, and later looks up places of more pages than the processor remembers. Where the kernel gives pages of 2 MiB to
//! those who ask for them, large arrays do. And what one array gives back, the next one takes, cleared or not: given to
//! the kernel in between, it would be found and cleared again.
//!
//! Sources: Linux, Documentation/admin-guide/mm/transhuge.rst; `mallopt(3)`.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};

/// The size of a large page.
#[cfg(any(target_os = "linux", test))]
const PAGE: usize = 2 << 20;

/// No number is aligned to more.
#[cfg(target_os = "linux")]
const OF_NUMBERS: usize = 16;

/// The allocator of the system, which asks for large pages.
pub struct LargePages;

// SAFETY: all memory is that of the system's allocator, as it gives it: advice changes neither places nor contents.
unsafe impl GlobalAlloc for LargePages {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as asked of this function
        let memory = unsafe { System.alloc(layout) };
        advise(memory, layout.size(), layout.align());
        memory
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as asked of this function
        let memory = unsafe { System.alloc_zeroed(layout) };
        advise(memory, layout.size(), layout.align());
        memory
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as asked of this function
        let memory = unsafe { System.realloc(memory, layout, size) };
        advise(memory, size, layout.align());
        memory
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as asked of this function
        unsafe { System.dealloc(memory, layout) }
    }
}

/// Has the system's allocator keep the memory that is given back to it, for the arrays to come: a run needs about as much
/// in each of its iterations. One that does not know how goes on as it does.
pub fn keep_memory() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    // SAFETY: both only change where later memory comes from; an option that is unknown is refused.
    unsafe {
        libc::mallopt(libc::M_MMAP_MAX, 0);
        libc::mallopt(libc::M_TRIM_THRESHOLD, -1);
    }
}

/// Asks for large pages where some fit in whole; a kernel that has none says so, and nothing is lost. Not for memory
/// aligned to more than numbers are: matrix products pack into such memory, 64 MiB for each thread, and touch little of it.
#[cfg_attr(not(target_os = "linux"), expect(unused_variables))]
fn advise(memory: *mut u8, size: usize, align: usize) {
    super::exhausted::note(memory, size);
    #[cfg(target_os = "linux")]
    if size >= PAGE
        && align <= OF_NUMBERS
        && !memory.is_null()
        && let Some((skip, length)) = whole_pages(memory.addr(), size)
    {
        // SAFETY: the range lies within memory that was just allocated, and the advice leaves its contents as they are.
        unsafe {
            libc::madvise(memory.add(skip).cast(), length, libc::MADV_HUGEPAGE);
        }
    }
}

/// The bytes before the first whole page in a range of memory, and those of all whole pages in it.
#[cfg(any(target_os = "linux", test))]
fn whole_pages(start: usize, size: usize) -> Option<(usize, usize)> {
    let skip = start.wrapping_neg() % PAGE;
    let length = size.checked_sub(skip)? / PAGE * PAGE;
    (length > 0).then_some((skip, length))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_pages_lie_within_the_range() {
        for (start, size, wanted) in [
            (0, PAGE, Some((0, PAGE))),
            (1, PAGE, None),
            (1, 2 * PAGE - 1, Some((PAGE - 1, PAGE))),
            (PAGE + 16, 4 * PAGE, Some((PAGE - 16, 3 * PAGE))),
            (PAGE - 16, PAGE + 15, None),
            (PAGE - 16, 8, None),
        ] {
            assert_eq!(whole_pages(start, size), wanted, "{start} {size}");
        }
    }

    #[test]
    fn memory_is_what_was_asked_for() {
        let mut some = vec![0u8; 3 * PAGE + 5];
        assert!(some.iter().all(|&b| b == 0));
        some.fill(7);
        some.resize(9 * PAGE, 8);
        assert!(some[..3 * PAGE + 5].iter().all(|&b| b == 7));
        assert!(some[3 * PAGE + 5..].iter().all(|&b| b == 8));
        some.truncate(PAGE);
        some.shrink_to_fit();
        assert!(some.len() == PAGE && some.iter().all(|&b| b == 7));
    }
}
