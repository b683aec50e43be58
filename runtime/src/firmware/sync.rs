//! Locks and uninterruptible operations. Source: threads-and-time.md section 6.

use kmotiondef::{GuestAddr, ThreadId};
use vm::firmware::{Caller, Outcome, Wake};
use vm::trap::TrapKind;

use super::parts::Parts;

/// Waits until a lock is free, then takes it.
///
/// A lock holds its owner's thread number plus one. Anything that is no other thread's identity counts as free.
pub(crate) fn mutex_lock(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    mutex: GuestAddr,
) -> Result<Outcome<()>, TrapKind> {
    let owner: i32 = caller.memory.load(mutex)?;
    let own = i32::from(caller.thread.map_or(0, ThreadId::get)) + 1;
    if ThreadId::new(owner - 1).is_some() && owner != own {
        return Ok(Outcome::Wait(Wake::Retry));
    }
    caller.memory.store(mutex, own)?;
    Ok(Outcome::Done(()))
}

/// Frees a lock, whoever owns it.
pub(crate) fn mutex_unlock(_: &mut Parts, caller: &mut Caller<'_>, mutex: GuestAddr) -> Result<(), TrapKind> {
    caller.memory.store(mutex, 0_i32)
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

/// Stores `value` where 0 was; returns what was there.
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

    use crate::testing::Desk;

    #[test]
    fn a_lock_waits_for_other_threads_only() {
        let address = PERSIST.address();
        for (owner, taken) in
            [(0, true), (2, true), (100, true), (-1, true), (3, false), (8, false), (9, true)]
        {
            let mut desk = Desk::new();
            desk.memory.poke(address, owner);
            assert_eq!(desk.is_done("MutexLock", &[address.get().into()]), taken, "{owner}");
            assert_eq!(desk.memory.peek::<i32>(address), if taken { 2 } else { owner });
        }
    }

    #[test]
    fn test_and_set_returns_what_was_there() {
        let mut desk = Desk::new();
        let arguments = [PERSIST.address().get().into(), 7];
        assert_eq!(desk.call_i32("TestAndSet", &arguments), 0);
        assert_eq!(desk.call_i32("TestAndSet", &arguments), 7);
    }
}
