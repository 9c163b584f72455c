use super::kind::Kind;
use super::*;
use crate::readers::validate;
use std::fmt::Write as _;

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

/// Rewrites a text mesh as binary data, number by number, in the widths that the format prescribes.
struct BinaryWriter<'a> {
    words: std::str::SplitWhitespace<'a>,
    out: Vec<u8>,
    big_endian: bool,
    wide: bool,
}

impl BinaryWriter<'_> {
    fn put<const N: usize>(&mut self, little: [u8; N]) {
        let mut bytes = little;
        if self.big_endian {
            bytes.reverse();
        }
        self.out.extend(bytes);
    }

    fn int(&mut self) -> i32 {
        let value: i32 = self.words.next().unwrap().parse().unwrap();
        self.put(value.to_le_bytes());
        value
    }

    fn size(&mut self) -> u64 {
        let value: u64 = self.words.next().unwrap().parse().unwrap();
        if self.wide {
            self.put(value.to_le_bytes());
        } else {
            self.put((value as u32).to_le_bytes());
        }
        value
    }

    fn reals(&mut self, n: u64) {
        for _ in 0..n {
            let value: f64 = self.words.next().unwrap().parse().unwrap();
            self.put(value.to_le_bytes());
        }
    }

    fn ints(&mut self, n: u64) {
        (0..n).for_each(|_| _ = self.int());
    }

    fn v2_nodes(&mut self) {
        let n: u64 = self.words.next().unwrap().parse().unwrap();
        self.out.extend(format!("{n}\n").bytes());
        for _ in 0..n {
            self.int();
            self.reals(3);
        }
    }

    fn v2_elements(&mut self) {
        let n: u64 = self.words.next().unwrap().parse().unwrap();
        self.out.extend(format!("{n}\n").bytes());
        for _ in 0..n {
            let [label, kind, ntag] =
                [0; 3].map(|_: i32| self.words.next().unwrap().parse::<i32>().unwrap());
            for header in [kind, 1, ntag, label] {
                self.put(header.to_le_bytes());
            }
            let nnode = Kind::find(kind.into()).unwrap().nnode as u64;
            self.ints(ntag as u64 + nnode);
        }
    }

    fn v4_entities(&mut self) {
        let counts = [0; 4].map(|_: u64| self.size());
        for (dim, count) in counts.into_iter().enumerate() {
            for _ in 0..count {
                self.int();
                self.reals(if dim == 0 { 3 } else { 6 });
                for _ in 0..=usize::from(dim > 0) {
                    let n = self.size();
                    self.ints(n);
                }
            }
        }
    }

    fn v4_nodes(&mut self) {
        let nblock = self.size();
        (0..3).for_each(|_| _ = self.size());
        for _ in 0..nblock {
            let dim = self.int() as u64;
            self.int();
            let parametric = self.int() as u64;
            let n = self.size();
            (0..n).for_each(|_| _ = self.size());
            self.reals(n * (3 + parametric * dim));
        }
    }

    fn v4_elements(&mut self) {
        let nblock = self.size();
        (0..3).for_each(|_| _ = self.size());
        for _ in 0..nblock {
            self.ints(2);
            let nnode = Kind::find(self.int().into()).unwrap().nnode as u64;
            let n = self.size();
            (0..n * (1 + nnode)).for_each(|_| _ = self.size());
        }
    }
}

