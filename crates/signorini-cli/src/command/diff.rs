//! `signorini diff A B`

use super::console::Console;
use clap::Args;
use serde::Serialize;
use signorini::text::{plural, short};
use signorini_io::compare::{
    Comparison, Finding, Outcome, Pair, Tolerance, Worst, compare, pairs, tables,
};
use signorini_io::fs::{Fs, RealFs};
use std::path::{Path, PathBuf};

/// The exit code for results that differ.
const DIFFERENT: u8 = 1;

/// The exit code for files that cannot be compared.
const NOT_COMPARED: u8 = 2;

/// Compare results with a reference.
#[derive(Debug, Args)]
#[command(after_help = "\
Both are files of one kind, .dat, .frd, .csv or .vtu (.ref behind it does not count), or two folders of results: their \
history.csv,\n.dat, .frd and frames. Compared is block by block: a quantity at one time; of a table in .csv, a column in one \
step.\nEvery difference counts relative to the largest absolute value that the block has in the reference. Numbers of nodes,\n\
elements and points must be the same. Banners of steps and increments in .dat files and numbers of iterations do not count.\n\n\
Exit codes: 0 the same within the tolerance, 1 different, 2 command line, or files that cannot be compared")]
pub struct Diff {
    /// The results
    found: PathBuf,
    /// The reference: differences are relative to its largest values
    reference: PathBuf,
    /// Largest difference, relative to the largest value of a block
    #[arg(long, alias = "rtol", value_name = "PART", default_value_t = 1e-3, value_parser = not_negative)]
    rel: f64,
    /// Differences up to this are none, in the unit of the values
    #[arg(long, value_name = "SIZE", default_value_t = 0.0, value_parser = not_negative)]
    abs: f64,
    /// Blocks and files that only one of them has do not count; they are still named
    #[arg(long)]
    common: bool,
    /// Only what differs, and the verdict
    #[arg(short, long)]
    quiet: bool,
    /// One line of JSON for every block, and one for the verdict
    #[arg(long)]
    json: bool,
}

impl Diff {
    pub fn execute(self) -> u8 {
        match self.compared() {
            Ok(code) => code,
            Err(why) => {
                Console::stderr().line(&format!("error: {why}"));
                if self.json {
                    let verdict = Verdict::new("not compared", NOT_COMPARED, &Count::default());
                    tell_json(&verdict);
                }
                NOT_COMPARED
            }
        }
    }

    fn compared(&self) -> Result<u8, String> {
        let mut count = Count::default();
        for pair in self.pairs()? {
            count.nfile += 1;
            match (&pair.found, &pair.reference) {
                (Some(found), Some(reference)) => {
                    self.files(&pair.name, found, reference, &mut count)?
                }
                (found, _) => {
                    let outcome = if found.is_some() {
                        Outcome::Extra
                    } else {
                        Outcome::Missing
                    };
                    let finding = Finding {
                        name: String::new(),
                        time: None,
                        outcome,
                    };
                    self.tell(&pair.name, &finding, &mut count);
                }
            }
        }
        let nothing = format!(
            "nothing of {} and {} can be compared",
            self.found.display(),
            self.reference.display()
        );
        if count.nblock == 0 {
            return Err(nothing);
        }
        let is_same = count.ndifferent == 0
            && (self.common || count.nsingle == 0)
            && count.nblock > count.nsingle;
        let (status, code) = if is_same {
            ("same", 0)
        } else {
            ("different", DIFFERENT)
        };
        if self.json {
            tell_json(&Verdict::new(status, code, &count));
        } else {
            Console::stdout().line(&count.verdict(is_same, self));
        }
        Ok(code)
    }

    /// The two files, or those of the two folders.
    fn pairs(&self) -> Result<Vec<Pair>, String> {
        match (self.found.is_dir(), self.reference.is_dir()) {
            (true, true) => pairs(&RealFs, &self.found, &self.reference).map_err(|e| e.to_string()),
            (false, false) => Ok(vec![Pair {
                name: self.found.display().to_string(),
                found: Some(self.found.clone()),
                reference: Some(self.reference.clone()),
            }]),
            _ => Err("one is a folder and the other is not; compare two files, or two folders of results".into()),
        }
    }

    fn files(
        &self,
        name: &str,
        found: &Path,
        reference: &Path,
        count: &mut Count,
    ) -> Result<(), String> {
        let read = |path: &Path| {
            let bytes = RealFs.read(path).map_err(|e| e.to_string())?;
            tables(&path.display().to_string(), &bytes).map_err(|e| e.to_string())
        };
        for finding in compare(&read(found)?, &read(reference)?) {
            self.tell(name, &finding, count);
        }
        Ok(())
    }

    fn tell(&self, file: &str, finding: &Finding, count: &mut Count) {
        let agrees = finding.agrees(self.tolerance());
        count.add(finding, agrees);
        if self.json {
            tell_json(&Line::new(file, finding, agrees));
        } else if !(self.quiet && agrees) {
            if count.file != file {
                file.clone_into(&mut count.file);
                Console::stdout().line(file);
            }
            Console::stdout().line(&self.in_words(finding, agrees));
        }
    }

