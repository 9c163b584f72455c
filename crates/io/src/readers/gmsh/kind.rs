//! The element types of Gmsh and what they are here.

use signorini_geometry::element::{self, Element};

/// A family of element types.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    Point,
    Line,
    Triangle,
    Quadrilateral,
    Tetrahedron,
    Hexahedron,
    Wedge,
    Pyramid,
}

impl Shape {
    const fn dim(self) -> u8 {
        match self {
            Self::Point => 0,
            Self::Line => 1,
            Self::Triangle | Self::Quadrilateral => 2,
            Self::Tetrahedron | Self::Hexahedron | Self::Wedge | Self::Pyramid => 3,
        }
    }

    const fn word(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Line => "line",
            Self::Triangle => "triangle",
            Self::Quadrilateral => "quadrilateral",
            Self::Tetrahedron => "tetrahedron",
            Self::Hexahedron => "hexahedron",
            Self::Wedge => "wedge, or prism,",
            Self::Pyramid => "pyramid",
        }
    }
}

/// The types of a family: number in the file, polynomial order, number of nodes.
type Family = &'static [(u32, u8, usize)];

/// Every type.
#[rustfmt::skip]
const TYPES: [(Shape, Family); 8] = [
    (Shape::Point, &[(15, 0, 1)]),
    (Shape::Line, &[(1, 1, 2), (8, 2, 3), (26, 3, 4), (27, 4, 5), (28, 5, 6), (62, 6, 7), (63, 7, 8), (64, 8, 9),
        (65, 9, 10), (66, 10, 11)]),
    (Shape::Triangle, &[(2, 1, 3), (9, 2, 6), (20, 3, 9), (21, 3, 10), (22, 4, 12), (23, 4, 15), (24, 5, 15),
        (25, 5, 21), (42, 6, 28), (43, 7, 36), (44, 8, 45), (45, 9, 55), (46, 10, 66), (52, 6, 18), (53, 7, 21),
        (54, 8, 24), (55, 9, 27), (56, 10, 30)]),
    (Shape::Quadrilateral, &[(3, 1, 4), (10, 2, 9), (16, 2, 8), (36, 3, 16), (37, 4, 25), (38, 5, 36), (39, 3, 12),
        (40, 4, 16), (41, 5, 20), (47, 6, 49), (48, 7, 64), (49, 8, 81), (50, 9, 100), (51, 10, 121), (57, 6, 24),
        (58, 7, 28), (59, 8, 32), (60, 9, 36), (61, 10, 40)]),
    (Shape::Tetrahedron, &[(4, 1, 4), (11, 2, 10), (29, 3, 20), (30, 4, 35), (31, 5, 56), (32, 4, 22), (33, 5, 28),
        (71, 6, 84), (72, 7, 120), (73, 8, 165), (74, 9, 220), (75, 10, 286), (79, 6, 34), (80, 7, 40), (81, 8, 46),
        (82, 9, 52), (83, 10, 58), (137, 3, 16)]),
    (Shape::Hexahedron, &[(5, 1, 8), (12, 2, 27), (17, 2, 20), (92, 3, 64), (93, 4, 125), (94, 5, 216), (95, 6, 343),
        (96, 7, 512), (97, 8, 729), (98, 9, 1000), (99, 3, 32), (100, 4, 44), (101, 5, 56), (102, 6, 68),
        (103, 7, 80), (104, 8, 92), (105, 9, 104)]),
    (Shape::Wedge, &[(6, 1, 6), (13, 2, 18), (18, 2, 15)]),
    (Shape::Pyramid, &[(7, 1, 5), (14, 2, 14), (19, 2, 13), (118, 3, 30), (119, 4, 55), (120, 5, 91), (121, 6, 140),
        (122, 7, 204), (123, 8, 285), (124, 9, 385), (125, 3, 21), (126, 4, 29), (127, 5, 37), (128, 6, 45),
        (129, 7, 53), (130, 8, 61), (131, 9, 69)]),
];

/// Types that have an element here: number, name, and for each of our nodes its place in the file (none: the same).
const ELEMENTS: [(u32, &str, &[usize]); 14] = [
    (1, "line2", &[]),
    (2, "tri3", &[]),
    (3, "quad4", &[]),
    (4, "tet4", &[]),
    (5, "hex8", &[]),
    (6, "wedge6", &[]),
    (8, "line3", &[]),
    (9, "tri6", &[]),
    (16, "quad8", &[]),
    (10, "quad9", &[]),
    (11, "tet10", &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8]),
    (
        17,
        "hex20",
        &[
            0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15,
        ],
    ),
    (
        12,
        "hex27",
        &[
            0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 20, 25, 21, 23,
            24, 22, 26,
        ],
    ),
    (
        18,
        "wedge15",
        &[0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11],
    ),
];

/// What a type number of Gmsh means.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kind {
    /// The number in the file.
    pub number: u32,
    /// Dimension, 0 for points.
    pub dim: u8,
    /// Polynomial order.
    pub order: u8,
    /// Nodes per cell.
    pub nnode: usize,
    /// The element here, if there is one.
    pub element: Option<Element>,
    /// Our node `i` is the node `permutation[i]` of the file; empty where the orders agree.
    pub permutation: &'static [usize],
    shape: Shape,
}

impl Kind {
    /// The type of this number; `None` for numbers without meaning and for cells without a fixed number of nodes.
    pub fn find(number: i64) -> Option<Self> {
        let number = u32::try_from(number).ok()?;
        let (shape, &(_, order, nnode)) = TYPES
            .iter()
            .flat_map(|(shape, types)| types.iter().map(move |t| (*shape, t)))
            .find(|(_, t)| t.0 == number)?;
        let known = ELEMENTS.iter().find(|e| e.0 == number);
        Some(Self {
            number,
            dim: shape.dim(),
            order,
            nnode,
            element: known.and_then(|(_, name, _)| element::by_name(name)),
            permutation: known.map_or(&[], |(_, _, permutation)| *permutation),
            shape,
        })
    }

