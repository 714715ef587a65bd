//! Does the operator's page list every cap and every exit code? The rows of caps are those of `Limits::table`, word for
//! word; exit codes are read from their source.

use clearance::limits::{Limit, Limits};

/// The rows that `page` lacks.
fn missing_rows(page: &str, limits: &[Limit]) -> Vec<String> {
    let row = |l: &Limit| format!("| `{}` | {} | {} | {} |", l.name, l.value, l.unit, l.what_happens);
    limits.iter().map(row).filter(|row| !page.lines().any(|line| line == row)).collect()
}

#[test]
fn the_operators_page_lists_every_limit_with_its_default() {
    let missing = missing_rows(include_str!("../../docs/operations.md"), &Limits::default().table());
    assert!(missing.is_empty(), "docs/operations.md lacks these rows:\n{}", missing.join("\n"));
}

#[test]
fn a_missing_limit_and_a_stale_default_are_found() {
    let limit = Limit { name: "max_items", unit: "items", value: 5, what_happens: "refused" };
    assert_eq!(missing_rows("| `max_items` | 5 | items | refused |", std::slice::from_ref(&limit)), [""; 0]);
    assert_eq!(missing_rows("| `max_items` | 6 | items | refused |", std::slice::from_ref(&limit)).len(), 1);
    assert_eq!(missing_rows("", &[limit]).len(), 1);
}

/// The numbers of `src/cli/exit_code.rs` that have no row in `page`.
fn missing_codes(page: &str, source: &str) -> Vec<String> {
    let code = |line: &str| line.trim().strip_suffix(',')?.split_once(" = ").map(|(_, number)| number.to_owned());
    let codes = source.lines().filter_map(code).filter(|number| number.parse::<u8>().is_ok());
    codes.filter(|code| !page.lines().any(|line| line.starts_with(&format!("| {code} |")))).collect()
}

#[test]
fn the_operators_page_lists_every_exit_code() {
    let source = include_str!("../../src/cli/exit_code.rs");
    assert_eq!(missing_codes(include_str!("../../docs/operations.md"), source), [""; 0]);
    assert!(missing_codes("", source).len() > 3, "the codes were not found in the source");
}
