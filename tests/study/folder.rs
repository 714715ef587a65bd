//! The folder of one small study, made once for all tests, and its tables.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

/// Seconds of measuring: enough for each way to run once.
const BUDGET: &str = "4";

static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("study");
    if out.exists() {
        std::fs::remove_dir_all(&out).unwrap();
    }
    let doors = Path::new(env!("CARGO_TARGET_TMPDIR")).join("study-doors.jsonl");
    let line = |items: u32| {
        format!(
            r#"{{"what":"door","door":"grpc","items":{items},"through":{{"p50":{}e-6}},"within":{{"p50":{items}e-6}}}}"#,
            items + 40
        )
    };
    std::fs::write(&doors, format!("{{\"what\":\"begin\"}}\n{}\n{}\n", line(1), line(100))).unwrap();
    let made = Command::new(env!("CARGO_BIN_EXE_clearance"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["study", "--quick", "--budget", BUDGET, "--out"])
        .arg(&out)
        .arg("--doors")
        .arg(&doors)
        .output()
        .unwrap();
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let told = String::from_utf8(made.stdout).unwrap();
    assert_eq!(told.trim(), out.join("index.html").to_str().unwrap());
    out
});

pub fn folder() -> &'static Path {
    &FOLDER
}

/// Rows of a table, by name of the column.
pub type Row = BTreeMap<String, String>;

/// One line of CSV, quotes taken off.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut cell, mut quoted) = (Vec::new(), String::new(), false);
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(std::mem::take(&mut cell)),
            _ => cell.push(c),
        }
    }
    cells.push(cell);
    cells
}

pub fn table(name: &str) -> Vec<Row> {
    let text = std::fs::read_to_string(folder().join(format!("{name}.csv"))).unwrap();
    let mut lines = text.lines();
    let head = cells(lines.next().unwrap());
    let row = |line| {
        let cells = cells(line);
        assert_eq!(cells.len(), head.len(), "{line}");
        head.iter().cloned().zip(cells).collect()
    };
    let rows: Vec<Row> = lines.map(row).collect();
    assert!(!rows.is_empty(), "{name}");
    rows
}

pub fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} of {row:?}"))
}

/// None where the cell is empty: nothing was measured there.
pub fn maybe(row: &Row, column: &str) -> Option<f64> {
    if row[column].is_empty() { None } else { Some(number(row, column)) }
}

/// All values of a column, each once.
pub fn values<'a>(rows: &'a [Row], column: &str) -> std::collections::BTreeSet<&'a str> {
    rows.iter().map(|row| row[column].as_str()).collect()
}
