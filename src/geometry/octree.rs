//! A set of cells of a grid, as an octree that shares what did not change: a new set costs what was added or removed.
//!
//! The leaves are bricks of 4 x 4 x 4 cells, one bit each. A brick's place is told by its Morton code (the bits of its coordinates,
//! interleaved), and a node of level n holds all bricks whose codes agree but for their last 3n bits. Levels at which nothing
//! branches are left out (Morrison's Patricia tree, 1968), so every inner node has at least two children and a set of cells has one tree,
//! whatever the edits it came from.

use std::sync::Arc;

/// Bits of a cell's coordinate.
const BITS: u32 = 23;
/// Cells have coordinates in `-REACH..REACH`.
pub(super) const REACH: i32 = 1 << (BITS - 1);
/// Of a brick's side, in cells, as a power of two.
const BRICK_BITS: u32 = 2;
const SIDE: i32 = 1 << BRICK_BITS;

/// Coordinates of a cell.
pub(super) type GridCell = [i32; 3];

/// Cells from `low` to below `high` along each axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Region {
    pub low: GridCell,
    pub high: GridCell,
}

impl Region {
    pub fn union(&self, other: &Self) -> Self {
        Self {
            low: std::array::from_fn(|i| self.low[i].min(other.low[i])),
            high: std::array::from_fn(|i| self.high[i].max(other.high[i])),
        }
    }

    fn contains(&self, other: &Self) -> bool {
        (0..3).all(|i| self.low[i] <= other.low[i] && other.high[i] <= self.high[i])
    }

    fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|i| self.low[i] < other.high[i] && other.low[i] < self.high[i])
    }
}

/// A node that is shared by all sets it belongs to.
#[derive(Debug)]
pub(super) enum Node {
    Brick(Brick),
    Inner(Inner),
}

/// 4 x 4 x 4 cells, at least one of them occupied: bit `x + 4 y + 16 z`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Brick {
    pub code: u64,
    pub bits: u64,
}

#[derive(Debug)]
pub(super) struct Inner {
    level: u32,
    /// The least code of a brick that could be below.
    code: u64,
    /// Which octants are there.
    pub mask: u8,
    pub children: Box<[Arc<Node>]>,
    cells: u64,
    region: Region,
}

/// Brick and bit of a cell.
pub(super) fn place(cell: GridCell) -> Brick {
    let shifted = cell.map(|c| (c + REACH) as u32);
    let code = (0..3).fold(0, |code, axis| code | spread(shifted[axis] >> BRICK_BITS) << axis);
    let [x, y, z] = shifted.map(|c| c & (SIDE as u32 - 1));
    Brick { code, bits: 1 << (x + 4 * y + 16 * z) }
}

/// Puts two zeros between any two of the 21 bits.
fn spread(value: u32) -> u64 {
    let mut v = u64::from(value) & 0x1f_ffff;
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        v = (v | v << shift) & mask;
    }
    v
}

/// The inverse of [`spread`], of every third bit.
fn gather(code: u64) -> u32 {
    let mut v = code & 0x1249_2492_4924_9249;
    for (shift, mask) in [
        (2, 0x10c3_0c30_c30c_30c3),
        (4, 0x100f_00f0_0f00_f00f),
        (8, 0x001f_0000_ff00_00ff),
        (16, 0x001f_0000_0000_ffff),
        (32, 0x1f_ffff),
    ] {
        v = (v | v >> shift) & mask;
    }
    v as u32
}

impl Brick {
    /// The cell of its bit 0.
    pub fn origin(&self) -> GridCell {
        std::array::from_fn(|axis| ((gather(self.code >> axis) << BRICK_BITS) as i32) - REACH)
    }

    /// The cell of a bit.
    pub fn cell(&self, bit: u32) -> GridCell {
        let [x, y, z] = self.origin();
        let bit = bit as i32;
        [x + bit % 4, y + bit / 4 % 4, z + bit / 16]
    }

    /// Around the cells whose bits are set.
    pub fn region(&self) -> Region {
        let origin = self.origin();
        // The bits of each layer across an axis.
        let layers = [0x1111_1111_1111_1111_u64, 0x000f_000f_000f_000f, 0xffff];
        let is_used = |axis: usize, layer: i32| self.bits & layers[axis] << (layer << (2 * axis)) != 0;
        let range = |axis| {
            let low = (0..SIDE).find(|layer| is_used(axis, *layer)).unwrap_or(0);
            let high = (0..SIDE).rfind(|layer| is_used(axis, *layer)).unwrap_or(0);
            [origin[axis] + low, origin[axis] + high + 1]
        };
        let ranges = [0, 1, 2].map(range);
        Region { low: ranges.map(|[low, _]| low), high: ranges.map(|[_, high]| high) }
    }

