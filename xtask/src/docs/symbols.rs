//! What the sources define, by path, and the words that programs write and read.

use crate::ChoreError;
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use syn::visit::{self, Visit};

/// An index of all sources.
#[derive(Debug, Default)]
pub(super) struct Symbols {
    /// Paths of definitions by their last word: crate, modules, type, name.
    defined: BTreeMap<String, BTreeSet<Vec<String>>>,
    /// Words in literals and in data, in lower case: names of files, columns, foreign keywords.
    words: BTreeSet<String>,
    /// Methods of traits, in the order of the source, by crate and name.
    traits: BTreeMap<(String, String), Vec<Vec<String>>>,
}

impl Symbols {
    /// Adds the definitions and words of a Rust source.
    pub fn add_rust(&mut self, path: &Path, source: &str) -> Result<(), ChoreError> {
        let failed = |error: &dyn std::fmt::Display| ChoreError::Failed {
            what: format!("the parser of {}", path.display()),
            reason: error.to_string(),
        };
        let file = syn::parse_file(source).map_err(|error| failed(&error))?;
        let mut visitor = Definitions {
            within: module(path),
            out: &mut self.defined,
            traits: &mut self.traits,
        };
        visitor.add_path();
        visitor.visit_file(&file);
        let tokens: TokenStream = source.parse().map_err(|error| failed(&error))?;
        self.add_literals(tokens);
        Ok(())
    }

    /// Adds the words of a text of data, whose remarks begin with a sign.
    pub fn add_data(&mut self, text: &str, remark: &str) {
        for line in text.lines() {
            self.add_words(line.split(remark).next().unwrap_or_default());
        }
    }

    /// Adds the names that a Python script defines, attributes among them, and the strings in it that are no sentences.
    pub fn add_python(&mut self, text: &str) {
        for line in text.lines().map(str::trim_start) {
            let named = ["def ", "class ", "self."]
                .iter()
                .find_map(|word| line.strip_prefix(word));
            let name = named.and_then(|rest| rest.split(|c| !is_wordy(c)).next());
            self.words.extend(name.map(str::to_lowercase));
            for part in line.split('"').filter(|part| !part.contains(' ')) {
                self.add_words(part);
            }
        }
    }

    fn add_words(&mut self, text: &str) {
        let words = text.split(|c: char| !is_wordy(c));
        self.words.extend(words.map(str::to_lowercase));
    }

    /// String literals; documentation is none.
    fn add_literals(&mut self, tokens: TokenStream) {
        let mut after_sign = false;
        for tree in tokens {
            let is_attribute = std::mem::replace(&mut after_sign, is_sign(&tree));
            match tree {
                TokenTree::Group(group) => {
                    let is_doc = is_attribute
                        && group.delimiter() == Delimiter::Bracket
                        && starts_with_doc(&group.stream());
                    if !is_doc {
                        self.add_literals(group.stream());
                    }
                }
                TokenTree::Literal(literal) => {
                    if let Ok(syn::Lit::Str(text)) =
                        syn::parse_str::<syn::Lit>(&literal.to_string())
                    {
                        self.add_literal(&text.value());
                    }
                }
                _ => {}
            }
        }
    }

    /// A literal as a whole and, unless it is a sentence, each of its words.
    fn add_literal(&mut self, text: &str) {
        self.words.insert(text.trim().to_lowercase());
        if !text.trim().contains(' ') || text.trim().contains('\n') {
            self.add_words(text);
        }
    }

    /// Whether a word is one that programs write or read, in any case of letters.
    pub fn has_word(&self, word: &str) -> bool {
        self.words.contains(&word.to_lowercase())
    }

    /// Whether a word is a part of one that programs write or read.
    pub fn has_fragment(&self, word: &str) -> bool {
        let word = word.to_lowercase();
        self.has_word(&word)
            || self
                .words
                .iter()
                .any(|known| known.split('_').any(|part| part == word))
    }

