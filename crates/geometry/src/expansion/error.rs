//! Why shells cannot be expanded.

use thiserror::Error;

/// Why shells cannot be expanded. Numbers of elements and nodes are those of the input.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ExpansionError {
    /// A cell that does not exist.
    #[error("shell {shell} of the list is no cell of the mesh")]
    NoSuchCell {
        /// Its place in the list, from 0.
        shell: usize,
    },
    /// A node that does not exist.
    #[error("element {label} has a node that is not in the mesh")]
    NoSuchNode {
        /// The element.
        label: u64,
    },
    /// A section that does not exist.
    #[error("element {label} has section {section}, which does not exist")]
    NoSuchSection {
        /// The element.
        label: u64,
        /// The number of its section, from 0.
        section: usize,
    },
    /// An element that is no shell.
    #[error(
        "element {label} is a {element}, which cannot be a shell; shells are triangles of 3 or 6 nodes and quadrilaterals \
         of 4, 8 or 9"
    )]
    NotAShell {
        /// The element.
        label: u64,
        /// Its type.
        element: &'static str,
    },
    /// An element with two sections.
    #[error("element {label} is a shell twice; give it one section")]
    Twice {
        /// The element.
        label: u64,
    },
    /// A thickness that is not positive.
    #[error(
        "the thickness of shell element {label} is {thickness} at node {node}; it must be positive"
    )]
    Thickness {
        /// The element.
        label: u64,
        /// The node.
        node: u64,
        /// The thickness.
        thickness: f64,
    },
    /// An offset that is not finite.
    #[error("the offset of shell element {label} is {offset}; it must be finite")]
    Offset {
        /// The element.
        label: u64,
        /// The offset.
        offset: f64,
    },
    /// A prescribed normal without direction.
    #[error("the normal given for element {label} at node {node} has no direction")]
    NoDirection {
        /// The element.
        label: u64,
        /// The node.
        node: u64,
    },
    /// A surface without normal.
    #[error(
        "shell element {label} has no area at node {node}: its edges there are parallel or have no length"
    )]
    NoArea {
        /// The element.
        label: u64,
        /// The node.
        node: u64,
    },
    /// A surface that folds over.
    #[error(
        "shell element {label} is concave or folded at node {node}; check the order of its nodes"
    )]
    Folded {
        /// The element.
        label: u64,
        /// The node.
        node: u64,
    },
    /// A director that leaves the shell on its wrong side.
    #[error(
        "the normal of shell element {label} at node {node} points to its negative side; check the normals given there \
         and the angle within which normals join"
    )]
    Reversed {
        /// The element.
        label: u64,
        /// The node.
        node: u64,
    },
    /// A shell that is bent too tightly for its thickness.
    #[error(
        "shell element {label} turns inside out at node {node}: its radius of curvature there is {radius:.6e}, and its \
         {face} face lies {depth:.6e} towards the centre of curvature (half of the thickness without an offset); make \
         it thinner, or change the offset"
    )]
    InsideOut {
        /// The element.
        label: u64,
        /// The node.
        node: u64,
        /// The radius of curvature of the surface through the nodes.
        radius: f64,
        /// The distance from the nodes to the face.
        depth: f64,
        /// Which face: `"negative"` or `"positive"`.
        face: &'static str,
    },
    /// A set that has the name of a side.
    #[error(
        "the set {name:?} exists, but this is the name of a side of the shells in {of:?}; rename it"
    )]
    NameTaken {
        /// Its name.
        name: String,
        /// The set with shells.
        of: String,
    },
}
