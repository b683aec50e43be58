//! Loops with their registers renamed.
//!
//! In software-pipelined code a result lands in every cycle, and the interpreter of single packets spends most of its
//! time on results in flight. A loop that is reached often is therefore planned once ([`plan`]): a result is written at
//! once to a location that no instruction reads yet, and instructions are renamed to read it there from the cycle on in
//! which it lands ([`renaming`]). They are executed by the same functions as elsewhere. When the loop is left, for
//! whatever reason, the state is converted back: only the computer's clock shows the difference.

mod plan;
mod renaming;

use std::collections::BTreeMap;

use self::plan::{Arrival, LoopPlan, plan};
use self::renaming::{EffectShape, list};
use super::cache::Cache;
use super::core::StackWatch;
use super::decode::instructions;
use super::memory::Memory;
use super::pipeline::State;
use super::watched::WatchedMemory;
use crate::trap::TrapKind;

/// Arrivals after which a loop is planned.
const HOT: u32 = 64;
/// A place that is not planned any more.
const COLD: u32 = u32::MAX;
/// Places that are counted, a power of two.
const PLACES: usize = 256;
/// Most loops of one place, most loops.
const MOST_HERE: usize = 8;
const MOST: usize = 128;
/// Number of code changes after which no more loops are planned.
const MOST_CHANGES: u32 = 64;
/// The fewest cycles that must be left for a loop to be entered.
const LEAST: i64 = 64;
/// A loop that in this many entries or more has executed fewer packets in each than `WORTH` is not entered any more.
const TRIAL: u64 = 64;
const WORTH: u64 = 32;

/// The targets of backward branches, and the loops there.
#[derive(Debug)]
pub(super) struct Loops {
    /// Places, and how often they were reached.
    places: Box<[(u32, u32); PLACES]>,
    known: BTreeMap<u32, Vec<RenamedLoop>>,
    count: usize,
    /// The generation of the code that the loops were planned from.
    generation: u64,
    changes: u32,
    flying: Vec<EffectShape>,
    is_off: bool,
}

/// A loop with its entry and the effects in flight at the entry.
#[derive(Debug)]
pub(super) struct RenamedLoop {
    flying: Vec<EffectShape>,
    planned: LoopPlan,
    entries: u64,
    /// Packets executed.
    packets: u64,
}

impl Default for Loops {
    fn default() -> Self {
        Self {
            places: Box::new([(0, 0); PLACES]),
            known: BTreeMap::new(),
            count: 0,
            generation: 0,
            changes: 0,
            flying: Vec::new(),
            is_off: false,
        }
    }
}

/// A copy is empty: loops are found again, just as packets are decoded again.
impl Clone for Loops {
    fn clone(&self) -> Self {
        Self { is_off: self.is_off, ..Self::default() }
    }
}

impl Loops {
    /// No loop is planned any more.
    #[cfg(test)]
    pub(super) const fn turn_off(&mut self) {
        self.is_off = true;
    }

    /// The number of packets executed by the loops known now.
    #[cfg(test)]
    pub(super) fn packets(&self) -> u64 {
        self.known.values().flatten().map(|known| known.packets).sum()
    }

    /// The loop that begins where a branch has arrived.
    pub(super) fn find<M: Memory>(
        &mut self,
        state: &State,
        cache: &mut Cache,
        memory: &M,
    ) -> Option<&mut RenamedLoop> {
        if self.is_off || state.is_idle || state.clock.left() < LEAST {
            return None;
        }
        if self.generation != cache.generation() {
            self.clear(cache.generation());
        }
        let pc = state.pc();
        let place = &mut self.places[pc as usize / 4 % PLACES];
        if place.0 != pc {
            *place = (pc, 0);
        }
        if place.1 < HOT {
            place.1 += 1;
            return None;
        }
        if place.1 == COLD || !list(state, &mut self.flying) {
            return None;
        }
        let here = self.known.entry(pc).or_default();
        let index = match here.iter().position(|known| known.flying == self.flying) {
            Some(index) => index,
            // After an interrupt other effects may be in flight, but not for long.
            None if here.len() >= MOST_HERE || self.count >= MOST => return None,
            None => {
                let Some(planned) = plan_with(state, &self.flying, cache, memory) else {
                    place.1 = COLD;
                    return None;
                };
                here.push(RenamedLoop { flying: self.flying.clone(), planned, entries: 0, packets: 0 });
                self.count += 1;
                here.len() - 1
            }
        };
        let found = here.get_mut(index)?;
        found.entries += 1;
        if found.entries >= TRIAL && found.packets < found.entries * WORTH {
            place.1 = COLD;
        }
        Some(found)
    }

