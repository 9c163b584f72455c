//! The sources of the site, put together from the pages of the repository.
//!
//! `docs/SUMMARY.md` has the chapters. Under the gallery stands a chapter for each example, under the verification manual
//! one for each of its pages. What pages link to and is no chapter is copied to `files/`; a linked folder gets a page that
//! lists it.

use crate::Options;
use crate::examples::{self, Example};
use crate::markdown::{self, Written};
use crate::places::{metadata, normal, page_of, relative};
use anyhow::{Context, Result};
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Sources that mdBook can render.
#[derive(Debug)]
pub struct Staged {
    /// The folder of the book; its sources are in `src`.
    pub folder: PathBuf,
    /// Formulas on all pages.
    pub nformula: usize,
    /// What is wrong with the pages.
    pub faults: Vec<String>,
}

const SUMMARY: &str = "docs/SUMMARY.md";
const GALLERY: &str = "docs/gallery.md";
const MANUAL: &str = "docs/manual.md";
const RUST: &str = "docs/rust.md";

/// Style of the site beyond that of mdBook.
const STYLE: &str = include_str!("site.css");

/// A book that is being put together.
struct Stage<'a> {
    root: &'a Path,
    sources: PathBuf,
    /// The page of the site of every chapter, by its path in the repository.
    pages: BTreeMap<PathBuf, PathBuf>,
    /// Files and folders of the repository that pages lead to.
    linked: BTreeSet<PathBuf>,
    nformula: usize,
    faults: Vec<String>,
}

/// Puts the sources together in a folder, which is cleared before.
pub fn stage(root: &Path, folder: &Path, options: &Options) -> Result<Staged> {
    if folder.exists() {
        std::fs::remove_dir_all(folder)
            .with_context(|| format!("cannot clear {}", folder.display()))?;
    }
    let examples = examples::list(root)?;
    let summary = read(&root.join(SUMMARY))?;
    let manual = options.manual.as_deref().map(manual_pages).transpose()?;
    let mut stage = Stage {
        root,
        sources: folder.join("src"),
        pages: chapters(&summary, &examples),
        linked: BTreeSet::new(),
        nformula: 0,
        faults: Vec::new(),
    };
    stage.orphans()?;
    let summary = with_chapters(&summary, &examples, manual.as_deref().unwrap_or_default());
    stage.page(Path::new(SUMMARY), &summary)?;
    let chapters: Vec<PathBuf> = stage.pages.keys().cloned().collect();
    for path in chapters.iter().filter(|path| *path != Path::new(SUMMARY)) {
        let source = read(&root.join(path))?;
        let source = stage.filled(path, &source, &examples, options)?;
        stage.page(path, &source)?;
    }
    if let Some(manual) = &options.manual {
        copy_folder(manual, &stage.sources.join("manual"))?;
    }
    if let Some(rust) = &options.rust {
        copy_folder(rust, &stage.sources.join("rust"))?;
    }
    stage.files()?;
    stage.styles()?;
    Ok(Staged {
        folder: folder.to_path_buf(),
        nformula: stage.nformula,
        faults: stage.faults,
    })
}

