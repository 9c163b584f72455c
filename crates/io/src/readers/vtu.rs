//! VTK's unstructured grids (`.vtu`) as meshes, also those that a run has written.
//!
//! ```text
//! cells                        by VTK's type, in VTK's node order
//! whole-number array of cells  a set of cells for each value from 0 on, called `name_value`: MaterialIds_2
//! whole-number array of nodes  a set of nodes for each value from 0 on
//! element_id, node_id          the numbers of elements and nodes, where they are distinct; without them from 1 on
//! ```
//!
//! Negative values stand for no set. An array of more than 256 values groups nothing: it gives no sets, and a note says
//! so. Arrays with which VTK numbers things for itself (`GlobalNodeId`, `vtkOriginalCellIds`, …) and those of several
//! components are no sets either. Vertices are left out; pixels and voxels are quadrilaterals and hexahedra.
//!
//! A wedge's first triangle has its normal out of the cell in VTK up to 9.3 and in files after that definition, into it
//! in later ones and in files of other programs: the sign of its volume decides.
//!
//! Source: *VTK File Formats*; types and node orders are those of [`cells`].

use super::{MeshError, Place};
use crate::vtk::cells::{self, CellType};
use crate::vtk::{self, Array, Vtu};
use signorini_geometry::element::MAX_NODES;
use signorini_geometry::mesh::{CellId, Mesh, NodeId, Set};
use signorini_geometry::tensor::Vec3;
use std::collections::{BTreeMap, HashSet};

/// An array of more different values than this groups nothing.
const GROUPS: usize = 256;

/// Arrays that number or mark things and group nothing.
const NUMBERS: [&str; 11] = [
    ELEMENT_ID,
    NODE_ID,
    "contact_status",
    "GlobalNodeId",
    "GlobalNodeIds",
    "GlobalElementId",
    "GlobalElementIds",
    "GlobalCellIds",
    "vtkOriginalPointIds",
    "vtkOriginalCellIds",
    "vtkGhostType",
];

/// The numbers of elements in the frames of a run.
const ELEMENT_ID: &str = "element_id";

/// The numbers of nodes in the frames of a run.
const NODE_ID: &str = "node_id";

/// VTK's single points, which mark nodes.
const VERTICES: [u8; 2] = [cells::VERTEX, 2];

/// Reads a grid, with notes. `name` appears in messages.
///
/// # Errors
/// Any fault in the file, with the array or the byte; a type of cells that is not read.
///
/// # Limits
/// Those of [`vtk`]. The content may be as large as 256 MiB and 64 times the file.
pub fn read(name: &str, bytes: &[u8]) -> Result<(Mesh, Vec<String>), MeshError> {
    let place = || Place::File(name.into());
    if bytes.trim_ascii().is_empty() {
        return Err(MeshError::Empty { place: place() });
    }
    let grid = vtk::read(bytes).map_err(|error| MeshError::Vtu {
        place: place(),
        error,
    })?;
    from_grid(name, &grid)
}

/// The mesh that a grid is, and notes.
///
/// # Errors
/// Coordinates that are not finite, types of cells that are not read, no cells at all.
pub fn from_grid(name: &str, grid: &Vtu) -> Result<(Mesh, Vec<String>), MeshError> {
    let place = Place::File(name.into());
    let mut mesh = Mesh::default();
    let mut notes = Vec::new();
    mesh.points = grid.points.iter().map(|&x| Vec3::from(x)).collect();
    mesh.node_labels = labels(grid.point_field(NODE_ID), grid.points.len());
    for (x, &node) in grid.points.iter().zip(&mesh.node_labels) {
        for (x, axis) in x.iter().zip(['x', 'y', 'z']) {
            if !x.is_finite() {
                return Err(MeshError::NotFinite {
                    place,
                    node,
                    axis,
                    found: x.to_string(),
                });
            }
        }
    }
    let cells = push_cells(&place, grid, &mut mesh)?;
    if mesh.ncell() == 0 {
        return Err(MeshError::NoElements {
            place,
            nnode: mesh.nnode(),
        });
    }
    for array in &grid.cell_data {
        for (set, members) in groups(array, &mut notes) {
            let cells = members
                .iter()
                .filter_map(|&i| cells.get(i).copied().flatten());
            mesh.sets.entry(set).or_default().cells.extend(cells);
        }
    }
    for array in &grid.point_data {
        for (set, members) in groups(array, &mut notes) {
            let nodes = members.iter().map(|&i| i as NodeId);
            mesh.sets.entry(set).or_default().nodes.extend(nodes);
        }
    }
    mesh.sets.retain(|_, set: &mut Set| !set.is_empty());
    for set in mesh.sets.values_mut() {
        set.cells.sort_unstable();
    }
    if !grid.skipped.is_empty() {
        notes.push(format!("arrays left out: {}", grid.skipped.join(", ")));
    }
    Ok((mesh, notes))
}

