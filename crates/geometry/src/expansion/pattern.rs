//! How a shell is divided into quadrilaterals.
//!
//! ```text
//! 3───────2   3───5───2   3───────2   3───6───2      2
//! │       │   │   │   │   │       │   │   │   │      │ ╲
//! │       │   │   │   │   5───────4   7───8───5      5   4
//! │       │   │   │   │   │       │   │   │   │      │ 6   ╲
//! 0───────1   0───4───1   0───────1   0───4───1      0───3───1
//!   WHOLE       ALONG       ACROSS      FOUR           THREE
//! ```
//!
//! A *station* is a corner of these quadrilaterals.

/// A division.
#[derive(Debug, PartialEq)]
pub(super) struct Pattern {
    /// The node of the surface's element at each station, corners first; its number of nodes stands for its centre.
    pub nodes: &'static [usize],
    /// The stations of each quadrilateral, in the order of the shell's corners.
    pub quads: &'static [[usize; 4]],
    /// The parts of each edge from its start to its end: a quadrilateral and the side of its solid.
    pub edges: &'static [&'static [(usize, u8)]],
}

/// The side of an eight-node solid on the edge from corner `k` of its negative face to the next.
const fn on_edge(k: u8) -> u8 {
    2 + k
}

const E: [u8; 4] = [on_edge(0), on_edge(1), on_edge(2), on_edge(3)];

/// One quadrilateral.
pub(super) static WHOLE: Pattern = Pattern {
    nodes: &[0, 1, 2, 3],
    quads: &[[0, 1, 2, 3]],
    edges: &[&[(0, E[0])], &[(0, E[1])], &[(0, E[2])], &[(0, E[3])]],
};

/// Two, with middles on edges 0 and 2.
pub(super) static ALONG: Pattern = Pattern {
    nodes: &[0, 1, 2, 3, 4, 6],
    quads: &[[0, 4, 5, 3], [4, 1, 2, 5]],
    edges: &[
        &[(0, E[0]), (1, E[0])],
        &[(1, E[1])],
        &[(1, E[2]), (0, E[2])],
        &[(0, E[3])],
    ],
};

/// Two, with middles on edges 1 and 3.
pub(super) static ACROSS: Pattern = Pattern {
    nodes: &[0, 1, 2, 3, 5, 7],
    quads: &[[0, 1, 4, 5], [5, 4, 2, 3]],
    edges: &[
        &[(0, E[0])],
        &[(0, E[1]), (1, E[1])],
        &[(1, E[2])],
        &[(1, E[3]), (0, E[3])],
    ],
};

/// Four around the centre.
pub(super) static FOUR: Pattern = Pattern {
    nodes: &[0, 1, 2, 3, 4, 5, 6, 7, 8],
    quads: &[[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]],
    edges: &[
        &[(0, E[0]), (1, E[0])],
        &[(1, E[1]), (2, E[1])],
        &[(2, E[2]), (3, E[2])],
        &[(3, E[3]), (0, E[3])],
    ],
};

/// Three around the centre of a triangle, each from a corner.
pub(super) static THREE: Pattern = Pattern {
    nodes: &[0, 1, 2, 3, 4, 5, 6],
    quads: &[[0, 3, 6, 5], [1, 4, 6, 3], [2, 5, 6, 4]],
    edges: &[
        &[(0, E[0]), (1, E[3])],
        &[(1, E[0]), (2, E[3])],
        &[(2, E[0]), (0, E[3])],
    ],
};
