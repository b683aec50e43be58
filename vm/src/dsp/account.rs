//! A record of the time spent by real images, for each packet and each firmware call.
//!
//! Nothing is sampled: packets are executed one at a time, and a run is the same, cycle by cycle, as without an
//! account.
//!
//! Real code keeps no list of its callers, so the account builds one: a branch to the beginning of a function is a call
//! if the return address in B3 is near after the branch, and that call ends when the return address is reached.

use std::collections::BTreeMap;

use kmotiondef::{CodeAddr, Cycles, GuestAddr};

use crate::engine::ContextId;

/// The largest distance from a call to its return address, in bytes: six packets.
const LONGEST_CALL: u32 = 6 * 32;
/// The limit of calls that have not returned; calls of code that never returns are not added beyond it.
const DEEPEST: usize = 256;

/// A place where time is spent: context, packet, firmware function, callers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Spender {
    /// The thread or the call-back.
    pub context: ContextId,
    /// The packet.
    pub at: CodeAddr,
    /// The firmware function called there, if the time was spent in it.
    pub firmware: Option<GuestAddr>,
    /// The calls that led there.
    pub callers: Callers,
}

/// An entry in the tree of calls; see [`Account::calls`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Callers(usize);

/// Time that was spent, in cycles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Time {
    /// Processor time.
    pub computing: Cycles,
    /// Time in which a firmware function made the thread wait.
    pub waiting: Cycles,
}

/// A context, a packet of it, and the firmware function that this calls.
pub(super) type PacketSite = (ContextId, CodeAddr, Option<GuestAddr>);

/// The branch by which a packet was reached.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch {
    /// The packet of the last taken branch.
    pub(super) from: CodeAddr,
    /// B3.
    pub(super) link: u32,
    /// True if a function begins at the packet that is reached.
    pub(super) enters: bool,
}

/// A call that has not returned.
#[derive(Clone, Copy, Debug)]
struct OpenCall {
    /// The return address.
    return_address: u32,
    /// The callers before it.
    outer: Callers,
}

/// The calls of a context that have not returned.
#[derive(Clone, Debug, Default)]
struct CallTrail {
    open: Vec<OpenCall>,
    callers: Callers,
}

/// Time spent, by place.
#[derive(Clone, Debug, Default)]
pub struct Account {
    spent: BTreeMap<Spender, Time>,
    /// The place in which each waiting context waits, and the start of the wait.
    waits: [Option<(Spender, Cycles)>; ContextId::COUNT],
    /// Each list of calls as the list before it and the last call; the list 0 is empty.
    lists: Vec<(Callers, CodeAddr)>,
    known: BTreeMap<(Callers, CodeAddr), Callers>,
    trails: [CallTrail; ContextId::COUNT],
}

impl Account {
    /// All that has spent time, in their order.
    pub fn spent(&self) -> impl Iterator<Item = (Spender, Time)> {
        self.spent.iter().map(|(spender, time)| (*spender, *time))
    }

    /// The packets that made the calls, innermost first.
    pub fn calls(&self, callers: Callers) -> impl Iterator<Item = CodeAddr> {
        let entry = |callers: Callers| callers.0.checked_sub(1).and_then(|index| self.lists.get(index));
        std::iter::successors(entry(callers), move |(outer, _)| entry(*outer)).map(|(_, call)| *call)
    }

    /// A context starts again.
    pub(super) fn begin(&mut self, context: ContextId) {
        self.trails[context.index()] = CallTrail::default();
    }

    /// A packet of a context has ended, and `next` is the next one.
    pub(super) fn follow(&mut self, context: ContextId, next: u32, branch: Branch) {
        let trail = &mut self.trails[context.index()];
        if let Some(call) = trail.open.pop_if(|call| call.return_address == next) {
            trail.callers = call.outer;
            return;
        }
        // A jump to the beginning of a function in progress is not a call, nor is a tail jump from its end to another
        // function.
        let is_new = trail.open.last().is_none_or(|call| call.return_address != branch.link);
        let is_call = branch.enters && is_new && is_return_of(branch.link, branch.from.as_guest_addr().get());
        if !is_call || trail.open.len() >= DEEPEST {
            return;
        }
        let list = (trail.callers, branch.from);
        let lists = &mut self.lists;
        let callers = *self.known.entry(list).or_insert_with(|| {
            lists.push(list);
            Callers(lists.len())
        });
        trail.open.push(OpenCall { return_address: branch.link, outer: trail.callers });
        trail.callers = callers;
    }

    fn spender(&self, (context, at, firmware): PacketSite) -> Spender {
        Spender { context, at, firmware, callers: self.trails[context.index()].callers }
    }

    pub(super) fn compute(&mut self, place: PacketSite, computing: Cycles) {
        let spender = self.spender(place);
        self.spent.entry(spender).or_default().computing += computing;
    }

    /// A context begins to wait.
    pub(super) fn wait(&mut self, place: PacketSite, now: Cycles) {
        self.waits[place.0.index()] = Some((self.spender(place), now));
    }

    /// A context continues.
    pub(super) fn resume(&mut self, context: ContextId, now: Cycles) {
        if let Some((spender, since)) = self.waits[context.index()].take() {
            self.spent.entry(spender).or_default().waiting += now - since;
        }
    }
}

/// Reports whether `back` may be the return address of a call at `at`.
pub(super) const fn is_return_of(back: u32, at: u32) -> bool {
    back.wrapping_sub(at) <= LONGEST_CALL
}
