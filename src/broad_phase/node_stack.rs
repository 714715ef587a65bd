//! The stack of a traversal: on the call stack as long as it is short, on the heap when the tree is deep.
//!
//! It grows without limit, so that no child is ever dropped.

use arrayvec::ArrayVec;

/// Entries kept without an allocation; a balanced tree of a million leaves needs some forty.
const INLINE: usize = 64;

/// A last-in, first-out stack.
pub(super) struct NodeStack<T> {
    inline: ArrayVec<T, INLINE>,
    spilled: Vec<T>,
}

impl<T> NodeStack<T> {
    /// A stack with one entry.
    pub(super) fn starting_with(first: T) -> Self {
        let mut inline = ArrayVec::new();
        inline.push(first);
        Self { inline, spilled: Vec::new() }
    }

    #[inline(always)]
    pub(super) fn push(&mut self, value: T) {
        // While some are spilled the inline part is full.
        if let Err(full) = self.inline.try_push(value) {
            self.spilled.push(full.element());
        }
    }

    #[inline(always)]
    pub(super) fn pop(&mut self) -> Option<T> {
        self.spilled.pop().or_else(|| self.inline.pop())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gives_back_everything_in_reverse_beyond_the_inline_part() {
        let mut stack = NodeStack::starting_with(0);
        (1..1000).for_each(|i| stack.push(i));
        let popped: Vec<i32> = std::iter::from_fn(|| stack.pop()).collect();
        assert_eq!(popped, (0..1000).rev().collect::<Vec<_>>());
    }
}
