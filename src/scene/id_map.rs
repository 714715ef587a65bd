//! How is the content of a scene kept in many versions? By a map from ids that clones share.
//!
//! A radix tree of 16-way nodes: a clone is one reference count, and a change copies the nodes on the way to one id,
//! five for the first million ids. Wider nodes would be fewer and found sooner, but a copy has to count a reference to
//! everything the node points to, which is what an edit of a few scattered ids spends its time on. Nodes without entries
//! are dropped: ids that are gone for good cost nothing.

use std::array;
use std::sync::Arc;

const BITS: u32 = 4;
const FANOUT: usize = 1 << BITS;

/// A map from `u64` to `T`, in the order of the keys.
#[derive(Clone, Debug)]
pub(super) struct IdMap<T> {
    root: Option<Arc<Node<T>>>,
    /// Levels of branches above the leaves.
    levels: u32,
    length: usize,
}

#[derive(Clone, Debug)]
enum Node<T> {
    Branch([Option<Arc<Node<T>>>; FANOUT]),
    Leaf([Option<T>; FANOUT]),
}

impl<T: Clone> IdMap<T> {
    pub(super) fn new() -> Self {
        Self { root: None, levels: 0, length: 0 }
    }

    pub(super) fn len(&self) -> usize {
        self.length
    }

    pub(super) fn get(&self, key: u64) -> Option<&T> {
        if !self.reaches(key) {
            return None;
        }
        let mut node = self.root.as_deref()?;
        let mut level = self.levels;
        loop {
            match node {
                Node::Branch(children) => node = children[digit(key, level)].as_deref()?,
                Node::Leaf(values) => return values[digit(key, 0)].as_ref(),
            }
            level -= 1;
        }
    }

    /// A value to be changed in this version alone.
    pub(super) fn get_mut(&mut self, key: u64) -> Option<&mut T> {
        self.get(key)?;
        let mut node = Arc::make_mut(self.root.as_mut()?);
        let mut level = self.levels;
        loop {
            match node {
                Node::Branch(children) => node = Arc::make_mut(children[digit(key, level)].as_mut()?),
                Node::Leaf(values) => return values[digit(key, 0)].as_mut(),
            }
            level -= 1;
        }
    }

    /// Puts a value in, and gives back the one that was there.
    pub(super) fn insert(&mut self, key: u64, value: T) -> Option<T> {
        while !self.reaches(key) {
            if let Some(root) = self.root.take() {
                let mut children = array::from_fn(|_| None);
                children[0] = Some(root);
                self.root = Some(Arc::new(Node::Branch(children)));
            }
            self.levels += 1;
        }
        let before = self.root.get_or_insert_with(|| Node::empty(self.levels)).put(key, self.levels, value);
        self.length += usize::from(before.is_none());
        before
    }

    pub(super) fn remove(&mut self, key: u64) -> Option<T> {
        self.get(key)?;
        let root = self.root.as_mut()?;
        let removed = Arc::make_mut(root).take(key, self.levels);
        if root.is_empty() {
            *self = Self::new();
        } else {
            self.length -= 1;
        }
        removed
    }

    /// The values in the order of their keys.
    pub(super) fn values(&self) -> impl Iterator<Item = &T> {
        self.values_from(0)
    }

    /// The values of the keys from `first` on, in their order.
    pub(super) fn values_from(&self, first: u64) -> impl Iterator<Item = &T> {
        let mut path: Vec<(&Node<T>, usize)> = Vec::new();
        let mut node = self.root.as_deref().filter(|_| self.reaches(first));
        let mut level = self.levels;
        while let Some(inner) = node {
            let digit = digit(first, level);
            node = match inner {
                // The child that leads to `first` is entered here, so the walk goes on after it.
                Node::Branch(children) => {
                    path.push((inner, digit + 1));
                    children[digit].as_deref()
                }
                Node::Leaf(_) => {
                    path.push((inner, digit));
                    None
                }
            };
            level = level.saturating_sub(1);
        }
        std::iter::from_fn(move || {
            loop {
                let (node, next) = path.pop()?;
                if next == FANOUT {
                    continue;
                }
                path.push((node, next + 1));
                match node {
                    Node::Branch(children) => path.extend(children[next].iter().map(|child| (&**child, 0))),
                    Node::Leaf(values) if values[next].is_some() => return values[next].as_ref(),
                    Node::Leaf(_) => {}
                }
            }
        })
    }

