//! The library behind a safe door: the only calls into PETSc.
#![allow(unsafe_code)]

use crate::error::LinearError;
use std::ptr::NonNull;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// PETSc is entered for one thread at a time.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

fn alone() -> MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The structure that only `shim.c` knows.
#[repr(C)]
struct Opaque {
    _private: [u8; 0],
}

unsafe extern "C" {
    fn signorini_petsc_new(made: *mut *mut Opaque) -> i32;
    fn signorini_petsc_free(share: *mut Opaque) -> i32;
    fn signorini_petsc_operator(
        share: *mut Opaque,
        nrow: i32,
        start: *const i32,
        column: *const i32,
        value: *const f64,
    ) -> i32;
    fn signorini_petsc_values(share: *mut Opaque, value: *const f64) -> i32;
    fn signorini_petsc_multiply(share: *mut Opaque, x: *const f64, y: *mut f64) -> i32;
    fn signorini_petsc_ask(share: *mut Opaque, count: i32, number: *const i32) -> i32;
    fn signorini_petsc_answer(share: *mut Opaque, own: *const f64, asked: *mut f64) -> i32;
    fn signorini_petsc_bodies(
        share: *mut Opaque,
        nrow: i32,
        start: *const i32,
        column: *const i32,
        value: *const f64,
        modes: *const f64,
    ) -> i32;
    fn signorini_petsc_cycle(
        share: *mut Opaque,
        b: *const f64,
        z: *mut f64,
        failed: *mut i32,
    ) -> i32;
    fn signorini_petsc_levels(share: *mut Opaque, levels: *mut i32) -> i32;
}

/// The rows of a matrix that this rank has, compressed, with columns as all ranks number them.
#[derive(Clone, Debug, Default)]
pub(super) struct OwnRows {
    pub start: Vec<i32>,
    pub column: Vec<i32>,
    pub value: Vec<f64>,
}

impl OwnRows {
    pub fn nrow(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// Whether its lists are those of a compressed matrix.
    fn check(&self) -> Result<i32, LinearError> {
        let ends = self.start.last().map(|&end| end as usize);
        fits("values of entries", self.value.len(), self.column.len())?;
        fits("entries of rows", ends.unwrap_or(0), self.column.len())?;
        count("rows", self.nrow())
    }
}

/// The matrices of a problem as PETSc keeps them, of which this rank has some rows.
pub(super) struct Share {
    id: NonNull<Opaque>,
    /// Rows and entries of the operator, rows of the bodies, and entries asked for.
    nrow: usize,
    nentry: usize,
    nbody: usize,
    nasked: usize,
}

// SAFETY: the structure is reached through this one owner alone, nothing in it belongs to a thread, and no two calls of
// PETSc run at once.
unsafe impl Send for Share {}

fn outcome(code: i32) -> Result<(), LinearError> {
    if code == 0 {
        Ok(())
    } else {
        Err(LinearError::Library {
            name: "PETSc",
            code,
            detail: 0,
        })
    }
}

fn fits(what: &'static str, got: usize, wanted: usize) -> Result<(), LinearError> {
    if got == wanted {
        Ok(())
    } else {
        Err(LinearError::Shape { what, got, wanted })
    }
}

fn count(what: &'static str, number: usize) -> Result<i32, LinearError> {
    i32::try_from(number).map_err(|_| LinearError::Range {
        what,
        number,
        end: i32::MAX as usize,
    })
}

impl Share {
    /// One without matrices.
    ///
    /// # Errors
    /// `Library`.
    pub fn new() -> Result<Self, LinearError> {
        // MPI comes first, entered as this program wants it
        signorini_ranks::world();
        let _alone = alone();
        let mut made = std::ptr::null_mut();
        // SAFETY: `made` is live and written during the call alone.
        outcome(unsafe { signorini_petsc_new(&raw mut made) })?;
        let id = NonNull::new(made).ok_or(LinearError::Library {
            name: "PETSc",
            code: -1,
            detail: 0,
        })?;
        Ok(Self {
            id,
            nrow: 0,
            nentry: 0,
            nbody: 0,
            nasked: 0,
        })
    }

    /// Takes the operator.
    ///
    /// # Errors
    /// `Shape`, `Range`, `Library`.
    pub fn set_operator(&mut self, rows: &OwnRows) -> Result<(), LinearError> {
        let nrow = rows.check()?;
        let _alone = alone();
        // SAFETY: `id` is alive; `start` has one entry more than there are rows and rises to the length of `column` and
        // `value`, as was checked; PETSc copies all three.
        outcome(unsafe {
            signorini_petsc_operator(
                self.id.as_ptr(),
                nrow,
                rows.start.as_ptr(),
                rows.column.as_ptr(),
                rows.value.as_ptr(),
            )
        })?;
        (self.nrow, self.nentry) = (rows.nrow(), rows.value.len());
        Ok(())
    }

