//! Elements as `.frd` files number them.
//!
//! ```text
//! hexahedron, 20 nodes    ours   corners, bottom edges, top edges, upright edges
//!                         .frd   corners, bottom edges, upright edges, top edges
//! wedge, 15 nodes         likewise
//! all others              as ours
//! ```
//!
//! There is no type with nodes inside of an element or a side: a hexahedron of 27 nodes is written as one of 20, a
//! quadrilateral of 9 as one of 8. Elements that are not in the table have no type: files of them are refused.
//!
//! Source: files that CalculiX 2.20 writes for one element of each type.

use signorini_geometry::element::{self, Element};

/// The number in the file, our name, and for each node in the file its place in our element (none: the same).
///
/// Of two lines for one number the first is the one for reading.
#[rustfmt::skip]
const TABLE: [(u8, &str, &[usize]); 14] = [
    (1, "hex8", &[]),
    (2, "wedge6", &[]),
    (3, "tet4", &[]),
    (4, "hex20", &UPRIGHT_FIRST_HEX),
    (4, "hex27", &UPRIGHT_FIRST_HEX),
    (5, "wedge15", &[0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11]),
    (6, "tet10", &[]),
    (7, "tri3", &[]),
    (8, "tri6", &[]),
    (9, "quad4", &[]),
    (10, "quad8", &[]),
    (10, "quad9", &[0, 1, 2, 3, 4, 5, 6, 7]),
    (11, "line2", &[]),
    (12, "line3", &[]),
];

const UPRIGHT_FIRST_HEX: [usize; 20] = [
    0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15,
];

/// A type of elements.
#[derive(Clone, Copy, Debug)]
pub struct CellType {
    /// The number in the file.
    pub number: u8,
    /// The element.
    pub element: Element,
    order: &'static [usize],
}

impl CellType {
    fn of((number, name, order): (u8, &str, &'static [usize])) -> Option<Self> {
        let element = element::by_name(name)?;
        Some(Self {
            number,
            element,
            order,
        })
    }

    /// The type that an element is written as.
    #[must_use]
    pub fn of_element(element: Element) -> Option<Self> {
        let row = TABLE.iter().find(|(_, name, _)| *name == element.name());
        row.copied().and_then(Self::of)
    }

    /// The type that a number stands for.
    #[must_use]
    pub fn of_number(number: u64) -> Option<Self> {
        let row = TABLE.iter().find(|(known, ..)| u64::from(*known) == number);
        row.copied().and_then(Self::of)
    }

    /// Nodes of an element in the file.
    #[must_use]
    pub fn nnode(self) -> usize {
        match self.order.len() {
            0 => self.element.nnode(),
            n => n,
        }
    }

    /// For each node in the file, in its order, the place in our element.
    pub fn places(self) -> impl Iterator<Item = usize> {
        let place = move |k| self.order.get(k).copied().unwrap_or(k);
        (0..self.nnode()).map(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_names_an_element_and_every_type_is_read_as_one_that_has_all_its_nodes() {
        for (_, name, _) in TABLE {
            let element = element::by_name(name).unwrap();
            let one = CellType::of_element(element).unwrap();
            let mut places: Vec<usize> = one.places().collect();
            places.sort_unstable();
            assert!(places.into_iter().eq(0..one.nnode()), "{}", element.name());
            let read = CellType::of_number(u64::from(one.number)).unwrap();
            assert_eq!(read.element.nnode(), one.nnode(), "{}", element.name());
        }
        assert!(CellType::of_number(0).is_none() && CellType::of_number(13).is_none());
    }
}
