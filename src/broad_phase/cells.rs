//! Building over very many entries: first sorted into the cells of a grid, by their centres.
//!
//! The top of the tree is grouped over cells, by the same heuristic with the cells' entries as weights, then the entries
//! of each cell for themselves (as Pantaleoni, Luebke, "HLBVH", 2010, and Garanzha and others, 2011, do with cells of a
//! space-filling curve). That saves half the levels of splits over all entries and hardly costs quality: splits high up
//! differ little. Entries much larger than most have a cell of their own, so that they do not make ordinary cells large.

use std::ops::Range;

use super::arrange::{Item, Supply};
use super::volume::BoundingVolume;

/// Entries of a cell on average, if they were spread evenly.
const EVENLY: usize = 48;

/// Cells along an axis at the most.
const MOST_CELLS: f32 = 1024.0;

/// An axis along which entries spread less than this part of the longest one has one cell.
const FLAT: f32 = 1e-3;

/// Entries this many times as dear as the median of a sample are large.
const LARGE: f32 = 64.0;

/// Entries of the sample.
const SAMPLE: usize = 65;

/// Entries by cells, none of which is empty.
pub(super) struct Cells<V: BoundingVolume> {
    /// Indices of entries, cell by cell.
    sorted: Vec<u32>,
    cells: Vec<(Range<usize>, V::Bound)>,
}

impl<V: BoundingVolume> Cells<V> {
    /// Entries sorted by cells. Nothing if there is no sensible grid.
    pub(super) fn of(count: usize, entries: Supply<'_, V>) -> Option<Self> {
        let bound = |index: u32| entries(index).volume.bound();
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for index in 0..count as u32 {
            let centre = V::centre(&bound(index));
            for axis in 0..3 {
                low[axis] = if centre[axis] < low[axis] { centre[axis] } else { low[axis] };
                high[axis] = if centre[axis] > high[axis] { centre[axis] } else { high[axis] };
            }
        }
        let counts = cells_along([0, 1, 2].map(|axis| high[axis] - low[axis]), count / EVENLY)?;
        let scale: [f32; 3] = std::array::from_fn(|axis| match counts[axis] {
            1 => 0.0,
            count => count as f32 / (high[axis] - low[axis]),
        });
        let large = LARGE * median_cost::<V>((0..count as u32).step_by(count.div_ceil(SAMPLE)).map(bound));
        let along = |axis: usize, centre: f32| (((centre - low[axis]) * scale[axis]) as usize).min(counts[axis] - 1);
        let last = counts.iter().product();
        let cell_of = |bound: &V::Bound| {
            let [x, y, z] = V::centre(bound);
            let cell = (along(2, z) * counts[1] + along(1, y)) * counts[0] + along(0, x);
            if V::cost(bound) > large { last } else { cell }
        };
        let mut cells = vec![(0..0, V::nothing()); last + 1];
        let of: Vec<u32> = (0..count as u32)
            .map(|index| {
                let bound = bound(index);
                let cell = cell_of(&bound);
                let (range, all) = &mut cells[cell];
                range.end += 1;
                *all = V::union(all, &bound);
                cell as u32
            })
            .collect();
        let mut start = 0;
        for (range, _) in &mut cells {
            (start, *range) = (start + range.end, start..start);
        }
        let mut sorted = vec![0; count];
        for (index, cell) in (0..).zip(&of) {
            let (range, _) = &mut cells[*cell as usize];
            sorted[range.end] = index;
            range.end += 1;
        }
        cells.retain(|(range, _)| !range.is_empty());
        Some(Self { sorted, cells })
    }

    /// The cells, as things to be grouped.
    pub(super) fn items(&self) -> Vec<Item<V>> {
        (0..).zip(&self.cells).map(|(index, (_, bound))| Item::new(*bound, index)).collect()
    }

    /// The indices of a cell's entries.
    pub(super) fn entries(&self, cell: u32) -> &[u32] {
        &self.sorted[self.cells[cell as usize].0.clone()]
    }
}

/// About so many cells, nearly cubes, in a box of these sides.
fn cells_along(sides: [f32; 3], wanted: usize) -> Option<[usize; 3]> {
    let longest = sides[0].max(sides[1]).max(sides[2]);
    if !(longest.is_finite() && longest > 1e-30) {
        return None;
    }
    let thick = sides.iter().filter(|side| **side > FLAT * longest).count();
    let relative = sides.map(|side| f64::from(side / longest));
    let volume: f64 = relative.iter().filter(|side| **side > f64::from(FLAT)).product();
    let share = volume / wanted.max(1) as f64;
    let side = match thick {
        1 => share,
        2 => share.sqrt(),
        _ => libm::cbrt(share),
    };
    Some(relative.map(|length| {
        if length > f64::from(FLAT) { (length / side).ceil().clamp(1.0, f64::from(MOST_CELLS)) as usize } else { 1 }
    }))
}

fn median_cost<V: BoundingVolume>(sample: impl Iterator<Item = V::Bound>) -> f32 {
    let mut costs: Vec<f32> = sample.map(|bound| V::cost(&bound)).collect();
    let middle = costs.len() / 2;
    *costs.select_nth_unstable_by(middle, f32::total_cmp).1
}
