//! The rotation: which thread gets the slice of a tick.
//!
//! It is pure: it does not access memory, time or an engine. Rules: threads-and-time.md 1.2 of the specification.

use kmotiondef::ThreadId;

/// The owner of a slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum SliceOwner {
    /// The primary thread, number 0.
    #[default]
    Primary,
    /// A user thread.
    User(ThreadId),
}

impl SliceOwner {
    /// The thread's number, 0 for the primary thread.
    #[must_use]
    pub const fn number(self) -> u8 {
        match self {
            Self::Primary => 0,
            Self::User(thread) => thread.get(),
        }
    }
}

/// A set of user threads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ThreadSet(u8);

impl ThreadSet {
    /// The set without members.
    pub const EMPTY: Self = Self(0);

    /// The set with `thread` added.
    #[must_use]
    pub const fn with(self, thread: ThreadId) -> Self {
        Self(self.0 | 1 << thread.get())
    }

    /// The set without `thread`.
    #[must_use]
    pub const fn without(self, thread: ThreadId) -> Self {
        Self(self.0 & !(1 << thread.get()))
    }

    /// Reports whether `thread` is a member.
    #[must_use]
    pub const fn contains(self, thread: ThreadId) -> bool {
        self.0 >> thread.get() & 1 != 0
    }

    /// Reports whether the set has no member.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Number of members.
    #[must_use]
    pub const fn len(self) -> u32 {
        self.0.count_ones()
    }

    /// The members as bits, bit n for thread n.
    #[must_use]
    pub const fn bits(self) -> u8 {
        self.0
    }
}

impl FromIterator<ThreadId> for ThreadSet {
    fn from_iter<I: IntoIterator<Item = ThreadId>>(threads: I) -> Self {
        threads.into_iter().fold(Self::EMPTY, Self::with)
    }
}

/// The thread after `current`: the next active one in ascending order, then the primary thread.
#[must_use]
pub fn next(active: ThreadSet, current: SliceOwner) -> SliceOwner {
    let passed = (2 << current.number()) - 1;
    let left = u32::from(active.bits()) & !passed;
    // No bit is number 32, which is no thread's.
    ThreadId::new(left.trailing_zeros().cast_signed()).map_or(SliceOwner::Primary, SliceOwner::User)
}

/// The thread `ticks` ticks after `current`, while the same threads are active.
#[must_use]
pub fn after(active: ThreadSet, current: SliceOwner, ticks: u64) -> SliceOwner {
    // From the slice of an inactive thread, the rotation first returns to its cycle.
    if ticks == 0 {
        return current;
    }
    let period = u64::from(active.len()) + 1;
    (0..(ticks - 1) % period).fold(next(active, current), |turn, _| next(active, turn))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(numbers: &[i32]) -> ThreadSet {
        numbers.iter().filter_map(|number| ThreadId::new(*number)).collect()
    }

    /// The slices that follow the first of `expected`.
    fn check(active: &[i32], expected: &str) {
        let active = set(active);
        let first = expected.bytes().next().map_or(0, |digit| digit - b'0');
        let mut turn = ThreadId::new(i32::from(first)).map_or(SliceOwner::Primary, SliceOwner::User);
        let mut slices = String::new();
        for count in 0..40 {
            assert_eq!(after(active, turn, 0), turn, "after {count} slices");
            slices.push(char::from(b'0' + turn.number()));
            turn = next(active, turn);
        }
        assert_eq!(slices, expected);
    }

    #[test]
    fn rotation_matches_the_released_firmware() {
        check(&[], "0000000000000000000000000000000000000000");
        check(&[1], "0101010101010101010101010101010101010101");
        check(&[2], "0202020202020202020202020202020202020202");
        check(&[1, 2], "2012012012012012012012012012012012012012");
        check(&[2, 5], "5025025025025025025025025025025025025025");
        check(&[1, 2, 3], "1230123012301230123012301230123012301230");
        check(&[7], "0707070707070707070707070707070707070707");
        check(&[1, 7], "7017017017017017017017017017017017017017");
        check(&[1, 2, 3, 4, 5, 6, 7], "2345670123456701234567012345670123456701");
        check(&[5, 2], "5025025025025025025025025025025025025025");
    }

    #[test]
    fn many_turns_at_once_are_the_same_as_one_by_one() {
        for active in [set(&[]), set(&[3]), set(&[1, 4, 7])] {
            for start in [SliceOwner::Primary, SliceOwner::User(ThreadId::new(2).expect("2 is a thread"))] {
                let mut turn = start;
                for ticks in 0..20 {
                    assert_eq!(after(active, start, ticks), turn);
                    turn = next(active, turn);
                }
            }
        }
    }
}
