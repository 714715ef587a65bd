//! Pairs whose witness is a formula. Oracle: that formula's derivative, by hand; of capsules, central differences of it.

use super::*;

fn places(random: &mut Random) -> [Placement; 2] {
    [(); 2].map(|()| Pose::new(random.vector(2.0), random.rotation()).unwrap().placement())
}

fn each_twist(mut check: impl FnMut(usize, usize, Vec3, Vec3)) {
    for body in 0..2 {
        for k in 0..6 {
            let axis = Vec3::ith(k % 3, 1.0);
            let (v, w) = if k < 3 { (axis, Vec3::zeros()) } else { (Vec3::zeros(), axis) };
            check(body, k, v, w);
        }
    }
}

fn listed(distance: f64, n: Vec3, p: Vec3, q: Vec3) -> Quantities {
    [distance, n.x, n.y, n.z, p.x, p.y, p.z, q.x, q.y, q.z]
}

#[test]
fn two_spheres() {
    let mut random = Random(11);
    for _ in 0..1000 {
        let [r, s] = [(); 2].map(|()| random.within(0.1, 1.5));
        let at = places(&mut random);
        let (_, told) = measured(&Shape::sphere(r).unwrap(), &Shape::sphere(s).unwrap(), [&at[0], &at[1]]);
        let between = at[1].translation - at[0].translation;
        let (far, n) = (between.norm(), between.normalize());
        assert!(told.is_valid && (told.conditioning - far).abs() < 1e-12, "{told:?}");
        each_twist(|body, k, v, _| {
            let sign = if body == 0 { -1.0 } else { 1.0 };
            let dn = (v - n * n.dot(&v)) * (sign / far);
            let moved = |of: usize| if of == body { v } else { Vec3::zeros() };
            let expected = listed(sign * n.dot(&v), dn, moved(0) + dn * r, moved(1) - dn * s);
            assert!(apart(&column(&told, body, k), &expected) < 1e-12 * (1.0 + 1.0 / far));
        });
    }
}

#[test]
fn a_sphere_and_a_half_space_or_a_plane() {
    let mut random = Random(12);
    for round in 0..1000 {
        let (r, outward, offset) = (random.within(0.1, 1.5), random.vector(1.0).normalize(), random.within(-1.0, 1.0));
        let wall =
            if round % 2 == 0 { Shape::half_space(outward, offset) } else { Shape::plane(outward, offset) }.unwrap();
        let at = places(&mut random);
        let (found, told) = measured(&Shape::sphere(r).unwrap(), &wall, [&at[0], &at[1]]);
        assert!(told.is_valid && !told.on_border, "{told:?}");
        let n = found.normal;
        // The wall's points y have m . (y - t) = offset in the world, where -n = m turns with the wall.
        let to_center = at[0].translation - at[1].translation;
        each_twist(|body, k, v, w| {
            let (of_ball, of_wall) = if body == 0 {
                ((v, w), (Vec3::zeros(), Vec3::zeros()))
            } else {
                ((Vec3::zeros(), Vec3::zeros()), (v, w))
            };
            let dn = of_wall.1.cross(&n);
            let d_distance = -(dn.dot(&to_center) + n.dot(&(of_ball.0 - of_wall.0)));
            let d_on_ball = of_ball.0 + dn * r;
            let d_on_wall = d_on_ball + n * d_distance + dn * found.signed_distance;
            let expected = listed(d_distance, dn, d_on_ball, d_on_wall);
            let off = apart(&column(&told, body, k), &expected);
            assert!(off < 1e-12, "{off:e} {found:?} {told:?}");
        });
    }
}

/// Nearest points of two lines, each from its middle along a direction.
fn lines(middles: [Vec3; 2], along: [Vec3; 2], radii: [f64; 2]) -> Quantities {
    let [u, v] = along;
    let (uu, uv, vv) = (u.dot(&u), u.dot(&v), v.dot(&v));
    let between = middles[1] - middles[0];
    let determinant = uv * uv - uu * vv;
    let (s, t) = (
        (v.dot(&between) * uv - u.dot(&between) * vv) / determinant,
        (v.dot(&between) * uu - u.dot(&between) * uv) / determinant,
    );
    let (p, q) = (middles[0] + u * s, middles[1] + v * t);
    let n = (q - p).normalize();
    listed((q - p).norm() - radii[0] - radii[1], n, p + n * radii[0], q - n * radii[1])
}

#[test]
fn two_capsules_side_by_side() {
    let mut random = Random(13);
    let (mut seen, mut inside) = (0, 0);
    while seen < 1000 {
        let radii = [(); 2].map(|()| random.within(0.1, 0.5));
        let at = places(&mut random);
        let shapes = radii.map(|r| Shape::capsule(r, 4.0).unwrap());
        let (found, told) = measured(&shapes[0], &shapes[1], [&at[0], &at[1]]);
        let formula = |at: [&Placement; 2]| {
            lines(at.map(|at| at.translation), at.map(|at| at.rotation.column(2).into_owned()), radii)
        };
        let here = formula([&at[0], &at[1]]);
        // Both between their ends; not nearly parallel, and the lines not nearly crossing.
        let gap = found.signed_distance + radii[0] + radii[1];
        let crossing = at[0].rotation.column(2).cross(&at[1].rotation.column(2)).norm();
        if apart(&of_separation(&found), &here) > 1e-9 || crossing < 0.2 || gap < 0.1 {
            continue;
        }
        assert!(told.is_valid && !told.on_border, "{told:?}");
        let h = 1e-5;
        each_twist(|body, k, v, w| {
            let moved = |sign: f64| {
                let there = twisted(&at[body], v * (h * sign), w * (h * sign));
                formula(if body == 0 { [&there, &at[1]] } else { [&at[0], &there] })
            };
            let (after, before) = (moved(1.0), moved(-1.0));
            let expected = std::array::from_fn(|row| (after[row] - before[row]) / (2.0 * h));
            let off = apart(&column(&told, body, k), &expected);
            assert!(off < 1e-7, "{off:e} {body} {k} {found:?} {told:?}");
        });
        seen += 1;
        inside += usize::from(found.signed_distance < 0.0);
    }
    assert!(inside > 20, "{inside}");
}
