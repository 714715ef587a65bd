//! How are very many things parted under one node? By the cells of a coarse grid, in three passes instead of one or two
//! for every halving.
//!
//! The grid is over the centres, with 64 cells that are as nearly cubes as halving allows. The parts are made of whole
//! cells: split in two again and again between layers of cells, by the surface-area heuristic, the dearest part first. Cells
//! are to things what bins are to one axis.

use arrayvec::ArrayVec;

use super::arrange::{Item, Part};
use super::volume::{BoundingVolume, LANES};

/// Halvings of the grid; it has two to that power cells.
const BITS: u32 = 6;
const CELLS: usize = 1 << BITS;

/// Layers of cells along an axis, at most.
const LAYERS: usize = CELLS;

/// With fewer cells in use the grid says too little.
const FEW_CELLS: usize = 12;

/// A cell that is not empty.
#[derive(Clone, Copy)]
struct Block<V: BoundingVolume> {
    bound: V::Bound,
    count: usize,
    /// Along each axis.
    layers: [u8; 3],
    number: usize,
}

/// Some cells, one after another in the list of cells.
struct Group<V: BoundingVolume> {
    start: usize,
    end: usize,
    count: usize,
    bound: V::Bound,
}

/// Reorders the items into parts for the children of one node, each of at most `most` things. None where a grid does not part them
/// well; then nothing has changed that matters.
pub(super) fn parts<V: BoundingVolume>(
    items: &mut [Item<V>],
    spare: &mut Vec<Item<V>>,
    numbers: &mut Vec<u8>,
    bound: &V::Bound,
    unit: usize,
    most: usize,
) -> Option<ArrayVec<Part<V>, LANES>> {
    let grid = Grid::over::<V>(items);
    let mut found = [(V::nothing(), 0_usize); CELLS];
    numbers.clear();
    numbers.extend(items.iter().map(|item| {
        let number = grid.cell_of(V::centre(&item.bound));
        let (bound, count) = &mut found[number];
        *bound = V::union(bound, &item.bound);
        *count += 1;
        number as u8
    }));
    let used = found.iter().enumerate().filter(|(_, (_, count))| *count > 0);
    let mut cells: ArrayVec<Block<V>, CELLS> = used
        .map(|(number, (bound, count))| Block { bound: *bound, count: *count, layers: grid.layers(number), number })
        .collect();
    if cells.len() < FEW_CELLS || cells.iter().any(|cell| cell.count > most.min(items.len() / 2)) {
        return None;
    }
    let groups = grouped(&mut cells, bound, items.len(), unit);
    if groups.iter().any(|group| group.count > most) {
        return None;
    }
    let mut parts = ArrayVec::new();
    let (mut start, mut next, mut group_of) = (0, [0_usize; LANES], [0_u8; CELLS]);
    for (i, group) in groups.iter().enumerate() {
        cells[group.start..group.end].iter().for_each(|cell| group_of[cell.number] = i as u8);
        parts.push(Part { start, end: start + group.count, bound: group.bound });
        next[i] = start;
        start += group.count;
    }
    spare.clear();
    spare.extend_from_slice(items);
    for (item, number) in spare.iter().zip(numbers.iter()) {
        let place = &mut next[group_of[*number as usize & (CELLS - 1)] as usize & (LANES - 1)];
        items[*place] = *item;
        *place += 1;
    }
    Some(parts)
}

/// Up to eight groups of cells, the dearest split first.
fn grouped<V: BoundingVolume>(
    cells: &mut [Block<V>],
    bound: &V::Bound,
    count: usize,
    unit: usize,
) -> ArrayVec<Group<V>, LANES> {
    let mut groups: ArrayVec<Group<V>, LANES> = ArrayVec::new();
    groups.push(Group { start: 0, end: cells.len(), count, bound: *bound });
    while groups.len() < LANES {
        let splittable = groups.iter().enumerate().filter(|(_, group)| group.end - group.start > 1);
        let dearest =
            splittable.map(|(i, group)| (V::cost(&group.bound), i)).reduce(|a, b| if a.0 < b.0 { b } else { a });
        let Some((_, worst)) = dearest else { break };
        let Group { start, end, .. } = groups[worst];
        let [first, second] = halves(&mut cells[start..end], start, unit);
        groups[worst] = first;
        groups.push(second);
    }
    groups
}