    /// The bits of the cells in a region.
    fn bits_in(&self, region: &Region) -> u64 {
        let is_in = |cell: GridCell| (0..3).all(|i| region.low[i] <= cell[i] && cell[i] < region.high[i]);
        (0..64).filter(|&bit| is_in(self.cell(bit))).fold(0, |bits, bit| bits | 1 << bit)
    }
}

impl Node {
    fn level(&self) -> u32 {
        if let Self::Inner(inner) = self { inner.level } else { 0 }
    }

    fn code(&self) -> u64 {
        match self {
            Self::Brick(brick) => brick.code,
            Self::Inner(inner) => inner.code,
        }
    }

    /// How many cells are below.
    pub fn cells(&self) -> u64 {
        match self {
            Self::Brick(brick) => u64::from(brick.bits.count_ones()),
            Self::Inner(inner) => inner.cells,
        }
    }

    /// Around the cells below.
    pub fn region(&self) -> Region {
        match self {
            Self::Brick(brick) => brick.region(),
            Self::Inner(inner) => inner.region,
        }
    }

    /// Bytes of this node and those below, as if nothing were shared.
    pub fn memory(&self) -> usize {
        // Two counts beside the node of each Arc.
        let own = size_of::<Self>() + 2 * size_of::<usize>();
        match self {
            Self::Brick(_) => own,
            Self::Inner(inner) => {
                own + size_of_val(&*inner.children) + inner.children.iter().map(|child| child.memory()).sum::<usize>()
            }
        }
    }

    /// Whether a cell is below.
    pub fn has(&self, place: &Brick) -> bool {
        match self {
            Self::Brick(brick) => brick.code == place.code && brick.bits & place.bits != 0,
            Self::Inner(inner) => {
                let fits = (inner.code ^ place.code) >> (3 * inner.level) == 0;
                fits && inner.child(octant(place.code, inner.level)).is_some_and(|child| child.has(place))
            }
        }
    }

    /// All bricks, in the order of their codes.
    pub fn for_each(&self, visit: &mut impl FnMut(&Brick)) {
        match self {
            Self::Brick(brick) => visit(brick),
            Self::Inner(inner) => inner.children.iter().for_each(|child| child.for_each(visit)),
        }
    }
}

impl Inner {
    /// Of children in different octants, at least two, in the order of their codes.
    fn of(level: u32, children: Vec<Arc<Node>>) -> Arc<Node> {
        let first = &children[0];
        let mut inner = Self {
            level,
            code: first.code() >> (3 * level) << (3 * level),
            mask: 0,
            cells: 0,
            region: first.region(),
            children: [].into(),
        };
        for child in &children {
            inner.mask |= 1 << octant(child.code(), level);
            inner.cells += child.cells();
            inner.region = inner.region.union(&child.region());
        }
        inner.children = children.into();
        Arc::new(Node::Inner(inner))
    }

    /// The child in an octant.
    pub fn child(&self, octant: u32) -> Option<&Arc<Node>> {
        let before = self.mask & ((1 << octant) - 1);
        (self.mask >> octant & 1 == 1).then(|| &self.children[before.count_ones() as usize])
    }
}

/// Which child of a node of that level a brick is below.
fn octant(code: u64, level: u32) -> u32 {
    (code >> (3 * (level - 1)) & 7) as u32
}

/// The level of the least node that has both bricks below it.
fn level_of_both(one: u64, other: u64) -> u32 {
    (64 - (one ^ other).leading_zeros()).div_ceil(3)
}

/// The tree of bricks that are in the order of their codes, each code once; at least one.
pub(super) fn build(bricks: &[Brick]) -> Arc<Node> {
    let (first, last) = (bricks[0], bricks[bricks.len() - 1]);
    if bricks.len() == 1 {
        return Arc::new(Node::Brick(first));
    }
    let level = level_of_both(first.code, last.code);
    let of_octants = bricks.chunk_by(|one, other| octant(one.code, level) == octant(other.code, level));
    Inner::of(level, of_octants.map(build).collect())
}

