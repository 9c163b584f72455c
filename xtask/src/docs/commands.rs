//! Command lines that a page names: programs, subcommands, options, packages, tests.

use super::Facts;
use serde_json::Value as Json;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Options by subcommand of the program.
#[derive(Debug, Default)]
pub(super) struct Program {
    options: BTreeMap<String, BTreeSet<String>>,
}

impl Program {
    /// The subcommands that a page of help lists.
    pub fn subcommands(help: &str) -> Vec<String> {
        let lines = help.lines().skip_while(|line| *line != "Commands:").skip(1);
        let listed = lines.take_while(|line| !line.is_empty());
        let names = listed.filter_map(|line| line.strip_prefix("  ")?.split_whitespace().next());
        names.map(ToString::to_string).collect()
    }

    /// Adds a subcommand with the options of its page of help.
    pub fn add(&mut self, subcommand: &str, help: &str) {
        let lines = help
            .lines()
            .map(str::trim_start)
            .filter(|line| line.starts_with('-'));
        let words = lines.flat_map(|line| {
            line.split([' ', ','])
                .take_while(|word| word.is_empty() || word.starts_with('-'))
        });
        let options = words
            .filter(|word| !word.is_empty())
            .map(ToString::to_string);
        self.options
            .insert(subcommand.to_string(), options.collect());
    }

    fn knows(&self, option: &str) -> bool {
        self.options
            .values()
            .any(|options| options.contains(option))
    }

    /// Whether there is such a subcommand.
    pub fn has(&self, subcommand: &str) -> bool {
        self.options.contains_key(subcommand)
    }
}

/// Packages of the workspace with their targets and features, as `cargo metadata` lists them.
#[derive(Debug, Default)]
pub(super) struct Packages {
    /// Kind of a target (`test`, `bin`, …, `feature`), package, name.
    targets: BTreeSet<(String, String, String)>,
}

impl Packages {
    pub fn new(metadata: &Json) -> Self {
        let mut out = Self::default();
        let list = |json: &Json, key: &str| {
            json.get(key)
                .and_then(Json::as_array)
                .cloned()
                .unwrap_or_default()
        };
        let text = |json: &Json| json.as_str().unwrap_or_default().to_string();
        for package in list(metadata, "packages") {
            let name = text(&package["name"]);
            out.targets
                .insert(("package".to_string(), name.clone(), name.clone()));
            for target in list(&package, "targets") {
                for kind in list(&target, "kind") {
                    out.targets
                        .insert((text(&kind), name.clone(), text(&target["name"])));
                }
            }
            let features = package.get("features").and_then(Json::as_object);
            for feature in features.into_iter().flat_map(|features| features.keys()) {
                out.targets
                    .insert(("feature".to_string(), name.clone(), feature.clone()));
            }
        }
        out
    }

    /// Whether a package, or any, has such a target.
    pub fn has(&self, kind: &str, package: Option<&str>, name: &str) -> bool {
        let fits = |(k, p, n): &(String, String, String)| {
            k == kind && package.is_none_or(|wanted| p == wanted) && n == name
        };
        self.targets.iter().any(fits)
    }
}

/// Programs of others: their options are not checked.
const FOREIGN: [&str; 8] = [
    "apt", "ccx", "git", "gmsh", "paraview", "pip", "rustup", "pvpython",
];

/// Subcommands of cargo that take a package and targets.
const CARGO: [&str; 10] = [
    "bench", "build", "check", "clippy", "doc", "fmt", "install", "publish", "run", "test",
];

/// Options of cargo and of its tests that take no name of this repository.
const CARGO_OPTIONS: [&str; 17] = [
    "--all",
    "--all-targets",
    "--check",
    "--dry-run",
    "--features",
    "--ignored",
    "--lib",
    "--no-deps",
    "--nocapture",
    "--open",
    "--package",
    "--path",
    "--release",
    "--test",
    "--test-threads",
    "--workspace",
    "--bench",
];

/// Whether a text starts as a command does.
pub(super) fn is_command(text: &str) -> bool {
    let mut words = text.split_whitespace().skip_while(|word| is_setting(word));
    let Some(first) = words.next() else {
        return false;
    };
    let known =
        ["cargo", "signorini", "python", ".ci/run"].contains(&first) || FOREIGN.contains(&first);
    known && (words.next().is_some() || first == ".ci/run")
}

