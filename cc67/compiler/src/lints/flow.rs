//! The locals that every way to a place of a function has stored in.

use cranelift_entity::EntityRef;

use crate::typed::LocalId;

/// The facts that hold at a position.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Flow {
    /// Not reachable: every fact holds.
    Unreachable,
    /// The locals that hold a value, one bit each.
    Stored(Vec<u64>),
}

impl Flow {
    /// The start of a function: nothing holds a value.
    pub(super) const fn start() -> Self {
        Self::Stored(Vec::new())
    }

    pub(super) fn insert(&mut self, local: LocalId) {
        let Self::Stored(words) = self else { return };
        let (word, bit) = position(local);
        if words.len() <= word {
            words.resize(word + 1, 0);
        }
        words[word] |= bit;
    }

    pub(super) fn contains(&self, local: LocalId) -> bool {
        let Self::Stored(words) = self else { return true };
        let (word, bit) = position(local);
        words.get(word).is_some_and(|word| word & bit != 0)
    }

    /// Merges another path to the same point: only what both have assigned is certain.
    pub(super) fn join(&mut self, other: &Self) {
        match (&mut *self, other) {
            (_, Self::Unreachable) => {}
            (Self::Unreachable, Self::Stored(_)) => *self = other.clone(),
            (Self::Stored(words), Self::Stored(others)) => {
                words.truncate(others.len());
                words.iter_mut().zip(others).for_each(|(word, other)| *word &= other);
            }
        }
    }
}

/// The word of a local and its bit there.
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
        left.insert(a);
        let mut right = left.clone();
        right.insert(b);
        let mut meeting = Flow::Unreachable;
        assert!(meeting.contains(b));
        meeting.join(&right);
        assert_eq!(meeting, right);
        meeting.join(&left);
        assert!(meeting.contains(a) && !meeting.contains(b));
        meeting.join(&Flow::Unreachable);
        assert!(meeting.contains(a));
    }
}
