//! Tables in `.dat` files, as CalculiX prints them.
//!
//! ```text
//!  displacements (vx,vy,vz) for set NALL and time  0.1000000E+01          a header with a time
//!
//!          1  0.000000E+00  0.000000E+00 -2.939934E-06                   identifiers, then values
//!
//!  statistics for slave set S, master set M and time  0.1000000E+01      a header, and under it
//!
//!    total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)   captions without one
//!
//!     3.026943E-01  6.054093E-01  …
//! ```
//!
//! The banners `S T E P 1` and `INCREMENT 1` of later versions are passed over, and so is a word behind the numbers of a
//! line: the name of an orientation, or the `L` of a local system. Whole numbers in front are identifiers; a number of
//! stars, which had no place in its columns, is none.

use super::fortran::{LineError, lines, real};
use std::sync::Arc;

/// Bytes of a header at most.
const HEADER: usize = 400;

/// A table: what stands under one header at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// The header without its time.
    pub section: Arc<str>,
    /// The line under the header that names which of its tables this is; empty where there is but one.
    pub caption: String,
    /// The time in the header.
    pub time: Option<f64>,
    /// The line of the header or caption, from 1.
    pub line: usize,
    /// Identifiers in front of every row.
    pub nid: usize,
    /// Values in every row.
    pub nvalue: usize,
    /// Identifiers, row by row.
    pub ids: Vec<i64>,
    /// Values, row by row.
    pub values: Vec<f64>,
}

impl Block {
    /// Header and caption.
    #[must_use]
    pub fn name(&self) -> String {
        match self.caption.as_str() {
            "" => self.section.to_string(),
            caption => format!("{}: {caption}", self.section),
        }
    }

    /// The names of the values in the last parentheses of the header, where there are as many as values.
    #[must_use]
    pub fn components(&self) -> Vec<&str> {
        let text = match self.caption.as_str() {
            "" => &*self.section,
            caption => caption,
        };
        let lists = text
            .split('(')
            .skip(1)
            .filter_map(|rest| rest.split(')').next());
        let names: Vec<&str> = lists
            .flat_map(|list| list.split(','))
            .map(str::trim)
            .collect();
        match names.len().checked_sub(self.nvalue) {
            Some(before) if before == 0 || before == self.nid => {
                names.into_iter().skip(before).collect()
            }
            _ => Vec::new(),
        }
    }
}

/// Reads all tables of a file. A header with nothing under it is an empty table. Where the number of columns changes under
/// a header, a new table begins.
///
/// # Errors
/// The first line that is neither a header nor a row of numbers.
///
/// # Limits
/// Headers of 400 bytes; identifiers of 63 bits. Memory is a small multiple of the size of the file.
///
/// # Example
/// ```
/// use signorini_io::readers::dat::parse;
///
/// let text = b"\n displacements (vx,vy,vz) for set ALL and time  0.1000000E+01\n\n\
///     \x20        1  0.000000E+00  0.000000E+00  2.500000E-01\n";
/// let tables = parse(text)?;
/// assert_eq!(tables[0].time, Some(1.0));
/// assert_eq!((tables[0].ids[0], tables[0].values[2]), (1, 0.25));
/// # Ok::<(), signorini_io::readers::LineError>(())
/// ```
pub fn parse(bytes: &[u8]) -> Result<Vec<Block>, LineError> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut row = Row::default();
    for (line, text) in lines(bytes) {
        let text = text.trim_ascii();
        let wrong = |what| LineError { line, what };
        if text.is_empty() {
            continue;
        }
        if row.read(text).map_err(wrong)? {
            let block = blocks.last_mut().ok_or(wrong("numbers without a header"))?;
            if !block.fits(&row) {
                let next = Block::new(&block.section, &block.caption, block.time, block.line);
                blocks.push(next);
            }
            if let Some(block) = blocks.last_mut() {
                block.push(&row);
            }
        } else if !is_banner(text) {
            if text.len() > HEADER {
                return Err(wrong("a header of more than 400 bytes"));
            }
            begin(&mut blocks, &String::from_utf8_lossy(text), line);
        }
    }
    Ok(blocks)
}

