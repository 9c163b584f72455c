//! Linear equations between unknowns, solved for those that may depend on others: Gauss and Jordan's elimination of
//! sparse rows.

use crate::system::{Dof, Relation, Turn};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// What an equation speaks of once the displacements of followers have been split.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Column {
    /// A raw dof that follows no carrier.
    Dof(Dof),
    /// What a turning carrier adds.
    Turn(Turn),
}

/// `Σ coefficient · column = 0`; a right-hand side is a column of its own.
#[derive(Clone, Debug, Default)]
pub(super) struct Row {
    /// Number of the constraint it comes from.
    pub owner: usize,
    pub terms: BTreeMap<Column, f64>,
}

/// Equations solved for dependent dofs, and those in which nothing may depend.
#[derive(Debug, Default)]
pub(super) struct Reduced {
    pub solved: Vec<(Dof, Row)>,
    pub left: Vec<Row>,
}

/// Part of the largest coefficient below which one counts as cancelled.
const CANCELLED: f64 = 1e-11;
/// Part of the largest coefficient that a pivot must have.
const PIVOT: f64 = 0.1;

impl Row {
    pub fn add(&mut self, column: Column, coefficient: f64) {
        *self.terms.entry(column).or_insert(0.0) += coefficient;
    }

    fn largest(&self) -> f64 {
        self.terms.values().fold(0.0, |m, c| c.abs().max(m))
    }

    fn scale(&mut self, by: f64) {
        self.terms.values_mut().for_each(|c| *c *= by);
    }

    /// Adds a multiple of another row; terms that cancel are gone.
    fn combine(&mut self, other: &Self, by: f64) {
        for (column, c) in &other.terms {
            let change = by * c;
            let term = self.terms.entry(*column).or_insert(0.0);
            let size = term.abs().max(change.abs());
            *term += change;
            if term.abs() <= CANCELLED * size {
                self.terms.remove(column);
            }
        }
    }

    /// The row as a relation for its dependent dof, whose coefficient is 1.
    pub fn relation(&self, dof: Dof) -> Relation {
        let mut relation = Relation {
            dof,
            terms: Vec::new(),
            turns: Vec::new(),
        };
        for (column, c) in &self.terms {
            match *column {
                Column::Dof(d) if d == dof => {}
                Column::Dof(d) => relation.terms.push((d, -c)),
                Column::Turn(turn) => relation.turns.push((turn, -c)),
            }
        }
        relation
    }
}

/// Solves rows for dofs with a rank, those of lower rank first where coefficients allow. What is solved for occurs in
/// no other row afterwards.
pub(super) fn reduce(rows: Vec<Row>, rank: impl Fn(Dof) -> Option<u8>) -> Reduced {
    // dofs that occur seldom are better pivots: their elimination fills least
    let mut count: HashMap<Dof, usize> = HashMap::new();
    for row in &rows {
        for column in row.terms.keys() {
            if let Column::Dof(dof) = column {
                *count.entry(*dof).or_insert(0) += 1;
            }
        }
    }
    let mut solved: Vec<(Dof, Row)> = Vec::new();
    let mut place: HashMap<Dof, usize> = HashMap::new();
    // the solved rows in which a column occurs
    let mut uses: HashMap<Column, BTreeSet<usize>> = HashMap::new();
    let mut left = Vec::new();
    for mut row in rows {
        row.terms.retain(|_, c| *c != 0.0);
        let known: Vec<(usize, f64)> = row
            .terms
            .iter()
            .filter_map(|(column, c)| match column {
                Column::Dof(dof) => place.get(dof).map(|&k| (k, *c)),
                Column::Turn(_) => None,
            })
            .collect();
        for (k, c) in known {
            row.combine(&solved[k].1, -c);
        }
        let pivot = pivot(&row, &rank, &count);
        let Some((dof, coefficient)) = pivot else {
            left.push(row);
            continue;
        };
        row.scale(coefficient.recip());
        let number = solved.len();
        for k in uses.remove(&Column::Dof(dof)).unwrap_or_default() {
            let other = &mut solved[k].1;
            let Some(c) = other.terms.get(&Column::Dof(dof)).copied() else {
                continue;
            };
            other.combine(&row, -c);
            other.terms.remove(&Column::Dof(dof));
            for column in row.terms.keys() {
                if other.terms.contains_key(column) {
                    uses.entry(*column).or_default().insert(k);
                }
            }
        }
        for column in row.terms.keys().filter(|c| **c != Column::Dof(dof)) {
            uses.entry(*column).or_default().insert(number);
        }
        place.insert(dof, number);
        solved.push((dof, row));
    }
    Reduced { solved, left }
}

