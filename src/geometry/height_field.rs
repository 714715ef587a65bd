//! Terrain: heights over a regular grid, solid down to a floor.
//!
//! Sample `[row][column]` is at `x = column * spacing.x`, `y = row * spacing.y`, each product rounded to a double. Between four
//! samples the surface is two triangles that meet along the line from the sample of least row and column to that of greatest.
//! Below each triangle everything down to the floor belongs to the body: a planner's terrain is ground, and what is
//! under its surface has collided though it touches no triangle.
//!
//! There is no list of triangles and no tree of boxes: the cells in a box are found by arithmetic, and the largest height in a block of
//! cells by a pyramid of maxima, which keeps one number for 16 cells, one for 64, and so on. (The least height is not
//! needed: the body reaches down to the floor.) So a field costs 8.7 bytes a sample.

use super::shape::{length, position};
use super::{Aabb, InvalidShape, Vec3};

/// Blocks of 4 x 4 cells are the smallest whose maximum is kept; of smaller ones it is taken from the samples.
const FIRST_KEPT: u8 = 2;

/// Heights over a grid of samples, in the field's frame; metres.
#[derive(Clone, Debug)]
pub struct HeightField {
    grid: Grid,
    floor: f64,
    heights: Vec<f64>,
    /// Maxima of blocks of `2^level` cells a side, level by level from [`FIRST_KEPT`], row by row.
    maxima: Vec<f64>,
    /// Where each level begins in `maxima`.
    levels: Vec<usize>,
    bounds: Aabb,
}

/// How the samples of a height field lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Samples along y, at least two.
    pub rows: u32,
    /// Samples along x, at least two.
    pub columns: u32,
    /// Between samples along x and along y, metres; positive.
    pub spacing: [f64; 2],
}

/// A block of cells, half of one, or one of the two columns of a cell.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    /// The block is of `2^level` cells a side, where the field has as many.
    level: u8,
    piece: Piece,
    /// In blocks of its level.
    row: u32,
    column: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Piece {
    Whole,
    /// The half of lesser (0) or greater (1) rows.
    Half(u8),
    /// Of a single cell: the triangle at its greatest column (0) or its greatest row (1).
    Triangle(u8),
}

/// What a height field is made of: everything between a triangle and the floor. Metres, in the field's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// Corners of the triangle. None is below the floor.
    pub top: [Vec3; 3],
    /// Height of the triangle's shadow.
    pub floor: f64,
}

impl Column {
    /// Its corners: the triangle's and those below them.
    #[must_use]
    pub fn corners(&self) -> [Vec3; 6] {
        let [a, b, c] = self.top;
        let below = |p: Vec3| Vec3::new(p.x, p.y, self.floor);
        [a, b, c, below(a), below(b), below(c)]
    }
}

impl HeightField {
    /// Heights row by row, metres, above the floor at height `floor`.
    ///
    /// # Errors
    /// Fewer than two rows or columns, or 2^31 cells; a spacing that is not positive; a number of heights that is not
    /// rows times columns; a height that is not finite or below the floor.
    pub fn new(grid: Grid, heights: Vec<f64>, floor: f64) -> Result<Self, InvalidShape> {
        for (field, count) in [("rows", grid.rows), ("columns", grid.columns)] {
            if count < 2 {
                return Err(InvalidShape::TooFew { field, count: count as usize, least: 2 });
            }
        }
        for (field, spacing) in [("spacing.x", grid.spacing[0]), ("spacing.y", grid.spacing[1])] {
            length(field, spacing)?;
            if spacing == 0.0 {
                return Err(InvalidShape::NotPositive { field, value: spacing });
            }
        }
        if u64::from(grid.rows) * u64::from(grid.columns) > 1 << 31 {
            return Err(InvalidShape::TooMany { field: "heights", limit: 1 << 31 });
        }
        let wanted = grid.rows as usize * grid.columns as usize;
        if heights.len() != wanted {
            return Err(InvalidShape::WrongCount { field: "heights", count: heights.len(), wanted });
        }
        position(|| "floor".to_owned(), Vec3::repeat(floor))?;
        let far = grid.sample(grid.rows - 1, grid.columns - 1, floor);
        position(|| "spacing".to_owned(), far)?;
        let mut highest = floor;
        for (i, height) in heights.iter().enumerate() {
            position(|| format!("heights[{i}]"), Vec3::repeat(*height))?;
            if *height < floor {
                return Err(InvalidShape::BelowFloor { sample: i, height: *height, floor });
            }
            highest = highest.max(*height);
        }
        let bounds = Aabb { min: Vec3::new(0.0, 0.0, floor), max: Vec3::new(far.x, far.y, highest) };
        let mut field = Self { grid, floor, heights, maxima: Vec::new(), levels: Vec::new(), bounds };
        field.pile_up();
        Ok(field)
    }

