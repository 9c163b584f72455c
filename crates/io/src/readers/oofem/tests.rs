use super::*;

/// A cube on a contact facet, with this in place of its sets.
fn deck(sets: &str, nset: usize) -> String {
    format!(
        "# a comment\n\njob.out\nA cube\nStaticStructural nsteps 1 nmodules 1\nerrorcheck\ndomain 3d\n\
         OutputManager tstep_all\nndofman 8 nelem 2 ncrosssect 2 nmat 2 nbc 0 nltf 0 \\\n  nset {nset}\n\
         node 1 coords 3 0 0 0\nnode 2 coords 3 1 0 0\nnode 3 coords 3 1 1 0\nnode 4 coords 3 0 1 0\n\
         node 15 coords 3 0 0 1\nnode 6 coords 3 1 0 1\nnode 7 coords 3 1 1 1\nnode 8 coords 3 0 1 1\n\
         LSpace 9 nodes 8 1 2 3 4 15 6 7 8 crosssect 1 mat 1 nlgeo 1\n\
         StructuralContactElement_QuadLin 3 nodes 4 15 6 7 8 crosssect 2 mat 2 nip 4\n\
         SimpleCS 1 material 1\nDummyCS 2 mat 2\nIsoLE 1 d 0. E 1. n 0.\nDummyMat 2\n{sets}"
    )
}

fn read_text(text: &str) -> Result<Deck, MeshError> {
    read_deck(&RealFs, "job.in", text.as_bytes())
}

#[test]
fn nodes_elements_and_sets_become_a_mesh() {
    let sets = "set 1 noderanges {1 (6 8)}\nset 2 nodes 2 4 1 elements 1 3 elementboundaries 4 9 1 9 2\n\
                SET 3 nodes 3 8 1 4 ordered_nodes\nset 4 allelements\n#%BEGIN_CHECK% tolerance 1.e-3\n\
                #NODE tStep 1 number 15 dof 3 unknown d value 1.\n## remark\n#%END_CHECK%\n";
    let deck = read_text(&deck(sets, 4)).unwrap();
    let mesh = &deck.meshed.mesh;
    assert_eq!((mesh.nnode(), mesh.ncell(), mesh.dim()), (8, 2, 3));
    assert_eq!(mesh.node_labels[4], 15);
    let nodes = |name: &str| mesh.sets[name].nodes.clone();
    assert_eq!(nodes("set-1"), [0, 5, 6, 7]);
    assert_eq!(nodes("set-2"), [0, 3], "in the order of their numbers");
    assert_eq!(nodes("set-3"), [7, 0, 3], "in their own");
    assert_eq!(mesh.sets["set-2-elements"].cells.len(), 1);
    assert_eq!(mesh.sets["set-4"].cells.len(), 2);
    let faces = &mesh.sets["set-2-sides"].faces;
    let of_face = |k: usize| mesh.face(faces[k]).unwrap().1;
    assert_eq!((faces.len(), of_face(1).iter().min()), (2, Some(&4)));
    assert_eq!(deck.meshed.groups.len(), 1);
    let group = &deck.meshed.groups[0];
    assert_eq!((group.name.as_str(), group.nlgeo), ("lspace-1", 1));
    assert_eq!(mesh.sets["lspace-1"].cells.len(), 1);
    let checks = deck.parts.checks.unwrap();
    assert!(checks.closed && checks.records.len() == 1);
    assert_eq!(deck.parts.description, "A cube");
}

#[test]
fn sets_may_stand_before_the_sections() {
    let text = deck("", 1).replace("SimpleCS", "set 1 elements 1 9\nSimpleCS");
    let text = text
        .replace("crosssect 1 mat 1", "")
        .replace("SimpleCS 1", "SimpleCS 1 set 1");
    let deck = read_text(&text).unwrap();
    let group = &deck.meshed.groups[0];
    assert_eq!((group.section, group.material), (1, 1));
}

#[test]
fn lines_may_end_in_any_way_and_letters_may_be_large() {
    let text = deck("set 1 nodes 1 1\n", 1);
    let plain = read_text(&text).unwrap().meshed.mesh;
    for other in [
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        text.to_uppercase(),
    ] {
        assert_eq!(read_text(&other).unwrap().meshed.mesh, plain);
    }
}

#[test]
fn faults_are_reported_with_their_lines() {
    let good = deck("set 1 nodes 1 1\n", 1);
    for (from, to, wanted) in [
        (
            "nelem 2",
            "nelem 1",
            "line 25: `set` stands where the end of the deck should",
        ),
        (
            "nodes 8 1 2",
            "nodes 8 1 99",
            "line 19: there is no node 99",
        ),
        (
            "nodes 8 1 2",
            "nodes 8 1 1",
            "line 19: element 9 has node 1 twice",
        ),
        (
            "nodes 4 15 6 7 8",
            "nodes 3 15 6 7",
            "has 3 nodes; structuralcontactelement_quadlin has 4",
        ),
        (
            "node 15 ",
            "node 4 ",
            "line 15: a second node has the number 4",
        ),
        (
            "LSpace 9",
            "LSpace x",
            "`x` stands where a whole number of `the number` should",
        ),
        (
            "LSpace",
            "LSpaec",
            "there is no element type `lspaec`; did you mean `lspace`?",
        ),
        (
            "coords 3 1 0 0",
            "coords 3 1 0",
            "is announced to have 3 entries",
        ),
        (
            "coords 3 1 0 0",
            "coords 3 1 nan 0",
            "`nan` stands where a finite number of `coords`",
        ),
        ("nset 1", "nset 2", "ends where set 2 of 2 should follow"),
        (
            "nset 1",
            "nset 0",
            "`set` stands where the end of the deck should",
        ),
        ("ndofman 8 ", "", "no `ndofman`"),
        (
            "domain 3d",
            "domian 3d",
            "`domian` stands where the record of the domain should",
        ),
        ("set 1 nodes 1 1", "set 1 nodes 1 5", "there is no node 5"),
        (
            "set 1 nodes 1 1",
            "set 1 elementboundaries 2 9 7",
            "element 9 (lspace) has no side 7",
        ),
        (
            "set 1 nodes 1 1",
            "set 1 elementedges 2 9 1",
            "`elementedges` of a lspace is not supported",
        ),
        ("set 1 nodes 1 1", "@include \"job.in\"", "includes itself"),
        (
            "set 1 nodes 1 1",
            "@include nowhere.in",
            "including `nowhere.in`",
        ),
    ] {
        let text = good.replacen(from, to, 1);
        assert_ne!(text, good, "{from}");
        let message = read_text(&text).unwrap_err().to_string();
        assert!(message.contains(wanted), "{message}\n{wanted}");
    }
}

#[test]
fn what_is_no_text_is_refused() {
    for bytes in [&b""[..], b" \n\n", b"\xff\xfea\0", b"a\0b"] {
        assert!(read_deck(&RealFs, "job.in", bytes).is_err());
    }
    let message = read_text("a\nb\n").unwrap_err().to_string();
    assert!(message.contains("the analysis should follow"), "{message}");
}

/// A short line may not ask for more memory than a deck of its length may mean.
#[test]
fn ranges_that_repeat_themselves_are_refused() {
    let all = "(1 15) ".repeat(100_000);
    let text = deck(&format!("set 1 noderanges {{{all}}}\n"), 1);
    assert!(
        read_text(&text).is_ok(),
        "700 000 bytes may mean 700 000 nodes"
    );
    let records = "set 1 allnodes\n".replace('1', "9");
    assert!(read_text(&deck(&records, 1)).is_ok());
}
