//! The vocabulary with what other rooms describe: materials, shapes of surfaces, contact laws, friction laws,
//! loads.

use super::bodies::MATERIAL;
use super::contact::{ENFORCEMENT, FRICTION};
use super::own;
use super::placeholders::{LAWS, LOADS, SHAPES};
use super::steps::LOAD;
use super::surface::SHAPE;
use super::whole::CASE;
use super::{Choice, Default, Key, Rule, Shape, Table, key, word};
use signorini_vocabulary::Description;

/// Descriptions of the things that a case may name, each from the room that makes them.
#[derive(Clone, Debug, Default)]
pub struct Kinds {
    /// Materials, by their `model`; the keys are their constants.
    pub materials: Vec<Description>,
    /// Shapes of surfaces, each a table in `shape`.
    pub surfaces: Vec<Description>,
    /// Curves of gap and pressure, each a table in `enforcement`.
    pub laws: Vec<Description>,
    /// Friction laws. The first key of each stands in `friction` and says which law is meant.
    pub frictions: Vec<Description>,
    /// Loads, each a key in `[[step.load]]`.
    pub loads: Vec<Description>,
}

/// Every key of a case, those of [`Kinds`] among them.
#[derive(Debug)]
pub struct Vocabulary {
    /// The whole case.
    pub case: &'static Table,
    kinds: Kinds,
}

impl Vocabulary {
    /// The vocabulary with these kinds of things, and those that the program brings which runs a case.
    ///
    /// # Limits
    /// Tables live as long as the program: make one vocabulary, not one for each case.
    #[must_use]
    pub fn new(mut kinds: Kinds) -> Self {
        kinds.materials.push(own::MATERIAL);
        kinds.surfaces.push(own::SHAPE);
        kinds.laws.push(own::LAW);
        kinds.frictions.push(own::FRICTION);
        let changes = [
            (&MATERIAL, with_materials(&MATERIAL, &kinds.materials)),
            (&SHAPE, with_tables(&SHAPE, &kinds.surfaces, 0, SHAPES)),
            (
                &ENFORCEMENT,
                with_tables(&ENFORCEMENT, &kinds.laws, 1, LAWS),
            ),
            (&LOAD, with_tables(&LOAD, &kinds.loads, 2, LOADS)),
            (&FRICTION, with_frictions(&FRICTION, &kinds.frictions)),
        ]
        .map(|(plain, table)| (plain, leak(table)));
        Self {
            case: replaced(&CASE, &changes).unwrap_or(&CASE),
            kinds,
        }
    }

    /// The vocabulary without any kind of thing: it has every default that a case has.
    pub(crate) fn plain() -> Self {
        Self {
            case: &CASE,
            kinds: Kinds::default(),
        }
    }

    /// The material of this name.
    #[must_use]
    pub fn material(&self, name: &str) -> Option<&Description> {
        self.kinds.materials.iter().find(|one| one.name == name)
    }

    /// All materials.
    #[must_use]
    pub fn materials(&self) -> &[Description] {
        &self.kinds.materials
    }

    /// All shapes of surfaces.
    #[must_use]
    pub fn surfaces(&self) -> &[Description] {
        &self.kinds.surfaces
    }

    /// All contact laws.
    #[must_use]
    pub fn laws(&self) -> &[Description] {
        &self.kinds.laws
    }

    /// All loads.
    #[must_use]
    pub fn loads(&self) -> &[Description] {
        &self.kinds.loads
    }

    /// All friction laws.
    #[must_use]
    pub fn frictions(&self) -> &[Description] {
        &self.kinds.frictions
    }
}

fn leak<T>(value: T) -> &'static T {
    Box::leak(Box::new(value))
}

fn leak_all<T>(values: Vec<T>) -> &'static [T] {
    Box::leak(values.into_boxed_slice())
}

/// The table with tables inside of it replaced by others; none where nothing changes.
fn replaced(
    table: &'static Table,
    changes: &[(&'static Table, &'static Table)],
) -> Option<&'static Table> {
    let known = changes
        .iter()
        .find(|(plain, _)| std::ptr::eq(*plain, table));
    if let Some((_, by)) = known {
        return Some(by);
    }
    let shapes: Vec<Option<Shape>> = table
        .keys
        .iter()
        .map(|key| replaced_shape(&key.shape, changes))
        .collect();
    if shapes.iter().all(Option::is_none) {
        return None;
    }
    let keys = table.keys.iter().zip(shapes).map(|(key, shape)| Key {
        shape: shape.unwrap_or(key.shape),
        ..*key
    });
    Some(leak(Table {
        keys: leak_all(keys.collect()),
        ..*table
    }))
}

