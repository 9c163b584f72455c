//! What contacts take over from those of a model with other sides or other contacts.
//!
//! Rows are the same where their points have the same nodes, facets where they have. What is new knows nothing yet; what
//! follows from the sides as a whole, such as who leaves functions to whom, is made again where these differ.

use super::Interface;
use crate::system::{Archive, ContactNumbering};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::Carrier;
use std::collections::HashMap;

impl Interface {
    /// What its rows, facets and multipliers are.
    pub(super) fn numbered(&self) -> ContactNumbering {
        let parts = &self.parts;
        let mut count: HashMap<Vec<NodeId>, u32> = HashMap::new();
        let row = |row: usize| {
            let nodes = parts.discretization.point(row).nodes.to_vec();
            let number = count.entry(nodes.clone()).or_insert(0);
            *number += 1;
            (nodes, *number)
        };
        let rows = (0..parts.discretization.nrow()).map(row).collect();
        let facet = |facet: u32| match parts.pair.primary.carrier(facet) {
            Carrier::Nodes(nodes) => nodes.to_vec(),
            // where nodes carry nothing, numbers say all
            Carrier::Rigid(_) | Carrier::Fixed => vec![facet],
        };
        ContactNumbering {
            name: self.stored_name(),
            rows,
            facets: (0..parts.pair.primary.nfacet() as u32).map(facet).collect(),
            first_multiplier: parts.first_multiplier,
            nmultiplier: self.nmultiplier(),
        }
    }
}

/// Arrays of rows: numbers for each, and the place of the number of a facet among these. What rows stand for is not among them:
/// where a side has become larger, there is more around the nodes of its edge.
const OF_ROWS: [(&str, usize, Option<usize>); 4] = [
    ("pairs", super::history::PAIR, Some(0)),
    ("memory", super::history::MEMORY, Some(0)),
    ("judged", super::history::JUDGED, Some(1)),
    ("worn", 1, None),
];

/// Arrays of a contact as a whole.
const OF_ALL: [&str; 4] = ["state", "drift", "worn_opposite", "worn_volume"];

/// Puts what is stored of a model into what a model with other contacts stores, which has just been made.
pub fn inherit(
    from: (&[ContactNumbering], &Archive),
    (contacts, to): (&[ContactNumbering], &mut Archive),
) {
    let (before, from) = from;
    for (name, values) in &from.arrays {
        if !name.starts_with("contact.") && !name.ends_with(MULTIPLIERS) {
            to.arrays.insert(name.clone(), values.clone());
        }
    }
    let known = |one: &ContactNumbering| before.iter().find(|other| other.name == one.name);
    for (one, other) in contacts.iter().filter_map(|one| Some((one, known(one)?))) {
        one.take_over(other, from, to);
    }
    let n = to.length("state.u.multiplier").unwrap_or(0);
    for (name, values) in from
        .arrays
        .iter()
        .filter(|(name, _)| name.ends_with(MULTIPLIERS))
    {
        let mut all = vec![0.0; n];
        for (one, other) in contacts.iter().filter_map(|one| Some((one, known(one)?))) {
            let rows = one.rows_of(other);
            for (row, before) in rows
                .iter()
                .enumerate()
                .filter_map(|(r, b)| Some((r, (*b)?)))
            {
                let (own, of) = (one.multipliers(row), other.multipliers(before));
                if let (Some(own), Some(of)) = (all.get_mut(own), values.get(of))
                    && own.len() == of.len()
                {
                    own.copy_from_slice(of);
                }
            }
        }
        to.arrays.insert(name.clone(), all);
    }
}

/// What the names of arrays of multipliers end in.
const MULTIPLIERS: &str = ".multiplier";

impl ContactNumbering {
    /// The multipliers of a row.
    fn multipliers(&self, row: usize) -> std::ops::Range<usize> {
        let first = self.first_multiplier + row * self.nmultiplier;
        first..first + self.nmultiplier
    }

    /// Of each row, which it was before.
    fn rows_of(&self, before: &Self) -> Vec<Option<usize>> {
        let places: HashMap<_, usize> = before.rows.iter().zip(0..).collect();
        self.rows
            .iter()
            .map(|row| places.get(row).copied())
            .collect()
    }