    /// Builds the pyramid.
    fn pile_up(&mut self) {
        for level in FIRST_KEPT..self.top_level() {
            let (rows, columns) = (self.grid.blocks(level, 0), self.grid.blocks(level, 1));
            let start = self.maxima.len();
            for row in 0..rows {
                for column in 0..columns {
                    let children = self.quarters(Patch { level, piece: Piece::Whole, row, column });
                    let highest = children.map(|child| self.highest(child)).fold(self.floor, f64::max);
                    self.maxima.push(highest);
                }
            }
            self.levels.push(start);
        }
        self.maxima.shrink_to_fit();
    }

    /// The level whose single block is the whole field.
    fn top_level(&self) -> u8 {
        let cells = (self.grid.rows - 1).max(self.grid.columns - 1);
        (32 - (cells - 1).leading_zeros()) as u8
    }

    /// How the samples lie.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// Row by row, metres.
    #[must_use]
    pub fn heights(&self) -> &[f64] {
        &self.heights
    }

    /// Where the body ends below, metres.
    #[must_use]
    pub fn floor(&self) -> f64 {
        self.floor
    }

    /// Bounds in the field's frame.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Bytes on the heap.
    #[must_use]
    pub fn memory(&self) -> usize {
        size_of_val(&*self.heights) + size_of_val(&*self.maxima) + size_of_val(&*self.levels)
    }

    /// The whole field.
    #[must_use]
    pub fn root(&self) -> Patch {
        Patch { level: self.top_level(), piece: Piece::Whole, row: 0, column: 0 }
    }

    /// The two parts of a patch; none of a single column.
    #[must_use]
    pub fn halves(&self, patch: Patch) -> Option<[Patch; 2]> {
        let mut patch = patch;
        loop {
            let Patch { level, piece, row, column } = patch;
            match piece {
                Piece::Triangle(_) => return None,
                Piece::Whole if level == 0 => {
                    return Some([0, 1].map(|which| Patch { piece: Piece::Triangle(which), ..patch }));
                }
                Piece::Whole => {
                    let halves = [0, 1].map(|which| Patch { piece: Piece::Half(which), ..patch });
                    if 2 * row + 1 < self.grid.blocks(level - 1, 0) {
                        return Some(halves);
                    }
                    patch = halves[0];
                }
                Piece::Half(which) => {
                    let row = 2 * row + u32::from(which);
                    let quarter = |column| Patch { level: level - 1, piece: Piece::Whole, row, column };
                    if 2 * column + 1 < self.grid.blocks(level - 1, 1) {
                        return Some([quarter(2 * column), quarter(2 * column + 1)]);
                    }
                    patch = quarter(2 * column);
                }
            }
        }
    }

    /// A box around a patch.
    #[must_use]
    pub fn bounds_of(&self, patch: Patch) -> Aabb {
        let [rows, columns] = self.cells_of(patch);
        let low = self.grid.sample(rows[0], columns[0], self.floor);
        Aabb { min: low, max: self.grid.sample(rows[1], columns[1], self.highest(patch)) }
    }

    /// The number of the column that a patch is: twice that of its cell, plus one for the triangle at the greatest row. None for larger
    /// patches. Cells are counted row by row.
    #[must_use]
    pub fn column_number(&self, patch: Patch) -> Option<u32> {
        let Piece::Triangle(which) = patch.piece else { return None };
        Some(2 * (patch.row * (self.grid.columns - 1) + patch.column) + u32::from(which))
    }

