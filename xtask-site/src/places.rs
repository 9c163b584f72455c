//! Paths of the repository, and the pages of the site that they become.

use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::path::{Component, Path, PathBuf};
use std::process::Command;

/// The cargo that runs this program.
pub fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// What `cargo metadata` prints.
pub fn metadata(root: &Path, options: &[&str]) -> Result<Value> {
    let ended = cargo()
        .args(["metadata", "--format-version", "1"])
        .args(options)
        .current_dir(root)
        .output()
        .context("cargo metadata cannot be run")?;
    if !ended.status.success() {
        bail!(
            "cargo metadata failed: {}",
            String::from_utf8_lossy(&ended.stderr)
        );
    }
    serde_json::from_slice(&ended.stdout).context("what cargo metadata prints is no JSON")
}

/// A path without `.` and `..`; none where it leads out of its root.
pub fn normal(path: &Path) -> Option<PathBuf> {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::Normal(name) => out.push(name),
            Component::CurDir => {}
            Component::ParentDir => {
                if !out.pop() {
                    return None;
                }
            }
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    Some(out)
}

/// The page of the site for a Markdown file of the repository: those of `docs/` stand at the top, and a README that stands
/// for its folder has the name of the folder.
pub fn page_of(path: &Path) -> PathBuf {
    if path == Path::new("README.md") {
        return PathBuf::from("overview.md");
    }
    let path = path.strip_prefix("docs").unwrap_or(path);
    match (path.file_name(), path.parent()) {
        (Some(name), Some(folder)) if name == "README.md" => folder.with_extension("md"),
        _ => path.to_path_buf(),
    }
}

/// The way from a page of the site to a file of the site, with slashes.
pub fn relative(page: &Path, to: &Path) -> String {
    let folder = page.parent().unwrap_or(Path::new(""));
    let names = |path: &Path| -> Vec<String> {
        let names = path.components();
        names
            .map(|part| part.as_os_str().to_string_lossy().into_owned())
            .collect()
    };
    let (from, to) = (names(folder), names(to));
    let same = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n("..", from.len() - same);
    let down = to.iter().skip(same).map(String::as_str);
    up.chain(down).collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_of_docs_stand_at_the_top_and_readmes_have_the_name_of_their_folder() {
        for (path, page) in [
            ("docs/guide.md", "guide.md"),
            ("docs/tutorials/friction.md", "tutorials/friction.md"),
            ("README.md", "overview.md"),
            ("ARCHITECTURE.md", "ARCHITECTURE.md"),
            (
                "examples/hertz_sphere_3d/README.md",
                "examples/hertz_sphere_3d.md",
            ),
        ] {
            assert_eq!(page_of(Path::new(path)), Path::new(page));
        }
    }

    #[test]
    fn ways_between_pages_go_up_and_down() {
        let way = |page: &str, to: &str| relative(Path::new(page), Path::new(to));
        assert_eq!(way("guide.md", "keys.md"), "keys.md");
        assert_eq!(way("tutorials/friction.md", "keys.md"), "../keys.md");
        assert_eq!(way("tutorials/a.md", "tutorials/b.md"), "b.md");
        assert_eq!(way("examples/a.md", "files/x/y.py"), "../files/x/y.py");
    }

    #[test]
    fn paths_out_of_the_root_are_none() {
        assert_eq!(normal(Path::new("docs/../../x")), None);
        assert_eq!(
            normal(Path::new("docs/../x/./y")),
            Some(PathBuf::from("x/y"))
        );
    }
}
