//! Calls of functions that return early, such as the last call of a recursion, or a guard whose condition fails.
//!
//! If a path of few words leads from the beginning of a function to a return, without a store or a request, its callers
//! inline it. This is an attempt: at its end, the budget must cover the path, so that no charge on it could have ended
//! the slice, and the stack must have been at least as deep before. In all other cases the call is made, and the state
//! is unchanged.

use std::collections::{BTreeMap, BTreeSet};
use std::mem::{offset_of, replace, take};
use std::rc::Rc;

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{Block, InstBuilder, Value, types};
use cranelift_frontend::Variable;

use super::super::state::{BYTES_PER_CALL, State};
use super::memory::is_in_sdram;
use super::nan::lax_registers;
use super::{Translator, type_of, zero};
use crate::kind::{OpKind, Width};
use crate::meter::branch_target;
use crate::op::Op;
use crate::operand::{FuncRef, Off, RegI32};
use crate::program::{Function, Program};

/// The most words of a function that are searched, and the most registers that it may have.
const MAX_WORDS: usize = 32;
const MAX_REGISTERS: usize = 64;

/// The most attempts in one function: each adds blocks and registers to it, and the time and memory that its translation
/// takes grow faster than their number.
const MAX_ATTEMPTS: usize = 16;

/// The words of a path to a return, in ascending order, which is the order of execution.
pub(super) type ShortcutWords = Rc<BTreeSet<usize>>;

/// The words of `function` from which an attempt gets to a return; `None` if its first word is not one.
fn shortcut(program: &Program, function: &Function, may_load: bool) -> Option<BTreeSet<usize>> {
    let first = function.body.start;
    let mut search = ReturnSearch { program, may_load, leads: BTreeMap::new() };
    let found = function.classes.len() <= MAX_REGISTERS && search.leads_to_return(first);
    found.then(|| search.leads.into_iter().filter(|(_, leads)| *leads).map(|(at, _)| at).collect())
}

/// Looks for paths to a return.
struct ReturnSearch<'a> {
    program: &'a Program,
    /// False where loads are reported.
    may_load: bool,
    /// True for each visited word that leads to a return.
    leads: BTreeMap<usize, bool>,
}

impl ReturnSearch<'_> {
    fn leads_to_return(&mut self, at: usize) -> bool {
        if let Some(leads) = self.leads.get(&at) {
            return *leads;
        }
        self.leads.insert(at, false);
        let leads = self.leads.len() <= MAX_WORDS && self.follow(at);
        self.leads.insert(at, leads);
        leads
    }

    fn follow(&mut self, at: usize) -> bool {
        let op = self.program.ops()[at];
        match op.kind() {
            OpKind::Return(_) => true,
            OpKind::Charge | OpKind::Constant | OpKind::Move | OpKind::Negation | OpKind::Conversion => {
                self.leads_to_return(at + 1)
            }
            OpKind::Arithmetic => !may_divide_by_zero(&op) && self.leads_to_return(at + 1),
            OpKind::Load(_) => self.may_load && is_in_sdram(&op) && self.leads_to_return(at + 1),
            OpKind::Jump => self.branch(at, &op),
            OpKind::Branch => {
                let next = self.leads_to_return(at + 1);
                self.branch(at, &op) || next
            }
            OpKind::Structure
            | OpKind::Address
            | OpKind::Store(_)
            | OpKind::Block
            | OpKind::Table
            | OpKind::Argument(_)
            | OpKind::Call
            | OpKind::Result(_)
            | OpKind::Stop => false,
        }
    }

    /// Reports whether the target of the branch `op` is a later word that leads to a return.
    fn branch(&mut self, at: usize, op: &Op) -> bool {
        let target = branch_target(op).map(|to| to.0 as usize).filter(|to| *to > at);
        target.is_some_and(|to| self.leads_to_return(to))
    }
}

/// Reports whether an instruction is a division of integers.
const fn may_divide_by_zero(op: &Op) -> bool {
    matches!(
        op,
        Op::DivI32S { .. }
            | Op::DivI32U { .. }
            | Op::RemI32S { .. }
            | Op::RemI32U { .. }
            | Op::DivI64S { .. }
            | Op::DivI64U { .. }
            | Op::RemI64S { .. }
            | Op::RemI64U { .. }
    )
}

/// The blocks of the current attempt.
#[derive(Clone, Copy)]
pub(super) struct Attempt {
    /// Makes the call.
    call: Block,
    /// Takes the result, as a slot.
    behind: Block,
}

