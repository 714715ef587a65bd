//! The dynamic tree of `clearance` as a contender, through its public API.
//!
//!   in_place      changes are made to the only version there is
//!   published     a reader holds the version before while the next is made; it is dropped once the next is published

use std::io;
use std::ops::ControlFlow;

use clearance::broad_phase::{DynamicTree, ProxyId};
use clearance::geometry::{Aabb, BoxCast, Vec3};
use clearance_peers::trees::{BoxRecord, Counted, RayRecord, Trees, serve};

#[global_allocator]
static ALLOCATOR: Counted = Counted;

struct Ours;

struct Kept {
    tree: DynamicTree,
    /// The entry of each box.
    entries: Vec<ProxyId>,
    /// What readers have.
    published: Option<DynamicTree>,
}

impl Kept {
    fn publish(&mut self) {
        let before = self.published.replace(self.tree.clone());
        drop(before);
    }
}

impl Trees for Ours {
    type Bounds = Aabb;
    type Ray = (BoxCast, f64);
    type Tree = Kept;

    fn configs(operation: &str, _boxes: usize) -> &'static [&'static str] {
        match operation {
            "build" => &["in_place"],
            "moves" => &["in_place", "published"],
            _ => &["published"],
        }
    }

    fn bounds(record: &BoxRecord) -> Aabb {
        let [a, b, c, d, e, f] = *record;
        Aabb { min: Vec3::new(a, b, c), max: Vec3::new(d, e, f) }
    }

    fn ray(record: &RayRecord) -> (BoxCast, f64) {
        let [x, y, z, dx, dy, dz, length] = *record;
        let start = Aabb::around([Vec3::new(x, y, z)]);
        (BoxCast { start, motion: Vec3::new(dx, dy, dz) * length }, length)
    }

    fn build(config: &str, boxes: &[Aabb]) -> Kept {
        let (tree, entries) = DynamicTree::build(boxes.len(), |i| (boxes[i], i as u64));
        let published = (config == "published").then(|| tree.clone());
        Kept { tree, entries, published }
    }

    fn apply(config: &str, kept: &mut Kept, moves: &[(u32, Aabb)]) {
        for (index, bounds) in moves {
            kept.tree.move_to(kept.entries[*index as usize], *bounds);
        }
        kept.tree.settle();
        if config == "published" {
            kept.publish();
        }
    }

    fn pairs(kept: &mut Kept, _boxes: &[Aabb], mut visit: impl FnMut(u32, u32)) {
        kept.tree.self_pairs(|a, b| {
            visit(a as u32, b as u32);
            ControlFlow::Continue(())
        });
    }

    fn query(kept: &Kept, query: &Aabb) -> usize {
        let mut found = 0;
        kept.tree.overlap(query, |_| {
            found += 1;
            ControlFlow::Continue(())
        });
        found
    }

    fn first_hit(kept: &Kept, _boxes: &[Aabb], (cast, length): &(BoxCast, f64)) -> f64 {
        let mut first = f64::INFINITY;
        kept.tree.cast(cast, 1.0, |_, fraction| {
            first = first.min(fraction);
            first
        });
        first * length
    }

    fn publish(_config: &str, kept: &mut Kept, index: u32, bounds: Aabb) {
        kept.tree.move_to(kept.entries[index as usize], bounds);
        kept.tree.settle();
        kept.publish();
    }
}

fn main() -> io::Result<()> {
    serve::<Ours>()
}
