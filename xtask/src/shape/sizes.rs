//! Functions and files that are too long.

use super::{Fault, Source};
use syn::spanned::Spanned;

const LONGEST_FUNCTION: usize = 100;
const LONGEST_FILE: usize = 800;

/// Files over the limit.
pub(super) fn files(sources: &[Source]) -> Vec<Fault> {
    let long = sources.iter().filter(|s| s.nline > LONGEST_FILE);
    let fault = |source: &Source| Fault {
        path: source.path.clone(),
        line: source.nline,
        what: format!("{} lines", source.nline),
    };
    long.map(fault).collect()
}

/// Functions over the limit.
pub(super) fn functions(sources: &[Source]) -> Vec<Fault> {
    let mut found = Vec::new();
    for source in sources {
        for function in source.functions() {
            let first = function.signature.span().start().line;
            let nline = function.block.span().end().line + 1 - first;
            if nline > LONGEST_FUNCTION {
                let what = format!("`{}` has {nline} lines", function.signature.ident);
                found.push(source.fault(function.signature, what));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn source(text: &str) -> Source {
        Source::new(Path::new("a.rs"), text).unwrap()
    }

    #[test]
    fn lines_count_from_signature_to_brace() {
        for (inside, nfault) in [(LONGEST_FUNCTION - 2, 0), (LONGEST_FUNCTION - 1, 1)] {
            let lines = "    x();\n".repeat(inside);
            for text in [
                format!("/// Text.\nfn f() {{\n{lines}}}\n"),
                format!("impl A {{ fn f(&self) {{\n{lines}}} }}\n"),
                format!("trait A {{ fn f(&self) {{\n{lines}}} }}\n"),
                format!("mod m {{ fn g() {{ fn f() {{\n{lines}}} }} }}\n"),
            ] {
                let nlong = nfault * text.matches("fn ").count();
                assert_eq!(functions(&[source(&text)]).len(), nlong, "{text}");
            }
        }
    }

    #[test]
    fn a_file_has_as_many_lines_as_its_text() {
        assert!(files(&[source(&"\n".repeat(LONGEST_FILE))]).is_empty());
        assert_eq!(files(&[source(&"\n".repeat(LONGEST_FILE + 1))]).len(), 1);
    }
}
