//! The stack of a traversal: on the call stack as long as it is short, on the heap when the tree is deep.
//!
//! It grows without limit, so that no child is ever dropped.

/// Entries kept without an allocation; a balanced tree of a million leaves needs some forty.
const INLINE: usize = 64;

/// A last-in, first-out stack.
pub(super) struct NodeStack<T> {
    inline: [T; INLINE],
    length: usize,
    spilled: Vec<T>,
}

impl<T: Copy> NodeStack<T> {
    /// A stack with one entry.
    pub(super) fn starting_with(first: T) -> Self {
        Self { inline: [first; INLINE], length: 1, spilled: Vec::new() }
    }

    pub(super) fn push(&mut self, value: T) {
        if self.length < INLINE {
            self.inline[self.length] = value;
            self.length += 1;
        } else {
            self.spilled.push(value);
        }
    }

    pub(super) fn pop(&mut self) -> Option<T> {
        if let Some(value) = self.spilled.pop() {
            return Some(value);
        }
        self.length = self.length.checked_sub(1)?;
        Some(self.inline[self.length])
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
