//! Contact mechanics by finite elements: the library's face.
//!
//! ```text
//! case.toml ──load──▶ Case + Mesh ──build──▶ Model ──solve──▶ hertz.out/results.pvd, history.csv, …
//!                                                     │
//!                                                     └──▶ News ──▶ Listener (terminal, --json, Python)
//! ```
//!
//! # Example
//! ```no_run
//! use signorini::{Reading, RunOptions, build, load, solve};
//!
//! let loaded = load("hertz.toml".as_ref(), &Reading::default())?;
//! eprint!("{}", loaded.warnings);
//! let model = build(loaded.case, loaded.mesh)?;
//! let options = RunOptions::new(loaded.source);
//! let finished = solve(model, &options, &mut ());
//! eprint!("{}", finished.diagnostics);
//! for (name, contact) in &finished.summary.contacts {
//!     println!("{name}: force {:?}, largest pressure {}", contact.force, contact.pressure_max);
//! }
//! assert_eq!(finished.exit_code, 0);
//! # Ok::<(), signorini::Diagnostics>(())
//! ```

pub mod crash;
mod driver;
mod load;
mod own;
pub mod prelude;
pub mod preview;
pub mod ranks;
pub mod resume;
pub mod run;
pub mod setup;
pub mod status;
pub mod text;
pub mod threads;
mod vocabulary;

pub use driver::Driver;
pub use load::{Loaded, Opened, Reading, Source, load, load_case, load_mesh, open_text};
pub use own::Own;
pub use run::{Finished, Limits, Listener, News, RunOptions, run, solve};
pub use setup::{Model, build, build_with};
pub use signorini_io::deck::Compat;
pub use signorini_io::diagnostic::{Diagnostic, Diagnostics};
pub use vocabulary::vocabulary;

/// The version of the program.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
