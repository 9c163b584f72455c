//! Circles of files: files of a crate that use each other's items.
//!
//! A file uses another one where a `use` or a path in its code leads to an item that is *defined* there; re-exports are
//! followed to the definition, and neither they nor `mod` make a file depend on what it hands on. What only tests see is
//! left out.
//!
//! Limits: methods, and names that come through a glob, are not seen.

use super::File;
use super::imports::{Found, ModulePath, imports};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::PathBuf;

/// Files that use each other, with one use for each pair of them.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Circle {
    /// The user, the line, the item, and the file that defines it.
    uses: Vec<(PathBuf, usize, String, PathBuf)>,
}

impl fmt::Display for Circle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let files: BTreeSet<_> = self.uses.iter().map(|(user, ..)| user).collect();
        writeln!(f, "{} files use each other in a circle:", files.len())?;
        for (user, line, item, definer) in &self.uses {
            let (user, definer) = (user.display(), definer.display());
            writeln!(f, "  {user}:{line}: uses {item} of {definer}")?;
        }
        Ok(())
    }
}

/// What a module makes visible.
#[derive(Default)]
struct Names {
    /// Items that it defines.
    defined: BTreeSet<String>,
    /// Names that it hands on, with where they lead.
    handed_on: BTreeMap<String, ModulePath>,
}

/// Every module with a file of its own.
struct House<'a> {
    files: Vec<(&'a File, Found)>,
    names: BTreeMap<&'a [String], (usize, Names)>,
}

/// All circles of files, crate by crate.
pub(super) fn circles(files: &[File]) -> Vec<Circle> {
    let house = House::new(files);
    let uses = house.uses();
    let after: Vec<BTreeSet<usize>> = uses.iter().map(|of| of.keys().copied().collect()).collect();
    let circles = components(&after).into_iter().filter(|c| c.len() > 1);
    let circles = circles.map(|members| {
        let mut found = Vec::new();
        for &user in &members {
            for (&definer, (line, item)) in uses[user].iter().filter(|(d, _)| members.contains(d)) {
                let path = |file: usize| house.files[file].0.path.clone();
                found.push((path(user), *line, item.clone(), path(definer)));
            }
        }
        Circle { uses: found }
    });
    circles.collect()
}

impl<'a> House<'a> {
    fn new(files: &'a [File]) -> Self {
        let read = |file: &'a File| (file, imports(&file.source, &file.module));
        let all: Vec<(&File, Found)> = files.iter().map(read).collect();
        let tests: BTreeSet<ModulePath> = all.iter().flat_map(|(_, f)| f.tests.clone()).collect();
        let is_test = |file: &File| tests.iter().any(|test| file.module.starts_with(test));
        let files: Vec<_> = all.into_iter().filter(|(file, _)| !is_test(file)).collect();
        let mut names = BTreeMap::new();
        for (number, (file, found)) in files.iter().enumerate() {
            let mut of_file = Names {
                defined: defined(&file.source),
                ..Names::default()
            };
            for import in found.imports.iter().filter(|import| import.is_handed_on) {
                if let Some(name) = import.path.last() {
                    of_file.handed_on.insert(name.clone(), import.path.clone());
                }
            }
            names.insert(&file.module[..], (number, of_file));
        }
        Self { files, names }
    }

    /// The files that each file uses, with a line and the item.
    fn uses(&self) -> Vec<BTreeMap<usize, (usize, String)>> {
        let of_file = |(number, (_, found)): (usize, &(&File, Found))| {
            let mut uses = BTreeMap::new();
            for import in found.imports.iter().filter(|import| !import.is_handed_on) {
                if let Some((definer, item)) = self.definer(&import.path, 0)
                    && definer != number
                {
                    uses.entry(definer).or_insert((import.line, item));
                }
            }
            uses
        };
        self.files.iter().enumerate().map(of_file).collect()
    }

    /// The file that defines what a path leads to, and the name there.
    fn definer(&self, path: &[String], depth: usize) -> Option<(usize, String)> {
        // re-exports of re-exports; a chain this long is a circle of its own
        const DEEPEST: usize = 16;
        let inside = (1..=path.len()).rev();
        let found = inside.filter_map(|n| Some((n, self.names.get(&path[..n])?)));
        let (length, (file, names)) = found.into_iter().next()?;
        let Some(name) = path.get(length) else {
            // a module: the used part of it is not known
            return None;
        };
        match names.handed_on.get(name) {
            Some(to) if depth < DEEPEST && to[..] != path[..=length] => self.definer(to, depth + 1),
            _ => names.defined.contains(name).then(|| (*file, name.clone())),
        }
    }
}