    /// Bytes of all nodes, those that other versions hold too included. What values point to is not in it.
    pub(super) fn memory(&self) -> usize {
        self.root.as_ref().map_or(0, |root| Node::memory(root, &|_| true))
    }

    /// Bytes of the nodes that no other version holds; it looks at no others.
    pub(super) fn own_memory(&self) -> usize {
        self.root.as_ref().map_or(0, |root| Node::memory(root, &|node| Arc::strong_count(node) == 1))
    }

    /// Whether the tree is tall enough for the key.
    fn reaches(&self, key: u64) -> bool {
        key.checked_shr(BITS * (self.levels + 1)).unwrap_or(0) == 0
    }
}

impl<T: Clone> Node<T> {
    fn empty(level: u32) -> Arc<Self> {
        Arc::new(if level == 0 { Self::Leaf(array::from_fn(|_| None)) } else { Self::Branch(array::from_fn(|_| None)) })
    }

    fn is_empty(&self) -> bool {
        match self {
            Self::Branch(children) => children.iter().all(Option::is_none),
            Self::Leaf(values) => values.iter().all(Option::is_none),
        }
    }

    fn memory(node: &Arc<Self>, counts: &impl Fn(&Arc<Self>) -> bool) -> usize {
        if !counts(node) {
            return 0;
        }
        let below = match &**node {
            Self::Branch(children) => children.iter().flatten().map(|child| Self::memory(child, counts)).sum(),
            Self::Leaf(_) => 0,
        };
        below + size_of::<Self>() + 2 * size_of::<usize>()
    }

    fn take(&mut self, key: u64, level: u32) -> Option<T> {
        match self {
            Self::Branch(children) => {
                let place = &mut children[digit(key, level)];
                let child = place.as_mut()?;
                let removed = Arc::make_mut(child).take(key, level - 1);
                if child.is_empty() {
                    *place = None;
                }
                removed
            }
            Self::Leaf(values) => values[digit(key, 0)].take(),
        }
    }
}

/// Puts a value below a node that other versions may share.
trait Put<T> {
    fn put(&mut self, key: u64, level: u32, value: T) -> Option<T>;
}

impl<T: Clone> Put<T> for Arc<Node<T>> {
    fn put(&mut self, key: u64, level: u32, value: T) -> Option<T> {
        match Arc::make_mut(self) {
            Node::Branch(children) => {
                children[digit(key, level)].get_or_insert_with(|| Node::empty(level - 1)).put(key, level - 1, value)
            }
            Node::Leaf(values) => values[digit(key, 0)].replace(value),
        }
    }
}

/// Which child of a node on that level leads to the key.
fn digit(key: u64, level: u32) -> usize {
    (key >> (BITS * level)) as usize % FANOUT
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use proptest::prelude::*;

    use super::*;

    /// Keys close together, far apart, and the greatest.
    fn keys() -> impl Strategy<Value = u64> {
        prop_oneof![4 => 0..200_u64, 1 => 4000..5000_u64, 1 => any::<u64>(), 1 => Just(u64::MAX)]
    }

    proptest! {
        #[test]
        fn agrees_with_a_map_and_leaves_earlier_versions_alone(
            steps in prop::collection::vec((keys(), any::<bool>()), 0..200),
        ) {
            let mut map = IdMap::new();
            let mut expected = BTreeMap::new();
            let mut versions = Vec::new();
            for (step, (key, insert)) in steps.into_iter().enumerate() {
                versions.push((map.clone(), expected.clone()));
                if insert {
                    prop_assert_eq!(map.insert(key, step), expected.insert(key, step));
                } else {
                    prop_assert_eq!(map.remove(key), expected.remove(&key));
                }
                prop_assert_eq!(map.get(key), expected.get(&key));
                if let Some(value) = map.get_mut(key / 2) {
                    *value += 1000;
                }
                expected.entry(key / 2).and_modify(|value| *value += 1000);
            }
            versions.push((map, expected));
            for (map, expected) in versions {
                prop_assert_eq!(map.len(), expected.len());
                prop_assert!(map.values().eq(expected.values()));
                for first in [0, 1, 63, 64, 100, 4500, u64::MAX] {
                    prop_assert!(map.values_from(first).eq(expected.range(first..).map(|(_, value)| value)));
                }
            }
        }
    }

    #[test]
    fn ids_that_are_gone_keep_no_nodes() {
        let mut map = IdMap::new();
        for key in 0..10_000 {
            map.insert(key, key);
            map.remove(key);
        }
        assert!(map.root.is_none());
    }
}
