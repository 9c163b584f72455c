//! Methods with a default that exactly one implementor overrides.

use super::{Fault, Source, is_for_tests};
use std::collections::BTreeMap;
use std::path::Path;
use syn::visit::{self, Visit};

/// Defaults that exactly one implementor overrides; implementors in tests are left out.
pub(super) fn singular(sources: &[Source]) -> Vec<Fault> {
    let mut seen = Seen::default();
    for source in sources.iter().filter(|source| !is_test_file(&source.path)) {
        seen.source = Some(source);
        seen.visit_file(&source.file);
    }
    let Seen {
        defaults,
        overrides,
        ..
    } = seen;
    let single = |key: &(String, String)| overrides.get(key).filter(|by| by.len() == 1);
    let fault = |(key, mut fault): ((String, String), Fault)| {
        let by = single(&key)?.first()?;
        fault.what = format!("only {by} overrides the default of `{}::{}`", key.0, key.1);
        Some(fault)
    };
    defaults.into_iter().filter_map(fault).collect()
}

/// Whether all of a file is for tests and benches.
fn is_test_file(path: &Path) -> bool {
    let is_test = |part: &str| matches!(part, "tests" | "tests.rs" | "benches" | "examples");
    path.iter().filter_map(|part| part.to_str()).any(is_test)
}

/// Defaults and overrides by trait and method.
#[derive(Default)]
struct Seen<'a> {
    source: Option<&'a Source>,
    defaults: BTreeMap<(String, String), Fault>,
    overrides: BTreeMap<(String, String), Vec<String>>,
}

impl<'ast> Visit<'ast> for Seen<'_> {
    fn visit_item_mod(&mut self, module: &'ast syn::ItemMod) {
        if !is_for_tests(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }

    fn visit_item_trait(&mut self, item: &'ast syn::ItemTrait) {
        let Some(source) = self.source.filter(|_| !is_for_tests(&item.attrs)) else {
            return;
        };
        for member in &item.items {
            if let syn::TraitItem::Fn(method) = member
                && method.default.is_some()
            {
                let key = (item.ident.to_string(), method.sig.ident.to_string());
                let fault = source.fault(&method.sig, String::new());
                self.defaults.insert(key, fault);
            }
        }
    }

    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        let name = item
            .trait_
            .as_ref()
            .and_then(|(path, _)| path.segments.last());
        let Some(name) = name.filter(|_| !is_for_tests(&item.attrs)) else {
            return;
        };
        let by = implementor(&item.self_ty);
        for member in &item.items {
            if let syn::ImplItem::Fn(method) = member {
                let key = (name.ident.to_string(), method.sig.ident.to_string());
                self.overrides.entry(key).or_default().push(by.clone());
            }
        }
    }
}

fn implementor(ty: &syn::Type) -> String {
    match ty {
        syn::Type::Path(path) => path.path.segments.last().map_or_else(
            || "a type".to_string(),
            |segment| format!("`{}`", segment.ident),
        ),
        _ => "a type".to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRAIT: &str = "trait Law { fn name(&self); fn rate(&self) -> bool { false } }\n";

    fn found(path: &str, implementors: &str) -> Vec<String> {
        let text = format!("{TRAIT}{implementors}");
        let source = Source::new(Path::new(path), &text).unwrap();
        singular(&[source]).into_iter().map(|f| f.what).collect()
    }

    #[test]
    fn one_override_is_one_too_few() {
        let one = "impl Law for A { fn name(&self) {} fn rate(&self) -> bool { true } }\n";
        let two = one.replace("for A", "for B<'_>");
        let without = "impl Law for C { fn name(&self) {} }\n";
        let (a, b) = (format!("{one}{without}"), format!("{one}{two}"));
        assert_eq!(
            found("src/law.rs", &a),
            ["only `A` overrides the default of `Law::rate`"]
        );
        assert!(found("src/law.rs", &b).is_empty());
        assert!(found("src/law.rs", without).is_empty());
    }

    #[test]
    fn implementors_in_tests_do_not_count() {
        let one = "impl Law for A { fn rate(&self) -> bool { true } }\n";
        let test = "#[cfg(test)] mod tests { impl Law for B { fn rate(&self) -> bool { true } } }";
        assert_eq!(found("src/law.rs", &format!("{one}{test}")).len(), 1);
        assert!(found("src/law/tests.rs", one).is_empty());
    }
}
