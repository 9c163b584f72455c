//! Which modules a source file names: every `use` and every path in the code, resolved to the crate and its modules.
//!
//! Code that only tests see is left out: items under `#[cfg(test)]`, and the files of modules declared under it.

use super::tokens::{Token, tokens};

/// A module path: the crate by the name of its folder, then the modules.
pub(super) type ModulePath = Vec<String>;

/// A path that a file names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Import {
    /// From the crate on; what follows the modules (types, functions) is still there.
    pub path: ModulePath,
    /// Where, from 1.
    pub line: usize,
    /// Whether the file hands it on (`pub use`) and need not use it itself.
    pub is_handed_on: bool,
}

/// What is found in a file.
#[derive(Debug, Default)]
pub(super) struct Found {
    /// What its code names.
    pub imports: Vec<Import>,
    /// Modules with files of their own that only tests see.
    pub tests: Vec<ModulePath>,
}

/// Reads one file, which is the module `module`.
pub(super) fn imports(source: &str, module: &[String]) -> Found {
    let tokens = tokens(source);
    let mut parser = Parser {
        tokens: &tokens,
        at: 0,
        depth: 0,
        module: module.to_vec(),
        blocks: Vec::new(),
        handing_on: false,
        found: Found::default(),
    };
    parser.file();
    parser.found
}

struct Parser<'a> {
    tokens: &'a [Token<'a>],
    at: usize,
    /// Braces that are open.
    depth: usize,
    /// The module that the present place belongs to.
    module: ModulePath,
    /// The depth at which each module written in place was opened.
    blocks: Vec<usize>,
    /// Whether the tree that is taken is that of a `pub use`.
    handing_on: bool,
    found: Found,
}

