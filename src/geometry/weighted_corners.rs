//! How high are a hull's corners, and how do they spread when each weighs an exponential of its height?
//!
//! Several corners at a time, as in `hull_scan`: lanes are the same whatever the registers are, and nothing is contracted to a fused product, so
//! sums are the same bytes everywhere. The exponential is our own, as that of a library takes one number: `exp(x) = 2^k exp(r)`, k the whole
//! number nearest to x / ln 2, so |r| <= ln(2) / 2, and a polynomial of Taylor's to the eleventh power, which is off by r^12 / 12! < 1e-14.

use pulp::{Arch, NullaryFnOnce};

use super::Vec3;

/// Corners that are looked at together.
const LANES: usize = 8;

/// Coordinates of as many corners, kept apart.
type Block = [[f64; LANES]; 3];

/// Sums over those corners whose weight is worth it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CornerSums {
    /// How many they are.
    pub kept: usize,
    /// Of the weights.
    pub weight: f64,
    /// Weighted, of x, y, xx, xy, yy, from the top; metres and square metres.
    pub moments: [f64; 5],
}

/// What corners are weighed by: `exp((height - that of the top) / temperature)`.
#[derive(Clone, Copy, Debug)]
pub struct CornerWeights {
    /// Across the direction, and the direction.
    pub axes: [Vec3; 3],
    /// The highest corner.
    pub top: Vec3,
    /// Metres; the direction's axis and heights, divided by it, are finite.
    pub temperature: f64,
    /// Corners whose exponent is less are left out; at least -700.
    pub lowest: f64,
}

impl CornerWeights {
    /// Over the first `count` corners of some blocks.
    pub(super) fn sums(&self, blocks: &[Block], count: usize, arch: Arch) -> CornerSums {
        arch.dispatch(Task { weights: self, blocks, count })
    }
}

/// The work as a value: a closure would be compiled on its own, for the narrowest registers.
struct Task<'a> {
    weights: &'a CornerWeights,
    blocks: &'a [Block],
    count: usize,
}

impl NullaryFnOnce for Task<'_> {
    type Output = CornerSums;

    #[inline(always)]
    fn call(self) -> CornerSums {
        let (mut kept, mut weight, mut moments) = ([0.0; LANES], [0.0; LANES], [[0.0; LANES]; 5]);
        let [along_x, along_y, up] = self.weights.axes;
        let (top, lowest) = (self.weights.top, self.weights.lowest);
        let up = up / self.weights.temperature;
        for (b, block) in self.blocks.iter().enumerate() {
            let left = self.count - b * LANES;
            let (mut x, mut y, mut exponent) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
            for lane in 0..LANES {
                let (p, q, r) = (block[0][lane] - top.x, block[1][lane] - top.y, block[2][lane] - top.z);
                x[lane] = along_x.x * p + along_x.y * q + along_x.z * r;
                y[lane] = along_y.x * p + along_y.y * q + along_y.z * r;
                exponent[lane] = up.x * p + up.y * q + up.z * r;
            }
            let exponentials = exponentials(&exponent);
            for lane in 0..LANES {
                // The negation keeps what is no number, so that nothing hides it.
                let is_kept = !(exponent[lane] < lowest) && lane < left;
                let w = if is_kept { exponentials[lane] } else { 0.0 };
                kept[lane] += if is_kept { 1.0 } else { 0.0 };
                weight[lane] += w;
                let (wx, wy) = (w * x[lane], w * y[lane]);
                moments[0][lane] += wx;
                moments[1][lane] += wy;
                moments[2][lane] += wx * x[lane];
                moments[3][lane] += wx * y[lane];
                moments[4][lane] += wy * y[lane];
            }
        }
        CornerSums { kept: sum(&kept) as usize, weight: sum(&weight), moments: moments.map(|of_lanes| sum(&of_lanes)) }
    }
}

/// In pairs.
#[inline(always)]
fn sum(v: &[f64; LANES]) -> f64 {
    ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]))
}

/// The bits of a number of this size count ones.
const ONES: f64 = 6_755_399_441_055_744.0;

/// ln 2 in two parts; k times the first is exact.
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];

/// 1/0! to 1/11!.
const TAYLOR: [f64; 12] = [
    1.0,
    1.0,
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
];

/// Of numbers up to a few; those below -700 are taken for that.
#[inline(always)]
fn exponentials(x: &[f64; LANES]) -> [f64; LANES] {
    let mut all = [0.0; LANES];
    for lane in 0..LANES {
        let x = if x[lane] < -700.0 { -700.0 } else { x[lane] };
        let shifted = x * std::f64::consts::LOG2_E + ONES;
        let k = shifted - ONES;
        let r = (x - k * LN_2[0]) - k * LN_2[1];
        let mut polynomial = TAYLOR[11];
        for power in (0..11).rev() {
            polynomial = polynomial * r + TAYLOR[power];
        }
        // The last bits of `shifted` are k; with the bias added they are the exponent's.
        all[lane] = polynomial * f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the library's exponential.
    #[test]
    fn the_exponential_is_exact_to_fourteen_digits() {
        for n in 0..10_000 {
            let x = 1e-12 - f64::from(n) * 0.07;
            let [one, ..] = exponentials(&[x; LANES]);
            let relative = one / libm::exp(x) - 1.0;
            assert!(x < -700.0 || relative.abs() < 2e-14, "exp({x}) is off by {relative:e}");
        }
        assert_eq!(exponentials(&[0.0; LANES]), [1.0; LANES]);
        assert!(exponentials(&[f64::NAN; LANES])[0].is_nan());
        assert!(exponentials(&[f64::NEG_INFINITY; LANES])[0] < 1e-300);
    }

    /// Oracle: the sums written out, one corner after the other.
    #[test]
    fn sums_are_those_of_all_corners_one_by_one_and_of_no_padding() {
        let corners: Vec<Vec3> = (0..13)
            .map(|n| Vec3::new(libm::sin(f64::from(n)), libm::cos(1.3 * f64::from(n)), f64::from(n) / -20.0))
            .collect();
        let block = |chunk: &[Vec3]| {
            [0, 1, 2].map(|axis| std::array::from_fn(|lane| chunk.get(lane).unwrap_or(&corners[0])[axis]))
        };
        let blocks: Vec<Block> = corners.chunks(LANES).map(block).collect();
        let axes = [Vec3::y(), -Vec3::x(), Vec3::z()];
        let weights = CornerWeights { axes, top: corners[0], temperature: 0.1, lowest: -5.2 };
        let told = weights.sums(&blocks, corners.len(), Arch::new());
        let mut expected = CornerSums::default();
        for p in corners.iter().map(|p| p - corners[0]).filter(|p| p.z / 0.1 >= -5.2) {
            let (w, x, y) = (libm::exp(p.z / 0.1), p.y, -p.x);
            expected.kept += 1;
            expected.weight += w;
            for (sum, product) in expected.moments.iter_mut().zip([x, y, x * x, x * y, y * y]) {
                *sum += w * product;
            }
        }
        assert_eq!((told.kept, expected.kept), (11, 11));
        assert!((told.weight - expected.weight).abs() < 1e-13);
        for (one, other) in told.moments.into_iter().zip(expected.moments) {
            assert!((one - other).abs() < 1e-13);
        }
        assert_eq!(weights.sums(&blocks, corners.len(), Arch::Scalar), told);
    }
}
