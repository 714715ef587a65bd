//! Which random number stands at a place? The same seed, stream and place always have the same one.
//!
//! Philox4x32 with ten rounds (Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3", 2011): a bijection of 128 bits
//! under a key of 64, so different counters never share their words, and nothing has to be drawn in order. The seed is the key; the
//! counter is (sample, block, stream). Normal numbers come two at a time by the polar form of the plane (Box and Muller 1958).

use std::f64::consts::TAU;

/// What each round multiplies with, and by what the key grows; from the paper.
const MULTIPLIERS: [u32; 2] = [0xd251_1f53, 0xcd9e_8d57];
const KEY_STEPS: [u32; 2] = [0x9e37_79b9, 0xbb67_ae85];

/// Rounds: the paper's, three more than statistical tests ask for.
const ROUNDS: usize = 10;

/// Numbers of one seed and one stream.
#[derive(Clone, Copy, Debug)]
pub(super) struct CounterRandom {
    key: [u32; 2],
    stream: [u32; 2],
}

impl CounterRandom {
    pub fn new(seed: u64, stream: u64) -> Self {
        Self { key: halves(seed), stream: halves(stream) }
    }

    /// Two independent standard normal numbers.
    pub fn normals(&self, sample: u32, block: u32) -> [f64; 2] {
        let [a, b, c, d] = philox([sample, block, self.stream[0], self.stream[1]], self.key);
        // In (0, 1], so that the logarithm is finite.
        let radius = (-2.0 * libm::log(unit_interval(a, b) + STEP)).sqrt();
        let (sin, cos) = libm::sincos(TAU * unit_interval(c, d));
        [radius * cos, radius * sin]
    }
}

/// The low half, then the high one.
fn halves(word: u64) -> [u32; 2] {
    [word as u32, (word >> 32) as u32]
}

/// Between neighbours in [0, 1).
const STEP: f64 = 1.0 / (1u64 << 53) as f64;

/// In [0, 1), from the upper 53 of 64 bits.
fn unit_interval(low: u32, high: u32) -> f64 {
    ((u64::from(high) << 32 | u64::from(low)) >> 11) as f64 * STEP
}

fn philox(mut counter: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    for _ in 0..ROUNDS {
        let [low_0, high_0] = halves(u64::from(MULTIPLIERS[0]) * u64::from(counter[0]));
        let [low_1, high_1] = halves(u64::from(MULTIPLIERS[1]) * u64::from(counter[2]));
        counter = [high_1 ^ counter[1] ^ key[0], low_1, high_0 ^ counter[3] ^ key[1], low_0];
        key = [key[0].wrapping_add(KEY_STEPS[0]), key[1].wrapping_add(KEY_STEPS[1])];
    }
    counter
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the known answers that come with the authors' own library, Random123.
    #[test]
    fn the_authors_known_answers_come_out() {
        let known = [
            ([0; 4], [0; 2], [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]),
            ([u32::MAX; 4], [u32::MAX; 2], [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]),
            (
                [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344],
                [0xa409_3822, 0x299f_31d0],
                [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1],
            ),
        ];
        for (counter, key, words) in known {
            assert_eq!(philox(counter, key), words);
        }
    }

    /// Oracle: moments of the normal distribution. Of 200 000 numbers the mean of the k-th power is off by its standard error
    /// times a normal number; five of them are exceeded by a right generator once in two million.
    #[test]
    fn moments_are_those_of_the_normal_distribution() {
        let random = CounterRandom::new(7, 3);
        let numbers: Vec<f64> = (0..100_000).flat_map(|sample| random.normals(sample, 0)).collect();
        let count = numbers.len() as f64;
        for (power, mean, variance) in [(1, 0.0, 1.0), (2, 1.0, 2.0), (3, 0.0, 15.0), (4, 3.0, 96.0)] {
            let measured = numbers.iter().map(|z| z.powi(power)).sum::<f64>() / count;
            let errors = (measured - mean) / (variance / count).sqrt();
            assert!(errors.abs() < 5.0, "power {power}: {measured} is {errors} standard errors off");
        }
        let pairs = (0..100_000).map(|sample| random.normals(sample, 0)).map(|[x, y]| x * y).sum::<f64>();
        assert!((pairs / 100_000_f64.sqrt()).abs() < 5.0, "the two of a pair go together: {pairs}");
    }

    #[test]
    fn seed_stream_sample_and_block_all_matter_and_nothing_else_does() {
        let at = |seed, stream, sample, block| CounterRandom::new(seed, stream).normals(sample, block);
        assert_eq!(at(1, 2, 3, 4), at(1, 2, 3, 4));
        let others = [at(1 << 32, 2, 3, 4), at(1, 2 << 32, 3, 4), at(1, 2, 4, 4), at(1, 2, 3, 5), at(2, 1, 3, 4)];
        for other in others {
            assert_ne!(at(1, 2, 3, 4), other);
        }
    }
}
