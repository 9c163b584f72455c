//! What names and numbers of a deck are called in its mesh.

use super::card::key;
use super::definition::Family;
use crate::diagnostic::Place;
use signorini_geometry::mesh::CellId;
use std::collections::{BTreeMap, HashSet};

/// What a name in a deck is a name of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A set of nodes.
    Nodes,
    /// A set of elements.
    Elements,
    /// A surface: of faces, else of nodes.
    Surface,
    /// A surface of nodes: their names are their own.
    SurfaceOfNodes,
}

impl Kind {
    /// The families of sets that it may be, best first.
    const fn families(self) -> &'static [Family] {
        match self {
            Self::Nodes => &[Family::Nodes],
            Self::Elements => &[Family::Cells],
            Self::Surface => &[Family::Faces, Family::Points],
            Self::SurfaceOfNodes => &[Family::Points],
        }
    }
}

/// Nodes, elements and sets whose numbers and names stand for themselves: the deck, or an instance.
#[derive(Clone, Debug, Default)]
pub(super) struct Names {
    /// What numbers of nodes and of elements are more than in the deck.
    pub shift: [u64; 2],
    /// Names of sets in the mesh, by what they are compared by.
    pub sets: [BTreeMap<String, String>; 4],
    /// Numbers of elements that are no cells, by the element sets that hold them.
    pub special: BTreeMap<String, Vec<u64>>,
}

/// An element that is no cell of a mesh: a spring, a gap, a mass.
#[derive(Clone, Debug)]
pub struct Special {
    /// Its type, in capitals.
    pub kind: String,
    /// Its number in the mesh.
    pub label: u64,
    /// The numbers of its nodes in the mesh.
    pub nodes: Vec<u64>,
    /// The number of its *ELEMENT card.
    pub(super) card: Option<u32>,
}

impl Special {
    /// Whether both are of one *ELEMENT card.
    #[must_use]
    pub fn is_with(&self, other: &Self) -> bool {
        (self.card, &self.kind) == (other.card, &other.kind)
    }
}

/// An *ELEMENT card.
#[derive(Clone, Debug)]
pub struct ElementCard {
    /// Where it stands.
    pub place: Place,
    /// The element set that it names.
    pub elset: Option<String>,
}

/// What names and numbers of a deck are called in its mesh.
///
/// A *space* is the deck itself, number 0, or one of its instances; a statement in a part speaks of all its instances.
#[derive(Clone, Debug, Default)]
pub struct Directory {
    pub(super) spaces: Vec<Names>,
    pub(super) instances: BTreeMap<String, usize>,
    /// The spaces of each scope of the deck.
    pub(super) scopes: Vec<Vec<usize>>,
    /// The spaces of instances that are turned.
    pub(super) turned: Vec<usize>,
    /// The type of each cell, in capitals, by block and cell.
    pub(super) types: Vec<Vec<u32>>,
    pub(super) type_names: Vec<String>,
    /// The *ELEMENT card of each cell, by block and cell.
    pub(super) cards: Vec<Vec<u32>>,
    pub(super) element_cards: Vec<ElementCard>,
    /// Elements that are no cells.
    pub(super) special: Vec<Special>,
    /// The cells that are shells, in order.
    pub(super) shells: Vec<CellId>,
}

/// The space of the instance and the rest of a name such as `part-1.top`.
pub(super) fn of_instance<'n>(
    instances: &BTreeMap<String, usize>,
    name: &'n str,
) -> Option<(usize, &'n str)> {
    name.match_indices('.').find_map(|(dot, _)| {
        let (instance, rest) = name.split_at_checked(dot)?;
        let space = instances.get(&key(instance))?;
        Some((*space, rest.strip_prefix('.')?))
    })
}

impl Directory {
    /// The spaces that a scope of the deck stands for.
    #[must_use]
    pub fn spaces(&self, scope: usize) -> &[usize] {
        self.scopes.get(scope).map_or(&[], Vec::as_slice)
    }