    /// The code has changed.
    #[cold]
    fn clear(&mut self, generation: u64) {
        self.generation = generation;
        self.known.clear();
        self.count = 0;
        self.changes += 1;
        let heat = if self.changes > MOST_CHANGES { COLD } else { 0 };
        self.places.iter_mut().for_each(|place| place.1 = heat);
    }
}

/// Plans the loop where a branch has arrived.
#[cold]
fn plan_with<M: Memory>(
    state: &State,
    flying: &[EffectShape],
    cache: &mut Cache,
    memory: &M,
) -> Option<LoopPlan> {
    let generation = cache.generation();
    let planned = plan(state.pc(), state.branched_at()[0], flying, &mut |at| {
        if at & 3 != 0 {
            return None;
        }
        let index = cache.find(at, memory).ok()?;
        let (packet, micros) = cache.packet(index);
        let insts = instructions(memory, at);
        (insts.len() == micros.len())
            .then(|| (packet, insts.into_iter().zip(micros.iter().copied()).collect()))
    });
    // Too many packets were decoded, and all were forgotten.
    planned.filter(|_| generation == cache.generation())
}

impl RenamedLoop {
    /// Executes packets until the loop is left.
    ///
    /// # Errors
    /// The fault of a packet, and the number of the instruction if one caused it.
    #[inline(never)]
    pub(super) fn run<M: Memory>(
        &mut self,
        state: &mut State,
        memory: &mut WatchedMemory<'_, M>,
        mut stack: Option<&mut StackWatch>,
        packets: &mut u64,
    ) -> Result<(), (TrapKind, Option<usize>)> {
        let LoopPlan { packets: planned, borders } = &self.planned;
        borders[0].before.load_state(state);
        let began = *packets;
        let mut at = 0;
        while !state.clock.is_over() {
            let packet = &planned[at as usize];
            for micro in &packet.micros {
                if !micro.is_executed(&state.regs) {
                    continue;
                }
                if let Err(kind) = state.execute::<true, _>(micro, memory) {
                    let number = packet.micros.iter().position(|other| std::ptr::eq(other, micro));
                    self.leave_within(at, number.unwrap_or(0), state);
                    return Err((kind, number));
                }
            }
            *packets += 1;
            if !packet.is_special {
                state.clock.cycle += u64::from(packet.cycles);
                at = packet.next;
                continue;
            }
            if let Some(place) = packet.stack
                && let Some(stack) = &mut stack
                && let Err(kind) = stack.check(state.regs[usize::from(place)])
            {
                self.leave_within(at, packet.micros.len(), state);
                return Err((kind, None));
            }
            state.clock.cycle += u64::from(packet.cycles);
            at = packet.arrival.and_then(|arrival| arrival.target(state)).unwrap_or(packet.next);
            if planned[at as usize].is_exit || memory.hits[0].is_some() {
                break;
            }
        }
        borders[at as usize].before.store_state(state);
        state.pc = planned[at as usize].pc;
        self.packets += *packets - began;
        Ok(())
    }

    /// Leaves the loop within a packet, before the instruction with this number.
    #[cold]
    fn leave_within(&self, at: u32, number: usize, state: &mut State) {
        self.planned.borders[at as usize].before_instruction(number).store_state(state);
        state.pc = self.planned.packets[at as usize].pc;
    }
}

impl Arrival {
    /// The packet that follows; if the branch is not taken, further cycles pass.
    #[inline(always)]
    fn target(self, state: &mut State) -> Option<u32> {
        if let Some(decider) = self.decider
            && !decider.holds(&state.regs)
        {
            state.clock.cycle += u64::from(self.rest);
            return None;
        }
        if let Some(from) = self.from {
            state.note_branch(from);
        }
        Some(self.to)
    }
}