    /// A column by its number.
    #[must_use]
    pub fn column(&self, number: u32) -> Column {
        let (cell, which) = (number / 2, number % 2);
        let (row, column) = (cell / (self.grid.columns - 1), cell % (self.grid.columns - 1));
        let at = |row: u32, column: u32| self.grid.sample(row, column, self.height(row, column));
        let (first, last) = (at(row, column), at(row + 1, column + 1));
        let top = if which == 0 { [first, at(row, column + 1), last] } else { [first, last, at(row + 1, column)] };
        Column { top, floor: self.floor }
    }

    /// Every length multiplied by `factor`.
    pub(super) fn scaled(&self, factor: f64) -> Result<Self, InvalidShape> {
        let grid = Grid { spacing: self.grid.spacing.map(|s| s * factor), ..self.grid };
        // A product rounds alike for equal factors, so no height falls below the floor.
        Self::new(grid, self.heights.iter().map(|h| h * factor).collect(), self.floor * factor)
    }

    fn height(&self, row: u32, column: u32) -> f64 {
        self.heights[row as usize * self.grid.columns as usize + column as usize]
    }

    /// The largest height in a patch.
    fn highest(&self, patch: Patch) -> f64 {
        let Patch { level, piece, row, column } = patch;
        match piece {
            Piece::Whole if level >= FIRST_KEPT => {
                // The single block of the top level is the field.
                let Some(start) = self.levels.get(usize::from(level - FIRST_KEPT)) else { return self.bounds.max.z };
                self.maxima[start + (row as usize * self.grid.blocks(level, 1) as usize) + column as usize]
            }
            Piece::Half(which) if level > FIRST_KEPT => {
                let parts = self.quarters(patch).filter(|quarter| quarter.row % 2 == u32::from(which));
                parts.map(|quarter| self.highest(quarter)).fold(self.floor, f64::max)
            }
            Piece::Whole | Piece::Half(_) | Piece::Triangle(_) => {
                let [rows, columns] = self.cells_of(patch);
                let samples = (rows[0]..=rows[1]).flat_map(|row| (columns[0]..=columns[1]).map(move |c| (row, c)));
                samples.map(|(row, column)| self.height(row, column)).fold(self.floor, f64::max)
            }
        }
    }

    /// The blocks of the next level that a block is made of.
    fn quarters(&self, block: Patch) -> impl Iterator<Item = Patch> {
        let level = block.level - 1;
        let (rows, columns) = (self.grid.blocks(level, 0), self.grid.blocks(level, 1));
        let of_rows = 2 * block.row..(2 * block.row + 2).min(rows);
        let of_columns = 2 * block.column..(2 * block.column + 2).min(columns);
        of_rows.flat_map(move |row| {
            of_columns.clone().map(move |column| Patch { level, piece: Piece::Whole, row, column })
        })
    }

    /// First and last row and column of samples.
    fn cells_of(&self, patch: Patch) -> [[u32; 2]; 2] {
        let Patch { level, piece, row, column } = patch;
        let span = |first: u32, level: u8, count: u32| [first << level, ((first + 1) << level).min(count - 1)];
        let rows = match piece {
            Piece::Half(which) => span(2 * row + u32::from(which), level - 1, self.grid.rows),
            Piece::Whole | Piece::Triangle(_) => span(row, level, self.grid.rows),
        };
        [rows, span(column, level, self.grid.columns)]
    }
}

impl Grid {
    /// A point over the sample of that row and column.
    fn sample(&self, row: u32, column: u32, height: f64) -> Vec3 {
        Vec3::new(f64::from(column) * self.spacing[0], f64::from(row) * self.spacing[1], height)
    }

