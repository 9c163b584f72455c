//! A part of a table of results.

use csv::{ReaderBuilder, StringRecord};
use serde_json::{Value, json};
use std::collections::VecDeque;
use std::io::Read;

/// What is wanted of a table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// The columns, in this order; all of them where empty.
    pub columns: Vec<String>,
    /// The first row, from 0; none: the last rows.
    pub first: Option<usize>,
    /// Rows at most.
    pub rows: usize,
    /// Numbers at most.
    pub cells: usize,
}

/// A part of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The names of its columns.
    pub columns: Vec<String>,
    /// Its rows: numbers, texts, null for what is no number.
    pub rows: Vec<Vec<Value>>,
    /// The first of them in the table, from 0.
    pub first: usize,
    /// Rows of the whole table.
    pub total: usize,
}

/// Why there is no table.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// The file is not a table.
    #[error("the table cannot be read: {0}")]
    Damaged(#[from] csv::Error),
    /// A column that the table does not have.
    #[error("there is no column \"{name}\"; the columns are: {known}")]
    Unknown {
        /// The name.
        name: String,
        /// The names there are.
        known: String,
    },
}

impl Part {
    /// Reads what is wanted, holding no more than that in memory.
    ///
    /// # Errors
    /// A damaged file; unknown columns. A last row that is being written is left out.
    pub fn read(from: impl Read, wanted: &Wanted) -> Result<Self, TableError> {
        let mut reader = ReaderBuilder::new().flexible(true).from_reader(from);
        let header = reader.headers()?.clone();
        let chosen = chosen(&header, &wanted.columns)?;
        let most = wanted.rows.min(wanted.cells / chosen.len().max(1)).max(1);
        let mut rows: VecDeque<Vec<Value>> = VecDeque::new();
        let mut total = 0;
        for record in reader.records() {
            let record = record?;
            if record.len() < header.len() {
                break;
            }
            let is_wanted = wanted
                .first
                .is_none_or(|first| total >= first && rows.len() < most);
            total += 1;
            if is_wanted {
                let cells = chosen.iter().map(|column| value(record.get(*column)));
                rows.push_back(cells.collect());
            }
            if rows.len() > most {
                rows.pop_front();
            }
        }
        let first = wanted.first.unwrap_or(total - rows.len()).min(total);
        let names = chosen.iter().filter_map(|column| header.get(*column));
        Ok(Self {
            columns: names.map(str::to_owned).collect(),
            rows: rows.into(),
            first,
            total,
        })
    }

    /// Whether rows of the table are missing.
    pub fn is_cut(&self) -> bool {
        self.rows.len() < self.total
    }

    /// In words: which rows these are.
    pub fn remark(&self) -> String {
        let (n, total) = (self.rows.len(), self.total);
        match n {
            0 => format!("no rows of {total}"),
            _ if n == total => format!("all {total} rows"),
            _ => format!(
                "rows {} to {} of {total} (from 0); ask for others with first_row and rows",
                self.first,
                self.first + n - 1
            ),
        }
    }

    /// As an object.
    pub fn value(&self) -> Value {
        json!({
            "columns": self.columns,
            "rows": self.rows,
            "first_row": self.first,
            "total_rows": self.total,
            "truncated": self.is_cut(),
            "remark": self.remark(),
        })
    }

    /// As a text: lines of values, with commas between.
    pub fn text(&self) -> String {
        let mut text = self.columns.join(",");
        for row in &self.rows {
            text.push('\n');
            let cells = row.iter().map(|cell| match cell {
                Value::String(text) => text.clone(),
                other => other.to_string(),
            });
            text.push_str(&cells.collect::<Vec<_>>().join(","));
        }
        text
    }
}

/// The numbers of the columns that are wanted.
fn chosen(header: &StringRecord, wanted: &[String]) -> Result<Vec<usize>, TableError> {
    if wanted.is_empty() {
        return Ok((0..header.len()).collect());
    }
    let find = |name: &String| {
        let found = header.iter().position(|known| known == name);
        found.ok_or_else(|| TableError::Unknown {
            name: name.chars().take(100).collect(),
            known: header.iter().collect::<Vec<_>>().join(", "),
        })
    };
    wanted.iter().map(find).collect()
}

/// A number where it is one, else a text.
fn value(cell: Option<&str>) -> Value {
    let cell = cell.unwrap_or_default();
    match cell.parse::<f64>() {
        Ok(number) if number.is_finite() => cell
            .parse::<i64>()
            .map_or_else(|_| json!(number), |whole| json!(whole)),
        Ok(_) => Value::Null,
        Err(_) => Value::String(cell.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "time,step,\"a,b\"\n0.5,press,1\n1.0,press,NaN\n1.5,\"pull \"\"x\"\"\",-3e-2\n2,pull,4\n2.5,pu";

    fn wanted(columns: &[&str], first: Option<usize>, rows: usize) -> Wanted {
        Wanted {
            columns: columns.iter().map(|&name| name.to_owned()).collect(),
            first,
            rows,
            cells: 1000,
        }
    }

    #[test]
    fn the_last_rows_are_given_where_none_is_named() {
        let part = Part::read(TABLE.as_bytes(), &wanted(&[], None, 2)).unwrap();
        assert_eq!(part.columns, ["time", "step", "a,b"]);
        assert_eq!((part.first, part.total, part.is_cut()), (2, 4, true));
        assert_eq!(
            part.rows[0],
            [json!(1.5), json!("pull \"x\""), json!(-0.03)]
        );
        assert_eq!(
            part.remark(),
            "rows 2 to 3 of 4 (from 0); ask for others with first_row and rows"
        );
    }

    #[test]
    fn columns_and_rows_are_chosen() {
        let part = Part::read(TABLE.as_bytes(), &wanted(&["a,b", "time"], Some(1), 1)).unwrap();
        assert_eq!(part.rows, [[Value::Null, json!(1.0)]]);
        assert_eq!((part.first, part.total), (1, 4));
        let all = Part::read(TABLE.as_bytes(), &wanted(&["time"], None, 10)).unwrap();
        assert_eq!((all.rows.len(), all.is_cut()), (4, false));
        assert_eq!(all.text(), "time\n0.5\n1.0\n1.5\n2");
        let behind = Part::read(TABLE.as_bytes(), &wanted(&[], Some(9), 1)).unwrap();
        assert_eq!(
            (behind.rows.len(), behind.first, behind.is_cut()),
            (0, 4, true)
        );
    }

    #[test]
    fn a_wide_table_has_fewer_rows() {
        let few = Wanted {
            cells: 6,
            ..wanted(&[], None, 100)
        };
        assert_eq!(Part::read(TABLE.as_bytes(), &few).unwrap().rows.len(), 2);
    }

    #[test]
    fn an_unknown_column_is_refused_with_those_there_are() {
        let error = Part::read(TABLE.as_bytes(), &wanted(&["tim"], None, 1)).unwrap_err();
        assert!(error.to_string().contains("time, step, a,b"), "{error}");
    }

    #[test]
    fn an_empty_table_has_no_rows() {
        let part = Part::read("a,b\n".as_bytes(), &wanted(&[], None, 5)).unwrap();
        assert_eq!((part.total, part.is_cut(), part.first), (0, false, 0));
        assert!(Part::read("".as_bytes(), &wanted(&[], None, 5)).is_ok());
    }
}