impl<'a> Parser<'a> {
    /// The text `ahead` tokens further; empty after the end.
    fn text(&self, ahead: usize) -> &'a str {
        self.tokens.get(self.at + ahead).map_or("", |t| t.text)
    }

    /// The text `back` tokens before; empty before the start.
    fn before(&self, back: usize) -> &'a str {
        let at = self.at.checked_sub(back);
        at.and_then(|at| self.tokens.get(at)).map_or("", |t| t.text)
    }

    fn is_word(&self, ahead: usize) -> bool {
        self.tokens.get(self.at + ahead).is_some_and(Token::is_word)
    }

    fn line(&self) -> usize {
        self.tokens.get(self.at).map_or(0, |t| t.line)
    }

    fn file(&mut self) {
        while self.at < self.tokens.len() {
            match self.text(0) {
                "#" if self.text(1) == "[" || self.text(1) == "!" => {
                    let inner = self.text(1) == "!";
                    if self.attribute_hides() {
                        if inner && self.blocks.is_empty() {
                            self.found = Found::default();
                            return;
                        }
                        self.hidden_item();
                    }
                }
                "use" if self.text(1) != "<" => {
                    // `pub use`, or `pub(crate) use`
                    self.handing_on = self.before(1) == "pub" || self.before(1) == ")";
                    self.at += 1;
                    self.tree(&[]);
                    self.handing_on = false;
                }
                "mod" if self.is_word(1) && self.text(2) == "{" => {
                    self.module.push(self.text(1).to_string());
                    self.blocks.push(self.depth);
                    self.at += 2;
                }
                "{" => {
                    self.depth += 1;
                    self.at += 1;
                }
                "}" => {
                    self.depth = self.depth.saturating_sub(1);
                    if self.blocks.last() == Some(&self.depth) {
                        self.blocks.pop();
                        self.module.pop();
                    }
                    self.at += 1;
                }
                _ if self.is_word(0) && self.text(1) == "::" => self.path(),
                _ => self.at += 1,
            }
        }
    }

    /// Takes an attribute; whether it leaves the code to tests.
    fn attribute_hides(&mut self) -> bool {
        let start = self.at;
        while self.at < self.tokens.len() && self.text(0) != "[" {
            self.at += 1;
        }
        self.bracketed();
        let words = &self.tokens[start..self.at];
        let has = |word| words.iter().any(|t| t.text == word);
        has("cfg") && has("test") && !has("not") && !has("any")
    }

    /// Takes everything from an opening bracket to the one that closes it.
    fn bracketed(&mut self) {
        let mut open = 0usize;
        while self.at < self.tokens.len() {
            match self.text(0) {
                "(" | "[" | "{" => open += 1,
                ")" | "]" | "}" => open = open.saturating_sub(1),
                _ => {}
            }
            self.at += 1;
            if open == 0 {
                return;
            }
        }
    }

    /// Takes the item that an attribute leaves to tests.
    fn hidden_item(&mut self) {
        while self.at < self.tokens.len() {
            match self.text(0) {
                ";" => {
                    if self.before(2) == "mod" {
                        let name = self.before(1).to_string();
                        self.found.tests.push(joined(&self.module, [name]));
                    }
                    self.at += 1;
                    return;
                }
                "{" => return self.bracketed(),
                "(" | "[" => self.bracketed(),
                ")" | "]" | "}" => return,
                _ => self.at += 1,
            }
        }
    }

    /// Takes one branch of a `use`, after the segments `prefix`.
    fn tree(&mut self, prefix: &[&'a str]) {
        let line = self.line();
        let mut segments = prefix.to_vec();
        loop {
            match self.text(0) {
                "::" => self.at += 1,
                "{" => {
                    self.at += 1;
                    while self.at < self.tokens.len() && self.text(0) != "}" {
                        self.tree(&segments);
                        if self.text(0) == "," {
                            self.at += 1;
                        }
                    }
                    self.at += 1;
                    return;
                }
                "as" => {
                    self.at += 2;
                    break;
                }
                "*" => {
                    self.at += 1;
                    break;
                }
                "self" if !segments.is_empty() => self.at += 1,
                _ if self.is_word(0) => {
                    segments.push(self.text(0));
                    self.at += 1;
                }
                "," | "}" | ";" | "" => break,
                _ => self.at += 1,
            }
        }
        self.take(&segments, line);
    }

    /// Takes a path in the code, from its first word on.
    fn path(&mut self) {
        let line = self.line();
        let visibility = self.before(1) == "in" && self.before(2) == "(";
        let mut segments = vec![self.text(0)];
        self.at += 1;
        while self.text(0) == "::" && self.is_word(1) {
            segments.push(self.text(1));
            self.at += 2;
        }
        if self.text(0) == "::" {
            self.at += 1;
        }
        if !visibility {
            self.take(&segments, line);
        }
    }

    fn take(&mut self, segments: &[&str], line: usize) {
        if let Some(path) = self.resolve(segments) {
            self.found.imports.push(Import {
                path,
                line,
                is_handed_on: self.handing_on,
            });
        }
    }

    /// The path from the crate on. A path that starts with none of `crate`, `self`, `super` and a crate of ours is
    /// taken as one from the present module on: that of a module inside it, or of something foreign, which then is in
    /// no other room.
    fn resolve(&self, segments: &[&str]) -> Option<ModulePath> {
        let (&first, rest) = segments.split_first()?;
        let owned = |rest: &[&str]| rest.iter().map(ToString::to_string).collect::<Vec<_>>();
        let path = match first {
            "crate" => joined(self.module.get(..1)?, owned(rest)),
            "self" => joined(&self.module, owned(rest)),
            "super" => {
                let up = segments.iter().take_while(|s| **s == "super").count();
                let keep = self.module.len().checked_sub(up)?;
                joined(self.module.get(..keep)?, owned(segments.get(up..)?))
            }
            "signorini" => owned(segments),
            // the one room whose name is that of its package
            "signorini_cli" => joined(&["signorini-cli".to_string()], owned(rest)),
            _ => match first.strip_prefix("signorini_") {
                Some(name) => joined(&[name.to_string()], owned(rest)),
                None => joined(&self.module, owned(segments)),
            },
        };
        Some(path)
    }
}