impl Stage<'_> {
    /// Names pages of `docs/` that are no chapter: nobody would find them.
    fn orphans(&mut self) -> Result<()> {
        let mut files = Vec::new();
        walk(&self.root.join("docs"), &mut files)?;
        for file in files {
            let path = file.strip_prefix(self.root).unwrap_or(&file);
            let is_page = path.extension() == Some(OsStr::new("md"));
            if is_page && !self.pages.contains_key(path) {
                self.faults
                    .push(format!("{}: no chapter of {SUMMARY}", path.display()));
            }
        }
        Ok(())
    }

    /// A page with what is made when the site is built.
    fn filled(
        &mut self,
        path: &Path,
        source: &str,
        examples: &[Example],
        options: &Options,
    ) -> Result<String> {
        let (mark, text) = match path.to_str() {
            Some(GALLERY) => {
                let pictures = self.sources.join("pictures");
                let gallery = examples::gallery(examples, options.results.as_deref(), &pictures)?;
                self.faults.extend(gallery.faults);
                ("<!-- gallery -->", gallery.text)
            }
            Some(MANUAL) => ("<!-- manual -->", manual_text(options)),
            Some(RUST) => ("<!-- rust -->", rust_text(options)?),
            _ => return Ok(source.to_string()),
        };
        if !source.contains(mark) {
            self.faults
                .push(format!("{}: {mark} is missing", path.display()));
        }
        Ok(source.replace(mark, &text))
    }

    /// Writes a page for mdBook.
    fn page(&mut self, path: &Path, source: &str) -> Result<()> {
        let page = page_of(path);
        let folder = path.parent().unwrap_or(Path::new(""));
        let (pages, linked) = (&self.pages, &mut self.linked);
        let written = markdown::rewrite(source, |to| {
            lead(&page, folder, to, self.root, pages, linked)
        });
        let Written {
            text,
            nformula,
            faults,
        } = written;
        self.nformula += nformula;
        let named = |(line, what): (usize, String)| format!("{}:{line}: {what}", path.display());
        self.faults.extend(faults.into_iter().map(named));
        write(&self.sources.join(page), text.as_bytes())
    }

    /// Copies what pages lead to, and lists folders.
    fn files(&mut self) -> Result<()> {
        let mut waiting: Vec<PathBuf> = std::mem::take(&mut self.linked).into_iter().collect();
        let mut done = BTreeSet::new();
        while let Some(path) = waiting.pop() {
            if !done.insert(path.clone()) {
                continue;
            }
            let place = self.root.join(&path);
            if place.is_dir() {
                let (text, inside) = listing(&place, &path)?;
                write(&self.sources.join(copy_of(&path, true)), text.as_bytes())?;
                waiting.extend(inside);
            } else {
                let bytes = std::fs::read(&place)
                    .with_context(|| format!("cannot read {}", place.display()))?;
                write(&self.sources.join(copy_of(&path, false)), &bytes)?;
            }
        }
        Ok(())
    }

    /// The style sheets, and the fonts of formulas from the crate that writes them.
    fn styles(&self) -> Result<()> {
        let root = self.sources.parent().unwrap_or(&self.sources);
        write(&root.join("site.css"), STYLE.as_bytes())?;
        let metadata = metadata(self.root, &[])?;
        let packages = metadata
            .get("packages")
            .and_then(serde_json::Value::as_array);
        let manifest = packages.into_iter().flatten().find_map(|package| {
            let is_it = package.get("name")? == "pulldown-latex";
            package.get("manifest_path")?.as_str().filter(|_| is_it)
        });
        let manifest = manifest.context("cargo metadata does not know pulldown-latex")?;
        let from = Path::new(manifest)
            .parent()
            .context("pulldown-latex has no folder")?;
        let style = read(&from.join("styles.css"))?;
        write(&root.join("math/styles.css"), style.as_bytes())?;
        copy_folder(&from.join("font"), &self.sources.join("math/font"))
    }
}

/// Where a link of a page leads in the site: to a page, to the copy of a file, or, as none, where it led before.
fn lead(
    page: &Path,
    folder: &Path,
    to: &str,
    root: &Path,
    pages: &BTreeMap<PathBuf, PathBuf>,
    linked: &mut BTreeSet<PathBuf>,
) -> Option<String> {
    if to.contains("://") || to.starts_with("mailto:") || to.starts_with('#') {
        return None;
    }
    let (file, anchor) = to
        .split_once('#')
        .map_or((to, String::new()), |(file, anchor)| {
            (file, format!("#{anchor}"))
        });
    let path = normal(&folder.join(file))?;
    let of_folder = if path == Path::new("examples") {
        PathBuf::from(GALLERY)
    } else {
        path.join("README.md")
    };
    if let Some(chapter) = pages.get(&path).or_else(|| pages.get(&of_folder)) {
        return Some(relative(page, chapter) + &anchor);
    }
    let place = root.join(&path);
    if !place.exists() {
        return None;
    }
    let copy = copy_of(&path, place.is_dir());
    linked.insert(path);
    Some(relative(page, &copy) + &anchor)
}

