//! Whether what the pages of a site lead to exists: pages, headings, pictures, scripts and style sheets.
//!
//! The HTML is read as a browser reads it. Links to other sites are not followed; they have to be addresses that can be.

use anyhow::{Context, Result};
use scraper::{Html, Selector};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::places::normal;

/// What was found.
#[derive(Debug, Default)]
pub struct Checked {
    /// Pages.
    pub npage: usize,
    /// Links to pages and headings of the site.
    pub nlink: usize,
    /// Pictures, scripts, style sheets and other files that pages name.
    pub nfile: usize,
    /// Links to other sites.
    pub nexternal: usize,
    /// What leads nowhere.
    pub faults: Vec<String>,
}

/// A page: the places that links can lead to, and what it leads to.
#[derive(Debug, Default)]
struct Page {
    anchors: BTreeSet<String>,
    links: Vec<String>,
    files: Vec<String>,
}

/// Reads all pages of a folder and looks up what they lead to.
pub fn check(site: &Path) -> Result<Checked> {
    let mut files = BTreeSet::new();
    list(site, Path::new(""), &mut files)?;
    let mut pages = BTreeMap::new();
    for path in files.iter().filter(|path| is_page(path)) {
        let text = std::fs::read_to_string(site.join(path))
            .with_context(|| format!("cannot read {}", path.display()))?;
        pages.insert(path.clone(), page(&text)?);
    }
    let mut checked = Checked {
        npage: pages.len(),
        ..Checked::default()
    };
    for (path, page) in &pages {
        for to in &page.links {
            if is_external(to) {
                checked.nexternal += 1;
                if !is_address(to) {
                    let what = format!("{}: the address {to} is none", path.display());
                    checked.faults.push(what);
                }
                continue;
            }
            checked.nlink += 1;
            checked.faults.extend(fault(path, to, &files, &pages));
        }
        for to in page.files.iter().filter(|to| !to.starts_with("data:")) {
            checked.nfile += 1;
            if is_external(to) {
                let what = format!("{}: {to} would need a network", path.display());
                checked.faults.push(what);
            } else {
                checked.faults.extend(fault(path, to, &files, &pages));
            }
        }
    }
    Ok(checked)
}

/// Pages of the site; the reference of the Rust libraries comes from rustdoc, which checks its own links.
fn is_page(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "html") && !path.starts_with("rust")
}

fn list(site: &Path, folder: &Path, out: &mut BTreeSet<PathBuf>) -> Result<()> {
    let place = site.join(folder);
    let entries =
        std::fs::read_dir(&place).with_context(|| format!("cannot list {}", place.display()))?;
    for entry in entries {
        let entry = entry?;
        let path = folder.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            list(site, &path, out)?;
        } else {
            out.insert(path);
        }
    }
    Ok(())
}

fn page(text: &str) -> Result<Page> {
    let select = |selector: &str| {
        Selector::parse(selector).map_err(|error| anyhow::anyhow!("{selector}: {error}"))
    };
    let html = Html::parse_document(text);
    let all = |selector: &str, attribute: &str| -> Result<Vec<String>> {
        let found = select(selector)?;
        let found = html
            .select(&found)
            .filter_map(|element| element.attr(attribute));
        Ok(found.map(str::to_string).collect())
    };
    let anchors = [all("[id]", "id")?, all("a[name]", "name")?].concat();
    let files = [
        all("img[src]", "src")?,
        all("script[src]", "src")?,
        all("iframe[src]", "src")?,
        all("link[href]", "href")?,
        all("video[src], source[src], embed[src]", "src")?,
    ];
    Ok(Page {
        anchors: anchors.into_iter().collect(),
        links: all("a[href]", "href")?,
        files: files.concat(),
    })
}

fn is_external(to: &str) -> bool {
    to.contains("://") || to.starts_with("//") || to.starts_with("mailto:")
}

