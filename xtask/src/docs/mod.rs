//! Whether what the Markdown files of the repository name exists.
//!
//! | named by | has to be |
//! |---|---|
//! | a link, a path between backquotes | a file or folder, and a heading behind `#` |
//! | a command in a block or between backquotes | a subcommand with these options, a script, a package, a test |
//! | a block in TOML, a key or a value between backquotes | in the schema of cases |
//! | a path of Rust or a single word between backquotes | defined in the sources, or a word that programs read or write |
//! | a table of rooms or of traits | what `ROOMS` and the sources say, see `tables.rs` |
//!
//! Everything is looked up where it is defined: sources by `syn`, packages by `cargo metadata`, options and keys by
//! the command itself, `cargo run --release -- …`, which is built for it.
//!
//! Limits: texts with spaces that are no command and no TOML, formulas above all, are not looked at; what a program of
//! others takes neither. Symbols of at most two letters are formulas. The fragments in `changes/` are history.
//!
//! To add a kind: a case in `spans.rs`.

mod commands;
mod keys;
mod markdown;
mod python;
mod reference;
mod spans;
mod symbols;
mod tables;
mod toml;

use crate::fault::Fault;
use crate::tree::Tree;
use crate::tree::read;
use crate::{ChoreError, Outcome, cargo};
use commands::{Packages, Program, Script};
use keys::Keys;
use markdown::{Page, Piece};
use reference::Examples;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;
use symbols::Symbols;

/// What is known of the repository.
struct Facts {
    tree: Tree,
    program: Program,
    packages: Packages,
    scripts: Vec<Script>,
    keys: Keys,
    symbols: Symbols,
}

/// The schema of cases itself, for the editors of those who open an example.
const SCHEMA: &str = "docs/case.schema.json";

/// Checks all pages and prints their faults.
pub(crate) fn check(root: &Path) -> Outcome {
    let facts = Facts::read(root)?;
    let (mut pages, mut faults) = (Vec::new(), Vec::new());
    for path in facts.tree.files().filter(|path| is_page(path)) {
        let source = read(&root.join(path))?;
        let of_tables = tables::faults(&source, &facts.symbols).into_iter();
        faults.extend(of_tables.map(|(line, what)| Fault {
            path: path.to_path_buf(),
            line,
            what,
        }));
        pages.push(markdown::page(path.to_path_buf(), &source));
    }
    faults.append(&mut judge(&pages, &facts));
    let examples = examples(root, facts.keys.schema())?;
    faults.extend(stale_keys(root, &facts.keys, &examples));
    faults.sort();
    for fault in &faults {
        println!("{fault}");
    }
    let nname: usize = pages.iter().map(|page| page.pieces.len()).sum();
    println!(
        "docs: {} pages, {nname} names, links and blocks, {} wrong",
        pages.len(),
        faults.len()
    );
    Ok(faults.is_empty())
}

/// Writes the schema, the page of all keys, and their classes for Python.
pub(crate) fn write_keys(root: &Path) -> Outcome {
    let schema = json("signorini schema", &signorini(root, &["schema"])?)?;
    for (path, text) in written_from(&schema, &examples(root, &schema)?) {
        let path = root.join(path);
        if let Err(source) = std::fs::write(&path, text) {
            return Err(ChoreError::Write { path, source });
        }
    }
    Ok(true)
}

/// Pages that are written from the program, and compared with it.
const WRITTEN: [&str; 4] = [
    reference::PATH,
    "docs/messages.md",
    "docs/commands.md",
    "docs/python-api.md",
];

/// Values of keys that the case of the tests leaves out.
const MORE_KEYS: &str = include_str!("keys.toml");

/// Values of keys, from the case that gives all of them.
fn examples(root: &Path, schema: &serde_json::Value) -> Result<Examples, ChoreError> {
    let case = read(&root.join(reference::CASE))?;
    if let Some(fault) = Keys::new(schema.clone()).faults(MORE_KEYS).first() {
        return Err(ChoreError::Failed {
            what: "xtask/src/docs/keys.toml".to_string(),
            reason: format!("byte {}: {}", fault.at, fault.what),
        });
    }
    Examples::new(schema, [&case, MORE_KEYS]).map_err(|error| ChoreError::Failed {
        what: reference::CASE.to_string(),
        reason: error.to_string(),
    })
}

