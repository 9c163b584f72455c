//! The state that kernels for wide registers leave behind.
//!
//! A function that uses the upper halves of vector registers should clear them when it returns: what follows in narrow
//! instructions on the same thread otherwise waits for their content. Matrix products of faer 0.24 with 512 bits do not;
//! the tangents of elements evaluated after them took 1.7 times as long (sliding blocks of 50,000 unknowns).
#![allow(unsafe_code)]

/// Clears the upper halves of the vector registers of this thread.
pub(super) fn clear_upper_halves() {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx") {
        // SAFETY: the processor has the instruction. No function may expect its caller or callee to keep upper halves, and
        // code compiled for wide registers knows that the intrinsic changes them.
        unsafe { std::arch::x86_64::_mm256_zeroupper() }
    }
}

/// The same on all threads of the current pool.
pub(super) fn clear_upper_halves_everywhere() {
    rayon::broadcast(|_| clear_upper_halves());
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;
    use std::arch::asm;

    /// Whether the processor says that upper halves are in use; nothing where it does not say.
    fn are_in_use() -> Option<bool> {
        let has_state = std::arch::is_x86_feature_detected!("avx")
            && std::arch::is_x86_feature_detected!("xsavec");
        if !has_state {
            return None;
        }
        let low: u32;
        // SAFETY: the processor has XGETBV, and with XSAVEC or XSAVES the form that reports the components in use.
        unsafe { asm!("xgetbv", in("ecx") 1, out("eax") low, out("edx") _) };
        Some(low & 0b100 != 0)
    }

    #[test]
    fn upper_halves_are_not_in_use_afterwards() {
        if are_in_use().is_none() {
            println!("skipped: the processor does not tell what is in use");
            return;
        }
        // SAFETY: the processor has AVX, and the register is named as changed.
        unsafe { asm!("vcmptrueps ymm15, ymm15, ymm15", out("ymm15") _) };
        let before = are_in_use();
        clear_upper_halves();
        println!("{before:?}");
        assert_eq!((before, are_in_use()), (Some(true), Some(false)));
    }
}
