//! Why a linear system was not solved.

/// Why a linear system was not solved.
///
/// # Example
/// ```
/// use signorini_linear::sparsity::{BlockPattern, Pattern};
/// use signorini_linear::{LinearError, LinearKind, Problem, Symmetry, Values, choose};
///
/// // a spring that nothing holds
/// let bulk = BlockPattern::from_cliques(2, 1, &[0, 1], &[0, 2]);
/// let interface = Pattern::empty(2);
/// let values = Values { bulk: &[2.0, -2.0, -2.0, 2.0], interface: &[] };
/// let mut solver = choose(LinearKind::Direct);
/// solver.analyze(&Problem {
///     ndof: 2,
///     bulk: &bulk,
///     interface: &interface,
///     fields: &[],
///     equation: &[0, 1],
///     nequation: 2,
///     symmetry: Symmetry::Definite,
///     sign: &[1; 2],
///     coordinates: &[[0.0; 3]; 2],
///     between: &[],
/// })?;
/// let mut x = [0.0; 2];
/// let outcome = solver
///     .factorize(&values)
///     .and_then(|()| solver.solve(&values, &[-1.0, 1.0], &mut x, 1e-10));
/// assert!(matches!(outcome, Err(LinearError::Singular { .. })));
/// # Ok::<(), LinearError>(())
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinearError {
    /// A motion costs no force: the matrix is singular to round-off.
    #[error("the linear system is singular{}: something can move freely; hold every body, or close its contact",
        .equation.map(|e| format!(", most of all in equation {e}")).unwrap_or_default())]
    Singular {
        /// The equation that moves most, or whose row is zero; `None` where it cannot be determined.
        equation: Option<usize>,
    },
    /// A number in the matrix, the right-hand side or the solution is infinite or not a number.
    #[error(
        "the linear system holds a number that is not finite: look for inverted elements or overflowing laws"
    )]
    NotFinite,
    /// The solution does not satisfy the system.
    #[error(
        "the residual of the linear system stays at {residual:e} where {wanted:e} was asked: \
        look for stiffnesses that differ by many powers of ten, or ask for less"
    )]
    Inaccurate {
        /// The relative residual that was reached.
        residual: f64,
        /// The one that was asked for.
        wanted: f64,
    },
    /// The factor does not fit into memory or into its index.
    #[error(
        "the system of {nequation} equations ({nentry} entries) is too large for a direct solver: use fewer"
    )]
    TooLarge {
        /// The number of equations.
        nequation: usize,
        /// The entries of the matrix or of the factor where known, else those seen so far.
        nentry: usize,
    },
    /// A list has the wrong length.
    #[error("linear system: {got} {what} where {wanted} belong")]
    Shape {
        /// What the list holds.
        what: &'static str,
        /// Its length.
        got: usize,
        /// The length it should have.
        wanted: usize,
    },
    /// A number points outside what it numbers.
    #[error("linear system: {what} {number} is not below {end}")]
    Range {
        /// What is numbered.
        what: &'static str,
        /// The number.
        number: usize,
        /// The first number outside.
        end: usize,
    },
    /// A foreign library gives up for a reason of its own.
    #[error(
        "{name} gives up with code {code}, {detail}: its manual tells what they mean; \
        the solver \"direct\" does without it"
    )]
    Library {
        /// The library.
        name: &'static str,
        /// Its code.
        code: i32,
        /// What it says about the code.
        detail: i32,
    },
    /// A call came before the one that it depends on.
    #[error("linear solver: call {before} first")]
    Order {
        /// The call that is missing.
        before: &'static str,
    },
}
