//! Waiting loops: their iterations are translated a second time, with requests to skip the following iterations.
//!
//! The branches that end an iteration lead to the second translation, and all branches out of it to the first. So an
//! iteration of the second translation has executed only words of the loop when it ends.

use std::mem::{offset_of, replace, take};

use cranelift_codegen::ir::{Block, InstBuilder, types};

use super::super::request::Reason;
use super::super::state::State;
use super::Translator;
use crate::operand::Class;
use crate::polling::{PollingLoop, TimeTests};

impl Translator<'_, '_> {
    /// The block at the word `to` for the branch that is being translated.
    pub(super) fn block_of(&mut self, to: usize) -> Block {
        let ends = |polling: &PollingLoop| polling.first == to && polling.branches.contains(&self.at);
        if self.calls.attempt.is_some() || !self.waits.loops.iter().any(ends) {
            return self.blocks[&to];
        }
        match self.waits.end {
            Some((first, end)) if first == to => end,
            Some(_) | None => *self.waits.entries.entry(to).or_insert_with(|| self.builder.create_block()),
        }
    }

    /// Translates the iterations of the loops whose branches have been met.
    pub(super) fn waiting_loops(&mut self) {
        let is_rare = replace(&mut self.unroll.is_rare, true);
        // Each may meet the branches of others.
        let mut open: Vec<PollingLoop> = self.waits.loops.clone();
        while let Some(next) = open.iter().position(|polling| self.waits.entries.contains_key(&polling.first))
        {
            let polling = open.swap_remove(next);
            self.waiting_loop(&polling);
        }
        self.unroll.is_rare = is_rare;
    }

    fn waiting_loop(&mut self, polling: &PollingLoop) {
        let (entry, end) = (self.waits.entries[&polling.first], self.builder.create_block());
        self.waits.end = Some((polling.first, end));
        let budget = self.builder.declare_var(types::I64);
        let tick = self.builder.declare_var(types::I64);

        self.builder.set_cold_block(entry);
        self.begin(entry);
        let left = self.builder.use_var(self.registers.budget);
        self.builder.def_var(budget, left);
        let present = self.load_state(types::I64, offset_of!(State, signs.tick));
        self.builder.def_var(tick, present);
        let called = self.builder.declare_var(types::I64);
        self.builder.def_var(called, left);
        self.waits.clock = polling.clock.as_ref().map(|clock| (clock.call, called));
        self.iteration(polling);

        self.at = polling.branches[0];
        self.builder.set_cold_block(end);
        self.begin(end);
        if let Some(clock) = &polling.clock {
            self.pass_clock(clock);
        }
        let (start, tick) = (self.builder.use_var(budget), self.builder.use_var(tick));
        self.usual_request(Reason::PassIterations.code(), self.at, start, tick);
        self.builder.ins().jump(entry, &[]);
        self.reachable = false;
        (self.waits.end, self.waits.clock) = (None, None);
    }

    /// Notes the instant at which a call has yielded the time.
    pub(super) fn note_time(&mut self) {
        if let Some((_, called)) = self.waits.clock.filter(|(call, _)| *call == self.at) {
            let budget = self.builder.use_var(self.registers.budget);
            self.builder.def_var(called, budget);
        }
    }

    /// Stores the time, and the registers with which it is compared, in the state.
    fn pass_clock(&mut self, clock: &TimeTests) {
        let Some((_, called)) = self.waits.clock else { return };
        let called = self.builder.use_var(called);
        let arguments = offset_of!(State, exchange.arguments);
        self.store_state(called, arguments);
        for (place, register) in (1..).zip(clock.registers()) {
            let value = self.builder.use_var(self.registers.variables[usize::from(register)]);
            let slot = self.slot(Class::F64, value);
            self.store_state(slot, arguments + place * size_of::<u64>());
        }
    }

    /// Translates the words of an iteration; the block at the first one has been entered.
    fn iteration(&mut self, polling: &PollingLoop) {
        let inside = polling.words.iter().filter(|at| **at != polling.first && self.blocks.contains_key(at));
        let inside: Vec<usize> = inside.copied().collect();
        let blocks: Vec<Block> = inside.iter().map(|_| self.builder.create_block()).collect();
        let own = inside.into_iter().zip(blocks);
        let outside: Vec<_> = own.map(|(at, block)| (at, self.blocks.insert(at, block))).collect();
        // Falls through from the previous word, and only then.
        for at in polling.words.range(polling.first..).chain(polling.words.range(..polling.first)) {
            if *at != polling.first
                && let Some(block) = self.blocks.get(at).copied()
            {
                self.builder.set_cold_block(block);
                self.begin(block);
            }
            self.word(*at);
        }
        if take(&mut self.reachable) {
            self.unreachable();
        }
        self.blocks.extend(outside.into_iter().filter_map(|(at, block)| Some((at, block?))));
    }
}
