//! `docs/commands.md` compared with the help of the program; SIGNORINI_BLESS writes it.

use crate::{compare, signorini};
use std::fmt::Write as _;

const HEAD: &str = "# Commands

`signorini` is one command with subcommands; `signorini COMMAND --help` prints what this page says about one. A CASE is a
`.toml` file or a deck, a DIR the folder of results of a run.

| exit code | meaning |
|---|---|
| 0 | solved, all expectations met; the command did what it was asked to |
| 1 | solved, but an expectation failed, or the audit with `--strict`; results differ |
| 2 | the command line is wrong |
| 3 | the input is wrong: case, deck, mesh; nothing was solved |
| 4 | the model is ill-posed; nothing was solved |
| 5 | an increment did not converge; all that did is on disk |
| 6 | results could not be written; what was written before is intact |
| 7 | the run cannot be resumed |
| 8 | a limit such as `--max-wall`, or memory, was reached; the run can be resumed |
| 70 | an internal error, which is a bug |
| 130, 143 | interrupted by Ctrl-C or SIGTERM; the run can be resumed |

| environment | meaning |
|---|---|
| SIGNORINI_THREADS, OMP_NUM_THREADS | the number of threads; results do not depend on it |
| NO_COLOR | no colours |

Written from the help of the program by a test, which fails where the two differ.
";

/// The names of the subcommands in a page of help, without `help` itself.
fn subcommands(help: &str) -> Vec<String> {
    let list = help.split("Commands:\n").nth(1).unwrap_or_default();
    let names = list
        .lines()
        .take_while(|line| !line.is_empty())
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next());
    names
        .filter(|name| *name != "help")
        .map(str::to_string)
        .collect()
}

fn written() -> String {
    let mut out = HEAD.to_string();
    for name in subcommands(&signorini(&["--help"])) {
        let help = signorini(&[&name, "--help"]);
        let lines = help.lines().map(str::trim_end);
        let help: Vec<&str> = lines.collect();
        writeln!(
            out,
            "\n## signorini {name}\n\n```text\n{}\n```",
            help.join("\n").trim()
        )
        .unwrap();
    }
    out
}

#[test]
fn the_page_of_commands_is_what_the_program_says_of_itself() {
    compare("commands.md", &written());
}
