//! Triangles from STL files, text and binary.
//!
//! ```text
//! text     solid NAME                         binary   80 bytes of anything, the number n (4 bytes)
//!            facet normal nx ny nz                     n times 50 bytes: normal, three corners
//!              outer loop                              (12 numbers of 4 bytes), 2 bytes of anything;
//!                vertex x y z      three times         all little-endian
//!              endloop
//!            endfacet
//!          endsolid NAME
//! ```
//!
//! A file is binary where its length is what its count says, or where it does not begin with `solid`, or where it has
//! zero bytes: some binary files begin with that word, too. Corners of exactly equal coordinates become one point;
//! triangles of which two corners are one point are left out. Outside is where the corners run counter-clockwise:
//! normals of the file are only compared with that. A text may hold several solids.
//!
//! Source: 3D Systems, *StereoLithography Interface Specification*, 1988.

use super::Place;
use super::error::excerpt;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;
use std::collections::HashMap;
use thiserror::Error;

/// The triangles of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// Points, each once.
    pub points: Vec<Vec3>,
    /// The corners of each triangle among them, counter-clockwise seen from outside.
    pub triangles: Vec<[NodeId; 3]>,
}

/// Why triangles cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum StlError {
    /// A file of no bytes, or of white space only.
    #[error("{place}: the file is empty; was it written to the end?")]
    Empty {
        /// Where.
        place: Place,
    },
    /// Text of two bytes per character.
    #[error("{place}: the file is in UTF-16; save it as plain text or as binary STL")]
    Utf16 {
        /// Where.
        place: Place,
    },
    /// Something else altogether.
    #[error(
        "{place}: this is not an STL file: it starts with `{found}`, and is too short for a binary one"
    )]
    NotStl {
        /// Where.
        place: Place,
        /// What was found.
        found: String,
    },
    /// A count that the file cannot hold.
    #[error(
        "{place}: {announced} triangles are announced, but only {found} follow; the file is truncated or damaged: save or copy it again"
    )]
    Count {
        /// Where.
        place: Place,
        /// What was announced.
        announced: u32,
        /// What was found.
        found: usize,
    },
    /// A text that ends too early.
    #[error(
        "{place}: the file ends where `{wanted}` should follow; it is truncated: save or copy it again"
    )]
    Truncated {
        /// Where.
        place: Place,
        /// What is needed.
        wanted: &'static str,
    },
    /// Another word than must come next.
    #[error("{place}: `{found}` stands where `{wanted}` should be")]
    Word {
        /// Where.
        place: Place,
        /// What is needed.
        wanted: &'static str,
        /// What was found.
        found: String,
    },
    /// Something else where a number should be.
    #[error("{place}: `{found}` stands where a coordinate should be{hint}")]
    NotANumber {
        /// Where.
        place: Place,
        /// What was found.
        found: String,
        /// What to do.
        hint: &'static str,
    },
    /// An infinite coordinate, or not a number.
    #[error("{place}: a coordinate of triangle {triangle} is {found}; coordinates must be finite")]
    NotFinite {
        /// Where.
        place: Place,
        /// The triangle, from 1.
        triangle: usize,
        /// What was found.
        found: String,
    },
    /// No triangles.
    #[error("{place}: there are no triangles in this file{hint}")]
    NoTriangles {
        /// Where.
        place: Place,
        /// What became of those there were.
        hint: &'static str,
    },
    /// More points than can be numbered.
    #[error("{place}: the triangles have more than 2^32 - 1 points")]
    TooMany {
        /// Where.
        place: Place,
    },
}

type Result<T> = std::result::Result<T, StlError>;

/// Bytes before the first triangle of a binary file.
const HEAD: usize = 84;
/// Bytes of a triangle.
const RECORD: usize = 50;

