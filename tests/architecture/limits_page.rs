//! Does the operator's page list every cap? Its rows are those of `Limits::table`, word for word.

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
