//! Reading what a run starts from: the case and its mesh, with a record of both.

use crate::setup::{judge_mesh_of, read_mesh_of, read_motions_of, read_surfaces_of};
use crate::vocabulary::vocabulary;
use sha2::{Digest, Sha256};
use signorini_geometry::mesh::Mesh;
use signorini_io::case::{self, Case, MeshSource, Shape};
use signorini_io::deck::{self, Compat};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_io::fs::{self, Action, RealFs};
use signorini_io::writers::json::Input;
use std::path::{Path, PathBuf};

/// Where a case comes from: enough to know it again, and to read it again.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Source {
    /// What the run is called: the stem of the case's file name.
    pub name: String,
    /// The case, as the user named it.
    pub path: PathBuf,
    /// The folder that paths in the case are relative to.
    pub folder: PathBuf,
    /// The bytes of the case.
    pub text: Vec<u8>,
    /// What `--set` changed: path and value.
    pub overrides: Vec<(String, String)>,
    /// The mesh file, where there is one.
    pub mesh: Option<PathBuf>,
    /// The files that were read, with their hashes.
    pub inputs: Vec<Input>,
}

impl Source {
    /// What the case and its mesh hash to: two runs of one hash are the same run.
    #[must_use]
    pub fn hash(&self) -> [u8; 32] {
        let mut hasher = Sha256::new();
        for (path, value) in &self.overrides {
            hasher.update(format!("{path}={value}\n"));
        }
        for input in &self.inputs {
            hasher.update(input.sha256.as_bytes());
        }
        hasher.finalize().into()
    }

    /// The folder its results go to unless the user names one: next to the case.
    #[must_use]
    pub fn output_folder(&self) -> PathBuf {
        self.path.with_file_name(format!("{}.out", self.name))
    }
}

/// A case with its mesh.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The case.
    pub case: Case,
    /// Its mesh.
    pub mesh: Mesh,
    /// What is unusual.
    pub warnings: Diagnostics,
    /// Where both come from.
    pub source: Source,
}

/// How a case is read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// What is changed in it: path and value.
    pub set: Vec<(String, String)>,
    /// Whose laws hold in a deck; none: the best ones in decks of Abaqus and CalculiX, its own in one of OOFEM.
    pub compat: Option<Compat>,
}

/// A case, or a deck, whose mesh may still have to be read.
#[derive(Clone, Debug)]
pub struct Opened {
    /// What it asks for; a deck, as a case would say it.
    pub case: Case,
    /// What is unusual.
    pub warnings: Diagnostics,
    /// Where it comes from.
    pub source: Source,
    /// The mesh of a deck, which is read with it.
    mesh: Option<KnownMesh>,
}

/// A mesh that need not be read.
#[derive(Clone, Debug)]
struct KnownMesh {
    mesh: Mesh,
    /// The hash of the deck that it was read with; none of a mesh of the program's own.
    sha256: Option<String>,
}

impl Opened {
    /// Reads the mesh, and the surfaces that are given by files.
    ///
    /// # Errors
    /// All faults of the mesh and of those files, behind what was unusual before.
    pub fn with_mesh(self) -> Result<Loaded, Diagnostics> {
        self.finish()
    }

    /// As [`Opened::with_mesh`], with a mesh of the program's own in place of the one that the case names. `record` is the text
    /// that stands for both, with the mesh in it: a run keeps it to go on from, and knows itself by it.
    ///
    /// # Errors
    /// All faults of the mesh and of the files of surfaces, behind what was unusual before.
    pub fn over(mut self, mesh: Mesh, record: Vec<u8>) -> Result<Loaded, Diagnostics> {
        if let Some(input) = self.source.inputs.first_mut() {
            input.sha256 = sha256(&record);
        }
        self.source.text = record;
        self.mesh = Some(KnownMesh { mesh, sha256: None });
        self.finish()
    }

    fn finish(mut self) -> Result<Loaded, Diagnostics> {
        match mesh_of(&mut self.case, &mut self.source, self.mesh) {
            Ok((mesh, more)) => {
                self.warnings.append(more);
                Ok(Loaded {
                    case: self.case,
                    mesh,
                    warnings: self.warnings,
                    source: self.source,
                })
            }
            Err(found) => {
                self.warnings.append(found);
                Err(self.warnings)
            }
        }
    }
}

