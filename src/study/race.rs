//! How long does each way take? Ways run in turn, round after round, so that whatever slows the machine for a while slows
//! all of them.

use std::time::{Duration, Instant};

/// A block of calls takes at least so long where one call takes less: the clock's own cost and step are a hundredth of it.
const BLOCK: Duration = Duration::from_micros(3);

/// What takes longer than this is timed call by call, as it comes.
const LONG: Duration = Duration::from_micros(100);

/// Calls in a block at most.
const MOST_CALLS: u32 = 64;

/// Something that can be done to each of a list of items.
pub(super) struct Way<'a> {
    pub work: Box<dyn FnMut(usize) + 'a>,
    /// How many items it is done to: the first ones.
    pub items: usize,
}

impl<'a> Way<'a> {
    pub fn new(items: usize, work: impl FnMut(usize) + 'a) -> Self {
        Self { work: Box::new(work), items }
    }
}

/// How long a way took for one call, seconds.
#[derive(Clone, Debug, Default)]
pub(super) struct Raced {
    /// Over the items, each by the median over its rounds.
    pub median: f64,
    /// The 99th percentile over the items of the same; of fewer than a hundred the largest.
    pub p99: f64,
    /// The median over the items in each round.
    pub rounds: Vec<f64>,
}

/// How long ways are raced.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounds {
    /// Seconds after which no further round begins.
    pub seconds: f64,
    pub least: usize,
    pub most: usize,
}

/// Races the ways; `advance` is told the part of the time that is over.
pub(super) fn race(ways: &mut [Way], rounds: Rounds, advance: &mut dyn FnMut(f64)) -> Vec<Raced> {
    let begun = Instant::now();
    let calls: Vec<u32> = ways.iter_mut().map(calls_in_a_block).collect();
    let mut times: Vec<Vec<Vec<f64>>> = ways.iter().map(|way| vec![Vec::new(); way.items]).collect();
    for round in 0..rounds.most.max(1) {
        let so_far = begun.elapsed().as_secs_f64();
        if round >= rounds.least.max(1) && so_far * (round + 1) as f64 / round as f64 > rounds.seconds {
            break;
        }
        advance((so_far / rounds.seconds).min(1.0));
        // Another way comes first in each round.
        for turn in 0..ways.len() {
            let index = (turn + round * ways.len() / rounds.most.max(1)) % ways.len();
            let (way, times) = (&mut ways[index], &mut times[index]);
            for item in 0..way.items {
                if calls[index] > 1 {
                    // Not timed: it finds what the way before left in the caches.
                    (way.work)(item);
                }
                let begun = Instant::now();
                (0..calls[index]).for_each(|_| (way.work)(item));
                times[item].push(begun.elapsed().as_secs_f64() / f64::from(calls[index]));
            }
        }
    }
    times.iter().map(|items| raced(items)).collect()
}

/// By the least of a few tries; what takes long takes no block.
fn calls_in_a_block(way: &mut Way) -> u32 {
    let mut longest = Duration::ZERO;
    for item in 0..way.items.min(3) {
        let mut least = Duration::MAX;
        for _ in 0..4 {
            let begun = Instant::now();
            (way.work)(item);
            least = least.min(begun.elapsed());
            if least > LONG {
                return 1;
            }
        }
        longest = longest.max(least);
    }
    (BLOCK.as_secs_f64() / longest.as_secs_f64().max(1e-9)).ceil().clamp(2.0, f64::from(MOST_CALLS)) as u32
}

fn raced(items: &[Vec<f64>]) -> Raced {
    let of_items: Vec<f64> = items.iter().map(|times| quantile(times, 0.5)).collect();
    let count = items.iter().map(Vec::len).min().unwrap_or(0);
    let in_round = |round: usize| quantile(&items.iter().map(|times| times[round]).collect::<Vec<f64>>(), 0.5);
    Raced {
        median: quantile(&of_items, 0.5),
        p99: quantile(&of_items, 0.99),
        rounds: (0..count).map(in_round).collect(),
    }
}

/// The value that this part of all does not exceed; NaN of none.
pub(super) fn quantile(values: &[f64], part: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let index = (part * sorted.len() as f64).ceil() as usize;
    sorted.get(index.saturating_sub(1)).copied().unwrap_or(f64::NAN)
}

/// The ratio of two ways in the same rounds: its median, and the ends of the 95 % interval of order statistics (of few rounds
/// the least and the greatest).
pub(super) fn ratio(one: &Raced, other: &Raced) -> [f64; 3] {
    let mut ratios: Vec<f64> = one.rounds.iter().zip(&other.rounds).map(|(a, b)| a / b).collect();
    ratios.sort_unstable_by(f64::total_cmp);
    let count = ratios.len() as f64;
    let reach = 0.98 * count.sqrt();
    let at = |place: f64| ratios.get((place.max(0.0) as usize).min(ratios.len().saturating_sub(1))).copied();
    let value = |place: f64| at(place).unwrap_or(f64::NAN);
    [value(0.5 * count - reach - 0.5), quantile(&ratios, 0.5), value((0.5 * count + reach).ceil())]
}

/// What the clock alone makes of a block of nothing, and how much equal rounds differ: seconds, and a part.
pub(super) fn noise() -> (f64, f64) {
    let mut sum = 0_u64;
    let mut nothing = [Way::new(50, |item| sum = sum.wrapping_add(std::hint::black_box(item as u64)))];
    let rounds = Rounds { seconds: 0.05, least: 5, most: 20 };
    let clock = race(&mut nothing, rounds, &mut |_| ()).first().map_or(f64::NAN, |raced| raced.median);
    // Some hundred nanoseconds of arithmetic, always the same.
    let work = |_| {
        let mut x = std::hint::black_box(1.0_f64);
        (0..100).for_each(|_| x = std::hint::black_box(x * 0.999 + 0.1));
    };
    let spread = race(&mut [Way::new(20, work)], rounds, &mut |_| ()).first().map_or(f64::NAN, |raced| {
        let middle = quantile(&raced.rounds, 0.5);
        (quantile(&raced.rounds, 0.9) - quantile(&raced.rounds, 0.1)) / middle
    });
    (clock, spread)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_samples() {
        let values: Vec<f64> = (1..=100).rev().map(f64::from).collect();
        assert_eq!([0.5, 0.99, 1.0].map(|part| quantile(&values, part)), [50.0, 99.0, 100.0]);
        assert!(quantile(&[], 0.5).is_nan());
    }

    #[test]
    fn every_way_does_every_item_in_every_round() {
        let counts = std::cell::RefCell::new([0_u32; 2]);
        let work = |way: usize| {
            let counts = &counts;
            move |_| counts.borrow_mut()[way] += 1
        };
        let rounds = Rounds { seconds: 0.0, least: 3, most: 5 };
        let raced = race(&mut [Way::new(2, work(0)), Way::new(4, work(1))], rounds, &mut |_| ());
        assert!(raced.iter().all(|raced| raced.rounds.len() == 3 && raced.median >= 0.0 && raced.p99 >= raced.median));
        let counts = counts.borrow();
        assert!(counts[0] >= 6 && counts[1] >= 12, "{counts:?}");
    }

    #[test]
    fn the_interval_of_a_ratio_is_around_its_median() {
        let of = |rounds: &[f64]| Raced { rounds: rounds.to_vec(), ..Raced::default() };
        let [low, median, high] = ratio(&of(&[1.0, 2.0, 3.0, 4.0, 5.0]), &of(&[1.0; 5]));
        assert!(low <= median && median <= high && median == 3.0, "{low} {median} {high}");
    }
}