/// The names of the items that a file defines at its outermost level.
fn defined(source: &str) -> BTreeSet<String> {
    let Ok(file) = syn::parse_file(source) else {
        return BTreeSet::new();
    };
    let name = |item: &syn::Item| match item {
        syn::Item::Const(item) => Some(item.ident.to_string()),
        syn::Item::Enum(item) => Some(item.ident.to_string()),
        syn::Item::Fn(item) => Some(item.sig.ident.to_string()),
        syn::Item::Static(item) => Some(item.ident.to_string()),
        syn::Item::Struct(item) => Some(item.ident.to_string()),
        syn::Item::Trait(item) => Some(item.ident.to_string()),
        syn::Item::Type(item) => Some(item.ident.to_string()),
        syn::Item::Union(item) => Some(item.ident.to_string()),
        _ => None,
    };
    file.items.iter().filter_map(name).collect()
}

/// The strongly connected components of a graph, given by what comes after each vertex.
///
/// Source: Tarjan, *SIAM J. Comput.* 1 (1972) 146–160.
fn components(after: &[BTreeSet<usize>]) -> Vec<BTreeSet<usize>> {
    struct Search<'a> {
        after: &'a [BTreeSet<usize>],
        number: Vec<Option<usize>>,
        low: Vec<usize>,
        stack: Vec<usize>,
        on_stack: Vec<bool>,
        next: usize,
        found: Vec<BTreeSet<usize>>,
    }
    impl Search<'_> {
        fn visit(&mut self, v: usize) {
            self.number[v] = Some(self.next);
            self.low[v] = self.next;
            self.next += 1;
            self.stack.push(v);
            self.on_stack[v] = true;
            for &w in &self.after[v] {
                match self.number[w] {
                    None => {
                        self.visit(w);
                        self.low[v] = self.low[v].min(self.low[w]);
                    }
                    Some(number) if self.on_stack[w] => self.low[v] = self.low[v].min(number),
                    Some(_) => {}
                }
            }
            if self.number[v] == Some(self.low[v]) {
                let mut component = BTreeSet::new();
                while let Some(w) = self.stack.pop() {
                    self.on_stack[w] = false;
                    component.insert(w);
                    if w == v {
                        break;
                    }
                }
                self.found.push(component);
            }
        }
    }
    let n = after.len();
    let mut search = Search {
        after,
        number: vec![None; n],
        low: vec![0; n],
        stack: Vec::new(),
        on_stack: vec![false; n],
        next: 0,
        found: Vec::new(),
    };
    for v in 0..n {
        if search.number[v].is_none() {
            search.visit(v);
        }
    }
    search.found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(module: &str, source: &str) -> File {
        File {
            path: PathBuf::from(module.replace("::", "/") + ".rs"),
            module: module.split("::").map(ToString::to_string).collect(),
            source: source.to_string(),
        }
    }

    fn shown(files: &[File]) -> String {
        let circles = circles(files);
        circles.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn files_that_use_each_other_are_a_circle() {
        let text = shown(&[
            file("a::one", "use super::two::Two; pub struct One;"),
            file("a::two", "pub struct Two; fn f(_: crate::one::One) {}"),
            file("a::three", "use crate::one::One;"),
        ]);
        assert!(text.starts_with("2 files use each other"), "{text}");
        assert!(text.contains("a/one.rs:1: uses Two of a/two.rs"), "{text}");
        assert!(text.contains("a/two.rs:1: uses One of a/one.rs"), "{text}");
    }

    #[test]
    fn re_exports_lead_to_the_definition_and_use_nothing() {
        let folder = "mod two; pub use two::Two; pub struct One;";
        let clean = [
            file("a", folder),
            file("a::two", "pub struct Two;"),
            file("a::three", "use crate::Two; use super::One;"),
        ];
        assert_eq!(shown(&clean), "");
        let circle = [
            file("a", "mod two; use two::Two; pub struct One(Two);"),
            file("a::two", "use super::One; pub struct Two;"),
        ];
        assert!(shown(&circle).contains("a.rs:1: uses Two of a/two.rs"));
    }

    #[test]
    fn what_only_tests_use_makes_no_circle() {
        let source = "pub struct Two; #[cfg(test)] mod tests { use crate::one::One; }";
        let files = [
            file("a::one", "use super::two::Two; pub struct One;"),
            file("a::two", source),
        ];
        assert_eq!(shown(&files), "");
    }
}