/// The numbers in an array where they are from 1 on and distinct, else 1, 2, ….
fn labels(array: Option<&Array>, count: usize) -> Vec<u64> {
    let counted = || (1..=count as u64).collect();
    let Some(numbers) = array.and_then(|array| array.numbers.to_i64()) else {
        return counted();
    };
    let given = numbers
        .iter()
        .map(|&n| u64::try_from(n).ok().filter(|&n| n > 0));
    let Some(given) = given.collect::<Option<Vec<u64>>>() else {
        return counted();
    };
    let mut seen = HashSet::with_capacity(given.len());
    match given.len() == count && given.iter().all(|label| seen.insert(*label)) {
        true => given,
        false => counted(),
    }
}

/// Puts all cells into the mesh, and says where they went.
fn push_cells(
    place: &Place,
    grid: &Vtu,
    mesh: &mut Mesh,
) -> Result<Vec<Option<CellId>>, MeshError> {
    let types = CellType::by_number();
    let labels = labels(grid.cell_field(ELEMENT_ID), grid.types.len());
    let mut cells = Vec::with_capacity(grid.types.len());
    let mut ids = [0; MAX_NODES];
    for ((&kind, ends), &label) in grid.types.iter().zip(grid.offsets.windows(2)).zip(&labels) {
        if VERTICES.contains(&kind) {
            cells.push(None);
            continue;
        }
        let Some(cell_type) = types.get(kind as usize).copied().flatten() else {
            return Err(MeshError::Unsupported {
                place: place.clone(),
                found: format!("cells of VTK type {kind}, such as {label}"),
                hint: "save it with linear or quadratic cells of fixed shape, no polyhedra",
            });
        };
        let element = cell_type.element;
        let nodes = match ends {
            &[start, end] => grid.connectivity.get(start..end).unwrap_or_default(),
            _ => &[],
        };
        if nodes.len() != element.nnode() {
            return Err(MeshError::NodeCount {
                place: place.clone(),
                element: label,
                kind: element.name().into(),
                found: nodes.len(),
                wanted: element.nnode(),
            });
        }
        let ours = ids.get_mut(..nodes.len()).unwrap_or_default();
        for (&node, place) in nodes.iter().zip(cell_type.places()) {
            if let Some(id) = ours.get_mut(place) {
                *id = node as NodeId;
            }
        }
        if kind == 13 {
            turn_wedge(mesh, ours);
        }
        for (i, id) in ours.iter().enumerate() {
            if ours.iter().take(i).any(|before| before == id) {
                return Err(MeshError::RepeatedNode {
                    place: place.clone(),
                    element: label,
                    node: mesh.node_labels.get(*id as usize).copied().unwrap_or(0),
                });
            }
        }
        cells.push(Some(mesh.push_cell(element, ours, label)));
    }
    Ok(cells)
}

/// Exchanges two nodes of each triangle of a wedge whose volume is negative.
fn turn_wedge(mesh: &Mesh, nodes: &mut [NodeId]) {
    let x = |i: usize| {
        let node = nodes.get(i).copied().unwrap_or(0);
        mesh.points
            .get(node as usize)
            .copied()
            .unwrap_or(Vec3::ZERO)
    };
    let axis = x(3) + x(4) + x(5) - x(0) - x(1) - x(2);
    let lower = (x(1) - x(0)).cross(x(2) - x(0));
    let upper = (x(4) - x(3)).cross(x(5) - x(3));
    if (lower + upper).dot(axis) < 0.0 {
        nodes.swap(1, 2);
        nodes.swap(4, 5);
    }
}

