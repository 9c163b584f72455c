use super::{MeshError, Place};
use signorini_geometry::element::{self, by_name};
use signorini_geometry::mesh::{Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use std::collections::{HashMap, HashSet};

/// An element as written in a case: its number, its type, the group it is in, the numbers of its nodes.
pub type InlineElement<'a> = (u64, &'a str, Option<&'a str>, &'a [u64]);

/// A mesh from nodes (number, position) and elements; every group becomes a set of cells.
///
/// # Errors
/// All faults at once, each with the entry it is in.
pub fn build(
    nodes: &[(u64, [f64; 3])],
    elements: &[InlineElement<'_>],
) -> Result<Mesh, Vec<MeshError>> {
    let mut mesh = Mesh::default();
    let mut errors = Vec::new();
    let lookup = push_nodes(nodes, &mut mesh, &mut errors);
    let mut seen = HashSet::with_capacity(elements.len());
    for (i, &(label, kind, group, labels)) in elements.iter().enumerate() {
        let place = || entry("elements", i);
        if !seen.insert(label) {
            errors.push(MeshError::DuplicateElement {
                place: place(),
                element: label,
            });
        }
        let Some(element) = by_name(kind) else {
            errors.push(MeshError::UnknownElement {
                place: place(),
                found: kind.chars().take(40).collect(),
                known: element::TABLE.map(|e| e.name()).join(", "),
            });
            continue;
        };
        if labels.len() != element.nnode() {
            errors.push(MeshError::NodeCount {
                place: place(),
                element: label,
                kind: element.name().into(),
                found: labels.len(),
                wanted: element.nnode(),
            });
            continue;
        }
        let mut ids: Vec<NodeId> = Vec::with_capacity(labels.len());
        for (k, &node) in labels.iter().enumerate() {
            match lookup.get(&node) {
                None => errors.push(MeshError::MissingNode {
                    place: place(),
                    element: label,
                    node,
                }),
                Some(_) if labels.iter().take(k).any(|&before| before == node) => {
                    errors.push(MeshError::RepeatedNode {
                        place: place(),
                        element: label,
                        node,
                    });
                }
                Some(&id) => ids.push(id),
            }
        }
        if ids.len() == element.nnode() {
            let cell = mesh.push_cell(element, &ids, label);
            if let Some(group) = group {
                let set = mesh.sets.entry(group.to_owned()).or_default();
                set.cells.push(cell);
            }
        }
    }
    if elements.is_empty() {
        errors.push(MeshError::NoElements {
            place: Place::File("[mesh]".into()),
            nnode: nodes.len(),
        });
    }
    for set in mesh.sets.values_mut() {
        set.cells.sort_unstable();
    }
    if errors.is_empty() {
        Ok(mesh)
    } else {
        Err(errors)
    }
}

fn entry(table: &'static str, index: usize) -> Place {
    Place::Entry {
        table,
        entry: index + 1,
    }
}

fn push_nodes(
    nodes: &[(u64, [f64; 3])],
    mesh: &mut Mesh,
    errors: &mut Vec<MeshError>,
) -> HashMap<u64, NodeId> {
    let mut lookup = HashMap::with_capacity(nodes.len());
    for (i, &(label, x)) in nodes.iter().enumerate() {
        for (x, axis) in x.iter().zip(['x', 'y', 'z']) {
            if !x.is_finite() {
                errors.push(MeshError::NotFinite {
                    place: entry("nodes", i),
                    node: label,
                    axis,
                    found: x.to_string(),
                });
            }
        }
        if lookup.insert(label, mesh.points.len() as NodeId).is_some() {
            errors.push(MeshError::DuplicateNode {
                place: entry("nodes", i),
                node: label,
            });
        }
        mesh.points.push(Vec3::from(x));
        mesh.node_labels.push(label);
    }
    lookup
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The brick and the tip of the case format's first example.
    const NODES: [(u64, [f64; 3]); 12] = [
        (1, [0.0, 0.0, 0.0]),
        (2, [1.0, 0.0, 0.0]),
        (3, [1.0, 1.0, 0.0]),
        (4, [0.0, 1.0, 0.0]),
        (5, [0.0, 0.0, 1.0]),
        (6, [1.0, 0.0, 1.0]),
        (7, [1.0, 1.0, 1.0]),
        (8, [0.0, 1.0, 1.0]),
        (11, [0.5, 0.25, 1.0]),
        (12, [0.2, 0.0, 1.8]),
        (13, [0.8, 0.0, 1.8]),
        (14, [0.5, 0.6, 1.8]),
    ];

    #[test]
    fn the_paper_brick_has_its_nodes_cells_and_groups() {
        let elements: [InlineElement<'_>; 2] = [
            (1, "hex8", Some("brick"), &[1, 2, 3, 4, 5, 6, 7, 8]),
            (2, "tet4", Some("tool"), &[11, 12, 13, 14]),
        ];
        let mesh = build(&NODES, &elements).unwrap();
        assert_eq!((mesh.nnode(), mesh.ncell(), mesh.dim()), (12, 2, 3));
        assert_eq!(mesh.node_labels[8], 11);
        let tool = mesh.sets["tool"].cells[0];
        assert_eq!(mesh.cell(tool), [8, 9, 10, 11]);
        assert_eq!(mesh.cell_label(tool), Some(2));
        assert_eq!(mesh.nodes_of(&mesh.sets["brick"]), [0, 1, 2, 3, 4, 5, 6, 7]);
    }

    #[test]
    fn every_fault_is_reported_at_once_with_its_entry() {
        let nodes = [
            (1, [0.0; 3]),
            (2, [1.0, f64::NAN, 0.0]),
            (2, [1.0, 0.0, 0.0]),
            (3, [0.0, 1.0, 0.0]),
        ];
        let elements: [InlineElement<'_>; 5] = [
            (1, "tri3", None, &[1, 2, 9]),
            (2, "tri", None, &[1, 2, 3]),
            (3, "tri3", None, &[1, 2]),
            (1, "tri3", None, &[1, 3, 1]),
            (5, "tri3", None, &[1, 2, 3]),
        ];
        let errors = build(&nodes, &elements).unwrap_err();
        let messages: Vec<String> = errors.iter().map(ToString::to_string).collect();
        assert_eq!(
            messages,
            [
                "[mesh] nodes, entry 2: coordinate y of node 2 is NaN; coordinates must be finite",
                "[mesh] nodes, entry 3: node 2 is defined a second time; give every node a number of its own",
                "[mesh] elements, entry 1: element 1 refers to node 9, which the mesh does not have; correct the element or add the node",
                "[mesh] elements, entry 2: there is no element type `tri`; supported are line2, line3, tri3, tri6, quad4, quad8, quad9, tet4, tet10, hex8, hex20, hex27, wedge6, wedge15",
                "[mesh] elements, entry 3: element 3 has 2 nodes; a tri3 has 3",
                "[mesh] elements, entry 4: element 1 is defined a second time; give every element a number of its own",
                "[mesh] elements, entry 4: element 1 has node 1 twice; collapsed elements are not supported: use a type with fewer nodes",
            ]
        );
    }

    #[test]
    fn a_mesh_without_elements_is_refused() {
        let errors = build(&NODES, &[]).unwrap_err();
        assert!(matches!(
            errors[..],
            [MeshError::NoElements { nnode: 12, .. }]
        ));
    }
}
