//! What holds whatever the shapes are. Oracle: a motion of both bodies together turns everything with it; a pair with its sides swapped is the
//! same pair.

use super::*;
use clearance::narrow_phase::DerivativeMethod;

#[test]
fn a_common_motion_turns_everything_with_it() {
    let mut random = Random(21);
    let mut seen = [[0; KINDS]; KINDS];
    let mut methods = [0; 2];
    for round in 0..20_000 {
        let (one, two) = (round % KINDS, (round / KINDS) % KINDS);
        if one == KINDS - 1 && two == KINDS - 1 {
            continue;
        }
        let (a, b) = (shape(&mut random, one), shape(&mut random, two));
        let gap = [0.3, 1e-2, -1e-2][random.below(3)];
        let Some([at_a, at_b]) = placed(&mut random, &a, &b, gap) else { continue };
        let (found, told) = measured(&a, &b, [&at_a, &at_b]);
        if !told.is_valid || told.conditioning < 1e-3 {
            continue;
        }
        let (v, w) = (random.vector(1.0), random.vector(1.0));
        let of = |at: &Placement| (v + w.cross(&at.translation), w);
        let moved = along(&told, [of(&at_a), of(&at_b)]);
        let turned = |x: Vec3| v + w.cross(&x);
        let [vx, vy, vz, ..] = told.signed_distance[1];
        let normal = Vec3::new(vx, vy, vz);
        let (n, p, q) = (w.cross(&normal), turned(found.point_on_a), turned(found.point_on_b));
        let expected = [0.0, n.x, n.y, n.z, p.x, p.y, p.z, q.x, q.y, q.z];
        // Smooth pairs are told at a normal that is nearer the truth than the separation's, with points of their own: `smooth` has them.
        let polished = (normal - found.normal).norm();
        assert!(
            polished < 1e-6 && (polished == 0.0 || told.method == DerivativeMethod::Exact),
            "{polished:e} {told:?}"
        );
        let allowed = 1e-10 + 10.0 * polished;
        let off = apart(&moved, &expected);
        assert!(off < allowed, "{off:e} {allowed:e} {one} {two} {found:?} {told:?}");
        seen[one][two] += 1;
        methods[usize::from(told.method == DerivativeMethod::Exact)] += 1;
    }
    for (one, row) in seen.iter().enumerate() {
        for (two, count) in row.iter().enumerate() {
            assert!(*count > 20 || (one == KINDS - 1 && two == KINDS - 1), "{one} {two}: {count}");
        }
    }
    assert!(methods.iter().all(|count| *count > 100), "{methods:?}");
}

#[test]
fn swapped_sides_have_swapped_derivatives() {
    let mut random = Random(22);
    let mut seen = 0;
    while seen < 3000 {
        let (one, two) = (random.below(KINDS), random.below(KINDS - 1));
        let (a, b) = (shape(&mut random, one), shape(&mut random, two));
        let Some([at_a, at_b]) = placed(&mut random, &a, &b, [0.3, 1e-2, -1e-2][seen % 3]) else { continue };
        let (found, told) = measured(&a, &b, [&at_a, &at_b]);
        // The other way round, of the same witness.
        let swapped = Separation {
            normal: -found.normal,
            point_on_a: found.point_on_b,
            point_on_b: found.point_on_a,
            subshape_a: found.subshape_b,
            subshape_b: found.subshape_a,
            ..found
        };
        let back = derivatives(&b, &a, &at_b, &at_a, &swapped, &DerivativeGoal::default(), &goal()).unwrap();
        assert_eq!((told.is_valid, told.on_border, told.method), (back.is_valid, back.on_border, back.method));
        if !told.is_valid || told.conditioning < 1e-3 {
            continue;
        }
        for body in 0..2 {
            for k in 0..6 {
                let (there, here) = (column(&back, 1 - body, k), column(&told, body, k));
                let [d, nx, ny, nz, p @ ..] = there;
                let turned = [d, -nx, -ny, -nz, p[3], p[4], p[5], p[0], p[1], p[2]];
                let off = apart(&turned, &here) * told.conditioning.min(1.0);
                assert!(off < 1e-11, "{off:e} {one} {two} {told:?} {back:?}");
            }
        }
        seen += 1;
    }
}