/// What is written from the schema: files and their text.
fn written_from(schema: &serde_json::Value, examples: &Examples) -> [(&'static str, String); 3] {
    [
        // values of JSON can be written
        (SCHEMA, format!("{schema:#}\n")),
        (reference::PATH, reference::page(schema, examples)),
        (python::PATH, python::module(schema)),
    ]
}

/// Files of keys that are not what the schema says.
fn stale_keys(root: &Path, keys: &Keys, examples: &Examples) -> Vec<Fault> {
    let all = written_from(keys.schema(), examples).into_iter();
    all.filter_map(|(path, wanted)| stale(root, path, &wanted))
        .collect()
}

fn stale(root: &Path, path: &str, wanted: &str) -> Option<Fault> {
    let found = std::fs::read_to_string(root.join(path)).unwrap_or_default();
    let differ = wanted.lines().zip(found.lines()).position(|(a, b)| a != b);
    (wanted != found).then(|| Fault {
        path: PathBuf::from(path),
        line: differ.unwrap_or_else(|| found.lines().count().min(wanted.lines().count())) + 1,
        what: "this is not what the schema of cases says: run `cargo xtask keys`".to_string(),
    })
}

/// Whether a file is a page to check: all Markdown but the fragments of the list of changes.
fn is_page(path: &Path) -> bool {
    let is_fragment = path.parent() == Some(Path::new("changes"))
        && path.file_name().is_some_and(|name| name != "README.md");
    path.extension().is_some_and(|ending| ending == "md") && !is_fragment
}

fn judge(pages: &[Page], facts: &Facts) -> Vec<Fault> {
    let by_path: BTreeMap<&Path, &Page> = pages
        .iter()
        .map(|page| (page.path.as_path(), page))
        .collect();
    let mut out = Vec::new();
    for page in pages {
        for (line, piece) in &page.pieces {
            let found = match piece {
                Piece::Code(_) if WRITTEN.iter().any(|path| page.path == Path::new(path)) => {
                    Vec::new()
                }
                Piece::Code(text) => at_start(spans::faults(text, &page.path, facts)),
                Piece::Link(to) => at_start(link_faults(to, page, &by_path, facts)),
                Piece::Block { language, text } => block_faults(language, text, &page.path, facts),
            };
            out.extend(found.into_iter().map(|(below, what)| Fault {
                path: page.path.clone(),
                line: line + below,
                what,
            }));
        }
    }
    out.sort();
    out
}

fn at_start(faults: Vec<String>) -> Vec<(usize, String)> {
    faults.into_iter().map(|what| (0, what)).collect()
}

fn link_faults(
    to: &str,
    page: &Page,
    pages: &BTreeMap<&Path, &Page>,
    facts: &Facts,
) -> Vec<String> {
    if to.contains("://") || to.starts_with("mailto:") {
        return Vec::new();
    }
    let (file, anchor) = to
        .split_once('#')
        .map_or((to, None), |(file, anchor)| (file, Some(anchor)));
    if !file.is_empty() && !facts.tree.has_from(&page.path, file) {
        return vec![format!("the link leads to {file}, which does not exist")];
    }
    let target = if file.is_empty() {
        Some(page)
    } else {
        let folder = page.path.parent().unwrap_or(Path::new(""));
        crate::tree::normal(&folder.join(file)).and_then(|path| pages.get(path.as_path()).copied())
    };
    let has = |anchor: &str| target.is_none_or(|page| page.anchors.contains(anchor));
    let lost = anchor.filter(|anchor| !has(anchor));
    lost.map(|anchor| format!("the link leads to the heading #{anchor}, which does not exist"))
        .into_iter()
        .collect()
}

/// Faults of a block of code, each with how many lines it lies below the first.
fn block_faults(language: &str, text: &str, page: &Path, facts: &Facts) -> Vec<(usize, String)> {
    match language {
        "toml" => {
            let place = |at: usize| text[..at.min(text.len())].matches('\n').count();
            let found = facts.keys.faults(text).into_iter();
            found.map(|fault| (place(fault.at), fault.what)).collect()
        }
        "sh" => each_command(text, |line| Some(line), page, facts),
        "console" => each_command(text, |line| line.strip_prefix("$ "), page, facts),
        "" if text.lines().any(commands::is_command) => {
            vec![(
                0,
                "a block of commands has no language: write ```sh, with # before remarks"
                    .to_string(),
            )]
        }
        _ => Vec::new(),
    }
}

fn each_command(
    text: &str,
    command: impl Fn(&str) -> Option<&str>,
    page: &Path,
    facts: &Facts,
) -> Vec<(usize, String)> {
    let lines = text.lines().enumerate();
    let commands = lines.filter_map(|(below, line)| Some((below, command(line)?)));
    let found = commands.flat_map(|(below, line)| {
        commands::faults(line, page, facts)
            .into_iter()
            .map(move |what| (below, what))
    });
    found.collect()
}

impl Facts {
    fn read(root: &Path) -> Result<Self, ChoreError> {
        let tree = Tree::read(root)?;
        let mut symbols = Symbols::default();
        let mut scripts = Vec::new();
        for path in tree.files() {
            let file = root.join(path);
            match path.extension().and_then(|ending| ending.to_str()) {
                Some("rs") => symbols.add_rust(path, &read(&file)?)?,
                Some("py") => {
                    let text = read(&file)?;
                    symbols.add_python(&text);
                    scripts.push(Script {
                        path: path.to_path_buf(),
                        text,
                    });
                }
                Some("geo" | "c") => symbols.add_data(&read(&file)?, "//"),
                _ if path.ends_with("case.toml") => symbols.add_data(&read(&file)?, "#"),
                _ => {}
            }
        }
        let metadata = output(root, &["metadata", "--no-deps", "--format-version", "1"])?;
        let help = signorini(root, &["--help"])?;
        let mut program = Program::default();
        for subcommand in Program::subcommands(&help) {
            let page = if subcommand == "help" {
                String::new()
            } else {
                signorini(root, &[&subcommand, "--help"])?
            };
            program.add(&subcommand, &page);
        }
        Ok(Self {
            packages: Packages::new(&json("cargo metadata", &metadata)?),
            keys: Keys::new(json("signorini schema", &signorini(root, &["schema"])?)?),
            tree,
            program,
            scripts,
            symbols,
        })
    }
}

fn json(what: &str, text: &str) -> Result<serde_json::Value, ChoreError> {
    serde_json::from_str(text).map_err(|error| ChoreError::Failed {
        what: what.to_string(),
        reason: error.to_string(),
    })
}

/// What the program prints: the one that the variable `SIGNORINI` names, else the one of this tree, built where it is not.
fn signorini(root: &Path, arguments: &[&str]) -> Result<String, ChoreError> {
    match std::env::var_os("SIGNORINI") {
        Some(program) => printed(root, &program, arguments),
        None => output(
            root,
            &[&["run", "--quiet", "--release", "--"], arguments].concat(),
        ),
    }
}

/// What cargo prints.
fn output(root: &Path, arguments: &[&str]) -> Result<String, ChoreError> {
    printed(root, &cargo(), arguments)
}

fn printed(root: &Path, program: &OsStr, arguments: &[&str]) -> Result<String, ChoreError> {
    let failed = |reason: String| ChoreError::Failed {
        what: format!("{} {}", program.display(), arguments.join(" ")),
        reason,
    };
    let ended = Command::new(program)
        .args(arguments)
        .current_dir(root)
        .output();
    let ended = ended.map_err(|error| failed(error.to_string()))?;
    if !ended.status.success() {
        return Err(failed(String::from_utf8_lossy(&ended.stderr).into_owned()));
    }
    Ok(String::from_utf8_lossy(&ended.stdout).into_owned())
}

#[cfg(test)]
mod tests;
