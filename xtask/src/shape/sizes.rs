//! Functions and files that are too long.

use super::{Fault, Source};
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

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

/// Functions over the limit, those in traits and in functions too.
pub(super) fn functions(sources: &[Source]) -> Vec<Fault> {
    let mut found = Vec::new();
    for source in sources {
        let mut visitor = Functions {
            source,
            found: &mut found,
        };
        visitor.visit_file(&source.file);
    }
    found
}

struct Functions<'a> {
    source: &'a Source,
    found: &'a mut Vec<Fault>,
}

impl Functions<'_> {
    fn look(&mut self, signature: &syn::Signature, block: &syn::Block) {
        let (first, last) = (signature.span().start().line, block.span().end().line);
        let nline = last + 1 - first;
        if nline > LONGEST_FUNCTION {
            let what = format!("`{}` has {nline} lines", signature.ident);
            self.found.push(self.source.fault(signature, what));
        }
    }
}

impl<'ast> Visit<'ast> for Functions<'_> {
    fn visit_item_fn(&mut self, function: &'ast syn::ItemFn) {
        self.look(&function.sig, &function.block);
        visit::visit_item_fn(self, function);
    }

    fn visit_impl_item_fn(&mut self, function: &'ast syn::ImplItemFn) {
        self.look(&function.sig, &function.block);
        visit::visit_impl_item_fn(self, function);
    }

    fn visit_trait_item_fn(&mut self, function: &'ast syn::TraitItemFn) {
        if let Some(block) = &function.default {
            self.look(&function.sig, block);
        }
        visit::visit_trait_item_fn(self, function);
    }
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