/// Reads triangles, with notes. `name` appears in messages.
///
/// # Errors
/// Any fault in the file, with the line or the byte.
///
/// # Example
/// ```
/// use signorini_io::readers::stl::read;
///
/// let text = b"solid tool\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
///     endloop\nendfacet\nendsolid tool\n";
/// let (found, _) = read("tool.stl", text)?;
/// assert_eq!((found.points.len(), found.triangles.len()), (3, 1));
/// # Ok::<(), signorini_io::readers::stl::StlError>(())
/// ```
pub fn read(name: &str, bytes: &[u8]) -> Result<(Triangles, Vec<String>)> {
    let place = || Place::File(name.into());
    if bytes.trim_ascii().is_empty() {
        return Err(StlError::Empty { place: place() });
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(StlError::Utf16 { place: place() });
    }
    let mut welded = Welded::new(name);
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let solid = text.trim_ascii_start().get(..5);
    let is_text = solid.is_some_and(|s| s.eq_ignore_ascii_case(b"solid")) && !bytes.contains(&0);
    match announced(bytes) {
        Some(n) if !is_text || size(n) == Some(bytes.len()) => binary(bytes, n, &mut welded)?,
        _ if is_text => Text::new(name, text).solids(&mut welded)?,
        _ => {
            return Err(StlError::NotStl {
                place: place(),
                found: excerpt(bytes),
            });
        }
    }
    welded.finished()
}

/// The number of triangles that a binary file announces.
fn announced(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(HEAD - 4..HEAD)?.first_chunk()?;
    Some(u32::from_le_bytes(*count))
}

/// The bytes of a binary file of this many triangles.
fn size(ntriangle: u32) -> Option<usize> {
    (ntriangle as usize).checked_mul(RECORD)?.checked_add(HEAD)
}

fn binary(bytes: &[u8], announced: u32, welded: &mut Welded) -> Result<()> {
    let records = bytes.get(HEAD..).unwrap_or_default();
    let found = records.len() / RECORD;
    let place = |offset| Place::Byte {
        file: welded.file.into(),
        offset,
    };
    if found < announced as usize {
        return Err(StlError::Count {
            place: place(HEAD - 4),
            announced,
            found,
        });
    }
    let more = records.len() - RECORD * announced as usize;
    if more > 0 {
        let after = format!("{more} bytes after the last of {announced} triangles were left out");
        welded.notes.push(after);
    }
    let records = records.chunks_exact(RECORD).take(announced as usize);
    for (i, record) in records.enumerate() {
        let mut numbers = [0.0; 12];
        for (number, raw) in numbers.iter_mut().zip(record.chunks_exact(4)) {
            let raw = raw.first_chunk().copied().unwrap_or_default();
            *number = f64::from(f32::from_le_bytes(raw));
        }
        let [nx, ny, nz, corners @ ..] = numbers;
        let offset = HEAD + RECORD * i;
        let place = || Place::Byte {
            file: welded.file.into(),
            offset,
        };
        let place = place();
        welded.push(Vec3::new(nx, ny, nz), corners, || place)?;
    }
    Ok(())
}

/// The words of a text.
struct Text<'a> {
    file: &'a str,
    rest: &'a [u8],
    line: usize,
}

impl<'a> Text<'a> {
    const fn new(file: &'a str, text: &'a [u8]) -> Self {
        Self {
            file,
            rest: text,
            line: 1,
        }
    }

    fn place(&self) -> Place {
        Place::Line {
            file: self.file.into(),
            line: self.line,
        }
    }

