//! The bytecode engine: interprets a program.
//!
//! The registers of all calls of a context lie in one array, each call's window directly
//! behind its caller's registers, so that an argument is written where the callee has its
//! parameter. `dispatch::execute` goes from instruction to instruction, calls and returns
//! included, until something else is needed than registers and RAM; the loop around it sees to that.

mod activation;
mod arith;
mod code;
mod context;
mod control;
mod dispatch;
mod memory;
mod sequences;

use kmotiondef::{CodeAddr, Cycles, GuestAddr};

use self::activation::{Exit, State};
pub(crate) use self::code::Code;
use self::context::Context;
use crate::engine::{ContextId, Engine, Slice, Stack, Stop};
use crate::firmware::{Firmware, Outcome};
use crate::operand::{FuncRef, SigRef};
use crate::program::Program;
use crate::trap::{Trap, TrapKind};

/// Interprets programs.
#[derive(Debug, Default)]
pub struct BytecodeEngine {
    contexts: [Option<Context>; ContextId::COUNT],
}

impl Engine for BytecodeEngine {
    fn start<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        _program: &Program,
        function: FuncRef,
        stack: Stack,
        _firmware: &F,
    ) {
        self.contexts[id.index()].get_or_insert_with(Context::new).reset(function, stack);
    }

    fn resume<F: Firmware + ?Sized>(&mut self, id: ContextId, slice: &mut Slice<'_, F>) -> Stop {
        let Some(context) = &mut self.contexts[id.index()] else {
            return Stop::Ended;
        };
        run(id, context, slice).unwrap_or_else(|kind| {
            Stop::Trapped(Trap { kind, at: slice.program.address_of(context.calls.pc), thread: id.thread() })
        })
    }

    fn stack_used(&self, id: ContextId) -> u32 {
        self.contexts[id.index()].as_ref().map_or(0, Context::stack_used)
    }

    fn backtrace(&self, id: ContextId, program: &Program) -> Vec<CodeAddr> {
        let words = self.contexts[id.index()].as_ref().map(Context::backtrace).unwrap_or_default();
        words.into_iter().map(|word| program.address_of(word)).collect()
    }
}

/// Runs `context` until it stops; when it traps, its `pc` is the instruction that did it.
fn run<F: Firmware + ?Sized>(
    id: ContextId,
    context: &mut Context,
    slice: &mut Slice<'_, F>,
) -> Result<Stop, TrapKind> {
    let program = slice.program;
    if let Some(function) = context.pending.take() {
        context.enter(program, function)?;
    }
    loop {
        let exit = execute(context, slice);
        match exit {
            Exit::Preempted => {
                context.calls.pc += 1;
                return Ok(Stop::Preempted);
            }
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
            Exit::Call(function) => context.call(program, function)?,
            Exit::Ended => return Ok(Stop::Ended),
            Exit::CallFirmware(address, signature) => {
                let missing = TrapKind::UnknownFirmwareFunction { addr: address };
                if let Some(stop) = call_firmware(id, context, slice, address, signature, missing)? {
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
                if let Some(stop) = call_firmware(id, context, slice, address, signature, missing)? {
                    return Ok(stop);
                }
            }
        }
    }
}

/// Executes `context`, whose `pc` is then the instruction that ended that.
fn execute<F: Firmware + ?Sized>(context: &mut Context, slice: &mut Slice<'_, F>) -> Exit {
    let program = slice.program;
    let (calls, registers) = context.parts();
    let mut state =
        State { program, memory: slice.memory, budget: slice.budget.get(), registers, calls, exit: None };
    let exit = dispatch::execute(&mut state, program.code.words(&program.ops));
    slice.budget = Cycles::new(state.budget);
    exit
}

/// Makes a firmware call; the stop, if the context does not go on behind it at once.
///
/// # Errors
/// `missing` if there is no function at `address`, or what the call itself yields.
fn call_firmware<F: Firmware + ?Sized>(
    id: ContextId,
    context: &mut Context,
    slice: &mut Slice<'_, F>,
    address: GuestAddr,
    signature: SigRef,
    missing: TrapKind,
) -> Result<Option<Stop>, TrapKind> {
    let called = slice.program.signature(signature);
    slice.firmware.signature(address).ok_or(missing)?.check_call(address, called)?;
    let stop = match slice.call_firmware(id, address, context.arguments(called.params.len()))? {
        Outcome::Done(value) => {
            context.calls.result = value.into_slot();
            None
        }
        Outcome::Wait(wake) => return Ok(Some(Stop::Waiting(wake))),
        Outcome::End => return Ok(Some(Stop::Ended)),
        Outcome::Pause => {
            context.calls.result = 0;
            Some(Stop::Paused)
        }
    };
    context.calls.pc += 1;
    Ok(stop)
}

#[cfg(test)]
mod tests;
