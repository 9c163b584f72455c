//! Keys of cases, explained one by one: what `signorini explain KEY` says.
//!
//! ```text
//!   contact.enforcement.penalty     the whole path; NAME stands for a name of the user's choice
//!   enforcement.penalty             its end
//!   material.neo-hookean.E          a constant of a model
//!   mortar                          a word that a key takes
//! ```

mod example;
mod part;
mod words;

use super::vocabulary::{Default, Key, Shape, Table, Vocabulary};
use crate::diagnostic::closest;
use part::Part;
use signorini_vocabulary::Description;

/// What stands for a name of the user's choice.
const NAME: &str = "NAME";
/// No more places of one name are listed.
const PLACES: usize = 8;

/// A key, explained.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyInfo {
    /// Where it stands: `contact.enforcement.penalty`.
    pub path: String,
    /// What it means.
    pub meaning: String,
    /// The form of its values, in words.
    pub form: String,
    /// The range of numbers, in words.
    pub range: Option<String>,
    /// The unit of numbers, where there is one of its own.
    pub unit: Option<&'static str>,
    /// What holds where it is absent.
    pub default: Option<String>,
    /// Whether it must be given.
    pub required: bool,
    /// What to write instead, where this version does not support it; may be empty.
    pub later: Option<&'static str>,
    /// The keys inside, with their meanings.
    pub keys: Vec<(&'static str, &'static str)>,
    /// A piece of a case with it.
    pub example: String,
}

/// What a query leads to.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The key.
    pub key: KeyInfo,
    /// Paths of other keys of this name.
    pub others: Vec<String>,
}

/// A key with the way to it.
#[derive(Clone, Debug)]
struct Entry {
    parts: Vec<Part>,
    key: Key,
}

impl Entry {
    fn path(&self) -> Vec<&'static str> {
        let mut path = Vec::new();
        for part in &self.parts {
            path.push(part.name());
            if matches!(part, Part::Named(_)) {
                path.push(NAME);
            }
        }
        path.push(self.key.name);
        path
    }

    fn is_of_material(&self) -> bool {
        self.parts.first() == Some(&Part::Named("material"))
    }

    fn info(&self, model: Option<&Description>) -> KeyInfo {
        let key = &self.key;
        let mut path = self.path();
        if let (Some(model), Some(name)) = (model, path.get_mut(1)) {
            *name = model.name;
        }
        KeyInfo {
            path: path.join("."),
            meaning: key.doc.to_owned(),
            form: words::form(&key.shape),
            range: words::range(&key.shape),
            unit: words::unit(key),
            default: words::default(&key.default),
            required: key.default == Default::Required,
            later: key.later,
            keys: inside(&key.shape).map_or_else(Vec::new, |table| listed(table.keys)),
            example: example::of(&self.parts, key, model.map(|model| model.name)),
        }
    }
}

fn listed(keys: &[Key]) -> Vec<(&'static str, &'static str)> {
    keys.iter().map(|key| (key.name, key.doc)).collect()
}

/// The table that a value may be, or that its entries are.
fn inside(shape: &Shape) -> Option<&'static Table> {
    match shape {
        Shape::Table(table) | Shape::Tables(table) | Shape::Named(table) => Some(table),
        Shape::Either(shapes) => shapes.iter().find_map(inside),
        _ => None,
    }
}

fn entries(vocabulary: &Vocabulary) -> Vec<Entry> {
    let mut out = Vec::new();
    walk(vocabulary.case, &[], &mut out);
    out
}

fn walk(table: &Table, parts: &[Part], out: &mut Vec<Entry>) {
    for key in table.keys {
        out.push(Entry {
            parts: parts.to_vec(),
            key: *key,
        });
        let below = |part: Part| [parts, &[part]].concat();
        let mut forms = vec![&key.shape];
        if let Shape::Either(shapes) = &key.shape {
            forms = shapes.iter().collect();
        }
        for form in forms {
            match form {
                Shape::Table(table) => walk(table, &below(Part::Table(key.name)), out),
                Shape::Tables(table) => walk(table, &below(Part::List(key.name)), out),
                Shape::Named(table) => walk(table, &below(Part::Named(key.name)), out),
                _ => {}
            }
        }
    }
}

/// The paths of all keys, in the order of the vocabulary.
#[must_use]
pub fn paths(vocabulary: &Vocabulary) -> Vec<String> {
    let all = entries(vocabulary);
    all.iter().map(|entry| entry.path().join(".")).collect()
}

