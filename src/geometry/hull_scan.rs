//! The farthest of some points by looking at all of them, several at a time.
//!
//! Coordinates are kept apart (structure of arrays) in blocks of eight: an AVX-512 register, two of AVX2, four of NEON or
//! SSE2. Which of them the processor has is found out at run time by the `pulp` crate; the same expression is evaluated for
//! every point whatever the registers are, so the answer is the same bytes everywhere.

use pulp::{Arch, NullaryFnOnce};

use super::{CornerSums, CornerWeights, Vec3};

/// Points that are looked at together.
const LANES: usize = 8;

/// From this many points on the widest registers pay for the jump to the code that uses them.
const DISPATCHED: usize = 24;

/// Points, coordinate by coordinate, filled up to whole blocks with copies of the first, which are never the answer: of equals
/// it is the first.
#[derive(Clone, Debug)]
pub(super) struct Scan {
    blocks: Vec<[[f64; LANES]; 3]>,
    arch: Arch,
}

impl Scan {
    /// Bytes on the heap.
    pub fn memory(&self) -> usize {
        size_of_val(&*self.blocks)
    }

    pub fn new(points: &[Vec3]) -> Self {
        let block = |chunk: &[Vec3]| {
            [0, 1, 2].map(|axis| std::array::from_fn(|lane| chunk.get(lane).unwrap_or(&points[0])[axis]))
        };
        Self { blocks: points.chunks(LANES).map(block).collect(), arch: arch() }
    }

    /// Index of the point where `direction . x` is greatest; among equals the first.
    pub fn farthest(&self, direction: Vec3) -> usize {
        if self.blocks.len() * LANES < DISPATCHED {
            farthest(&self.blocks, direction)
        } else {
            self.arch.dispatch(Task { blocks: &self.blocks, direction })
        }
    }

    /// The same, where all points are in one block; none where not.
    #[inline]
    pub fn farthest_of_few(&self, direction: Vec3) -> Option<usize> {
        let [block] = self.blocks.as_slice() else { return None };
        let values = products(block, direction);
        Some(first_equal(&values, greatest(&values)).unwrap_or(0))
    }

    /// Weighted sums over the first `count` points, which are all of them.
    pub fn weighted(&self, weights: &CornerWeights, count: usize) -> CornerSums {
        weights.sums(&self.blocks, count, self.arch)
    }
}

/// The work as a value: a closure would be compiled on its own, for the narrowest registers.
struct Task<'a> {
    blocks: &'a [[[f64; LANES]; 3]],
    direction: Vec3,
}

impl NullaryFnOnce for Task<'_> {
    type Output = usize;

    #[inline(always)]
    fn call(self) -> usize {
        farthest(self.blocks, self.direction)
    }
}

/// What the processor has. A build with `CLEARANCE_SCALAR` set does without: `benches/instructions` compares the two.
fn arch() -> Arch {
    if option_env!("CLEARANCE_SCALAR").is_some() { Arch::Scalar } else { Arch::new() }
}

/// First the greatest value, lane by lane and without branches; then the first point that has it, found by evaluating the
/// same expression again.
#[inline(always)]
fn farthest(blocks: &[[[f64; LANES]; 3]], direction: Vec3) -> usize {
    let mut of_lanes = [f64::NEG_INFINITY; LANES];
    for block in blocks {
        let values = products(block, direction);
        for lane in 0..LANES {
            of_lanes[lane] = greater(of_lanes[lane], values[lane]);
        }
    }
    let greatest = greatest(&of_lanes);
    for (b, block) in blocks.iter().enumerate() {
        if let Some(lane) = first_equal(&products(block, direction), greatest) {
            return b * LANES + lane;
        }
    }
    0 // The direction has a component that is not a number.
}

#[inline(always)]
fn products(block: &[[f64; LANES]; 3], d: Vec3) -> [f64; LANES] {
    let mut products = [0.0; LANES];
    for lane in 0..LANES {
        products[lane] = block[0][lane] * d.x + block[1][lane] * d.y + block[2][lane] * d.z;
    }
    products
}

/// In pairs, which registers of any width can do together.
#[inline(always)]
fn greatest(v: &[f64; LANES]) -> f64 {
    let mut half = [0.0; LANES / 2];
    for lane in 0..LANES / 2 {
        half[lane] = greater(v[lane], v[lane + LANES / 2]);
    }
    greater(greater(half[0], half[2]), greater(half[1], half[3]))
}

/// One instruction, other than `f64::max`, which has an opinion about what is not a number.
#[inline(always)]
fn greater(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

#[inline(always)]
fn first_equal(values: &[f64; LANES], value: f64) -> Option<usize> {
    let mut equals = 0u32;
    for lane in 0..LANES {
        equals |= u32::from(values[lane] == value) << lane;
    }
    (equals != 0).then(|| equals.trailing_zeros() as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_set_of_registers_finds_the_same_point() {
        let coordinate = |i: usize, k: usize| ((i * 73 + k * 31) % 101) as f64 / 7.0;
        let points: Vec<Vec3> =
            (0..45).map(|i| Vec3::new(coordinate(i, 1), coordinate(i, 2), coordinate(i, 3))).collect();
        let scan = Scan::new(&points);
        for k in 0..200 {
            let d = Vec3::new(libm::sin(k as f64), libm::cos(1.3 * k as f64), libm::sin(0.7 * k as f64 + 1.0));
            let plain = farthest(&scan.blocks, d);
            let value = |i: usize| points[i].x * d.x + points[i].y * d.y + points[i].z * d.z;
            assert_eq!((0..45).find(|&i| (0..45).all(|j| value(j) <= value(i))), Some(plain));
            for dispatched in [scan.farthest(d), scan.arch.dispatch(Task { blocks: &scan.blocks, direction: d })] {
                assert_eq!(dispatched, plain);
            }
        }
    }
}
