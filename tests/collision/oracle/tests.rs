//! The oracles against one another, and against digits that other arithmetic wrote down.

use super::double_double::Dd;
use super::exhaustive::exact;
use super::truth;
use crate::hard_cases::hard_cases;
use crate::random_pairs::random_pair;
use crate::samples::Random;

/// Oracle: rational and 400-bit arithmetic of another program, 41 digits each.
#[test]
fn the_brackets_of_the_oracle_hold_the_digits_of_the_hard_cases() {
    let cases = hard_cases();
    let (mut narrow, mut open) = (0, Vec::new());
    for case in &cases {
        let found = truth(&case.a.body, &case.b.body, 0.0, 800);
        let doubt = Dd::from(case.gap + 1e-28 * case.truth.abs().hi + 1e-300);
        let holds = found.lower <= case.truth + doubt && case.truth - doubt <= found.upper;
        assert!(holds, "{}: {found:?}, digits {:?}", case.id, case.truth);
        if found.width() <= 1e-21 * found.size { narrow += 1 } else { open.push(&case.id) }
    }
    assert!(narrow > 1330, "only {narrow} of {} closed; open: {open:?}", cases.len());
}

/// Oracle: the finite search in big integers, which is exact. Pairs of at most 8 and 6 corners, every gap and scale.
#[test]
fn double_doubles_agree_with_big_integers_on_small_polytopes() {
    let mut random = Random::new(41);
    let (mut apart, mut touching, mut deep) = (0, 0, 0);
    while apart + touching + deep < 150 {
        let pair = random_pair(&mut random);
        let (a, b) = (&pair.a.body, &pair.b.body);
        let (Some(corners_a), Some(corners_b)) = (a.core.corners(), b.core.corners()) else { continue };
        if corners_a.len() * corners_b.len() > 48 {
            continue;
        }
        let exact = exact(a, b).expect("both are polytopes");
        let found = truth(a, b, 0.0, 400);
        let doubt = Dd::from(1e-29 * found.size);
        let holds = found.lower <= exact + doubt && exact - doubt <= found.upper;
        assert!(holds, "{exact:?} is not within {found:?}\n{a:?}\n{b:?}");
        assert!(found.width() <= 1e-22 * found.size, "{found:?}\n{a:?}\n{b:?}");
        match exact.hi / found.size {
            share if share > 1e-12 => apart += 1,
            share if share < -1e-12 => deep += 1,
            _ => touching += 1,
        }
    }
    assert!(apart > 20 && touching > 20 && deep > 20, "{apart} apart, {touching} touching, {deep} deep");
}

/// Oracle: digits from rational arithmetic, which the finite search must give to the last place it keeps.
#[test]
fn big_integers_agree_with_the_digits_of_the_hard_cases() {
    let mut checked = 0;
    for case in hard_cases().into_iter().filter(|case| case.exact) {
        let (a, b) = (&case.a.body, &case.b.body);
        let corners = |body: &super::Body| body.core.corners().map_or(0, |corners| corners.len());
        if corners(a) * corners(b) > 24 {
            continue;
        }
        let found = exact(a, b).expect("exact cases are polytopes");
        let off = (found - case.truth).abs();
        assert!(off <= Dd::from(1e-29 * (case.truth.abs().hi + case.size) + 1e-320), "{}: {found:?}", case.id);
        checked += 1;
    }
    assert!(checked > 150, "{checked} cases");
}