fn to_binary(text: &str, big_endian: bool, wide: bool) -> Vec<u8> {
    let mut out = Vec::new();
    let mut rest = text;
    while let Some((name, after)) = rest.strip_prefix('$').and_then(|r| r.split_once('\n')) {
        let end = format!("$End{name}\n");
        let (body, after) = after.split_once(&end).unwrap();
        rest = after;
        out.extend(format!("${name}\n").bytes());
        let mut writer = BinaryWriter {
            words: body.split_whitespace(),
            out: Vec::new(),
            big_endian,
            wide,
        };
        let v2 = text.contains("\n2.2 ");
        match name {
            "MeshFormat" => {
                let version = writer.words.next().unwrap();
                let width = if wide { 8 } else { 4 };
                writer.out.extend(format!("{version} 1 {width}\n").bytes());
                writer.put(1_i32.to_le_bytes());
            }
            "Entities" => writer.v4_entities(),
            "Nodes" if v2 => writer.v2_nodes(),
            "Nodes" => writer.v4_nodes(),
            "Elements" if v2 => writer.v2_elements(),
            "Elements" => writer.v4_elements(),
            _ => writer.out.extend(body.trim_end().bytes()),
        }
        out.append(&mut writer.out);
        out.extend(format!("\n{end}").bytes());
    }
    out
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

/// What is changed in a text mesh, and the message.
#[test]
fn faults_are_told_with_place_cause_and_remedy() {
    let cases: [(&str, &str, &str, &str); 24] = [
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
            "3 4 2 6 1 10 20 30 40",
            "3 94 2 6 1 10 20 30 40",
            "box.msh, line 26: `$EndElements` stands where a node number should be in $Elements: the section ends before its count is met",
        ),
        (
            V2,
            "3 4 2",
            "3 34 2",
            "box.msh, line 23: there is no element type `34`; supported are line2 (1), tri3 (2), quad4 (3), tet4 (4), hex8 (5), wedge6 (6), line3 (8), tri6 (9), quad8 (16), quad9 (10), tet10 (11), hex20 (17), hex27 (12), wedge15 (18)",
        ),
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
        (
            V4,
            "3 1 4 1",
            "2 1 4 1",
            "box.msh, line 41: elements of type 4 (tetrahedron of 4 nodes) stand in an entity of dimension 2; the block is damaged: save the mesh again",
        ),
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
    ];
    let mut wrong = String::new();
    for (text, from, to, message) in cases {
        assert!(text.contains(from), "{from}");
        let found = fault(&text.replacen(from, to, 1));
        if found != message {
            writeln!(wrong, "{found}\n  instead of\n{message}").unwrap();
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
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
fn damaged_binary_data_is_told_with_its_byte() {
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

#[test]
fn a_hundred_bytes_cannot_ask_for_a_hundred_gigabytes() {
    for count in ["1000000000", "999999999999", "9223372036854775807"] {
        let files = [
            format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{count}\n1 0 0 0\n"),
            format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{count}\n"),
            format!(
                "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n{count} {count} 1 {count}\n0 1 0 {count}\n"
            ),
            format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1 1 1\n0 1 0 {count}\n1\n"),
            format!(
                "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n{count} {count} 0 0\n1 0 0 0 {count} 1\n"
            ),
        ];
        for file in files {
            let error = read("bomb.msh", file.as_bytes()).unwrap_err();
            let refused = matches!(
                error,
                MeshError::TooMany { .. } | MeshError::Count { .. } | MeshError::Truncated { .. }
            );
            assert!(refused, "{error}");
        }
    }
}

#[test]
fn groups_cannot_multiply_without_bound() {
    let (ngroup, ncell) = (2000, 2000);
    let mut text =
        String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 ");
    write!(text, "{ngroup}").unwrap();
    (1..=ngroup).for_each(|g| write!(text, " {g}").unwrap());
    text += " 0\n$EndEntities\n$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n$Elements\n";
    writeln!(text, "1 {ncell} 1 {ncell}\n3 1 4 {ncell}").unwrap();
    (1..=ncell).for_each(|e| writeln!(text, "{e} 1 2 3 4").unwrap());
    text += "$EndElements\n";
    let error = read("box.msh", text.as_bytes()).unwrap_err();
    assert!(
        matches!(
            error,
            MeshError::TooManyMemberships {
                found: 4_000_000,
                ..
            }
        ),
        "{error}"
    );
}

/// The numbers of the generator `x ← 6364136223846793005 x + 1442695040888963407`.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % n.max(1)
    }
}

fn mutate_bytes(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len());
        match random.below(5) {
            0 => bytes[at] = random.below(256) as u8,
            1 => bytes[at] ^= 1 << random.below(8),
            2 => bytes.truncate(at.max(1)),
            3 => drop(bytes.drain(at..(at + random.below(20)).min(bytes.len()))),
            _ => {
                let piece = bytes[at..(at + random.below(40)).min(bytes.len())].to_vec();
                let to = random.below(bytes.len());
                bytes.splice(to..to, piece);
            }
        }
        if bytes.is_empty() {
            bytes.push(b'$');
        }
    }
}

fn mutate_words(text: &str, random: &mut Random) -> String {
    const ODD: [&str; 16] = [
        "0",
        "-1",
        "1",
        "2",
        "15",
        "4294967295",
        "9223372036854775807",
        "18446744073709551616",
        "1e308",
        "nan",
        "-inf",
        "$Nodes",
        "$EndNodes",
        "\"",
        "é",
        "",
    ];
    let mut words: Vec<&str> = text.split_inclusive([' ', '\n']).collect();
    let replaced: Vec<String> = ODD.iter().map(|w| format!("{w} ")).collect();
    for _ in 0..=random.below(3) {
        let (at, other) = (random.below(words.len()), random.below(words.len()));
        match random.below(4) {
            0 => words.swap(at, other),
            1 => drop(words.remove(at)),
            2 => words.insert(at, words[other]),
            _ => words[at] = &replaced[random.below(ODD.len())],
        }
    }
    words.concat()
}

/// Bytes that reading a damaged file of up to 14 kB may allocate, all together.
const MOST: u64 = 1 << 22;