/// Whether a word sets a variable of the environment.
fn is_setting(word: &str) -> bool {
    let name = word.split_once('=').map(|(name, _)| name);
    name.is_some_and(|name| {
        !name.is_empty() && name.chars().all(|c| c.is_ascii_uppercase() || c == '_')
    })
}

/// What is wrong with a command on a page.
pub(super) fn faults(line: &str, page: &Path, facts: &Facts) -> Vec<String> {
    let Some(words) = shlex::split(line) else {
        return vec!["a quotation mark is not closed".to_string()];
    };
    let mut check = Check {
        page,
        facts,
        faults: Vec::new(),
    };
    for command in words.split(|word| ["&&", "|", ";", ">"].contains(&word.as_str())) {
        let words: Vec<&str> = command
            .iter()
            .map(String::as_str)
            .skip_while(|word| is_setting(word))
            .collect();
        check.command(&words);
    }
    check.faults
}

/// What is wrong with options that stand alone, as in `--compat ccx`.
pub(super) fn option_faults(text: &str, facts: &Facts) -> Vec<String> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let mut faults = Vec::new();
    for (i, word) in words
        .iter()
        .enumerate()
        .filter(|(_, word)| word.starts_with('-'))
    {
        let option = word.split('=').next().unwrap_or_default();
        let is_number = option[1..].starts_with(|c: char| c.is_ascii_digit());
        let known = facts.program.knows(option)
            || CARGO_OPTIONS.contains(&option)
            || facts
                .scripts
                .iter()
                .any(|script| takes(&script.text, option));
        if !known && !is_number {
            faults.push(format!("no command or script has the option {option}"));
        }
        if option == "--set" {
            faults.extend(words.get(i + 1).and_then(|change| set_fault(change, facts)));
        }
    }
    faults
}

/// A change by `--set` has to name a key.
fn set_fault(change: &str, facts: &Facts) -> Option<String> {
    let (key, _) = change.split_once('=')?;
    let known = facts.keys.leads(key) || key == "KEY";
    (!known).then(|| format!("a case has no key {key} for --set"))
}

/// A Python script.
#[derive(Debug, Default)]
pub(super) struct Script {
    /// From the root.
    pub path: std::path::PathBuf,
    pub text: String,
}

fn takes(script: &str, option: &str) -> bool {
    script.contains(&format!("\"{option}\""))
}

/// Whether a page is one that a test does from the first line to the last: `crates/signorini-cli/tests/pages/reader.rs`.
pub(super) fn is_followed(page: &Path) -> bool {
    page.starts_with("docs/tutorials") || page.starts_with("docs/howto")
}

struct Check<'a> {
    page: &'a Path,
    facts: &'a Facts,
    faults: Vec<String>,
}

