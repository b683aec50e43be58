//! The bytecode engine: interprets a program.
//!
//! The registers of all calls of a context lie in one array, each call's window directly after its caller's registers,
//! so that an argument is written where the callee has its parameter. `dispatch::execute` goes from instruction to
//! instruction, calls and returns included, until it needs something other than registers and RAM; the loop around it
//! handles that.

#![deny(clippy::wildcard_enum_match_arm, reason = "a new instruction, operator or mode must be decided")]

mod activation;
mod arith;
mod code;
mod context;
mod control;
mod dispatch;
mod holds;
mod jumps;
mod memory;
pub(crate) mod observe;
mod parts;
mod sequences;
mod split;
mod steps;
mod waits;

use std::sync::Arc;

use kmotiondef::jumps::JumpFunction;
use kmotiondef::{CodeAddr, Cycles, GuestAddr};

use self::activation::{Exit, State};
use self::code::{Code, EncodedProgram, Words};
use self::context::{Context, SavedContext};
use self::holds::Holds;
use self::observe::Observer;
use self::split::SegmentRest;
use self::steps::{NextStep, StepState};
use crate::call::CallArguments;
use crate::engine::{
    AccessRange, CallEnd, CallStack, ContextId, Executor, ForeignSnapshot, FrameView, Hold, ObservedAccesses,
    Preemption, Slice, Stack, Stop,
};
use crate::firmware::{Firmware, Outcome, SwitchPoint};
use crate::kind::OpKind;
use crate::memory::GuestMemory;
use crate::operand::SigRef;
use crate::program::Program;
use crate::translations::Translations;
use crate::trap::{Trap, TrapKind};

/// Interprets programs.
#[derive(Debug, Default)]
pub struct BytecodeEngine {
    words: Translations<Arc<EncodedProgram>>,
    contexts: [Option<RunningContext>; ContextId::COUNT],
    holds: Holds,
    steps: StepState,
}

/// A context, and the code that it executes.
#[derive(Debug)]
struct RunningContext {
    code: Code,
    context: Context,
}

impl BytecodeEngine {
    /// Observes contexts that are started from now on with `observer`.
    #[cfg(feature = "native")]
    pub(crate) fn observe_with(&mut self, observer: Option<Observer>) {
        self.steps.observer = observer;
    }

    /// The program that `id` runs.
    pub(crate) fn program(&self, id: ContextId) -> Option<&Arc<Program>> {
        self.contexts[id.index()].as_ref().map(|running| &running.code.program)
    }
}

impl BytecodeEngine {
    /// Updates, in all contexts, the words at which they are held.
    fn refresh(&mut self) {
        for RunningContext { code, .. } in self.contexts.iter_mut().flatten() {
            let observed = self.steps.observed();
            let encode = |program: &Program| EncodedProgram::new(program, observed, &|_| None);
            let plain = self.words.get(&code.program, |program| Arc::new(encode(program)));
            code.words = self.holds.words(&code.program, plain);
        }
    }
}

/// The contexts of a bytecode engine as they were at an instant.
#[derive(Debug)]
pub struct BytecodeSnapshot {
    contexts: [Option<(Code, SavedContext)>; ContextId::COUNT],
    passes: [bool; ContextId::COUNT],
    /// The marks of the owners of pages, where accesses are reported.
    owners: Option<Box<[u8]>>,
}

impl Executor for BytecodeEngine {
    type Code = Program;
    type Snapshot = BytecodeSnapshot;

    fn set_preemption(&mut self, preemption: Preemption) {
        self.steps.preemption = preemption;
    }

    fn observe(&mut self, observed: ObservedAccesses) {
        self.steps.observer = Observer::new(observed);
    }