fn replaced_shape(shape: &Shape, changes: &[(&'static Table, &'static Table)]) -> Option<Shape> {
    match *shape {
        Shape::Table(table) => replaced(table, changes).map(Shape::Table),
        Shape::Tables(table) => replaced(table, changes).map(Shape::Tables),
        Shape::Named(table) => replaced(table, changes).map(Shape::Named),
        Shape::Either(shapes) => {
            let new: Vec<Option<Shape>> = shapes
                .iter()
                .map(|one| replaced_shape(one, changes))
                .collect();
            if new.iter().all(Option::is_none) {
                return None;
            }
            let all = new.into_iter().zip(shapes);
            let all = all.map(|(new, old)| new.unwrap_or(*old)).collect();
            Some(Shape::Either(leak_all(all)))
        }
        _ => None,
    }
}

/// Keys of several descriptions, each once, as keys that may be absent.
fn all_keys(of: &[Description]) -> Vec<Key> {
    let mut keys: Vec<Key> = Vec::new();
    for key in of.iter().flat_map(|one| one.keys) {
        if keys.iter().all(|known| known.name != key.name) {
            keys.push(Key {
                default: Default::Absent,
                ..*key
            });
        }
    }
    keys
}

/// Models are words, and their constants keys behind the word.
fn with_materials(table: &Table, materials: &[Description]) -> Table {
    let models: Vec<Choice> = materials.iter().map(|one| word(one.name)).collect();
    let mut keys = table.keys.to_vec();
    if let Some(model) = keys.first_mut() {
        model.shape = Shape::Choice(leak_all(models));
    }
    let constants = all_keys(materials);
    let behind = keys.len().min(1);
    keys.splice(behind..behind, constants);
    Table {
        keys: leak_all(keys),
        ..*table
    }
}

/// Each thing is a key with a table or a value of its own, behind the first keys of the table; its rules have the names
/// of all things in place of `mark`.
fn with_tables(table: &Table, things: &[Description], behind: usize, mark: &str) -> Table {
    let of_things = things.iter().map(|thing| {
        if let Some(only) = thing.bare_key() {
            let default = Default::Absent;
            return Key { default, ..*only };
        }
        let inner = leak(Table {
            heading: thing.name,
            doc: thing.doc,
            keys: thing.keys,
            rules: thing.rules,
        });
        key(thing.name, Shape::Table(inner), thing.doc).hints(thing.hints)
    });
    let mut keys = table.keys.to_vec();
    let behind = keys.len().min(behind);
    keys.splice(behind..behind, of_things);
    let all: Vec<&'static str> = things.iter().map(|thing| thing.name).collect();
    let names = |keys: &'static [&'static str]| {
        let names = keys.iter().flat_map(|key| match *key {
            key if key == mark => all.as_slice(),
            _ => std::slice::from_ref(key),
        });
        leak_all(names.copied().collect())
    };
    let rules = table.rules.iter().map(|rule| match rule {
        Rule::ExactlyOne(keys) => Rule::ExactlyOne(names(keys)),
        Rule::AtMostOne(keys) => Rule::AtMostOne(names(keys)),
        other => *other,
    });
    Table {
        keys: leak_all(keys),
        rules: leak_all(rules.collect()),
        ..*table
    }
}

/// Keys of all laws, before those of the table; the first of each law says which one it is.
fn with_frictions(table: &Table, laws: &[Description]) -> Table {
    let mut keys = all_keys(laws);
    keys.extend_from_slice(table.keys);
    let firsts = laws.iter().filter_map(|law| law.keys.first());
    let mut rules = vec![Rule::ExactlyOne(leak_all(
        firsts.map(|key| key.name).collect(),
    ))];
    for law in laws {
        let Some((first, others)) = law.keys.split_first() else {
            continue;
        };
        for other in others {
            rules.push(Rule::Needs(other.name, first.name));
            if other.default == Default::Required {
                rules.push(Rule::Needs(first.name, other.name));
            }
        }
        rules.extend_from_slice(law.rules);
    }
    rules.extend_from_slice(table.rules);
    Table {
        keys: leak_all(keys),
        rules: leak_all(rules),
        ..*table
    }
}
