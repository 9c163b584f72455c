//! Natural modes: the lowest eigenvalues of a pencil, `K φ = λ M φ`, by Lanczos' method with shift and inversion.
//!
//! ```text
//!   K − σ M  ──factor──▶  L D Lᵀ, with the number of eigenvalues below σ                            (E1)
//!   v ⟼ (K − σ M)⁻¹ M v,  θ = 1/(λ − σ):  a basis of its Krylov space, block by block               (E2)
//!   T = Vᵀ M (K − σ M)⁻¹ M V,  Vᵀ M V = 1:  T s = θ s,  φ = V s                                     (E3)
//!   ‖(K − σ M)⁻¹ M φ − θ φ‖_M = ‖T_next s‖                                                          (E4)
//!   K − τ M, τ above the last mode ──factor──▶ how many there are: all found, or the space grows    (E5)
//! ```
//!
//! All vectors are orthogonalized against all others, twice, in the inner product of the mass, and the best ones are kept where
//! the basis is full (thick restart). A block has several vectors, so that repeated eigenvalues come at once; (E5) says whether
//! one was missed all the same, and new directions are then added. Multipliers and nodes without mass are no hindrance: a last
//! application of (E2) takes from a mode what the mass does not see.
//!
//! `σ` is zero where `K` has a factor. Where bodies are free it is negative, of about the size of the first eigenvalue that is not
//! zero: at first it is taken from the stiffness against uniform strains, and again from the eigenvalues themselves.
//!
//! By Sylvester's law of inertia a factor of `K − σ M` has as many negative pivots as there are eigenvalues below σ, and one more
//! for each multiplier.
//!
//! The same bits on any number of threads: factors are made by one, sums go in a fixed order.
//!
//! Sources: Ericsson and Ruhe, Math. Comp. 35, 1980; Grimes, Lewis and Simon, SIAM J. Matrix Anal. Appl. 15, 1994; Wu and Simon,
//! SIAM J. Matrix Anal. Appl. 22, 2000 (thick restart); Nour-Omid, Parlett, Ericsson and Jensen, Math. Comp. 48, 1987 (mass
//! without full rank).

mod basis;
mod mode;
mod pencil;
mod search;

pub use mode::{Mode, Modes, Wanted};

use crate::error::LinearError;
use crate::problem::{Problem, Values};
use pencil::Pencil;
use search::Search;

/// The lowest modes of a symmetric pencil. The stiffness may have multipliers, whose sign in the problem is −1; the mass is not
/// negative in any motion and acts on no multiplier. There may be fewer modes than wanted: as many as the mass has
/// directions.
///
/// # Errors
/// Those of [`LinearSolver`](crate::LinearSolver): `Singular` where something moves without stiffness and without mass. `Slow` where
/// not all of them were found.
///
/// # Example
/// ```
/// use signorini_linear::sparsity::{BlockPattern, Pattern};
/// use signorini_linear::{Problem, Symmetry, Values, Wanted, lowest_modes};
///
/// // two masses of 1 between three springs of 1: ω² = 1, 3
/// let bulk = BlockPattern::from_cliques(2, 1, &[0, 1], &[0, 2]);
/// let problem = Problem {
///     ndof: 2,
///     bulk: &bulk,
///     interface: &Pattern::empty(2),
///     fields: &[],
///     equation: &[0, 1],
///     nequation: 2,
///     symmetry: Symmetry::Definite,
///     sign: &[1; 2],
///     coordinates: &[[0.0; 3], [1.0, 0.0, 0.0]],
///     between: &[],
/// };
/// let stiffness = Values { bulk: &[2.0, -1.0, -1.0, 2.0], interface: &[] };
/// let mass = Values { bulk: &[1.0, 0.0, 0.0, 1.0], interface: &[] };
/// let found = lowest_modes(&problem, [stiffness, mass], Wanted { count: 2, from: None })?;
/// for (mode, wanted) in found.modes.iter().zip([1.0, 3.0]) {
///     assert!((mode.eigenvalue - wanted).abs() < 1e-12);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn lowest_modes(
    problem: &Problem,
    [stiffness, mass]: [Values<'_>; 2],
    wanted: Wanted,
) -> Result<Modes, LinearError> {
    let mut pencil = Pencil::new(problem, [stiffness, mass])?;
    if wanted.count == 0 || problem.nequation == 0 {
        return Ok(Modes::default());
    }
    if let Some(from) = wanted.from {
        pencil.shift_near(from)?;
        return Search::new(&mut pencil, wanted)?.run();
    }
    let is_free = match pencil.shift_to(0.0) {
        Ok(()) => false,
        Err(LinearError::Singular { .. }) => true,
        Err(other) => return Err(other),
    };
    if !is_free {
        return Search::new(&mut pencil, wanted)?.run();
    }
    let mut shift = -pencil.first_guess();
    for _ in 0..GUESSES {
        pencil.shift_near(shift)?;
        let mut search = Search::new(&mut pencil, wanted)?;
        match search.better_shift()? {
            None => return search.run(),
            Some(better) => shift = better,
        }
    }
    pencil.shift_near(shift)?;
    Search::new(&mut pencil, wanted)?.run()
}

/// How often the shift of free bodies is chosen again, at most.
const GUESSES: usize = 3;
