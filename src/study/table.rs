//! The numbers behind a drawing: one table, written as CSV.

use std::fmt::Write as _;

/// Rows of text under named columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// Of the file, without `.csv`.
    pub name: &'static str,
    /// Names, with units where there are any.
    pub columns: Vec<&'static str>,
    /// As many cells in each as there are columns.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// Without rows.
    #[must_use]
    pub fn new(name: &'static str, columns: &[&'static str]) -> Self {
        Self { name, columns: columns.to_vec(), rows: Vec::new() }
    }

    /// Adds a row.
    pub fn push(&mut self, row: Vec<String>) {
        debug_assert_eq!(row.len(), self.columns.len(), "{}", self.name);
        self.rows.push(row);
    }

    /// As RFC 4180 has it, with a line of names.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = String::new();
        let cell = |cell: &str| {
            if cell.contains([',', '"', '\n']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_owned() }
        };
        let names: Vec<String> = self.columns.iter().map(|name| cell(name)).collect();
        let _ = writeln!(text, "{}", names.join(","));
        for row in &self.rows {
            let cells: Vec<String> = row.iter().map(|value| cell(value)).collect();
            let _ = writeln!(text, "{}", cells.join(","));
        }
        text
    }
}

/// A number with as many digits as mean something; nothing for what is no number.
pub(super) fn number(value: f64) -> String {
    if !value.is_finite() {
        String::new()
    } else if value == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&value.abs()) {
        let digits = (5.0 - libm::log10(value.abs()).floor()).clamp(0.0, 9.0) as usize;
        let text = format!("{value:.digits$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    } else {
        format!("{value:.5e}")
    }
}

/// Nanoseconds of a time in seconds.
pub(super) fn nanoseconds(seconds: f64) -> String {
    number(seconds * 1e9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_with_commas_are_quoted_and_numbers_are_short() {
        let mut table = Table::new("t", &["a", "b"]);
        table.push(vec!["1, \"2\"".to_owned(), number(0.25)]);
        assert_eq!(table.csv(), "a,b\n\"1, \"\"2\"\"\",0.25\n");
        assert_eq!(
            [0.0, 1.0, 1234.5678, 1e-9, f64::NAN, 120.0].map(number),
            ["0", "1", "1234.57", "1.00000e-9", "", "120"]
        );
    }
}