/// Reads a case or a deck, and its mesh.
///
/// # Errors
/// All faults of the case at once; else all faults of the mesh.
///
/// # Example
/// ```
/// use signorini::{Reading, build, load};
///
/// let text = r#"
/// [mesh]
/// nodes = [
///   [1, 0.0, 0.0], [2, 1.0, 0.0], [3, 1.0, 1.0], [4, 0.0, 1.0],
/// ]
/// elements = [{ id = 1, type = "quad4", group = "plate", nodes = [1, 2, 3, 4] }]
/// [model]
/// space = "plane-stress"
/// [sets]
/// base = { nodes = [1, 2] }
/// head = { nodes = [3, 4] }
/// [material.soft]
/// model = "linear-elastic"
/// E = 1000.0
/// nu = 0.0
/// [[body]]
/// group = "plate"
/// material = "soft"
/// [[step]]
/// name = "pull"
/// geometry = "linear"
/// fix = [{ on = "base", u = "all" }]
/// move = [{ on = "head", ux = 0.0, uy = 0.01 }]
/// [[expect]]
/// what = "reaction_force.y @ set head"
/// value = 10.0
/// tol = { abs = 1e-6 }
/// "#;
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("plate.toml");
/// std::fs::write(&path, text)?;
/// let reading = Reading {
///     set: vec![("material.soft.E".to_owned(), "2000.0".to_owned())],
///     ..Reading::default()
/// };
/// let loaded = load(&path, &reading)?;
/// assert_eq!(loaded.case.materials[0].number("E"), Some(2000.0));
/// assert_eq!(build(loaded.case, loaded.mesh)?.system.layout.nnode(), 4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn load(path: &Path, reading: &Reading) -> Result<Loaded, Diagnostics> {
    load_case(path, reading)?.with_mesh()
}

/// Reads a case without its mesh, or a deck.
///
/// # Errors
/// All faults of the case at once.
pub fn load_case(path: &Path, reading: &Reading) -> Result<Opened, Diagnostics> {
    let overrides = &reading.set;
    fs::permit(Action::Read, path).map_err(|error| {
        Diagnostic::error(&codes::UNREADABLE, error.to_string()).help(error.help())
    })?;
    let Ok(text) = fs::read(path) else {
        // says why, in the words for users
        let (case, warnings) = case::read_case_file(path, overrides, vocabulary())?;
        return Ok(Opened {
            case,
            warnings,
            source: Source::default(),
            mesh: None,
        });
    };
    open_text(path, text, reading)
}

/// As [`load_case`], from the text of a case or deck that need not be on the disk; `path` is what it is called, and the
/// folder in it is the one that paths in the case are relative to.
///
/// # Errors
/// All faults of the case at once.
///
/// # Example
/// ```
/// use signorini::{Reading, open_text};
///
/// let text = r#"
/// mesh     = { file = "block.msh" }
/// material = { steel = { model = "linear-elastic", E = 210e3, nu = 0.3 } }
/// body     = [{ group = "block", material = "steel" }]
/// step     = [{ name = "press", fix = [{ on = "base", u = "all" }] }]
/// "#;
/// let opened = open_text("models/block.toml".as_ref(), text.into(), &Reading::default())?;
/// assert_eq!(opened.source.folder, std::path::Path::new("models"));
/// # Ok::<(), signorini::Diagnostics>(())
/// ```
pub fn open_text(path: &Path, text: Vec<u8>, reading: &Reading) -> Result<Opened, Diagnostics> {
    let overrides = &reading.set;
    let name = path.display().to_string();
    let (case, warnings, text, mesh) = if is_deck(path) {
        read_deck(&name, &text, reading)?
    } else {
        let (case, warnings) = case::read_case(&name, &text, overrides, vocabulary())?;
        (case, warnings, text, None)
    };
    let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned());
    let source = Source {
        name: stem.unwrap_or_else(|| "case".into()),
        path: path.to_path_buf(),
        folder: folder_of(path),
        inputs: vec![Input {
            path: path.display().to_string(),
            sha256: sha256(&text),
        }],
        text,
        overrides: overrides.to_vec(),
        mesh: None,
    };
    Ok(Opened {
        case,
        warnings,
        source,
        mesh,
    })
}

