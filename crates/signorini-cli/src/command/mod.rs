//! The commands, one file each; this one knows their names and options.

mod ccx_compat;
mod check;
mod completions;
mod console;
mod convert;
mod demo;
mod diff;
mod doctor;
mod exhausted;
mod explain;
mod guard;
mod info;
mod init;
mod keywords;
mod ndjson;
mod pages;
mod resume;
mod run;
mod schema;
mod signals;
mod stack;
mod templates;
mod terminal;
mod threads;

use clap::{Args, Parser, Subcommand, ValueEnum};
use console::Console;
use signorini::{Compat, Reading};
use std::path::PathBuf;
use std::process::ExitCode;

#[global_allocator]
static MEMORY: pages::LargePages = pages::LargePages;

/// The exit code for a command line that is not understood.
const WRONG_COMMAND: u8 = 2;

/// Contact mechanics by finite elements.
#[derive(Debug, Parser)]
#[command(name = "signorini", version, about, arg_required_else_help = true)]
#[command(
    after_help = "Exit codes: 0 solved, 1 an expectation failed or results differ, 2 command line, 3 input, 4 ill-posed model, \
    5 not converged,\n6 not written, 7 cannot resume, 8 limit reached, 70 internal error, 130/143 interrupted"
)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Solve a case.
    Run(run::Run),
    /// Go on with a run that was stopped, from its last checkpoint.
    Resume(resume::Resume),
    /// Read everything, solve nothing: sizes, choices and faults.
    Check(check::Check),
    /// Write a case to start from.
    Init(init::Init),
    /// Run an example in a temporary folder and compare with its expected values.
    Demo(demo::Demo),
    /// List the content of a mesh, a case, or a folder of results.
    Info(info::Info),
    /// Compare results with a reference, block by block.
    Diff(diff::Diff),
    /// Stand in for CalculiX.
    CcxCompat(ccx_compat::CcxCompat),
    /// Write a deck as a case.
    Convert(convert::Convert),
    /// Print the JSON schema of cases, for editors.
    Schema,
    /// List the keywords of decks: read, left out, refused.
    Keywords,
    /// Explain the code of a message.
    Explain(explain::Explain),
    /// Tell version, machine and threads, and solve something small: for reports of bugs.
    Doctor,
    /// Print completions for a shell.
    Completions(completions::Completions),
}

/// Options of all commands that read a case.
#[derive(Clone, Debug, Default, Args)]
struct CaseOptions {
    /// Change a value of the case: --set material.steel.E=2000
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = assignment)]
    set: Vec<(String, String)>,
    /// The laws of a deck: the best there are, or those of a program; by default oofem for .in, else none
    #[arg(long, value_name = "PROGRAM")]
    compat: Option<CompatWord>,
}

/// A word for [`Compat`].
#[derive(Clone, Copy, Debug, ValueEnum)]
enum CompatWord {
    /// The best way to hold surfaces apart, the best elements
    None,
    /// Penalties and types as the deck says
    Ccx,
    /// Elements as OOFEM integrates them
    Oofem,
}

impl CaseOptions {
    fn reading(&self) -> Reading {
        Reading {
            set: self.set.clone(),
            compat: self.compat.map(|word| match word {
                CompatWord::None => Compat::None,
                CompatWord::Ccx => Compat::Ccx,
                CompatWord::Oofem => Compat::Oofem,
            }),
        }
    }
}

/// Options of all commands that solve.
#[derive(Clone, Debug, Default, Args)]
struct SolveOptions {
    /// Number of threads; results do not depend on it
    #[arg(short = 'j', long, value_name = "N", env = "SIGNORINI_THREADS", value_parser = clap::value_parser!(u64).range(1..=4096))]
    threads: Option<u64>,
    /// Events as lines of JSON on standard output
    #[arg(long)]
    json: bool,
    /// Only errors and the ending
    #[arg(short, long, conflicts_with = "verbose")]
    quiet: bool,
    /// Every iteration, too
    #[arg(short, long)]
    verbose: bool,
    /// No progress bar
    #[arg(long)]
    no_progress: bool,
    /// Stop after this time, resumable: 90s, 10min, 2h
    #[arg(long, value_name = "TIME", value_parser = duration)]
    max_wall: Option<f64>,
    /// Tell where the time went
    #[arg(long)]
    timings: bool,
    /// Exit code 1 where the audit of the results finds something wrong, not just a warning
    #[arg(long)]
    strict: bool,
}

/// A folder for results.
#[derive(Clone, Debug, Default, Args)]
struct FolderOption {
    /// The folder for the results; CASE.out next to the case where absent
    #[arg(short = 'o', long = "output", value_name = "DIR")]
    output: Option<PathBuf>,
}

/// Runs the command that the command line names.
pub fn main() -> ExitCode {
    pages::keep_memory();
    exhausted::watch();
    guard::guarded(|| {
        let cli = match Cli::try_parse() {
            Ok(cli) => cli,
            Err(error) => return refused(&error),
        };
        match cli.verb {
            Verb::Run(run) => run.execute(),
            Verb::Resume(resume) => resume.execute(),
            Verb::Check(check) => check.execute(),
            Verb::Init(init) => init.execute(),
            Verb::Demo(demo) => demo.execute(),
            Verb::Info(info) => info.execute(),
            Verb::Diff(diff) => diff.execute(),
            Verb::CcxCompat(compat) => compat.execute(),
            Verb::Convert(convert) => convert.execute(),
            Verb::Schema => schema::execute(),
            Verb::Keywords => keywords::execute(),
            Verb::Explain(explain) => explain.execute(),
            Verb::Doctor => doctor::execute(),
            Verb::Completions(completions) => completions.execute(),
        }
    })
}

/// Help and version are no errors; everything else that clap says is.
fn refused(error: &clap::Error) -> u8 {
    if error.use_stderr() {
        Console::stderr().text(&error.to_string());
        WRONG_COMMAND
    } else {
        Console::stdout().text(&error.to_string());
        0
    }
}

fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() => {
            Ok((key.trim().to_owned(), value.to_owned()))
        }
        _ => Err("write KEY=VALUE, as in material.steel.E=2000".to_owned()),
    }
}

fn duration(text: &str) -> Result<f64, String> {
    signorini::text::seconds(text).ok_or_else(|| "write 90s, 10min or 2h".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn assignments_are_split_at_the_first_equals_sign() {
        assert_eq!(assignment("a.b=c=d"), Ok(("a.b".into(), "c=d".into())));
        assert!(assignment("ab").is_err());
        assert!(assignment("=1").is_err());
    }
}
