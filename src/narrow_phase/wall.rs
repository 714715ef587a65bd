//! A mesh against a half-space or a plane: down its tree, lowest boxes first.

use super::box_gaps::BOX_ERROR_ULPS;
use super::convex::Convex;
use super::goal::Goal;
use super::least::Least;
use super::outcome::Separation;
use super::pieces::{Piece, mesh_of};
use super::support::radius;
use super::unbounded::{self, Unbounded};
use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::geometry::{Content, Core, MOST_LEVELS, NodeId, Placement, TwinBox, Vec3, length};

/// The least separation of the triangles of a mesh from an unbounded piece.
pub(super) fn walk(a: &Piece, wall: Unbounded, goal: &Goal) -> Option<Separation> {
    let tree = mesh_of(a)?.tree();
    let nodes = tree.nodes();
    let heights = Heights::new(a, &wall);
    let mut least = Least::new(goal);
    let mut waiting = [(f64::NEG_INFINITY, NodeId::ROOT); MOST_LEVELS + 1];
    let mut count = 1;
    while count > 0 {
        count -= 1;
        let (lower, node) = waiting[count];
        // Until one triangle has been looked at none is left out: its corners are the proof from above.
        if least.has_witness() {
            if least.leaves_out(lower) {
                continue;
            }
            if least.must_stop() {
                waiting[..=count].iter().for_each(|(lower, _)| least.put_aside(*lower));
                break;
            }
        }
        match nodes.content(node) {
            Content::Leaf(leaf) => {
                let triangle = Core::Triangle(*tree.corners(leaf));
                let (swept_radius, placement_error) = (a.swept_radius, a.placement_error);
                let convex = Convex { core: &triangle, swept_radius, at: &a.at, placement_error, given: a.given };
                let found = unbounded::separation(convex, wall, &least.goal());
                least.take(Separation { subshape_a: tree.number(leaf), ..found });
            }
            Content::Children(children) => {
                least.cost.nodes += 1;
                let lowers = heights.lower_bounds(nodes.both(children));
                let nearer = usize::from(lowers[1] < lowers[0]);
                for child in [1 - nearer, nearer] {
                    waiting[count] = (lowers[child].max(lower), children[child]);
                    count += 1;
                }
            }
        }
    }
    least.finish()
}

/// Heights of a mesh's boxes over a wall.
struct Heights {
    /// In the mesh's frame.
    up: Vec3,
    /// Of the mesh's origin, metres.
    origin: f64,
    thin: bool,
    /// Rounding and swept radii, metres.
    slack: f64,
}

impl Heights {
    fn new(a: &Piece, wall: &Unbounded) -> Self {
        let (normal, offset) = wall.upright();
        let wall_in_a = Placement::relative(&a.at, wall.at);
        let up = wall_in_a.direction(normal);
        let origin = -up.dot(&wall_in_a.translation) - offset;
        let radii = a.swept_radius + wall.swept_radius;
        let extent = radius(a.shape.core()) + length(wall_in_a.translation) + offset.abs() + radii;
        let slack = BOX_ERROR_ULPS * UNIT_ROUNDOFF * extent + a.placement_error + wall.placement_error + radii;
        Self { up, origin, thin: wall.thin, slack }
    }

    /// Lower bounds of the signed distance of what is in two boxes: their lowest corners, or, where a plane passes between lowest
    /// and highest, the lesser part that sticks through it.
    fn lower_bounds(&self, boxes: &TwinBox) -> [f64; 2] {
        [0, 1].map(|lane| {
            let b = boxes.lane(lane);
            let height = self.up.dot(&b.center) + self.origin;
            let half = b.axes.tr_mul(&self.up).abs().dot(&b.half_extents);
            let (low, high) = (height - half, height + half);
            (if self.thin { low.max(-high) } else { low }) - self.slack
        })
    }
}
