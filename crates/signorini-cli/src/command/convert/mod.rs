//! `signorini convert IN OUT`
//!
//! ```text
//! job.inp, job.in                            case.toml         the same case; the mesh stays in the deck
//! part.msh, part.inp, part.in, part.vtu      part.inp, .vtu    the mesh
//! case.out, results.pvd                      job.frd           results, for CalculiX GraphiX, PrePoMax and FreeCAD
//! job.frd                                    job.pvd, .vtu     results, for ParaView; a .vtu holds the last time
//! ```

mod file;
mod grid;
mod mesh;
mod results;

use super::console::Console;
use super::exit::WRONG_COMMAND;
use super::options::CaseOptions;
use clap::Args;
use file::{extension, write};
use signorini::load_case;
use signorini_io::case::{MeshSource, resolved};
use signorini_io::diagnostic::Diagnostics;
use std::path::{Path, PathBuf};

/// Write a deck as a case, a mesh or results in another format.
#[derive(Debug, Args)]
pub struct Convert {
    /// A deck (.inp, .in), a mesh (.msh, .inp, .in, .vtu), a folder of results, a .pvd or a .frd
    input: PathBuf,
    /// What is to be written: .toml of a deck, .inp or .vtu of a mesh, .frd, .pvd or .vtu of results
    output: PathBuf,
    #[command(flatten)]
    changes: CaseOptions,
}

/// What is made of what.
enum Way {
    Case,
    Mesh,
    ToFrd,
    FromFrd,
}

impl Convert {
    pub fn execute(self) -> u8 {
        let Some(way) = self.way() else {
            let text = "error: convert writes\n  a deck, .inp or .in, as a case, .toml\n  a mesh, .msh, .inp, .in or .vtu, as .inp or .vtu\n  results, a folder or .pvd, as .frd\n  results, .frd, as .pvd or .vtu\n";
            Console::stderr().text(text);
            return WRONG_COMMAND;
        };
        let done = match way {
            Way::Case => self.case(),
            Way::Mesh => mesh::convert(&self.input, &self.output),
            Way::ToFrd => results::to_frd(&self.input, &self.output),
            Way::FromFrd => results::from_frd(&self.input, &self.output),
        };
        match done {
            Ok(found) => {
                Console::stderr().findings(&found);
                Console::stdout().line(&format!("→ {}", self.output.display()));
                0
            }
            Err(found) => {
                Console::stderr().findings(&found);
                found.exit_code().unwrap_or(3)
            }
        }
    }

    fn way(&self) -> Option<Way> {
        let from = extension(&self.input);
        let from = if self.input.is_dir() { "pvd" } else { &from };
        let to = extension(&self.output);
        Some(match (from, to.as_str()) {
            ("inp" | "in", "toml") => Way::Case,
            ("msh" | "inp" | "in" | "vtu", "inp" | "vtu") => Way::Mesh,
            ("pvd", "frd") => Way::ToFrd,
            ("frd", "pvd" | "vtu") => Way::FromFrd,
            _ => return None,
        })
    }

    fn case(&self) -> Result<Diagnostics, Diagnostics> {
        let opened = load_case(&self.input, &self.changes.reading())?;
        let (mut case, found) = (opened.case, opened.warnings);
        case.mesh = MeshSource::File {
            path: self.mesh().into(),
        };
        let text = resolved(&case, signorini::vocabulary());
        write(&self.output, text.as_bytes())?;
        Ok(found)
    }

    /// The path of the deck as the case sees it: by its name where both lie in one folder, else whole.
    fn mesh(&self) -> String {
        let folder = |path: &Path| {
            path.parent()
                .map(|p| p.canonicalize().unwrap_or_else(|_| p.into()))
        };
        let name = self.input.file_name().map(Path::new).unwrap_or(&self.input);
        if folder(&self.input) == folder(&self.output) {
            return name.display().to_string();
        }
        let whole = self.input.canonicalize();
        whole
            .unwrap_or_else(|_| self.input.clone())
            .display()
            .to_string()
    }
}
