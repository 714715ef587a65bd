//! Which entries meet each other: within one tree, or between two.
//!
//! Two subtrees go down together, lane against lane, as long as their bounds meet. Of two leaves only the entries that
//! meet the other leaf's bound are held against each other. The recursion is no deeper than the two trees together.

use std::ops::ControlFlow;

use super::node::{Inner, Kid, Leaf, lanes_of};
use super::traverse::TraversalStats;
use super::tree::DynamicTree;
use super::volume::BoundingVolume;

impl<V: BoundingVolume> DynamicTree<V> {
    /// Calls `visit` once for every unordered pair of entries whose volumes have a point in common, the lower number
    /// first, until it breaks.
    pub fn self_pairs(&self, mut visit: impl FnMut(u64, u64) -> ControlFlow<()>) -> TraversalStats {
        let tree = self.settled();
        let mut walk = Walk { stats: TraversalStats::default(), visit: |a: u64, b: u64| visit(a.min(b), a.max(b)) };
        if let Some(root) = &tree.root {
            let _ = walk.within(root);
        }
        walk.stats
    }

    /// Calls `visit` for every entry of this tree and every one of `other` whose volumes have a point in common, this
    /// tree's number first, until it breaks.
    pub fn pairs_with(&self, other: &Self, visit: impl FnMut(u64, u64) -> ControlFlow<()>) -> TraversalStats {
        let (tree, other) = (self.settled(), other.settled());
        let mut walk = Walk { stats: TraversalStats::default(), visit };
        if let (Some(a), Some(b)) = (&tree.root, &other.root) {
            let (bound_a, bound_b) = (a.bound(), b.bound());
            let _ = walk.between(a, &bound_a, b, &bound_b);
        }
        walk.stats
    }
}

struct Walk<F> {
    stats: TraversalStats,
    visit: F,
}

impl<F: FnMut(u64, u64) -> ControlFlow<()>> Walk<F> {
    /// Pairs within one subtree.
    fn within<V: BoundingVolume>(&mut self, kid: &Kid<V>) -> ControlFlow<()> {
        self.stats.nodes += 1;
        let inner = match kid {
            Kid::Leaf(leaf) => return self.within_leaf(leaf),
            Kid::Inner(inner) => inner,
        };
        for (lane, kid) in inner.kids.iter().enumerate() {
            self.within(kid)?;
            let bound = V::get(&inner.lanes, lane);
            let later = !0_u8 << lane << 1;
            let meeting = V::meeting(&inner.lanes, &V::probe_of(&bound)).maybe & later;
            for other in lanes_of(meeting) {
                self.between(kid, &bound, &inner.kids[other], &V::get(&inner.lanes, other))?;
            }
        }
        ControlFlow::Continue(())
    }

    fn within_leaf<V: BoundingVolume>(&mut self, leaf: &Leaf<V>) -> ControlFlow<()> {
        for lane in 0..leaf.entries.len() {
            let meeting = V::meeting(&leaf.lanes, &V::probe_of(&V::get(&leaf.lanes, lane)));
            let later = !0_u8 << lane << 1;
            for other in lanes_of(meeting.maybe & later) {
                self.report(leaf, lane, leaf, other, meeting.surely >> other & 1 != 0)?;
            }
        }
        ControlFlow::Continue(())
    }

    /// Pairs of one entry from each of two subtrees whose bounds meet.
    fn between<V: BoundingVolume>(
        &mut self,
        a: &Kid<V>,
        bound_a: &V::Bound,
        b: &Kid<V>,
        bound_b: &V::Bound,
    ) -> ControlFlow<()> {
        match (a, b) {
            (Kid::Leaf(a), Kid::Leaf(b)) => self.between_leaves(a, b, bound_b),
            (Kid::Inner(a), Kid::Inner(b)) => {
                self.stats.nodes += 1;
                for lane in lanes_of(V::meeting(&a.lanes, &V::probe_of(bound_b)).maybe) {
                    let bound = V::get(&a.lanes, lane);
                    for other in lanes_of(V::meeting(&b.lanes, &V::probe_of(&bound)).maybe) {
                        self.between(&a.kids[lane], &bound, &b.kids[other], &V::get(&b.lanes, other))?;
                    }
                }
                ControlFlow::Continue(())
            }
            (Kid::Inner(a), Kid::Leaf(_)) => {
                self.descend(a, bound_b, |walk, kid, bound| walk.between(kid, bound, b, bound_b))
            }
            (Kid::Leaf(_), Kid::Inner(b)) => {
                self.descend(b, bound_a, |walk, kid, bound| walk.between(a, bound_a, kid, bound))
            }
        }
    }

    /// Goes on with the children of a node that meet what lies on the other side.
    fn descend<V: BoundingVolume>(
        &mut self,
        inner: &Inner<V>,
        bound: &V::Bound,
        mut go_on: impl FnMut(&mut Self, &Kid<V>, &V::Bound) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.stats.nodes += 1;
        for lane in lanes_of(V::meeting(&inner.lanes, &V::probe_of(bound)).maybe) {
            go_on(self, &inner.kids[lane], &V::get(&inner.lanes, lane))?;
        }
        ControlFlow::Continue(())
    }

    fn between_leaves<V: BoundingVolume>(&mut self, a: &Leaf<V>, b: &Leaf<V>, bound_b: &V::Bound) -> ControlFlow<()> {
        self.stats.nodes += 1;
        for lane in lanes_of(V::meeting(&a.lanes, &V::probe_of(bound_b)).maybe) {
            let meeting = V::meeting(&b.lanes, &V::probe_of(&V::get(&a.lanes, lane)));
            for other in lanes_of(meeting.maybe) {
                self.report(a, lane, b, other, meeting.surely >> other & 1 != 0)?;
            }
        }
        ControlFlow::Continue(())
    }

    /// Reports an entry of one leaf and one of another whose bounds meet, if they do: surely, or as is to be seen.
    #[inline(always)]
    fn report<V: BoundingVolume>(
        &mut self,
        a: &Leaf<V>,
        lane: usize,
        b: &Leaf<V>,
        other: usize,
        surely: bool,
    ) -> ControlFlow<()> {
        self.stats.leaves += 1;
        if surely || a.volumes[lane].overlaps(&b.volumes[other]) {
            (self.visit)(a.payloads[lane], b.payloads[other])?;
        }
        ControlFlow::Continue(())
    }
}
