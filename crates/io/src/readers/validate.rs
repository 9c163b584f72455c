//! What can be wrong with a mesh that could be read.

use signorini_geometry::mesh::quality::{self, Jacobian};
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use std::collections::hash_map::RandomState;
use std::fmt;
use std::hash::BuildHasher;
use std::panic::resume_unwind;
use std::thread;
use thiserror::Error;

/// How many elements or nodes an issue names.
const NAMED: usize = 10;

/// Nodes nearer than this, relative to the diagonal of the mesh, coincide.
const COINCIDENT: f64 = 1e-9;

/// Coordinates beyond this, and meshes smaller than its inverse, are refused: squares would overflow.
const ABSURD: f64 = 1e150;

/// A Jacobian below this is zero, relative to the size of the cell.
const FLAT: f64 = 1e-12;

/// How much an issue matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// Often a mistake.
    Warning,
    /// The mesh cannot be used.
    Error,
}

/// Numbers of the input: how many, and the first ten of them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sample {
    /// How many there are.
    pub count: usize,
    /// The first ten.
    pub first: Vec<u64>,
}

impl Sample {
    fn push(&mut self, label: u64) {
        self.count += 1;
        if self.first.len() < NAMED {
            self.first.push(label);
        }
    }
}

impl fmt::Display for Sample {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, label) in self.first.iter().enumerate() {
            write!(f, "{}{label}", if i == 0 { "" } else { ", " })?;
        }
        if self.count > self.first.len() {
            write!(f, ", … ({} in all)", self.count)?;
        }
        Ok(())
    }
}

/// One thing wrong, or unusual, with a mesh.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MeshIssue {
    /// Coordinates that are infinite or not numbers.
    #[error("coordinates are not finite at nodes {nodes}")]
    NotFinite {
        /// The nodes.
        nodes: Sample,
    },
    /// Coordinates whose squares overflow.
    #[error("coordinates exceed 1e150 at nodes {nodes}")]
    TooLarge {
        /// The nodes.
        nodes: Sample,
    },
    /// A mesh whose squares vanish.
    #[error("the whole mesh is {extent:e} long")]
    TooSmall {
        /// Length of the diagonal of its box.
        extent: f64,
    },
    /// A mesh so far away that its coordinates lose digits.
    #[error(
        "the mesh is {extent:e} long but {distance:e} from the origin; its coordinates lose digits"
    )]
    FarAway {
        /// Length of the diagonal of its box.
        extent: f64,
        /// Largest coordinate.
        distance: f64,
    },
    /// All cells are numbered the other way round.
    #[error("all {ncell} elements have a negative volume: the whole mesh is mirrored")]
    Mirrored {
        /// How many.
        ncell: usize,
    },
    /// Cells numbered the other way round.
    #[error("negative volume: elements {elements}")]
    Inverted {
        /// The cells.
        elements: Sample,
    },
    /// Cells whose Jacobian changes sign.
    #[error("elements {elements} are folded: the Jacobian is negative at some points")]
    Folded {
        /// The cells.
        elements: Sample,
    },
    /// Cells whose Jacobian vanishes at some or all points.
    #[error("zero volume: elements {elements}, in whole or at a corner")]
    Flat {
        /// The cells.
        elements: Sample,
    },
    /// Cells with the same node twice.
    #[error("elements {elements} have a node twice")]
    RepeatedNode {
        /// The cells.
        elements: Sample,
    },
    /// Solids on the same nodes as another.
    #[error("elements {elements} have the same nodes as another element")]
    Duplicate {
        /// The cells.
        elements: Sample,
    },
    /// Nodes at the same place that are not the same node.
    #[error("nodes within {tolerance:.1e} of another one: {count}, such as {} and {}", pair[0], pair[1])]
    Coincident {
        /// Nodes that coincide with an earlier one.
        count: usize,
        /// An example.
        pair: [u64; 2],
        /// The distance.
        tolerance: f64,
    },
    /// Nodes without elements.
    #[error("nodes without elements: {count}; they are ignored")]
    Unreferenced {
        /// How many.
        count: usize,
    },
}

impl MeshIssue {
    /// How much it matters.
    #[must_use]
    pub const fn severity(&self) -> Severity {
        match self {
            Self::Unreferenced { .. } => Severity::Note,
            Self::FarAway { .. } | Self::Coincident { .. } | Self::Duplicate { .. } => {
                Severity::Warning
            }
            _ => Severity::Error,
        }
    }

