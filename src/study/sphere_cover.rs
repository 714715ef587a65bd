//! Cells and balls that hold a body: what is left out is proved apart from it, so nothing of it is lost.

use crate::geometry::{Aabb, InvalidShape, Placement, PointCloud, Quaternion, Shape, Vec3, Voxels};
use crate::narrow_phase::{Goal, separation};

use super::families::placed;

/// A grid of cubes, those that the body may touch.
pub(super) struct Cover {
    /// Side of a cell, metres.
    pub side: f64,
    pub cells: Vec<[i32; 3]>,
}

/// Cells of a grid that are not proved apart from the body, found from coarse to fine.
pub(super) fn cover(body: &Shape, bounds: &Aabb, side: f64) -> Cover {
    let cell_of = |p: Vec3| <[f64; 3]>::from(p).map(|c| (c / side).floor() as i32);
    let (low, high) = (cell_of(bounds.min), cell_of(bounds.max));
    let span = 1 + (0..3).map(|k| high[k] - low[k]).fold(0, i32::max);
    let mut size = 1;
    while size < span {
        size *= 2;
    }
    let mut cells = Vec::new();
    let mut open = vec![(low, size)];
    while let Some((at, size)) = open.pop() {
        if !may_touch(body, at, size, side) {
            continue;
        }
        if size == 1 {
            cells.push(at);
            continue;
        }
        let half = size / 2;
        open.extend((0..8).map(|octant| {
            let step = |bit: i32| half * (octant >> bit & 1);
            ([at[0] + step(0), at[1] + step(1), at[2] + step(2)], half)
        }));
    }
    cells.sort_unstable();
    Cover { side, cells }
}

/// Whether a cube of so many cells is not proved apart from the body. It is looked at a billionth larger, so that its rounded
/// ends do not matter.
fn may_touch(body: &Shape, at: [i32; 3], size: i32, side: f64) -> bool {
    let half = 0.5 * side * f64::from(size);
    let center = Vec3::from(at.map(f64::from)) * side + Vec3::repeat(half);
    let (Ok(cube), Some(place)) =
        (Shape::cuboid(Vec3::repeat(half * (1.0 + 1e-9))), placed(center, Quaternion::IDENTITY))
    else {
        return true;
    };
    let found = separation(body, &cube, &Placement::identity(), &place, &Goal::verdict());
    found.map_or(true, |found| found.bracket.lower <= 0.0)
}

impl Cover {
    fn center(&self, cell: &[i32; 3]) -> Vec3 {
        Vec3::from_fn(|k, _| (f64::from(cell[k]) + 0.5) * self.side)
    }

    /// The cells as voxels.
    ///
    /// # Errors
    /// Cells beyond what a map holds.
    pub fn voxels(&self) -> Result<Voxels, InvalidShape> {
        Voxels::new(self.side)?.with_cells(&self.cells)
    }

    /// A ball around each cell, through its corners.
    ///
    /// # Errors
    /// No cells.
    pub fn balls(&self) -> Result<(PointCloud, f64), InvalidShape> {
        let centers: Vec<Vec3> = self.cells.iter().map(|cell| self.center(cell)).collect();
        Ok((PointCloud::new(&centers)?, 0.5 * self.side * 3.0_f64.sqrt() * (1.0 + 1e-9)))
    }

    /// How far a point of the cells may be from the body: at least and at most, metres. A cell reaches no farther from its middle than half
    /// its diagonal; its corners say how far some point is.
    pub fn inflation_of_cells(&self, body: &Shape) -> [f64; 2] {
        let reach = 0.5 * self.side * 3.0_f64.sqrt();
        let corner = |cell: &[i32; 3], i: usize| {
            Vec3::from_fn(|k, _| (f64::from(cell[k]) + f64::from((i >> k & 1) as u32)) * self.side)
        };
        self.greatest(body, reach, |cell| (0..8).map(|i| corner(cell, i)).collect())
    }

    /// The same of the balls; its lower end from the points of each ball along the axes and diagonals.
    pub fn inflation_of_balls(&self, body: &Shape, radius: f64) -> [f64; 2] {
        let steps = [-1.0, 0.0, 1.0];
        let directions: Vec<Vec3> = steps
            .into_iter()
            .flat_map(|x| steps.into_iter().flat_map(move |y| steps.into_iter().map(move |z| Vec3::new(x, y, z))))
            .filter(|v| v.norm() > 0.0)
            .map(|v| v.normalize() * radius)
            .collect();
        self.greatest(body, radius, |cell| directions.iter().map(|d| self.center(cell) + d).collect())
    }

    fn greatest(&self, body: &Shape, reach: f64, points: impl Fn(&[i32; 3]) -> Vec<Vec3>) -> [f64; 2] {
        let goal = Goal { depth: crate::narrow_phase::Depth::Distance, ..Goal::penetration() };
        let distance = |point: Vec3| {
            let at = placed(point, Quaternion::IDENTITY)?;
            separation(body, &Shape::point(), &Placement::identity(), &at, &goal).ok().map(|found| found.bracket)
        };
        let (mut least, mut most) = (0.0_f64, 0.0_f64);
        let mut open: Vec<(f64, &[i32; 3])> = self
            .cells
            .iter()
            .map(|cell| (distance(self.center(cell)).map_or(f64::INFINITY, |b| b.upper.max(0.0) + reach), cell))
            .collect();
        open.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
        if let Some((upper, _)) = open.first() {
            most = most.max(*upper);
        }
        // Those that may reach farthest say how far some point does.
        for (_, cell) in open.iter().take(64) {
            let farthest = points(cell).into_iter().filter_map(distance).map(|b| b.lower).fold(0.0, f64::max);
            least = least.max(farthest);
        }
        [least, most]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_and_balls_hold_a_ball_and_reach_no_farther_than_they_say() {
        let ball = Shape::sphere(1.0).unwrap();
        let cover = cover(&ball, &ball.bounds().unwrap(), 0.25);
        // By hand: a cell touches the ball when the point of it nearest to the centre is within 1. The grid begins with the cells of
        // the least corner, so that those which the ball touches from the other side, at -1, are not in it.
        let touches = |cell: &[i32; 3]| {
            let near = |c: i32| 0.25 * f64::from(if c >= 0 { c } else { -c - 1 });
            cell.iter().map(|c| near(*c) * near(*c)).sum::<f64>() <= 1.0
        };
        let range = -4..6;
        let all = range.clone().flat_map(|i| (-4..6).flat_map(move |j| (-4..6).map(move |k| [i, j, k])));
        let expected: Vec<[i32; 3]> = all.filter(touches).collect();
        assert_eq!(cover.cells.len(), expected.len());
        let [least, most] = cover.inflation_of_cells(&ball);
        // The farthest corner of any cell, less the radius.
        let corner = |c: i32| 0.25 * f64::from(if c >= 0 { c + 1 } else { -c });
        let farthest =
            expected.iter().map(|c| c.iter().map(|c| corner(*c) * corner(*c)).sum::<f64>().sqrt()).fold(0.0, f64::max);
        assert!(least <= farthest - 1.0 + 1e-9 && farthest - 1.0 <= most, "{least} {farthest} {most}");
        let (_, radius) = cover.balls().unwrap();
        let [least, most] = cover.inflation_of_balls(&ball, radius);
        assert!(least > 0.0 && least <= most && most <= 2.0 * 0.25 * 3.0_f64.sqrt(), "{least} {most}");
    }
}