    /// Takes other values of the same operator.
    ///
    /// # Errors
    /// `Shape`, `Library`.
    pub fn set_values(&mut self, rows: &OwnRows) -> Result<(), LinearError> {
        fits("rows", rows.nrow(), self.nrow)?;
        fits("values of entries", rows.value.len(), self.nentry)?;
        let _alone = alone();
        // SAFETY: `id` is alive; `value` has one number for each entry of its operator on this rank.
        outcome(unsafe { signorini_petsc_values(self.id.as_ptr(), rows.value.as_ptr()) })
    }

    /// `y = A x`, of both the entries of this rank.
    ///
    /// # Errors
    /// `Shape`, `Library`.
    pub fn multiply(&mut self, x: &[f64], y: &mut [f64]) -> Result<(), LinearError> {
        fits("entries", x.len(), self.nrow)?;
        fits("entries", y.len(), self.nrow)?;
        let _alone = alone();
        // SAFETY: `id` is alive; both lists have one entry for each row of this rank.
        outcome(unsafe { signorini_petsc_multiply(self.id.as_ptr(), x.as_ptr(), y.as_mut_ptr()) })
    }

    /// Which entries of vectors of all equations this rank asks for.
    ///
    /// # Errors
    /// `Range`, `Library`.
    pub fn ask(&mut self, number: &[i32]) -> Result<(), LinearError> {
        let n = count("entries asked for", number.len())?;
        let _alone = alone();
        // SAFETY: `id` is alive and has an operator; `number` has `n` entries, which PETSc copies.
        outcome(unsafe { signorini_petsc_ask(self.id.as_ptr(), n, number.as_ptr()) })?;
        self.nasked = number.len();
        Ok(())
    }

    /// Those entries of the vector of which this rank has `own`.
    ///
    /// # Errors
    /// `Shape`, `Library`.
    pub fn answer(&mut self, own: &[f64], asked: &mut [f64]) -> Result<(), LinearError> {
        fits("entries", own.len(), self.nrow)?;
        fits("entries asked for", asked.len(), self.nasked)?;
        let _alone = alone();
        // SAFETY: `id` is alive; `own` has one entry for each row of this rank, `asked` one for each that was asked for.
        outcome(unsafe {
            signorini_petsc_answer(self.id.as_ptr(), own.as_ptr(), asked.as_mut_ptr())
        })
    }

    /// Makes the hierarchy of the bodies.
    ///
    /// # Shapes
    /// `modes`: six motions, one after the other, each with one entry for each row of this rank.
    ///
    /// # Errors
    /// `Shape`, `Range`, `Library`.
    pub fn set_bodies(&mut self, rows: &OwnRows, modes: &[f64]) -> Result<(), LinearError> {
        let nrow = rows.check()?;
        fits("entries of motions", modes.len(), 6 * rows.nrow())?;
        let _alone = alone();
        // SAFETY: `id` is alive; the lists of `rows` were checked, and `modes` has six entries for each row; PETSc copies
        // all of them.
        outcome(unsafe {
            signorini_petsc_bodies(
                self.id.as_ptr(),
                nrow,
                rows.start.as_ptr(),
                rows.column.as_ptr(),
                rows.value.as_ptr(),
                modes.as_ptr(),
            )
        })?;
        self.nbody = rows.nrow();
        Ok(())
    }

    /// One cycle of the hierarchy, of both lists the entries of this rank; false where a smoother or the coarsest level
    /// has failed on some rank.
    ///
    /// # Errors
    /// `Shape`, `Library`.
    pub fn cycle(&mut self, b: &[f64], z: &mut [f64]) -> Result<bool, LinearError> {
        fits("entries", b.len(), self.nbody)?;
        fits("entries", z.len(), self.nbody)?;
        let mut failed = 0;
        let _alone = alone();
        // SAFETY: `id` is alive and has a hierarchy; both lists have one entry for each of its rows on this rank.
        outcome(unsafe {
            signorini_petsc_cycle(
                self.id.as_ptr(),
                b.as_ptr(),
                z.as_mut_ptr(),
                &raw mut failed,
            )
        })?;
        Ok(failed == 0)
    }

    /// Levels of the hierarchy.
    ///
    /// # Errors
    /// `Library`.
    pub fn levels(&mut self) -> Result<usize, LinearError> {
        let mut levels = 0;
        let _alone = alone();
        // SAFETY: `id` is alive and has a hierarchy; the number is live and written during the call alone.
        outcome(unsafe { signorini_petsc_levels(self.id.as_ptr(), &raw mut levels) })?;
        Ok(usize::try_from(levels).unwrap_or(0))
    }
}

impl Drop for Share {
    fn drop(&mut self) {
        let _alone = alone();
        // SAFETY: `id` came from `signorini_petsc_new` and is given back once.
        unsafe { signorini_petsc_free(self.id.as_ptr()) };
    }
}