/// What is in either. Nodes of `one` are kept where they have it all.
pub(super) fn union(one: &Arc<Node>, other: &Arc<Node>) -> Arc<Node> {
    if Arc::ptr_eq(one, other) {
        return Arc::clone(one);
    }
    if let (Node::Brick(a), Node::Brick(b)) = (&**one, &**other)
        && a.code == b.code
    {
        let bits = a.bits | b.bits;
        return if bits == a.bits { Arc::clone(one) } else { Arc::new(Node::Brick(Brick { bits, ..*a })) };
    }
    let level = level_of_both(one.code(), other.code()).max(one.level()).max(other.level());
    let (ours, theirs) = (children_at(one, level), children_at(other, level));
    let mut children = Vec::with_capacity(8);
    for wanted in 0..8 {
        let in_octant = |nodes: &[Arc<Node>]| nodes.iter().position(|node| octant(node.code(), level) == wanted);
        match (in_octant(ours), in_octant(theirs)) {
            (Some(a), Some(b)) => children.push(union(&ours[a], &theirs[b])),
            (Some(a), None) => children.push(Arc::clone(&ours[a])),
            (None, Some(b)) => children.push(Arc::clone(&theirs[b])),
            (None, None) => {}
        }
    }
    let is_same = one.level() == level
        && children.len() == ours.len()
        && children.iter().zip(ours).all(|(new, old)| Arc::ptr_eq(new, old));
    if is_same { Arc::clone(one) } else { Inner::of(level, children) }
}

/// The children of a node of that level, or a lower node as the only child of one.
fn children_at(node: &Arc<Node>, level: u32) -> &[Arc<Node>] {
    match &**node {
        Node::Inner(inner) if inner.level == level => &inner.children,
        Node::Inner(_) | Node::Brick(_) => std::slice::from_ref(node),
    }
}

/// What is outside of a region; none where that is nothing. The same node where nothing is inside.
pub(super) fn without(node: &Arc<Node>, region: &Region) -> Option<Arc<Node>> {
    let around = node.region();
    if !region.overlaps(&around) {
        return Some(Arc::clone(node));
    }
    if region.contains(&around) {
        return None;
    }
    match &**node {
        Node::Brick(brick) => {
            let bits = brick.bits & !brick.bits_in(region);
            match bits {
                0 => None,
                _ if bits == brick.bits => Some(Arc::clone(node)),
                _ => Some(Arc::new(Node::Brick(Brick { bits, ..*brick }))),
            }
        }
        Node::Inner(inner) => {
            let left: Vec<Arc<Node>> = inner.children.iter().filter_map(|child| without(child, region)).collect();
            let is_same =
                left.len() == inner.children.len() && left.iter().zip(&inner.children).all(|(a, b)| Arc::ptr_eq(a, b));
            match left.len() {
                0 => None,
                1 => left.into_iter().next(),
                _ if is_same => Some(Arc::clone(node)),
                _ => Some(Inner::of(inner.level, left)),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_cells_are_inverse_to_the_ends_of_the_grid() {
        for cell in [[0, 0, 0], [-1, -1, -1], [5, -7, 1234], [REACH - 1, -REACH, 3], [-REACH, REACH - 1, REACH - 1]] {
            let place = place(cell);
            assert_eq!(place.bits.count_ones(), 1);
            assert_eq!(place.cell(place.bits.trailing_zeros()), cell);
            assert_eq!(place.region(), Region { low: cell, high: cell.map(|c| c + 1) });
            assert_eq!(place.code >> 63, 0);
        }
    }

    #[test]
    fn what_did_not_change_is_shared() {
        let bricks: Vec<Brick> = (0..1000).map(|code| Brick { code: code * 37, bits: 1 | code << 7 }).collect();
        let all = build(&bricks);
        assert!(Arc::ptr_eq(&union(&all, &build(&bricks[3..40])), &all), "nothing new");
        let nowhere = Region { low: [REACH - 9; 3], high: [REACH; 3] };
        assert!(Arc::ptr_eq(&without(&all, &nowhere).unwrap(), &all), "nothing there");
        let more = union(&all, &build(&[Brick { code: 1, bits: 1 }]));
        let (Node::Inner(old), Node::Inner(new)) = (&*all, &*more) else { panic!("{all:?}") };
        let shared = old.children.iter().zip(&new.children).filter(|(a, b)| Arc::ptr_eq(a, b)).count();
        assert_eq!(shared, old.children.len() - 1);
    }
}