/// Whether an address to elsewhere could be followed: a scheme, a host, no blanks.
fn is_address(to: &str) -> bool {
    let rest = ["https://", "http://", "mailto:"]
        .iter()
        .find_map(|scheme| to.strip_prefix(scheme));
    rest.is_some_and(|rest| {
        let host = rest.split(['/', '?', '#']).next().unwrap_or_default();
        (host.contains('.') || host.contains('@')) && !to.contains(char::is_whitespace)
    })
}

/// What is wrong with a link within the site.
fn fault(
    page: &Path,
    to: &str,
    files: &BTreeSet<PathBuf>,
    pages: &BTreeMap<PathBuf, Page>,
) -> Option<String> {
    let (file, anchor) = to
        .split_once('#')
        .map_or((to, None), |(file, anchor)| (file, Some(anchor)));
    let file = decoded(file.split('?').next().unwrap_or_default());
    let target = if file.is_empty() {
        Some(page.to_path_buf())
    } else {
        normal(&page.parent().unwrap_or(Path::new("")).join(&file))
    };
    let Some(target) = target.filter(|target| files.contains(target)) else {
        return Some(format!(
            "{}: {to} leads to a file that the site does not have",
            page.display()
        ));
    };
    let anchor = anchor.filter(|anchor| !anchor.is_empty())?;
    let anchor = decoded(anchor);
    let has = pages
        .get(&target)
        .is_none_or(|page| page.anchors.contains(&anchor));
    (!has).then(|| {
        format!(
            "{}: {to} leads to a heading that {} does not have",
            page.display(),
            target.display()
        )
    })
}

/// `%20` and the like as the bytes they stand for.
fn decoded(text: &str) -> String {
    let mut out = Vec::new();
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        let byte = match (first, after) {
            (b'%', [a, b, ..]) => std::str::from_utf8(&[*a, *b])
                .ok()
                .and_then(|pair| u8::from_str_radix(pair, 16).ok()),
            _ => None,
        };
        out.push(byte.unwrap_or(*first));
        rest = after
            .get(if byte.is_some() { 2 } else { 0 }..)
            .unwrap_or_default();
    }
    String::from_utf8_lossy(&out).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The faults of a site of two pages and a picture, the first page being this text.
    fn faults(text: &str) -> Vec<String> {
        let site = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            let path = site.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        };
        write("index.html", text);
        write(
            "sub/page.html",
            "<h1 id='top'>T</h1><a href='../index.html'>back</a>",
        );
        write("a picture.png", "");
        check(site.path()).unwrap().faults
    }

    #[test]
    fn what_exists_is_found() {
        let text = "<h2 id='here'>H</h2><a href='#here'>a</a><a href='sub/page.html#top'>b</a>\
                    <img src='a%20picture.png'><a href='https://example.org/x'>c</a>";
        assert_eq!(faults(text), Vec::<String>::new());
    }

    #[test]
    fn a_link_to_a_page_that_is_not_there_fails() {
        let found = faults("<a href='sub/other.html'>a</a>");
        assert!(
            found.len() == 1 && found[0].contains("sub/other.html"),
            "{found:?}"
        );
    }

    #[test]
    fn a_link_to_a_heading_that_is_not_there_fails() {
        for text in [
            "<a href='sub/page.html#bottom'>a</a>",
            "<a href='#nowhere'>a</a>",
        ] {
            let found = faults(text);
            assert!(
                found.len() == 1 && found[0].contains("heading"),
                "{found:?}"
            );
        }
    }

    #[test]
    fn a_picture_that_is_not_there_fails() {
        assert_eq!(faults("<img src='lost.png'>").len(), 1);
    }

    #[test]
    fn a_link_out_of_the_site_on_disk_fails() {
        assert_eq!(faults("<a href='../outside.html'>a</a>").len(), 1);
    }

    #[test]
    fn what_needs_a_network_to_be_read_fails() {
        assert_eq!(
            faults("<script src='https://cdn.example.org/x.js'></script>").len(),
            1
        );
    }

    #[test]
    fn an_address_without_a_host_fails() {
        assert_eq!(faults("<a href='https://'>a</a>").len(), 1);
    }
}
