//! Reading a case: from the text of users to plain structs, with all errors of a file at once.
//!
//! ```text
//! bytes ──decode──▶ text ──parse──▶ tables ──set──▶ tables ──check──▶ tables ──build──▶ Case
//!         UTF-8             TOML             --set           vocabulary        names, references
//! ```
//!
//! Every stage reports all it finds; a later stage runs only on what an earlier one left sound. The
//! [`vocabulary`] holds every key once: reading, the list of keys in messages, the JSON [`schema()`] and the
//! [`resolved()`] case follow it. What refers to the mesh is checked where the mesh is known.
//!
//! To add a key: one line in `vocabulary`, one field in `parts`, one line each in `build` and `resolved`.

mod build;
mod check;
mod fields;
pub mod keys;
#[doc(hidden)]
pub mod mutate;
mod origin;
mod overrides;
mod parts;
mod resolved;
mod scalar;
mod schema;
mod syntax;
#[cfg(test)]
mod tests;
mod text;
mod units;
pub mod vocabulary;

pub use parts::*;
pub use resolved::resolved;
pub use schema::schema;

use std::path::Path;

use vocabulary::Vocabulary;

use crate::diagnostic::{Diagnostic, Diagnostics, Severity, SourceFile, codes};

/// Reads a case from the bytes of a file called `name`, changed by `--set` options (path, value).
///
/// Warnings come with the case.
///
/// # Errors
/// All errors of the text at once, each with its place, and warnings among them.
///
/// # Example
/// ```
/// use signorini_io::case::read_case;
/// use signorini_io::case::vocabulary::{Kinds, Vocabulary};
/// use signorini_mechanics::material;
///
/// let text = br#"
/// mesh     = { file = "block.msh" }
/// material = { steel = { model = "linear-elastic", E = 210e3, nu = 0.3 } }
/// body     = [{ group = "block", material = "steel" }]
/// step     = [{ name = "press", fix = [{ on = "base", u = "all" }] }]
/// "#;
/// let vocabulary = Vocabulary::new(Kinds {
///     materials: material::descriptions(),
///     ..Kinds::default()
/// });
/// let set = [("material.steel.nu".to_owned(), "0.25".to_owned())];
/// let (case, warnings) = read_case("block.toml", text, &set, &vocabulary).unwrap();
/// assert_eq!(case.materials[0].number("nu"), Some(0.25));
/// assert!(warnings.is_empty());
///
/// let errors = read_case("block.toml", b"mehs = 1", &[], &vocabulary).unwrap_err();
/// assert!(errors.plain().contains("did you mean `mesh`?"));
/// ```
pub fn read_case(
    name: &str,
    bytes: &[u8],
    overrides: &[(String, String)],
    vocabulary: &Vocabulary,
) -> Result<(Case, Diagnostics), Diagnostics> {
    let text = text::decode(name, bytes)?;
    let holds_something =
        |line: &str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
    if !text.lines().any(holds_something) {
        return Err(Diagnostic::error(&codes::EMPTY, format!("{name} is empty"))
            .help("start from a template: signorini init")
            .into());
    }
    let file = SourceFile::new(name, text);
    let mut origins = origin::Origins::new(file.clone());
    let syntax::Parsed {
        mut table,
        errors,
        sound,
    } = syntax::parse(file.text(), &origins);
    if !sound {
        return Err(errors);
    }
    let spoilt: Vec<_> = errors
        .iter()
        .filter_map(|one| Some(origins.line(one.labels.first()?.span.start)))
        .collect();

    let wrong_options = overrides::apply(&mut table, overrides, vocabulary.case, &mut origins);
    let mut found = check::check(&table, vocabulary.case, &origins);
    let (case, more) = build::build(&table, vocabulary, &origins);
    found.append(more);
    // What stands on a line that is no TOML has been reported already.
    found.retain(|one| {
        one.labels.first().is_none_or(|label| {
            let line = label.file.line_index(label.span.start);
            label.file.name() != name || !spoilt.contains(&(0, line))
        })
    });
    found.append(errors);
    found.sort_by_place();
    let mut all = wrong_options;
    all.append(found);
    if all.has_errors() {
        return Err(all);
    }
    all.append(units::plausibility(&case));
    let allowed: Vec<&str> = case.allow.iter().map(String::as_str).collect();
    all.silence(&allowed);
    debug_assert!(all.iter().all(|one| one.severity != Severity::Error));
    Ok((case, all))
}

/// Reads the case in a file.
///
/// # Errors
/// As [`read_case`], and when the file cannot be read.
pub fn read_case_file(
    path: &Path,
    overrides: &[(String, String)],
    vocabulary: &Vocabulary,
) -> Result<(Case, Diagnostics), Diagnostics> {
    let name = path.display().to_string();
    if path.is_dir() {
        return Err(
            Diagnostic::error(&codes::UNREADABLE, format!("{name} is a directory"))
                .help("name the case in it")
                .into(),
        );
    }
    match std::fs::read(path) {
        Ok(bytes) => read_case(&name, &bytes, overrides, vocabulary),
        Err(error) => {
            let mut one = Diagnostic::error(
                &codes::UNREADABLE,
                format!("{name} cannot be read: {error}"),
            );
            if let Ok(here) = std::env::current_dir() {
                one = one.note(format!("the current directory is {}", here.display()));
            }
            Err(one.into())
        }
    }
}
