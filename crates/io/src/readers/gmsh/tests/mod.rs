mod binary;
mod damage;
mod faults;
mod size;

use super::*;
use binary::to_binary;

/// Two tetrahedra on a common triangle, one triangle, one marked node, and a node that nothing uses.
const V2: &str = "$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
0 1 \"tip\"
2 5 \"the base\"
3 6 \"körper\"
$EndPhysicalNames
$Nodes
6
10 0 0 0
20 1 0 0
30 0 1 0
40 0 0 1
50 1 1 1
99 5 5 5
$EndNodes
$Elements
5
1 15 2 1 4 40
2 2 2 5 7 10 30 20
3 4 2 6 1 10 20 30 40
4 4 2 6 2 20 30 40 50
5 4 2 9 2 20 30 40 50
$EndElements
";

/// The same, its second tetrahedron in two groups by its entity.
const V4: &str = "$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
0 1 \"tip\"
2 5 \"the base\"
3 6 \"körper\"
$EndPhysicalNames
$Entities
1 0 1 2
4 0 0 1 1 1
7 0 0 0 1 1 0 1 -5 0
1 0 0 0 1 1 1 1 6 1 7
2 0 0 0 1 1 1 2 6 9 1 -7
$EndEntities
$Nodes
3 6 10 99
0 4 0 1
40
0 0 1
2 7 1 3
10
20
30
0 0 0 0.5 0.5
1 0 0 0.5 0.5
0 1 0 0.5 0.5
3 1 0 2
50
99
1 1 1
5 5 5
$EndNodes
$Elements
4 4 1 4
0 4 15 1
1 40
2 7 2 1
2 10 30 20
3 1 4 1
3 10 20 30 40
3 2 4 1
4 20 30 40 50
$EndElements
";

fn fault(text: &str) -> String {
    read("box.msh", text.as_bytes()).unwrap_err().to_string()
}

fn assert_is_the_sample(mesh: &Mesh, notes: &[String]) {
    let mut nodes: Vec<(u64, [f64; 3])> = mesh
        .node_labels
        .iter()
        .copied()
        .zip(mesh.points.iter().map(|x| x.to_array()))
        .collect();
    nodes.sort_by_key(|n| n.0);
    let expected = [
        (10, [0.0, 0.0, 0.0]),
        (20, [1.0, 0.0, 0.0]),
        (30, [0.0, 1.0, 0.0]),
        (40, [0.0, 0.0, 1.0]),
        (50, [1.0, 1.0, 1.0]),
        (99, [5.0, 5.0, 5.0]),
    ];
    assert_eq!(nodes, expected);
    let labels =
        |ids: &[u32]| -> Vec<u64> { ids.iter().map(|&n| mesh.node_labels[n as usize]).collect() };
    let cells = |name: &str| -> Vec<(u64, Vec<u64>)> {
        let cells = mesh.sets[name].cells.iter();
        cells
            .map(|&c| (mesh.cell_label(c).unwrap(), labels(mesh.cell(c))))
            .collect()
    };
    assert_eq!(
        mesh.sets.keys().collect::<Vec<_>>(),
        ["körper", "the base", "tip", "volume_9"]
    );
    let (first, second) = ((3, vec![10, 20, 30, 40]), (4, vec![20, 30, 40, 50]));
    assert_eq!(cells("körper"), [first, second.clone()]);
    assert_eq!(cells("volume_9"), [second]);
    assert_eq!(cells("the base"), [(2, vec![10, 30, 20])]);
    assert_eq!(labels(&mesh.sets["tip"].nodes), [40]);
    assert_eq!((mesh.ncell(), mesh.dim()), (3, 3));
    assert_eq!(notes, ["1 node without elements, ignored"]);
}

#[test]
fn both_versions_in_text_give_the_same_mesh() {
    for text in [V2, V4] {
        let (mesh, notes) = read("box.msh", text.as_bytes()).unwrap();
        assert_is_the_sample(&mesh, &notes);
    }
}

#[test]
fn binary_data_of_either_byte_order_gives_the_same_mesh() {
    for text in [V2, V4] {
        for big_endian in [false, true] {
            let bytes = to_binary(text, big_endian, true);
            let (mesh, notes) = read("box.msh", &bytes).unwrap();
            assert_is_the_sample(&mesh, &notes);
        }
    }
    let narrow = to_binary(V4, false, false);
    let (mesh, notes) = read("box.msh", &narrow).unwrap();
    assert_is_the_sample(&mesh, &notes);
}

#[test]
fn line_ends_marks_and_white_space_do_not_matter() {
    for text in [V2, V4] {
        for changed in [
            text.replace('\n', "\r\n"),
            text.replace('\n', "\r"),
            format!("\u{feff}{text}"),
            text.replace(" 0 ", "\t 0  "),
            format!("$Comments\nmade by hand; $5\n$EndComments\n{text}"),
        ] {
            let (mesh, notes) = read("box.msh", changed.as_bytes()).unwrap();
            assert_is_the_sample(&mesh, &notes);
        }
    }
}

#[test]
fn other_sections_are_stepped_over_and_noted() {
    let extra =
        "$Periodic\n1\n0 1 2\n1\n1 2\n$EndPeriodic\n$NodeData\n1\n\"$EndOfWorld\"\n$EndNodeData\n";
    let (mesh, notes) = read("box.msh", format!("{V4}{extra}").as_bytes()).unwrap();
    assert_eq!(notes[0], "ignored: $NodeData, $Periodic");
    assert_is_the_sample(&mesh, &notes[1..]);
}

#[test]
fn names_are_kept_letter_by_letter() {
    let long = "long ".repeat(5000);
    for name in ["Körper", "körper ", " a \"quoted\" b", "面", &long] {
        let text = V2.replace("körper", name);
        let (mesh, _) = read("box.msh", text.as_bytes()).unwrap();
        assert_eq!(mesh.sets[name].cells.len(), 2);
    }
    let mut latin = V2.replace("körper", "k#rper").into_bytes();
    let at = latin.iter().position(|&b| b == b'#').unwrap();
    latin[at] = 0xf6;
    let (mesh, notes) = read("box.msh", &latin).unwrap();
    assert!(mesh.sets.contains_key("körper"));
    assert!(notes[0].contains("Latin-1"), "{notes:?}");
}

#[test]
fn groups_of_one_name_are_one_set_and_empty_groups_stay() {
    let text = V2
        .replace("the base", "tip")
        .replace("3\n0 1", "4\n1 3 \"nothing\"\n0 1");
    let (mesh, notes) = read("box.msh", text.as_bytes()).unwrap();
    let tip = &mesh.sets["tip"];
    assert_eq!((tip.nodes.len(), tip.cells.len()), (1, 1));
    assert!(mesh.sets["nothing"].is_empty());
    assert_eq!(
        notes[1..],
        [
            "the physical group `nothing` is empty",
            "several physical groups are called `tip`; they are one set"
        ]
    );
}

#[test]
fn unsupported_cells_below_the_solids_are_left_out_with_a_note() {
    // a four-node line on two entities, one of them in a group
    let text = V2.replace("$Elements\n5", "$Elements\n7").replace(
        "1 15 2",
        "8 26 2 3 1 10 20 30 40\n9 26 2 0 1 10 20 30 40\n1 15 2",
    );
    let (mesh, notes) = read("box.msh", text.as_bytes()).unwrap();
    assert_eq!(
        notes[0],
        "2 elements of type 26 (line of 4 nodes) left out: not supported yet; missing from `curve_3`"
    );
    assert_eq!(mesh.ncell(), 3);
}
