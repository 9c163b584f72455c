//! What cannot be expanded.

use super::*;
use crate::mesh::Set;

fn unit() -> Mesh {
    grid("quad4", [2, 1], |u, v| Vec3::new(2.0 * u, v, 0.0))
}

fn text(mesh: &Mesh, section: Section<'_>) -> String {
    try_with(mesh, section).unwrap_err().to_string()
}

fn assert_has(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "{text:?} lacks {part:?}");
    }
}

#[test]
fn what_is_no_shell_is_named() {
    let mut mesh = unit();
    let line = mesh.push_cell(by_name("line2").unwrap(), &[0, 1], 77);
    let given = BTreeMap::new();
    let joining = Joining {
        angle: Joining::ANGLE,
        given: &given,
    };
    let section_ = [section(0.1, 0.0)];
    let of = |cells: &[ShellCell]| expand(&mesh, cells, &section_, &joining).unwrap_err();
    let shell = |cell, section| ShellCell { cell, section };
    let cell = |index| CellId { block: 0, index };
    let not = ExpansionError::NotAShell {
        label: 77,
        element: "line2",
    };
    assert_eq!(of(&[shell(line, 0)]), not);
    let twice = ExpansionError::Twice { label: 2 };
    assert_eq!(of(&[shell(cell(1), 0), shell(cell(1), 0)]), twice);
    let none = ExpansionError::NoSuchCell { shell: 1 };
    assert_eq!(of(&[shell(cell(1), 0), shell(cell(2), 0)]), none);
    let (label, section) = (1, 1);
    let none = ExpansionError::NoSuchSection { label, section };
    assert_eq!(of(&[shell(cell(0), 1)]), none);
    mesh.blocks[0].nodes[2] = 99;
    let cells = [shell(cell(0), 0)];
    let none = ExpansionError::NoSuchNode { label: 1 };
    assert_eq!(
        expand(&mesh, &cells, &section_, &joining).unwrap_err(),
        none
    );
}

#[test]
fn thickness_must_be_positive() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let found = try_with(&unit(), section(bad, 0.0)).unwrap_err();
        assert!(matches!(
            found,
            ExpansionError::Thickness {
                label: 1,
                node: 7,
                ..
            }
        ));
    }
    let mesh = unit();
    let mut at_nodes = vec![0.1; mesh.nnode()];
    at_nodes[4] = -0.2;
    let nodal = Section {
        thickness: 0.1,
        at_nodes: Some(&at_nodes),
        offset: 0.0,
    };
    let name = label(4).to_string();
    assert_has(
        &text(&mesh, nodal),
        &["element 2", &name, "-0.2", "positive"],
    );
    assert_has(
        &text(&mesh, section(0.1, f64::NAN)),
        &["offset", "element 1", "finite"],
    );
}

#[test]
fn a_thickness_that_is_not_positive_inside_is_named_by_the_thinnest_node() {
    let mesh = grid("quad8", [1, 1], |u, v| Vec3::new(u, v, 0.0));
    // the centre has half of the mids, less a quarter of the corners
    let at_nodes: Vec<f64> = (0..8)
        .map(|n| {
            if n < 4 {
                1.0
            } else {
                0.4 + 0.01 * f64::from(n)
            }
        })
        .collect();
    let nodal = Section {
        thickness: 1.0,
        at_nodes: Some(&at_nodes),
        offset: 0.0,
    };
    assert_has(&text(&mesh, nodal), &["element 1", &label(4).to_string()]);
}

#[test]
fn a_cell_without_area_is_named() {
    for (element, _) in ELEMENTS {
        let mesh = grid(element, [2, 1], |u, _| Vec3::new(2.0 * u, u, 0.0));
        let found = try_with(&mesh, section(0.1, 0.0)).unwrap_err();
        assert!(
            matches!(found, ExpansionError::NoArea { label: 1, .. }),
            "{found}"
        );
    }
    // an edge without length
    let mut mesh = unit();
    mesh.points[1] = mesh.points[0];
    assert_has(&text(&mesh, section(0.1, 0.0)), &["element 1", "no area"]);
}

#[test]
fn concave_and_crossed_cells_are_named() {
    let mut concave = unit();
    let corner = concave.blocks[0].nodes[2] as usize;
    concave.points[corner] = Vec3::new(0.3, 0.3, 0.0);
    let found = text(&concave, section(0.01, 0.0));
    assert_has(
        &found,
        &["element 1", "concave", &label(corner).to_string()],
    );
    let mut crossed = unit();
    crossed.blocks[0].nodes.swap(2, 3);
    assert_has(
        &text(&crossed, section(0.01, 0.0)),
        &["element 1", "concave"],
    );
}

#[test]
fn a_shell_that_is_bent_too_tightly_is_named_with_its_radius() {
    // a cylinder of radius 1, whose normals point outwards
    let bent = |n: u32| {
        grid("quad4", [n, 1], |u, v| {
            let angle = 3.0 * u;
            Vec3::new(angle.sin(), v, angle.cos())
        })
    };
    let mesh = bent(24);
    assert!(try_with(&mesh, section(1.9, 0.0)).is_ok());
    let found = try_with(&mesh, section(2.1, 0.0)).unwrap_err();
    let ExpansionError::InsideOut {
        radius,
        depth,
        face: "negative",
        ..
    } = found
    else {
        panic!("{found}");
    };
    assert!(is_close(radius, 1.0, 0.05), "{radius}");
    assert!(is_close(depth, 1.05, 1e-12), "{depth}");
    // with the nodes on the negative face it is right
    assert!(try_with(&mesh, section(2.1, -0.5)).is_ok());
    assert!(try_with(&mesh, section(1.05, 0.5)).is_err());
    let text = found.to_string();
    assert_has(&text, &["element 2", "node", "radius", "negative face"]);
}

#[test]
fn prescribed_normals_must_leave_the_shell_on_its_positive_side() {
    let mesh = unit();
    let of = |normal: Vec3| {
        let cell = CellId { block: 0, index: 1 };
        let given = BTreeMap::from([((cell, 4), normal)]);
        let joining = Joining {
            angle: Joining::ANGLE,
            given: &given,
        };
        expand(&mesh, &all(&mesh), &[section(0.01, 0.0)], &joining)
    };
    assert!(of(Vec3::new(0.3, 0.0, 1.0)).is_ok());
    let (label, node) = (2, label(4));
    let reversed = ExpansionError::Reversed { label, node };
    assert_eq!(of(-Vec3::unit(2)).unwrap_err(), reversed);
    let none = ExpansionError::NoDirection { label, node };
    assert_eq!(of(Vec3::ZERO).unwrap_err(), none);
}

#[test]
fn names_of_sides_must_be_free() {
    let mut mesh = unit();
    let cells = mesh.cells(2).collect();
    let set = Set {
        cells,
        ..Set::default()
    };
    mesh.sets.insert("sheet".into(), set);
    mesh.sets.insert("sheet.edge".into(), Set::default());
    assert_has(
        &text(&mesh, section(0.1, 0.0)),
        &["sheet.edge", "\"sheet\"", "rename"],
    );
}
