//! The library behind a safe door: the only calls into MUMPS.
#![allow(unsafe_code)]

use crate::error::LinearError;
use std::ptr::NonNull;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// MUMPS keeps state of its own between the calls of one process: two at once would disturb each other.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

fn alone() -> MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The structure of MUMPS, which only `shim.c` knows.
#[repr(C)]
struct Opaque {
    _private: [u8; 0],
}

/// How a call ended: `INFOG(1)` and `INFOG(2)`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Status {
    /// Negative for an error, positive for a warning.
    pub code: i32,
    /// What more there is to say.
    pub detail: i32,
}

unsafe extern "C" {
    fn signorini_mumps_new(symmetry: i32) -> *mut Opaque;
    fn signorini_mumps_free(id: *mut Opaque);
    fn signorini_mumps_analyze(
        id: *mut Opaque,
        n: i32,
        nentry: i64,
        row: *mut i32,
        column: *mut i32,
        place: *mut i32,
    ) -> Status;
    fn signorini_mumps_factorize(
        id: *mut Opaque,
        row: *mut i32,
        column: *mut i32,
        value: *mut f64,
        spare: i32,
    ) -> Status;
    fn signorini_mumps_negative_pivots(id: *const Opaque) -> i32;
    fn signorini_mumps_solve(id: *mut Opaque, x: *mut f64) -> Status;
}

/// What is eliminated how, `SYM` of MUMPS.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// L U with pivots.
    Unsymmetric = 0,
    /// L D Lᵀ, pivots as they come.
    Definite = 1,
    /// L D Lᵀ with pivots of one and two rows.
    Symmetric = 2,
}

/// The place of every entry of a matrix, counted from 1, and when every unknown is eliminated.
pub(super) struct Pattern {
    row: Vec<i32>,
    column: Vec<i32>,
    place: Vec<i32>,
}

impl Pattern {
    /// From entries and an order of elimination, `order[new] = old`; `None` where a number needs more than 32 bits.
    pub fn new(entries: impl Iterator<Item = (u32, u32)>, order: &[u32]) -> Option<Self> {
        let one_more = |number: u32| i32::try_from(number).ok()?.checked_add(1);
        let (mut row, mut column) = (Vec::new(), Vec::new());
        for (i, j) in entries {
            row.push(one_more(i)?);
            column.push(one_more(j)?);
        }
        let mut place = vec![0; order.len()];
        for (new, &old) in (0u32..).zip(order) {
            *place.get_mut(old as usize)? = one_more(new)?;
        }
        Some(Self { row, column, place })
    }

    pub fn nentry(&self) -> usize {
        self.row.len()
    }
}

/// An analyzed matrix with its last factor.
pub(super) struct Instance {
    id: NonNull<Opaque>,
    kind: Kind,
    pattern: Pattern,
}

// SAFETY: the structure is reached through this one owner alone, nothing in it belongs to a thread, and no two calls of
// MUMPS run at once.
unsafe impl Send for Instance {}

impl Instance {
    /// Analyzes a pattern; of a symmetric matrix it has one triangle.
    ///
    /// # Errors
    /// The status of the analysis; `None` where not even its structure fits into memory.
    pub fn new(kind: Kind, mut pattern: Pattern) -> Result<Self, Option<Status>> {
        let n = i32::try_from(pattern.place.len()).map_err(|_| None)?;
        let nentry = i64::try_from(pattern.nentry()).map_err(|_| None)?;
        let alone = alone();
        // SAFETY: takes a number, and gives a structure of its own or null.
        let id = NonNull::new(unsafe { signorini_mumps_new(kind as i32) }).ok_or(None)?;
        // SAFETY: `id` is alive; `row` and `column` have `nentry` entries and `place` has `n`, all of them live and
        // borrowed for the call alone. MUMPS keeps none of the pointers: the shim takes them back.
        let status = unsafe {
            signorini_mumps_analyze(
                id.as_ptr(),
                n,
                nentry,
                pattern.row.as_mut_ptr(),
                pattern.column.as_mut_ptr(),
                pattern.place.as_mut_ptr(),
            )
        };
        drop(alone);
        let instance = Self { id, kind, pattern };
        if status.code < 0 {
            Err(Some(status))
        } else {
            Ok(instance)
        }
    }

    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// Factorizes; `spare` is working space beyond the estimate, in per cent.
    ///
    /// # Errors
    /// `Shape` where there is not one value per entry.
    pub fn factorize(&mut self, value: &mut [f64], spare: i32) -> Result<Status, LinearError> {
        fits("values of entries", value.len(), self.pattern.nentry())?;
        let _alone = alone();
        // SAFETY: `id` is alive and analyzed; the three lists have as many entries as the analysis was given, and are
        // borrowed for the call alone.
        Ok(unsafe {
            signorini_mumps_factorize(
                self.id.as_ptr(),
                self.pattern.row.as_mut_ptr(),
                self.pattern.column.as_mut_ptr(),
                value.as_mut_ptr(),
                spare,
            )
        })
    }

