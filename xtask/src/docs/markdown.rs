//! Markdown as the pieces that can be checked, each with its line.

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd};
use std::collections::BTreeSet;
use std::path::PathBuf;

/// A part of a page that may name something.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Piece {
    /// Text between backquotes.
    Code(String),
    /// Where a link or an image leads.
    Link(String),
    /// A block of code with the first word of its fence.
    Block { language: String, text: String },
}

/// A Markdown file.
#[derive(Debug, Default)]
pub(super) struct Page {
    /// From the root of the repository.
    pub path: PathBuf,
    /// Pieces with their lines, from 1.
    pub pieces: Vec<(usize, Piece)>,
    /// The anchors of its headings.
    pub anchors: BTreeSet<String>,
}

/// Reads a page.
pub(super) fn page(path: PathBuf, source: &str) -> Page {
    let mut page = Page {
        path,
        ..Page::default()
    };
    let line_of = |at: usize| 1 + source[..at].matches('\n').count();
    let parser = Parser::new_ext(source, Options::ENABLE_TABLES);
    for (_, definition) in parser.reference_definitions().iter() {
        let piece = Piece::Link(definition.dest.to_string());
        page.pieces.push((line_of(definition.span.start), piece));
    }
    let mut heading: Option<String> = None;
    let mut block: Option<(Option<usize>, String, String)> = None;
    for (event, range) in parser.into_offset_iter() {
        match event {
            Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
            Event::End(TagEnd::Heading(_)) => {
                page.anchors
                    .extend(heading.take().map(|text| anchor(&text)));
            }
            Event::Start(Tag::CodeBlock(kind)) => {
                let fence = match &kind {
                    CodeBlockKind::Fenced(fence) => fence.as_ref(),
                    CodeBlockKind::Indented => "",
                };
                let language = fence.split([' ', ',']).next().unwrap_or_default();
                block = Some((None, language.to_string(), String::new()));
            }
            Event::End(TagEnd::CodeBlock) => {
                if let Some((line, language, text)) = block.take() {
                    let line = line.unwrap_or_else(|| line_of(range.start));
                    page.pieces.push((line, Piece::Block { language, text }));
                }
            }
            Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                let piece = Piece::Link(dest_url.to_string());
                page.pieces.push((line_of(range.start), piece));
            }
            Event::Code(text) => {
                if let Some(heading) = &mut heading {
                    heading.push_str(&text);
                }
                let piece = Piece::Code(text.to_string());
                page.pieces.push((line_of(range.start), piece));
            }
            Event::Text(text) => {
                if let Some((line, _, so_far)) = &mut block {
                    line.get_or_insert_with(|| line_of(range.start));
                    so_far.push_str(&text);
                }
                if let Some(heading) = &mut heading {
                    heading.push_str(&text);
                }
            }
            _ => {}
        }
    }
    page
}

/// The anchor that GitHub makes of a heading.
fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter_map(|c| match c {
        ' ' => Some('-'),
        '-' | '_' => Some(c),
        _ if c.is_alphanumeric() => Some(c),
        _ => None,
    });
    kept.flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOURCE: &str = "\
# The `first` one, and more\n\n\
A [link](docs/a.md#b), ![a picture](p.png) and `code\nthat goes on`.\n\n\
```sh extra\nline one\nline two\n```\n\n| a |\n|---|\n| `cell` |\n\n[ref]: crates/x.rs\n";

    #[test]
    fn pieces_are_found_with_their_lines() {
        let found = page(PathBuf::from("x.md"), SOURCE).pieces;
        let link = |text: &str| Piece::Link(text.to_string());
        let code = |text: &str| Piece::Code(text.to_string());
        let block = Piece::Block {
            language: "sh".to_string(),
            text: "line one\nline two\n".to_string(),
        };
        let expected = [
            (15, link("crates/x.rs")),
            (1, code("first")),
            (3, link("docs/a.md#b")),
            (3, link("p.png")),
            (3, code("code that goes on")),
            (7, block),
            (13, code("cell")),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn anchors_are_those_of_the_headings() {
        let anchors = page(PathBuf::new(), SOURCE).anchors;
        assert_eq!(
            anchors.into_iter().collect::<Vec<_>>(),
            ["the-first-one-and-more"]
        );
    }
}
