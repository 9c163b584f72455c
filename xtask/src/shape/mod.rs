//! Whether the sources keep the shape that the house asks for.
//!
//! | what | at most |
//! |---|---|
//! | lines of a function, signature and braces included | 100 |
//! | lines of a source file | 800 |
//! | tests with a number of a list for a name: `f01_hertz`, `test_3` | 0 |
//! | methods with a default that exactly one implementor overrides, tests left out | 0 |
//!
//! A default that one implementor overrides belongs to that implementor, or to a trait of its own.
//!
//! Limits: traits are matched by the last word of their path; what macros make is not seen.

mod names;
mod overrides;
mod sizes;

use crate::tree::Tree;
use crate::{ChoreError, Outcome};
use std::fmt;
use std::path::{Path, PathBuf};
use syn::spanned::Spanned;

/// A source of Rust, parsed.
struct Source {
    path: PathBuf,
    nline: usize,
    file: syn::File,
}

/// A place that breaks a rule.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Fault {
    path: PathBuf,
    line: usize,
    what: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.path.display(), self.line, self.what)
    }
}

impl Source {
    fn new(path: &Path, text: &str) -> Result<Self, ChoreError> {
        let file = syn::parse_file(text).map_err(|error| ChoreError::Failed {
            what: format!("the parser of {}", path.display()),
            reason: error.to_string(),
        })?;
        Ok(Self {
            path: path.to_path_buf(),
            nline: text.lines().count(),
            file,
        })
    }

    fn fault(&self, at: &impl Spanned, what: String) -> Fault {
        Fault {
            path: self.path.clone(),
            line: at.span().start().line,
            what,
        }
    }
}

/// What finds the places that break a rule.
type Rule = fn(&[Source]) -> Vec<Fault>;

/// Whether attributes say that only tests see an item.
fn is_for_tests(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute
                .parse_args::<syn::Ident>()
                .is_ok_and(|word| word == "test")
    })
}

/// Prints each place that breaks a rule, and counts them by rule.
pub fn check(root: &Path) -> Outcome {
    let sources = read(root)?;
    let rules: [(&str, Rule); 4] = [
        ("functions over 100 lines", sizes::functions),
        ("files over 800 lines", sizes::files),
        ("tests named by a number", names::numbered),
        (
            "defaults that one implementor overrides",
            overrides::singular,
        ),
    ];
    let mut holds = true;
    for (rule, find) in rules {
        let mut faults = find(&sources);
        faults.sort();
        for fault in &faults {
            println!("{fault}");
        }
        println!("{}: {rule}", faults.len());
        holds &= faults.is_empty();
    }
    Ok(holds)
}

fn read(root: &Path) -> Result<Vec<Source>, ChoreError> {
    let tree = Tree::read(root)?;
    let is_rust = |path: &&Path| path.extension().is_some_and(|ending| ending == "rs");
    let mut sources = Vec::new();
    for path in tree.files().filter(is_rust) {
        let full = root.join(path);
        let text = std::fs::read_to_string(&full)
            .map_err(|source| ChoreError::Read { path: full, source })?;
        sources.push(Source::new(path, &text)?);
    }
    Ok(sources)
}
