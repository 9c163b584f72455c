//! Which kind of thing a text between backquotes names, and whether that exists.

use super::toml::{Data, Kind, parse};
use super::{Facts, commands};
use crate::tree::{is_path, is_placeholder};
use std::path::Path;

/// Stems of the names that pages give to files of the user.
const USERS: [&str; 5] = ["case", "job", "mesh", "part", "reference"];

/// Words of Rust that no source here defines.
const FREE: [&str; 2] = ["unsafe", "unwrap"];

/// What is wrong with a text between backquotes.
pub(super) fn faults(text: &str, page: &Path, facts: &Facts) -> Vec<String> {
    if commands::is_command(text) {
        return commands::faults(text, page, facts);
    }
    if text.starts_with('-') && text[1..].starts_with(|c: char| c.is_ascii_alphabetic() || c == '-')
    {
        return commands::option_faults(text, facts);
    }
    if let Some(faults) = key_faults(text, facts) {
        return faults;
    }
    let is_known = match text {
        _ if text.starts_with('*') => {
            let card = text.split(',').next().unwrap_or_default();
            card.len() < 2 || facts.symbols.has_word(card.trim_start_matches('*'))
        }
        _ if is_path(text) => is_known_path(text, page, facts),
        _ if text.contains("::") && text.chars().all(|c| is_wordy(c) || c == ':') => {
            facts.symbols.has(text)
        }
        _ => return word_faults(text, facts),
    };
    missing(
        is_known,
        text,
        "nothing in the repository has this name: correct it, or write it without backquotes",
    )
}

fn missing(is_known: bool, text: &str, what: &str) -> Vec<String> {
    if is_known {
        Vec::new()
    } else {
        vec![format!("`{text}`: {what}")]
    }
}

/// A file of the repository, one that a program writes, or one of the user.
fn is_known_path(text: &str, page: &Path, facts: &Facts) -> bool {
    let is_shown = commands::is_followed(page) && !text.contains('/');
    if is_shown || facts.tree.knows(page, text) {
        return true;
    }
    let (folder, name) = text
        .rsplit_once('/')
        .map_or(("", text), |(folder, name)| (folder, name));
    let (stem, ending) = name.split_once('.').unwrap_or((name, ""));
    let is_of_user = USERS.contains(&stem) || is_placeholder(stem);
    let parts = stem.split(['_', '-']).filter(|part| !is_placeholder(part));
    let is_numbered = stem.contains("NNNN")
        && parts
            .into_iter()
            .all(|part| facts.symbols.has_fragment(part));
    let is_written = name.is_empty() || facts.symbols.has_word(name) || is_numbered;
    let is_source = ["rs", "md", "py"].contains(&ending);
    let is_results = folder.is_empty()
        || folder.ends_with(".out")
        || folder == "frames"
        || is_placeholder(folder);
    !is_source && is_results && (is_of_user || is_written)
}

fn is_wordy(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_' || c == '-'
}

/// What is wrong with keys and values of cases; none where the text is none of these.
fn key_faults(text: &str, facts: &Facts) -> Option<Vec<String>> {
    if text.starts_with('[') {
        return header_faults(text, facts);
    }
    if text.starts_with('{') && text.ends_with('}') {
        let value = single(&format!("x = {text}"))?.1;
        let known = facts.keys.fits(None, &value);
        return Some(missing(known, text, "no key of a case takes such a table"));
    }
    if text.starts_with('"') && text.ends_with('"') && text.len() > 2 {
        let word = text.trim_matches('"');
        let known = facts.keys.has_word(word) || facts.symbols.has_word(word);
        return Some(missing(known, text, "no key of a case takes this word"));
    }
    if !text.contains(" = ") {
        return None;
    }
    let (key, value) = single(text)?;
    let is_formula = is_symbol(&key) && matches!(value.kind, Kind::Integer | Kind::Number);
    if is_formula && !facts.keys.has(&key) {
        return Some(Vec::new());
    }
    let known = facts.keys.fits(Some(&key), &value);
    Some(missing(
        known,
        text,
        "a case has no such key, or the key takes no such value",
    ))
}

/// A table's header, alone or with a key behind it: `[solver] linear = "direct"`.
fn header_faults(text: &str, facts: &Facts) -> Option<Vec<String>> {
    let at = text.find(']')?;
    let closing = text[at..].chars().take_while(|c| *c == ']').count();
    let (header, rest) = text.split_at(at + closing);
    let name = header.trim_matches(['[', ']']);
    if name.len() < 3
        || !name
            .chars()
            .all(|c| c.is_ascii_lowercase() || "_.".contains(c))
    {
        return None;
    }
    let faults = facts.keys.faults(&format!("{header}\n{rest}")).into_iter();
    Some(
        faults
            .map(|fault| format!("`{text}`: {}", fault.what))
            .collect(),
    )
}

/// The one key and value of a text in TOML.
fn single(text: &str) -> Option<(String, Data)> {
    let Kind::Table(mut entries) = parse(text).ok()?.kind else {
        return None;
    };
    let entry = entries.pop().filter(|_| entries.is_empty())?;
    Some((entry.key, entry.value))
}

/// Whether a word is a symbol of a formula: each part has two letters at most.
fn is_symbol(word: &str) -> bool {
    word.split('_').all(|part| part.len() <= 2)
}

/// A single word: a symbol, a key, a value, a name that programs write or read.
fn word_faults(text: &str, facts: &Facts) -> Vec<String> {
    let call = text.strip_suffix("()").unwrap_or(text);
    if call.contains('.')
        && !call.starts_with('.')
        && call
            .split('.')
            .all(|part| !part.is_empty() && part.chars().all(is_wordy))
    {
        return dotted_faults(text, facts);
    }
    let is_word = call.starts_with(|c: char| c.is_ascii_alphabetic()) && call.chars().all(is_wordy);
    let is_free =
        FREE.contains(&call) || (call.contains('-') && call.split('-').all(is_placeholder));
    if !is_word || is_symbol(call) || (is_free && !facts.symbols.has(call)) {
        return Vec::new();
    }
    missing(
        is_known_word(call, facts),
        text,
        "no symbol, key, option or file of the repository has this name: correct it, or write it without backquotes",
    )
}

/// `material.rubber.E`, or a result such as `tip.force_x`, whose first part is a name of the user.
fn dotted_faults(text: &str, facts: &Facts) -> Vec<String> {
    let mut parts = text.split('.');
    let first = parts.next().unwrap_or_default();
    if text
        .chars()
        .all(|c| c.is_ascii_digit() || "e.-".contains(c))
    {
        return Vec::new();
    }
    let known = if facts.keys.has_top(first) {
        facts.keys.leads(text)
    } else {
        parts.all(|part| is_symbol(part) || is_known_word(part, facts))
    };
    missing(known, text, "no key of a case and no result has this name")
}

fn is_known_word(word: &str, facts: &Facts) -> bool {
    facts.symbols.has(word)
        || facts.symbols.has_word(word)
        || facts.keys.has(word)
        || facts.keys.has_word(word)
        || facts.program.has(word)
        || facts.packages.has("package", None, word)
        || facts.packages.has("test", None, word)
        || facts.tree.has(Path::new(word))
}