/// Where the copy of a file, or the page that lists a folder, stands in the site. mdBook passes over names that begin with a
/// dot, and over Markdown.
fn copy_of(path: &Path, is_folder: bool) -> PathBuf {
    let names = path.components().map(|part| {
        let name = part.as_os_str().to_string_lossy();
        name.trim_start_matches('.').to_string()
    });
    let mut out: PathBuf = std::iter::once("files".to_string()).chain(names).collect();
    if is_folder {
        out.push("index.html");
    } else if out.extension() == Some(OsStr::new("md")) {
        out.set_extension("md.txt");
    }
    out
}

/// The pages of a table of contents and of the examples.
fn chapters(summary: &str, examples: &[Example]) -> BTreeMap<PathBuf, PathBuf> {
    let mut paths = vec![PathBuf::from(SUMMARY)];
    markdown::rewrite(summary, |to| {
        paths.extend(normal(&Path::new("docs").join(to)));
        None
    });
    paths.extend(examples.iter().map(|example| example.page.clone()));
    let named = |path: PathBuf| {
        let page = page_of(&path);
        (path, page)
    };
    paths.into_iter().map(named).collect()
}

/// The table of contents with the chapters that are not in the repository's own.
fn with_chapters(summary: &str, examples: &[Example], manual: &[(String, String)]) -> String {
    let mut out = String::new();
    for line in summary.lines() {
        out.push_str(line);
        out.push('\n');
        let depth = line.len() - line.trim_start().len() + 4;
        if line.contains("(gallery.md)") {
            for example in examples {
                // writing to a string cannot fail
                let _ = writeln!(
                    out,
                    "{:depth$}- [{}](../{})",
                    "",
                    example.title,
                    example.page.display()
                );
            }
        }
        if line.contains("(manual.md)") {
            for (title, name) in manual {
                let _ = writeln!(out, "{:depth$}- [{title}](manual/{name})", "");
            }
        }
    }
    out
}

/// The pages of a verification manual with their titles, in the order of their names.
fn manual_pages(folder: &Path) -> Result<Vec<(String, String)>> {
    let mut files = Vec::new();
    walk(folder, &mut files)?;
    let mut pages = Vec::new();
    for file in files
        .iter()
        .filter(|file| file.extension() == Some(OsStr::new("md")))
    {
        let name = file.strip_prefix(folder).unwrap_or(file);
        let source = read(file)?;
        let title = markdown::title(&source).unwrap_or("Untitled").to_string();
        pages.push((title, name.to_string_lossy().into_owned()));
    }
    Ok(pages)
}

fn manual_text(options: &Options) -> String {
    let text = if options.manual.is_some() {
        "The chapters below this page are that manual, as it was made for this site."
    } else {
        "This site was built without the manual: `cargo xtask site --manual DIR` takes it in."
    };
    text.to_string()
}

/// Links to the libraries whose reference is there.
fn rust_text(options: &Options) -> Result<String> {
    let Some(folder) = &options.rust else {
        return Ok(
            "This site was built without the reference of the libraries: \
                   `cargo xtask site --rust target/doc` takes it in."
                .to_string(),
        );
    };
    let mut out = String::new();
    let mut names: Vec<String> = Vec::new();
    for entry in
        std::fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))?
    {
        let entry = entry?;
        if entry.path().join("index.html").exists() {
            names.push(entry.file_name().to_string_lossy().into_owned());
        }
    }
    names.sort();
    for name in names
        .iter()
        .filter(|name| *name != "src" && !name.starts_with("static"))
    {
        let _ = writeln!(out, "- [`{name}`](rust/{name}/index.html)");
    }
    Ok(out)
}

/// A page that lists a folder, and what it lists.
fn listing(place: &Path, path: &Path) -> Result<(String, Vec<PathBuf>)> {
    let name = path.display();
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{name}</title></head>\n\
         <body>\n<h1>{name}</h1>\n<ul>\n"
    );
    let mut inside = Vec::new();
    for entry in entries(place)? {
        let below = path.join(&entry);
        let copy = copy_of(&below, place.join(&entry).is_dir());
        let from = copy_of(path, true);
        // writing to a string cannot fail
        let _ = writeln!(
            out,
            "<li><a href=\"{}\">{entry}</a></li>",
            relative(&from, &copy)
        );
        inside.push(below);
    }
    out.push_str("</ul>\n</body>\n</html>\n");
    Ok((out, inside))
}

