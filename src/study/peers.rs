//! What do other libraries take for the same kind of pairs? As `benches/peers/compare --save` wrote it.

use std::path::Path;

use super::study::{NoStudy, read};

/// A row of that file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PeerRow {
    /// What was asked: for example `hull250 distance near`.
    pub row: String,
    /// Whose figure it is.
    pub contender: String,
    /// How it was set up.
    pub config: String,
    /// Seconds.
    pub median: f64,
    pub p99: f64,
    /// Metres.
    pub error_p99: f64,
}

/// All rows.
///
/// # Errors
/// A file that cannot be read, or that lacks a column.
pub(super) fn rows(path: &Path) -> Result<Vec<PeerRow>, NoStudy> {
    let text = read(path)?;
    parsed(&text).map_err(|what| NoStudy::Content { path: path.to_owned(), what })
}

fn parsed(text: &str) -> Result<Vec<PeerRow>, String> {
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let column =
        |name: &str| head.iter().position(|cell| *cell == name).ok_or_else(|| format!("there is no column {name}"));
    let [row, contender, config, median, p99, error] = [
        column("row")?,
        column("contender")?,
        column("config")?,
        column("median_ns")?,
        column("p99_ns")?,
        column("error_p99")?,
    ];
    let mut rows = Vec::new();
    for line in lines.filter(|line| !line.is_empty()) {
        let cells: Vec<&str> = line.split(',').collect();
        let cell = |index: usize| cells.get(index).copied().unwrap_or_default();
        let number = |index: usize| cell(index).parse::<f64>().map_err(|_| format!("no number in: {line}"));
        rows.push(PeerRow {
            row: cell(row).to_owned(),
            contender: cell(contender).to_owned(),
            config: cell(config).to_owned(),
            median: number(median)? * 1e-9,
            p99: number(p99)? * 1e-9,
            error_p99: cell(error).parse().unwrap_or(f64::NAN),
        });
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_found_by_name_and_broken_lines_refused() {
        let text = "contender,row,median_ns,p99_ns,config,error_p99\nCoal,hull8 distance near,100,200,gjk/1e-06,1e-9\n";
        let rows = parsed(text).unwrap();
        assert_eq!((rows[0].contender.as_str(), rows[0].error_p99), ("Coal", 1e-9));
        assert!((rows[0].median - 1e-7).abs() < 1e-20);
        assert!(parsed("row,contender\n").is_err());
        assert!(parsed(&text.replace("100", "fast")).is_err());
    }
}
