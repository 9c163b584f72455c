//! Keys of a contact that do not go together, exit code 4. Most are refused where the case is read; the other refusals of
//! the model are tested next to it, in `signorini_mechanics::model::contact::sides`.

use super::blocks::{BLOCKS, Blocks, HEAD_MOVED};
use super::trial::{Remedy, Trial};
use crate::support::change;

/// Node against node, with a side that is no whole face.
fn bare(side: &str, nodes: &str, keys: &'static str) -> String {
    let text = Blocks {
        contact: Some(keys),
        steps: HEAD_MOVED,
        ..BLOCKS
    }
    .text();
    let text = change(
        &text,
        "[sets]",
        &format!("[sets]\nbare = {{ nodes = {nodes} }}"),
    );
    let before = format!("{side} = \"");
    let from = text.find(&before).unwrap() + before.len();
    let to = from + text[from..].find('"').unwrap();
    format!("{}bare{}", &text[..from], &text[to..])
}

#[test]
fn bare_nodes_have_no_normals() {
    let primary = "method = \"node-to-node\"\n";
    let secondary = "method = \"node-to-node\"\nnormals = \"secondary\"\n";
    for text in [
        bare("primary", "[16, 18]", primary),
        bare("secondary", "[101, 103]", secondary),
    ] {
        Trial {
            text,
            code: 4,
            says: &[
                "S0303",
                "contact \"touch\"",
                "normals of bare nodes cannot be averaged",
                "case.toml:",
            ],
            help: "write  normals",
            remedy: Remedy::Key,
            gone: None,
        }
        .holds();
    }
}
