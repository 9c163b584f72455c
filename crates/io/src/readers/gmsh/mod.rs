//! Gmsh meshes (`.msh`), versions 4.1 and 2.2, as text and as binary data of either byte order.
//!
//! ```text
//! $MeshFormat     version, 0 text | 1 binary, width of sizes
//! $PhysicalNames  dimension tag "name"
//! $Entities       which entity is in which physical groups (4.1)
//! $Nodes          numbers and positions
//! $Elements       numbers, types, nodes, and the entity or group they are in
//! ```
//!
//! Physical groups become sets: of nodes in dimension 0, else of cells. Groups without a name are called by dimension
//! and tag (`volume_7`). Names are kept letter by letter; groups of one name become one set. Nodes without elements are
//! kept. Other sections (`$Periodic`, `$NodeData`, …) are stepped over and noted.
//!
//! Text and binary data hold the same numbers in the same order, so each version is read by one set of functions over
//! a cursor that knows how numbers are stored. Source: Gmsh reference manual, chapter "Gmsh file formats".
//!
//! To add an element: one line in the table of `kind.rs`.

mod builder;
mod cursor;
mod kind;
mod v2;
mod v4;

use super::MeshError;
use super::error::excerpt;
use builder::Builder;
use cursor::{Binary, Cursor};
use signorini_geometry::mesh::Mesh;
use std::collections::BTreeSet;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Version {
    V2,
    V4,
}

/// Reads a mesh, with notes. `name` appears in messages.
///
/// # Errors
/// Any fault in the file, with its line (text) or byte (binary).
///
/// # Limits
/// First-order elements; unsupported ones of lower dimension than the solids are left out with a note. Sizes of four
/// bytes are read in 4.1 as well. Memory stays below a fixed multiple of the size of the file.
pub fn read(name: &str, bytes: &[u8]) -> Result<(Mesh, Vec<String>), MeshError> {
    let mut cursor = Cursor::new(name, bytes);
    let version = header(&mut cursor)?;
    let mut builder = Builder::new();
    let mut skipped = BTreeSet::new();
    let mut elements = false;
    while let Some(section) = cursor.open_section()? {
        match (section, version) {
            ("PhysicalNames", _) => names(&mut cursor, &mut builder)?,
            ("Entities", Version::V4) => v4::entities(&mut cursor, &mut builder, false)?,
            ("PartitionedEntities", Version::V4) => v4::entities(&mut cursor, &mut builder, true)?,
            ("Nodes", _) | ("ParametricNodes", Version::V2) => {
                if builder.has_nodes() {
                    return Err(twice(&cursor, section));
                }
                match version {
                    Version::V2 => v2::nodes(&mut cursor, &mut builder, section != "Nodes")?,
                    Version::V4 => v4::nodes(&mut cursor, &mut builder)?,
                }
            }
            ("Elements", _) => {
                if elements {
                    return Err(twice(&cursor, section));
                }
                if !builder.has_nodes() {
                    return Err(MeshError::SectionOrder {
                        place: cursor.place(),
                        section: "Elements",
                        needed: "Nodes",
                    });
                }
                elements = true;
                match version {
                    Version::V2 => v2::elements(&mut cursor, &mut builder)?,
                    Version::V4 => v4::elements(&mut cursor, &mut builder)?,
                }
            }
            _ => {
                if section != "Comments" && skipped.len() < 20 {
                    skipped.insert(section);
                }
                cursor.skip_section()?;
                continue;
            }
        }
        cursor.close_section()?;
    }
    if !builder.has_nodes() {
        return Err(MeshError::NoSection {
            place: cursor.file(),
            section: "Nodes",
        });
    }
    if !skipped.is_empty() {
        let list: Vec<String> = skipped.iter().map(|s| format!("${s}")).collect();
        builder.notes.push(format!("ignored: {}", list.join(", ")));
    }
    builder.finish(&cursor)
}

fn twice(cursor: &Cursor<'_>, section: &str) -> MeshError {
    MeshError::SectionTwice {
        place: cursor.place(),
        section: section.into(),
    }
}

