//! What is wrong with a file is reported with its place, its cause and a remedy.

use super::*;
use std::fmt::Write as _;

/// A text mesh, what is replaced in it and by what, and the message that follows.
type Fault = (&'static str, &'static str, &'static str, &'static str);

fn assert_reported(faults: &[Fault]) {
    let mut wrong = String::new();
    for &(text, from, to, message) in faults {
        assert!(text.contains(from), "{from}");
        let found = fault(&text.replacen(from, to, 1));
        if found != message {
            writeln!(wrong, "{found}\n  instead of\n{message}").unwrap();
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn faults_of_nodes_and_elements_are_reported_with_place_cause_and_remedy() {
    assert_reported(&[
        (
            V2,
            "4 4 2 6 2 20 30 40 50",
            "4 4 2 6 2 20 30 40 51",
            "box.msh, line 24: element 4 refers to node 51, which the mesh does not have; correct the element or add the node",
        ),
        (
            V2,
            "20 1 0 0",
            "10 1 0 0",
            "box.msh, line 13: node 10 is defined a second time; give every node a number of its own",
        ),
        (
            V4,
            "10\n20\n30",
            "10\n40\n30",
            "box.msh, line 24: node 40 is defined a second time; give every node a number of its own",
        ),
        (
            V2,
            "4 4 2 6 2 20",
            "3 4 2 6 2 20",
            "box.msh, line 24: element 3 is defined a second time; give every element a number of its own",
        ),
        (
            V2,
            "10 30 20",
            "10 30 10",
            "box.msh, line 22: element 2 has node 10 twice; collapsed elements are not supported: use a type with fewer nodes",
        ),
        (
            V2,
            "3 4 2",
            "3 34 2",
            "box.msh, line 23: there is no element type `34`; supported are line2 (1), tri3 (2), quad4 (3), tet4 (4), hex8 (5), wedge6 (6), line3 (8), tri6 (9), quad8 (16), quad9 (10), tet10 (11), hex20 (17), hex27 (12), wedge15 (18)",
        ),
        (
            V4,
            "3 1 4 1",
            "2 1 4 1",
            "box.msh, line 41: elements of type 4 (tetrahedron of 4 nodes) stand in an entity of dimension 2; the block is damaged: save the mesh again",
        ),
    ]);
}

#[test]
fn faults_of_numbers_are_reported_with_place_cause_and_remedy() {
    assert_reported(&[
        (
            V2,
            "20 1 0 0",
            "20 1 nan 0",
            "box.msh, line 13: coordinate y of node 20 is nan; coordinates must be finite",
        ),
        (
            V2,
            "20 1 0 0",
            "20 1 1e400 0",
            "box.msh, line 13: coordinate y of node 20 is 1e400; coordinates must be finite",
        ),
        (
            V2,
            "20 1 0 0",
            "20 1,5 0 0",
            "box.msh, line 13: `1,5` stands where a coordinate should be in $Nodes: use a decimal point, and spaces between numbers",
        ),
        (
            V2,
            "99 5 5 5",
            "99999999999999999999 5 5 5",
            "box.msh, line 17: a node number is 99999999999999999999, which is out of range (up to 2^63 - 1); the file is truncated or damaged: correct the number or save it again",
        ),
        (
            V2,
            "99 5 5 5",
            "-99 5 5 5",
            "box.msh, line 17: a node number is -99, which is out of range (0 to 2^63 - 1); the file is truncated or damaged: correct the number or save it again",
        ),
    ]);
}

#[test]
fn faults_of_counts_are_reported_with_place_cause_and_remedy() {
    assert_reported(&[
        (
            V2,
            "3 4 2 6 1 10 20 30 40",
            "3 94 2 6 1 10 20 30 40",
            "box.msh, line 26: `$EndElements` stands where a node number should be in $Elements: the section ends before its count is met",
        ),
        (
            V2,
            "$Nodes\n6",
            "$Nodes\n7",
            "box.msh, line 18: `$EndNodes` stands where a node number should be in $Nodes: the section ends before its count is met",
        ),
        (
            V2,
            "$Nodes\n6",
            "$Nodes\n5",
            "box.msh, line 17: `99` stands where $EndNodes should be; the section holds more than its count says, or the mark is missing",
        ),
        (
            V2,
            "$Nodes\n6",
            "$Nodes\n9000000000000",
            "box.msh, line 11: the number of nodes is 9000000000000, but only 189 bytes follow; the file is truncated or damaged: correct the number or save it again",
        ),
        (
            V4,
            "3 1 0 2\n50",
            "3 1 0 1\n50",
            "box.msh, line 32: $Nodes announces 6 nodes, but its blocks hold 5; correct the count or save the mesh again",
        ),
        (
            V4,
            "4 4 1 4",
            "4 5 1 4",
            "box.msh, line 44: $Elements announces 5 elements, but its blocks hold 4; correct the count or save the mesh again",
        ),
        (
            V4,
            "4 4 1 4",
            "4 3 1 4",
            "box.msh, line 43: $Elements announces 3 elements, but its blocks hold 4; correct the count or save the mesh again",
        ),
    ]);
}

#[test]
fn faults_of_sections_are_reported_with_place_cause_and_remedy() {
    assert_reported(&[
        (
            V4,
            "4.1 0 8",
            "4 0 8",
            "box.msh, line 2: Gmsh format 4 is not supported; save as 4.1: Mesh.MshFileVersion = 4.1 (or 2.2)",
        ),
        (
            V4,
            "4.1 0 8",
            "4.1 2 8",
            "box.msh, line 2: the file type in $MeshFormat is 2, which must be 0 or 1; save the mesh again",
        ),
        (
            V4,
            "$Nodes",
            "oops\n$Nodes",
            "box.msh, line 17: `oops` stands between sections, where one such as $Nodes should start; remove it",
        ),
        (
            V2,
            "\"tip\"",
            "tip",
            "box.msh, line 6: the name of physical group 1 is not in double quotes: `tip`; write 0 1 \"name\"",
        ),
        (
            V4,
            "$EndElements\n",
            "",
            "box.msh, line 45: the file ends inside $Elements, where its end mark should follow; it is truncated: save or copy it again",
        ),
    ]);
}

#[test]
fn what_is_no_mesh_of_these_versions_is_named() {
    for (text, message) in [
        ("", "box.msh: the file is empty; was it written to the end?"),
        (
            " \n\n",
            "box.msh: the file is empty; was it written to the end?",
        ),
        (
            "$NOD\n1\n1 0 0 0\n$ENDNOD\n",
            "box.msh: Gmsh format 1 is not supported; save as 4.1: Mesh.MshFileVersion = 4.1 (or 2.2)",
        ),
        (
            "*HEADING\nblock",
            "box.msh: this is not a Gmsh mesh: it starts with `*HEADING`, not with $MeshFormat",
        ),
        (
            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n",
            "box.msh: there is no $Nodes in this file; save the whole mesh",
        ),
    ] {
        assert_eq!(fault(text), message);
    }
    let utf16: Vec<u8> = V2.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let marked = [b"\xff\xfe".as_slice(), &utf16].concat();
    assert!(matches!(read("a", &marked), Err(MeshError::Utf16 { .. })));
    assert!(matches!(read("a", &utf16), Err(MeshError::NotAMesh { .. })));
    assert!(matches!(
        read("a", &[0; 64]),
        Err(MeshError::NotAMesh { .. })
    ));
}

#[test]
fn nodes_alone_and_sections_out_of_order_are_refused() {
    let (before, elements) = V2.split_at(V2.find("$Elements").unwrap());
    assert_eq!(
        fault(before),
        "box.msh: the mesh has 6 nodes but no elements; mesh the model before saving it whole (in Gmsh: put what is to be saved into physical groups, or set Mesh.SaveAll = 1)"
    );
    let (head, nodes) = before.split_at(before.find("$Nodes").unwrap());
    assert_eq!(
        fault(&format!("{head}{elements}{nodes}")),
        "box.msh, line 10: $Elements comes before $Nodes; put $Nodes first, as Gmsh writes it"
    );
    assert_eq!(
        fault(&format!("{before}{nodes}{elements}")),
        "box.msh, line 19: a second $Nodes; a mesh has one: save it again as one model"
    );
}

#[test]
fn unsupported_solids_are_named_in_words_and_counted() {
    let pyramid = V2
        .replace("4 4 2 6 2 20 30 40 50", "4 7 2 6 2 10 20 30 40 50")
        .replace("5 4 2 9 2 20 30 40 50", "5 7 2 9 2 10 20 30 40 99");
    assert_eq!(
        fault(&pyramid),
        "box.msh, line 24: the mesh has 2 elements of type 7 (pyramid of 5 nodes): not supported yet; mesh with tetrahedra, wedges or hexahedra only"
    );
    let nodes = " 10".repeat(20);
    let cubic = V2.replace("5 4 2 9 2 20 30 40 50", &format!("5 29 2 9 2{nodes}"));
    assert_eq!(
        fault(&cubic),
        "box.msh, line 25: the mesh has 1 element of type 29 (tetrahedron of 20 nodes): not supported yet; mesh with first-order elements: Mesh.ElementOrder = 1"
    );
}

#[test]
fn damaged_binary_data_is_reported_with_its_byte() {
    let good = to_binary(V4, false, true);
    let at = |needle: &[u8]| {
        good.windows(needle.len())
            .position(|w| w == needle)
            .unwrap()
    };
    let changed = |offset: usize, bytes: &[u8]| {
        let mut bad = good.clone();
        bad[offset..offset + bytes.len()].copy_from_slice(bytes);
        read("box.msh", &bad).unwrap_err().to_string()
    };
    let mark = at(b"4.1 1 8\n") + 8;
    assert_eq!(
        changed(mark, &[7, 7, 7, 7]),
        format!(
            "box.msh, byte {mark}: the byte order mark in $MeshFormat is 117901063, which must be 1, in one byte order or the other; save the mesh again"
        )
    );
    // read in the other byte order, the number of points is 2^56
    let message = changed(mark, &[0, 0, 0, 1]);
    let entities = at(b"$Entities\n") + 10;
    assert_eq!(
        message,
        format!(
            "box.msh, byte {entities}: the number of entities is 72057594037927936, but only {} bytes follow; the file is truncated, damaged or in another byte order: save it again",
            good.len() - entities - 8
        )
    );
    let nodes = at(b"$Nodes\n") + 7 + 8;
    assert_eq!(
        changed(nodes, &u64::MAX.to_le_bytes()),
        format!(
            "box.msh, byte {nodes}: the number of nodes is 18446744073709551615, which is out of range (0 to 2^63 - 1); the file is truncated, damaged or in another byte order: save it again"
        )
    );
    let half = &good[..nodes + 60];
    let message = read("box.msh", half).unwrap_err().to_string();
    assert!(
        message.contains("only") && message.contains("bytes follow"),
        "{message}"
    );
}
