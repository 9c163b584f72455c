//! Checks and chores of the repository: `cargo xtask CHORE`.
//!
//! ```text
//! cargo xtask                  lists the chores
//! cargo xtask rooms            fails where a room imports one that its line in the table does not list
//! cargo xtask rooms --graph    prints that table
//! cargo xtask rooms --circles  lists files that use each other in a circle
//! cargo xtask docs             fails where a Markdown file names what does not exist
//! cargo xtask keys             writes docs/keys.md, the page of all keys of cases, their schema, and their classes for Python
//! cargo xtask shape            fails where a function or file is too long, or a default serves one implementor
//! cargo xtask site             builds the documentation as a site, target/site/index.html, and checks its links; its options
//!                              are at the head of `xtask-site/src/main.rs`
//! ```
//!
//! Exit codes: 0 all is well, 1 a check failed, 2 the command line is wrong or a file cannot be read.
//!
//! To add a chore: a module with a function that takes the repository's root, and one line in [`CHORES`].

mod docs;
mod fault;
mod rooms;
mod shape;
mod site;
mod tree;

use std::ffi::OsString;
use std::fmt;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What a chore ends with: whether its check holds, or why it could not look.
type Outcome = Result<bool, ChoreError>;

/// A chore: its command line, what it does, and the function that does it.
struct Chore {
    arguments: &'static [&'static str],
    about: &'static str,
    run: Run,
}

/// The function of a chore.
#[derive(Clone, Copy)]
enum Run {
    /// One that takes nothing but the root.
    Alone(fn(&Path) -> Outcome),
    /// One that takes the options behind its name, too.
    WithOptions(fn(&Path, &[String]) -> Outcome),
}

const CHORES: [Chore; 7] = [
    Chore {
        arguments: &["rooms"],
        about: "fail where a room imports one that its line in the table does not list",
        run: Run::Alone(rooms::check),
    },
    Chore {
        arguments: &["rooms", "--circles"],
        about: "list circles of files that use each other, and fail where there are any",
        run: Run::Alone(rooms::circles),
    },
    Chore {
        arguments: &["rooms", "--graph"],
        about: "print which room may import which",
        run: Run::Alone(rooms::graph),
    },
    Chore {
        arguments: &["docs"],
        about: "fail where a Markdown file names a file, command, key or symbol that does not exist",
        run: Run::Alone(docs::check),
    },
    Chore {
        arguments: &["keys"],
        about: "write docs/keys.md, docs/case.schema.json and the classes of keys for Python",
        run: Run::Alone(docs::write_keys),
    },
    Chore {
        arguments: &["shape"],
        about: "fail where a function or file is too long, or a default serves one implementor",
        run: Run::Alone(shape::check),
    },
    Chore {
        arguments: &["site"],
        about: "build the documentation as a site, target/site/index.html, and fail where a link leads nowhere",
        run: Run::WithOptions(site::build),
    },
];

/// Why a chore could not be done.
#[derive(Debug)]
enum ChoreError {
    /// A file or folder that cannot be read.
    Read {
        path: PathBuf,
        source: std::io::Error,
    },
    /// A file that cannot be written.
    Write {
        path: PathBuf,
        source: std::io::Error,
    },
    /// Something that a chore needs did not do its work.
    Failed { what: String, reason: String },
    /// The folder of this program has no parent.
    NoRoot,
}

impl fmt::Display for ChoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read { path, source } => write!(f, "cannot read {}: {source}", path.display()),
            Self::Write { path, source } => write!(f, "cannot write {}: {source}", path.display()),
            Self::Failed { what, reason } => write!(f, "{what} failed: {reason}"),
            Self::NoRoot => f.write_str("xtask does not lie inside the repository"),
        }
    }
}

fn main() -> ExitCode {
    let given: Vec<String> = std::env::args().skip(1).collect();
    if given.is_empty() {
        print!("{}", list());
        return ExitCode::SUCCESS;
    }
    let words: Vec<&str> = given.iter().map(String::as_str).collect();
    let Some(chore) = CHORES.iter().find(|chore| chore.is(&words)) else {
        eprint!("no chore is called \"{}\"\n{}", given.join(" "), list());
        return ExitCode::from(2);
    };
    let options = given.get(chore.arguments.len()..).unwrap_or_default();
    let done = root().and_then(|root| match chore.run {
        Run::Alone(run) => run(&root),
        Run::WithOptions(run) => run(&root, options),
    });
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

/// Whether a command line names a chore.
fn is_chore(arguments: &[&str]) -> bool {
    CHORES.iter().any(|chore| chore.is(arguments))
}

impl Chore {
    /// Whether a command line names this chore, with options where it takes some.
    fn is(&self, words: &[&str]) -> bool {
        match self.run {
            Run::Alone(_) => words == self.arguments,
            Run::WithOptions(_) => words.starts_with(self.arguments),
        }
    }
}

fn list() -> String {
    let line = |chore: &Chore| {
        let command = chore.arguments.join(" ");
        format!("cargo xtask {command:<16} {}\n", chore.about)
    };
    CHORES.iter().map(line).collect()
}

/// The cargo that runs this program.
fn cargo() -> OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

fn root() -> Result<PathBuf, ChoreError> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent();
    root.map(Path::to_path_buf).ok_or(ChoreError::NoRoot)
}