    /// Whether a path such as `Term::converged` ends in a definition, with the words before it around it in this order.
    /// A crate may be written `signorini_x` or `x`; what `signorini` passes on counts as its own.
    pub fn has(&self, path: &str) -> bool {
        let wanted: Vec<&str> = path
            .split("::")
            .filter(|part| !["crate", "self", "super"].contains(part))
            .collect();
        let wanted: Vec<&str> = wanted.iter().map(|part| short(part)).collect();
        let passed_on = wanted
            .strip_prefix(&["signorini"])
            .filter(|rest| !rest.is_empty());
        [Some(&wanted[..]), passed_on]
            .into_iter()
            .flatten()
            .any(|path| self.has_parts(path))
    }

    fn has_parts(&self, wanted: &[&str]) -> bool {
        let Some((last, around)) = wanted.split_last() else {
            return false;
        };
        let is_around = |path: &Vec<String>| {
            let mut outer = path[..path.len() - 1].iter();
            around.iter().all(|part| outer.any(|name| name == part))
        };
        self.defined
            .get(*last)
            .is_some_and(|paths| paths.iter().any(is_around))
    }

    /// The methods of each trait of this name in a crate.
    pub fn traits(&self, within: &str, name: &str) -> impl Iterator<Item = &Vec<String>> {
        let key = (within.to_string(), name.to_string());
        self.traits.get(&key).into_iter().flatten()
    }

    /// Whether a filter for tests selects any.
    pub fn has_filter(&self, filter: &str) -> bool {
        let mut paths = self.defined.values().flatten();
        paths.any(|path| path.join("::").contains(filter))
    }
}

fn is_wordy(c: char) -> bool {
    c.is_alphanumeric() || c == '_' || c == '-'
}

fn is_sign(tree: &TokenTree) -> bool {
    matches!(tree, TokenTree::Punct(sign) if "#!".contains(sign.as_char()))
}

fn starts_with_doc(stream: &TokenStream) -> bool {
    matches!(stream.clone().into_iter().next(), Some(TokenTree::Ident(name)) if name == "doc")
}

/// A crate's name without that of the project.
fn short(name: &str) -> &str {
    let rest = name
        .strip_prefix("signorini_")
        .or_else(|| name.strip_prefix("signorini-"));
    rest.unwrap_or(name)
}

/// The module that a file is: crate, then folders and the file, without `src`, `mod`, `lib` and `main`.
fn module(path: &Path) -> Vec<String> {
    let path = path
        .strip_prefix("crates")
        .unwrap_or(path)
        .with_extension("");
    let parts = path.iter().filter_map(|part| part.to_str());
    let kept = parts.filter(|part| !["src", "mod", "lib", "main"].contains(part));
    kept.map(|part| short(part).replace('-', "_")).collect()
}

/// Collects definitions.
struct Definitions<'a> {
    within: Vec<String>,
    out: &'a mut BTreeMap<String, BTreeSet<Vec<String>>>,
    traits: &'a mut BTreeMap<(String, String), Vec<Vec<String>>>,
}

impl Definitions<'_> {
    /// Adds the place itself, and all that it lies in.
    fn add_path(&mut self) {
        for n in 1..=self.within.len() {
            let path = self.within[..n].to_vec();
            self.out
                .entry(path[n - 1].clone())
                .or_default()
                .insert(path);
        }
    }

    fn add(&mut self, name: &syn::Ident) {
        let name = name.to_string().trim_start_matches("r#").to_string();
        let path = [&self.within[..], std::slice::from_ref(&name)].concat();
        self.out.entry(name).or_default().insert(path);
    }

    /// Goes into something that has a name.
    fn inside(&mut self, name: &syn::Ident, f: impl FnOnce(&mut Self)) {
        self.add(name);
        self.within.push(name.to_string());
        f(self);
        self.within.pop();
    }
}

macro_rules! leaves {
    ($($function:ident($kind:ident) $($name:ident).+;)*) => {
        $(fn $function(&mut self, found: &'ast syn::$kind) {
            self.add(&found.$($name).+);
            visit::$function(self, found);
        })*
    };
}

macro_rules! containers {
    ($($function:ident($kind:ident);)*) => {
        $(fn $function(&mut self, found: &'ast syn::$kind) {
            self.inside(&found.ident, |inner| visit::$function(inner, found));
        })*
    };
}

