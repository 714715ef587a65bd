//! Occupied cells of a regular grid: a map that grows and is cleared while others still ask older ones.
//!
//! Cell `(i, j, k)` is the closed box from `(i, j, k) * resolution` to `(i + 1, j + 1, k + 1) * resolution`, each product rounded to a
//! double: neighbours share their faces exactly. A point belongs to the one cell with `i * resolution <= x < (i + 1) * resolution`, and
//! so for y and z. A map without cells is a shape that nothing touches.

use std::sync::Arc;

use super::octree::{self, Brick, GridCell, Inner, Node, REACH, Region, place};
use super::shape::{length, position};
use super::tolerance::LARGEST_LENGTH;
use super::{Aabb, InvalidShape, Vec3};

/// Cells at most: they are numbered.
const MOST_CELLS: u64 = 1 << 31;

/// A set of cells. Cloning one is cheap; edits make a new one that shares what they leave as it is.
#[derive(Clone, Debug)]
pub struct Voxels {
    resolution: f64,
    root: Option<Arc<Node>>,
}

/// A node of the tree, or some of its children or bits.
#[derive(Clone, Copy, Debug)]
pub struct Cells<'a> {
    part: CellsPart<'a>,
    /// How many cells come before these.
    rank: u32,
}

#[derive(Clone, Copy, Debug)]
enum CellsPart<'a> {
    /// The octants whose bits are set, at least two.
    Octants(&'a Inner, u8),
    Brick(Brick),
}

impl Voxels {
    /// A map without cells.
    ///
    /// # Errors
    /// A resolution (side of a cell, metres) that is not positive, or so large that cells would be out of reach.
    pub fn new(resolution: f64) -> Result<Self, InvalidShape> {
        length("resolution", resolution)?;
        if resolution == 0.0 {
            return Err(InvalidShape::NotPositive { field: "resolution", value: resolution });
        }
        let limit = LARGEST_LENGTH / f64::from(REACH);
        if resolution > limit {
            return Err(InvalidShape::TooLarge { field: "resolution".to_owned(), value: resolution, limit });
        }
        Ok(Self { resolution, root: None })
    }

    /// The map with the cells of these points too, metres, in its frame.
    ///
    /// # Errors
    /// A point that is not finite or in no cell: cells reach from `-2^22` to `2^22` along each axis. More than `2^31` cells.
    pub fn with_points(&self, points: &[Vec3]) -> Result<Self, InvalidShape> {
        let mut places = Vec::with_capacity(points.len());
        for (i, p) in points.iter().enumerate() {
            position(|| format!("points[{i}]"), *p)?;
            let limit = f64::from(REACH) * self.resolution;
            let too_far = || InvalidShape::TooLarge { field: format!("points[{i}]"), value: p.amax(), limit };
            places.push(place(self.cell_of(*p).ok_or_else(too_far)?));
        }
        self.with(places)
    }

    /// The map with these cells too, given by their coordinates.
    ///
    /// # Errors
    /// A coordinate outside of `-2^22 .. 2^22`; more than `2^31` cells.
    pub fn with_cells(&self, cells: &[[i32; 3]]) -> Result<Self, InvalidShape> {
        let reach = -REACH..REACH;
        for (i, cell) in cells.iter().enumerate() {
            if let Some(far) = cell.iter().find(|c| !reach.contains(c)) {
                let (value, limit) = (f64::from(*far) * self.resolution, f64::from(REACH) * self.resolution);
                return Err(InvalidShape::TooLarge { field: format!("cells[{i}]"), value, limit });
            }
        }
        self.with(cells.iter().map(|cell| place(*cell)).collect())
    }

    fn with(&self, mut places: Vec<Brick>) -> Result<Self, InvalidShape> {
        places.sort_unstable_by_key(|place| place.code);
        let of_bricks = places.chunk_by(|one, other| one.code == other.code);
        let bits = |of_brick: &[Brick]| of_brick.iter().fold(0, |bits, place| bits | place.bits);
        let bricks: Vec<Brick> = of_bricks.map(|same| Brick { code: same[0].code, bits: bits(same) }).collect();
        if bricks.is_empty() {
            return Ok(self.clone());
        }
        let new = octree::build(&bricks);
        let root = self.root.as_ref().map_or_else(|| Arc::clone(&new), |root| octree::union(root, &new));
        if root.cells() > MOST_CELLS {
            return Err(InvalidShape::TooMany { field: "cells", limit: MOST_CELLS });
        }
        Ok(Self { root: Some(root), ..*self })
    }