    /// Negative pivots of the last factor; 0 where they have no sign.
    pub fn negative_pivots(&self) -> usize {
        // the same number counts pivots off the diagonal there
        if self.kind == Kind::Unsymmetric {
            return 0;
        }
        // SAFETY: `id` is alive; the call only reads a number of it.
        let count = unsafe { signorini_mumps_negative_pivots(self.id.as_ptr()) };
        usize::try_from(count).unwrap_or(0)
    }

    /// Solves with the last factor, in place. MUMPS itself says so where there is none.
    ///
    /// # Errors
    /// `Shape` where there is not one number per unknown.
    pub fn solve(&mut self, x: &mut [f64]) -> Result<Status, LinearError> {
        fits("unknowns", x.len(), self.pattern.place.len())?;
        let _alone = alone();
        // SAFETY: `id` is alive; `x` has one number per unknown and is borrowed for the call alone.
        Ok(unsafe { signorini_mumps_solve(self.id.as_ptr(), x.as_mut_ptr()) })
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        let _alone = alone();
        // SAFETY: `id` came from `signorini_mumps_new` and is given back once.
        unsafe { signorini_mumps_free(self.id.as_ptr()) };
    }
}

fn fits(what: &'static str, got: usize, wanted: usize) -> Result<(), LinearError> {
    if got == wanted {
        Ok(())
    } else {
        Err(LinearError::Shape { what, got, wanted })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ⎡0 1⎤
    /// ⎣1 d⎦
    fn exchange(kind: Kind) -> Instance {
        let entries = match kind {
            Kind::Unsymmetric => vec![(0, 1), (1, 0), (1, 1)],
            _ => vec![(0, 1), (1, 1)],
        };
        let pattern = Pattern::new(entries.into_iter(), &[1, 0]).unwrap();
        Instance::new(kind, pattern).map_err(drop).unwrap()
    }

    #[test]
    fn pivots_are_found_off_the_diagonal() {
        let mut symmetric = exchange(Kind::Symmetric);
        assert_eq!(symmetric.factorize(&mut [1.0, 0.0], 20).unwrap().code, 0);
        assert_eq!(symmetric.negative_pivots(), 1);
        let mut unsymmetric = exchange(Kind::Unsymmetric);
        let status = unsymmetric.factorize(&mut [1.0, 2.0, 4.0], 20).unwrap();
        assert_eq!((status.code, unsymmetric.negative_pivots()), (0, 0));
        let mut x = [3.0, 5.0];
        assert_eq!(symmetric.solve(&mut x).unwrap().code, 0);
        assert_eq!(x, [5.0, 3.0]);
        let mut x = [3.0, 14.0];
        assert_eq!(unsymmetric.solve(&mut x).unwrap().code, 0);
        assert_eq!(x, [1.0, 3.0]);
    }

    #[test]
    fn faults_are_told_by_their_code() {
        let mut instance = exchange(Kind::Symmetric);
        assert_eq!(instance.solve(&mut [1.0, 1.0]).unwrap().code, -3);
        assert_eq!(instance.factorize(&mut [0.0, 0.0], 20).unwrap().code, -10);
        assert!(instance.factorize(&mut [1.0], 20).is_err());
        assert!(instance.solve(&mut [1.0]).is_err());
        let twice = Pattern::new([(0, 0), (1, 1)].into_iter(), &[0, 0]).unwrap();
        let status = Instance::new(Kind::Symmetric, twice).err().flatten();
        assert_eq!(status.map(|s| s.code), Some(-4));
    }

    #[test]
    fn threads_may_each_have_their_own() {
        std::thread::scope(|scope| {
            // powers of two, so that nothing is rounded
            for d in [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0] {
                scope.spawn(move || {
                    for _ in 0..20 {
                        let mut instance = exchange(Kind::Symmetric);
                        instance.factorize(&mut [1.0, d], 20).unwrap();
                        let mut x = [1.0, d + 1.0];
                        instance.solve(&mut x).unwrap();
                        assert_eq!(x, [1.0, 1.0]);
                    }
                });
            }
        });
    }
}
