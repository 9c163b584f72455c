//! Results of one run against those of another: by table, relative to the largest value of each.
//!
//! ```text
//! file ──tables──▶ Table, Table, …  ┐
//!                                   ├─compare──▶ Finding, Finding, …
//! file ──tables──▶ Table, Table, …  ┘  reference
//! ```
//!
//! A table is a quantity at one time: rows that start with identifiers (node, element, integration point), and values.
//! Two tables belong together that have the same name and time, in the order of their files; rows that have the same
//! identifiers; columns of the same name, or in the same place where they have none.
//!
//! | symbol | name in code | what |
//! |---|---|---|
//! | max abs (a − b) | `difference` | over all rows and columns of a table |
//! | max abs b | `norm` | likewise, `b` being the reference |
//!
//! A table agrees where `difference ≤ max(rel · norm, abs)` (E1) and no row and no column is in one file only. Two values
//! that are no numbers agree with each other and with nothing else. Rows of zeros and tables without rows that the
//! reference alone has say nothing: CalculiX prints zeros for every number of a set that no node has, and the headings
//! of loads that do not act. Rows of the points inside a face in contact become one: the sum of their energies, the mean
//! of everything else.
//!
//! One more kind of file: a function in `tables` and a line in [`KINDS`].

mod tables;
mod tree;

pub use tables::{CompareError, KINDS, tables};
pub use tree::{Pair, pairs};

use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Times that agree to this part are the same: tables print seven digits, data sets six.
const SAME_TIME: f64 = 2e-5;

/// A quantity at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// What it is of.
    pub name: String,
    /// The time, where there is one.
    pub time: Option<f64>,
    /// The identifiers that stand in front of every row.
    pub nid: usize,
    /// Identifiers, row by row.
    pub ids: Vec<i64>,
    /// Names of the columns of values.
    pub columns: Vec<String>,
    /// Values, row by row.
    pub values: Vec<f64>,
}

impl Table {
    fn nrow(&self) -> usize {
        let by_ids = self.ids.len().checked_div(self.nid);
        let by_values = self.values.len().checked_div(self.columns.len());
        by_ids.or(by_values).unwrap_or(0)
    }

    fn ids_of(&self, row: usize) -> &[i64] {
        self.ids
            .get(row * self.nid..(row + 1) * self.nid)
            .unwrap_or_default()
    }

    /// Whether a row holds nothing but zeros.
    fn is_zero(&self, row: usize) -> bool {
        (0..self.columns.len()).all(|column| self.value(row, column) == 0.0)
    }

    fn value(&self, row: usize, column: usize) -> f64 {
        let value = self.values.get(row * self.columns.len() + column);
        value.copied().unwrap_or(f64::NAN)
    }
}

/// How much may differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// In parts of the largest value of a table in the reference.
    pub rel: f64,
    /// In the unit of the values.
    pub abs: f64,
}

/// Where two tables differ most.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Worst {
    /// Identifiers of the row.
    pub ids: Vec<i64>,
    /// Name of the column.
    pub column: String,
    /// The value.
    pub found: f64,
    /// That of the reference.
    pub expected: f64,
}

/// What came out for two tables that belong together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// Rows that both have.
    pub nrow: usize,
    /// The largest difference.
    pub difference: f64,
    /// The largest absolute value in the reference.
    pub norm: f64,
    /// Where the largest difference is; nothing where there is none.
    pub worst: Option<Worst>,
    /// Rows and columns that only one of them has, in words.
    pub mismatch: Option<String>,
}

impl Comparison {
    /// The largest difference relative to the largest value of the reference.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        if self.difference == 0.0 {
            0.0
        } else {
            self.difference / self.norm
        }
    }

    /// Whether both agree (E1).
    #[must_use]
    pub fn agrees(&self, tolerance: Tolerance) -> bool {
        let allowed = (tolerance.rel * self.norm).max(tolerance.abs);
        self.mismatch.is_none() && self.difference <= allowed
    }
}

/// What became of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Both files have it.
    Both(Comparison),
    /// Only the file that is compared has it.
    Extra,
    /// Only the reference has it.
    Missing,
}

