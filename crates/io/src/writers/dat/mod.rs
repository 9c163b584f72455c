//! `NAME.dat`: printed tables in CalculiX's format, that people compare and scripts read.
//!
//! ```text
//!                         S T E P       1
//!
//!
//!                                 INCREMENT     3
//!
//!
//!  stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) for set BEAM and time  0.1000000E+01
//!
//!          7   1  1.250000E+02 -3.000000E-01  0.000000E+00  0.000000E+00  0.000000E+00  0.000000E+00
//! ```
//!
//! A page is what belongs to one time: its heading, as versions from 2.21 on write it, and tables. Columns are fixed;
//! names are in capitals, as CalculiX has them. Tensors run xx, yy, zz, xy, xz, yz, shear strains being components of the
//! tensor. What is printed where in an element, and in which order, is the matter of [`Points`].
//!
//! Contact is printed of nodes, in the way of node-to-face contact. Of methods with points inside faces it is printed of
//! faces: sums and means over the points that touch, where CalculiX has a row for each of its points.
//!
//! Bodies of revolution are printed as CalculiX's wedge of two degrees: forces, energies and volumes are [`WEDGE`] times
//! those of the circumference.

mod contact;
mod points;
#[cfg(test)]
mod tests;

pub use contact::{ContactKind, Statistics, tangents};
pub use points::{Points, WEDGE};

use super::rows::{Newlines, RowFile, RowsError};
use crate::fs::Fs;
use signorini_geometry::tensor::Sym3;
use std::fmt::Write as _;
use std::path::Path;

/// What a table holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Displacements of nodes.
    Displacements,
    /// Forces of bodies and contacts at nodes.
    Forces,
    /// Their sum.
    TotalForce,
    /// Temperatures of nodes.
    Temperatures,
    /// Heat that bodies and contacts take from nodes.
    Heat,
    /// Its sum.
    TotalHeat,
    /// Fluxes of heat at points.
    HeatFluxes,
    /// Cauchy stresses at points.
    Stresses,
    /// Strains at points: linear, or of Green and Lagrange.
    Strains,
    /// The parts of them that cause stress.
    MechanicalStrains,
    /// Equivalent plastic strains at points.
    PlasticStrains,
    /// Energies per initial volume at points.
    EnergyDensities,
    /// Energies of elements.
    Energies,
    /// Their sum.
    TotalEnergy,
    /// Initial volumes of elements.
    Volumes,
    /// Their sum.
    TotalVolume,
    /// Squared angular velocities of the centrifugal loads on elements.
    Spins,
}

impl Kind {
    const fn caption(self) -> &'static str {
        match self {
            Self::Displacements => "displacements (vx,vy,vz) ",
            Self::Forces => "forces (fx,fy,fz) ",
            Self::TotalForce => "total force (fx,fy,fz) ",
            Self::Temperatures => "temperatures ",
            Self::Heat => "heat generation ",
            Self::TotalHeat => "total heat generation ",
            Self::HeatFluxes => "heat flux (elem, integ.pnt.,qx,qy,qz) ",
            Self::Stresses => "stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) ",
            Self::Strains => "strains (elem, integ.pnt.,exx,eyy,ezz,exy,exz,eyz) ",
            Self::MechanicalStrains => {
                "mechanical strains (elem, integ.pnt.,exx,eyy,ezz,exy,exz,eyz) "
            }
            // no blank: so it is written
            Self::PlasticStrains => "equivalent plastic strain (elem, integ.pnt.,pe)",
            Self::EnergyDensities => "internal energy density (elem, integ.pnt.,energy) ",
            Self::Energies => "internal energy (element, energy) ",
            Self::TotalEnergy => "total internal energy ",
            Self::Volumes => "volume (element, volume) ",
            Self::TotalVolume => "total volume ",
            Self::Spins => "centrifugal force(element,omega square) ",
        }
    }
}

/// What the numbers of a row belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Of {
    /// The node or element of this number.
    One(u64),
    /// The node of this number, along axes of its own.
    Local(u64),
    /// A point of an element, from 1.
    Point(u64, usize),
    /// A point of an element, from 1, along the axes of its material.
    LocalPoint(u64, usize),
    /// A side of an element, from 1.
    Side(u64, usize),
    /// The whole set.
    All,
    /// Both sides of a contact.
    Both,
}

/// The tables of one time.
#[derive(Clone, Debug)]
pub struct Page {
    text: String,
    time: String,
}

impl Page {
    /// An empty page: step and increment from 1, the time since the run began.
    #[must_use]
    pub fn new(step: usize, increment: usize, time: f64) -> Self {
        let mut page = Self {
            text: String::new(),
            time: String::new(),
        };
        put_time(&mut page.time, time);
        page.line(format_args!("\n{:24}S T E P{step:8}\n\n", ""));
        page.line(format_args!("{:32}INCREMENT{increment:6}\n", ""));
        page
    }

