//! Staged sources as HTML, by mdBook.

use crate::book::Staged;
use anyhow::{Context, Result};
use mdbook_driver::MDBook;
use mdbook_driver::config::Config;
use std::path::Path;

/// Renders a staged book; what was in the folder before is replaced.
pub fn render(staged: &Staged, out: &Path) -> Result<()> {
    if out.exists() {
        std::fs::remove_dir_all(out).with_context(|| format!("cannot clear {}", out.display()))?;
    }
    let config: Config = CONFIG.parse().context("the settings of mdBook")?;
    let mut config = config;
    config.build.build_dir = out.to_path_buf();
    let book = MDBook::load_with_config(&staged.folder, config)?;
    book.build()
}

/// Without the default preprocessors, which would take `{{…}}` on a page for an instruction.
const CONFIG: &str = r#"
[book]
title = "Signorini"
description = "Contact mechanics by finite elements"
language = "en"

[build]
create-missing = false
use-default-preprocessors = false

[output.html]
default-theme = "light"
preferred-dark-theme = "navy"
smart-punctuation = false
no-section-label = true
additional-css = ["math/styles.css", "site.css"]
input-404 = ""
hash-files = false

[output.html.fold]
enable = true
level = 0

[output.html.print]
enable = false

[output.html.playground]
runnable = false

[output.html.search]
limit-results = 30
use-boolean-and = true
boost-title = 3
expand = true
heading-split-level = 3
"#;
