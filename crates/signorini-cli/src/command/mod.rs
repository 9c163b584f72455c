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
mod exit;
mod explain;
mod findings;
mod guard;
mod help;
mod info;
mod init;
mod job;
mod keywords;
mod mcp;
mod ndjson;
mod object;
mod options;
mod pages;
mod ranks;
mod report;
mod resume;
mod run;
mod schema;
mod signals;
mod stack;
mod status;
mod templates;
mod terminal;
mod threads;
mod verify;
mod within;

use clap::{CommandFactory, Parser, Subcommand};
use console::Console;
use exit::WRONG_COMMAND;
pub use pages::LargePages;
use std::ffi::OsString;

/// Contact mechanics by finite elements.
#[derive(Debug, Parser)]
#[command(
    name = "signorini",
    version,
    about,
    arg_required_else_help = true,
    disable_help_subcommand = true
)]
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
    /// Say what a run has reached: while it goes on, after it was killed, and after its end.
    Status(status::Status),
    /// List the content of a mesh, a case, or a folder of results.
    Info(info::Info),
    /// Write results as one page that works offline, or as pictures.
    Report(report::Report),
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
    /// Explain the code of a message, or a key of cases.
    Explain(explain::Explain),
    /// Explain a command, a key of cases, or the code of a message.
    Help(help::Help),
    /// Run problems with known answers on this machine and compare.
    Verify(verify::Verify),
    /// Tell version, machine and threads, and solve something small: for reports of bugs.
    Doctor(doctor::Doctor),
    /// Serve agents by the Model Context Protocol, on standard input and output.
    Mcp(mcp::Mcp),
    /// Print completions for a shell.
    Completions(completions::Completions),
}

/// Runs the command that a command line names, its first word being the program; returns the exit code.
///
/// It takes the signals of the process, and its pool of threads.
///
/// # Example
/// ```
/// assert_eq!(signorini_cli::main(["signorini", "explain", "S0102"]), 0);
/// assert_eq!(signorini_cli::main(["signorini", "rum", "case.toml"]), 2);
/// ```
pub fn main<T: Into<OsString> + Clone>(arguments: impl IntoIterator<Item = T>) -> u8 {
    let arguments: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    if let Err(code) = within::keep() {
        return code;
    }
    pages::keep_memory();
    exhausted::watch();
    let words = arguments.iter().skip(1);
    let words: Vec<String> = words
        .map(|word| word.to_string_lossy().into_owned())
        .collect();
    let program = arguments.first().cloned().unwrap_or_default();
    guard::guarded(&words, move || {
        let cli = match Cli::try_parse_from(arguments) {
            Ok(cli) => cli,
            Err(error) => return refused(&error),
        };
        match cli.verb {
            Verb::Run(run) => ranks::end(run.execute()),
            Verb::Resume(resume) => ranks::end(resume.execute()),
            Verb::Check(check) => ranks::end(check.execute()),
            Verb::Init(init) => init.execute(),
            Verb::Demo(demo) => demo.execute(),
            Verb::Status(status) => status.execute(),
            Verb::Info(info) => info.execute(),
            Verb::Report(report) => report.execute(),
            Verb::Diff(diff) => diff.execute(),
            Verb::CcxCompat(compat) => compat.execute(),
            Verb::Convert(convert) => convert.execute(),
            Verb::Schema => schema::execute(),
            Verb::Keywords => keywords::execute(),
            Verb::Explain(explain) => explain.execute(),
            Verb::Help(help) => help.execute(Cli::command()),
            Verb::Doctor(doctor) => doctor.execute(),
            Verb::Verify(verify) => verify.execute(),
            Verb::Mcp(mcp) => mcp.execute(&program),
            Verb::Completions(completions) => completions.execute(Cli::command()),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
