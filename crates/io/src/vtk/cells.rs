//! VTK's types of cells and the elements they are.
//!
//! Node orders are from the parametric coordinates of VTK's cells. Its hexahedron of 27 nodes has the centres of its
//! sides at -x, +x, -y, +y, -z, +z. Its wedge has the normal of the first triangle pointing in, by its shape functions
//! and its quality measures as by ours; the faces and the volume that VTK 9.2 and older give it are turned inside out.
//!
//! To add a cell type: one line in the table. Of two types for one element the first is written.

use signorini_geometry::element::{self, Element};

/// VTK's type of a single point.
pub const VERTEX: u8 = 1;

/// VTK's number, our name, and for each node of VTK its place in our element (none: the same).
#[rustfmt::skip]
const TABLE: [(u8, &str, &[usize]); 16] = [
    (3, "line2", &[]),
    (5, "tri3", &[]),
    (9, "quad4", &[]),
    (8, "quad4", &[0, 1, 3, 2]),
    (10, "tet4", &[]),
    (12, "hex8", &[]),
    (11, "hex8", &[0, 1, 3, 2, 4, 5, 7, 6]),
    (13, "wedge6", &[]),
    (21, "line3", &[]),
    (22, "tri6", &[]),
    (23, "quad8", &[]),
    (28, "quad9", &[]),
    (24, "tet10", &[]),
    (25, "hex20", &[]),
    (29, "hex27", &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 25, 23, 22, 24, 20, 21, 26]),
    (26, "wedge15", &[]),
];

/// A type of cells that is an element.
#[derive(Clone, Copy, Debug)]
pub struct CellType {
    /// VTK's number.
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

    /// All types by VTK's number.
    #[must_use]
    pub fn by_number() -> [Option<Self>; 256] {
        let mut types = [None; 256];
        for one in TABLE.into_iter().filter_map(Self::of) {
            if let Some(entry) = types.get_mut(one.number as usize) {
                *entry = Some(one);
            }
        }
        types
    }

    /// For each node of VTK, in its order, the place in our element.
    pub fn places(self) -> impl Iterator<Item = usize> {
        let place = move |k| self.order.get(k).copied().unwrap_or(k);
        (0..self.element.nnode()).map(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_element_has_a_type_and_every_order_holds_each_node_once() {
        for element in element::TABLE {
            assert!(
                CellType::of_element(element).is_some(),
                "{}",
                element.name()
            );
        }
        for one in CellType::by_number().into_iter().flatten() {
            let mut places: Vec<usize> = one.places().collect();
            places.sort_unstable();
            assert!(places.into_iter().eq(0..one.element.nnode()));
        }
    }

    #[test]
    fn middles_of_sides_are_those_of_vtk() {
        // the parametric coordinates of VTK's triquadratic hexahedron, on [-1, 1]
        let middles = [
            [-1.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, -1.0],
            [0.0, 0.0, 1.0],
            [0.0, 0.0, 0.0],
        ];
        let hex27 = element::by_name("hex27").unwrap();
        let places = CellType::of_element(hex27).unwrap().places().skip(20);
        for (middle, place) in middles.into_iter().zip(places) {
            assert_eq!(hex27.nodes()[place].to_array(), middle);
        }
    }
}