    fn start<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        program: &Arc<Program>,
        entry: GuestAddr,
        stack: Stack,
        firmware: &F,
    ) -> Result<(), TrapKind> {
        let function = program.function_at(entry).ok_or(TrapKind::BadCallTarget { addr: entry })?;
        let observed = self.steps.observed();
        if let Some(observer) = &mut self.steps.observer {
            observer.clear();
        }
        let encode =
            |program: &Program| EncodedProgram::new(program, observed, &|address| firmware.reads(address));
        let words = self.words.get(program, |program| Arc::new(encode(program)));
        let words = self.holds.words(program, words);
        self.holds.passes[id.index()] = false;
        let code = Code { program: Arc::clone(program), words };
        let place = &mut self.contexts[id.index()];
        let mut context = place.take().map_or_else(Context::new, |running| running.context);
        if context.filter.is_none() {
            context.filter = self.steps.observer.as_ref().and_then(|observer| observer.filter(id));
        }
        context.reset(function, stack);
        *place = Some(RunningContext { code, context });
        Ok(())
    }

    fn resume<F: Firmware + ?Sized>(&mut self, id: ContextId, slice: &mut Slice<'_, F>) -> Stop {
        let Some(RunningContext { code, context }) = &mut self.contexts[id.index()] else {
            return Stop::Ended;
        };
        self.steps.loops = code.words.loops();
        let stop = if self.holds.is_active() {
            self.holds.resume(id, code, context, slice, &mut self.steps)
        } else {
            self.holds.passes[id.index()] = false;
            enter(&code.program, context)
                .and_then(|()| run(id, &code.program, code.words.words(), context, slice, &mut self.steps))
        };
        stop.unwrap_or_else(|kind| {
            let at = code.program.address_of(context.calls.pc);
            Stop::Trapped(Trap::new(kind, at, id.thread()))
        })
    }

    fn snapshot(&self) -> BytecodeSnapshot {
        let save = |running: &RunningContext| (running.code.clone(), running.context.save());
        BytecodeSnapshot {
            contexts: std::array::from_fn(|index| self.contexts[index].as_ref().map(save)),
            passes: self.holds.passes,
            owners: self.steps.observer.as_ref().map(|observer| observer.owners().marks()),
        }
    }

    fn restore(&mut self, snapshot: &BytecodeSnapshot) -> Result<(), ForeignSnapshot> {
        for (place, saved) in self.contexts.iter_mut().zip(&snapshot.contexts) {
            let old = place.take();
            *place = saved.as_ref().map(|(code, saved)| {
                let mut context = old.map_or_else(Context::new, |running| running.context);
                context.put_back(saved);
                RunningContext { code: code.clone(), context }
            });
        }
        self.holds.passes = snapshot.passes;
        if let (Some(observer), Some(marks)) = (&self.steps.observer, &snapshot.owners) {
            observer.owners().put_back(marks);
        }
        self.refresh();
        Ok(())
    }

    fn stack_used(&self, id: ContextId) -> u32 {
        self.contexts[id.index()].as_ref().map_or(0, |running| running.context.stack_used())
    }

    fn backtrace(&self, id: ContextId) -> Vec<CodeAddr> {
        let Some(RunningContext { code, context }) = &self.contexts[id.index()] else { return Vec::new() };
        context.backtrace().into_iter().map(|word| code.program.address_of(word)).collect()
    }

    const HOLDS: bool = true;

    fn set_breakpoints(&mut self, addresses: &[CodeAddr]) {
        self.holds.set_breakpoints(addresses.iter().copied());
        self.refresh();
    }

    fn set_stepping(&mut self, context: Option<ContextId>) {
        self.holds.set_stepping(context);
    }

    fn set_watched(&mut self, memory: &GuestMemory, ranges: &[(GuestAddr, u32)]) {
        self.holds.set_watched(memory, ranges);
        self.refresh();
    }

    fn set_accessed(&mut self, ranges: &[AccessRange]) {
        self.holds.set_accessed(ranges);
        self.refresh();
    }

    fn take_change(&mut self, memory: &GuestMemory) -> Option<usize> {
        self.holds.take_change(memory)
    }

    fn take_hold(&mut self) -> Option<Hold> {
        self.holds.hold.take()
    }

    fn frames(&self, id: ContextId) -> Vec<FrameView> {
        let Some(RunningContext { code, context }) = &self.contexts[id.index()] else { return Vec::new() };
        context.frames(|word| code.program.address_of(word))
    }

    fn set_register(&mut self, id: ContextId, frame: usize, register: u16, slot: u64) -> bool {
        let running = self.contexts[id.index()].as_mut();
        running.is_some_and(|running| running.context.set_in(frame, register, slot))
    }

    fn result(&self, id: ContextId) -> Option<u64> {
        self.contexts[id.index()].as_ref().map(|running| running.context.calls.result)
    }

    fn call<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        program: &Arc<Program>,
        entry: GuestAddr,
        arguments: &[u64],
        stack: CallStack,
        slice: &mut Slice<'_, F>,
    ) -> CallEnd {
        let me = id.index();
        let (kept, passes) = (self.contexts[me].take(), self.holds.passes[me]);
        let mut own = stack.whole;
        if let Some(kept) = kept.as_ref().filter(|_| stack.is_in_use) {
            own.top = kept.context.calls.frame_address();
        }
        let end = self.call_alone(id, program, entry, arguments, own, slice);
        self.contexts[me] = kept;
        self.holds.passes[me] = passes;
        end
    }
}