/// What an array of whole numbers groups: names of sets, and which entries are in each.
fn groups(array: &Array, notes: &mut Vec<String>) -> Vec<(String, Vec<usize>)> {
    if array.ncomponent != 1 || NUMBERS.contains(&array.name.as_str()) {
        return Vec::new();
    }
    let Some(values) = array.numbers.to_i64() else {
        return Vec::new();
    };
    let mut groups: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
    for (entry, &value) in values.iter().enumerate().filter(|(_, value)| **value >= 0) {
        groups.entry(value).or_default().push(entry);
        if groups.len() > GROUPS {
            notes.push(format!(
                "array `{}` has more than {GROUPS} values: it gives no sets",
                array.name
            ));
            return Vec::new();
        }
    }
    let named = groups.into_iter();
    named
        .map(|(value, entries)| (format!("{}_{value}", array.name), entries))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(name: &str, values: Vec<i32>) -> Array {
        Array {
            name: name.into(),
            ncomponent: 1,
            component_names: vec![],
            numbers: vtk::Numbers::I32(values),
        }
    }

    /// Two wedges on one triangle: above it in the order of Abaqus, below it in the old one of VTK.
    fn wedges() -> Vtu {
        let layer = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
        Vtu {
            points: [layer(0.0), layer(1.0), layer(2.0)].concat(),
            types: vec![13, 13, 1],
            offsets: vec![0, 6, 12, 13],
            connectivity: vec![3, 4, 5, 6, 7, 8, 0, 2, 1, 3, 5, 4, 0],
            cell_data: vec![
                numbers("group", vec![7, -1, 7]),
                numbers("element_id", vec![12, 11, 10]),
            ],
            point_data: vec![numbers("mask", vec![0, 0, 0, 0, 0, 0, 1, 1, 1])],
            ..Vtu::default()
        }
    }

    #[test]
    fn whole_numbers_become_sets_and_labels_and_wedges_turn_to_a_positive_volume() {
        let (mesh, _) = from_grid("a.vtu", &wedges()).unwrap();
        assert_eq!(super::super::validate(&mesh), []);
        assert_eq!((mesh.nnode(), mesh.ncell()), (9, 2));
        assert_eq!(mesh.blocks[0].labels, [12, 11]);
        let names: Vec<&String> = mesh.sets.keys().collect();
        assert_eq!(names, ["group_7", "mask_0", "mask_1"]);
        assert_eq!(mesh.sets["group_7"].cells.len(), 1);
        assert_eq!(mesh.sets["mask_1"].nodes, [6, 7, 8]);
    }

    #[test]
    fn numbers_that_group_nothing_give_no_sets_but_a_note() {
        let mut grid = wedges();
        let count = GROUPS as i32 + 1;
        grid.points.resize(count as usize, [0.0; 3]);
        grid.point_data = vec![numbers("mask", (0..count).collect())];
        let (mesh, notes) = from_grid("a.vtu", &grid).unwrap();
        assert_eq!(mesh.sets.len(), 1);
        assert_eq!(
            notes,
            ["array `mask` has more than 256 values: it gives no sets"]
        );
    }

    #[test]
    fn faults_name_the_file_and_the_cell() {
        let fault = |change: fn(&mut Vtu)| {
            let mut grid = wedges();
            change(&mut grid);
            from_grid("a.vtu", &grid).unwrap_err().to_string()
        };
        assert_eq!(
            fault(|g| g.types[1] = 42),
            "a.vtu: the mesh has cells of VTK type 42, such as 11: not supported yet; save it with linear or quadratic cells of fixed shape, no polyhedra"
        );
        assert_eq!(
            fault(|g| g.types[1] = 12),
            "a.vtu: element 11 has 6 nodes; a hex8 has 8"
        );
        assert!(fault(|g| g.connectivity[6] = 1).contains("element 11 has node 2 twice"));
        assert!(fault(|g| g.points[4][1] = f64::NAN).contains("coordinate y of node 5 is NaN"));
        assert!(fault(|g| g.types = vec![1; 3]).contains("no elements"));
        let error = read("a.vtu", b"solid").unwrap_err().to_string();
        assert!(
            error.starts_with("a.vtu: the file is not a .vtu file"),
            "{error}"
        );
    }
}
