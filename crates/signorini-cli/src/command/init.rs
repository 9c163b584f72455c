//! `signorini init [TEMPLATE] [DIR]`

use super::console::Console;
use super::exit::WRONG_COMMAND;
use super::findings::not_written;
use super::templates::{self, TEMPLATES, Template};
use clap::Args;
use signorini_io::fs::{Fs, FsError, RealFs};
use std::path::{Path, PathBuf};

/// Write a case to start from.
#[derive(Debug, Args)]
pub struct Init {
    /// Which one; see --list
    #[arg(default_value = TEMPLATES[0].name)]
    template: String,
    /// The folder for it
    #[arg(default_value = ".")]
    folder: PathBuf,
    /// List the templates
    #[arg(long)]
    list: bool,
}

impl Init {
    pub fn execute(self) -> u8 {
        if self.list {
            let out = Console::stdout();
            for template in &TEMPLATES {
                out.line(&format!("{:<22}  {}", template.name, template.about));
            }
            return 0;
        }
        let console = Console::stderr();
        let Some(template) = templates::find(&self.template) else {
            console.line(&format!("error: {}", templates::unknown(&self.template)));
            return WRONG_COMMAND;
        };
        let files = template.mesh.iter().map(|(name, _)| *name);
        let mut files = std::iter::once(template.file).chain(files);
        let existing = files.find(|name| self.folder.join(name).exists());
        if let Some(name) = existing {
            console.line(&format!(
                "error: {} is there already; name another folder, or remove it",
                self.folder.join(name).display()
            ));
            return 3;
        }
        match write(&self.folder, template) {
            Ok(path) => {
                let shown = path.display();
                console.line(&format!("✓ {shown}   run it: signorini run {shown}"));
                0
            }
            Err(error) => {
                console.findings(&not_written(&error).into());
                FsError::EXIT_CODE
            }
        }
    }
}

/// What the first line of a case says to editors.
const SCHEMA: &str = "#:schema .signorini/schema.json\n";

/// Writes a template into a folder, with its mesh and the schema that its first line names for editors; returns the path
/// of the file to run.
pub fn write(folder: &Path, template: &Template) -> Result<PathBuf, FsError> {
    RealFs.create_dir_all(folder)?;
    if let Some((name, text)) = template.mesh {
        RealFs.write_atomic(&folder.join(name), text.as_bytes())?;
    }
    let path = folder.join(template.file);
    if !template.file.ends_with(".toml") {
        RealFs.write_atomic(&path, template.text.as_bytes())?;
        return Ok(path);
    }
    let schema = folder.join(".signorini");
    RealFs.create_dir_all(&schema)?;
    let text = serde_json::to_string_pretty(&signorini_io::case::schema(signorini::vocabulary()))
        .unwrap_or_default();
    RealFs.write_atomic(&schema.join("schema.json"), text.as_bytes())?;
    let case = format!("{SCHEMA}{}", template.text);
    RealFs.write_atomic(&path, case.as_bytes())?;
    Ok(path)
}