    /// Whether this is the point, which marks a node.
    pub fn is_point(&self) -> bool {
        self.shape == Shape::Point
    }

    /// In words: `"type 11 (tetrahedron of 10 nodes)"`.
    pub fn in_words(&self) -> String {
        let (number, shape, nnode) = (self.number, self.shape.word(), self.nnode);
        format!("type {number} ({shape} of {nnode} nodes)")
    }
}

/// The types that can be read, for messages.
pub(super) fn supported() -> String {
    let types = ELEMENTS
        .iter()
        .filter(|e| element::by_name(e.1).is_some())
        .map(|(number, name, _)| format!("{name} ({number})"));
    types.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_types_are_the_elements_of_the_same_order() {
        for (number, name) in [
            (1, "line2"),
            (2, "tri3"),
            (3, "quad4"),
            (4, "tet4"),
            (5, "hex8"),
            (6, "wedge6"),
        ] {
            let kind = Kind::find(number).unwrap();
            let element = kind.element.unwrap();
            assert_eq!(element.name(), name);
            assert_eq!(element.nnode(), kind.nnode);
            assert_eq!(element.dim(), kind.dim as usize);
            assert!(kind.permutation.is_empty());
        }
        assert!(Kind::find(15).unwrap().is_point());
        assert!(Kind::find(0).is_none() && Kind::find(34).is_none() && Kind::find(-1).is_none());
    }

    /// The reference nodes of Gmsh's second-order types, doubled to whole numbers.
    const TET10: [[i8; 3]; 10] = [
        [0, 0, 0],
        [2, 0, 0],
        [0, 2, 0],
        [0, 0, 2],
        [1, 0, 0],
        [1, 1, 0],
        [0, 1, 0],
        [0, 0, 1],
        [0, 1, 1],
        [1, 0, 1],
    ];
    const HEX20: [[i8; 3]; 20] = [
        [-2, -2, -2],
        [2, -2, -2],
        [2, 2, -2],
        [-2, 2, -2],
        [-2, -2, 2],
        [2, -2, 2],
        [2, 2, 2],
        [-2, 2, 2],
        [0, -2, -2],
        [-2, 0, -2],
        [-2, -2, 0],
        [2, 0, -2],
        [2, -2, 0],
        [0, 2, -2],
        [2, 2, 0],
        [-2, 2, 0],
        [0, -2, 2],
        [-2, 0, 2],
        [2, 0, 2],
        [0, 2, 2],
    ];
    const WEDGE15: [[i8; 3]; 15] = [
        [0, 0, -2],
        [2, 0, -2],
        [0, 2, -2],
        [0, 0, 2],
        [2, 0, 2],
        [0, 2, 2],
        [1, 0, -2],
        [0, 1, -2],
        [0, 0, 0],
        [1, 1, -2],
        [2, 0, 0],
        [0, 2, 0],
        [1, 0, 2],
        [0, 1, 2],
        [1, 1, 2],
    ];

    /// VTK numbers mid-side nodes edge by edge: bottom ring, top ring, uprights; the tetrahedron base first.
    #[test]
    fn second_order_types_are_permuted_to_the_order_of_vtk() {
        let tet: &[[usize; 2]] = &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
        let hex: &[[usize; 2]] = &[
            [0, 1],
            [1, 2],
            [2, 3],
            [3, 0],
            [4, 5],
            [5, 6],
            [6, 7],
            [7, 4],
            [0, 4],
            [1, 5],
            [2, 6],
            [3, 7],
        ];
        let wedge: &[[usize; 2]] = &[
            [0, 1],
            [1, 2],
            [2, 0],
            [3, 4],
            [4, 5],
            [5, 3],
            [0, 3],
            [1, 4],
            [2, 5],
        ];
        type Case<'a> = (i64, &'a [[i8; 3]], usize, &'a [[usize; 2]]);
        let cases: [Case<'_>; 3] = [
            (11, &TET10, 4, tet),
            (17, &HEX20, 8, hex),
            (18, &WEDGE15, 6, wedge),
        ];
        for (number, nodes, ncorner, edges) in cases {
            let permutation = Kind::find(number).unwrap().permutation;
            assert_eq!(permutation.len(), nodes.len());
            assert!(permutation.iter().take(ncorner).copied().eq(0..ncorner));
            for (&[a, b], &place) in edges.iter().zip(&permutation[ncorner..]) {
                let middle = [0, 1, 2].map(|axis| (nodes[a][axis] + nodes[b][axis]) / 2);
                assert_eq!(nodes[place], middle, "type {number}, edge {a}-{b}");
            }
        }
    }

    #[test]
    fn every_type_with_an_element_here_has_its_dimension_and_number_of_nodes() {
        for (number, name, permutation) in ELEMENTS {
            let kind = Kind::find(number.into()).unwrap();
            assert!(permutation.is_empty() || permutation.len() == kind.nnode);
            assert_eq!(
                kind.element.map(|e| e.name()),
                element::by_name(name).map(|e| e.name())
            );
            if let Some(element) = kind.element {
                let expected = (kind.dim as usize, kind.nnode);
                assert_eq!((element.dim(), element.nnode()), expected, "{name}");
            }
        }
    }

    #[test]
    fn types_are_listed_once() {
        let mut numbers: Vec<u32> = TYPES.iter().flat_map(|t| t.1).map(|t| t.0).collect();
        let count = numbers.len();
        numbers.sort_unstable();
        numbers.dedup();
        assert_eq!(numbers.len(), count);
    }
}
