//! The locals in which every path to a position of a function has stored, or which it has read before a store.

use cranelift_entity::EntityRef;

use crate::typed::LocalId;

/// The facts that hold at a position.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Flow {
    /// Not reachable: every fact holds.
    Unreachable,
    Reachable {
        /// Hold a value on every path.
        stored: LocalSet,
        /// Were read on every path before they had a value.
        read: LocalSet,
    },
}

impl Flow {
    /// The start of a function: nothing holds a value.
    pub(super) const fn start() -> Self {
        Self::Reachable { stored: LocalSet(Vec::new()), read: LocalSet(Vec::new()) }
    }

    pub(super) fn store(&mut self, local: LocalId) {
        if let Self::Reachable { stored, .. } = self {
            stored.insert(local);
        }
    }

    /// Notes a read of a local without a value.
    pub(super) fn read(&mut self, local: LocalId) {
        if let Self::Reachable { read, .. } = self {
            read.insert(local);
        }
    }

    pub(super) fn is_stored(&self, local: LocalId) -> bool {
        match self {
            Self::Unreachable => true,
            Self::Reachable { stored, .. } => stored.contains(local),
        }
    }

    pub(super) fn is_read(&self, local: LocalId) -> bool {
        match self {
            Self::Unreachable => true,
            Self::Reachable { read, .. } => read.contains(local),
        }
    }

    /// Merges another path to the same point: a fact is certain if it holds on both.
    pub(super) fn join(&mut self, other: &Self) {
        match (&mut *self, other) {
            (_, Self::Unreachable) => {}
            (Self::Unreachable, Self::Reachable { .. }) => *self = other.clone(),
            (Self::Reachable { stored, read }, Self::Reachable { stored: other, read: other_read }) => {
                stored.intersect(other);
                read.intersect(other_read);
            }
        }
    }
}

/// A set of locals, one bit each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct LocalSet(Vec<u64>);

impl LocalSet {
    fn insert(&mut self, local: LocalId) {
        let (word, bit) = position(local);
        if self.0.len() <= word {
            self.0.resize(word + 1, 0);
        }
        self.0[word] |= bit;
    }

    fn contains(&self, local: LocalId) -> bool {
        let (word, bit) = position(local);
        self.0.get(word).is_some_and(|word| word & bit != 0)
    }

    fn intersect(&mut self, other: &Self) {
        self.0.truncate(other.0.len());
        self.0.iter_mut().zip(&other.0).for_each(|(word, other)| *word &= other);
    }
}

/// The index of a local's word, and its bit in the word.
fn position(local: LocalId) -> (usize, u64) {
    (local.index() / 64, 1 << (local.index() % 64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_variables_stored_on_every_path_count_as_initialised() {
        let [a, b] = [3, 200].map(LocalId::new);
        let mut left = Flow::start();
        left.store(a);
        let mut right = left.clone();
        right.store(b);
        let mut meeting = Flow::Unreachable;
        assert!(meeting.is_stored(b));
        meeting.join(&right);
        assert_eq!(meeting, right);
        meeting.join(&left);
        assert!(meeting.is_stored(a) && !meeting.is_stored(b));
        meeting.join(&Flow::Unreachable);
        assert!(meeting.is_stored(a));
    }

    #[test]
    fn a_read_is_certain_if_it_is_on_every_path() {
        let a = LocalId::new(0);
        let mut left = Flow::start();
        left.read(a);
        assert!(left.is_read(a) && !left.is_stored(a));
        left.join(&Flow::start());
        assert!(!left.is_read(a));
    }
}