    /// Begins a table of a set.
    pub fn table(&mut self, kind: Kind, set: &str) {
        let (caption, time) = (kind.caption(), std::mem::take(&mut self.time));
        let set = set.to_ascii_uppercase();
        self.line(format_args!("\n {caption}for set {set} and time {time}\n"));
        self.time = time;
    }

    /// Adds a row to the table.
    pub fn row(&mut self, of: Of, numbers: &[f64]) {
        // writing to a string cannot fail
        let _ = match of {
            Of::One(label) | Of::Local(label) => write!(self.text, "{label:10}"),
            Of::Point(label, point) | Of::LocalPoint(label, point) => {
                write!(self.text, "{label:10} {point:3}")
            }
            Of::Side(label, side) => write!(self.text, "{label:10} {side:10}"),
            Of::All => write!(self.text, "{:6}", ""),
            Of::Both => write!(self.text, "{:2}", ""),
        };
        for number in numbers {
            self.text.push(' ');
            put_number(&mut self.text, *number);
        }
        if matches!(of, Of::Local(_) | Of::LocalPoint(..)) {
            self.text.push_str(" L");
        }
        self.text.push('\n');
    }

    fn line(&mut self, text: std::fmt::Arguments<'_>) {
        // writing to a string cannot fail
        let _ = writeln!(self.text, "{text}");
    }

    /// What it says so far.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }
}

/// The components of a tensor in the order of the tables.
#[must_use]
pub fn tensor(of: &Sym3) -> [f64; 6] {
    [of.xx(), of.yy(), of.zz(), of.xy(), of.xz(), of.yz()]
}

/// Fortran's `1p,e13.6`.
fn put_number(text: &mut String, number: f64) {
    let start = text.len();
    match put_digits(text, number) {
        Some(exponent) => put_exponent(text, exponent),
        None => put_no_number(text, number),
    }
    align(text, start, 13);
}

/// Fortran's `e14.7`: nothing before the point.
fn put_time(text: &mut String, number: f64) {
    let start = text.len();
    match put_digits(text, number) {
        Some(exponent) => {
            // d.dddddd becomes 0.ddddddd
            let point = text[start..].find('.').map_or(start, |at| start + at);
            text.remove(point);
            text.insert_str(point.saturating_sub(1).max(start), "0.");
            put_exponent(text, if number == 0.0 { 0 } else { exponent + 1 });
        }
        None => put_no_number(text, number),
    }
    align(text, start, 14);
}

/// Adds seven digits and answers with the power of ten behind the first; nothing for NaN and infinities.
fn put_digits(text: &mut String, number: f64) -> Option<i32> {
    if !number.is_finite() {
        return None;
    }
    let start = text.len();
    let _ = write!(text, "{number:.6e}");
    let at = start + text.get(start..)?.find('e')?;
    let exponent = text.get(at + 1..)?.parse().ok();
    text.truncate(at);
    exponent
}

/// Three digits take the place of the letter.
fn put_exponent(text: &mut String, exponent: i32) {
    let _ = match exponent {
        -99..=99 => write!(text, "E{exponent:+03}"),
        _ => write!(text, "{exponent:+04}"),
    };
}

fn put_no_number(text: &mut String, number: f64) {
    text.push_str(match number {
        f64::INFINITY => "Infinity",
        f64::NEG_INFINITY => "-Infinity",
        _ => "NaN",
    });
}

/// Moves what was added since `start` to the right of a column.
fn align(text: &mut String, start: usize, width: usize) {
    let length = text.len() - start;
    let blanks = width.saturating_sub(length);
    text.insert_str(start, &"              "[..blanks.min(14)]);
}

/// The growing file of a run.
#[derive(Debug)]
pub struct Tables {
    rows: RowFile,
}

impl Tables {
    /// Starts the file again.
    ///
    /// # Errors
    /// [`RowsError::Fs`].
    pub fn create(fs: &dyn Fs, path: &Path) -> Result<Self, RowsError> {
        Ok(Self {
            rows: RowFile::create(fs, path, "")?,
        })
    }

    /// Goes on after the first `keep` lines; what follows them is cut off.
    ///
    /// # Errors
    /// [`RowsError::MissingRows`], [`RowsError::Fs`].
    pub fn resume(fs: &dyn Fs, path: &Path, keep: u64) -> Result<Self, RowsError> {
        Ok(Self {
            rows: RowFile::resume(fs, path, "", keep, Newlines::Plain)?,
        })
    }

    /// Appends a page and hands it to the system at once.
    ///
    /// # Errors
    /// [`RowsError::Fs`]; nothing of the page is then in the file.
    pub fn append(&mut self, page: &Page) -> Result<(), RowsError> {
        self.rows.append_lines(page.text())
    }

    /// Makes all pages durable; to be called before a checkpoint counts them.
    ///
    /// # Errors
    /// [`RowsError::Fs`].
    pub fn sync(&mut self) -> Result<(), RowsError> {
        self.rows.sync()
    }

    /// The number of lines.
    #[must_use]
    pub fn nrow(&self) -> u64 {
        self.rows.nrow()
    }
}