fn joined(head: &[String], tail: impl IntoIterator<Item = String>) -> ModulePath {
    head.iter().cloned().chain(tail).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(text: &str) -> ModulePath {
        text.split("::").map(ToString::to_string).collect()
    }

    fn found(source: &str) -> Vec<(String, usize)> {
        let found = imports(source, &path("mechanics::contact::law"));
        let line = |i: &Import| (i.path.join("::"), i.line);
        found.imports.iter().map(line).collect()
    }

    fn paths(source: &str) -> Vec<String> {
        found(source).into_iter().map(|(path, _)| path).collect()
    }

    #[test]
    fn use_trees_are_opened_leaf_by_leaf() {
        let source = "use crate::system::{\n    Dof,\n    linear::{self, Values as V},\n    sparsity::*,\n};";
        let expected = [
            ("mechanics::system::Dof", 2),
            ("mechanics::system::linear", 3),
            ("mechanics::system::linear::Values", 3),
            ("mechanics::system::sparsity", 4),
        ];
        assert_eq!(found(source), expected.map(|(p, l)| (p.to_string(), l)));
        assert_eq!(
            paths("use {crate::a, signorini_geometry as g};"),
            ["mechanics::a", "geometry"]
        );
    }

    #[test]
    fn super_and_self_are_resolved_also_inside_modules_written_in_place() {
        assert_eq!(
            paths("use super::row::Rows;"),
            ["mechanics::contact::row::Rows"]
        );
        assert_eq!(paths("use super::super::system;"), ["mechanics::system"]);
        assert_eq!(paths("use self::a::B;"), ["mechanics::contact::law::a::B"]);
        let source = "mod a { fn f() { if x {} } use super::b; } use super::c;";
        assert_eq!(
            paths(source),
            ["mechanics::contact::law::b", "mechanics::contact::c"]
        );
        assert_eq!(paths("use super::super::super::super::x;"), [""; 0]);
    }

    #[test]
    fn paths_in_code_are_found_and_those_in_comments_and_strings_are_not() {
        let source = "fn f(x: &signorini_geometry::tensor::Vec3) -> <crate::system::Dof as T>::X {\n\
                      // crate::a::b\n let y = \"crate::c\"; crate::solve::newton::<f64>() }";
        let expected = [
            "geometry::tensor::Vec3",
            "mechanics::system::Dof",
            "mechanics::solve::newton",
        ];
        assert_eq!(paths(source), expected);
        assert_eq!(paths("pub(in crate::contact) fn f() {}"), [""; 0]);
        assert_eq!(
            paths("fn f() -> impl Fn() + use<'_> {} use crate::a;"),
            ["mechanics::a"]
        );
    }

    #[test]
    fn foreign_paths_stay_inside_the_module() {
        assert_eq!(
            paths("use std::fmt;"),
            ["mechanics::contact::law::std::fmt"]
        );
    }

    #[test]
    fn what_only_tests_see_is_left_out() {
        let source = "#[cfg(test)]\nmod tests { use crate::a; fn f() {} }\nuse crate::b;";
        assert_eq!(paths(source), ["mechanics::b"]);
        assert_eq!(
            paths("#[cfg(test)] use crate::a; use crate::b;"),
            ["mechanics::b"]
        );
        assert_eq!(
            paths(
                "#[cfg(all(test, unix))] #[allow(x)] pub fn f(a: [u8; 3]) { crate::a::f() } use crate::b;"
            ),
            ["mechanics::b"]
        );
        assert_eq!(paths("#[cfg(not(test))] use crate::a;"), ["mechanics::a"]);
        assert_eq!(paths("#![cfg(test)] use crate::a;"), [""; 0]);
        let declared = imports("#[cfg(test)]\nmod tests;\nmod b;", &path("io::fs"));
        assert_eq!(declared.tests, [path("io::fs::tests")]);
    }
}
