//! `history.csv` and `convergence.csv`: columns with the text of every cell as it is in the file.

use signorini_io::readers::csv::records;

/// A table, as read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// The names of the columns.
    pub columns: Vec<String>,
    /// The cells of every row; a row that is too short or torn is left out.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// Reads a table of comma-separated values. Rows that have not as many cells as the header, and a last line that does
    /// not end, are left out.
    #[must_use]
    pub fn read(text: &str) -> Self {
        let mut lines = records(text)
            .filter(|record| record.is_ended)
            .map(|record| record.cells);
        let columns = lines.next().unwrap_or_default();
        let rows = lines.filter(|row| row.len() == columns.len()).collect();
        Self { columns, rows }
    }

    /// The place of a column.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column == name)
    }

    /// The text of a cell; empty where there is none.
    #[must_use]
    pub fn text(&self, row: usize, column: usize) -> &str {
        let cells = self.rows.get(row);
        cells
            .and_then(|cells| cells.get(column))
            .map_or("", |cell| cell)
    }

    /// The number in a cell; NaN where there is none.
    #[must_use]
    pub fn number(&self, row: usize, column: usize) -> f64 {
        self.text(row, column).parse().unwrap_or(f64::NAN)
    }

    /// The numbers of a column; empty where there is no such column.
    #[must_use]
    pub fn numbers(&self, name: &str) -> Vec<f64> {
        let column = self.column(name);
        let all = column.map(|c| {
            (0..self.rows.len())
                .map(|row| self.number(row, c))
                .collect()
        });
        all.unwrap_or_default()
    }

    /// The texts of a column; empty where there is no such column.
    #[must_use]
    pub fn texts(&self, name: &str) -> Vec<&str> {
        let column = self.column(name);
        let all = column.map(|c| (0..self.rows.len()).map(|row| self.text(row, c)).collect());
        all.unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quoted_names_keep_their_commas_and_a_torn_row_is_left_out() {
        let table = Table::read("time,\"a,\"\"b\"\"\"\n1.0,2e-3\n2.0,3\n3.0,");
        assert_eq!(table.columns, ["time", "a,\"b\""]);
        assert_eq!(table.numbers("a,\"b\""), [2e-3, 3.0]);
        assert_eq!(table.text(0, 1), "2e-3");
        assert!(table.numbers("c").is_empty());
    }

    #[test]
    fn an_empty_file_is_an_empty_table() {
        assert_eq!(Table::read(""), Table::default());
    }
}
