//! Locks and uninterruptible operations. Source: threads-and-time.md section 6.

use kmotiondef::{GuestAddr, ThreadId};
use vm::firmware::{Caller, Outcome, Wake};
use vm::trap::TrapKind;

use super::calls::HeldLock;
use super::level::MutexRule;
use super::parts::Parts;

/// Waits until a lock is free, then takes it.
pub(crate) fn mutex_lock(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    mutex: GuestAddr,
) -> Result<Outcome<()>, TrapKind> {
    let word: i32 = caller.memory.load(mutex)?;
    let own = i32::from(caller.thread.map_or(0, ThreadId::get));
    let taken = match parts.level.behaviour().mutexes {
        MutexRule::Owner => taken_word(word, own),
        MutexRule::Counted => taken_counted_word(word, own, caller),
    };
    match taken {
        Some(taken) => {
            caller.memory.store(mutex, taken)?;
            if let Some(thread) = caller.thread {
                parts.calls.locks.record_taken(HeldLock { thread, lock: mutex, at: caller.at });
            }
            Ok(Outcome::Done(()))
        }
        None => Ok(Outcome::Wait(Wake::Retry)),
    }
}

/// The word of a lock after it is taken; `None` if another thread owns it.
///
/// The word is the owner's number plus one. The board tests the owner's bit by a shift with a six-bit count: a word
/// that shifts all bits out counts as free.
fn taken_word(word: i32, own: i32) -> Option<i32> {
    const COUNT: i32 = 63;
    let is_taken = word.wrapping_sub(1) & COUNT < 32 && word != own + 1;
    (!is_taken).then_some(own + 1)
}

/// The owner of a lock that counts, and its locks.
const fn owner_and_count(word: i32) -> (i32, i32) {
    (word >> COUNT_BITS, word & COUNT_MASK)
}
/// Bits of the count of locks.
const COUNT_BITS: u32 = 16;
const COUNT_MASK: i32 = (1 << COUNT_BITS) - 1;

/// As [`taken_word`], for a word of the owner and a count of its locks.
fn taken_counted_word(word: i32, own: i32, caller: &Caller<'_>) -> Option<i32> {
    let (owner, count) = owner_and_count(word);
    if owner == own || word == 0 {
        return Some((own << COUNT_BITS) + count + 1);
    }
    // The primary thread is always active.
    let is_active =
        owner == 0 || ThreadId::new(owner).is_some_and(|owner| caller.threads.state(owner).is_active());
    // Board quirk: a lock that is taken over contains the number of the next thread instead of the one that takes it.
    if is_active && count == 0 {
        return Some((own << COUNT_BITS) + 1);
    }
    (!is_active).then_some(((own + 1) << COUNT_BITS) + 1)
}

/// Frees a lock: any owner's, or one of the caller's own.
pub(crate) fn mutex_unlock(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    mutex: GuestAddr,
) -> Result<(), TrapKind> {
    parts.calls.locks.record_freed(mutex);
    if parts.level.behaviour().mutexes == MutexRule::Owner {
        return caller.memory.store(mutex, 0_i32);
    }
    let word: i32 = caller.memory.load(mutex)?;
    let (owner, count) = owner_and_count(word);
    let own = i32::from(caller.thread.map_or(0, ThreadId::get));
    if count == 0 || owner != own {
        parts.out.console.message("Mutex Error");
        return Ok(());
    }
    caller.memory.store(mutex, if count == 1 { 0 } else { word - 1 })
}

/// `*place |= mask`.
pub(crate) fn atomic_set(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    place: GuestAddr,
    mask: i32,
) -> Result<(), TrapKind> {
    let value: i32 = caller.memory.load(place)?;
    caller.memory.store(place, value | mask)
}

/// `*place &= mask`: the mask holds ones at the bits to keep.
pub(crate) fn atomic_clear(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    place: GuestAddr,
    mask: i32,
) -> Result<(), TrapKind> {
    let value: i32 = caller.memory.load(place)?;
    caller.memory.store(place, value & mask)
}

/// `*place |= mask`, 16 bits of both.
pub(crate) fn atomic_set_16(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    place: GuestAddr,
    mask: i32,
) -> Result<(), TrapKind> {
    let value: u16 = caller.memory.load(place)?;
    caller.memory.store(place, value | mask as u16)
}

/// `*place &= mask`, 16 bits of both.
pub(crate) fn atomic_clear_16(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    place: GuestAddr,
    mask: i32,
) -> Result<(), TrapKind> {
    let value: u16 = caller.memory.load(place)?;
    caller.memory.store(place, value & mask as u16)
}

/// Stores `value` if the word is 0; returns the old word.
pub(crate) fn test_and_set(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    mutex: GuestAddr,
    value: i32,
) -> Result<i32, TrapKind> {
    let old: i32 = caller.memory.load(mutex)?;
    if old == 0 {
        caller.memory.store(mutex, value)?;
    }
    Ok(old)
}

#[cfg(test)]
mod tests {
    use kmotiondef::variables::PERSIST;

    use crate::testing::TestBench;

    #[test]
    fn a_lock_waits_for_other_threads_only() {
        let address = PERSIST.address();
        let free = [0, 2, 33, 64, 100, -1].map(|owner| (owner, true));
        let taken = [3, 8, 9, 32, 65, 855].map(|owner| (owner, false));
        for (owner, taken) in free.into_iter().chain(taken) {
            let mut bench = TestBench::new();
            bench.memory.poke(address, owner);
            assert_eq!(bench.is_done("MutexLock", &[address.get().into()]), taken, "{owner}");
            assert_eq!(bench.memory.peek::<i32>(address), if taken { 2 } else { owner });
        }
    }

    #[test]
    fn test_and_set_returns_what_was_there() {
        let mut bench = TestBench::new();
        let arguments = [PERSIST.address().get().into(), 7];
        assert_eq!(bench.call_i32("TestAndSet", &arguments), 0);
        assert_eq!(bench.call_i32("TestAndSet", &arguments), 7);
    }
}
