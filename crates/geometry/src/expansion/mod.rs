//! Solids of eight nodes in place of shells.
//!
//! ```text
//!   positive face   +───────────────+───────────────+        x⁺
//!                   │               │               │         ↑ n        director: the pair x⁻, x⁺
//!   surface         ●───────────────●───────────────●         X          through the nodes of the mesh
//!                   │     solid     │               │
//!   negative face   +───────────────+───────────────+        x⁻
//! ```
//!
//! ```text
//! x⁻ = X − (o + ½) t n,   x⁺ = X + (½ − o) t n                                                       (E1)
//! n  = Σ nₑ / |Σ nₑ|                              over the cells e that join                          (E2)
//! m  = ½ (a + b) + ⅛ (tₐ − t_b),   tₐ = |c| Pₐc / |Pₐc|,   c = b − a                                   (E3)
//! 1/R = (n_b − nₐ)·c / c²                                                                             (E4)
//! ```
//!
//! | symbol | meaning |
//! |---|---|
//! | `X`, `t`, `o` | node, thickness, offset in thicknesses: at +½ the nodes lie on the positive face |
//! | `nₑ`, `n` | unit normal of the surface of cell `e` at a node, by the right-hand rule; of a director |
//! | `a`, `b`, `m` | ends and middle of an edge of a linear cell that is divided |
//! | `Pₐ` | projection onto what is perpendicular to the normals of the edge's cells at `a` |
//! | `R` | radius of curvature along an edge |
//!
//! **Normals.** At each node the cells with a prescribed normal come first, then all others. Of those left the cell of
//! lowest label is the reference; all cells whose normal is within the angle of that of the reference (not of the mean) and
//! that have the same thickness and offset have one director with it, until none is left. The angle is half a degree where
//! the normal of the reference is prescribed. A cell that faces the other way never joins. A node with several directors is
//! a *knot*: each of its directors has a middle of its own.
//!
//! **Division.** A quadrilateral of eight or nine nodes becomes four solids, a triangle three, any other quadrilateral one.
//! Their middles lie on the surface of the element. Triangles of three nodes get middles of edges by cubic interpolation
//! between the normals at both ends, (E3): on a sphere these lie closer to it by two orders of the edge's length than those
//! of flat facets. On a fold the edge is perpendicular to both normals. Then their surface is that of the element of six
//! nodes. The normals at ends are those of the surface, joined whatever the thickness, offset and orientation of cells. A
//! quadrilateral of four nodes with a neighbour that has a middle on the common edge is divided in two, or in four,
//! and so on through its neighbours: all divisions match.
//!
//! **Limits.** A solid must not turn inside out, which the corners of all solids are checked for.
//!
//! **Source.** Normals, offset and the order of nodes are those of CalculiX: G. Dhondt, *CalculiX CrunchiX User's Manual*,
//! version 2.20, on shell elements.

mod bend;
mod edges;
mod error;
mod input;
mod join;
mod pattern;
mod result;
mod sets;
mod sheet;
mod shell;
mod solids;
#[cfg(test)]
mod tests;

pub use error::ExpansionError;
pub use input::{Joining, Section, ShellCell};
pub use result::{Director, Expansion, Kept, Knot, Place, ShellSide};

use crate::element::Family;
use crate::mesh::{Block, CellId, Face, Mesh};
use edges::Middles;
use join::{Joined, Joins};
use sheet::Sheet;
use shell::Shells;

/// Replaces shells by solids.
///
/// Nodes of the mesh keep their numbers and positions, blocks their numbers, and cells that are no shells theirs, but for
/// cells in a block with shells: see [`Expansion::kept`]. New nodes get labels after the largest, solids that of their
/// shell. A set with shells has their solids and their given nodes instead; for a set `"a"` of this kind there are sets
/// `"a.positive"`, `"a.negative"` and `"a.edge"` of faces, the last one on edges that one shell has alone.
///
/// # Errors
/// A cell that is no shell, has no area, or is folded; a thickness that is not positive; a shell that is bent so tightly
/// that it turns inside out; a set that has the name of a side.
///
/// # Example
/// ```
/// use signorini_geometry::element::by_name;
/// use signorini_geometry::expansion::{Joining, Section, ShellCell, expand};
/// use signorini_geometry::mesh::Mesh;
/// use signorini_geometry::tensor::Vec3;
/// use std::collections::BTreeMap;
///
/// let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let mut mesh = Mesh {
///     points: square.map(Vec3::from).to_vec(),
///     node_labels: vec![1, 2, 3, 4],
///     ..Mesh::default()
/// };
/// let cell = mesh.push_cell(by_name("quad4").ok_or("not in the table")?, &[0, 1, 2, 3], 1);
/// let section = Section { thickness: 0.1, at_nodes: None, offset: 0.5 };
/// let joining = Joining { angle: Joining::ANGLE, given: &BTreeMap::new() };
/// let expansion = expand(&mesh, &[ShellCell { cell, section: 0 }], &[section], &joining)?;
/// assert_eq!(expansion.directors.len(), 4);
/// // the nodes lie on the positive face
/// let director = expansion.directors[0];
/// assert_eq!(expansion.mesh.points[director.positive as usize], Vec3::ZERO);
/// assert_eq!(expansion.mesh.points[director.negative as usize], Vec3::new(0.0, 0.0, -0.1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn expand(
    mesh: &Mesh,
    cells: &[ShellCell],
    sections: &[Section<'_>],
    joining: &Joining<'_>,
) -> Result<Expansion, ExpansionError> {
    let shells = Shells::new(mesh, cells, sections)?;
    let middles = Middles::new(mesh.nnode(), &shells.list);
    let mut sheet = Sheet::new(mesh, &shells.list, &middles)?;
    sheet.find_normals(cells.iter().map(|shell| shell.cell), joining)?;
    if !middles.ends.is_empty() {
        let joined = Joined::new(&sheet, joining, Joins::Surface);
        let (first, angle) = (mesh.nnode(), joining.angle);
        bend::bend(&mut sheet, first, &middles.ends, &joined, angle);
    }
    sheet.complete()?;
    let joined = Joined::new(&sheet, joining, Joins::Directors);
    let mut expansion = build(mesh, &shells, &sheet, &joined)?;
    let edges = middles.ends.into_iter().map(Place::Edge);
    let cells = sheet.centres.iter().copied().map(Place::Cell);
    expansion.places = edges.chain(cells).collect();
    (expansion.free, expansion.free_from) = free_edges(&expansion, &sheet);
    sets::replace(&mut expansion, &shells)?;
    Ok(expansion)
}