    /// The map without the cells that points of the closed box belong to: what was inserted from points of the box is gone, and
    /// with it whatever else was in the same cells.
    ///
    /// # Errors
    /// A corner that is not finite, or a least corner above the greatest.
    pub fn without_box(&self, bounds: &Aabb) -> Result<Self, InvalidShape> {
        position(|| "min".to_owned(), bounds.min)?;
        position(|| "max".to_owned(), bounds.max)?;
        if let Some(axis) = (0..3).find(|&axis| bounds.min[axis] > bounds.max[axis]) {
            return Err(InvalidShape::UpsideDown { axis: ["x", "y", "z"][axis] });
        }
        // Ends out of reach are as good as the last cells.
        let index = |x: f64| self.index_of(x).unwrap_or(if x < 0.0 { -REACH - 1 } else { REACH });
        let low = std::array::from_fn(|axis| index(bounds.min[axis]));
        let high = std::array::from_fn(|axis| index(bounds.max[axis]) + 1);
        let root = self.root.as_ref().and_then(|root| octree::without(root, &Region { low, high }));
        Ok(Self { root, ..*self })
    }

    /// The cell that a point belongs to; none out of reach.
    #[must_use]
    pub fn cell_of(&self, point: Vec3) -> Option<[i32; 3]> {
        Some([self.index_of(point.x)?, self.index_of(point.y)?, self.index_of(point.z)?])
    }

    fn index_of(&self, x: f64) -> Option<i32> {
        let guess = (x / self.resolution).floor();
        if !(guess.abs() <= f64::from(REACH) + 1.0) {
            return None;
        }
        // The quotient rounds, so the right cell may be the next one.
        let mut index = guess as i32;
        if self.edge(index) > x {
            index -= 1;
        } else if self.edge(index + 1) <= x {
            index += 1;
        }
        (-REACH..REACH).contains(&index).then_some(index)
    }

    /// Where a cell begins, along an axis.
    fn edge(&self, index: i32) -> f64 {
        f64::from(index) * self.resolution
    }

    /// Side of a cell, metres.
    #[must_use]
    pub fn resolution(&self) -> f64 {
        self.resolution
    }

    /// How many cells are occupied.
    #[must_use]
    pub fn len(&self) -> usize {
        self.root.as_ref().map_or(0, |root| root.cells() as usize)
    }

    /// Whether none is.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.root.is_none()
    }

    /// Whether a cell is occupied.
    #[must_use]
    pub fn has(&self, cell: [i32; 3]) -> bool {
        let in_reach = cell.iter().all(|c| (-REACH..REACH).contains(c));
        in_reach && self.root.as_ref().is_some_and(|root| root.has(&place(cell)))
    }

    /// The occupied cells in the order of their numbers: bricks of 4 x 4 x 4 in the order of their Morton codes, in a brick by z, then y, then x.
    #[must_use]
    pub fn cells(&self) -> Vec<[i32; 3]> {
        let mut cells = Vec::with_capacity(self.len());
        if let Some(root) = &self.root {
            root.for_each(&mut |brick| {
                cells.extend((0..64).filter(|bit| brick.bits >> bit & 1 == 1).map(|bit| brick.cell(bit)));
            });
        }
        cells
    }

    /// The box of a cell, metres, in the map's frame.
    #[must_use]
    pub fn box_of(&self, cell: [i32; 3]) -> Aabb {
        self.around(&Region { low: cell, high: cell.map(|c| c + 1) })
    }

    /// Bounds in the map's frame; none without cells.
    #[must_use]
    pub fn bounds(&self) -> Option<Aabb> {
        self.root.as_ref().map(|root| self.around(&root.region()))
    }

    /// Bytes on the heap, those shared with other maps included.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.root.as_ref().map_or(0, |root| root.memory())
    }

    /// All cells; none without cells.
    #[must_use]
    pub fn root(&self) -> Option<Cells<'_>> {
        self.root.as_ref().map(|root| Cells::of(root, 0))
    }

    /// A box around some cells.
    #[must_use]
    pub fn bounds_of(&self, cells: Cells) -> Aabb {
        self.around(&cells.region())
    }

    /// Every length multiplied by `factor`.
    pub(super) fn scaled(&self, factor: f64) -> Result<Self, InvalidShape> {
        Ok(Self { root: self.root.clone(), ..Self::new(self.resolution * factor)? })
    }

    fn around(&self, region: &Region) -> Aabb {
        let corner = |cell: GridCell| Vec3::from(cell.map(|c| self.edge(c)));
        Aabb { min: corner(region.low), max: corner(region.high) }
    }
}

impl<'a> Cells<'a> {
    fn of(node: &'a Node, rank: u32) -> Self {
        let part = match node {
            Node::Brick(brick) => CellsPart::Brick(*brick),
            Node::Inner(inner) => CellsPart::Octants(inner, inner.mask),
        };
        Self { part, rank }
    }

