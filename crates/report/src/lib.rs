//! Results of contact problems as one HTML page that works offline, and as PNG pictures.
//!
//! ```text
//! folder of results ──results──▶ tables, texts, frames ──page──▶ report.html
//!                                         └──skin, fields──▶ picture ──▶ PNG
//! ```
//!
//! Nothing here computes mechanics: every number on a page is one that the run wrote. All files go through
//! [`signorini_io::fs::Fs`]. A folder need not be complete: what is missing is left out, and the page says so.

mod colour;
mod error;
pub mod fields;
mod picture;
pub mod results;
pub mod skin;
pub mod table;
mod text;

pub use error::ReportError;
pub use picture::{PictureOptions, names, picture};