impl BytecodeEngine {
    /// Calls a function in a fresh context.
    fn call_alone<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        program: &Arc<Program>,
        entry: GuestAddr,
        arguments: &[u64],
        stack: Stack,
        slice: &mut Slice<'_, F>,
    ) -> CallEnd {
        let trap = |kind, at| CallEnd::Trapped(Trap::new(kind, at, id.thread()));
        let Some(function) = program.function_at(entry) else { return CallEnd::NoFunction };
        if program.signature_of(function).params.len() != arguments.len() {
            return CallEnd::NoFunction;
        }
        let at = program.address_of(function.0 as usize);
        if let Err(kind) = self.start(id, program, entry, stack, slice.firmware) {
            return trap(kind, at);
        }
        let Some(RunningContext { code, context }) = &mut self.contexts[id.index()] else {
            return CallEnd::NoFunction;
        };
        if let Err(kind) = enter(&code.program, context) {
            return trap(kind, at);
        }
        for (register, slot) in (0..).zip(arguments) {
            context.set(register, *slot);
        }
        let stop = self.resume(id, slice);
        let Some(RunningContext { context, .. }) = &self.contexts[id.index()] else {
            return CallEnd::NoFunction;
        };
        let at = program.address_of(context.calls.pc);
        let op = program.ops().get(context.calls.pc);
        match stop {
            Stop::Ended if op.is_some_and(|op| matches!(op.kind(), OpKind::Return(_))) => {
                CallEnd::Returned(context.calls.result)
            }
            Stop::Ended => CallEnd::EndsThread,
            Stop::Waiting(_) => CallEnd::Waits(at),
            Stop::Trapped(trap) => CallEnd::Trapped(trap),
            Stop::Preempted | Stop::NeedsBoard | Stop::Held => CallEnd::Endless(slice.length),
        }
    }
}

/// Enters the entry function of a context that has not run yet.
fn enter(program: &Program, context: &mut Context) -> Result<(), TrapKind> {
    match context.pending.take() {
        Some(function) => context.enter(program, function),
        None => Ok(()),
    }
}

