//! Which facets the pattern couples each row with.

/// The primary facets that the pattern couples each row with, row after row.
#[derive(Debug, Default)]
pub(super) struct Coupled {
    pub end: Vec<usize>,
    pub facets: Vec<u32>,
}

impl Coupled {
    pub fn row(&self, row: usize) -> &[u32] {
        let first = match row {
            0 => Some(&0),
            _ => self.end.get(row - 1),
        };
        match (first, self.end.get(row)) {
            (Some(&a), Some(&b)) => &self.facets[a..b],
            _ => &[],
        }
    }

    pub fn clear(&mut self) {
        self.end.clear();
        self.facets.clear();
    }

    pub fn end_row(&mut self) {
        self.end.push(self.facets.len());
    }

    /// The ends of rows, then the facets.
    pub fn to_numbers(&self) -> Vec<f64> {
        let ends = self.end.iter().map(|&e| e as f64);
        ends.chain(self.facets.iter().map(|&f| f64::from(f)))
            .collect()
    }

    /// Those of so many rows; `None` where they are not such numbers.
    pub fn from_numbers(numbers: &[f64], nrow: usize) -> Option<Self> {
        let (ends, facets) = numbers.split_at_checked(nrow.min(numbers.len()))?;
        let found = Self {
            end: ends.iter().map(|&e| e as usize).collect(),
            facets: facets.iter().map(|&f| f as u32).collect(),
        };
        let whole = found.end.last().is_none_or(|&e| e == found.facets.len());
        (found.end.is_sorted() && whole).then_some(found)
    }
}