    /// A block as a line.
    fn in_words(&self, finding: &Finding, agrees: bool) -> String {
        let time = finding
            .time
            .map_or_else(String::new, |time| format!(", time {time}"));
        let name = match finding.name.as_str() {
            "" => "the file".to_owned(),
            name => format!("{name}{time}"),
        };
        let is_single = !matches!(finding.outcome, Outcome::Both(_));
        let sign = match agrees {
            true => '✓',
            false if self.common && is_single => '·',
            false => '✗',
        };
        let what = match &finding.outcome {
            Outcome::Extra => "not in the reference".to_owned(),
            Outcome::Missing => "only in the reference".to_owned(),
            Outcome::Both(one) => difference(one),
        };
        format!("  {sign} {name}: {what}")
    }

    const fn tolerance(&self) -> Tolerance {
        Tolerance {
            rel: self.rel,
            abs: self.abs,
        }
    }
}

fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value >= 0.0 && value.is_finite() => Ok(value),
        _ => Err("write a number that is not negative, as in 1e-3".to_owned()),
    }
}

/// What was reported so far.
#[derive(Debug, Default)]
struct Count {
    /// The file that lines are about.
    file: String,
    nfile: usize,
    nblock: usize,
    /// Blocks beyond the tolerance.
    ndifferent: usize,
    /// Blocks and files that only one side has.
    nsingle: usize,
    largest: f64,
}

impl Count {
    fn add(&mut self, finding: &Finding, agrees: bool) {
        self.nblock += 1;
        match &finding.outcome {
            Outcome::Both(one) => {
                self.ndifferent += usize::from(!agrees);
                self.largest = self.largest.max(one.ratio());
            }
            _ => self.nsingle += 1,
        }
    }

    fn verdict(&self, is_same: bool, asked: &Diff) -> String {
        let (mut tolerance, largest) = (asked.rel.to_string(), short(self.largest));
        if asked.abs > 0.0 {
            tolerance = format!("{tolerance} or {}", asked.abs);
        }
        let compared = self.nblock - self.nsingle;
        let blocks = plural(compared, "block");
        let mut text = match is_same {
            true => format!("the same within {tolerance}: {blocks}, largest difference {largest}"),
            false => format!(
                "different: {} of {blocks} beyond {tolerance}",
                self.ndifferent
            ),
        };
        if self.nsingle > 0 {
            text = format!("{text}, {} only in one of both", self.nsingle);
        }
        text
    }
}

fn difference(one: &Comparison) -> String {
    let mut parts: Vec<String> = one.mismatch.iter().cloned().collect();
    parts.push(match &one.worst {
        None if one.norm == 0.0 => format!("the same in {}", plural(one.nrow, "row")),
        None => format!(
            "the same in {}, largest value {}",
            plural(one.nrow, "row"),
            short(one.norm)
        ),
        Some(worst) => format!(
            "{} = {} of {}, {}",
            number(one.ratio()),
            number(one.difference),
            short(one.norm),
            place(worst)
        ),
    });
    parts.join("; ")
}

fn place(worst: &Worst) -> String {
    let ids: Vec<String> = worst.ids.iter().map(ToString::to_string).collect();
    let row = match ids.is_empty() {
        true => String::new(),
        false => format!("at {} ", ids.join(" ")),
    };
    format!(
        "{row}{}: {} for {}",
        worst.column, worst.found, worst.expected
    )
}

fn number(value: f64) -> String {
    format!("{value:.2e}")
}

fn tell_json(line: &impl Serialize) {
    // plain data with finite numbers or null: nothing can fail
    let text = serde_json::to_string(line).unwrap_or_default();
    Console::stdout().line(&text);
}

/// A block for machines.
#[derive(Serialize)]
struct Line<'a> {
    v: u32,
    ev: &'static str,
    file: &'a str,
    name: &'a str,
    time: Option<f64>,
    outcome: &'static str,
    same: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    numbers: Option<Numbers<'a>>,
}

#[derive(Serialize)]
struct Numbers<'a> {
    rows: usize,
    ratio: f64,
    difference: f64,
    norm: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    ids: Option<&'a [i64]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    column: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    found: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    expected: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    mismatch: Option<&'a str>,
}

impl<'a> Line<'a> {
    fn new(file: &'a str, finding: &'a Finding, same: bool) -> Self {
        let (outcome, numbers) = match &finding.outcome {
            Outcome::Extra => ("not in the reference", None),
            Outcome::Missing => ("only in the reference", None),
            Outcome::Both(one) => ("compared", Some(Numbers::new(one))),
        };
        Self {
            v: signorini_io::writers::json::EVENT_VERSION,
            ev: "block",
            file,
            name: &finding.name,
            time: finding.time,
            outcome,
            same,
            numbers,
        }
    }
}

impl<'a> Numbers<'a> {
    fn new(one: &'a Comparison) -> Self {
        let worst = one.worst.as_ref();
        Self {
            rows: one.nrow,
            ratio: one.ratio(),
            difference: one.difference,
            norm: one.norm,
            ids: worst.map(|w| w.ids.as_slice()),
            column: worst.map(|w| w.column.as_str()),
            found: worst.map(|w| w.found),
            expected: worst.map(|w| w.expected),
            mismatch: one.mismatch.as_deref(),
        }
    }
}

/// The last line for machines.
#[derive(Serialize)]
struct Verdict {
    v: u32,
    ev: &'static str,
    status: &'static str,
    exit_code: u8,
    blocks: usize,
    different: usize,
    single: usize,
    largest: f64,
}

impl Verdict {
    fn new(status: &'static str, exit_code: u8, count: &Count) -> Self {
        Self {
            v: signorini_io::writers::json::EVENT_VERSION,
            ev: "end",
            status,
            exit_code,
            blocks: count.nblock,
            different: count.ndifferent,
            single: count.nsingle,
            largest: count.largest,
        }
    }
}
