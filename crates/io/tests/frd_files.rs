//! Files that CalculiX 2.20 has written: its mesh against the one of the deck, and values that are known.

#![allow(clippy::unwrap_used)]

use signorini_geometry::mesh::Mesh;
use signorini_io::readers::{frd, read_mesh};
use std::path::Path;

fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(
        Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("tests/data")
            .join(name),
    )
    .unwrap()
}

fn mesh(name: &str) -> Mesh {
    read_mesh(name, &bytes(name)).unwrap().0
}

#[test]
fn the_mesh_in_the_results_is_that_of_the_deck() {
    for (name, ncell) in [("ccx_cells", 6), ("ccx_plane", 4), ("ccx_slide", 2)] {
        let (deck, results) = (mesh(&format!("{name}.inp")), mesh(&format!("{name}.frd")));
        assert_eq!(results.ncell(), ncell);
        assert_eq!(deck.node_labels, results.node_labels, "{name}");
        assert_eq!(deck.points, results.points, "{name}");
        for dim in [2, 3] {
            for cell in deck.cells(dim) {
                let label = deck.cell_label(cell);
                let same = results
                    .cells(dim)
                    .find(|&other| results.cell_label(other) == label)
                    .unwrap();
                assert_eq!(deck.element(cell), results.element(same));
                assert_eq!(deck.cell(cell), results.cell(same), "{name}");
            }
        }
    }
}

#[test]
fn steps_increments_times_and_values_are_those_of_the_run() {
    let results = frd::parse(&bytes("ccx_slide.frd")).unwrap();
    assert!(results.is_complete);
    let moved: Vec<_> = results
        .datasets
        .iter()
        .filter(|d| d.name == "DISP")
        .collect();
    assert_eq!(
        (moved[0].step, moved[0].increment, moved[0].time),
        (1, 1, 0.5)
    );
    let last = moved[moved.len() - 1];
    assert_eq!((last.step, last.time), (2, 2.0));
    let head = last.nodes.iter().position(|&n| n == 15).unwrap();
    assert_eq!(
        last.row(head),
        [0.1, 0.03, -0.01],
        "as the deck prescribes it"
    );
    let contact = results.last("CONTACT").unwrap();
    assert_eq!(contact.components.len(), 6);
    let node = contact.nodes.iter().position(|&n| n == 11).unwrap();
    assert!(contact.row(node)[0] < 0.0 && contact.row(node)[3] > 0.0);
}
