//! Sets, blocks and the cells that are no shells.

use super::super::ShellSide;
use super::*;
use crate::mesh::{Face, Set};

/// A brick with a sheet on its top and a sheet next to it; only the second is a shell.
fn brick_and_sheets() -> (Mesh, Vec<ShellCell>) {
    let mut mesh = Mesh::default();
    for z in [0.0, 1.0] {
        for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            add_node(&mut mesh, Vec3::new(x, y, z));
        }
    }
    for x in [4.0, 5.0, 6.0] {
        add_node(&mut mesh, Vec3::new(x, 0.0, 0.0));
        add_node(&mut mesh, Vec3::new(x, 1.0, 0.0));
    }
    let quad4 = by_name("quad4").unwrap();
    let first = mesh.push_cell(quad4, &[8, 10, 11, 9], 31);
    let top = mesh.push_cell(quad4, &[4, 5, 6, 7], 32);
    let second = mesh.push_cell(quad4, &[10, 12, 13, 11], 33);
    let brick = mesh.push_cell(by_name("hex8").unwrap(), &[0, 1, 2, 3, 4, 5, 6, 7], 34);
    let sets = [
        (
            "everything",
            Set {
                nodes: vec![3, 8],
                cells: vec![first, top, second, brick],
                faces: vec![],
            },
        ),
        (
            "sheet",
            Set {
                cells: vec![second],
                ..Set::default()
            },
        ),
        (
            "block",
            Set {
                cells: vec![top],
                faces: vec![Face {
                    cell: brick,
                    side: 0,
                }],
                nodes: vec![1],
            },
        ),
        (
            "edge of the sheet",
            Set {
                faces: vec![Face {
                    cell: second,
                    side: 3,
                }],
                ..Set::default()
            },
        ),
        (
            "nodes",
            Set {
                nodes: vec![12, 13],
                ..Set::default()
            },
        ),
    ];
    mesh.sets = sets.map(|(name, set)| (name.to_string(), set)).into();
    let section = 0;
    let cells = [second, first].map(|cell| ShellCell { cell, section });
    (mesh, cells.to_vec())
}

#[test]
fn sets_have_solids_in_place_of_shells_and_their_sides_by_name() {
    let (mesh, cells) = brick_and_sheets();
    let given = BTreeMap::new();
    let joining = Joining {
        angle: Joining::ANGLE,
        given: &given,
    };
    let shell = expand(&mesh, &cells, &[section(0.1, 0.0)], &joining).unwrap();
    assert_is_consistent_without_boundary(&mesh, &shell);
    let out = &shell.mesh;
    // blocks keep their numbers; solids follow the brick
    assert_eq!(out.blocks.len(), 2);
    assert_eq!(out.blocks[0].labels, [32]);
    assert_eq!(out.blocks[1].labels, [34, 33, 31]);
    let id = |block, index| CellId { block, index };
    let (top, brick) = (id(0, 0), id(1, 0));
    assert_eq!(shell.kept.of(id(0, 1)), Some(top));
    assert_eq!(shell.kept.of(id(0, 0)), None);
    assert_eq!(shell.kept.of(id(0, 2)), None);
    assert_eq!(shell.kept.of(brick), Some(brick));
    assert_eq!(shell.solids, [vec![id(1, 1)], vec![id(1, 2)]]);
    let set = |name: &str| &out.sets[name];
    assert_eq!(set("everything").cells, [id(1, 2), top, id(1, 1), brick]);
    assert_eq!(set("everything").nodes, [3, 8, 10, 11, 9, 12, 13]);
    assert_eq!(set("sheet").nodes, [10, 12, 13, 11]);
    assert_eq!(set("nodes"), &mesh.sets["nodes"]);
    assert_eq!(set("block").cells, [top]);
    assert_eq!(set("block").faces, mesh.sets["block"].faces);
    assert_eq!(set("block").nodes, [1]);
    assert!(!out.sets.contains_key("block.positive"));
    assert!(!out.sets.contains_key("edge of the sheet.positive"));
    let faces = |shell_: usize, side| shell.faces(shell_, side).collect::<Vec<_>>();
    assert_eq!(set("edge of the sheet").faces, faces(0, ShellSide::Edge(1)));
    assert_eq!(set("sheet.positive").faces, faces(0, ShellSide::Positive));
    assert_eq!(set("sheet.negative").faces, faces(0, ShellSide::Negative));
    // the edge that both have is not free, whether the set has one or both
    let free = [0, 1, 2].map(|k| faces(0, ShellSide::Edge(k))).concat();
    assert_eq!(set("sheet.edge").faces, free);
    assert_eq!(set("everything.edge").faces.len(), 6);
    assert_eq!(set("everything.positive").faces.len(), 2);
}

/// The brick is another body.
fn assert_is_consistent_without_boundary(mesh: &Mesh, shell: &Expansion) {
    assert_is_consistent(mesh, shell);
    let top = shell.mesh.sets["everything.positive"].clone();
    let nodes = shell.mesh.nodes_of(&top);
    assert!(
        nodes
            .iter()
            .all(|&n| is_close(shell.mesh.points[n as usize].z, 0.05, 1e-15))
    );
}

#[test]
fn a_mesh_without_shells_stays_as_it_is() {
    let (mesh, _) = brick_and_sheets();
    let given = BTreeMap::new();
    let joining = Joining {
        angle: Joining::ANGLE,
        given: &given,
    };
    let none = expand(&mesh, &[], &[], &joining).unwrap();
    assert_eq!(none.mesh, mesh);
    assert!(none.directors.is_empty() && none.knots.is_empty());
}

#[test]
fn edges_of_a_hole_are_free() {
    for (element, parts) in ELEMENTS {
        let mut mesh = grid(element, [4, 4], |u, v| Vec3::new(u, v, 0.0));
        // a hole of one square
        let per_square = if element.starts_with("tri") { 2 } else { 1 };
        let block = &mut mesh.blocks[0];
        let n = block.element.nnode();
        block.labels.drain(5 * per_square..6 * per_square);
        block.nodes.drain(5 * per_square * n..6 * per_square * n);
        let set = Set {
            cells: mesh.cells(2).collect(),
            ..Set::default()
        };
        mesh.sets.insert("plate".into(), set);
        let shell = with(&mesh, section(0.1, 0.0));
        let per_edge = if parts > 1 { 2 } else { 1 };
        let edge = &shell.mesh.sets["plate.edge"].faces;
        assert_eq!(edge.len(), per_edge * (16 + 4), "{element}");
    }
}