    /// Whether a scope of the deck stands for instances that are turned.
    #[must_use]
    pub fn is_turned(&self, scope: usize) -> bool {
        let mut spaces = self.spaces(scope).iter();
        spaces.any(|space| self.turned.contains(space))
    }

    /// The space and the rest of a name such as `part-1.top`, as the assembly writes it.
    fn qualified<'n>(&self, space: usize, name: &'n str) -> Option<(usize, &'n str)> {
        of_instance(&self.instances, name).filter(|_| space == 0)
    }

    /// The name in the mesh of a set that a space calls `name`.
    #[must_use]
    pub fn set(&self, space: usize, kind: Kind, name: &str) -> Option<&str> {
        let name = name.trim_matches('"');
        let of = |space: usize, name: &str| {
            let (sets, name) = (&self.spaces.get(space)?.sets, key(name));
            let mut families = kind.families().iter();
            families.find_map(|family| sets.get(*family as usize)?.get(&name).map(String::as_str))
        };
        of(space, name).or_else(|| {
            let (within, rest) = self.qualified(space, name)?;
            of(within, rest)
        })
    }

    /// The names in the mesh of all sets of a kind that a space knows, for messages.
    #[must_use]
    pub fn known(&self, space: usize, kind: Kind) -> Vec<&str> {
        let sets = self.spaces.get(space).map(|space| &space.sets);
        let of = |family: &Family| sets.and_then(|sets| sets.get(*family as usize));
        let named = kind.families().iter().filter_map(of);
        named
            .flat_map(|sets| sets.values().map(String::as_str))
            .collect()
    }

    /// The number in the mesh of a node or an element that a space calls so: `12`, or `part-1.12`.
    #[must_use]
    pub fn label(&self, space: usize, kind: Kind, name: &str) -> Option<u64> {
        let of = |space: usize, number: &str| {
            let shift = self.spaces.get(space)?.shift;
            let shift = shift[usize::from(kind != Kind::Nodes)];
            super::card::whole(number.as_bytes())?.checked_add(shift)
        };
        of(space, name).or_else(|| {
            let (within, rest) = self.qualified(space, name)?;
            of(within, rest)
        })
    }

    /// The number of the *ELEMENT card of a cell, and the card.
    #[must_use]
    pub fn card_of(&self, cell: CellId) -> Option<(u32, &ElementCard)> {
        let cards = self.cards.get(cell.block as usize)?;
        let number = *cards.get(cell.index as usize)?;
        Some((number, self.element_cards.get(number as usize)?))
    }

    /// The types of elements, in capitals, and the type of each cell, by block and cell.
    #[must_use]
    pub fn types(&self) -> (&[String], &[Vec<u32>]) {
        (&self.type_names, &self.types)
    }

    /// The cells that are shells, in order: those of a *SHELL SECTION. Faces of them in sets have the numbers of their sides less
    /// one: 0 for the negative side, 1 for the positive one, edges from 2 on.
    #[must_use]
    pub fn shells(&self) -> &[CellId] {
        &self.shells
    }

    /// Whether a cell is a shell.
    #[must_use]
    pub fn is_shell(&self, cell: CellId) -> bool {
        self.shells.binary_search(&cell).is_ok()
    }

    /// The elements that are no cells.
    #[must_use]
    pub fn specials(&self) -> &[Special] {
        &self.special
    }

    /// The *ELEMENT card of an element that is no cell.
    #[must_use]
    pub fn card_of_special(&self, one: &Special) -> Option<&ElementCard> {
        self.element_cards.get(one.card? as usize)
    }

    /// The elements that are no cells, of an element set.
    pub fn special(&self, space: usize, name: &str) -> impl Iterator<Item = &Special> {
        let name = name.trim_matches('"');
        let of = |space: usize, name: &str| self.spaces.get(space)?.special.get(&key(name));
        let labels = of(space, name).or_else(|| {
            let (within, rest) = self.qualified(space, name)?;
            of(within, rest)
        });
        let labels: HashSet<u64> = labels.into_iter().flatten().copied().collect();
        self.special
            .iter()
            .filter(move |one| labels.contains(&one.label))
    }
}