/// Starts the table of a header or caption.
fn begin(blocks: &mut Vec<Block>, text: &str, line: usize) {
    let next = match (split_time(text), blocks.last_mut()) {
        (Some((section, time)), _) => Block::new(&spaced(section), "", Some(time), line),
        (None, Some(last)) if last.time.is_some() => {
            if last.caption.is_empty() && last.is_empty() {
                last.caption = text.to_owned();
                last.line = line;
                return;
            }
            Block::new(&last.section, text, last.time, line)
        }
        (None, _) => Block::new(&text.into(), "", None, line),
    };
    blocks.push(next);
}

/// A header with a blank in front of the name of its set, which CalculiX 2.20 leaves out of that of heat fluxes.
fn spaced(section: &str) -> Arc<str> {
    match section.split_once(" for set") {
        Some((table, set)) if !set.starts_with(' ') => format!("{table} for set {set}").into(),
        _ => section.into(),
    }
}

/// Header and time of `… and time  0.1000000E+01`.
fn split_time(text: &str) -> Option<(&str, f64)> {
    let (before, time) = text.rsplit_once("time")?;
    let time = real(time.as_bytes())?;
    let before = before.trim_end();
    Some((
        before.strip_suffix(" and").unwrap_or(before).trim_end(),
        time,
    ))
}

/// Whether a line is `S T E P  1` or `INCREMENT  1`.
fn is_banner(text: &[u8]) -> bool {
    let dense: Vec<u8> = text
        .iter()
        .copied()
        .filter(|c| *c != b' ')
        .take(40)
        .collect();
    let number = [&b"STEP"[..], b"INCREMENT"]
        .iter()
        .find_map(|key| dense.strip_prefix(*key));
    number.is_some_and(|n| !n.is_empty() && n.iter().all(u8::is_ascii_digit))
}

impl Block {
    fn new(section: &Arc<str>, caption: &str, time: Option<f64>, line: usize) -> Self {
        Self {
            section: Arc::clone(section),
            caption: caption.to_owned(),
            time,
            line,
            nid: 0,
            nvalue: 0,
            ids: Vec::new(),
            values: Vec::new(),
        }
    }

    fn is_empty(&self) -> bool {
        self.ids.is_empty() && self.values.is_empty()
    }

    fn fits(&self, row: &Row) -> bool {
        self.is_empty() || (self.nid, self.nvalue) == (row.ids.len(), row.values.len())
    }

    fn push(&mut self, row: &Row) {
        (self.nid, self.nvalue) = (row.ids.len(), row.values.len());
        self.ids.extend_from_slice(&row.ids);
        self.values.extend_from_slice(&row.values);
    }
}

/// The numbers of a line.
#[derive(Default)]
struct Row {
    ids: Vec<i64>,
    values: Vec<f64>,
}

impl Row {
    /// Takes the numbers of a line; says whether it starts with one.
    fn read(&mut self, text: &[u8]) -> Result<bool, &'static str> {
        self.ids.clear();
        self.values.clear();
        let mut has_word = false;
        let words = text
            .split(u8::is_ascii_whitespace)
            .filter(|word| !word.is_empty());
        for word in words {
            let id = match self.values.is_empty() {
                true => identifier(word),
                false => None,
            };
            let value = match word.iter().all(|c| *c == b'*') {
                true => Some(f64::NAN),
                false => real(word),
            };
            match (id, value) {
                _ if has_word && value.is_some() => return Err("a number behind a word"),
                (Some(id), _) => self.ids.push(id),
                (None, Some(value)) => self.values.push(value),
                (None, None) if self.ids.is_empty() && self.values.is_empty() => return Ok(false),
                (None, None) => has_word = true,
            }
        }
        Ok(true)
    }
}

