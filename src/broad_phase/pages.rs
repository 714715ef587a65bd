//! How can a large array of numbers be kept in many versions? By pages, and pages of pages, that the versions share.
//!
//! Writing to a number copies its page if another version holds it too, and the page that lists it. A clone costs one
//! reference count for each 4096 numbers.

use std::ops::Index;
use std::sync::Arc;

/// Numbers of a page, and pages of a list.
const PAGE: usize = 64;

type Page = Arc<[u32; PAGE]>;

/// An array in pages that clones share until they are written to.
#[derive(Clone, Debug, Default)]
pub(super) struct Pages {
    lists: Vec<Arc<[Option<Page>; PAGE]>>,
    length: usize,
}

impl Pages {
    /// Number of elements.
    pub(super) fn len(&self) -> usize {
        self.length
    }

    /// All numbers at once.
    pub(super) fn of(numbers: &[u32]) -> Self {
        let page = |numbers: &[u32]| {
            let mut page = [0; PAGE];
            page[..numbers.len()].copy_from_slice(numbers);
            Some(Arc::new(page))
        };
        let list = |numbers: &[u32]| {
            let mut pages = numbers.chunks(PAGE).map(page);
            Arc::new(std::array::from_fn(|_| pages.next().flatten()))
        };
        Self { lists: numbers.chunks(PAGE * PAGE).map(list).collect(), length: numbers.len() }
    }

    /// Appends an element; its index is the length before.
    pub(super) fn push(&mut self, value: u32) {
        if self.length == self.lists.len() * PAGE * PAGE {
            self.lists.push(Arc::new(std::array::from_fn(|_| None)));
        }
        self.length += 1;
        self.set(self.length as u32 - 1, value);
    }

    pub(super) fn set(&mut self, index: u32, value: u32) {
        let (list, page, place) = split(index);
        let page = &mut Arc::make_mut(&mut self.lists[list])[page];
        Arc::make_mut(page.get_or_insert_with(|| Arc::new([0; PAGE])))[place] = value;
    }

    /// Bytes of all pages, those that other versions hold too included.
    pub(super) fn memory(&self) -> usize {
        let lists = self.lists.len() * (8 + 16 + size_of::<[Option<Page>; PAGE]>());
        lists + self.length.div_ceil(PAGE) * (16 + size_of::<[u32; PAGE]>())
    }
}

impl Pages {
    /// Bytes of the pages and lists that no other version holds.
    pub(super) fn own_memory(&self) -> usize {
        let own_lists = self.lists.iter().filter(|list| Arc::strong_count(list) == 1);
        let of_list = |list: &Arc<[Option<Page>; PAGE]>| {
            let own = list.iter().flatten().filter(|page| Arc::strong_count(page) == 1).count();
            16 + size_of::<[Option<Page>; PAGE]>() + own * (16 + size_of::<[u32; PAGE]>())
        };
        own_lists.map(of_list).sum()
    }
}

fn split(index: u32) -> (usize, usize, usize) {
    let index = index as usize;
    (index / (PAGE * PAGE), index / PAGE % PAGE, index % PAGE)
}

impl Index<u32> for Pages {
    type Output = u32;

    #[inline]
    fn index(&self, index: u32) -> &u32 {
        let (list, page, place) = split(index);
        self.lists[list][page].as_ref().map(|page| &page[place]).expect("an index within the length has a page")
    }
}

#[cfg(test)]
impl Pages {
    /// How many pages the two versions share.
    pub(super) fn shared_with(&self, other: &Self) -> usize {
        let pages = |pages: &Self| -> Vec<Page> {
            pages.lists.iter().flat_map(|list| list.iter().flatten().cloned()).collect()
        };
        pages(self).iter().zip(&pages(other)).filter(|(a, b)| Arc::ptr_eq(a, b)).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_write_copies_one_page_and_leaves_the_other_version_alone() {
        let mut before = Pages::default();
        for i in 0..10_000_u32 {
            before.push(i);
        }
        let numbers: Vec<u32> = (0..10_000).collect();
        let at_once = Pages::of(&numbers);
        assert!((0..10_000).all(|i| at_once[i] == before[i]) && at_once.len() == before.len());
        let mut after = before.clone();
        let pages = 10_000_usize.div_ceil(PAGE);
        assert_eq!(after.shared_with(&before), pages);
        after.set(5000, 7);
        assert_eq!((before[5000], after[5000], before.len()), (5000, 7, 10_000));
        assert_eq!(after.shared_with(&before), pages - 1);
        assert!((0..10_000).all(|i| i == 5000 || after[i] == i));
    }
}