    /// How many blocks of a level there are along rows (0) or columns (1).
    fn blocks(&self, level: u8, axis: usize) -> u32 {
        let cells = if axis == 0 { self.rows - 1 } else { self.columns - 1 };
        cells.div_ceil(1 << level)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wavy(rows: u32, columns: u32) -> HeightField {
        let heights = (0..rows * columns).map(|i| libm::sin(f64::from(i) * 0.7) + f64::from(i % 7)).collect();
        HeightField::new(Grid { rows, columns, spacing: [0.5, 0.25] }, heights, -1.0).unwrap()
    }

    #[test]
    fn every_column_is_in_one_leaf_and_inside_every_box_above_it() {
        for (rows, columns) in [(2, 2), (2, 3), (3, 2), (2, 40), (33, 2), (5, 5), (17, 9), (20, 31), (65, 64)] {
            let field = wavy(rows, columns);
            let mut seen = vec![0; 2 * (rows as usize - 1) * (columns as usize - 1)];
            let mut open = vec![(field.root(), Vec::new())];
            while let Some((patch, mut above)) = open.pop() {
                above.push(field.bounds_of(patch));
                if let Some(halves) = field.halves(patch) {
                    open.extend(halves.map(|half| (half, above.clone())));
                    continue;
                }
                let number = field.column_number(patch).unwrap();
                seen[number as usize] += 1;
                let around = Aabb::around(field.column(number).corners());
                assert!(above.iter().all(|bounds| bounds.contains(&around)), "{rows} x {columns}: {patch:?}");
                assert!(above.len() <= 16);
            }
            assert!(seen.iter().all(|&n| n == 1), "{rows} x {columns}");
            assert_eq!(field.bounds_of(field.root()), field.bounds());
        }
    }

    #[test]
    fn boxes_are_tight_at_every_level() {
        let field = wavy(20, 31);
        let mut open = vec![field.root()];
        while let Some(patch) = open.pop() {
            let [rows, columns] = field.cells_of(patch);
            let highest = (rows[0]..=rows[1])
                .flat_map(|r| (columns[0]..=columns[1]).map(move |c| (r, c)))
                .map(|(r, c)| field.height(r, c))
                .fold(f64::NEG_INFINITY, f64::max);
            assert_eq!(field.bounds_of(patch).max.z, highest);
            open.extend(field.halves(patch).into_iter().flatten());
        }
    }

    #[test]
    fn the_diagonal_of_a_cell_leads_from_least_to_greatest() {
        let field = HeightField::new(Grid { rows: 2, columns: 2, spacing: [2.0, 3.0] }, vec![1.0, 2.0, 3.0, 4.0], 0.0);
        let field = field.unwrap();
        let [first, last] = [Vec3::new(0.0, 0.0, 1.0), Vec3::new(2.0, 3.0, 4.0)];
        assert_eq!(field.column(0), Column { top: [first, Vec3::new(2.0, 0.0, 2.0), last], floor: 0.0 });
        assert_eq!(field.column(1), Column { top: [first, last, Vec3::new(0.0, 3.0, 3.0)], floor: 0.0 });
    }

    #[test]
    fn what_is_no_field_is_refused_by_name() {
        let grid = Grid { rows: 2, columns: 2, spacing: [1.0, 1.0] };
        let text =
            |grid, heights: &[f64], floor| HeightField::new(grid, heights.to_vec(), floor).unwrap_err().to_string();
        let flat = [0.0; 4];
        assert_eq!(text(Grid { rows: 1, ..grid }, &[0.0; 2], 0.0), "rows is 1, at least 2 are needed");
        assert_eq!(text(Grid { spacing: [1.0, 0.0], ..grid }, &flat, 0.0), "spacing.y is not positive: 0");
        assert_eq!(text(Grid { spacing: [-1.0, 1.0], ..grid }, &flat, 0.0), "spacing.x is negative: -1");
        assert_eq!(text(grid, &[0.0; 3], 0.0), "heights has 3 numbers, 4 are needed");
        assert_eq!(text(grid, &[0.0, 1.0, f64::NAN, 0.0], 0.0), "heights[2] is not finite");
        assert_eq!(text(grid, &[0.0, 1.0, 0.0, -0.5], 0.0), "heights[3] is below the floor: -0.5 < 0");
        assert_eq!(text(grid, &flat, f64::INFINITY), "floor is not finite");
        let endless = Grid { rows: u32::MAX, columns: u32::MAX, spacing: [1.0, 1.0] };
        assert_eq!(text(endless, &[], 0.0), "heights has more than 2147483648 elements");
    }
}
