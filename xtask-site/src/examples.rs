//! The gallery: every example with its picture, its case and what its run took.

use crate::book::write;
use crate::markdown;
use crate::places::cargo;
use anyhow::{Context, Result};
use serde_json::Value;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use toml_edit::{DocumentMut, Item};

/// An example of the repository.
#[derive(Debug)]
pub struct Example {
    /// The name of its folder.
    pub name: String,
    /// The first heading of its page.
    pub title: String,
    /// Its page, from the root of the repository.
    pub page: PathBuf,
    /// Its case; none for scripts.
    pub case: Option<String>,
}

/// The gallery in Markdown.
#[derive(Debug, Default)]
pub struct Gallery {
    /// The text.
    pub text: String,
    /// Examples that have no picture or no results.
    pub faults: Vec<String>,
}

/// All examples by name: folders of `examples/` with a README.
pub fn list(root: &Path) -> Result<Vec<Example>> {
    let folder = root.join("examples");
    let mut examples = Vec::new();
    let entries =
        std::fs::read_dir(&folder).with_context(|| format!("cannot list {}", folder.display()))?;
    for entry in entries {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let Ok(page) = std::fs::read_to_string(entry.path().join("README.md")) else {
            continue;
        };
        examples.push(Example {
            title: markdown::title(&page).unwrap_or(&name).to_string(),
            page: PathBuf::from(format!("examples/{name}/README.md")),
            case: std::fs::read_to_string(entry.path().join("case.toml")).ok(),
            name,
        });
    }
    examples.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(examples)
}

/// The gallery of these examples; pictures are written to a folder of the sources.
pub fn gallery(examples: &[Example], results: Option<&Path>, pictures: &Path) -> Result<Gallery> {
    let mut gallery = Gallery::default();
    if results.is_none() {
        gallery.text.push_str(
            "*This site was built without results, so that there are neither pictures nor times here: \
             `cargo xtask site --results DIR` takes a folder with a folder of results for each example.*\n\n",
        );
    }
    gallery.text.push_str("<div class=\"gallery\">\n\n");
    for example in examples.iter().filter(|example| example.case.is_some()) {
        gallery.text.push_str("<div>\n\n");
        let run = results.map(|results| results.join(&example.name));
        if let Some(run) = &run {
            let name = format!("{}.png", example.name);
            match picture(run) {
                Ok(bytes) => {
                    write(&pictures.join(&name), &bytes)?;
                    // writing to a string cannot fail
                    let _ = writeln!(gallery.text, "![{}](pictures/{name})\n", example.title);
                }
                Err(error) => gallery.faults.push(format!(
                    "gallery: no picture of {}: {error:#}",
                    example.name
                )),
            }
        }
        let _ = writeln!(
            gallery.text,
            "**[{}]({})**\n",
            example.title,
            Path::new("..").join(&example.page).display()
        );
        let _ = writeln!(gallery.text, "{}\n", sentence(example));
        if let Some(run) = &run {
            match summary(run) {
                Ok(text) => {
                    let _ = writeln!(gallery.text, "{text}\n");
                }
                Err(error) => gallery
                    .faults
                    .push(format!("gallery: no run of {}: {error:#}", example.name)),
            }
        }
        gallery.text.push_str("</div>\n\n");
    }
    gallery.text.push_str("</div>\n");
    Ok(gallery)
}

/// What a case says of itself, with a link to it.
fn sentence(example: &Example) -> String {
    let case = example.case.as_deref().unwrap_or_default();
    let case: DocumentMut = case.parse().unwrap_or_default();
    let text = |key: &str| case.get(key).and_then(Item::as_str);
    let link = format!("[case](../examples/{}/case.toml)", example.name);
    let parts = [text("title"), Some(&link)];
    parts.into_iter().flatten().collect::<Vec<_>>().join(" · ")
}

/// The picture of a run: `picture.png` in its folder, or one of those that `signorini report --png` draws.
fn picture(run: &Path) -> Result<Vec<u8>> {
    let own = run.join("picture.png");
    let path = if own.exists() {
        own
    } else {
        let folder = run.join("pictures");
        if !folder.exists() {
            draw(run)?;
        }
        best(&folder)?
    };
    std::fs::read(&path).with_context(|| format!("cannot read {}", path.display()))
}

