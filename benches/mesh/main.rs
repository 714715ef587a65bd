//! Which bounding volumes should the tree of a mesh be made of? The same trees of boxes along axes, turned boxes, swept rectangles and
//! polytopes of fixed directions, walked in the same way over the same pairs; and last the library's own walk.
//!
//! Two bumpy balls of 5 000 and of 20 000 triangles: 0.5 to 2 apart, 1 to 10 mm apart, or overlapping by 0.1 to 0.5 along
//! the line in which they are slid. Each pair in turn, so that caches are cold; medians of the pairs' medians of five
//! rounds. `cargo bench --no-default-features --bench mesh`, about two minutes; the table is in `docs/meshes.md`.

mod bodies;
mod volumes;
mod walk;

use std::time::Instant;

use bodies::{Bodies, Pair};
use clearance::narrow_phase::{Depth, Goal, Within, separation, touching_pairs};
use volumes::{Box6, Box15, BoxNear, Dop18, Rss, Upright, Volume};
use walk::{Counts, Tree, distance, touch};

fn main() {
    println!(
        "| volumes | set | question | box pairs | triangle pairs | median, us |\n| --- | --- | --- | --- | --- | --- |"
    );
    for (name, rings) in [("5k", 51), ("20k", 101)] {
        let bodies = Bodies::new(rings);
        of_volume::<Upright>(name, &bodies);
        of_volume::<Dop18>(name, &bodies);
        of_volume::<Rss>(name, &bodies);
        of_volume::<Box6>(name, &bodies);
        of_volume::<Box15>(name, &bodies);
        of_volume::<BoxNear>(name, &bodies);
        of_library(name, &bodies);
    }
}

/// Medians and means over the pairs of a set.
fn measure(
    who: &str,
    size: &str,
    set: &str,
    question: &str,
    pairs: &[Pair],
    mut ask: impl FnMut(&Pair) -> (Counts, f64),
) {
    let mut times = vec![Vec::new(); pairs.len()];
    let mut sum = Counts::default();
    for round in 0..5 {
        for (pair, times) in pairs.iter().zip(&mut times) {
            let (counts, micros) = ask(pair);
            times.push(micros);
            if round == 0 {
                sum.boxes += counts.boxes;
                sum.triangles += counts.triangles;
            }
        }
    }
    let median = |values: &mut Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let mut medians: Vec<f64> = times.iter_mut().map(median).collect();
    let (n, micros) = (pairs.len() as u64, median(&mut medians));
    println!("| {who} | {size} {set} | {question} | {} | {} | {micros:.1} |", sum.boxes / n, sum.triangles / n);
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = work();
    (result, start.elapsed().as_secs_f64() * 1e6)
}

fn of_volume<V: Volume>(size: &str, bodies: &Bodies) {
    let trees = bodies.triangles.each_ref().map(|triangles| Tree::<V>::new(triangles));
    for (set, pairs) in &bodies.sets {
        for question in ["distance", "touch"] {
            measure(V::NAME, size, set, question, pairs, |pair| {
                // What a kind of volume works out once for a pair is left out of its time.
                let context = V::context(&pair.b_in_a());
                let [a, b] = &trees;
                timed(|| if question == "touch" { touch(a, b, pair, &context) } else { distance(a, b, pair, &context) })
            });
        }
    }
}

fn of_library(size: &str, bodies: &Bodies) {
    let [a, b] = &bodies.shapes;
    let mut found = Vec::new();
    for (set, pairs) in &bodies.sets {
        for (question, depth) in [("distance", Depth::Distance), ("touch", Depth::Verdict)] {
            let goal = Goal { depth, ..Goal::penetration() };
            measure("clearance", size, set, question, pairs, |pair| {
                let (answer, micros) = timed(|| separation(a, b, &pair.at_a, &pair.at_b, &goal));
                let cost = answer.expect("two meshes").cost;
                (Counts { boxes: 2 * cost.nodes, triangles: cost.pairs }, micros)
            });
        }
        if *set == "over" {
            measure("clearance", size, set, "all that touch", pairs, |pair| {
                let (end, micros) =
                    timed(|| touching_pairs(a, b, &pair.at_a, &pair.at_b, &Within::contact(), &mut found));
                let cost = end.expect("two meshes").cost;
                (Counts { boxes: 2 * cost.nodes, triangles: cost.pairs }, micros)
            });
        }
    }
}
