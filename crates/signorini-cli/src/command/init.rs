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
        let path = self.folder.join(file_name(template));
        if path.exists() {
            console.line(&format!(
                "error: {} is there already; name another folder, or remove it",
                path.display()
            ));
            return 3;
        }
        match write(&path, template) {
            Ok(()) => {
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

/// The file that a template is written to.
pub fn file_name(template: &Template) -> String {
    format!("{}.toml", template.name.replace('-', "_"))
}

/// Writes a template, and the schema that its first line may name for editors.
pub fn write(path: &Path, template: &Template) -> Result<(), FsError> {
    let folder = path.parent().unwrap_or(Path::new("."));
    let schema = folder.join(".signorini");
    RealFs.create_dir_all(&schema)?;
    let text = serde_json::to_string_pretty(&signorini_io::case::schema(signorini::vocabulary()))
        .unwrap_or_default();
    RealFs.write_atomic(&schema.join("schema.json"), text.as_bytes())?;
    let mut case = template.text.to_owned();
    if !case.starts_with("#:schema") {
        case.insert_str(0, "#:schema .signorini/schema.json\n");
    }
    RealFs.write_atomic(path, case.as_bytes())
}