/// Splits at least two cells between two layers of an axis.
fn halves<V: BoundingVolume>(cells: &mut [Block<V>], start: usize, unit: usize) -> [Group<V>; 2] {
    let mut best = (f32::INFINITY, 0, 1);
    for axis in 0..3 {
        let (least, most) = cells
            .iter()
            .fold((u8::MAX, 0), |(least, most), cell| (least.min(cell.layers[axis]), most.max(cell.layers[axis])));
        if least == most {
            continue;
        }
        let mut layers = [(V::nothing(), 0_usize); LAYERS];
        for cell in &*cells {
            let (bound, count) = &mut layers[cell.layers[axis] as usize];
            *bound = V::union(bound, &cell.bound);
            *count += cell.count;
        }
        let range = least as usize..=most as usize;
        let mut after = layers;
        for layer in range.clone().rev().skip(1) {
            after[layer] = (V::union(&after[layer].0, &after[layer + 1].0), after[layer].1 + after[layer + 1].1);
        }
        let mut before = (V::nothing(), 0);
        for edge in least as usize + 1..=most as usize {
            before = (V::union(&before.0, &layers[edge - 1].0), before.1 + layers[edge - 1].1);
            let side = |(bound, count): &(V::Bound, usize)| V::cost(bound) * count.div_ceil(unit) as f32;
            let price = side(&before) + side(&after[edge]);
            if price < best.0 {
                best = (price, axis, edge);
            }
        }
    }
    let (_, axis, edge) = best;
    cells.sort_unstable_by_key(|cell| (cell.layers[axis] as usize >= edge, cell.number));
    let middle = cells.partition_point(|cell| (cell.layers[axis] as usize) < edge);
    let group = |from: usize, to: usize| {
        let nothing = (V::nothing(), 0);
        let (bound, count) = cells[from..to]
            .iter()
            .fold(nothing, |(bound, count), cell| (V::union(&bound, &cell.bound), count + cell.count));
        Group { start: start + from, end: start + to, count, bound }
    };
    [group(0, middle), group(middle, cells.len())]
}

/// Which cell a centre is in.
struct Grid {
    low: [f32; 3],
    scale: [f32; 3],
    bits: [u32; 3],
}

impl Grid {
    fn over<V: BoundingVolume>(items: &[Item<V>]) -> Self {
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for item in items {
            let centre = V::centre(&item.bound);
            for axis in 0..3 {
                low[axis] = low[axis].min(centre[axis]);
                high[axis] = high[axis].max(centre[axis]);
            }
        }
        let extent: [f32; 3] = std::array::from_fn(|axis| high[axis] / 2.0 - low[axis] / 2.0);
        let (mut bits, mut side) = ([0; 3], extent);
        for _ in 0..BITS {
            let longest = (1..3).fold(0, |best, axis| if side[axis] > side[best] { axis } else { best });
            bits[longest] += 1;
            side[longest] /= 2.0;
        }
        let scale = std::array::from_fn(|axis| {
            let scale = ((1 << bits[axis]) as f32 * 0.499_999) / extent[axis];
            if scale.is_finite() { scale } else { 0.0 }
        });
        Self { low, scale, bits }
    }

    #[inline(always)]
    fn cell_of(&self, centre: [f32; 3]) -> usize {
        let layer = |axis: usize| {
            let layer = ((centre[axis] - self.low[axis]) * self.scale[axis]) as usize;
            layer.min((1 << self.bits[axis]) - 1)
        };
        ((layer(0) << self.bits[1] | layer(1)) << self.bits[2] | layer(2)) & (CELLS - 1)
    }

    fn layers(&self, cell: usize) -> [u8; 3] {
        let [_, y, z] = self.bits;
        [cell >> (y + z), cell >> z & ((1 << y) - 1), cell & ((1 << z) - 1)].map(|layer| layer as u8)
    }
}
