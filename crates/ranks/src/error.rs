//! Why ranks did not hear one another.

/// Why ranks did not hear one another.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RanksError {
    /// A list does not have the length that goes with the number of ranks.
    #[error("messages between ranks: {got} {what} where {wanted} belong")]
    Shape {
        /// What the list has.
        what: &'static str,
        /// Its length.
        got: usize,
        /// The length that it should have.
        wanted: usize,
    },
    /// MPI gives up.
    #[error(
        "MPI fails in {call} with code {code}: look at what it has printed, and whether a rank has died"
    )]
    Library {
        /// The call of MPI.
        call: &'static str,
        /// What it returned.
        code: i32,
    },
}

/// Checks a length.
///
/// # Errors
/// `Shape`.
pub(crate) fn fits(what: &'static str, got: usize, wanted: usize) -> Result<(), RanksError> {
    if got == wanted {
        Ok(())
    } else {
        Err(RanksError::Shape { what, got, wanted })
    }
}