/// The names in a folder in their order, without what runs and tools leave there.
fn entries(folder: &Path) -> Result<Vec<String>> {
    let listed =
        std::fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))?;
    let mut names = Vec::new();
    for entry in listed {
        let name = entry?.file_name().to_string_lossy().into_owned();
        let is_left = name.starts_with('.')
            || name.ends_with(".out")
            || name == "target"
            || name == "__pycache__";
        if !is_left {
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}

/// All files under a folder, in order.
fn walk(folder: &Path, out: &mut Vec<PathBuf>) -> Result<()> {
    for name in entries(folder)? {
        let path = folder.join(name);
        if path.is_dir() {
            walk(&path, out)?;
        } else {
            out.push(path);
        }
    }
    Ok(())
}

fn copy_folder(from: &Path, to: &Path) -> Result<()> {
    let mut files = Vec::new();
    walk(from, &mut files)?;
    for file in files {
        let bytes =
            std::fs::read(&file).with_context(|| format!("cannot read {}", file.display()))?;
        write(&to.join(file.strip_prefix(from).unwrap_or(&file)), &bytes)?;
    }
    Ok(())
}

fn read(path: &Path) -> Result<String> {
    std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))
}

/// Writes a file and the folders that it needs.
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)
            .with_context(|| format!("cannot make {}", folder.display()))?;
    }
    std::fs::write(path, bytes).with_context(|| format!("cannot write {}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn repository(pages: &[(&str, &str)]) -> tempfile::TempDir {
        let root = tempfile::tempdir().unwrap();
        for (path, text) in pages {
            write(&root.path().join(path), text.as_bytes()).unwrap();
        }
        root
    }

    fn lead_from(root: &Path, page: &str, to: &str) -> (Option<String>, BTreeSet<PathBuf>) {
        let chapters = [
            "README.md",
            "docs/a.md",
            "docs/t/b.md",
            "examples/x/README.md",
        ];
        let pages = chapters.map(|path| (PathBuf::from(path), page_of(Path::new(path))));
        let mut linked = BTreeSet::new();
        let folder = Path::new(page).parent().unwrap();
        let to = lead(
            &page_of(Path::new(page)),
            folder,
            to,
            root,
            &pages.into_iter().collect(),
            &mut linked,
        );
        (to, linked)
    }

    #[test]
    fn links_lead_to_pages_copies_and_lists() {
        let root = repository(&[("scripts/s.py", ""), ("examples/x/case.toml", "")]);
        let to = |page: &str, to: &str| lead_from(root.path(), page, to).0;
        assert_eq!(
            to("docs/t/b.md", "../a.md#h"),
            Some("../a.md#h".to_string())
        );
        assert_eq!(to("README.md", "docs/a.md"), Some("a.md".to_string()));
        assert_eq!(
            to("docs/a.md", "../examples/x"),
            Some("examples/x.md".to_string())
        );
        assert_eq!(
            to("docs/a.md", "../scripts/s.py"),
            Some("files/scripts/s.py".to_string())
        );
        assert_eq!(
            to("docs/a.md", "../scripts"),
            Some("files/scripts/index.html".to_string())
        );
        assert_eq!(to("docs/a.md", "https://example.org"), None);
        let linked = lead_from(root.path(), "docs/a.md", "../scripts/s.py").1;
        assert!(linked.contains(Path::new("scripts/s.py")));
    }

    #[test]
    fn what_does_not_exist_stays_as_it_is_for_the_check_of_links() {
        let root = repository(&[]);
        assert_eq!(lead_from(root.path(), "docs/a.md", "lost.md").0, None);
    }

    #[test]
    fn examples_are_chapters_under_the_gallery() {
        let example = Example {
            name: "x".to_string(),
            title: "A ball".to_string(),
            page: PathBuf::from("examples/x/README.md"),
            case: None,
        };
        let summary = with_chapters(
            "# S\n\n- [Gallery](gallery.md)\n- [B](b.md)\n",
            &[example],
            &[],
        );
        assert_eq!(
            summary,
            "# S\n\n- [Gallery](gallery.md)\n    - [A ball](../examples/x/README.md)\n- [B](b.md)\n"
        );
    }
}