    fn take_over(&self, before: &Self, from: &Archive, to: &mut Archive) {
        let name = |what: &str| format!("contact.{}.{what}", self.name);
        if self.rows == before.rows && self.facets == before.facets {
            let prefix = name("");
            let own = from
                .arrays
                .iter()
                .filter(|(name, _)| name.starts_with(&prefix));
            to.arrays
                .extend(own.map(|(name, values)| (name.clone(), values.clone())));
            return;
        }
        let rows = self.rows_of(before);
        let places: HashMap<&Vec<NodeId>, usize> = self.facets.iter().zip(0..).collect();
        let facet = |number: f64| {
            let nodes = before.facets.get(number as usize)?;
            places.get(nodes).map(|place| *place as f64)
        };
        for (what, n, at) in OF_ROWS {
            let (Some(old), Some(new)) =
                (from.arrays.get(&name(what)), to.arrays.get_mut(&name(what)))
            else {
                continue;
            };
            let known = new.chunks_exact_mut(n).zip(&rows);
            for (new, old) in
                known.filter_map(|(new, row)| Some((new, old.chunks_exact(n).nth((*row)?)?)))
            {
                let of_facet = at.and_then(|at| old.get(at)).copied().filter(|f| *f >= 0.0);
                let now = of_facet.map(facet);
                if now == Some(None) {
                    // what it met is none of the facets any more
                    continue;
                }
                new.copy_from_slice(old);
                if let (Some(at), Some(Some(now))) = (at, now)
                    && let Some(to) = new.get_mut(at)
                {
                    *to = now;
                }
            }
        }
        for what in OF_ALL {
            if let Some(values) = from.arrays.get(&name(what)) {
                to.arrays.insert(name(what), values.clone());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact(
        rows: &[NodeId],
        facets: &[[NodeId; 2]],
        first_multiplier: usize,
    ) -> ContactNumbering {
        ContactNumbering {
            name: "c".into(),
            rows: rows.iter().map(|node| (vec![*node], 1)).collect(),
            facets: facets.iter().map(|nodes| nodes.to_vec()).collect(),
            first_multiplier,
            nmultiplier: 2,
        }
    }

    #[test]
    fn rows_facets_and_multipliers_find_their_places() {
        let before = [contact(&[7, 8], &[[1, 2], [2, 3]], 0)];
        let now = contact(&[9, 8, 7], &[[0, 1], [2, 3], [1, 2]], 4);
        let (mut from, mut to) = (Archive::default(), Archive::default());
        from.put("contact.c.area", &[1.0, 2.0]);
        from.put("contact.c.judged", &[1.0, 0.0, 0.0, 2.0, 1.0, 5.0]);
        from.put("contact.c.choices", &[4.0]);
        from.put("state.u.multiplier", &[1.0, 2.0, 3.0, 4.0]);
        from.put("state.time", &[0.5]);
        to.put("contact.c.area", &[3.0, 5.0, 4.0]);
        to.put(
            "contact.c.judged",
            &[0.0, -1.0, 0.0, 0.0, -1.0, 0.0, 0.0, -1.0, 0.0],
        );
        to.put("contact.c.choices", &[]);
        to.put("state.u.multiplier", &[0.0; 10]);
        inherit((&before, &from), (&[now], &mut to));
        // what is around a node depends on the sides
        assert_eq!(to.arrays["contact.c.area"], [3.0, 5.0, 4.0]);
        let judged = [0.0, -1.0, 0.0, 2.0, 1.0, 5.0, 1.0, 2.0, 0.0];
        assert_eq!(to.arrays["contact.c.judged"], judged);
        assert_eq!(to.arrays["contact.c.choices"], [0.0; 0]);
        let multipliers = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0, 4.0, 1.0, 2.0];
        assert_eq!(to.arrays["state.u.multiplier"], multipliers);
        assert_eq!(to.arrays["state.time"], [0.5]);
        // the same sides take over all
        let mut same = to.clone();
        inherit((&before, &from), (&before, &mut same));
        assert_eq!(same.arrays["contact.c.choices"], [4.0]);
    }
}