    fn advance(&mut self, n: usize) -> &'a [u8] {
        let (taken, rest) = self.rest.split_at(n.min(self.rest.len()));
        self.line += taken.iter().filter(|&&b| b == b'\n').count();
        self.rest = rest;
        taken
    }

    /// The next word; empty at the end.
    fn word(&mut self) -> &'a [u8] {
        let space = self.rest.len() - self.rest.trim_ascii_start().len();
        self.advance(space);
        let end = self.rest.iter().position(u8::is_ascii_whitespace);
        self.advance(end.unwrap_or(self.rest.len()))
    }

    fn skip_line(&mut self) {
        let end = self.rest.iter().position(|&b| b == b'\n' || b == b'\r');
        self.advance(end.unwrap_or(self.rest.len()));
    }

    /// The next word is one of these: which.
    fn one_of(&mut self, words: &[&'static str]) -> Result<usize> {
        let found = self.word();
        let is = |w: &str| found.eq_ignore_ascii_case(w.as_bytes());
        let wanted = words.first().copied().unwrap_or_default();
        if found.is_empty() {
            let place = self.place();
            return Err(StlError::Truncated { place, wanted });
        }
        words
            .iter()
            .position(|w| is(w))
            .ok_or_else(|| StlError::Word {
                place: self.place(),
                wanted,
                found: excerpt(found),
            })
    }

    fn expect(&mut self, words: &[&'static str]) -> Result<()> {
        words
            .iter()
            .try_for_each(|word| self.one_of(&[word]).map(|_| ()))
    }

    fn number(&mut self) -> Result<f64> {
        let found = self.word();
        if found.is_empty() {
            let (place, wanted) = (self.place(), "vertex x y z");
            return Err(StlError::Truncated { place, wanted });
        }
        let text = std::str::from_utf8(found).unwrap_or_default();
        text.parse().map_err(|_| StlError::NotANumber {
            place: self.place(),
            found: excerpt(found),
            hint: match found.contains(&b',') {
                true => ": use a decimal point, and spaces between numbers",
                false => "",
            },
        })
    }

    /// A component of a normal, which some programs write as they please: NaN where it is no number.
    fn component(&mut self) -> f64 {
        let text = std::str::from_utf8(self.word()).unwrap_or_default();
        text.parse().unwrap_or(f64::NAN)
    }

    fn solids(&mut self, welded: &mut Welded) -> Result<()> {
        let mut nsolid = 0;
        while !self.rest.trim_ascii_start().is_empty() {
            self.expect(&["solid"])?;
            self.skip_line();
            nsolid += 1;
            while self.one_of(&["endsolid", "facet"])? == 1 {
                self.facet(welded)?;
            }
            self.skip_line();
        }
        if nsolid > 1 {
            let several = format!("the {nsolid} solids of the file were read as one");
            welded.notes.push(several);
        }
        Ok(())
    }

    fn facet(&mut self, welded: &mut Welded) -> Result<()> {
        self.expect(&["normal"])?;
        let normal = Vec3::new(self.component(), self.component(), self.component());
        self.expect(&["outer", "loop"])?;
        let mut corners = [0.0; 9];
        for corner in corners.chunks_exact_mut(3) {
            self.expect(&["vertex"])?;
            for x in corner {
                *x = self.number()?;
            }
        }
        self.expect(&["endloop", "endfacet"])?;
        welded.push(normal, corners, || self.place())
    }
}

/// Triangles whose corners become one point where they are equal.
struct Welded<'a> {
    file: &'a str,
    mesh: Triangles,
    known: HashMap<[u64; 3], NodeId>,
    nread: usize,
    /// Triangles of which two corners are one.
    collapsed: usize,
    /// Triangles whose corners run against their normal.
    against: usize,
    notes: Vec<String>,
}

impl<'a> Welded<'a> {
    fn new(file: &'a str) -> Self {
        Self {
            file,
            mesh: Triangles::default(),
            known: HashMap::new(),
            nread: 0,
            collapsed: 0,
            against: 0,
            notes: Vec::new(),
        }
    }

    fn push(
        &mut self,
        normal: Vec3,
        corners: [f64; 9],
        place: impl FnOnce() -> Place,
    ) -> Result<()> {
        self.nread += 1;
        if let Some(x) = corners.iter().find(|x| !x.is_finite()) {
            return Err(StlError::NotFinite {
                place: place(),
                triangle: self.nread,
                found: x.to_string(),
            });
        }
        let [a, b, c, d, e, f, g, h, i] = corners;
        let corners = [[a, b, c], [d, e, f], [g, h, i]].map(Vec3::from);
        let mut triangle = [0; 3];
        for (node, corner) in triangle.iter_mut().zip(corners) {
            let Some(point) = self.point(corner) else {
                return Err(StlError::TooMany { place: place() });
            };
            *node = point;
        }
        let [p, q, r] = triangle;
        if p == q || q == r || r == p {
            self.collapsed += 1;
            return Ok(());
        }
        let [x, y, z] = corners;
        if (y - x).cross(z - x).dot(normal) < 0.0 {
            self.against += 1;
        }
        self.mesh.triangles.push(triangle);
        Ok(())
    }