/// Draws the pictures of a run into its folder.
fn draw(run: &Path) -> Result<()> {
    let ended = cargo()
        .args(["run", "--quiet", "--release", "--package", "signorini-cli"])
        .args(["--", "report", "--png"])
        .arg(run)
        .output()
        .context("signorini report cannot be run")?;
    if !ended.status.success() {
        let said = String::from_utf8_lossy(&ended.stderr);
        anyhow::bail!(
            "{}",
            said.lines().next().unwrap_or("signorini report failed")
        );
    }
    Ok(())
}

/// The picture that says most of a run: that of the field that comes first here, or the first by name.
fn best(folder: &Path) -> Result<PathBuf> {
    let fields = ["von_mises", "contact_pressure", "displacement"];
    let named = fields.map(|field| folder.join(format!("{field}.png")));
    if let Some(path) = named.into_iter().find(|path| path.exists()) {
        return Ok(path);
    }
    let entries =
        std::fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))?;
    let mut paths = Vec::new();
    for entry in entries {
        paths.push(entry?.path());
    }
    paths.sort();
    let is_picture = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "png");
    let first = paths.into_iter().find(is_picture);
    first.with_context(|| format!("{} has no picture", folder.display()))
}

/// How a run ended and what it took.
fn summary(run: &Path) -> Result<String> {
    let path = run.join("summary.json");
    let text = std::fs::read_to_string(&path)
        .with_context(|| format!("cannot read {}", path.display()))?;
    let summary: Value =
        serde_json::from_str(&text).with_context(|| format!("{} is no JSON", path.display()))?;
    let sum = |key: &str| -> u64 {
        let steps = summary.get("steps").and_then(Value::as_array);
        let of = |step: &Value| step.get(key).and_then(Value::as_u64);
        steps.into_iter().flatten().filter_map(of).sum()
    };
    let seconds = |key: &str| summary.get("time")?.get(key)?.as_f64();
    let status = summary.get("status").and_then(Value::as_str);
    let mut parts = vec![
        status.unwrap_or("unknown").to_string(),
        format!("{} increments", sum("increments")),
        format!("{} iterations", sum("iterations")),
    ];
    parts.extend(
        summary
            .get("unknowns")
            .and_then(Value::as_u64)
            .map(|n| format!("{n} unknowns")),
    );
    parts.extend(seconds("total").map(|s| format!("{s:.1} s")));
    Ok(parts.join(" · "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example(name: &str) -> Example {
        Example {
            name: name.to_string(),
            title: "A ball".to_string(),
            page: PathBuf::from(format!("examples/{name}/README.md")),
            case: Some("title = \"Ball on plate\"\n".to_string()),
        }
    }

    #[test]
    fn without_results_the_gallery_says_so() {
        let folder = tempfile::tempdir().unwrap();
        let gallery = gallery(&[example("ball")], None, folder.path()).unwrap();
        assert!(gallery.text.contains("without results"));
        assert!(gallery.text.contains("Ball on plate") && !gallery.text.contains("!["));
        assert!(gallery.faults.is_empty());
    }

    #[test]
    fn results_give_a_picture_and_times() {
        let (results, pictures) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let run = results.path().join("ball");
        write(&run.join("picture.png"), b"png").unwrap();
        let summary = r#"{ "status": "solved", "unknowns": 30, "time": { "total": 1.25 },
            "steps": [{ "increments": 2, "iterations": 5 }, { "increments": 1, "iterations": 4 }] }"#;
        write(&run.join("summary.json"), summary.as_bytes()).unwrap();
        let gallery = gallery(&[example("ball")], Some(results.path()), pictures.path()).unwrap();
        assert!(
            gallery
                .text
                .contains("solved · 3 increments · 9 iterations · 30 unknowns · 1.2 s"),
            "{}",
            gallery.text
        );
        assert!(pictures.path().join("ball.png").exists() && gallery.faults.is_empty());
    }

    #[test]
    fn of_several_pictures_the_stress_is_shown() {
        let run = tempfile::tempdir().unwrap();
        for (name, text) in [("contact_pressure", "p"), ("von_mises", "s"), ("a", "a")] {
            let path = run.path().join(format!("pictures/{name}.png"));
            write(&path, text.as_bytes()).unwrap();
        }
        assert_eq!(picture(run.path()).unwrap(), b"s");
    }

    #[test]
    fn a_run_without_a_summary_is_a_fault() {
        let (results, pictures) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        write(&results.path().join("ball/picture.png"), b"png").unwrap();
        let gallery = gallery(&[example("ball")], Some(results.path()), pictures.path()).unwrap();
        assert_eq!(gallery.faults.len(), 1);
    }
}
