//! Tables that pages repeat from the sources: of rooms with their imports, and of traits with their methods.
//!
//! | header | first cell | second cell |
//! |---|---|---|
//! | `room`, `may import` | a room between backquotes | what its line of `ROOMS` lists, in that order |
//! | `trait`, `methods` | `crate::Trait` between backquotes | its methods in any order |
//!
//! A table of rooms lists all of them.

use super::symbols::Symbols;
use crate::rooms;
use std::collections::BTreeSet;

/// What a table lists.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Rooms,
    Traits,
}

/// The faults of the tables of a page, each with its line, from 1.
pub(super) fn faults(source: &str, symbols: &Symbols) -> Vec<(usize, String)> {
    let mut out = Vec::new();
    let mut table: Option<(Kind, usize)> = None;
    let mut listed = BTreeSet::new();
    for (line, text) in (1..).zip(source.lines()) {
        let cells: Vec<&str> = text.trim_matches('|').split('|').map(str::trim).collect();
        match (&cells[..], table) {
            _ if !text.starts_with('|') => {
                out.extend(table.take().and_then(|(kind, at)| lost(kind, at, &listed)));
            }
            (["room", "may import", ..], _) => table = Some((Kind::Rooms, line)),
            (["trait", "methods", ..], _) => table = Some((Kind::Traits, line)),
            ([name, list, ..], Some((kind, _))) if name.starts_with('`') => {
                let name = name.trim_matches('`');
                let list: Vec<&str> = list.split(", ").filter(|word| !word.is_empty()).collect();
                listed.insert(name.to_string());
                let fault = match kind {
                    Kind::Rooms => room_fault(name, &list),
                    Kind::Traits => trait_fault(name, &list, symbols),
                };
                out.extend(fault.map(|what| (line, what)));
            }
            _ => {}
        }
    }
    out.extend(table.and_then(|(kind, at)| lost(kind, at, &listed)));
    out
}

/// The rooms that a table leaves out.
fn lost(kind: Kind, at: usize, listed: &BTreeSet<String>) -> Option<(usize, String)> {
    if kind == Kind::Traits {
        return None;
    }
    let lost: Vec<&str> = rooms::names()
        .filter(|name| !listed.contains(*name))
        .collect();
    (!lost.is_empty()).then(|| (at, format!("the table of rooms lacks {}", lost.join(", "))))
}

fn room_fault(name: &str, list: &[&str]) -> Option<String> {
    match rooms::may_import(name) {
        None => Some(format!("there is no room {name}")),
        Some(true_list) if true_list != list => {
            Some(format!("room {name} may import: {}", true_list.join(", ")))
        }
        Some(_) => None,
    }
}

fn trait_fault(name: &str, list: &[&str], symbols: &Symbols) -> Option<String> {
    let (within, trait_name) = name.split_once("::").unwrap_or(("", name));
    let mut found = symbols.traits(within, trait_name).peekable();
    if found.peek().is_none() {
        return Some(format!("there is no trait {name}"));
    }
    let wanted: BTreeSet<&str> = list.iter().copied().collect();
    let mut methods = String::new();
    for one in found {
        if one.iter().map(String::as_str).collect::<BTreeSet<_>>() == wanted {
            return None;
        }
        methods = one.join(", ");
    }
    Some(format!("trait {name} has the methods: {methods}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn faults_of(source: &str) -> Vec<(usize, String)> {
        let mut symbols = Symbols::default();
        let term = "pub trait Term { fn name(&self); fn begin(&mut self) {} }";
        let path = Path::new("crates/mechanics/src/system/term.rs");
        symbols.add_rust(path, term).unwrap();
        faults(source, &symbols)
    }

    #[test]
    fn traits_have_the_methods_that_are_listed() {
        let table = |row: &str| format!("text\n\n| trait | methods |\n|---|---|\n{row}\n\ntext\n");
        assert!(faults_of(&table("| `mechanics::Term` | begin, name |")).is_empty());
        for row in [
            "| `mechanics::Term` | name |",
            "| `mechanics::Term` | name, begin, energy |",
            "| `io::Term` | name, begin |",
        ] {
            let found = faults_of(&table(row));
            assert_eq!(found.len(), 1, "{row}: {found:?}");
            assert_eq!(found[0].0, 5);
        }
    }

    #[test]
    fn rooms_import_what_is_listed_and_none_is_left_out() {
        let row = |name: &str| {
            let list = rooms::may_import(name).unwrap_or_default().join(", ");
            format!("| `{name}` | {list} | words |\n")
        };
        let rows: String = rooms::names().map(row).collect();
        let head = "| room | may import | contents |\n|---|---|---|\n";
        assert!(faults_of(&format!("{head}{rows}")).is_empty());
        let wrong = rows.replace(&row("linear"), "| `linear` | geometry | words |\n");
        assert_eq!(faults_of(&format!("{head}{wrong}")).len(), 1);
        let short = rows.replace(&row("linear"), "");
        let lacks = (1, "the table of rooms lacks linear".to_string());
        assert_eq!(faults_of(&format!("{head}{short}\ntext\n")), [lacks]);
    }
}
