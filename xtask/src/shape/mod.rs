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

use crate::fault::Fault;
use crate::tree::{self, Tree};
use crate::{ChoreError, Outcome};
use std::path::{Path, PathBuf};
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

/// A source of Rust, parsed.
struct Source {
    path: PathBuf,
    nline: usize,
    file: syn::File,
}

/// A function with its body: free, of a type, or a default of a trait.
struct Function<'a> {
    attributes: &'a [syn::Attribute],
    signature: &'a syn::Signature,
    block: &'a syn::Block,
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

    /// All functions, those inside of functions too.
    fn functions(&self) -> Vec<Function<'_>> {
        let mut found = Functions(Vec::new());
        found.visit_file(&self.file);
        found.0
    }

    fn fault(&self, at: &impl Spanned, what: String) -> Fault {
        Fault {
            path: self.path.clone(),
            line: at.span().start().line,
            what,
        }
    }
}

/// Functions as they are met.
struct Functions<'a>(Vec<Function<'a>>);

impl<'a> Functions<'a> {
    fn add(
        &mut self,
        attributes: &'a [syn::Attribute],
        signature: &'a syn::Signature,
        block: &'a syn::Block,
    ) {
        self.0.push(Function {
            attributes,
            signature,
            block,
        });
    }
}

impl<'a> Visit<'a> for Functions<'a> {
    fn visit_item_fn(&mut self, function: &'a syn::ItemFn) {
        self.add(&function.attrs, &function.sig, &function.block);
        visit::visit_item_fn(self, function);
    }

    fn visit_impl_item_fn(&mut self, function: &'a syn::ImplItemFn) {
        self.add(&function.attrs, &function.sig, &function.block);
        visit::visit_impl_item_fn(self, function);
    }

    fn visit_trait_item_fn(&mut self, function: &'a syn::TraitItemFn) {
        if let Some(block) = &function.default {
            self.add(&function.attrs, &function.sig, block);
        }
        visit::visit_trait_item_fn(self, function);
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
    let sources = sources(root)?;
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

fn sources(root: &Path) -> Result<Vec<Source>, ChoreError> {
    let tree = Tree::read(root)?;
    let is_rust = |path: &&Path| path.extension().is_some_and(|ending| ending == "rs");
    let mut sources = Vec::new();
    for path in tree.files().filter(is_rust) {
        sources.push(Source::new(path, &tree::read(&root.join(path))?)?);
    }
    Ok(sources)
}
