//! Contact without pairs: `all`.

use super::super::fields::Fields;
use super::super::parts::*;
use super::builder::Builder;
use super::contact::{method, per, start};
use crate::diagnostic::{Diagnostic, Place, codes};

/// Keys of a contact that mean nothing where pairs are found, with what to write instead.
const REFUSED: [(&str, &str); 5] = [
    ("passes", "delete it"),
    (
        "reach",
        "facets see as far as they are large, and as far as they move",
    ),
    (
        "tied",
        "name the sides that are joined in a [[contact]] of their own",
    ),
    ("pairs", "delete it"),
    (
        "wear",
        "name the sides that wear in a [[contact]] of their own",
    ),
];

impl Builder<'_> {
    /// The contact without pairs, of all contacts.
    pub(super) fn general(&mut self, contacts: Vec<(Fields<'_>, Place)>) -> Option<General> {
        let mut all = contacts.into_iter().filter(|(fields, _)| fields.has("all"));
        let (fields, place) = all.next()?;
        for (_, other) in all {
            self.found.push(
                Diagnostic::error(&codes::CONTRADICTION, "there are two contacts with `all`")
                    .at(&other, "the second")
                    .at(&place, "the first")
                    .help("say what is different between two bodies by [[contact.pair]]"),
            );
        }
        if fields.flag_if("all") == Some(false) {
            let remark = "write true, or list what may touch";
            let message = "a contact with  all = false  is none";
            self.error(&codes::CONTRADICTION, message, &fields.place("all"), remark);
        }
        for (key, remark) in REFUSED.iter().filter(|(key, _)| fields.has(key)) {
            let message = format!("`{key}` does not go with `all`");
            self.error(&codes::CONTRADICTION, message, &fields.place(key), *remark);
        }
        let common = self.contact(fields, place);
        if *common.method == Method::NodeToNode {
            let message = "\"node-to-node\" does not go with `all`";
            let remark = "it needs matching nodes: name the sides";
            self.error(&codes::CONTRADICTION, message, &common.method.place, remark);
        }
        let exclude = fields.rows("exclude").filter_map(|entry| {
            let names: Vec<Name> = match entry.get_ref().as_array() {
                Some(items) => items
                    .iter()
                    .filter_map(|one| fields.spanned_text(one))
                    .collect(),
                None => fields.spanned_text(entry).into_iter().collect(),
            };
            match &names[..] {
                [one] => Some((one.clone(), None)),
                [one, other] => Some((one.clone(), Some(other.clone()))),
                _ => {
                    let message = "an entry of `exclude` is a name, or a pair of names";
                    let at = fields.at(entry.span());
                    self.error(&codes::WRONG_LENGTH, message, &at, "three names or more");
                    None
                }
            }
        });
        let exclude = exclude.collect();
        let pairs = fields.tables("pair").into_iter();
        Some(General {
            of: fields.texts("all"),
            with_itself: fields.flag("self"),
            exclude,
            pairs: pairs
                .map(|(fields, place)| self.general_pair(fields, place))
                .collect(),
            common,
        })
    }

    fn general_pair(&mut self, fields: Fields<'_>, place: Place) -> GeneralPair {
        let mut names = fields.texts("between").into_iter();
        let mut next = || names.next().unwrap_or_default();
        let between = [next(), next()];
        let secondary = fields.text_if("secondary");
        let is_of = |name: &Name| between.iter().any(|one| one.value == name.value);
        if let Some(name) = secondary.as_ref().filter(|name| !is_of(name)) {
            let message = format!("\"{}\" is not one of the two", name.value);
            let remark = "it must be named by `between`";
            self.error(&codes::CONTRADICTION, message, &name.place, remark);
        }
        let has = |key: &str| fields.has(key);
        GeneralPair {
            friction: has("friction").then(|| self.friction(fields)),
            enforcement: has("enforcement").then(|| (self.enforcement(fields), per(fields))),
            method: has("method").then(|| method(fields)),
            secondary,
            start: has("start").then(|| start(fields.table("start"))),
            ..GeneralPair::new(between, place)
        }
    }
}