#[test]
fn two_thousand_damaged_files_end_in_a_mesh_or_an_error_and_take_little_memory() {
    let texts = [
        V2,
        V4,
        include_str!("../../../tests/data/box_22_text.msh"),
        include_str!("../../../tests/data/box_41_partitioned.msh"),
        include_str!("../../../tests/data/brick_41_text.msh"),
    ];
    let mut binaries: Vec<Vec<u8>> = vec![
        include_bytes!("../../../tests/data/box_22_parametric_binary.msh").to_vec(),
        include_bytes!("../../../tests/data/box_41_parametric_binary.msh").to_vec(),
        to_binary(V2, true, true),
        to_binary(V4, true, true),
        to_binary(V4, false, false),
    ];
    binaries.extend(texts.map(|t| t.as_bytes().to_vec()));
    let mut random = Random(20_240_229);
    let (mut read_anyway, mut refused) = (0, 0);
    for round in 0..2000 {
        let bytes = if round % 2 == 0 {
            let mut bytes = binaries[random.below(binaries.len())].clone();
            mutate_bytes(&mut bytes, &mut random);
            bytes
        } else {
            mutate_words(texts[random.below(texts.len())], &mut random).into_bytes()
        };
        let mut result = None;
        let taken = allocation_counter::measure(|| result = Some(read("damaged.msh", &bytes)));
        assert!(taken.bytes_total < MOST, "round {round}: {taken:?}");
        match result.unwrap() {
            Ok((mesh, _)) => {
                let _ = validate(&mesh);
                read_anyway += 1;
            }
            Err(error) => {
                let message = error.to_string();
                assert!(
                    message.starts_with("damaged.msh") && message.len() < 600,
                    "{message}"
                );
                refused += 1;
            }
        }
    }
    assert!(
        read_anyway > 100 && refused > 1000,
        "{read_anyway} {refused}"
    );
}

#[test]
fn every_beginning_of_a_file_is_refused() {
    for whole in [
        V2.as_bytes().to_vec(),
        V4.as_bytes().to_vec(),
        to_binary(V2, false, true),
        to_binary(V4, true, true),
    ] {
        for end in 0..whole.len() - 1 {
            assert!(read("cut.msh", &whole[..end]).is_err(), "{end}");
        }
    }
}

/// A box of `n³` nodes, cut into hexahedra.
fn grid(n: usize, version_2: bool) -> String {
    let mut text = String::new();
    let (nnode, ncell) = (n.pow(3), (n - 1).pow(3));
    let (mut labels, mut points) = (String::new(), String::new());
    for i in 0..nnode {
        let x = [i % n, i / n % n, i / n / n].map(|k| k as f64 / (n as f64 - 1.0) + 0.1);
        let point = format!("{} {} {}", x[0], x[1], x[2]);
        if version_2 {
            writeln!(points, "{} {point}", i + 1).unwrap();
        } else {
            writeln!(labels, "{}", i + 1).unwrap();
            writeln!(points, "{point}").unwrap();
        }
    }
    if version_2 {
        write!(text, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{nnode}\n{points}$EndNodes\n$Elements\n{ncell}\n").unwrap();
    } else {
        write!(text, "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 1 1 0\n$EndEntities\n").unwrap();
        write!(text, "$Nodes\n1 {nnode} 1 {nnode}\n3 1 0 {nnode}\n{labels}{points}$EndNodes\n$Elements\n1 {ncell} 1 {ncell}\n3 1 5 {ncell}\n").unwrap();
    }
    for c in 0..ncell {
        let m = n - 1;
        let base = c % m + c / m % m * n + c / m / m * n * n + 1;
        let tags = if version_2 { " 5 2 1 1" } else { "" };
        write!(text, "{}{tags}", c + 1).unwrap();
        for k in [0, 1, n + 1, n, n * n, n * n + 1, n * n + n + 1, n * n + n] {
            write!(text, " {}", base + k).unwrap();
        }
        text.push('\n');
    }
    text + "$EndElements\n"
}

#[test]
fn a_grid_of_a_thousand_nodes_is_whole() {
    for version_2 in [true, false] {
        let (mesh, notes) = read("grid.msh", grid(10, version_2).as_bytes()).unwrap();
        assert_eq!((mesh.nnode(), mesh.ncell(), notes.len()), (1000, 729, 0));
        assert_eq!(mesh.sets["volume_1"].cells.len(), 729);
        assert_eq!(validate(&mesh), []);
    }
}

/// Allocations and bytes of reading and validating grow with the file.
#[test]
fn memory_grows_in_proportion_to_the_file() {
    for version_2 in [true, false] {
        let [small, large] = [10, 30].map(|n| {
            let text = grid(n, version_2);
            let taken = allocation_counter::measure(|| {
                let (mesh, _) = read("grid.msh", text.as_bytes()).unwrap();
                assert_eq!(mesh.nnode(), n.pow(3));
                assert_eq!(validate(&mesh), []);
            });
            taken.bytes_total as f64 / text.len() as f64
        });
        // lists double when they are full
        assert!(
            large < 2.0 * small,
            "{small}, {large} bytes per byte of the file"
        );
    }
}
