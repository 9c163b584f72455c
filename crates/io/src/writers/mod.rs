//! What a run leaves behind: frames for viewers, tables for plots, lines for machines.
//!
//! ```text
//! frames/volume_0003.vtu   vtu   points, cells and fields at one time          written once, atomically
//! results.pvd              pvd   which frames there are, and their times       rewritten after every frame
//! history.csv              csv   one row per increment                         grows
//! convergence.csv          csv   one row per Newton iteration                  grows
//! hertz.sta                sta   one row per increment attempt                 grows
//! hertz.dat                dat   printed tables at the times asked for         grows
//! hertz.frd                frd   the mesh, then every frame                    grows
//! events.jsonl             json  one line per event                            grows
//! part.inp                 inp   a mesh                                        written once, atomically
//! summary.json             json  how it ended                                  written once, atomically
//! ```
//!
//! Writers never compute: they take plain slices and numbers and turn them into bytes. Every file goes through
//! [`Fs`](crate::fs::Fs). A frame is complete before a `.pvd` names it; files that grow are cut back to the checkpoint's
//! row when a run is resumed, so they must be synchronized before a checkpoint counts their rows.
//!
//! One more format: a file here that encodes into bytes, and a line in the table above.

pub mod csv;
pub mod dat;
pub mod frd;
pub mod inp;
pub mod json;
pub mod pvd;
mod rows;
pub mod sta;
pub mod vtu;

pub use rows::RowsError;
