mod faults;

use super::*;
use crate::readers::validate;
use signorini_geometry::mesh::FaceIndex;
use std::fmt::Write;
use std::fs;

/// Two bricks on each other, the upper one as a wedge pair, in the ways of writing that decks have.
const SAMPLE: &str = "\
*Heading
 two bricks, *not a card
** a comment
*NODE, NSET=Nall
 1, 0, 0, 0
 2, 1., 0, 0
 3, 1.E0, 1.D0, 0
 4, , 1
*Node, NSET=NALL
 5, 0, 0, 1
 6, 1, 0, 1,
 7, 1, 1, 1
 8, 0, 1, 1
 9, 0, 0, 2
10, 1, 0, 2
11, 1, 1, 2
12, 0, 1, 2
*ELEMENT, TYPE=C3D8R,
 ELSET=Lower Part
1, 1, 2, 3, 4,
 5, 6, 7, 8
*element,type=c3d6,elset=upper
 2, 5, 6, 7, 9, 10, 11
 3, 5, 7, 8, 9, 11, 12
*NSET, NSET=bottom, GENERATE
 1, 4
*nset, nset=ODD, generate
 1, 11, 2
*NSET, NSET=both
 bottom, 12,
*ELSET, ELSET=all
 LowerPart, UPPER
*SURFACE, NAME=top
 upper, S2
*SURFACE, NAME=foot, TYPE=NODE
 BOTTOM
 5,
*SURFACE, NAME=skin
 all
*MATERIAL, NAME=steel
*ELASTIC
 210000., 0.3
*STEP
*STATIC
*BOUNDARY
 bottom, 1, 3
*NODE PRINT, NSET=Nall
 U
*END STEP
";

/// What reading took: bytes that were allocated, all together, and bytes in which ends of lines were searched for.
#[derive(Debug)]
struct Taken {
    allocated: u64,
    scanned: u64,
}

fn taken(read: impl FnOnce()) -> Taken {
    let before = lines::SCANNED.get();
    let allocated = allocation_counter::measure(read).bytes_total;
    Taken {
        allocated,
        scanned: lines::SCANNED.get() - before,
    }
}

fn read_text(text: &str) -> Result<(Mesh, Vec<String>), MeshError> {
    read("part.inp", text.as_bytes())
}

