//! obvhs (single precision) and rstar (double) as contenders: `other_trees obvhs`, `other_trees rstar`.

use std::env;
use std::error::Error;
use std::io;

use clearance_peers::trees::{BoxRecord, Counted, RayRecord, Trees, serve};
use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use obvhs::ray::{Ray, RayHit};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

#[global_allocator]
static ALLOCATOR: Counted = Counted;

/// A tree by PLOC; every leaf holds one box.
///
///   refit     boxes change in place and those above them grow and shrink: the tree is not repaired
///   move      each box gets a new place; where all move, as `refit`
///
/// It has no walk of a tree against itself: pairs are found by a query for each box.
struct Obvhs;

impl Trees for Obvhs {
    type Bounds = Aabb;
    type Ray = Ray;
    type Tree = Bvh2;

    fn configs(operation: &str, _boxes: usize) -> &'static [&'static str] {
        match operation {
            "build" => &["ploc"],
            "publish" => &["move"],
            _ => &["refit", "move"],
        }
    }

    fn bounds(record: &BoxRecord) -> Aabb {
        let [a, b, c, d, e, f] = record.map(|number| number as f32);
        Aabb { min: Vec3A::new(a, b, c), max: Vec3A::new(d, e, f) }
    }

    fn ray(record: &RayRecord) -> Ray {
        let [x, y, z, dx, dy, dz, length] = record.map(|number| number as f32);
        Ray::new(Vec3A::new(x, y, z), Vec3A::new(dx, dy, dz), 0.0, length)
    }

    fn build(config: &str, boxes: &[Aabb]) -> Bvh2 {
        let indices = (0..boxes.len() as u32).collect();
        let mut builder = PlocBuilder::with_capacity(boxes.len());
        let mut tree = builder.build(PlocSearchDistance::Minimum, boxes, indices, SortPrecision::U64, 0);
        if config != "ploc" {
            // What changing it needs, and asking it does not.
            tree.init_primitives_to_nodes_if_uninit();
            tree.init_parents_if_uninit();
        }
        tree
    }

    fn apply(config: &str, tree: &mut Bvh2, moves: &[(u32, Aabb)]) {
        if moves.len() == tree.active_primitive_indices_count() {
            for (index, bounds) in moves {
                let node = tree.primitives_to_nodes[*index as usize] as usize;
                tree.nodes[node].set_aabb(*bounds);
            }
            tree.refit_all();
        } else if config == "move" {
            for (index, bounds) in moves {
                tree.move_primitive(*bounds, *index);
            }
        } else {
            for (index, bounds) in moves {
                let node = tree.primitives_to_nodes[*index as usize] as usize;
                tree.resize_node(node, *bounds);
            }
        }
    }

    fn pairs(tree: &mut Bvh2, boxes: &[Aabb], mut visit: impl FnMut(u32, u32)) {
        for (one, bounds) in (0..).zip(boxes) {
            tree.aabb_traverse(*bounds, |tree, node| {
                let other = tree.primitive_indices[tree.nodes[node as usize].first_index as usize];
                if other > one {
                    visit(one, other);
                }
                true
            });
        }
    }

    fn query(tree: &Bvh2, query: &Aabb) -> usize {
        let mut found = 0;
        tree.aabb_traverse(*query, |_, _| {
            found += 1;
            true
        });
        found
    }

    fn first_hit(tree: &Bvh2, boxes: &[Aabb], ray: &Ray) -> f64 {
        let mut hit = RayHit::none();
        let meets = tree.ray_traverse(*ray, &mut hit, |ray, i| {
            // It tells where the line enters, which is behind a ray that begins inside.
            boxes[tree.primitive_indices[i] as usize].intersect_ray(ray).max(0.0)
        });
        if meets { f64::from(hit.t) } else { f64::INFINITY }
    }

    fn publish(_config: &str, tree: &mut Bvh2, index: u32, bounds: Aabb) {
        let mut next = tree.clone();
        next.move_primitive(bounds, index);
        *tree = next;
    }
}

/// An R*-tree: a box that moves is removed and inserted, and the tree is loaded anew where all move.
struct Rstar;

type Entry = GeomWithData<Rectangle<[f64; 3]>, u32>;

struct Kept {
    tree: RTree<Entry>,
    /// Where each box is: what is removed is found by it.
    boxes: Vec<AABB<[f64; 3]>>,
}

fn entry(index: u32, bounds: AABB<[f64; 3]>) -> Entry {
    GeomWithData::new(bounds.into(), index)
}

impl Trees for Rstar {
    type Bounds = AABB<[f64; 3]>;
    type Ray = ();
    type Tree = Kept;

    fn configs(operation: &str, _boxes: usize) -> &'static [&'static str] {
        match operation {
            "ray" => &[],
            _ => &["default"],
        }
    }

    fn bounds(record: &BoxRecord) -> Self::Bounds {
        let [a, b, c, d, e, f] = *record;
        AABB::from_corners([a, b, c], [d, e, f])
    }

    fn ray(_record: &RayRecord) {}

    fn build(_config: &str, boxes: &[Self::Bounds]) -> Kept {
        let entries = (0..).zip(boxes).map(|(i, bounds)| entry(i, *bounds)).collect();
        Kept { tree: RTree::bulk_load(entries), boxes: boxes.to_vec() }
    }

    fn apply(config: &str, kept: &mut Kept, moves: &[(u32, Self::Bounds)]) {
        if moves.len() == kept.boxes.len() {
            moves.iter().for_each(|(index, bounds)| kept.boxes[*index as usize] = *bounds);
            *kept = Self::build(config, &kept.boxes);
            return;
        }
        for (index, bounds) in moves {
            let place = &mut kept.boxes[*index as usize];
            kept.tree.remove(&entry(*index, *place)).expect("the entry is where it was put");
            *place = *bounds;
            kept.tree.insert(entry(*index, *bounds));
        }
    }

    fn pairs(kept: &mut Kept, boxes: &[Self::Bounds], mut visit: impl FnMut(u32, u32)) {
        for (one, bounds) in (0..).zip(boxes) {
            for other in kept.tree.locate_in_envelope_intersecting(*bounds) {
                if other.data > one {
                    visit(one, other.data);
                }
            }
        }
    }

    fn query(kept: &Kept, query: &Self::Bounds) -> usize {
        kept.tree.locate_in_envelope_intersecting(*query).count()
    }

    fn first_hit(_kept: &Kept, _boxes: &[Self::Bounds], (): &()) -> f64 {
        f64::NAN
    }

    fn publish(config: &str, kept: &mut Kept, index: u32, bounds: Self::Bounds) {
        let mut next = Kept { tree: kept.tree.clone(), boxes: kept.boxes.clone() };
        Self::apply(config, &mut next, &[(index, bounds)]);
        *kept = next;
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let serve: fn() -> io::Result<()> = match env::args().nth(1).as_deref() {
        Some("obvhs") => serve::<Obvhs>,
        Some("rstar") => serve::<Rstar>,
        _ => return Err("usage: other_trees obvhs|rstar".into()),
    };
    Ok(serve()?)
}
