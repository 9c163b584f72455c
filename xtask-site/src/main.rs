//! The documentation as a site: `cargo xtask site`.
//!
//! ```text
//! cargo xtask site                    docs/ becomes target/site/index.html, and every link is checked
//! cargo xtask site --results DIR      the gallery shows the runs in DIR, one folder of results for each example
//! cargo xtask site --manual DIR       with the verification manual that `signorini verify --manual DIR` writes
//! cargo xtask site --rust DIR         with the reference of the libraries, target/doc after `cargo doc --workspace --no-deps`
//! ```
//!
//! Pages are in `docs/`, their order is in `docs/SUMMARY.md`. mdBook renders them; formulas become MathML here, so that
//! no script has to run and no network has to answer. A link from a page to a file of the repository leads to a copy of
//! that file in the site.
//!
//! Exit codes: 0 the site is complete, 1 a link or a formula is broken or a page is in no chapter, 2 the command line is
//! wrong or a file cannot be read or written.

mod book;
mod examples;
mod formulas;
mod links;
mod markdown;
mod places;
mod rendered;

use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What is to be built.
#[derive(Debug, Default, PartialEq, Eq)]
struct Options {
    /// Folders of results, one for each example.
    results: Option<PathBuf>,
    /// The verification manual in Markdown.
    manual: Option<PathBuf>,
    /// The output of `cargo doc`.
    rust: Option<PathBuf>,
    /// Where the site goes.
    out: Option<PathBuf>,
}

impl Options {
    fn parse(mut words: impl Iterator<Item = String>) -> Result<Self> {
        let mut options = Self::default();
        while let Some(word) = words.next() {
            let place = match word.as_str() {
                "--results" => &mut options.results,
                "--manual" => &mut options.manual,
                "--rust" => &mut options.rust,
                "--out" => &mut options.out,
                _ => bail!(
                    "unknown option \"{word}\"; there are --results, --manual, --rust and --out"
                ),
            };
            let value = words
                .next()
                .with_context(|| format!("{word} needs a folder"))?;
            *place = Some(PathBuf::from(value));
        }
        Ok(options)
    }
}

fn main() -> ExitCode {
    let built = Options::parse(std::env::args().skip(1)).and_then(|options| build(&options));
    match built {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("cargo xtask site: {error:#}");
            ExitCode::from(2)
        }
    }
}

/// Builds the site and checks it; false where something is broken.
fn build(options: &Options) -> Result<bool> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .context("the program does not lie inside the repository")?;
    let target = target_folder(root)?;
    let out = options.out.clone().unwrap_or_else(|| target.join("site"));
    let staged = book::stage(root, &target.join("site-sources"), options)?;
    rendered::render(&staged, &out)?;
    let checked = links::check(&out)?;
    for fault in staged.faults.iter().chain(&checked.faults) {
        println!("{fault}");
    }
    let nfault = staged.faults.len() + checked.faults.len();
    println!(
        "site: {} pages, {} formulas, {} links, {} pictures and files, {} links out of the site, {nfault} broken",
        checked.npage, staged.nformula, checked.nlink, checked.nfile, checked.nexternal
    );
    println!("site: {}", out.join("index.html").display());
    Ok(nfault == 0)
}

/// The folder of built files, as Cargo has it.
fn target_folder(root: &Path) -> Result<PathBuf> {
    let metadata = places::metadata(root, &["--no-deps"])?;
    let target = metadata
        .get("target_directory")
        .and_then(|value| value.as_str());
    target
        .map(PathBuf::from)
        .context("cargo metadata names no target folder")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(words: &[&str]) -> Result<Options> {
        Options::parse(words.iter().map(ToString::to_string))
    }

    #[test]
    fn options_name_folders() {
        let options = parse(&["--results", "runs", "--out", "site"]).unwrap();
        assert_eq!(options.results, Some(PathBuf::from("runs")));
        assert_eq!(options.out, Some(PathBuf::from("site")));
        assert_eq!(options.manual, None);
    }

    #[test]
    fn unknown_options_and_options_without_a_folder_are_refused() {
        for words in [&["--result", "runs"][..], &["--manual"]] {
            assert!(parse(words).is_err(), "{words:?}");
        }
    }
}
