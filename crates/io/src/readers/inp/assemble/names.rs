//! The names of sets in the mesh, and notes on numbers that no set can have.

use super::Assembly;
use crate::readers::inp::definition::Family;
use crate::readers::inp::directory::Names as Known;
use signorini_geometry::mesh::{CellId, Set};
use std::collections::HashSet;
use std::mem::take;

impl Assembly<'_> {
    pub(super) fn note_missing(&mut self) {
        for ((name, word), (count, first)) in take(&mut self.missing) {
            let what = match (word, count) {
                ("element set", 1) => "element",
                ("element set", _) => "elements",
                (_, 1) => "node",
                _ => "nodes",
            };
            let note = format!("{word} `{name}`: {count} {what} not in the mesh, such as {first}");
            self.notes.push(note);
        }
    }

    /// Gives every set its name in the mesh.
    ///
    /// Where several kinds have one name, the first of element set, surface, surface of nodes and node set has it alone;
    /// the others are `name.faces`, `name.points` and `name.nodes`, unless they mean the same nodes.
    ///
    /// Of a `whole` deck, sets of elements that are no cells are not empty.
    pub(super) fn name_sets(&mut self, whole: bool) {
        let prefixes: Vec<String> = std::iter::once(String::new())
            .chain(self.deck.instances.iter().map(|i| format!("{}.", i.name)))
            .collect();
        for (mut space, prefix) in take(&mut self.spaces).into_iter().zip(&prefixes) {
            let mut known = Known {
                shift: space.shift,
                special: take(&mut space.special_sets),
                ..Known::default()
            };
            for family in [Family::Cells, Family::Faces, Family::Points, Family::Nodes] {
                for (compared, named) in take(space.names(family)) {
                    let name = format!("{prefix}{}", named.name);
                    let has_special = known.special.get(&compared).is_some_and(|s| !s.is_empty());
                    if named.set.is_empty() && !(whole && has_special && family == Family::Cells) {
                        self.notes
                            .push(format!("{} `{name}` is empty", family.word()));
                    }
                    let name = self.name_set(family, name, named.set);
                    known.sets[family as usize].insert(compared, name);
                }
            }
            self.directory.spaces.push(known);
            let all: Vec<CellId> = space.cells.into_iter().flatten().collect();
            let instance = prefix.trim_end_matches('.');
            if !instance.is_empty() && !self.is_taken(instance) {
                let set = Set {
                    cells: all,
                    ..Set::default()
                };
                self.mesh.sets.insert(instance.to_owned(), set);
            }
        }
    }

    /// Whether a set has this name, in whatever letters.
    fn is_taken(&self, name: &str) -> bool {
        self.mesh.sets.contains_key(name)
    }

    /// Puts a set into the mesh, and answers what it is called there.
    fn name_set(&mut self, family: Family, name: String, mut set: Set) -> String {
        set.nodes.sort_unstable();
        set.nodes.dedup();
        set.cells.sort_unstable();
        set.cells.dedup();
        // in the order of their lines: whatever is made from them is numbered by it
        let mut seen = HashSet::new();
        set.faces.retain(|face| seen.insert(*face));
        let Some(taken) = self.mesh.sets.get(&name) else {
            self.mesh.sets.insert(name.clone(), set);
            return name;
        };
        if self.mesh.nodes_of(taken) == self.mesh.nodes_of(&set) && family == Family::Nodes {
            return name;
        }
        let suffix = match family {
            Family::Nodes => "nodes",
            Family::Cells => "elements",
            Family::Faces => "faces",
            Family::Points => "points",
        };
        let other = format!("{name}.{suffix}");
        self.notes.push(format!(
            "{} `{name}` is called `{other}`: another set has its name",
            family.word()
        ));
        self.mesh.sets.insert(other.clone(), set);
        other
    }
}