/// The key that a query names: by its path, by the end of it, or by a word that it takes.
///
/// # Errors
/// The known path or word that the query was probably meant to be, where there is one.
pub fn find(vocabulary: &Vocabulary, query: &str) -> Result<Found, Option<String>> {
    let trimmed = query.trim_matches(|c: char| c.is_whitespace() || c == '[' || c == ']');
    let wanted: Vec<&str> = trimmed.split('.').map(str::trim).collect();
    let all = entries(vocabulary);
    if let Some(found) = of_model(vocabulary, &all, &wanted) {
        return Ok(found);
    }
    for same in [|a: &str, b: &str| a == b, str::eq_ignore_ascii_case] {
        let whole = all.iter().find(|one| matches(&one.path(), &wanted, same));
        let ends = all.iter().filter(|one| ends(&one.path(), &wanted, same));
        let mut ends: Vec<&Entry> = ends.collect();
        ends.sort_by_key(|one| one.path().len());
        let first = whole.or_else(|| ends.first().copied());
        if let Some(first) = first {
            let others = ends.iter().map(|one| one.path().join("."));
            let own = first.path().join(".");
            let is_whole = whole.is_some() && wanted.len() > 1;
            let others = others.filter(|path| *path != own && !is_whole);
            return Ok(Found {
                key: first.info(None),
                others: others.take(PLACES).collect(),
            });
        }
    }
    match all.iter().find(|one| takes(&one.key.shape, trimmed)) {
        Some(entry) => Ok(Found {
            key: entry.info(None),
            others: Vec::new(),
        }),
        None => Err(near(vocabulary, &all, trimmed)),
    }
}

/// `material.neo-hookean.E`, `material.neo-hookean`, `neo-hookean`.
fn of_model(vocabulary: &Vocabulary, all: &[Entry], wanted: &[&str]) -> Option<Found> {
    let wanted = match wanted {
        ["material", rest @ ..] => rest,
        [_] => wanted,
        _ => return None,
    };
    let (name, rest) = wanted.split_first()?;
    let model = vocabulary.material(name)?;
    let key = match rest {
        [] => {
            let entry = all.iter().find(|one| one.path() == ["material"])?;
            let mut info = entry.info(None);
            info.path = format!("material.{}", model.name);
            info.meaning = model.doc.to_owned();
            info.form = "table".to_owned();
            info.keys = listed(model.keys);
            info.example = example::of_model(model);
            info
        }
        [key] => {
            let own = model.keys.iter().find(|own| own.name == *key);
            let entry = all
                .iter()
                .find(|one| one.is_of_material() && one.key.name == *key)?;
            let entry = Entry {
                key: own.copied().unwrap_or(entry.key),
                ..entry.clone()
            };
            entry.info(Some(model))
        }
        _ => return None,
    };
    Some(Found {
        key,
        others: Vec::new(),
    })
}

/// Whether a path is the wanted one; any word stands for a name of the user's choice.
fn matches(path: &[&str], wanted: &[&str], same: impl Fn(&str, &str) -> bool) -> bool {
    let mut pairs = path.iter().zip(wanted);
    path.len() == wanted.len() && pairs.all(|(part, word)| *part == NAME || same(part, word))
}

/// Whether the end of a path is the wanted one.
fn ends(path: &[&str], wanted: &[&str], same: impl Fn(&str, &str) -> bool) -> bool {
    let from = path.len().checked_sub(wanted.len());
    let end = from.and_then(|from| path.get(from..));
    end.is_some_and(|end| end.iter().zip(wanted).all(|(part, word)| same(part, word)))
}

/// Whether a word is among the values of a form.
fn takes(shape: &Shape, word: &str) -> bool {
    match shape {
        Shape::Choice(choices) => choices.iter().any(|one| one.word == word),
        Shape::Either(shapes) => shapes.iter().any(|one| takes(one, word)),
        Shape::List(item, ..) => takes(item, word),
        _ => false,
    }
}

fn near(vocabulary: &Vocabulary, all: &[Entry], query: &str) -> Option<String> {
    let paths: Vec<String> = all.iter().map(|one| one.path().join(".")).collect();
    let models = vocabulary.materials().iter().map(|model| model.name);
    let names = all.iter().map(|one| one.key.name).chain(models);
    let known = names.chain(paths.iter().map(String::as_str));
    closest(query, known).map(str::to_owned)
}

impl KeyInfo {
    /// The explanation, in lines.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = format!("{}: {}\n\n", self.path, self.meaning);
        let mut line = |name: &str, value: &str| {
            text += &format!("  {name:<9}{value}\n");
        };
        line("values", &self.form);
        if let Some(range) = &self.range {
            line("range", range);
        }
        if let Some(unit) = self.unit {
            line("unit", unit);
        }
        match (&self.default, self.required) {
            (_, true) => line("default", "none: it must be given"),
            (Some(default), _) => line("default", default),
            (None, _) => line("default", "absent"),
        }
        match self.later {
            Some("") => line("status", "not supported by this version"),
            Some(instead) => line("status", &format!("not supported yet; write {instead}")),
            None => {}
        }
        if !self.keys.is_empty() {
            text += "\nKeys inside\n";
            let width = self.keys.iter().map(|(name, _)| name.len()).max();
            for (name, doc) in &self.keys {
                text += &format!("  {name:<width$}  {doc}\n", width = width.unwrap_or(0));
            }
        }
        text += "\nExample\n";
        for line in self.example.lines() {
            text += &format!("  {line}\n");
        }
        text
    }
}

#[cfg(test)]
mod tests;