    /// The number of a point.
    fn point(&mut self, x: Vec3) -> Option<NodeId> {
        // −0 is 0
        let key = x.to_array().map(|x| (x + 0.0).to_bits());
        if let Some(&known) = self.known.get(&key) {
            return Some(known);
        }
        let number = NodeId::try_from(self.mesh.points.len()).ok()?;
        self.mesh.points.push(x);
        self.known.insert(key, number);
        Some(number)
    }

    fn finished(mut self) -> Result<(Triangles, Vec<String>)> {
        if self.mesh.triangles.is_empty() {
            return Err(StlError::NoTriangles {
                place: Place::File(self.file.into()),
                hint: match self.collapsed {
                    0 => "",
                    _ => " but such as have two corners in one point",
                },
            });
        }
        if self.collapsed > 0 {
            self.notes.push(format!(
                "{} triangles of which two corners are one point were left out",
                self.collapsed
            ));
        }
        if self.against > 0 {
            self.notes.push(format!(
                "the normals of {} of {} triangles point against the order of their corners; the order was taken",
                self.against,
                self.mesh.triangles.len()
            ));
        }
        Ok((self.mesh, self.notes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron, as rows of normal and corners.
    fn tetrahedron() -> Vec<[[f32; 3]; 4]> {
        let x = [
            [0.0; 3],
            [1.5, 0.0, 0.0],
            [0.0, 1.25, 0.0],
            [0.0, 0.0, 1.0 / 3.0],
        ];
        let n = 0.5;
        vec![
            [[0.0, 0.0, -1.0], x[0], x[2], x[1]],
            [[0.0, -1.0, 0.0], x[0], x[1], x[3]],
            [[-1.0, 0.0, 0.0], x[0], x[3], x[2]],
            [[n, n, n], x[1], x[2], x[3]],
        ]
    }

    fn as_binary(head: &[u8], facets: &[[[f32; 3]; 4]]) -> Vec<u8> {
        let mut bytes = head.to_vec();
        bytes.resize(80, b' ');
        bytes.extend((facets.len() as u32).to_le_bytes());
        for facet in facets {
            bytes.extend(facet.iter().flatten().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0, 0]);
        }
        bytes
    }

    fn as_text(facets: &[[[f32; 3]; 4]]) -> String {
        let row = |x: [f32; 3]| format!("{} {} {}", x[0], x[1], x[2]);
        let facet = |[n, a, b, c]: &[[f32; 3]; 4]| {
            let loops: String = [a, b, c]
                .map(|x| format!("      vertex {}\n", row(*x)))
                .concat();
            format!(
                "  facet normal {}\n    outer loop\n{loops}    endloop\n  endfacet\n",
                row(*n)
            )
        };
        let facets: String = facets.iter().map(facet).collect();
        format!("solid a facet by name\n{facets}endsolid a facet by name\n")
    }

    fn said(bytes: &[u8]) -> String {
        read("a.stl", bytes).unwrap_err().to_string()
    }

    #[test]
    fn text_and_binary_give_the_same_welded_triangles() {
        let (mesh, notes) = read("a.stl", &as_binary(b"made by hand", &tetrahedron())).unwrap();
        assert_eq!(notes, [""; 0]);
        assert_eq!(mesh.points.len(), 4);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [2, 1, 3]]);
        assert_eq!(mesh.points[3], Vec3::new(0.0, 0.0, f64::from(1.0f32 / 3.0)));
        let (again, _) = read("a.stl", &as_binary(b"solid name", &tetrahedron())).unwrap();
        assert_eq!(again, mesh);
        let text = as_text(&tetrahedron());
        let near = |text: &str| {
            let (from_text, notes) = read("a.stl", text.as_bytes()).unwrap();
            assert_eq!(notes, [""; 0]);
            assert_eq!(from_text.triangles, mesh.triangles);
            let pairs = from_text.points.iter().zip(&mesh.points);
            assert!(pairs.into_iter().all(|(a, b)| (*a - *b).norm() < 1e-7));
        };
        near(&text);
        near(&text.to_uppercase().replace('\n', "\r\n"));
        near(&text.replace('\n', "\r"));
        near(&format!(
            "\u{feff}  {}",
            text.replace("normal 0 0 -1", "normal nan -nan(ind) x")
        ));
    }