impl<'ast> Visit<'ast> for Definitions<'_> {
    leaves! {
        visit_item_fn(ItemFn) sig.ident;
        visit_item_const(ItemConst) ident;
        visit_item_static(ItemStatic) ident;
        visit_item_type(ItemType) ident;
        visit_impl_item_fn(ImplItemFn) sig.ident;
        visit_impl_item_const(ImplItemConst) ident;
        visit_trait_item_fn(TraitItemFn) sig.ident;
        visit_trait_item_const(TraitItemConst) ident;
        visit_trait_item_type(TraitItemType) ident;
    }

    containers! {
        visit_item_struct(ItemStruct);
        visit_item_enum(ItemEnum);
        visit_item_mod(ItemMod);
        visit_variant(Variant);
    }

    fn visit_item_trait(&mut self, found: &'ast syn::ItemTrait) {
        let methods = found.items.iter().filter_map(|item| match item {
            syn::TraitItem::Fn(method) => Some(method.sig.ident.to_string()),
            _ => None,
        });
        let within = self.within.first().cloned().unwrap_or_default();
        let known = self.traits.entry((within, found.ident.to_string()));
        known.or_default().push(methods.collect());
        self.inside(&found.ident, |inner| visit::visit_item_trait(inner, found));
    }

    fn visit_field(&mut self, field: &'ast syn::Field) {
        if let Some(name) = &field.ident {
            self.add(name);
        }
    }

    fn visit_item_impl(&mut self, block: &'ast syn::ItemImpl) {
        let name = match block.self_ty.as_ref() {
            syn::Type::Path(path) => path.path.segments.last().map(|last| last.ident.clone()),
            _ => None,
        };
        let Some(name) = name else {
            return visit::visit_item_impl(self, block);
        };
        self.within.push(name.to_string());
        visit::visit_item_impl(self, block);
        self.within.pop();
    }

    fn visit_item_macro(&mut self, found: &'ast syn::ItemMacro) {
        if let Some(name) = &found.ident {
            self.add(name);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn symbols() -> Symbols {
        let mut out = Symbols::default();
        let source = "/// Text on \"prose\".\npub trait Term { fn converged(&self); }\n\
            pub enum Closest { Faces }\nstruct S { field: u8 }\nimpl S { const N: u8 = 1; fn go() {} }\n\
            fn f() { g(\"contact_pressure\", \"a whole sentence\"); h!(\"{x}.force_x\") }\n";
        out.add_rust(Path::new("crates/mechanics/src/system/term.rs"), source)
            .unwrap();
        out.add_rust(
            Path::new("crates/signorini-cli/tests/command/main.rs"),
            "fn it_runs() {}",
        )
        .unwrap();
        out
    }

    #[test]
    fn definitions_are_found_by_their_path() {
        let symbols = symbols();
        for good in [
            "Term",
            "Term::converged",
            "system::Term",
            "mechanics::term::Term",
            "signorini_mechanics::system::Term",
            "signorini::Term",
            "Closest::Faces",
            "S::N",
            "S::go",
            "field",
            "f",
            "system",
            "crate::system",
        ] {
            assert!(symbols.has(good), "{good}");
        }
        for bad in [
            "Term::verdict",
            "Closest::go",
            "solve::Term",
            "Terms",
            "Term::system",
            "signorini::Absent",
        ] {
            assert!(!symbols.has(bad), "{bad}");
        }
    }

    #[test]
    fn words_are_those_of_literals_without_sentences_and_documentation() {
        let symbols = symbols();
        for good in [
            "contact_pressure",
            "Contact_Pressure",
            "force_x",
            "a whole sentence",
        ] {
            assert!(symbols.has_word(good), "{good}");
        }
        for bad in ["prose", "sentence", "Term"] {
            assert!(!symbols.has_word(bad), "{bad}");
        }
    }

    #[test]
    fn filters_select_tests_by_a_part_of_their_path() {
        let symbols = symbols();
        assert!(symbols.has_filter("command::it_r") && symbols.has_filter("term::"));
        assert!(!symbols.has_filter("solver::"));
    }
}
