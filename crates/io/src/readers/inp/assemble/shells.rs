//! Which elements are shells, and their sides.
//!
//! An element of a shell's type is a shell where a *SHELL SECTION names it. Its sides are S1, the negative one, S2, the positive
//! one, and its edges from S3 on, in the order of the sides of the plane element. Without a section it is a face of solids.

use super::{Assembly, Result, in_words};
use crate::readers::MeshError;
use crate::readers::inp::definition::{Definition, Family, Side};
use crate::readers::inp::kind::Role;
use crate::readers::inp::part::{Part, SHELL_SECTION};
use crate::readers::inp::statement::Statement;
use signorini_geometry::mesh::{CellId, Face};

/// The face on the negative side of a shell, from 0.
const NEGATIVE: u8 = 0;
/// The face on its positive side.
const POSITIVE: u8 = 1;

impl Assembly<'_> {
    /// Finds the shells, once element sets are known.
    pub(super) fn find_shells(&mut self, statements: &[Statement], part: Part) {
        let mut cells: Vec<CellId> = match part {
            Part::MeshOfShells if statements.is_empty() && self.mesh.dim() == 2 => {
                self.mesh.cells(2).collect()
            }
            _ => Vec::new(),
        };
        for card in statements
            .iter()
            .filter(|card| card.keyword == SHELL_SECTION)
        {
            let Some(name) = card.peek("ELSET") else {
                continue;
            };
            let spaces = self.directory.spaces(card.scope).iter();
            let sets =
                spaces.filter_map(|&space| self.find(space, Family::Cells, name.trim_matches('"')));
            cells.extend(sets.flat_map(|set| &set.cells));
        }
        cells.sort_unstable();
        cells.dedup();
        cells.retain(|cell| self.role(*cell) == Some(Role::Shell));
        // a type all of whose elements are shells is more than a mesh
        for (number, (kind, count)) in (0..).zip(self.deck.kinds.iter().zip(&self.counts)) {
            let of_kind = cells
                .iter()
                .filter(|cell| self.kind_of(**cell) == Some(number));
            if kind.role == Role::Shell && *count > 0 && of_kind.count() as u64 == *count {
                let words = in_words(*count, &kind.name);
                let is_of_kind = |note: &String| {
                    let rest = note.strip_prefix(&words);
                    rest.is_some_and(|rest| rest.starts_with(" (shell): "))
                };
                self.notes.retain(|note| !is_of_kind(note));
            }
        }
        self.directory.shells = cells;
    }

    /// The number of the kind of a cell.
    fn kind_of(&self, cell: CellId) -> Option<u32> {
        let types = self.directory.types.get(cell.block as usize)?;
        types.get(cell.index as usize).copied()
    }

    fn role(&self, cell: CellId) -> Option<Role> {
        let kind = self.deck.kinds.get(self.kind_of(cell)? as usize)?;
        Some(kind.role)
    }

    /// The dimension of what has sides: shells become solids.
    pub(super) fn dim(&self) -> usize {
        match self.directory.shells.is_empty() {
            true => self.mesh.dim(),
            false => 3,
        }
    }

    /// The faces of a shell that a surface names: both where it names no side.
    pub(super) fn side_of_shell(
        &self,
        cell: CellId,
        side: Side,
        definition: &Definition,
    ) -> Result<impl Iterator<Item = Face> + use<>> {
        let edges = self
            .mesh
            .element(cell)
            .map_or(0, |element| element.sides().len());
        let sides = match side {
            Side::Free => NEGATIVE..=POSITIVE,
            Side::Negative => NEGATIVE..=NEGATIVE,
            Side::Positive => POSITIVE..=POSITIVE,
            Side::Number(n) if usize::from(n) <= edges + 2 => n - 1..=n - 1,
            Side::Edge(n) if usize::from(n) <= edges => n + POSITIVE..=n + POSITIVE,
            Side::Number(_) | Side::Edge(_) => {
                let last = edges + 2;
                let hint =
                    format!("; its sides are SNEG or S1, SPOS or S2, and its edges S3 to S{last}");
                return Err(self.no_such_side(cell, side, definition, hint));
            }
        };
        Ok(sides.map(move |side| Face { cell, side }))
    }

    /// The fault of a side that an element does not have.
    pub(super) fn no_such_side(
        &self,
        cell: CellId,
        side: Side,
        definition: &Definition,
        hint: String,
    ) -> MeshError {
        MeshError::NoSuchSide {
            place: self.files.place(definition.spot),
            surface: definition.name.as_str().into(),
            element: self.mesh.cell_label(cell).unwrap_or(0),
            kind: self.mesh.element(cell).map_or("", |element| element.name()),
            side: match side {
                Side::Number(n) => format!("S{n}").into(),
                Side::Edge(n) => format!("E{n}").into(),
                _ => "SPOS or SNEG".into(),
            },
            hint: hint.into(),
        }
    }
}