/// A whole number without point or exponent.
fn identifier(word: &[u8]) -> Option<i64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::mutate::{Generator, mutate};

    const TEXT: &str = "
                        S T E P       1


                                INCREMENT     1


 displacements (vx,vy,vz) for set NALL and time  0.1000000E+01

         1  0.000000E+00  0.000000E+00  0.000000E+00
         2  1.000000E+00 -2.000000E+00  3.000000-101 L

 stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) for set EALL and time  0.1000000E+01

         7   1  1.000000E+00  2.000000E+00  3.000000E+00  4.000000E+00  5.000000E+00 *************

 total force (fx,fy,fz) for set NFIX and time  0.1000000E+01

        3.026943E-01  6.054093E-01  2.500000E+01

 contact stress (slave node,press,tang1,tang2) for all contact elements and time0.2000000E+01

 statistics for slave set SSLAV, master set SMAST and time  0.2000000E+01

   total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)

    1.000000E+00  2.000000E+00  3.000000E+00  4.000000E+00  5.000000E+00  6.000000E+00

   area,  normal force (+ = tension) and shear force (size)

    2.500000E-01 -2.500000E+01  6.768635E-01
";

    #[test]
    fn tables_are_read_with_their_headers_times_and_identifiers() {
        let blocks = parse(TEXT.as_bytes()).unwrap();
        assert_eq!(blocks.len(), 6);
        let [moved, stress, force, empty, total, area] = &blocks[..] else {
            panic!()
        };
        assert_eq!(&*moved.section, "displacements (vx,vy,vz) for set NALL");
        assert_eq!((moved.time, moved.nid, moved.nvalue), (Some(1.0), 1, 3));
        assert_eq!(moved.ids, [1, 2]);
        assert_eq!(moved.values, [0.0, 0.0, 0.0, 1.0, -2.0, 3e-101]);
        assert_eq!(moved.components(), ["vx", "vy", "vz"]);
        assert_eq!((stress.nid, &stress.ids[..]), (2, &[7, 1][..]));
        assert!(stress.values[5].is_nan());
        assert_eq!(stress.components().last(), Some(&"syz"));
        assert_eq!(
            (force.nid, &force.values[..]),
            (0, &[3.026943e-1, 6.054093e-1, 25.0][..])
        );
        assert!(empty.is_empty() && empty.time == Some(2.0));
        assert!(
            total
                .name()
                .starts_with("statistics for slave set SSLAV, master set SMAST: total surface")
        );
        assert_eq!(total.components(), ["fx", "fy", "fz", "mx", "my", "mz"]);
        assert_eq!(area.time, Some(2.0));
        assert!(area.caption.starts_with("area"));
        assert_eq!(area.values, [0.25, -25.0, 6.768635e-1]);
    }

    #[test]
    fn what_is_no_table_is_refused_with_its_line() {
        assert_eq!(parse(b"").unwrap(), []);
        let error = |text: &str| parse(text.as_bytes()).unwrap_err();
        assert_eq!(error("\n 1 2.0").line, 2);
        assert_eq!(
            error(" a\n 1 2.0 b 3.0").to_string(),
            "line 2: a number behind a word"
        );
        assert_eq!(error(&"x".repeat(500)).line, 1);
        // other columns under the same header are another table
        let blocks = parse(b" a\n 1 2.0\n 1 2 3.0\n 4 5 6.0").unwrap();
        assert_eq!(blocks.iter().map(|b| b.nid).collect::<Vec<_>>(), [1, 2]);
    }

    #[test]
    fn damaged_files_are_read_or_refused() {
        let mut generator = Generator::new(11);
        let mut refused = 0;
        for _ in 0..5000 {
            let bytes = mutate(TEXT.as_bytes(), &mut generator);
            match parse(&bytes) {
                Ok(blocks) => {
                    for block in blocks {
                        assert!(block.values.len() <= bytes.len());
                        let nrow = block.ids.len().checked_div(block.nid).unwrap_or(0);
                        assert!(block.nid == 0 || block.values.len() == nrow * block.nvalue);
                        let _ = (block.name(), block.components());
                    }
                }
                Err(error) => {
                    assert!(error.line <= 100);
                    refused += 1;
                }
            }
        }
        assert!(refused > 100, "{refused}");
    }
}
