//! What is wrong with a deck is reported with its line.

use super::*;

/// Changes of the sample, as what is replaced and by what, and how the message starts that follows.
fn assert_reported(changes: &[(&str, &str, &str)]) {
    for &(from, to, expected) in changes {
        assert!(SAMPLE.contains(from), "{from}");
        let message = fault(&SAMPLE.replacen(from, to, 1));
        assert!(message.starts_with(expected), "{message}\n{expected}");
    }
}

#[test]
fn faults_of_numbers_and_coordinates_are_reported_with_their_line() {
    assert_reported(&[
        (
            " 3, 1.E0",
            " 3, five",
            "part.inp, line 7: `five` stands where a coordinate should be in *NODE",
        ),
        (
            " 3, 1.E0",
            " 3, 1e400",
            "part.inp, line 7: coordinate x of node 3 is 1e400; coordinates must be finite",
        ),
        (
            " 3, 1.E0",
            " 3, nan",
            "part.inp, line 7: `nan` stands where a coordinate should be in *NODE",
        ),
        (
            " 3, 1.E0",
            " 3.5, 1.E0",
            "part.inp, line 7: `3.5` stands where a node number should be in *NODE",
        ),
        (
            " 1, 4\n",
            " 4, 1\n",
            "part.inp, line 26: the range of GENERATE is 4, 1, 1, which is out of range (first, last ≥ first, step ≥ 1); the file is truncated or damaged: correct the number or save it again",
        ),
    ]);
}

#[test]
fn faults_of_nodes_and_elements_are_reported_with_their_line() {
    assert_reported(&[
        (
            " 7, 1, 1, 1",
            " 6, 1, 1, 1",
            "part.inp, line 12: node 6 is defined a second time; give every node a number of its own",
        ),
        (
            " 3, 5, 7, 8",
            " 2, 5, 7, 8",
            "part.inp, line 24: element 2 is defined a second time; give every element a number of its own",
        ),
        (
            "9, 10, 11\n",
            "9, 10, 99\n",
            "part.inp, line 23: element 2 refers to node 99, which the mesh does not have; correct the element or add the node",
        ),
        (
            "9, 10, 11\n",
            "9, 10, 10\n",
            "part.inp, line 23: element 2 has node 10 twice; collapsed elements are not supported: use a type with fewer nodes",
        ),
        (
            " 5, 6, 7, 8\n*element",
            " 5, 6, 7\n*element",
            "part.inp, line 20: element 1 has 7 nodes; a C3D8R has 8",
        ),
        (
            " 5, 6, 7, 8\n*element",
            " 5, 6, 7, 8, 9\n*element",
            "part.inp, line 21: element 1 has 9 nodes; a C3D8R has 8",
        ),
        (
            "*ELEMENT, TYPE=C3D8R",
            "*ELEMENT, TIPE=C3D8R",
            "part.inp, line 18: *ELEMENT has no parameter TIPE; did you mean TYPE?",
        ),
        (
            "*ELEMENT, TYPE=C3D8R",
            "*ELEMENT",
            "part.inp, line 18: *ELEMENT has no TYPE; write *ELEMENT, TYPE=…",
        ),
        (
            "TYPE=C3D8R",
            "TYPE=C3D9",
            "part.inp, line 18: there is no element type `C3D9`; supported are C3D4/6/8",
        ),
    ]);
}

#[test]
fn faults_of_sets_and_surfaces_are_reported_with_their_line() {
    assert_reported(&[
        (
            " bottom, 12,",
            " botom, 12,",
            "part.inp, line 29: there is no node set `botom` before this line; there are bottom, Nall, ODD",
        ),
        (
            " upper, S2",
            " uper, S2",
            "part.inp, line 33: there is no element set `uper` before this line; there are all, Lower Part, upper",
        ),
        (
            " upper, S2",
            " upper, S9",
            "part.inp, line 33: surface `top`: element 2 (wedge6) has no side S9; its sides are S1 to S5",
        ),
        (
            " upper, S2",
            " upper, top",
            "part.inp, line 34: `top` stands where a side such as S1 should be in *SURFACE",
        ),
    ]);
}