/// Reads a case and its mesh once more, from the text of its source and with the overrides there.
///
/// # Errors
/// All faults of the case at once; else all faults of the mesh.
pub fn load_again(mut source: Source) -> Result<Loaded, Diagnostics> {
    let name = source.path.display().to_string();
    let (mut case, mut warnings) =
        case::read_case(&name, &source.text, &source.overrides, vocabulary())?;
    source.inputs.truncate(1);
    let (mesh, more) = load_mesh(&mut case, &mut source)?;
    warnings.append(more);
    Ok(Loaded {
        case,
        mesh,
        warnings,
        source,
    })
}

/// Reads the mesh of a case, and the surfaces that are given by files.
///
/// # Errors
/// All faults of the mesh and of those files.
pub fn load_mesh(case: &mut Case, source: &mut Source) -> Result<(Mesh, Diagnostics), Diagnostics> {
    mesh_of(case, source, None)
}

/// As [`load_mesh`], with the mesh of a deck where it is the one of the case.
fn mesh_of(
    case: &mut Case,
    source: &mut Source,
    known: Option<KnownMesh>,
) -> Result<(Mesh, Diagnostics), Diagnostics> {
    let mut warnings = read_surfaces_of(case, &source.folder)?;
    let is_own = known.as_ref().is_some_and(|known| known.sha256.is_none());
    let (mesh, hash) = match known {
        Some(known) => {
            warnings.append(judge_mesh_of(case, &known.mesh)?);
            (known.mesh, known.sha256)
        }
        None => {
            let (mesh, more) = read_mesh_of(case, &source.folder)?;
            warnings.append(more);
            (mesh, None)
        }
    };
    let hash_of = |path: &Path| sha256(&fs::read(path).unwrap_or_default());
    for surface in &case.surfaces {
        if let Shape::Stl { path } = &surface.shape {
            let path = source.folder.join(&path.value);
            source.inputs.push(Input {
                path: path.display().to_string(),
                sha256: hash_of(&path),
            });
        }
    }
    if let MeshSource::File { path } = &case.mesh
        && !is_own
    {
        let path = source.folder.join(&path.value);
        source.inputs.push(Input {
            path: path.display().to_string(),
            sha256: hash.unwrap_or_else(|| hash_of(&path)),
        });
        source.mesh = Some(path);
    }
    for path in read_motions_of(case, &mesh, &source.folder)? {
        source.inputs.push(Input {
            path: path.display().to_string(),
            sha256: hash_of(&path),
        });
    }
    let allowed: Vec<&str> = case.allow.iter().map(String::as_str).collect();
    warnings.silence(&allowed);
    Ok((mesh, warnings))
}

/// Whether a file is a deck of Abaqus or CalculiX, or one of OOFEM, by its extension.
fn is_deck(path: &Path) -> bool {
    is_of_oofem(path)
        || path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("inp"))
}

fn is_of_oofem(path: &Path) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("in"))
}

/// A deck as a case, the text of that case, and the mesh unless the case has another one.
fn read_deck(
    name: &str,
    bytes: &[u8],
    reading: &Reading,
) -> Result<(Case, Diagnostics, Vec<u8>, Option<KnownMesh>), Diagnostics> {
    let read = if is_of_oofem(name.as_ref()) {
        // its checks hold for its own elements, unless somebody wants better ones
        let compat = reading.compat.unwrap_or(Compat::Oofem);
        deck::oofem::read(&RealFs, name, bytes, compat)?
    } else {
        deck::read(&RealFs, name, bytes, reading.compat.unwrap_or_default())?
    };
    let text = case::resolved(&read.case, vocabulary()).into_bytes();
    let mesh = KnownMesh {
        mesh: read.mesh,
        sha256: Some(sha256(bytes)),
    };
    if reading.set.is_empty() {
        return Ok((read.case, read.found, text, Some(mesh)));
    }
    let (case, more) = case::read_case(name, &text, &reading.set, vocabulary())?;
    let mut found = read.found;
    found.append(more);
    let is_own = case.mesh == read.case.mesh;
    Ok((case, found, text, is_own.then_some(mesh)))
}

/// SHA-256 in hexadecimal.
pub(crate) fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes)
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_path_buf(),
        _ => PathBuf::from("."),
    }
}