    #[test]
    fn oddities_are_noted() {
        let mut facets = tetrahedron();
        facets[0][0] = [0.0, 0.0, 1.0];
        facets[1][2] = facets[1][1];
        facets[2][1] = [-0.0, 0.0, -0.0];
        let mut bytes = as_binary(b"", &facets);
        bytes.push(7);
        let (mesh, notes) = read("a.stl", &bytes).unwrap();
        assert_eq!((mesh.points.len(), mesh.triangles.len()), (4, 3));
        assert_eq!(
            notes,
            [
                "1 bytes after the last of 4 triangles were left out",
                "1 triangles of which two corners are one point were left out",
                "the normals of 1 of 3 triangles point against the order of their corners; the order was taken",
            ]
        );
        let twice = as_text(&tetrahedron()).repeat(2);
        let (mesh, notes) = read("a.stl", twice.as_bytes()).unwrap();
        assert_eq!((mesh.points.len(), mesh.triangles.len()), (4, 8));
        assert_eq!(notes, ["the 2 solids of the file were read as one"]);
    }

    #[test]
    fn faults_name_the_line_or_the_byte() {
        assert!(said(b" \n").contains("a.stl: the file is empty"));
        assert!(said(b"\xff\xfes\0o\0").contains("UTF-16"));
        assert_eq!(
            said(b"$MeshFormat\n4.1"),
            "a.stl: this is not an STL file: it starts with `$MeshFormat\\n4.1`, and is too short for a binary one"
        );
        let bytes = as_binary(b"solid", &tetrahedron());
        assert_eq!(
            said(&bytes[..bytes.len() - 1]),
            "a.stl, byte 80: 4 triangles are announced, but only 3 follow; the file is truncated or damaged: save or copy it again"
        );
        let mut many = bytes.clone();
        many[80..84].fill(0xff);
        assert!(said(&many).contains("4294967295 triangles are announced, but only 4 follow"));
        assert_eq!(
            said(&as_binary(b"", &[])),
            "a.stl: there are no triangles in this file"
        );
        let mut infinite = tetrahedron();
        infinite[1][3][1] = f32::INFINITY;
        assert_eq!(
            said(&as_binary(b"", &infinite)),
            "a.stl, byte 134: a coordinate of triangle 2 is inf; coordinates must be finite"
        );
        let text = as_text(&tetrahedron());
        let fault = |from: &str, to: &str| said(text.replacen(from, to, 1).as_bytes());
        assert_eq!(
            fault("vertex 0 1.25 0", "vertex 0 1,25 0"),
            "a.stl, line 5: `1,25` stands where a coordinate should be: use a decimal point, and spaces between numbers"
        );
        assert_eq!(
            fault("endloop", "endfacet"),
            "a.stl, line 7: `endfacet` stands where `endloop` should be"
        );
        assert!(fault("1.25", "nan").contains("a coordinate of triangle 1 is NaN"));
        assert_eq!(
            fault("endsolid a facet by name", ""),
            "a.stl, line 31: the file ends where `endsolid` should follow; it is truncated: save or copy it again"
        );
        assert!(said(b"solid a\nendsolid a").contains("no triangles"));
        let point = [[[0.0; 3]; 4]];
        assert!(
            said(&as_binary(b"", &point)).contains("but such as have two corners in one point")
        );
    }

    #[test]
    fn no_cut_and_no_changed_byte_panics() {
        let text = as_text(&tetrahedron()).into_bytes();
        for bytes in [text, as_binary(b"solid", &tetrahedron())] {
            for end in 0..bytes.len() {
                // a text may end without the name after its last word
                let cut = read("a.stl", &bytes[..end]);
                assert!(cut.is_err() || bytes[..end].windows(8).any(|w| w == b"endsolid"));
            }
            for at in 0..bytes.len() {
                for byte in [0, b' ', b'\n', b'9', 0x7f, 0xff] {
                    let mut changed = bytes.clone();
                    changed[at] = byte;
                    let _ = read("a.stl", &changed);
                }
            }
        }
    }
}
