//! The numbers of the solution, from the case.

use signorini_io::case::{self, FreeMotions};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Spanned, codes};
use signorini_linear::{LinearKind, SOLVERS};
use signorini_mechanics::solve::{LineSearch, NewtonSettings, StepperSettings};
use signorini_mechanics::system::GeometricStress;

/// The numbers of the solution.
pub(super) fn settings(solver: &case::Solver, found: &mut Diagnostics) -> StepperSettings {
    let newton = &solver.newton;
    StepperSettings {
        newton: NewtonSettings {
            max_iterations: newton.max_iterations as usize,
            force_tol: newton.force_tol,
            line_search: match newton.line_search {
                case::LineSearch::Off => LineSearch::Off,
                case::LineSearch::Auto | case::LineSearch::On => LineSearch::Auto,
            },
            geometric: match newton.stress {
                case::GeometricStress::Auto => GeometricStress::Auto,
                case::GeometricStress::Mixed => GeometricStress::Mixed,
                case::GeometricStress::Current => GeometricStress::Current,
            },
            hold_free: solver.free_motions == FreeMotions::Hold,
        },
        linear: linear(&solver.linear, found),
        stabilize_after: stabilize_after(&solver.on_trouble),
    }
}

/// How many sizes of an increment fail before viscous forces help: where sizes come first, some.
fn stabilize_after(remedies: &[case::Remedy]) -> Option<usize> {
    let place = remedies.iter().position(|r| *r == case::Remedy::Stabilize);
    place.map(|before| if before == 0 { 0 } else { SIZES })
}

/// Sizes of an increment that fail before viscous forces help, where smaller ones are tried first.
const SIZES: usize = 1;

/// The linear solver of that name, which not every build has.
fn linear(choice: &Spanned<case::LinearChoice>, found: &mut Diagnostics) -> LinearKind {
    let word = choice.word();
    match SOLVERS.iter().find(|solver| solver.name == word) {
        Some(solver) => solver.kind,
        None => {
            found.push(
                Diagnostic::error(
                    &codes::NOT_BUILT,
                    format!("`linear = \"{word}\"` needs a library that this program was built without"),
                )
                .at(&choice.place, "known, but not in this build")
                .note(match choice.value {
                    case::LinearChoice::Petsc => {
                        "with PETSc and MPI (Debian: libpetsc-real-dev, libopenmpi-dev, openmpi-bin):  cargo build --release --features mpi"
                    }
                    _ => "with the library (Debian: libmumps-seq-dev):  cargo build --release --features mumps",
                })
                .help("without it:  linear = \"direct\""),
            );
            LinearKind::default()
        }
    }
}
