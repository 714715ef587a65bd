//! Shapes made of many convex pieces: meshes, clouds, terrain, compounds, and whatever stands against them.
//!
//! The signed distance is the minimum over pairs of pieces. Everything is in the first shape's frame, so that a pair far
//! from the origin is as accurate as one near it. What boxes prove to be farther than the answer is not looked at, so the
//! bracket of the minimum is the minimum of the brackets.

use super::goal::Goal;
use super::least::Least;
use super::outcome::Separation;
use super::pieces::{Pieces, least_of_pieces, simple_pair};
use super::solid::with_containment;
use super::trees::has_tree;
use super::walk::walk;

/// The least over all pairs of pieces, as far as the goal needs it; none for a pair of unbounded pieces.
pub(super) fn separation(a: &Pieces, b: &Pieces, goal: &Goal) -> Option<Separation> {
    let mut least = Least::new(goal);
    for pa in a.iter() {
        for pb in b.iter() {
            // Until one pair has been looked at none is left out: its witness is the proof from above.
            if least.has_witness() {
                let lower = least_of_pieces(&pa, &pb);
                if least.leaves_out(lower) {
                    continue;
                }
                if least.must_stop() {
                    least.put_aside(lower);
                    continue;
                }
            }
            let asked = least.goal();
            let surfaces =
                if has_tree(&pa) || has_tree(&pb) { walk(&pa, &pb, &asked) } else { simple_pair(&pa, &pb, &asked) };
            let Some(found) = surfaces.map(|surfaces| with_containment(surfaces, &pa, &pb, goal)) else { continue };
            // Of a compound the part is named, of a lone mesh the triangle, of terrain the column, of a cloud the point.
            let name = |pieces: &Pieces, part, subshape| if pieces.len() > 1 { part } else { subshape };
            let (subshape_a, subshape_b) = (name(a, pa.part, found.subshape_a), name(b, pb.part, found.subshape_b));
            least.take(Separation { subshape_a, subshape_b, ..found });
        }
    }
    least.finish()
}