fn fault(text: &str) -> String {
    match read_text(text) {
        Ok(_) => panic!("{text}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn a_deck_gives_its_nodes_cells_and_sets() {
    let (mesh, notes) = read_text(SAMPLE).unwrap();
    println!("{notes:?}");
    assert_eq!((mesh.nnode(), mesh.ncell(), mesh.dim()), (12, 3, 3));
    assert_eq!(mesh.points[3].to_array(), [0.0, 1.0, 0.0]);
    let nodes = |name: &str| {
        let nodes = mesh.nodes_of(&mesh.sets[name]).into_iter();
        nodes
            .map(|n| mesh.node_labels[n as usize])
            .collect::<Vec<_>>()
    };
    assert_eq!(nodes("bottom"), [1, 2, 3, 4]);
    assert_eq!(nodes("ODD"), [1, 3, 5, 7, 9, 11]);
    assert_eq!(nodes("both"), [1, 2, 3, 4, 12]);
    assert_eq!(nodes("Nall").len(), 12);
    assert_eq!(nodes("top"), [9, 10, 11, 12]);
    assert_eq!(nodes("foot"), [1, 2, 3, 4, 5]);
    assert_eq!(mesh.sets["Lower Part"].cells.len(), 1);
    assert_eq!(mesh.sets["all"].cells.len(), 3);
    // 6 + 2 · 5 sides, without the two bricks' common ones: one of the lower, and of the wedges 2 + 2
    assert_eq!(mesh.sets["skin"].faces.len(), 6 + 2 * 5 - 2);
    assert_eq!(validate(&mesh), []);
    let index = FaceIndex::new(&mesh, mesh.cells(3));
    assert_eq!(mesh.faces(&mesh.sets["top"], &index).unwrap().len(), 2);
}

#[test]
fn line_ends_and_marks_do_not_matter() {
    let (mesh, _) = read_text(SAMPLE).unwrap();
    for text in [
        SAMPLE.replace('\n', "\r\n"),
        SAMPLE.replace('\n', "\r"),
        SAMPLE.replace('\n', "\n\n"),
        format!("\u{feff}{SAMPLE}"),
        SAMPLE.trim_end().to_owned(),
    ] {
        assert_eq!(read_text(&text).unwrap().0, mesh);
    }
    let utf16: Vec<u8> = (b"\xff\xfe".iter().copied())
        .chain(SAMPLE.bytes().flat_map(|b| [b, 0]))
        .collect();
    let error = read("part.inp", &utf16).unwrap_err();
    assert!(matches!(error, MeshError::Utf16 { .. }), "{error}");
}

#[test]
fn a_node_written_twice_at_one_place_is_one_node() {
    let again = SAMPLE.replacen("NSET=NALL\n", "NSET=NALL\n 2, 1, 0, 0\n", 1);
    assert_eq!(read_text(&again).unwrap().0.nnode(), 12);
}

#[test]
fn text_before_the_first_keyword_is_ignored_with_a_note() {
    let (mesh, notes) = read_text(&format!(">** made by hand\n1, 2\n{SAMPLE}")).unwrap();
    assert_eq!(mesh, read_text(SAMPLE).unwrap().0);
    let note = "part.inp, line 1: `>** made by hand` and what follows stands before the first keyword: ignored";
    assert_eq!(notes[0], note);
}

#[test]
fn files_are_included_where_they_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let read = || {
        let path = folder.path().join("Main.inp");
        read(&path.display().to_string(), &fs::read(&path).unwrap())
    };
    let at = SAMPLE.find(" 5, 0, 0, 1").unwrap();
    let (head, tail) = SAMPLE.split_at(at);
    fs::create_dir(folder.path().join("sub dir")).unwrap();
    write(
        "Main.inp",
        &format!("{head}*Include,\n INPUT=sub dir/Nodes.txt"),
    );
    write(
        "sub dir/Nodes.txt",
        &format!(
            "** data of the card before\n{}*INCLUDE, INPUT=rest.inp",
            &tail[..37]
        ),
    );
    write("sub dir/rest.inp", &tail[37..]);
    assert_eq!(read().unwrap().0, read_text(SAMPLE).unwrap().0);
    // data of one card
    let with_data = SAMPLE
        .replace(" 1, 4\n*nset", "*nset")
        .replace("NSET=bottom,", "NSET=bottom, INPUT=n.txt,");
    write("Main.inp", &with_data);
    write("n.txt", "1, 4");
    assert_eq!(read().unwrap().0, read_text(SAMPLE).unwrap().0);
    // faults have the line of their own file
    write("n.txt", "1, 4\n5, x");
    let error = read().unwrap_err().to_string();
    assert!(
        error.contains("n.txt, line 2: `x` stands where a node number"),
        "{error}"
    );
    write("Main.inp", "*NODE\n*INCLUDE, INPUT=Main.inp");
    let error = read().unwrap_err().to_string();
    assert!(
        error.contains("Main.inp, line 2: the file `Main.inp` includes itself"),
        "{error}"
    );
    write("Main.inp", "*INCLUDE, INPUT=0.inp");
    for i in 0..200 {
        let next = i + 1;
        write(
            &format!("{i}.inp"),
            &format!("*INCLUDE, INPUT={next}.inp\n*INCLUDE, INPUT={next}.inp"),
        );
    }
    let error = read().unwrap_err().to_string();
    assert!(
        error.contains("8.inp, line 1: files include each other more than 10 deep"),
        "{error}"
    );
    // 50^8 files are too many, and are not read
    for i in 0..8 {
        write(
            &format!("{i}.inp"),
            &format!("*INCLUDE, INPUT={}.inp\n", i + 1).repeat(50),
        );
    }
    write("8.inp", &"** nothing\n".repeat(100_000));
    let mut result = None;
    let taken = taken(|| result = Some(read()));
    let error = result.unwrap().unwrap_err().to_string();
    assert!(error.contains("come to more than"), "{error}");
    // each byte of 2^28 that files included again may come to, once
    assert!(
        taken.scanned < 1 << 29 && taken.allocated < 1 << 24,
        "{taken:?}"
    );
}

const ASSEMBLY: &str = "\
*PART, NAME=Cube
*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
*ELEMENT, TYPE=C3D8
1, 1, 2, 3, 4, 5, 6, 7, 8
*NSET, NSET=base, GENERATE
1, 4
*ELSET, ELSET=Set-1
1
*END PART
*ASSEMBLY, NAME=A
*INSTANCE, NAME=Low-1, PART=Cube
*END INSTANCE
*INSTANCE, NAME=Top-1, PART=cube
 0, 0, 3
 0, 0, 3, 0, 1, 3, 90
*NODE
9, 0, 0, 5
*END INSTANCE
*NODE
1, 9, 9, 9
*NSET, NSET=ref
1
*NSET, NSET=Low-1, INSTANCE=Low-1
base, 8
*NSET, NSET=few
Top-1.base, Low-1.5
*ELSET, ELSET=all
Low-1.Set-1, Top-1.1
*SURFACE, NAME=S
Top-1.Set-1, S1
*END ASSEMBLY
*STEP
*END STEP
";

#[test]
fn instances_are_copies_of_their_part_in_their_place() {
    let (mesh, notes) = read_text(ASSEMBLY).unwrap();
    assert_eq!((mesh.nnode(), mesh.ncell()), (8 + 9 + 1, 2));
    let names: Vec<&String> = mesh.sets.keys().collect();
    assert_eq!(
        names,
        [
            "Low-1",
            "Low-1.Set-1",
            "Low-1.base",
            "S",
            "Top-1",
            "Top-1.Set-1",
            "Top-1.base",
            "all",
            "few",
            "ref"
        ]
    );
    let labels = |name: &str| {
        let nodes = mesh.nodes_of(&mesh.sets[name]).into_iter();
        nodes
            .map(|n| mesh.node_labels[n as usize])
            .collect::<Vec<_>>()
    };
    assert_eq!(labels("Low-1.base"), [1, 2, 3, 4]);
    assert_eq!(labels("Top-1.base"), [9, 10, 11, 12]);
    assert_eq!(labels("few"), [5, 9, 10, 11, 12]);
    assert_eq!(labels("Low-1"), [1, 2, 3, 4, 8]);
    assert_eq!(labels("ref"), [18]);
    assert_eq!(mesh.sets["all"].cells.len(), 2);
    // (1, 0, 0) is moved to (1, 0, 3) and turned about the line through (0, 0, 3) along y
    let turned = mesh.points[9].to_array();
    for (got, expected) in turned.iter().zip([0.0, 0.0, 2.0]) {
        assert!((got - expected).abs() < 1e-15, "{turned:?}");
    }
    assert_eq!(mesh.points[16].to_array(), [0.0, 0.0, 5.0]);
    assert_eq!(
        validate(&mesh),
        [crate::readers::MeshIssue::Unreferenced { count: 1 }]
    );
    assert!(
        notes.contains(&"the nodes of instance `Top-1` have their own numbers plus 8".into()),
        "{notes:?}"
    );
    for (from, to, expected) in [
        (
            "PART=cube",
            "PART=cub",
            "line 22: there is no part `cub`; there are CUBE",
        ),
        (
            "NAME=Top-1",
            "NAME=LOW-1",
            "line 22: a second instance is called `LOW-1`",
        ),
        (
            "*END PART\n",
            "",
            "line 17: *INSTANCE stands inside another part or instance",
        ),
        (
            "Top-1.base",
            "Top-1.bas",
            "there is no node set `Top-1.bas`",
        ),
        ("INSTANCE=Low-1", "INSTANCE=Lo", "there is no instance `Lo`"),
    ] {
        let error = fault(&ASSEMBLY.replacen(from, to, 1));
        assert!(
            error.contains(expected) || expected.starts_with("line"),
            "{error}"
        );
    }
}

#[test]
fn sets_of_one_name_stay_apart_unless_they_mean_the_same() {
    let text = SAMPLE
        .replace("NSET=bottom", "NSET=upper")
        .replace("bottom", "upper")
        .replace("BOTTOM", "upper")
        .replace("NAME=top", "NAME=upper");
    let (mesh, notes) = read_text(&text).unwrap();
    assert_eq!(mesh.sets["upper"].cells.len(), 2);
    assert_eq!(mesh.sets["upper.faces"].faces.len(), 2);
    assert_eq!(mesh.sets["upper.nodes"].nodes, [0, 1, 2, 3]);
    assert!(
        notes
            .contains(&"node set `upper` is called `upper.nodes`: another set has its name".into()),
        "{notes:?}"
    );
    let same = SAMPLE.replace("NSET=Nall", "NSET=all");
    assert_eq!(read_text(&same).unwrap().0.sets["all"].nodes, [0; 0]);
}

#[test]
fn few_lines_cannot_ask_for_much_memory() {
    let mut doubling = SAMPLE.replace("*MATERIAL", "*NSET, NSET=n0\nNall\n*MATERIAL");
    let mut more = String::new();
    for i in 1..60 {
        let _ = write!(more, "*NSET, NSET=n{i}\nn{0}, n{0}\n", i - 1);
    }
    doubling = doubling.replace("*MATERIAL", &format!("{more}*MATERIAL"));
    assert!(
        fault(&doubling).contains("the sets come to more than"),
        "{}",
        fault(&doubling)
    );
    let ranges = SAMPLE.replace(" 1, 4\n", &" 1, 18446744073709551615\n".repeat(1000));
    assert_eq!(read_text(&ranges).unwrap().0.sets["bottom"].nodes.len(), 12);
    let cards = "*ELSET, ELSET=e\nall, all, all, all\n*SURFACE, NAME=s\nall, S1\n".repeat(20_000);
    let many = SAMPLE.replace("*MATERIAL", &format!("{cards}*MATERIAL"));
    let taken_by_many = taken(|| drop(read_text(&many)));
    let nodes: String = (0..10_000).fold(String::new(), |mut s, i| {
        let _ = writeln!(s, "{}, 0, 0, 0", i + 100);
        s
    });
    let mut instances = String::new();
    for i in 0..20_000 {
        let _ = write!(
            instances,
            "*INSTANCE, NAME=i{i}, PART=Cube\n*END INSTANCE\n"
        );
    }
    let copies = ASSEMBLY
        .replacen("1, 0, 0, 0\n", &format!("1, 0, 0, 0\n{nodes}"), 1)
        .replacen("*INSTANCE", &format!("{instances}*INSTANCE"), 1);
    let mut message = String::new();
    let taken_by_copies = taken(|| message = fault(&copies));
    assert!(message.contains("the copies of parts come to more than"));
    for (taken, text) in [(taken_by_many, &many), (taken_by_copies, &copies)] {
        let size = text.len() as u64;
        assert!(taken.scanned < 4 * size, "{taken:?} of {size}");
        assert!(taken.allocated < 1 << 30, "{taken:?} of {size}");
    }
}

#[test]
fn long_lines_and_many_empty_ones_are_scanned_a_few_times() {
    let long: String = (1..=150_000).fold(String::new(), |mut s, i| {
        let _ = write!(s, "{}, ", i % 12 + 1);
        s
    });
    let long = SAMPLE.replace(" bottom, 12,", &long);
    let (mesh, _) = read_text(&long).unwrap();
    assert_eq!(mesh.sets["both"].nodes.len(), 12);
    let empty = SAMPLE.replace("*MATERIAL", &("\n".repeat(10_000_000) + "*MATERIAL"));
    let stars = "*".repeat(1_000_000);
    let stars = SAMPLE.replace("*MATERIAL", &format!("{stars}\n*MATERIAL"));
    for text in [long, empty, stars] {
        let taken = taken(|| drop(read_text(&text).unwrap()));
        let size = text.len() as u64;
        assert!(taken.scanned < 4 * size, "{taken:?} of {size}");
        assert!(taken.allocated < 32 * size, "{taken:?} of {size}");
    }
}

#[test]
fn every_beginning_of_a_deck_ends_in_a_mesh_or_an_error() {
    for text in [SAMPLE, ASSEMBLY] {
        for end in 0..text.len() {
            let _ = read("part.inp", &text.as_bytes()[..end]);
        }
    }
}

#[test]
fn five_thousand_damaged_decks_end_in_a_mesh_or_an_error_and_take_little_memory() {
    const WORDS: [&str; 24] = [
        "*NODE",
        "*ELEMENT, TYPE=C3D8",
        "*NSET, NSET=a",
        "*ELSET, ELSET=a, GENERATE",
        "*SURFACE, NAME=s",
        "*PART, NAME=p",
        "*INSTANCE, NAME=i, PART=p",
        "*END PART",
        "*END INSTANCE",
        "*INCLUDE, INPUT=.",
        ",",
        "\n",
        "\"",
        "=",
        "*",
        "**",
        "S9",
        "-1",
        "0",
        "18446744073709551615",
        "1e400",
        "4294967296",
        "\u{0}",
        "é",
    ];
    let mut state = 7_u64;
    let mut below = |n: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as usize) % n.max(1)
    };
    let (mut good, mut bad, mut most) = (0, 0, 0);
    for i in 0..5000 {
        let mut bytes = [SAMPLE, ASSEMBLY][i % 2].as_bytes().to_vec();
        for _ in 0..=below(4) {
            let at = below(bytes.len());
            match below(6) {
                0 => bytes.truncate(at),
                1 => bytes[at..]
                    .iter_mut()
                    .take(1)
                    .for_each(|b| *b ^= 1 << below(8)),
                2 => drop(bytes.splice(at..at, WORDS[below(WORDS.len())].bytes())),
                3 => {
                    let mut lines: Vec<&[u8]> = bytes.split(|&b| b == b'\n').collect();
                    let (from, to) = (below(lines.len()), below(lines.len()));
                    if below(2) == 0 {
                        lines.swap(from, to);
                    } else {
                        lines.remove(from);
                    }
                    bytes = lines.join(&b'\n');
                }
                4 => {
                    let end = (at + below(60)).min(bytes.len());
                    let piece = bytes[at..end].to_vec();
                    let to = below(bytes.len());
                    bytes.splice(to..to, piece);
                }
                _ => {
                    let mut words: Vec<&[u8]> = bytes.split(|&b| b == b',').collect();
                    let word = below(words.len());
                    words[word] = WORDS[below(WORDS.len())].as_bytes();
                    bytes = words.join(&b',');
                }
            }
            if bytes.is_empty() {
                break;
            }
        }
        let mut result = None;
        let taken = taken(|| result = Some(read("part.inp", &bytes)));
        most = most.max(taken.allocated + taken.scanned);
        match result.unwrap() {
            Ok((mesh, _)) => {
                good += 1;
                let nnode = mesh.nnode() as u32;
                assert!(
                    mesh.blocks
                        .iter()
                        .flat_map(|b| &b.nodes)
                        .all(|&n| n < nnode)
                );
                assert_eq!(mesh.nnode(), mesh.node_labels.len());
            }
            Err(error) => {
                bad += 1;
                assert!(error.to_string().contains("part.inp"), "{error}");
            }
        }
    }
    println!("{good} meshes, {bad} errors, at most {most} bytes");
    assert!(most < 1 << 20, "{most}");
    assert!(good > 400 && bad > 1000, "{good} meshes, {bad} errors");
}