    /// Some octants of a node: the node of the only one.
    fn of_octants(inner: &'a Inner, mask: u8, rank: u32) -> Self {
        match inner.child(mask.trailing_zeros()) {
            Some(child) if mask.count_ones() == 1 => Self::of(child, rank),
            Some(_) | None => Self { part: CellsPart::Octants(inner, mask), rank },
        }
    }

    /// The two parts of some cells, cut across z, else y, else x; none of a single cell.
    #[must_use]
    pub fn halves(&self) -> Option<[Self; 2]> {
        match self.part {
            CellsPart::Octants(inner, mask) => {
                let lower =
                    [0x0f, 0x33, 0x55].map(|half| mask & half).into_iter().find(|low| *low != 0 && *low != mask)?;
                let before: u64 = nodes(inner, lower).map(Node::cells).sum();
                let rank = self.rank + before as u32;
                Some([Self::of_octants(inner, lower, self.rank), Self::of_octants(inner, mask & !lower, rank)])
            }
            CellsPart::Brick(brick) => {
                let halves = [
                    0x0000_0000_ffff_ffff,
                    0x0000_ffff_0000_ffff,
                    0x00ff_00ff_00ff_00ff,
                    0x0f0f_0f0f_0f0f_0f0f,
                    0x3333_3333_3333_3333,
                    0x5555_5555_5555_5555_u64,
                ];
                let bits = brick.bits;
                let lower = halves.map(|half| bits & half).into_iter().find(|low| *low != 0 && *low != bits)?;
                let part = |bits| CellsPart::Brick(Brick { bits, ..brick });
                let rank = self.rank + lower.count_ones();
                Some([Self { part: part(lower), rank: self.rank }, Self { part: part(bits & !lower), rank }])
            }
        }
    }

    /// The first cell, and its number in the order of [`Voxels::cells`].
    #[must_use]
    pub fn first(&self) -> ([i32; 3], u32) {
        let mut cells = *self;
        loop {
            match cells.part {
                CellsPart::Brick(brick) => return (brick.cell(brick.bits.trailing_zeros()), self.rank),
                CellsPart::Octants(inner, mask) => {
                    let lowest = mask & mask.wrapping_neg();
                    cells = Self::of_octants(inner, lowest, self.rank);
                }
            }
        }
    }

    fn region(&self) -> Region {
        match self.part {
            CellsPart::Brick(brick) => brick.region(),
            CellsPart::Octants(inner, mask) => {
                let around = nodes(inner, mask).map(Node::region).reduce(|one, other| one.union(&other));
                around.unwrap_or(Region { low: [0; 3], high: [0; 3] })
            }
        }
    }
}

