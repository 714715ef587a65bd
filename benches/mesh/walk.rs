//! A tree of any volumes, cut at medians, and walks over two of them: depth first, what looks nearer before what looks farther.

use clearance::geometry::{Aabb, Shape, Vec3};
use clearance::narrow_phase::{Depth, Goal, separation};

use crate::bodies::Pair;
use crate::volumes::{Relation, Volume};

/// What a walk cost.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    pub boxes: u64,
    pub triangles: u64,
}

struct Node<V> {
    volume: V,
    /// The left of two children that lie side by side; in a leaf the triangle.
    below: usize,
    is_leaf: bool,
}

pub struct Tree<V> {
    nodes: Vec<Node<V>>,
    triangles: Vec<[Vec3; 3]>,
}

impl<V: Volume> Tree<V> {
    pub fn new(triangles: &[[Vec3; 3]]) -> Self {
        let mut triangles = triangles.to_vec();
        let mut nodes = vec![Node { volume: V::around(&triangles), below: 0, is_leaf: true }];
        let mut open = vec![(0, 0, triangles.len())];
        while let Some((node, start, end)) = open.pop() {
            nodes[node].below = start;
            if end - start == 1 {
                continue;
            }
            let run = &mut triangles[start..end];
            let center = |t: &[Vec3; 3]| t[0] + t[1] + t[2];
            let axis = Aabb::around(run.iter().map(center)).half_extents().imax();
            let middle = run.len() / 2;
            run.select_nth_unstable_by(middle, |s, t| center(s)[axis].total_cmp(&center(t)[axis]));
            (nodes[node].below, nodes[node].is_leaf) = (nodes.len(), false);
            for (start, end) in [(start, start + middle), (start + middle, end)] {
                open.push((nodes.len(), start, end));
                nodes.push(Node { volume: V::around(&triangles[start..end]), below: 0, is_leaf: true });
            }
        }
        Self { nodes, triangles }
    }
}

/// The distance to a relative width of 1e-9.
pub fn distance<V: Volume>(a: &Tree<V>, b: &Tree<V>, pair: &Pair, context: &V::Context) -> Counts {
    let mut nearest = f64::INFINITY;
    let goal = Goal { depth: Depth::Distance, ..Goal::penetration() };
    walk(a, b, pair, context, f64::INFINITY, |s, t, normal| {
        let gap = |n: &Vec3| {
            let (low, high) = (t.map(|p| p.dot(n)), s.map(|p| p.dot(n)));
            low[0].min(low[1]).min(low[2]) - high[0].max(high[1]).max(high[2])
        };
        if normal.is_none_or(|n| gap(&n) < nearest) {
            let found = of_triangles(s, t, &goal);
            if found.bracket.upper < nearest {
                nearest = found.bracket.upper;
                return Found { beyond: beyond(nearest), normal: Some(found.normal), counts: 1 };
            }
            return Found { counts: 1, ..Found::nothing(nearest) };
        }
        Found::nothing(nearest)
    })
}

/// Whether they touch.
pub fn touch<V: Volume>(a: &Tree<V>, b: &Tree<V>, pair: &Pair, context: &V::Context) -> Counts {
    walk(a, b, pair, context, 0.0, |s, t, _| {
        let touches = of_triangles(s, t, &Goal::verdict()).bracket.upper <= 0.0;
        Found { beyond: if touches { f64::NEG_INFINITY } else { 0.0 }, normal: None, counts: 1 }
    })
}

fn of_triangles(s: &[Vec3; 3], t: &[Vec3; 3], goal: &Goal) -> clearance::narrow_phase::Separation {
    let shape = |[a, b, c]: &[Vec3; 3]| Shape::triangle(*a, *b, *c).expect("finite corners");
    let here = clearance::geometry::Pose::identity().placement();
    separation(&shape(s), &shape(t), &here, &here, goal).expect("bounded")
}

/// What came of two triangles.
struct Found {
    /// From here on pairs farther than this do not matter.
    beyond: f64,
    /// From A to B where they are nearest, if that is new.
    normal: Option<Vec3>,
    counts: u64,
}

impl Found {
    fn nothing(nearest: f64) -> Self {
        Self { beyond: beyond(nearest), normal: None, counts: 0 }
    }
}

/// Beyond what a pair does not matter any more; nothing matters after a contact.
fn beyond(nearest: f64) -> f64 {
    if nearest <= 0.0 { f64::NEG_INFINITY } else { nearest * (1.0 - 1e-9) }
}

fn walk<V: Volume>(
    a: &Tree<V>,
    b: &Tree<V>,
    pair: &Pair,
    context: &V::Context,
    threshold: f64,
    mut leaves: impl FnMut(&[Vec3; 3], &[Vec3; 3], Option<Vec3>) -> Found,
) -> Counts {
    let place = pair.b_in_a();
    let mut relation = Relation { place, normal: None, threshold };
    let mut counts = Counts::default();
    let mut open = Vec::with_capacity(128);
    open.push((f64::NEG_INFINITY, 0, 0));
    while let Some((lower, i, j)) = open.pop() {
        if lower > relation.threshold {
            continue;
        }
        let (x, y) = (&a.nodes[i], &b.nodes[j]);
        if x.is_leaf && y.is_leaf {
            let placed = b.triangles[y.below].map(|p| place.point(p));
            let found = leaves(&a.triangles[x.below], &placed, relation.normal.map(|(n, _)| n));
            counts.triangles += found.counts;
            relation.threshold = found.beyond;
            if let Some(n) = found.normal {
                relation.normal = Some((n, place.direction_into(n)));
            }
            continue;
        }
        let opens_a = y.is_leaf || (!x.is_leaf && x.volume.size() >= y.volume.size());
        let mut children = [0, 1].map(|k| {
            let (i, j) = if opens_a { (x.below + k, j) } else { (i, y.below + k) };
            counts.boxes += 1;
            (V::lower(&a.nodes[i].volume, &b.nodes[j].volume, &relation, context), i, j)
        });
        if children[0].0 < children[1].0 {
            children.swap(0, 1);
        }
        open.extend(children.into_iter().filter(|(lower, ..)| *lower <= relation.threshold));
    }
    counts
}
