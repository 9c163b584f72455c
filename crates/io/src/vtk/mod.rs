//! VTK's XML files: a scanner for the text in them, and the grid with its arrays in a `.vtu`.
//!
//! Read are arrays as text, in base64 or raw, in their tags or appended; of all widths and both byte orders; with sizes
//! of 4 or 8 bytes; plain or compressed by zlib. Nothing is believed: every size is checked against the bytes that are
//! there, and against the counts of the grid, before memory is asked for.
//!
//! Limits: one piece; UTF-8; no compressor but zlib. Fields of strings and bits are left out, by name.
//!
//! Source: *VTK File Formats*, section "XML File Formats"; what it leaves open, from files that VTK 9 writes.

pub mod cells;
mod decode;
mod stream;
pub(crate) mod xml;

pub use decode::{Array, Numbers, Vtu, VtuReadError, read, read_limited};
pub use xml::XmlError;
