//! How can a long array be kept in many versions? By pages, and lists of pages, that the versions share.
//!
//! Writing to an element copies its page if another version holds it too, and the list of that page. A clone costs one
//! reference count for each 4096 elements.

use std::ops::Index;
use std::sync::Arc;

/// Elements of a page, and pages of a list.
const PAGE: usize = 64;

/// What an allocation behind an `Arc` has beside its content.
pub(super) const COUNTS: usize = 2 * size_of::<usize>();

type List<T> = Vec<Arc<[T; PAGE]>>;

/// An array in pages that clones share until they are written to.
#[derive(Clone, Debug)]
pub(super) struct SharedArray<T> {
    lists: Vec<Arc<List<T>>>,
    length: usize,
}

impl<T: Clone> SharedArray<T> {
    /// No elements.
    pub(super) fn new() -> Self {
        Self { lists: Vec::new(), length: 0 }
    }

    /// Number of elements.
    pub(super) fn len(&self) -> usize {
        self.length
    }

    /// Appends an element; its index is the length before.
    pub(super) fn push(&mut self, value: T) {
        let index = self.length;
        self.length += 1;
        if index < self.lists.len() * PAGE * PAGE && !index.is_multiple_of(PAGE) {
            self.set(index as u32, value);
            return;
        }
        if index == self.lists.len() * PAGE * PAGE {
            self.lists.push(Arc::default());
        }
        if let Some(list) = self.lists.last_mut() {
            // The rest of a new page is filled with copies that no index reaches.
            Arc::make_mut(list).push(Arc::new(std::array::from_fn(|_| value.clone())));
        }
    }

    /// Gives an element, whose index is below the length, another value.
    pub(super) fn set(&mut self, index: u32, value: T) {
        let (list, page, place) = split(index);
        Arc::make_mut(&mut Arc::make_mut(&mut self.lists[list])[page])[place] = value;
    }

    /// Bytes of all pages, those that other versions hold too included.
    pub(super) fn memory(&self) -> usize {
        let pages: usize = self.lists.iter().map(|list| list.len()).sum();
        pages * (size_of::<[T; PAGE]>() + COUNTS + size_of::<usize>()) + self.lists.len() * size_of::<List<T>>()
    }

    /// Bytes of the pages that no other version holds.
    pub(super) fn own_memory(&self) -> usize {
        let own = |list: &&Arc<List<T>>| Arc::strong_count(list) == 1;
        let pages = |list: &Arc<List<T>>| {
            let own = list.iter().filter(|page| Arc::strong_count(page) == 1).count();
            own * (size_of::<[T; PAGE]>() + COUNTS) + list.len() * size_of::<usize>()
        };
        self.lists.iter().filter(own).map(pages).sum()
    }
}

impl<T> Index<u32> for SharedArray<T> {
    type Output = T;

    fn index(&self, index: u32) -> &T {
        let (list, page, place) = split(index);
        &self.lists[list][page][place]
    }
}

/// List, page in it, and place in that.
fn split(index: u32) -> (usize, usize, usize) {
    let index = index as usize;
    (index / (PAGE * PAGE), index / PAGE % PAGE, index % PAGE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_write_copies_one_page_and_leaves_the_other_version_alone() {
        let mut before = SharedArray::new();
        (0..10_000_u32).for_each(|i| before.push(i));
        assert_eq!(before.len(), 10_000);
        let mut after = before.clone();
        assert_eq!(after.own_memory(), 0);
        after.set(5_000, 7);
        after.push(1);
        assert_eq!((before[5_000], after[5_000], after[10_000], before.len()), (5_000, 7, 1, 10_000));
        assert!((0..10_000).all(|i| i == 5_000 || after[i] == i));
        assert!((1..4096).contains(&after.own_memory()), "{}", after.own_memory());
        assert!(after.memory() > 40_000);
    }
}