    /// What to change; `None` where nothing has to be.
    #[must_use]
    pub const fn remedy(&self) -> Option<&'static str> {
        Some(match self {
            Self::NotFinite { .. } => "correct the coordinates",
            Self::TooLarge { .. } | Self::TooSmall { .. } => "use other units",
            Self::FarAway { .. } => "move the mesh nearer to the origin",
            Self::Mirrored { .. } => {
                "reverse the order of the nodes in every element, or mirror the coordinates"
            }
            Self::Inverted { .. } => "reverse the order of their nodes",
            Self::Folded { .. } => "move their nodes, or mesh again",
            Self::Flat { .. } => "remove them, or move their nodes",
            Self::RepeatedNode { .. } => "use a type with fewer nodes",
            Self::Duplicate { .. } => "remove one of each",
            Self::Coincident { .. } => "merge them, unless bodies or a crack meet there",
            Self::Unreferenced { .. } => return None,
        })
    }

    /// The first elements that it names.
    #[must_use]
    pub fn elements(&self) -> &[u64] {
        match self {
            Self::Inverted { elements }
            | Self::Folded { elements }
            | Self::Flat { elements }
            | Self::RepeatedNode { elements }
            | Self::Duplicate { elements } => &elements.first,
            _ => &[],
        }
    }
}

/// Everything wrong with the mesh itself, cells of the highest dimension taken as solids.
///
/// The sign of the Jacobian is that of the determinant in space, of the area in the plane; a surface in space has none
/// and can only be flat. It is looked at in the quadrature points and the nodes, relative to the size of the cell.
///
/// # Example
/// ```
/// use signorini_io::readers::{read_mesh, validate};
///
/// // the fourth node lies on the wrong side: the volume is negative
/// let deck = b"*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, -1\n\
///     *ELEMENT, TYPE=C3D4\n7, 1, 2, 3, 4\n";
/// let (mesh, _) = read_mesh("part.inp", deck)?;
/// assert_eq!(validate(&mesh).len(), 1);
/// # Ok::<(), signorini_io::readers::MeshError>(())
/// ```
#[must_use]
pub fn validate(mesh: &Mesh) -> Vec<MeshIssue> {
    validate_as(mesh, quality::is_plane(mesh))
}

/// The same for a mesh whose cells are those of a plane, where areas have a sign, or not: shells may have all their nodes in one
/// plane, with normals to both sides.
#[must_use]
pub fn validate_as(mesh: &Mesh, plane: bool) -> Vec<MeshIssue> {
    let mut issues = Vec::new();
    let usable = coordinates(mesh, &mut issues);
    repeated_nodes(mesh, &mut issues);
    let used = used_nodes(mesh);
    // the three that take their time have nothing to do with each other
    let [of_volumes, of_pairs, coincident] = thread::scope(|scope| {
        let volumes = scope.spawn(|| match usable {
            true => volumes(mesh, plane),
            false => Vec::new(),
        });
        let coincident = scope.spawn(|| {
            let found = usable.then(|| coincident(mesh, &used));
            found.flatten().into_iter().collect()
        });
        let duplicates = duplicates(mesh);
        let ended = |task: thread::ScopedJoinHandle<'_, Vec<MeshIssue>>| {
            task.join().unwrap_or_else(|panic| resume_unwind(panic))
        };
        [
            ended(volumes),
            duplicates.into_iter().collect(),
            ended(coincident),
        ]
    });
    issues.extend([of_volumes, of_pairs, coincident].into_iter().flatten());
    let count = used.iter().filter(|used| !**used).count();
    if count > 0 {
        issues.push(MeshIssue::Unreferenced { count });
    }
    issues
}

fn label(mesh: &Mesh, node: usize) -> u64 {
    mesh.node_labels.get(node).copied().unwrap_or(0)
}

/// Whether coordinates can be calculated with.
fn coordinates(mesh: &Mesh, issues: &mut Vec<MeshIssue>) -> bool {
    let (mut not_finite, mut too_large) = (Sample::default(), Sample::default());
    for (node, x) in mesh.points.iter().enumerate() {
        if !x.is_finite() {
            not_finite.push(label(mesh, node));
        } else if x.max_abs() > ABSURD {
            too_large.push(label(mesh, node));
        }
    }
    let before = issues.len();
    if not_finite.count > 0 {
        issues.push(MeshIssue::NotFinite { nodes: not_finite });
    }
    if too_large.count > 0 {
        issues.push(MeshIssue::TooLarge { nodes: too_large });
    }
    if issues.len() > before || mesh.nnode() < 2 {
        return issues.len() == before;
    }
    let extent = mesh.diagonal();
    let distance = mesh.points.iter().fold(0.0, |d, x| x.max_abs().max(d));
    if extent < 1.0 / ABSURD {
        issues.push(MeshIssue::TooSmall { extent });
        return false;
    }
    if extent < 1e-8 * distance {
        issues.push(MeshIssue::FarAway { extent, distance });
    }
    true
}