#[test]
fn faults_of_keywords_and_files_are_reported_with_their_line() {
    assert_reported(&[
        (
            "*MATERIAL, NAME=steel",
            "*NCOPY, OLD SET=a",
            "part.inp, line 40: *NCOPY is refused: it makes nodes or elements out of others; export the deck with all of them written out",
        ),
        (
            "*MATERIAL, NAME=steel",
            "*INCLUDE, INPUT=none.inp",
            "part.inp, line 40: the file `none.inp` cannot be included: ",
        ),
        (
            "*Heading",
            "*PART, NAME=a",
            "part.inp, line 1: the file ends inside *PART, where its *END should follow; it is truncated: save or copy it again",
        ),
    ]);
}

#[test]
fn texts_that_are_no_mesh_are_refused() {
    for (text, expected) in [
        (
            "",
            "part.inp: the file is empty; was it written to the end?",
        ),
        (
            "1, 2\n",
            "part.inp, line 1: `1, 2` stands where a keyword such as *NODE should be; a deck starts with a keyword",
        ),
        (
            "*NODE\0",
            "part.inp: the file is not text: it holds zero bytes; export the deck again",
        ),
        (
            "*NODE\n1, 0\n",
            "part.inp: the mesh has 1 nodes but no elements; mesh the model before saving it whole",
        ),
        (
            "*NODE\n1\n",
            "part.inp, line 2: the file ends inside node 1 of *NODE, where coordinates should follow",
        ),
        (
            "*NODE\n1,0\n2,1\n*ELEMENT,TYPE=GAPUNI\n1,1,2\n",
            "part.inp: the mesh has 1 element of type GAPUNI: not supported yet",
        ),
    ] {
        let message = fault(text);
        assert!(message.starts_with(expected), "{message}\n{expected}");
    }
}

#[test]
fn unfinished_steps_and_sets_of_missing_nodes_are_noted() {
    let (_, notes) = read_text(&SAMPLE.replace("*END STEP", "")).unwrap();
    assert!(
        notes.iter().any(|n| n.contains("line 43: *STEP without")),
        "{notes:?}"
    );
    let (_, notes) = read_text(&SAMPLE.replace(" bottom, 12,", " bottom, 77,")).unwrap();
    assert!(
        notes
            .iter()
            .any(|n| n == "node set `both`: 1 node not in the mesh, such as 77"),
        "{notes:?}"
    );
}

#[test]
fn elements_that_are_no_solids_are_noted() {
    let more = "*ELEMENT, TYPE=S4, ELSET=lid\n10, 9, 10, 11, 12\n*ELEMENT, TYPE=SPRINGA, ELSET=k\n11, 1, 2\n\
        *ELEMENT, TYPE=MASS\n12, 1\n*SURFACE, NAME=plate\nlid, SPOS\n*ELEMENT OUTPUT\nS\n";
    let (mesh, notes) =
        read_text(&SAMPLE.replace("*MATERIAL", &format!("{more}*MATERIAL"))).unwrap();
    assert_eq!(mesh.sets["lid"].cells.len(), 1);
    assert_eq!(mesh.sets["plate"].cells, mesh.sets["lid"].cells);
    for note in [
        "1 element of type S4 (shell): faces or edges of the solids, without stiffness",
        "1 element of type SPRINGA left out: no cell of a mesh",
        "1 element of type MASS left out: no cell of a mesh",
        "element set `k` is empty",
    ] {
        assert!(notes.iter().any(|n| n == note), "{note}: {notes:?}");
    }
    let plane = "*NODE,SYSTEM=C\n1,1,0\n2,2,0\n3,2,90\n4,1,90\n*ELEMENT,TYPE=CPS4R,ELSET=e\n1,1,2,3,4\n*SURFACE,NAME=s\n1,S2\n";
    let (mesh, notes) = read_text(plane).unwrap();
    assert!((mesh.points[2].y - 2.0).abs() < 1e-15 && mesh.points[2].x.abs() < 1e-15);
    assert_eq!(mesh.sets["s"].faces[0].side, 1);
    assert!(
        notes.iter().any(|n| n.contains("CPS4R: plane stress")),
        "{notes:?}"
    );
}
