//! Pages of large models stay small enough to be mailed.

use crate::synthetic::{Blocks, FOLDER, complete, write_frames};
use signorini_io::fs::MemoryFs;
use signorini_report::{PageOptions, page};
use std::path::Path;

#[test]
fn a_model_with_100000_contact_facets_has_a_page_below_8_megabytes() {
    let fs = MemoryFs::default();
    let blocks = Blocks {
        n: 317,
        plane: false,
    };
    assert!(blocks.n * blocks.n > 100_000);
    write_frames(&fs, &blocks, 4);
    let bytes = page(&fs, Path::new(FOLDER), &PageOptions::default()).unwrap();
    assert!(bytes.len() < 8_000_000, "{}", bytes.len());
    let text = String::from_utf8(bytes).unwrap();
    assert!(text.contains("id=\"stage\""));
    // what was left out is said
    assert!(
        text.contains("triangles for the"),
        "nothing is said about facets"
    );
}

#[test]
fn less_is_shown_and_said_where_the_budget_is_small() {
    let fs = complete();
    let page = |budget: usize| {
        let options = PageOptions {
            budget,
            ..PageOptions::default()
        };
        let bytes = page(&fs, Path::new(FOLDER), &options).unwrap();
        String::from_utf8(bytes).unwrap()
    };
    assert!(!page(7_800_000).contains("are rounded to"));
    // a view keeps its least share, so that a long table cannot push it out
    assert!(page(1).contains("id=\"stage\""));
}