/// What a row is solved for.
fn pivot(
    row: &Row,
    rank: impl Fn(Dof) -> Option<u8>,
    count: &HashMap<Dof, usize>,
) -> Option<(Dof, f64)> {
    let least = PIVOT * row.largest();
    let candidates = row.terms.iter().filter_map(|(column, c)| match column {
        Column::Dof(dof) => rank(*dof).map(|rank| (*dof, *c, rank)),
        Column::Turn(_) => None,
    });
    let key = |&(dof, c, rank): &(Dof, f64, u8)| {
        let often = count.get(&dof).copied().unwrap_or(0);
        (c.abs() < least, rank, often, dof)
    };
    let chosen = candidates.min_by_key(key);
    chosen.map(|(dof, c, _)| (dof, c))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(owner: usize, terms: &[(Dof, f64)]) -> Row {
        let mut row = Row {
            owner,
            ..Row::default()
        };
        for &(dof, c) in terms {
            row.add(Column::Dof(dof), c);
        }
        row
    }

    #[test]
    fn solved_rows_hold_for_whatever_is_free() {
        // a chain, a loop that closes it, and one more
        let rows = vec![
            row(0, &[(1, 1.0), (2, -1.0)]),
            row(1, &[(2, 2.0), (3, -2.0), (9, 0.5)]),
            row(2, &[(3, 1.0), (4, 3.0)]),
            row(3, &[(1, 1.0), (4, 3.0), (9, 0.25)]),
            row(4, &[(5, 1e-6), (6, 1.0), (1, 1.0)]),
        ];
        let rank = |dof: Dof| (dof != 9 && dof != 4).then_some(0);
        let reduced = reduce(rows.clone(), rank);
        assert_eq!(reduced.solved.len(), 4);
        assert_eq!(reduced.left.len(), 1);
        assert!(reduced.left[0].terms.is_empty(), "{:?}", reduced.left);
        let mut u = [0.0; 10];
        (u[4], u[5], u[6], u[9]) = (0.3, -0.7, 1.1, 0.9);
        let relations: Vec<Relation> = reduced.solved.iter().map(|(d, r)| r.relation(*d)).collect();
        for relation in &relations {
            for (d, _) in &relation.terms {
                assert!(relations.iter().all(|r| r.dof != *d), "chains are resolved");
            }
            let value = relation.terms.iter().map(|&(d, c)| c * u[d as usize]);
            u[relation.dof as usize] = value.sum();
        }
        for row in &rows {
            let sum: f64 = row
                .terms
                .iter()
                .map(|(c, v)| match c {
                    Column::Dof(d) => v * u[*d as usize],
                    Column::Turn(_) => 0.0,
                })
                .sum();
            assert!(sum.abs() < 1e-14, "{row:?} {sum}");
        }
        // a tiny coefficient is no pivot
        assert!(relations.iter().all(|r| r.dof != 5));
    }

    #[test]
    fn rows_without_anything_that_may_depend_are_left() {
        let rows = vec![
            row(7, &[(1, 1.0), (2, 1.0)]),
            row(8, &[(1, 1.0), (2, -1.0)]),
        ];
        let reduced = reduce(rows, |dof| (dof == 1).then_some(0));
        assert_eq!(reduced.solved[0].0, 1);
        assert_eq!(reduced.left[0].owner, 8);
        assert_eq!(reduced.left[0].terms.len(), 1);
    }
}
