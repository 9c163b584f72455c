//! Tables of comma-separated values as records of cells, after RFC 4180.

/// A line of a table, or several where quotes hold the ends of lines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Record {
    /// The line on which it starts, from 1.
    pub line: usize,
    /// Its cells, without quotes.
    pub cells: Vec<String>,
    /// Whether its last line ends: that of a file which is being written may be torn.
    pub is_ended: bool,
}

/// The records of a table; empty lines are passed over.
pub fn records(text: &str) -> impl Iterator<Item = Record> {
    let mut chars = text.chars().peekable();
    let mut line = 1;
    std::iter::from_fn(move || {
        loop {
            let mut record = Record {
                line,
                cells: vec![String::new()],
                is_ended: false,
            };
            let (mut quoted, mut any) = (false, false);
            loop {
                let Some(c) = chars.next() else {
                    return any.then_some(record);
                };
                line += usize::from(c == '\n');
                match c {
                    '"' if quoted && chars.peek() == Some(&'"') => {
                        chars.next();
                        push(&mut record.cells, '"');
                    }
                    '"' => quoted = !quoted,
                    ',' if !quoted => record.cells.push(String::new()),
                    '\r' if !quoted => {}
                    '\n' if !quoted => break,
                    c => push(&mut record.cells, c),
                }
                any = true;
            }
            if any {
                record.is_ended = true;
                return Some(record);
            }
        }
    })
}

fn push(cells: &mut [String], c: char) {
    if let Some(cell) = cells.last_mut() {
        cell.push(c);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_keeps_what_quotes_hold_and_says_whether_it_ends() {
        let all: Vec<Record> = records("a,\"b\n,\"\"c\"\"\"\n\n1,").collect();
        let record = |line: usize, cells: [&str; 2], is_ended: bool| Record {
            line,
            cells: cells.map(String::from).to_vec(),
            is_ended,
        };
        assert_eq!(
            all,
            [
                record(1, ["a", "b\n,\"c\""], true),
                record(4, ["1", ""], false)
            ]
        );
    }
}
