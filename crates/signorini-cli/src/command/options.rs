//! Options that several commands have.

use clap::{Args, ValueEnum};
use signorini::{Compat, Reading};
use std::path::PathBuf;

/// Options of all commands that read a case.
#[derive(Clone, Debug, Default, Args)]
pub struct CaseOptions {
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
    /// How the case is to be read.
    pub fn reading(&self) -> Reading {
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
pub struct SolveOptions {
    /// Number of threads; results do not depend on it
    #[arg(short = 'j', long, value_name = "N", env = "SIGNORINI_THREADS", value_parser = clap::value_parser!(u64).range(1..=4096))]
    pub threads: Option<u64>,
    /// Events as lines of JSON on standard output
    #[arg(long)]
    pub json: bool,
    /// Only errors and the ending
    #[arg(short, long, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Every iteration, too
    #[arg(short, long)]
    pub verbose: bool,
    /// No progress bar
    #[arg(long)]
    pub no_progress: bool,
    /// Stop after this time, resumable: 90s, 10min, 2h
    #[arg(long, value_name = "TIME", value_parser = duration)]
    pub max_wall: Option<f64>,
    /// Solve the first steps only, by their names in order: press,drag; the rest can be resumed
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub steps: Vec<String>,
    /// Tell where the time went
    #[arg(long)]
    pub timings: bool,
    /// Exit code 1 where the audit of the results finds something wrong, not just a warning
    #[arg(long)]
    pub strict: bool,
}

/// A folder for results.
#[derive(Clone, Debug, Default, Args)]
pub struct FolderOption {
    /// The folder for the results; CASE.out next to the case where absent
    #[arg(short = 'o', long = "output", value_name = "DIR")]
    pub output: Option<PathBuf>,
}

fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() => {
            Ok((key.trim().to_owned(), value.to_owned()))
        }
        _ => Err("write KEY=VALUE, as in material.steel.E=2000".to_owned()),
    }
}

/// A time such as 90s, 10min or 2h, in seconds.
pub fn duration(text: &str) -> Result<f64, String> {
    signorini::text::seconds(text).ok_or_else(|| "write 90s, 10min or 2h".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn assignments_are_split_at_the_first_equals_sign() {
        assert_eq!(assignment("a.b=c=d"), Ok(("a.b".into(), "c=d".into())));
        assert!(assignment("ab").is_err());
        assert!(assignment("=1").is_err());
    }
}