fn repeated_nodes(mesh: &Mesh, issues: &mut Vec<MeshIssue>) {
    let mut elements = Sample::default();
    for block in &mesh.blocks {
        for (cell, &label) in block
            .nodes
            .chunks_exact(block.element.nnode())
            .zip(&block.labels)
        {
            let again = |(i, node)| cell.iter().take(i).any(|before| before == node);
            if cell.iter().enumerate().any(again) {
                elements.push(label);
            }
        }
    }
    if elements.count > 0 {
        issues.push(MeshIssue::RepeatedNode { elements });
    }
}

/// What the Jacobian of a cell is like.
#[derive(Clone, Copy, PartialEq)]
enum Volume {
    Good,
    Flat,
    Folded,
    Inverted,
}

/// The judgement on a cell with its nodes at `x`, which are moved and scaled.
fn judge(jacobian: &Jacobian, x: &mut [Vec3]) -> Volume {
    // coordinates are rounded; what that does to the Jacobian is not a volume
    let distance = x.iter().fold(0.0_f64, |d, x| d.max(x.max_abs()));
    let size = quality::normalize(x);
    if size == 0.0 {
        return Volume::Flat;
    }
    let zero = FLAT + 8.0 * f64::EPSILON * (distance / size);
    let (least, most) = jacobian.range(x);
    if least > zero {
        Volume::Good
    } else if most < -zero {
        Volume::Inverted
    } else if least < -zero {
        Volume::Folded
    } else {
        Volume::Flat
    }
}

fn volumes(mesh: &Mesh, plane: bool) -> Vec<MeshIssue> {
    let mut issues = Vec::new();
    let dim = mesh.dim();
    let [mut flat, mut folded, mut inverted] = [const {
        Sample {
            count: 0,
            first: Vec::new(),
        }
    }; 3];
    let mut ncell = 0;
    for block in mesh.blocks.iter().filter(|b| b.element.dim() == dim) {
        let jacobian = Jacobian::new(block.element, plane);
        let mut x = Vec::with_capacity(block.element.nnode());
        for (cell, &label) in block
            .nodes
            .chunks_exact(block.element.nnode())
            .zip(&block.labels)
        {
            x.clear();
            x.extend(cell.iter().filter_map(|&n| mesh.points.get(n as usize)));
            ncell += 1;
            match judge(&jacobian, &mut x) {
                Volume::Good => {}
                Volume::Flat => flat.push(label),
                Volume::Folded => folded.push(label),
                Volume::Inverted => inverted.push(label),
            }
        }
    }
    if inverted.count > 0 {
        issues.push(if inverted.count == ncell {
            MeshIssue::Mirrored { ncell }
        } else {
            MeshIssue::Inverted { elements: inverted }
        });
    }
    if folded.count > 0 {
        issues.push(MeshIssue::Folded { elements: folded });
    }
    if flat.count > 0 {
        issues.push(MeshIssue::Flat { elements: flat });
    }
    issues
}

fn duplicates(mesh: &Mesh) -> Option<MeshIssue> {
    let hasher = RandomState::new();
    let mut nodes: Vec<NodeId> = Vec::new();
    let mut hash = |cell: CellId| {
        nodes.clear();
        nodes.extend(mesh.cell(cell));
        nodes.sort_unstable();
        hasher.hash_one(&nodes)
    };
    let cells = mesh.cells(mesh.dim());
    let mut hashes: Vec<(u64, CellId)> = cells.map(|cell| (hash(cell), cell)).collect();
    hashes.sort_unstable();
    let sorted = |cell| {
        let mut nodes = mesh.cell(cell).to_vec();
        nodes.sort_unstable();
        nodes
    };
    let same = |pair: &&[(u64, CellId)]| matches!(pair, [a, b] if a.0 == b.0 && sorted(a.1) == sorted(b.1));
    let mut labels: Vec<u64> = (hashes.windows(2).filter(same))
        .filter_map(|pair| mesh.cell_label(pair.last()?.1))
        .collect();
    labels.sort_unstable();
    let mut elements = Sample::default();
    labels.into_iter().for_each(|label| elements.push(label));
    (elements.count > 0).then_some(MeshIssue::Duplicate { elements })
}

fn used_nodes(mesh: &Mesh) -> Vec<bool> {
    let mut used = vec![false; mesh.nnode()];
    let of_sets = mesh.sets.values().flat_map(|set| &set.nodes);
    for &node in mesh.blocks.iter().flat_map(|b| &b.nodes).chain(of_sets) {
        if let Some(used) = used.get_mut(node as usize) {
            *used = true;
        }
    }
    used
}

fn coincident(mesh: &Mesh, used: &[bool]) -> Option<MeshIssue> {
    let tolerance = COINCIDENT * mesh.diagonal();
    let found = quality::coincident(mesh, used, tolerance)?;
    Some(MeshIssue::Coincident {
        count: found.count,
        pair: found.pair.map(|node| label(mesh, node as usize)),
        tolerance,
    })
}

#[cfg(test)]
mod tests;
