//! Contacts.

use super::super::fields::Fields;
use super::super::parts::*;
use super::Builder;
use crate::diagnostic::{Place, Spanned, codes};

impl Builder {
    pub(super) fn contact(&mut self, fields: Fields<'_>, place: Place) -> Contact {
        let friction = fields
            .number_if("friction")
            .unwrap_or_else(|| fields.number("friction").into());
        if *friction > 0.0 {
            self.later(
                &format!("`friction` = {}", friction.value),
                &friction.place,
                "friction = 0.0",
            );
        }
        if fields.count("passes") == 2 {
            self.later("`passes` = 2", &fields.place("passes"), "passes = 1");
        }
        if fields.flag("tied") {
            self.later(
                "`tied` = true",
                &fields.place("tied"),
                "one body, with a mesh that is joined",
            );
        }
        let method = fields.text("method");
        Contact {
            name: fields.text("name"),
            secondary: fields.text("secondary"),
            primary: self.primary(fields),
            method: Spanned::new(
                match method.value.as_str() {
                    "node-to-segment" => Method::NodeToSegment,
                    _ => Method::Auto,
                },
                method.place,
            ),
            enforcement: enforcement(fields),
            friction,
            reach: fields.number_if("reach").map(|reach| reach.value),
            active: fields.flag("active"),
            place,
        }
    }

    fn primary(&mut self, fields: Fields<'_>) -> Name {
        let primary = fields.text("primary");
        if primary.value == "self" {
            self.later(
                "`primary = \"self\"`",
                &primary.place,
                "the surface on the other side",
            );
        } else if !primary.is_empty() && primary.value == fields.text("secondary").value {
            self.error(
                &codes::CONTRADICTION,
                format!(
                    "both sides of contact \"{}\" are \"{}\"",
                    fields.text("name").value,
                    primary.value
                ),
                &primary.place,
                "name the other side",
            );
        }
        primary
    }
}

fn enforcement(fields: Fields<'_>) -> Enforcement {
    let table = fields.table("enforcement");
    let is_table = fields
        .get("enforcement")
        .is_some_and(|value| value.get_ref().is_table());
    if !is_table {
        return Enforcement::Auto;
    }
    Enforcement::Penalty {
        penalty: table.number_if("penalty"),
        per: table.text_if("per").map(|word| {
            if word.value == "node" {
                Per::Node
            } else {
                Per::Area
            }
        }),
    }
}