/// The children in some octants.
fn nodes(inner: &Inner, mask: u8) -> impl Iterator<Item = &Node> {
    (0..8).filter(move |octant| mask >> octant & 1 == 1).filter_map(|octant| inner.child(octant)).map(|child| &**child)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;

    fn map(resolution: f64, cells: &[[i32; 3]]) -> Voxels {
        Voxels::new(resolution).unwrap().with_cells(cells).unwrap()
    }

    /// An edit of a map, in cells.
    #[derive(Clone, Debug)]
    enum Edit {
        Insert(Vec<[i32; 3]>),
        Clear([i32; 3], [i32; 3]),
    }

    fn edits() -> impl Strategy<Value = Vec<Edit>> {
        // Small coordinates, so that bricks fill and boxes hit; some far ones, so that levels are skipped.
        let near = -9..9;
        let coordinate = prop_oneof![8 => near, 1 => -3000..3000, 1 => Just(REACH - 1), 1 => Just(-REACH)];
        let cell = || [coordinate.clone(), coordinate.clone(), coordinate.clone()];
        let insert = prop::collection::vec(cell(), 1..60).prop_map(Edit::Insert);
        let clear = (cell(), cell()).prop_map(|(one, other)| {
            Edit::Clear(std::array::from_fn(|i| one[i].min(other[i])), std::array::from_fn(|i| one[i].max(other[i])))
        });
        prop::collection::vec(prop_oneof![2 => insert, 1 => clear], 1..12)
    }

    proptest! {
        /// Oracle: a set of cells. Every map of the history stays what it was, and equal sets have equal trees.
        #[test]
        fn edits_do_what_they_do_to_a_set_of_cells(edits in edits(), resolution in 0.01..3.0) {
            let mut model: BTreeSet<[i32; 3]> = BTreeSet::new();
            let mut history = vec![(Voxels::new(resolution).unwrap(), model.clone())];
            for edit in edits {
                let last = &history.last().unwrap().0;
                let next = match edit {
                    Edit::Insert(cells) => {
                        model.extend(&cells);
                        let points: Vec<Vec3> = cells.iter().map(|c| last.box_of(*c).center()).collect();
                        last.with_points(&points).unwrap()
                    }
                    Edit::Clear(low, high) => {
                        model.retain(|c| (0..3).any(|i| c[i] < low[i] || high[i] < c[i]));
                        let (low, high) = (last.box_of(low).center(), last.box_of(high).center());
                        last.without_box(&Aabb { min: low, max: high }).unwrap()
                    }
                };
                history.push((next, model.clone()));
            }
            for (map, model) in &history {
                prop_assert_eq!(map.cells().into_iter().collect::<BTreeSet<_>>(), model.clone());
                prop_assert_eq!(map.len(), model.len());
                prop_assert!(model.iter().all(|cell| map.has(*cell)));
                let cells: Vec<[i32; 3]> = model.iter().copied().collect();
                prop_assert_eq!(format!("{:?}", map.root), format!("{:?}", self::map(resolution, &cells).root));
            }
        }

        #[test]
        fn every_cell_is_in_one_leaf_and_inside_every_box_above_it(edits in edits()) {
            let cells: Vec<[i32; 3]> = edits.into_iter().flat_map(|edit| match edit {
                Edit::Insert(cells) => cells,
                Edit::Clear(low, high) => vec![low, high],
            }).collect();
            let map = map(0.5, &cells);
            let ordered = map.cells();
            let mut seen = vec![0; ordered.len()];
            let mut open = vec![(map.root().unwrap(), Vec::new())];
            while let Some((cells, mut above)) = open.pop() {
                above.push(map.bounds_of(cells));
                let (cell, rank) = cells.first();
                prop_assert_eq!(cell, ordered[rank as usize]);
                match cells.halves() {
                    Some(halves) => open.extend(halves.map(|half| (half, above.clone()))),
                    None => {
                        seen[rank as usize] += 1;
                        prop_assert!(above.iter().all(|bounds| bounds.contains(&map.box_of(cell))));
                        prop_assert_eq!(above.last(), Some(&map.box_of(cell)));
                        prop_assert!(above.len() <= 70);
                    }
                }
            }
            prop_assert!(seen.iter().all(|n| *n == 1));
        }

        #[test]
        fn a_point_is_in_its_cell_and_below_the_next(x in -1e4..1e4_f64, resolution in 0.01..3.0) {
            let map = Voxels::new(resolution).unwrap();
            let index = map.index_of(x).unwrap();
            prop_assert!(map.edge(index) <= x && x < map.edge(index + 1));
            // Edges themselves belong to the cell that begins there.
            prop_assert_eq!(map.index_of(map.edge(index)), Some(index));
            prop_assert_eq!(map.index_of(map.edge(index).next_down()), Some(index - 1));
        }
    }

    #[test]
    fn what_cannot_be_is_refused_by_name() {
        for (resolution, text) in [
            (0.0, "resolution is not positive: 0"),
            (-1.0, "resolution is negative: -1"),
            (f64::NAN, "resolution is not finite"),
        ] {
            assert_eq!(Voxels::new(resolution).unwrap_err().to_string(), text);
        }
        let map = Voxels::new(0.5).unwrap();
        let error = map.with_points(&[Vec3::zeros(), Vec3::new(0.0, f64::NAN, 0.0)]).unwrap_err();
        assert_eq!(error.to_string(), "points[1] is not finite");
        let error = map.with_points(&[Vec3::new(0.0, 0.0, 3e6)]).unwrap_err();
        assert_eq!(error.to_string(), "points[0] is beyond 2.097152e6 m: 3e6");
        assert!(map.with_cells(&[[0, REACH, 0]]).is_err());
        let upside_down = Aabb { min: Vec3::z(), max: Vec3::zeros() };
        assert_eq!(map.without_box(&upside_down).unwrap_err().to_string(), "min.z is above max.z");
        assert!(map.without_box(&Aabb { min: Vec3::repeat(f64::NAN), max: Vec3::zeros() }).is_err());
    }

    #[test]
    fn a_box_out_of_reach_clears_everything_and_nothing_is_left() {
        let map = map(0.5, &[[0, 0, 0], [REACH - 1, -REACH, 5]]);
        let all = Aabb { min: Vec3::repeat(-1e100), max: Vec3::repeat(1e100) };
        let empty = map.without_box(&all).unwrap();
        assert!(empty.is_empty() && empty.bounds().is_none() && empty.root().is_none() && map.len() == 2);
        let beside = Aabb { min: Vec3::repeat(1e99), max: Vec3::repeat(1e100) };
        assert_eq!(map.without_box(&beside).unwrap().len(), 2);
    }
}