/// The mesh with solids, whose sets are those of the given one.
fn build(
    mesh: &Mesh,
    shells: &Shells<'_>,
    sheet: &Sheet<'_>,
    joined: &Joined,
) -> Result<Expansion, ExpansionError> {
    let (mut mesh, kept) = without(mesh, shells);
    let (directors, knots) = solids::directors(&mut mesh, sheet, joined);
    let npart = sheet.pieces.iter().map(|piece| piece.pattern.quads.len());
    let mut corners = Vec::with_capacity(npart.sum());
    let mut all = Vec::with_capacity(sheet.pieces.len());
    let solid = Family::Hexahedron.linear();
    for piece in &sheet.pieces {
        let mut parts = Vec::with_capacity(piece.pattern.quads.len());
        for &quad in piece.pattern.quads {
            // every station has a normal by now, so it has a group; groups are directors
            let at = quad.map(|k| joined.of[piece.first + k]);
            let pairs = at.map(|d| &directors[d as usize]);
            solids::check(&mesh, sheet, piece, quad, pairs)?;
            let [a, b, c, d] = pairs.map(|pair| pair.negative);
            let [e, f, g, h] = pairs.map(|pair| pair.positive);
            parts.push(mesh.push_cell(solid, &[a, b, c, d, e, f, g, h], piece.shell.label));
            corners.push(at);
        }
        all.push(parts);
    }
    Ok(Expansion {
        mesh,
        directors,
        solids: all,
        corners,
        knots,
        places: Vec::new(),
        kept,
        patterns: sheet.pieces.iter().map(|piece| piece.pattern).collect(),
        free: Vec::new(),
        free_from: Vec::new(),
    })
}

/// The mesh without its shells, and where its other cells went.
fn without(mesh: &Mesh, shells: &Shells<'_>) -> (Mesh, Kept) {
    let mut kept = Kept::default();
    let mut rest = Mesh {
        blocks: Vec::with_capacity(mesh.blocks.len() + 1),
        points: mesh.points.clone(),
        node_labels: mesh.node_labels.clone(),
        sets: mesh.sets.clone(),
    };
    for (number, block) in mesh.blocks.iter().enumerate() {
        if shells.numbers.get(number).is_none_or(Vec::is_empty) {
            rest.blocks.push(block.clone());
            kept.places.push(None);
            continue;
        }
        let mut others = Block::new(block.element);
        let mut places = vec![Kept::NONE; block.ncell()];
        for (index, place) in places.iter_mut().enumerate() {
            let cell = CellId {
                block: number as u32,
                index: index as u32,
            };
            if shells.of(cell).is_none() {
                *place = others.ncell() as u32;
                others.nodes.extend_from_slice(block.cell(index));
                others.labels.extend(block.labels.get(index));
            }
        }
        rest.blocks.push(others);
        kept.places.push(Some(places));
    }
    (rest, kept)
}

/// The sides of edges that one shell has alone, and where those of each shell start.
fn free_edges(expansion: &Expansion, sheet: &Sheet<'_>) -> (Vec<Face>, Vec<usize>) {
    let (mut faces, mut pairs, mut ends) = (Vec::new(), Vec::new(), Vec::new());
    for (number, piece) in sheet.pieces.iter().enumerate() {
        for (k, parts) in piece.pattern.edges.iter().enumerate() {
            faces.extend(expansion.faces(number, ShellSide::Edge(k)));
            pairs.extend(parts.iter().map(|&(quad, side)| {
                let quad = piece.pattern.quads[quad];
                // sides 0 and 1 are the faces
                let from = side as usize - 2;
                [from, (from + 1) % 4].map(|i| sheet.stations[piece.first + quad[i]].node)
            }));
        }
        ends.push(pairs.len());
    }
    let (edges, nedge) = edges::number(sheet.points.len(), &pairs);
    let mut count = vec![0u32; nedge];
    edges.iter().for_each(|&edge| count[edge as usize] += 1);
    let (mut free, mut from, mut start) = (Vec::new(), vec![0], 0);
    for end in ends {
        let is_free = |k: &usize| count[edges[*k] as usize] == 1;
        free.extend((start..end).filter(is_free).map(|k| faces[k]));
        from.push(free.len());
        start = end;
    }
    (free, from)
}