impl Check<'_> {
    fn command(&mut self, words: &[&str]) {
        match words {
            [] => {}
            ["cargo", rest @ ..] => self.cargo(rest),
            ["signorini", rest @ ..] => self.signorini(rest),
            // the test that follows these pages runs their commands, with the files that they show
            _ if is_followed(self.page) => {}
            ["python" | "python3" | "pvpython", script, rest @ ..] => self.script(script, rest),
            [program, rest @ ..] if FOREIGN.contains(program) => self.files(rest),
            [program, ..] if program.contains('/') => self.file(program),
            [program, ..] => self.faults.push(format!(
                "{program} is no program of this project, and none of those of others that it uses"
            )),
        }
    }

    /// A file of the repository that a command takes. Others are the user's.
    fn file(&mut self, word: &str) {
        let results = word.split('/').any(|part| part.ends_with(".out"));
        let ours = word.starts_with("examples/")
            || word.starts_with("scripts/")
            || word.starts_with("crates/")
            || word.starts_with(".ci/");
        if ours && !results && !self.facts.tree.has(Path::new(word)) {
            self.faults.push(format!("there is no file {word}"));
        }
    }

    /// Files next to the page from which others are made.
    fn files(&mut self, words: &[&str]) {
        for word in words {
            if word.ends_with(".geo") && !self.facts.tree.has_from(self.page, word) {
                self.faults
                    .push(format!("there is no file {word} next to the page"));
            }
            self.file(word);
        }
    }

    fn signorini(&mut self, words: &[&str]) {
        let [subcommand, rest @ ..] = words else {
            return;
        };
        if ["--help", "--version", "…", "..."].contains(subcommand) {
            return;
        }
        let Some(options) = self.facts.program.options.get(*subcommand) else {
            return self
                .faults
                .push(format!("signorini has no subcommand {subcommand}"));
        };
        for (i, word) in rest.iter().enumerate() {
            let option = word.split('=').next().unwrap_or_default();
            if option.starts_with('-') && !options.contains(option) {
                self.faults
                    .push(format!("signorini {subcommand} has no option {option}"));
            } else if option == "--set" {
                self.faults.extend(
                    rest.get(i + 1)
                        .and_then(|change| set_fault(change, self.facts)),
                );
            } else {
                self.file(word);
            }
        }
    }

    fn script(&mut self, path: &str, words: &[&str]) {
        let scripts = &self.facts.scripts;
        let Some(script) = scripts.iter().find(|script| script.path == Path::new(path)) else {
            return self.faults.push(format!("there is no script {path}"));
        };
        let imports = |other: &&Script| {
            let stem = other
                .path
                .file_stem()
                .and_then(|stem| stem.to_str())
                .unwrap_or_default();
            script.text.contains(&format!("import {stem}"))
                || script.text.contains(&format!("from {stem} "))
        };
        let texts: Vec<&Script> = scripts.iter().filter(imports).chain([script]).collect();
        for word in words {
            let option = word.split('=').next().unwrap_or_default();
            if option.starts_with('-') && !texts.iter().any(|script| takes(&script.text, option)) {
                self.faults.push(format!("{path} has no option {option}"));
            }
            self.file(word);
        }
    }

    fn cargo(&mut self, words: &[&str]) {
        let (own, passed) = match words.iter().position(|word| *word == "--") {
            Some(at) => (&words[..at], Some(&words[at + 1..])),
            None => (words, None),
        };
        match own {
            ["xtask", chore @ ..] => {
                if !chore.is_empty() && !crate::is_chore(chore) {
                    self.faults
                        .push(format!("cargo xtask has no chore \"{}\"", chore.join(" ")));
                }
            }
            [subcommand, options @ ..] if CARGO.contains(subcommand) => {
                self.cargo_options(subcommand, options);
                if let ("run", Some(passed)) = (*subcommand, passed) {
                    self.signorini(passed);
                }
            }
            _ => self
                .faults
                .push(format!("cargo {} is not known here", own.join(" "))),
        }
    }

    fn cargo_options(&mut self, subcommand: &str, words: &[&str]) {
        let value_of = |names: [&str; 2]| {
            let at = words.iter().position(|word| names.contains(word))?;
            words.get(at + 1).copied()
        };
        let package = value_of(["-p", "--package"]);
        let mut words = words.iter().copied();
        while let Some(word) = words.next() {
            let kind = match word {
                "-p" | "--package" => "package",
                "--test" => "test",
                "--bin" => "bin",
                "--example" => "example",
                "--bench" => "bench",
                "--features" => "feature",
                "--path" => {
                    words.next().into_iter().for_each(|path| self.file(path));
                    continue;
                }
                "-j" => {
                    words.next();
                    continue;
                }
                _ => {
                    self.cargo_word(subcommand, word);
                    continue;
                }
            };
            let name = words.next().unwrap_or_default();
            if !self.facts.packages.has(kind, package, name) {
                let of = package
                    .filter(|_| kind != "package")
                    .map_or(String::new(), |package| format!(" of {package}"));
                self.faults.push(format!("there is no {kind} {name}{of}"));
            }
        }
    }

    /// An option without a value, or a filter of tests.
    fn cargo_word(&mut self, subcommand: &str, word: &str) {
        if word.starts_with('-') {
            if !CARGO_OPTIONS.contains(&word) {
                self.faults
                    .push(format!("the option {word} of cargo is not known here"));
            }
        } else if subcommand == "test" && !self.facts.symbols.has_filter(word) {
            self.faults
                .push(format!("no test has \"{word}\" in its path"));
        }
    }
}
