//! Building over very many entries: first sorted into the cells of a grid, by their centres.
//!
//! The top of the tree is grouped over cells, by the same heuristic with the cells' entries as weights, then the entries
//! of each cell for themselves (as Pantaleoni, Luebke, "HLBVH", 2010, and Garanzha and others, 2011, do with cells of a
//! space-filling curve). That saves half the levels of splits over all entries and hardly costs quality: splits high up
//! differ little. Entries much larger than most have a cell of their own, so that they do not make ordinary cells large.

use std::ops::Range;

use super::arrange::Item;
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

/// Sorts the items by cells: where each cell's are, none of them empty. Nothing if there is no sensible grid.
pub(super) fn into_cells<V: BoundingVolume>(items: &mut Vec<Item<V>>) -> Option<Vec<Range<usize>>> {
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for item in items.iter() {
        let centre = item.centre();
        for axis in 0..3 {
            low[axis] = if centre[axis] < low[axis] { centre[axis] } else { low[axis] };
            high[axis] = if centre[axis] > high[axis] { centre[axis] } else { high[axis] };
        }
    }
    let counts = cells_along([0, 1, 2].map(|axis| high[axis] - low[axis]), items.len() / EVENLY)?;
    let scale: [f32; 3] =
        std::array::from_fn(|axis| if counts[axis] > 1 { counts[axis] as f32 / (high[axis] - low[axis]) } else { 0.0 });
    let large = LARGE * median_cost(items);
    let along = |axis: usize, centre: f32| (((centre - low[axis]) * scale[axis]) as usize).min(counts[axis] - 1);
    let last = counts.iter().product();
    let cell_of = |item: &Item<V>| {
        let [x, y, z] = item.centre();
        let cell = (along(2, z) * counts[1] + along(1, y)) * counts[0] + along(0, x);
        if V::cost(item.bound()) > large { last } else { cell }
    };
    let cells: Vec<u32> = items.iter().map(|item| cell_of(item) as u32).collect();
    let mut starts = vec![0_usize; last + 2];
    cells.iter().for_each(|cell| starts[*cell as usize + 1] += 1);
    for cell in 0..=last {
        starts[cell + 1] += starts[cell];
    }
    let ranges = starts.windows(2).map(|ends| ends[0]..ends[1]).filter(|range| !range.is_empty()).collect();
    let mut sorted = vec![items[0]; items.len()];
    for (item, cell) in items.iter().zip(&cells) {
        let place = &mut starts[*cell as usize];
        sorted[*place] = *item;
        *place += 1;
    }
    *items = sorted;
    Some(ranges)
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

fn median_cost<V: BoundingVolume>(items: &[Item<V>]) -> f32 {
    let mut costs: Vec<f32> =
        items.iter().step_by(items.len().div_ceil(SAMPLE)).map(|item| V::cost(item.bound())).collect();
    let middle = costs.len() / 2;
    *costs.select_nth_unstable_by(middle, f32::total_cmp).1
}