impl<'a> Translator<'a, '_> {
    /// The path to a return of the function with the given index, if callers attempt to inline it.
    fn shortcut_of(&mut self, index: usize) -> Option<ShortcutWords> {
        // Code for the rare case stays small.
        if self.unroll.is_rare || self.calls.attempts == MAX_ATTEMPTS {
            return None;
        }
        let program = self.translation.program;
        let may_load = self.translation.observed.is_none();
        let find = || shortcut(program, &program.functions()[index], may_load).map(Rc::new);
        self.calls.shortcuts.entry(index).or_insert_with(find).clone()
    }

    pub(super) fn call(&mut self, func: FuncRef) {
        let index = self.function_index(func);
        let Some(words) = self.shortcut_of(index) else {
            return self.make_call(index);
        };
        self.calls.attempts += 1;
        let budget = self.builder.use_var(self.registers.budget);
        let attempt = Attempt { call: self.builder.create_block(), behind: self.builder.create_block() };
        let result = self.builder.append_block_param(attempt.behind, types::I64);
        self.attempt(&self.translation.program.functions()[index], &words, attempt);

        self.enter(attempt.call);
        self.builder.def_var(self.registers.budget, budget);
        self.make_call(index);
        let slot = self.calls.result.unwrap_or(budget);
        self.builder.ins().jump(attempt.behind, &[slot.into()]);

        self.enter(attempt.behind);
        self.calls.result = Some(result);
        self.reachable = true;
    }

    /// Translates `words` of `callee` with registers of their own.
    fn attempt(&mut self, callee: &'a Function, words: &BTreeSet<usize>, attempt: Attempt) {
        let variables = self.callee_registers(callee);
        let lax = lax_registers(self.translation.program, callee, self.calls.arguments.len());
        let blocks = self.attempt_blocks(words, attempt);
        let at = self.at;
        let blocks = replace(&mut self.blocks, blocks);
        let variables = replace(&mut self.registers.variables, variables);
        let lax = replace(&mut self.registers.lax, lax);
        let raw = take(&mut self.registers.raw);
        let function = replace(&mut self.translation.function, callee);
        self.calls.attempt = Some(attempt);
        for at in words {
            if let Some(block) = self.blocks.get(at).copied() {
                self.begin(block);
            }
            self.word(*at);
        }
        self.calls.attempt = None;
        self.translation.function = function;
        self.registers.raw = raw;
        self.registers.lax = lax;
        self.registers.variables = variables;
        self.blocks = blocks;
        self.at = at;
    }

    /// The registers of `callee` as it begins.
    fn callee_registers(&mut self, callee: &Function) -> Vec<Variable> {
        let mut variables = Vec::new();
        for (index, class) in callee.classes.iter().enumerate() {
            let variable = self.builder.declare_var(type_of(*class));
            let argument = self.calls.arguments.get(index).copied();
            let value = argument.unwrap_or_else(|| zero(&mut self.builder, *class));
            self.builder.def_var(variable, value);
            variables.push(variable);
        }
        variables
    }

    /// The blocks at which `words` are entered; ways out of them lead to the call.
    fn attempt_blocks(&mut self, words: &BTreeSet<usize>, attempt: Attempt) -> BTreeMap<usize, Block> {
        let mut blocks = BTreeMap::new();
        for at in words {
            let op = self.translation.program.ops()[*at];
            let next = (op.kind() == OpKind::Branch).then_some(at + 1);
            for to in branch_target(&op).map(|to| to.0 as usize).into_iter().chain(next) {
                let builder = &mut self.builder;
                let is_inside = words.contains(&to);
                blocks
                    .entry(to)
                    .or_insert_with(|| if is_inside { builder.create_block() } else { attempt.call });
            }
        }
        blocks
    }

    /// Ends an attempt with the result `slot`, if it succeeds.
    pub(super) fn end_attempt(&mut self, attempt: Attempt, slot: Value) {
        let (paid, room) = (self.builder.create_block(), self.builder.create_block());
        let left = self.builder.use_var(self.registers.budget);
        let overdrawn = self.builder.ins().icmp_imm_s(IntCC::SignedLessThan, left, 0);
        self.builder.ins().brif(overdrawn, attempt.call, &[], paid, &[]);
        self.enter(paid);
        let bytes = i64::from(self.translation.function.frame + BYTES_PER_CALL);
        let lowest = self.load_state(types::I32, offset_of!(State, stack.lowest));
        self.branch_if_room(self.frame.stack_pointer, lowest, bytes, room, attempt.call);
        self.enter(room);
        self.builder.ins().jump(attempt.behind, &[slot.into()]);
        self.reachable = false;
    }

    /// Loads in an attempt, which fails for an address outside SDRAM.
    pub(super) fn load_in_attempt(
        &mut self,
        attempt: Attempt,
        base: RegI32,
        off: Off,
        width: Width,
    ) -> Value {
        let place = self.place(base, off);
        let bits = self.wrong_bits_in_sdram(place, width);
        let inside = self.builder.create_block();
        self.builder.ins().brif(bits, attempt.call, &[], inside, &[]);
        self.enter(inside);
        let place = self.builder.ins().uextend(types::I64, place);
        let sdram = self.load_pointer(offset_of!(State, ram.sdram));
        let pointer = self.builder.ins().iadd(sdram, place);
        self.load_guest(pointer, 0, width)
    }
}