/// A table, and what became of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The name.
    pub name: String,
    /// The time.
    pub time: Option<f64>,
    /// What became of it.
    pub outcome: Outcome,
}

impl Finding {
    /// Whether both files have the table, and agree.
    #[must_use]
    pub fn agrees(&self, tolerance: Tolerance) -> bool {
        matches!(&self.outcome, Outcome::Both(one) if one.agrees(tolerance))
    }
}

/// Compares all tables with those of a reference; in the order of the reference, then what only the other file has.
#[must_use]
pub fn compare(found: &[Table], reference: &[Table]) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut partners: Vec<Option<usize>> = vec![None; reference.len()];
    let mut extra: Vec<usize> = Vec::new();
    let ours = by_name(found);
    let theirs = by_name(reference);
    for (name, places) in &ours {
        let wanted = theirs.get(name).map_or(&[][..], Vec::as_slice);
        extra.extend(match_times(
            (found, places),
            (reference, wanted),
            &mut partners,
        ));
    }
    for (wanted, partner) in reference.iter().zip(&partners) {
        let outcome = match partner.and_then(|place| found.get(place)) {
            Some(table) => Outcome::Both(compare_tables(table, wanted)),
            None if wanted.nrow() == 0 => continue,
            None => Outcome::Missing,
        };
        findings.push(Finding {
            name: wanted.name.clone(),
            time: wanted.time,
            outcome,
        });
    }
    extra.sort_unstable();
    findings.extend(
        extra
            .iter()
            .filter_map(|&place| found.get(place))
            .map(|table| Finding {
                name: table.name.clone(),
                time: table.time,
                outcome: Outcome::Extra,
            }),
    );
    findings
}

/// The places of tables by their names, whose case and blanks do not count.
fn by_name(tables: &[Table]) -> BTreeMap<String, Vec<usize>> {
    let mut places: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (place, table) in tables.iter().enumerate() {
        let words: Vec<&str> = table.name.split_whitespace().collect();
        places
            .entry(words.join(" ").to_lowercase())
            .or_default()
            .push(place);
    }
    places
}

/// Pairs tables of one name by their times, both in the order of their files; returns those without a partner.
fn match_times(
    (found, ours): (&[Table], &[usize]),
    (reference, theirs): (&[Table], &[usize]),
    partners: &mut [Option<usize>],
) -> Vec<usize> {
    let time = |tables: &[Table], place: usize| tables.get(place).and_then(|table| table.time);
    let mut theirs = theirs.iter().copied().peekable();
    let mut alone = Vec::new();
    for &place in ours {
        let now = time(found, place);
        // those of the reference that are earlier have no partner
        while theirs
            .next_if(|&other| order(time(reference, other), now) == Ordering::Less)
            .is_some()
        {}
        match theirs.next_if(|&other| order(time(reference, other), now) == Ordering::Equal) {
            Some(other) => {
                if let Some(partner) = partners.get_mut(other) {
                    *partner = Some(place);
                }
            }
            None => alone.push(place),
        }
    }
    alone
}

/// The order of two times; tables without one are all at the same.
fn order(one: Option<f64>, other: Option<f64>) -> Ordering {
    match (one, other) {
        (Some(one), Some(other))
            if (one - other).abs() > SAME_TIME * one.abs().max(other.abs()) =>
        {
            one.total_cmp(&other)
        }
        _ => Ordering::Equal,
    }
}

fn compare_tables(found: &Table, reference: &Table) -> Comparison {
    let (columns, odd_columns) = match_columns(found, reference);
    let (rows, odd_rows) = match_rows(found, reference);
    let mut result = Comparison {
        nrow: rows.len(),
        norm: norm(&reference.values),
        mismatch: odd_rows.or(odd_columns),
        ..Comparison::default()
    };
    let mut worst = None;
    for &(row, other) in &rows {
        for &(column, name) in &columns {
            let (a, b) = (found.value(row, column), reference.value(other, name));
            let difference = difference(a, b);
            if difference > result.difference {
                result.difference = difference;
                worst = Some((other, name, a, b));
            }
        }
    }
    result.worst = worst.map(|(row, column, found, expected)| Worst {
        ids: reference.ids_of(row).to_vec(),
        column: reference.columns.get(column).cloned().unwrap_or_default(),
        found,
        expected,
    });
    result
}