/// Runs `context` until it stops; when it traps, its `pc` is the instruction that did it.
fn run<F: Firmware + ?Sized>(
    id: ContextId,
    program: &Program,
    words: &Words,
    context: &mut Context,
    slice: &mut Slice<'_, F>,
    steps: &mut StepState,
) -> Result<Stop, TrapKind> {
    if let Some(filter) = &context.filter {
        filter.continues(slice.tick);
    }
    loop {
        let mut exit = Exit::Shared;
        if context.split.is_none() {
            exit = execute(program, words, context, slice);
        }
        let is_alone = matches!(exit, Exit::Shared);
        if is_alone {
            let access = steps.observer.as_mut().and_then(|observer| observer.about_to(program, context));
            if let Some(access) = access.as_ref().filter(|_| !context.has_high_word())
                && let Some(point) = access.switch_at(id, program, slice)
            {
                if point == SwitchPoint::BetweenWords
                    && context.stores_low_word(program, slice)?
                    && let Some(observer) = &mut steps.observer
                {
                    access.report(id, program, context, observer, slice);
                }
                slice.budget = Cycles::default();
                return Ok(Stop::Preempted);
            }
            match context.next_step(program, words, slice)? {
                NextStep::Held => return Ok(Stop::Held),
                step @ (NextStep::Preempted | NextStep::StoredLowWord) => {
                    if let (NextStep::StoredLowWord, Some(access), Some(observer)) =
                        (step, access, &mut steps.observer)
                    {
                        access.report(id, program, context, observer, slice);
                    }
                    return Ok(Stop::Preempted);
                }
                NextStep::Executed => continue,
                NextStep::Execute => {}
            }
            let pc = context.calls.pc;
            let alone = steps.single.with(program, words, pc, |word| execute(program, word, context, slice));
            exit = alone.unwrap_or(Exit::Trap(TrapKind::Unreachable));
            if let (Some(access), Some(observer)) = (access, &mut steps.observer)
                && matches!(exit, Exit::Held | Exit::Copy { .. } | Exit::Clear { .. })
            {
                access.report(id, program, context, observer, slice);
            }
        }
        match exit {
            Exit::Preempted => {
                let charge = context.calls.pc;
                context.calls.pc += 1;
                match steps.preemption {
                    Preemption::Segments => return Ok(Stop::Preempted),
                    Preemption::Instructions => {
                        context.split = SegmentRest::begin(program, charge, &mut slice.budget);
                    }
                }
            }
            // The context is held at the instruction after the single step.
            Exit::Held | Exit::Shared if is_alone => {}
            Exit::Load(address, width, register) => {
                let slot = slice.load_slot(address, width)?;
                context.set(register, slot);
                context.calls.pc += 1;
            }
            Exit::Store(address, width, slot) => {
                slice.store_slot(address, width, slot)?;
                context.calls.pc += 1;
            }
            Exit::Copy { to, from, len } => {
                slice.memory.copy(to, from, len.into())?;
                context.calls.pc += 1;
            }
            Exit::Clear { to, len } => {
                slice.memory.fill(to, 0, len.into())?;
                context.calls.pc += 1;
            }
            Exit::Trap(kind) => return Err(kind),
            Exit::Held | Exit::Shared => return Ok(Stop::Held),
            Exit::Call(function) => context.call(program, function)?,
            Exit::EndsIteration => {
                if let Some(stop) = waits::wait(id, program, words, context, slice, steps)? {
                    return Ok(stop);
                }
            }
            Exit::Ended => return Ok(Stop::Ended),
            Exit::CallFirmware(address, signature) => {
                let missing = TrapKind::UnknownFirmwareFunction { addr: address };
                if let Some(stop) = call_firmware(id, program, context, slice, (address, signature), missing)?
                {
                    return Ok(stop);
                }
            }
            Exit::CallPointer(address, signature) => {
                if let Some(function) = program.function_at(address) {
                    let called = program.signature(signature);
                    program.signature_of(function).check_call(address, called)?;
                    context.call(program, function)?;
                    continue;
                }
                let missing = TrapKind::BadCallTarget { addr: address };
                if let Some(stop) = call_firmware(id, program, context, slice, (address, signature), missing)?
                {
                    return Ok(stop);
                }
            }
        }
    }
}

/// Executes `context`; its `pc` is then the instruction that ended the execution.
fn execute<F: Firmware + ?Sized>(
    program: &Program,
    words: &Words,
    context: &mut Context,
    slice: &mut Slice<'_, F>,
) -> Exit {
    let (calls, registers, filter) = context.execution();
    let (sdram, ram) = slice.memory.split();
    let budget = slice.budget.get();
    let mut state = State { words, program, ram, budget, registers, calls, exit: None, filter };
    let exit = dispatch::execute(&mut state, sdram);
    slice.budget = Cycles::new(state.budget);
    exit
}

/// Makes a firmware call; returns the stop if the context does not continue at once after it.
///
/// # Errors
/// `missing` if there is no function at `address`, or what the call itself yields.
fn call_firmware<F: Firmware + ?Sized>(
    id: ContextId,
    program: &Program,
    context: &mut Context,
    slice: &mut Slice<'_, F>,
    (address, called): (GuestAddr, SigRef),
    missing: TrapKind,
) -> Result<Option<Stop>, TrapKind> {
    let called = program.signature(called);
    if let Some(function) = JumpFunction::at(address) {
        return jumps::call(id, function, called, context, slice).map(|()| None);
    }
    slice.firmware.signature(address).ok_or(missing)?.check_call(address, called)?;
    let arguments = CallArguments::from_slots(context.arguments(called.params.len()));
    let outcome = slice.call_firmware(id, address, arguments, program.address_of(context.calls.pc))?;
    if let Some(filter) = &context.filter
        && slice.firmware.take_ordering()
    {
        filter.clear();
    }
    match outcome {
        Outcome::Done(value) => {
            context.calls.result = value.into_slot();
            context.calls.pc += 1;
            Ok(None)
        }
        Outcome::Wait(wake) => Ok(Some(Stop::Waiting(wake))),
        Outcome::End => Ok(Some(Stop::Ended)),
    }
}

#[cfg(test)]
mod tests;
