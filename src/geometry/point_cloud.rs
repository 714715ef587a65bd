//! Many points with their own read-only tree: what a depth camera or a laser scanner sees.
//!
//! A cloud with a radius is this, swept by a ball: the union of the balls around its points. The tree is implicit. Points are
//! stored in the order in which medians cut them, so a node is a run of points and its children are the two halves of the
//! run; boxes are kept for runs of more than [`FEW`] points and made from the points of shorter ones. A million points take
//! some 40 bytes each.

use super::shape::position;
use super::{Aabb, InvalidShape, Vec3};

/// Runs of so many points or fewer have no box of their own in memory.
const FEW: u32 = 8;

/// Points, metres, in the cloud's frame. At least one.
#[derive(Clone, Debug)]
pub struct PointCloud {
    /// In the order of the tree.
    points: Vec<Vec3>,
    /// The number, as given, of each point.
    numbers: Vec<u32>,
    /// The nodes of more than a few points, parents first.
    nodes: Vec<Node>,
    bounds: Aabb,
    /// Where the point that was given first is stored.
    first: u32,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Aabb,
    /// The node of the upper half, if that is of more than a few points; that of the lower half comes next.
    upper: u32,
}

/// A node of the tree: a run of points in the order of the tree.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    start: u32,
    end: u32,
    node: u32,
}

impl PointCloud {
    /// # Errors
    /// No points, more than 2^31, or one that is not finite or out of reach.
    pub fn new(points: &[Vec3]) -> Result<Self, InvalidShape> {
        if points.is_empty() {
            return Err(InvalidShape::Empty { field: "points" });
        }
        let count = u32::try_from(points.len()).ok().filter(|count| *count <= 1 << 31);
        let count = count.ok_or(InvalidShape::TooMany { field: "points", limit: 1 << 31 })?;
        for (i, p) in points.iter().enumerate() {
            position(|| format!("points[{i}]"), *p)?;
        }
        let mut ordered: Vec<(Vec3, u32)> = points.iter().copied().zip(0..count).collect();
        let mut nodes = Vec::new();
        build(&mut ordered, &mut nodes);
        let bounds = Aabb::around(points.iter().copied());
        let first = ordered.iter().zip(0..count).find(|((_, number), _)| *number == 0).map_or(0, |(_, place)| place);
        let (points, numbers) = ordered.into_iter().unzip();
        Ok(Self { points, numbers, nodes, bounds, first })
    }

    /// How many points there are.
    #[expect(clippy::len_without_is_empty, reason = "a cloud is never empty")]
    #[must_use]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// The points in the order they were given.
    #[must_use]
    pub fn as_given(&self) -> Vec<Vec3> {
        let mut given = vec![Vec3::zeros(); self.points.len()];
        self.points.iter().zip(&self.numbers).for_each(|(p, number)| given[*number as usize] = *p);
        given
    }

    /// The point that was given first, metres.
    #[must_use]
    pub fn first(&self) -> Vec3 {
        self.points[self.first as usize]
    }

    /// Bounds in the cloud's frame.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Bytes on the heap.
    #[must_use]
    pub fn memory(&self) -> usize {
        size_of_val(&*self.points) + size_of_val(&*self.numbers) + size_of_val(&*self.nodes)
    }

    /// All points.
    #[must_use]
    pub fn root(&self) -> Run {
        Run { start: 0, end: self.points.len() as u32, node: 0 }
    }

    /// The box of a run of points.
    #[must_use]
    pub fn bounds_of(&self, run: Run) -> Aabb {
        if run.len() > FEW {
            return self.nodes[run.node as usize].bounds;
        }
        Aabb::around(self.points[run.start as usize..run.end as usize].iter().copied())
    }

    /// The halves of a run; none of a single point.
    #[must_use]
    pub fn halves(&self, run: Run) -> Option<[Run; 2]> {
        if run.len() == 1 {
            return None;
        }
        let middle = run.start + run.len() / 2;
        let upper = if run.len() > FEW { self.nodes[run.node as usize].upper } else { 0 };
        Some([Run { end: middle, node: run.node + 1, ..run }, Run { start: middle, node: upper, ..run }])
    }

    /// The point at a place in the order of the tree, metres.
    #[must_use]
    pub fn at(&self, place: u32) -> Vec3 {
        self.points[place as usize]
    }

    /// The number, as given, of the point at a place in the order of the tree.
    #[must_use]
    pub fn number(&self, place: u32) -> u32 {
        self.numbers[place as usize]
    }

    /// Every length multiplied by `factor`.
    pub(super) fn scaled(&self, factor: f64) -> Result<Self, InvalidShape> {
        Self::new(&self.as_given().into_iter().map(|p| p * factor).collect::<Vec<_>>())
    }
}

impl Run {
    /// The place of its first point in the order of the tree.
    #[must_use]
    pub fn start(&self) -> u32 {
        self.start
    }

    fn len(&self) -> u32 {
        self.end - self.start
    }
}

/// Puts a run in the order of its tree and appends its nodes.
fn build(run: &mut [(Vec3, u32)], nodes: &mut Vec<Node>) {
    if run.len() <= FEW as usize {
        return;
    }
    let bounds = Aabb::around(run.iter().map(|(p, _)| *p));
    let axis = bounds.half_extents().imax();
    let middle = run.len() / 2;
    // Ties by number, so that the tree is the same whatever the selection does with equals.
    run.select_nth_unstable_by(middle, |(p, i), (q, j)| p[axis].total_cmp(&q[axis]).then(i.cmp(j)));
    let node = nodes.len();
    nodes.push(Node { bounds, upper: 0 });
    let (lower, upper) = run.split_at_mut(middle);
    build(lower, nodes);
    nodes[node].upper = nodes.len() as u32;
    build(upper, nodes);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_is_in_one_leaf_and_inside_every_box_above_it() {
        for count in [1, 2, 7, 8, 9, 16, 17, 100, 1003] {
            let coordinate = |i: u32, factor: u32| f64::from(i * factor % 101);
            let points: Vec<Vec3> =
                (0..count).map(|i| Vec3::new(coordinate(i, 37), coordinate(i, 59), coordinate(i, 7) * 0.1)).collect();
            let cloud = PointCloud::new(&points).unwrap();
            let mut seen = vec![0; points.len()];
            let mut open = vec![(cloud.root(), Vec::new())];
            while let Some((run, mut above)) = open.pop() {
                above.push(cloud.bounds_of(run));
                if let Some(halves) = cloud.halves(run) {
                    open.extend(halves.map(|half| (half, above.clone())));
                    continue;
                }
                let (p, number) = (cloud.at(run.start()), cloud.number(run.start()) as usize);
                seen[number] += 1;
                assert_eq!(p, points[number]);
                assert!(above.iter().all(|bounds| bounds.contains(&Aabb { min: p, max: p })));
                assert!(above.len() <= 12, "deeper than medians cut");
            }
            assert!(seen.iter().all(|&n| n == 1));
            assert_eq!((cloud.as_given(), cloud.first()), (points.clone(), points[0]));
        }
    }

    #[test]
    fn no_points_and_points_that_are_no_numbers_are_refused_by_name() {
        assert_eq!(PointCloud::new(&[]).unwrap_err(), InvalidShape::Empty { field: "points" });
        let error = PointCloud::new(&[Vec3::zeros(), Vec3::new(0.0, f64::NAN, 0.0)]).unwrap_err();
        assert_eq!(error.to_string(), "points[1] is not finite");
    }
}