/// `n³` bricks.
fn grid(n: usize) -> String {
    let mut text = String::from("*NODE, NSET=all\n");
    let node = |i: usize, j: usize, k: usize| 1 + i + (n + 1) * (j + (n + 1) * k);
    for k in 0..=n {
        for j in 0..=n {
            for i in 0..=n {
                let x = [i, j, k].map(|i| i as f64 / n as f64);
                let _ = writeln!(
                    text,
                    "{:8}, {:.9e}, {:.9e}, {:.9e}",
                    node(i, j, k),
                    x[0],
                    x[1],
                    x[2]
                );
            }
        }
    }
    text += "*ELEMENT, TYPE=C3D8, ELSET=box\n";
    for k in 0..n {
        for j in 0..n {
            for i in 0..n {
                let [a, b] = [k, k + 1].map(|k| {
                    [
                        node(i, j, k),
                        node(i + 1, j, k),
                        node(i + 1, j + 1, k),
                        node(i, j + 1, k),
                    ]
                });
                let number = 1 + i + n * (j + n * k);
                let _ = writeln!(
                    text,
                    "{number}, {}, {}, {}, {}, {}, {}, {}, {}",
                    a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]
                );
            }
        }
    }
    text
}

#[test]
fn memory_and_scanning_grow_in_proportion_to_the_deck() {
    let [small, large] = [10, 30].map(|n| {
        let text = grid(n);
        let taken = taken(|| {
            let (mesh, _) = read_text(&text).unwrap();
            assert_eq!((mesh.nnode(), mesh.ncell()), ((n + 1).pow(3), n.pow(3)));
        });
        let per_byte = |n: u64| n as f64 / text.len() as f64;
        [per_byte(taken.allocated), per_byte(taken.scanned)]
    });
    println!("{small:?}, {large:?}");
    // lists double when they are full
    assert!(large[0] < 2.0 * small[0], "{small:?}, {large:?}");
    assert!(large[1] < 1.1 * small[1], "{small:?}, {large:?}");
}

#[test]
fn a_node_without_coordinates_is_at_the_origin_and_nodes_for_modes_are_passed_over() {
    let text = "*NODE\n1\n2,1\n3,1,1\n4,,1\n5,,,1\n6,1,,1\n7,1,1,1\n8,,1,1\n\
                *ELEMENT, TYPE=C3D8I, ELSET=E\n1,1,2,3,4,5,6,7,8,9,10,\n";
    let (mesh, _) = read_text(text).unwrap();
    assert_eq!(mesh.points[0].to_array(), [0.0; 3]);
    assert_eq!(mesh.points[7].to_array(), [0.0, 1.0, 1.0]);
    assert_eq!(mesh.blocks[0].nodes, [0, 1, 2, 3, 4, 5, 6, 7]);
    let more = text.replace("9,10,\n", "9,10,11,12\n");
    let message = fault(&more);
    assert!(
        message.contains("element 1 has 12 nodes; a C3D8I has 8"),
        "{message}"
    );
}
