//! A message, its remedy read from it, and the case with the remedy in it.

use crate::support::{Ended, folder_with, run};

/// A case that provokes a message, and what becomes of it with the remedy.
pub struct Trial<'a> {
    pub text: String,
    /// The exit code with the message.
    pub code: i32,
    /// The message: its code, the names in it, and the place.
    pub says: &'a [&'a str],
    /// How the line of the remedy begins.
    pub help: &'a str,
    pub remedy: Remedy<'a>,
    /// What the message is known by, where the case was solved with it, too.
    pub gone: Option<&'a str>,
}

/// How the remedy gets into the case.
pub enum Remedy<'a> {
    /// The key of the help, where the help says that it belongs.
    Key,
    /// What the help describes: this text for that one.
    Change(&'a str, &'a str),
    /// What the help describes, in another case.
    Case(String),
}

impl Trial<'_> {
    /// Asserts that the message names everything, and that the remedy works.
    #[track_caller]
    pub fn holds(self) {
        let before = ended(&self.text);
        before.says(self.code, self.says);
        let help = helps(&before, self.help);
        let text = match self.remedy {
            Remedy::Key => with_key(&self.text, &help),
            Remedy::Change(from, to) => {
                assert!(self.text.contains(from), "{from}");
                self.text.replacen(from, to, 1)
            }
            Remedy::Case(text) => text,
        };
        let after = ended(&text);
        assert_eq!(after.code, Some(0), "{help}\n{}\n{}", after.out, after.err);
        if self.code == 0 {
            assert!(self.gone.is_some(), "a message of a solved case");
        }
        if let Some(gone) = self.gone {
            assert!(!after.err.contains(gone), "{help}\n{}", after.err);
        }
    }
}

pub fn ended(text: &str) -> Ended {
    let folder = folder_with(text);
    run(folder.path(), &["run", "case.toml"])
}

/// The line of help that begins so.
#[track_caller]
fn helps(ended: &Ended, beginning: &str) -> String {
    let lines = ended.err.lines().rev();
    let mut helps = lines.filter_map(|line| line.trim_start().strip_prefix("= help: "));
    let found = helps.find(|help| help.starts_with(beginning));
    found
        .unwrap_or_else(|| panic!("no help `{beginning}` in\n{}", ended.err))
        .to_owned()
}

/// The case with the key of a help: `what it does:  KEY = VALUE  of contact "touch"`.
#[track_caller]
fn with_key(text: &str, help: &str) -> String {
    let parts: Vec<&str> = help.split("  ").collect();
    let at = parts.iter().position(|part| part.contains(" = "));
    let at = at.unwrap_or_else(|| panic!("no key in `{help}`"));
    let owner = parts.get(at + 1);
    let owner = owner.unwrap_or_else(|| panic!("no table in `{help}`"));
    let (heading, name) = match owner.split_once('"') {
        None if owner.contains("[solver]") => ("[solver]".to_owned(), None),
        Some((kind, name)) => {
            let name = name.split('"').next().unwrap_or_default();
            match kind.trim() {
                "of contact" => ("[[contact]]".to_owned(), Some(name)),
                "of step" => ("[[step]]".to_owned(), Some(name)),
                "of material" => (format!("[material.{name}]"), None),
                other => panic!("`{other}` in `{help}`"),
            }
        }
        None => panic!("no table in `{help}`"),
    };
    insert(text, &heading, name, parts[at])
}

/// Puts a line into the table of that heading and name, in the place of the same key.
#[track_caller]
fn insert(text: &str, heading: &str, name: Option<&str>, line: &str) -> String {
    let key = line.split(" = ").next().unwrap();
    let mut lines: Vec<&str> = text.lines().collect();
    let end = |from: usize| {
        let rest = lines.iter().skip(from);
        from + rest.take_while(|line| !line.starts_with('[')).count()
    };
    let name = name.map(|name| format!("name = \"{name}\""));
    let is_it = |&at: &usize| {
        let own = &lines[at + 1..end(at + 1)];
        lines[at] == heading
            && name
                .as_ref()
                .is_none_or(|name| own.contains(&name.as_str()))
    };
    match (0..lines.len()).find(is_it) {
        Some(at) => {
            let own = at + 1..end(at + 1);
            let same = |line: &str| line.strip_prefix(key).is_some_and(|l| l.starts_with(" = "));
            if let Some(old) = own.clone().find(|&k| same(lines[k])) {
                lines.remove(old);
            }
            lines.insert(at + 1, line);
        }
        None => {
            assert!(name.is_none(), "no {heading} {name:?}");
            lines.extend([heading, line]);
        }
    }
    lines.join("\n") + "\n"
}

#[test]
fn a_key_goes_where_its_help_says() {
    let text = "[[contact]]\nname = \"a\"\nmethod = \"mortar\"\n[[contact]]\nname = \"b\"\n";
    let help = "another method:  method = \"gauss-point\"  of contact \"a\"";
    let expected =
        "[[contact]]\nmethod = \"gauss-point\"\nname = \"a\"\n[[contact]]\nname = \"b\"\n";
    assert_eq!(with_key(text, help), expected);
    let help = "or:  free_motions = \"hold\"  in [solver]";
    assert!(with_key(text, help).ends_with("[solver]\nfree_motions = \"hold\"\n"));
}