/// Reads `$MeshFormat`: which version, and how numbers are stored.
fn header(cursor: &mut Cursor<'_>) -> Result<Version, MeshError> {
    let place = cursor.file();
    if cursor.accept(b"\xff\xfe") || cursor.accept(b"\xfe\xff") {
        return Err(MeshError::Utf16 { place });
    }
    cursor.accept(b"\xef\xbb\xbf");
    cursor.skip_space();
    let start = cursor.rest();
    if start.is_empty() {
        return Err(MeshError::Empty { place });
    }
    if start.starts_with(b"$NOD") {
        return Err(MeshError::Version {
            place,
            found: "1".into(),
        });
    }
    // comments may come first
    loop {
        if !cursor.rest().starts_with(b"$MeshFormat") && !cursor.rest().starts_with(b"$Comments") {
            return Err(MeshError::NotAMesh {
                place,
                found: excerpt(start.split(|&b| b == b'\n').next().unwrap_or(start)),
            });
        }
        match cursor.open_section()? {
            Some("MeshFormat") => break,
            Some(_) => cursor.skip_section()?,
            None => {}
        }
        cursor.skip_space();
    }
    let version = match cursor.text("the version")? {
        b"2" | b"2.1" | b"2.2" => Version::V2,
        b"4.1" => Version::V4,
        other => {
            return Err(MeshError::Version {
                place: cursor.place(),
                found: excerpt(other),
            });
        }
    };
    let binary = cursor.text("the file type")?;
    let is_binary = match binary {
        b"0" => false,
        b"1" => true,
        _ => return Err(format(cursor, "the file type", binary, "0 or 1")),
    };
    let width = cursor.text("the width of sizes")?;
    let wide = match (width, version) {
        (b"8", _) => true,
        (b"4", Version::V4) => false,
        _ => return Err(format(cursor, "the width of sizes", width, "8")),
    };
    if is_binary {
        cursor.line();
        cursor.binary = Some(Binary {
            big_endian: false,
            wide,
        });
        let one = cursor.int("the number 1")?;
        let big_endian = match one {
            1 => false,
            0x0100_0000 => true,
            _ => {
                let wanted = "1, in one byte order or the other";
                return Err(format(
                    cursor,
                    "the byte order mark",
                    one.to_string().as_bytes(),
                    wanted,
                ));
            }
        };
        cursor.binary = Some(Binary { big_endian, wide });
    }
    cursor.close_section()?;
    Ok(version)
}

fn format(
    cursor: &Cursor<'_>,
    what: &'static str,
    found: &[u8],
    wanted: &'static str,
) -> MeshError {
    MeshError::Format {
        place: cursor.place(),
        what,
        found: excerpt(found),
        wanted,
    }
}

/// Reads `$PhysicalNames`, which is text in binary files too.
fn names(cursor: &mut Cursor<'_>, builder: &mut Builder) -> Result<(), MeshError> {
    let wanted = "the number of physical names";
    let announced = cursor.text_int(wanted)?;
    let announced = u64::try_from(announced)
        .map_err(|_| cursor.out_of_range(wanted, announced, "0 to 2^63 - 1"))?;
    let announced = cursor.check_count(wanted, announced, 6)?;
    for _ in 0..announced {
        let wanted = "the dimension of a physical group";
        let dim = cursor.text_int(wanted)?;
        let Ok(dim @ 0..=3) = u8::try_from(dim) else {
            return Err(cursor.out_of_range(wanted, dim, "0 to 3"));
        };
        let tag = cursor.text_int("the tag of a physical group")?;
        let line = cursor.line();
        let first = line.iter().position(|&b| b == b'"');
        let last = line.iter().rposition(|&b| b == b'"');
        let name = first
            .zip(last)
            .and_then(|(first, last)| line.get(first + 1..last));
        let Some(name) = name else {
            return Err(MeshError::NoName {
                place: cursor.place(),
                dim,
                tag,
                found: excerpt(line.trim_ascii()),
            });
        };
        let name = match std::str::from_utf8(name) {
            Ok(name) => name.to_owned(),
            Err(_) => {
                let latin: String = name.iter().map(|&b| char::from(b)).collect();
                builder.notes.push(format!(
                    "the name `{latin}` is not UTF-8; it was read as Latin-1"
                ));
                latin
            }
        };
        builder.name(dim, tag.saturating_abs(), name);
    }
    Ok(())
}

#[cfg(test)]
mod tests;
