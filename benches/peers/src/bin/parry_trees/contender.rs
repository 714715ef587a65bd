//! parry's `Bvh`. A configuration is words joined by "/":
//!
//!   binned, ploc        how it is built
//!   refit               boxes change in place, those above them are refitted, and the tree is optimised a little
//!   reinsert            each box gets a new place; where all move, as `refit`: parry advises one for few, one for many

use clearance_peers::trees::{BoxRecord, RayRecord, Trees};

use super::parry::bounding_volume::Aabb;
use super::parry::math::{Real, Vector};
use super::parry::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use super::parry::query::{Ray, RayCast};

pub struct Parry;

pub struct Kept {
    tree: Bvh,
    workspace: BvhWorkspace,
}

fn vector(numbers: [f64; 3]) -> Vector {
    let [x, y, z] = numbers.map(|number| number as Real);
    Vector::new(x, y, z)
}

impl Trees for Parry {
    type Bounds = Aabb;
    type Ray = (Ray, Real);
    type Tree = Kept;

    fn configs(operation: &str, _boxes: usize) -> &'static [&'static str] {
        match operation {
            "build" => &["binned", "ploc"],
            "publish" => &["binned/reinsert"],
            _ => &["binned/reinsert", "binned/refit", "ploc/reinsert", "ploc/refit"],
        }
    }

    fn bounds(record: &BoxRecord) -> Aabb {
        let [a, b, c, d, e, f] = *record;
        Aabb::new(vector([a, b, c]), vector([d, e, f]))
    }

    fn ray(record: &RayRecord) -> (Ray, Real) {
        let [x, y, z, dx, dy, dz, length] = *record;
        (Ray::new(vector([x, y, z]), vector([dx, dy, dz])), length as Real)
    }

    fn build(config: &str, boxes: &[Aabb]) -> Kept {
        let strategy = if config.starts_with("ploc") { BvhBuildStrategy::Ploc } else { BvhBuildStrategy::Binned };
        Kept { tree: Bvh::from_leaves(strategy, boxes), workspace: BvhWorkspace::default() }
    }

    fn apply(config: &str, Kept { tree, workspace }: &mut Kept, moves: &[(u32, Aabb)]) {
        if config.ends_with("reinsert") && moves.len() < tree.leaf_count() as usize {
            for (index, bounds) in moves {
                tree.reinsert_or_update_with_change_detection(*bounds, *index, 0.0);
            }
        } else {
            for (index, bounds) in moves {
                tree.insert_or_update_partially(*bounds, *index, 0.0);
            }
            tree.refit(workspace);
            tree.optimize_incremental(workspace);
        }
    }

    fn pairs(Kept { tree, workspace }: &mut Kept, _boxes: &[Aabb], mut visit: impl FnMut(u32, u32)) {
        tree.traverse_bvtt_single_tree::<false>(workspace, &mut visit);
    }

    fn query(kept: &Kept, query: &Aabb) -> usize {
        kept.tree.intersect_aabb(query).count()
    }

    fn first_hit(kept: &Kept, boxes: &[Aabb], (ray, length): &(Ray, Real)) -> f64 {
        let hit = kept.tree.cast_ray(ray, *length, |i, best| boxes[i as usize].cast_local_ray(ray, best, true));
        hit.map_or(f64::INFINITY, |(_, distance)| f64::from(distance))
    }

    fn publish(_config: &str, kept: &mut Kept, index: u32, bounds: Aabb) {
        let mut next = kept.tree.clone();
        next.reinsert_or_update_with_change_detection(bounds, index, 0.0);
        kept.tree = next;
    }
}
