//! Things that other rooms describe: the values of their keys.

use super::super::fields::Fields;
use super::super::parts::Space;
use super::builder::Builder;
use crate::diagnostic::codes;
use signorini_vocabulary::{Chosen, Description, InPlane, Key, Shape, Value, Values};

impl Builder<'_> {
    /// The thing whose name is a key of the table.
    pub(super) fn chosen(&mut self, fields: Fields<'_>, thing: &Description) -> Chosen {
        let of_thing = match thing.bare_key() {
            Some(_) => fields,
            None => fields.table(thing.name),
        };
        Chosen {
            name: thing.name,
            values: self.values(of_thing, thing.keys),
        }
    }

    /// The values of these keys, defaults among them; keys without either are left out. Vectors have three components.
    pub(super) fn values(&mut self, fields: Fields<'_>, keys: &[Key]) -> Values {
        keys.iter().fold(Values::new(), |values, key| {
            let value = if is_vector(&key.shape) && fields.has(key.name) {
                let vector = self.vector_of(fields, key);
                vector.map(|vector| Value::Numbers(vector.into()))
            } else {
                fields.value(key)
            };
            match value {
                Some(value) => values.with(key.name, value),
                None => values,
            }
        })
    }

    /// The value of a key that is a vector or a direction; in a plane model as the key has it there.
    fn vector_of(&mut self, fields: Fields<'_>, key: &Key) -> Option<[f64; 3]> {
        let (name, place) = (key.name, fields.place(key.name));
        if key.plane == InPlane::Across && self.space == Space::Axisymmetric {
            self.error(
                &codes::CONTRADICTION,
                format!("a body of revolution takes no {name}"),
                &place,
                "its sections do not turn",
            );
        }
        let vector = match key.shape {
            Shape::Either(_) => self.line(fields, name),
            _ => self.vector(fields, name),
        }?;
        match key.plane {
            InPlane::Any => {}
            InPlane::Within => self.within(vector, name, &place),
            InPlane::Across => self.across(vector, name, &place),
        }
        Some(vector)
    }
}

/// Whether values of this form are vectors, or the name of an axis in place of one.
fn is_vector(shape: &Shape) -> bool {
    match shape {
        Shape::List(Shape::Number(_), 2, 3) => true,
        Shape::Either([Shape::Choice(_), vector]) => is_vector(vector),
        _ => false,
    }
}
