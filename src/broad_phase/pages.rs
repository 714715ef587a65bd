//! How can a large array be kept in many versions? By pages that the versions share.
//!
//! A clone costs one reference count per page; writing to an element copies its page if another version holds it too.
//! The tree's nodes are kept so, and a snapshot of a scene costs far less than its size.

use std::ops::{Index, IndexMut};
use std::sync::Arc;

/// Elements of a page. Larger pages make clones cheaper and first writes dearer; at 64 a tree of 100 000 leaves is
/// cloned through some 5 000 counts, and a move copies some twenty pages of 4 KiB.
const PAGE: usize = 64;

/// An array in pages that clones share until they are written to.
#[derive(Clone, Debug)]
pub(super) struct Pages<T> {
    pages: Vec<Arc<[T; PAGE]>>,
    length: usize,
}

impl<T: Clone> Pages<T> {
    /// No elements.
    pub(super) fn new() -> Self {
        Self { pages: Vec::new(), length: 0 }
    }

    /// Number of elements.
    pub(super) fn len(&self) -> usize {
        self.length
    }

    /// Appends an element; its index is the length before.
    pub(super) fn push(&mut self, value: T) {
        if self.length == self.pages.len() * PAGE {
            // The rest of a new page is filled with copies that no index reaches.
            self.pages.push(Arc::new(std::array::from_fn(|_| value.clone())));
        } else {
            Arc::make_mut(&mut self.pages[self.length / PAGE])[self.length % PAGE] = value;
        }
        self.length += 1;
    }
}

impl<T> Pages<T> {
    /// Bytes of the pages that no other version holds.
    pub(super) fn own_memory(&self) -> usize {
        self.pages.iter().filter(|page| Arc::strong_count(page) == 1).count() * size_of::<[T; PAGE]>()
    }
}

impl<T> Index<u32> for Pages<T> {
    type Output = T;

    fn index(&self, index: u32) -> &T {
        &self.pages[index as usize / PAGE][index as usize % PAGE]
    }
}

impl<T: Clone> IndexMut<u32> for Pages<T> {
    fn index_mut(&mut self, index: u32) -> &mut T {
        &mut Arc::make_mut(&mut self.pages[index as usize / PAGE])[index as usize % PAGE]
    }
}

#[cfg(test)]
impl<T> Pages<T> {
    /// How many pages the two versions share.
    pub(super) fn shared_with(&self, other: &Self) -> usize {
        self.pages.iter().zip(&other.pages).filter(|(a, b)| Arc::ptr_eq(a, b)).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_write_copies_one_page_and_leaves_the_other_version_alone() {
        let mut before = Pages::new();
        for i in 0..1000_u32 {
            before.push(i);
        }
        let mut after = before.clone();
        assert_eq!(after.shared_with(&before), 1000_usize.div_ceil(PAGE));
        after[500] = 7;
        assert_eq!((before[500], after[500]), (500, 7));
        assert_eq!(after.shared_with(&before), 1000_usize.div_ceil(PAGE) - 1);
        assert!((0..1000).all(|i| i == 500 || after[i] == i));
    }
}