/// The largest finite absolute value.
fn norm(values: &[f64]) -> f64 {
    let sizes = values.iter().map(|v| v.abs()).filter(|v| v.is_finite());
    sizes.fold(0.0, f64::max)
}

fn difference(a: f64, b: f64) -> f64 {
    if a == b || (a.is_nan() && b.is_nan()) {
        return 0.0;
    }
    let difference = (a - b).abs();
    if difference.is_nan() {
        f64::INFINITY
    } else {
        difference
    }
}

/// Pairs of columns, and which of them only one table has.
fn match_columns(found: &Table, reference: &Table) -> (Vec<(usize, usize)>, Option<String>) {
    let place = |tables: &Table, name: &str| tables.columns.iter().position(|c| c == name);
    if found.columns == reference.columns
        || found
            .columns
            .iter()
            .all(|name| place(reference, name).is_none())
    {
        let n = found.columns.len().min(reference.columns.len());
        let odd = (found.columns.len() != reference.columns.len()).then(|| {
            let (a, b) = (found.columns.len(), reference.columns.len());
            format!("{a} columns for {b}")
        });
        return ((0..n).map(|k| (k, k)).collect(), odd);
    }
    let mut pairs = Vec::new();
    let mut odd: Vec<&str> = Vec::new();
    for (other, name) in reference.columns.iter().enumerate() {
        match place(found, name) {
            Some(column) => pairs.push((column, other)),
            None => odd.push(name),
        }
    }
    odd.extend(
        found
            .columns
            .iter()
            .filter(|name| place(reference, name).is_none())
            .map(String::as_str),
    );
    let odd = (!odd.is_empty()).then(|| format!("only in one: column {}", odd.join(", ")));
    (pairs, odd)
}

/// Pairs of rows, and what rows only one table has.
fn match_rows(found: &Table, reference: &Table) -> (Vec<(usize, usize)>, Option<String>) {
    let (ours, theirs) = (found.nrow(), reference.nrow());
    if found.nid != reference.nid && ours > 0 && theirs > 0 {
        let odd = format!("{} identifiers in a row for {}", found.nid, reference.nid);
        return (Vec::new(), Some(odd));
    }
    if found.ids == reference.ids && ours == theirs {
        return ((0..ours).map(|row| (row, row)).collect(), None);
    }
    let (one, other) = (sorted_rows(found), sorted_rows(reference));
    let mut pairs = Vec::new();
    let (mut extra, mut missing) = (Vec::new(), Vec::new());
    let (mut i, mut j) = (0, 0);
    while let (Some(&a), Some(&b)) = (one.get(i), other.get(j)) {
        match found.ids_of(a).cmp(reference.ids_of(b)) {
            Ordering::Equal => {
                pairs.push((a, b));
                (i, j) = (i + 1, j + 1);
            }
            Ordering::Less => {
                extra.push(a);
                i += 1;
            }
            Ordering::Greater => {
                missing.push(b);
                j += 1;
            }
        }
    }
    extra.extend(one.iter().skip(i));
    missing.extend(other.iter().skip(j));
    missing.retain(|&row| !reference.is_zero(row));
    pairs.sort_unstable_by_key(|&(_, row)| row);
    let tell = |table: &Table, rows: &[usize], whose: &str| {
        rows.iter().min().map(|&first| {
            let ids = table.ids_of(first);
            format!("{} rows only in {whose}, such as {ids:?}", rows.len())
        })
    };
    let odd: Vec<String> = [
        tell(reference, &missing, "the reference"),
        tell(found, &extra, "the file"),
    ]
    .into_iter()
    .flatten()
    .collect();
    (pairs, (!odd.is_empty()).then(|| odd.join("; ")))
}

/// The rows by their identifiers; equal ones in the order of the file.
fn sorted_rows(table: &Table) -> Vec<usize> {
    let mut rows: Vec<usize> = (0..table.nrow()).collect();
    rows.sort_by(|&a, &b| table.ids_of(a).cmp(table.ids_of(b)));
    rows
}

#[cfg(test)]
mod tests;
