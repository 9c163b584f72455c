//! The sets of an expanded mesh.

use super::error::ExpansionError;
use super::result::{Expansion, ShellSide};
use super::shell::Shells;
use crate::mesh::{Face, NodeId, Set};

/// Puts solids in place of shells in all sets, and makes sets of their sides.
///
/// # Errors
/// The name of a side is taken.
pub(super) fn replace(this: &mut Expansion, shells: &Shells<'_>) -> Result<(), ExpansionError> {
    let given = std::mem::take(&mut this.mesh.sets);
    let mut sides = Vec::new();
    // the last set that each node was put into
    let mut last = vec![0u32; this.mesh.nnode()];
    for (number, (name, set)) in given.iter().enumerate() {
        let members: Vec<usize> = set.cells.iter().filter_map(|&c| shells.of(c)).collect();
        let mut replaced = Set {
            nodes: set.nodes.clone(),
            cells: Vec::with_capacity(set.cells.len() + members.len()),
            faces: faces(this, shells, &set.faces),
        };
        for &cell in &set.cells {
            match shells.of(cell) {
                Some(shell) => replaced
                    .cells
                    .extend(this.solids.get(shell).into_iter().flatten()),
                None => replaced.cells.extend(this.kept.of(cell)),
            }
        }
        if !members.is_empty() {
            add_nodes(
                &mut replaced.nodes,
                &members,
                shells,
                &mut last,
                number as u32 + 1,
            );
            for (side, faces) in of_sides(this, &members) {
                let side = format!("{name}.{side}");
                if given.contains_key(&side) {
                    let (name, of) = (side, name.clone());
                    return Err(ExpansionError::NameTaken { name, of });
                }
                let faces = Set {
                    faces,
                    ..Set::default()
                };
                sides.push((side, faces));
            }
        }
        this.mesh.sets.insert(name.clone(), replaced);
    }
    this.mesh.sets.extend(sides);
    Ok(())
}

/// The faces of a set; sides of shells are 0, the negative one, 1, the positive one, and their edges from 2 on.
fn faces(this: &Expansion, shells: &Shells<'_>, given: &[Face]) -> Vec<Face> {
    let mut faces = Vec::with_capacity(given.len());
    for &Face { cell, side } in given {
        match shells.of(cell) {
            Some(shell) => faces.extend(this.faces(shell, ShellSide::numbered(side))),
            None => faces.extend(this.kept.of(cell).map(|cell| Face { cell, side })),
        }
    }
    faces
}

/// Adds the given nodes of shells, each once. `last` has `set` at nodes that are there.
fn add_nodes(
    nodes: &mut Vec<NodeId>,
    members: &[usize],
    shells: &Shells<'_>,
    last: &mut [u32],
    set: u32,
) {
    for &node in nodes.iter() {
        if let Some(last) = last.get_mut(node as usize) {
            *last = set;
        }
    }
    let of_shells = members.iter().filter_map(|&shell| shells.list.get(shell));
    for &node in of_shells.flat_map(|shell| shell.nodes) {
        if let Some(last) = last.get_mut(node as usize)
            && *last != set
        {
            *last = set;
            nodes.push(node);
        }
    }
}

/// The faces on the sides of these shells, by name.
fn of_sides(this: &Expansion, members: &[usize]) -> [(&'static str, Vec<Face>); 3] {
    let on = |side| {
        let shells = members.iter();
        shells.flat_map(|&shell| this.faces(shell, side)).collect()
    };
    let edges = members.iter().flat_map(|&shell| this.free_edges(shell));
    [
        ("positive", on(ShellSide::Positive)),
        ("negative", on(ShellSide::Negative)),
        ("edge", edges.copied().collect()),
    ]
}
