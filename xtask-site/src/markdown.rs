//! Markdown of the repository as Markdown of the site: links lead to pages and files of the site, formulas are MathML.

use crate::formulas::mathml;
use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};
use std::ops::Range;

/// A page for the site.
#[derive(Debug, Default)]
pub struct Written {
    /// The text.
    pub text: String,
    /// The number of its formulas.
    pub nformula: usize,
    /// Formulas that cannot be read, with their line.
    pub faults: Vec<(usize, String)>,
}

/// What Markdown may have on a page: tables, notes and formulas between dollars.
fn options() -> Options {
    Options::ENABLE_TABLES
        | Options::ENABLE_FOOTNOTES
        | Options::ENABLE_STRIKETHROUGH
        | Options::ENABLE_TASKLISTS
        | Options::ENABLE_MATH
}

/// Rewrites a page. `lead` takes the target of a link or picture and gives that in the site, or none where it stays.
pub fn rewrite(source: &str, mut lead: impl FnMut(&str) -> Option<String>) -> Written {
    let mut edits: Vec<(Range<usize>, String)> = Vec::new();
    let mut written = Written::default();
    let line = |at: usize| source[..at].matches('\n').count() + 1;
    let parser = Parser::new_ext(source, options());
    let definitions: Vec<(String, Range<usize>)> = parser
        .reference_definitions()
        .iter()
        .map(|(_, definition)| (definition.dest.to_string(), definition.span.clone()))
        .collect();
    let mut is_code = false;
    for (event, range) in parser.into_offset_iter() {
        match event {
            Event::Start(Tag::CodeBlock(_)) => is_code = true,
            Event::End(TagEnd::CodeBlock) => is_code = false,
            Event::Text(_) if !is_code && has_dollar(source, &range) => {
                let what = "a dollar sign begins no formula: close it, or write \\$".to_string();
                written.faults.push((line(range.start), what));
            }
            Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                edits.extend(target(source, range, &dest_url, "](").zip(lead(&dest_url)));
            }
            Event::InlineMath(latex) | Event::DisplayMath(latex) => {
                let is_display = source[range.clone()].starts_with("$$");
                written.nformula += 1;
                match mathml(&latex, is_display) {
                    Ok(html) => edits.push((range, html)),
                    Err(error) => {
                        let what = format!("the formula {latex} cannot be read: {error}");
                        written.faults.push((line(range.start), what));
                    }
                }
            }
            _ => {}
        }
    }
    for (to, range) in definitions {
        edits.extend(target(source, range, &to, "]:").zip(lead(&to)));
    }
    written.text = apply(source, edits);
    written
}

/// Whether a text has a dollar sign that no backslash stands before.
fn has_dollar(source: &str, range: &Range<usize>) -> bool {
    let text = source.get(range.clone()).unwrap_or_default();
    text.match_indices('$')
        .any(|(at, _)| !source[..range.start + at].ends_with('\\'))
}

/// Where the target of a link stands within the link: after the last mark.
fn target(source: &str, range: Range<usize>, to: &str, mark: &str) -> Option<Range<usize>> {
    let text = source.get(range.clone())?;
    let after = text.rfind(mark)? + mark.len();
    let at = range.start + after + text.get(after..)?.find(to)?;
    Some(at..at + to.len())
}

/// A text with pieces replaced. Pictures inside links come after them; nothing else overlaps.
fn apply(source: &str, mut edits: Vec<(Range<usize>, String)>) -> String {
    edits.sort_by_key(|(range, _)| range.start);
    edits.dedup_by_key(|(range, _)| range.start);
    let mut out = String::with_capacity(source.len());
    let mut at = 0;
    for (range, text) in edits {
        if range.start < at {
            continue;
        }
        out.push_str(&source[at..range.start]);
        out.push_str(&text);
        at = range.end;
    }
    out.push_str(&source[at..]);
    out
}

/// The first heading of a page.
pub fn title(source: &str) -> Option<&str> {
    let line = source.lines().find(|line| line.starts_with("# "))?;
    line.strip_prefix("# ").map(str::trim)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn up(to: &str) -> Option<String> {
        (!to.contains("://")).then(|| format!("../{to}"))
    }

    #[test]
    fn links_pictures_and_definitions_are_led_elsewhere() {
        let source =
            "[a](x.md#h) ![b](p.png) [c](http://e.org) [d][r] [![i](q.png)](y.md)\n\n[r]: z.md\n";
        let wanted = "[a](../x.md#h) ![b](../p.png) [c](http://e.org) [d][r] [![i](../q.png)](../y.md)\n\n[r]: ../z.md\n";
        assert_eq!(rewrite(source, up).text, wanted);
    }

    #[test]
    fn code_is_left_alone() {
        let source = "`[a](x.md) $x$`\n\n```text\n[a](x.md) $x$\n```\n";
        assert_eq!(rewrite(source, up).text, source);
    }

    #[test]
    fn formulas_are_replaced_in_tables_too() {
        let written = rewrite("| a |\n|---|\n| $x_1 y_2$ |\n\n$$\na = b\n$$\n", up);
        assert_eq!((written.nformula, written.faults.len()), (2, 0));
        assert!(
            !written.text.contains('$') && written.text.matches("<math").count() == 2,
            "{}",
            written.text
        );
    }

    #[test]
    fn a_broken_formula_is_named_with_its_line() {
        for formula in ["$\\frac{1$", "$\\nothing x$", "$x"] {
            let written = rewrite(&format!("one\n\n{formula} two\n"), up);
            assert!(!written.faults.is_empty(), "{formula}");
            assert!(written.faults.iter().all(|(line, _)| *line == 3));
        }
        assert!(rewrite("5 \\$ and `$x`\n", up).faults.is_empty());
    }
}
