//! The bytecode engine: interprets a program.
//!
//! The registers of all calls of a context lie in one array, each call's window directly
//! behind its caller's registers, so that an argument is written where the callee has its
//! parameter. `Activation::run` executes one call until it calls, returns or stops; the loop
//! around it keeps the call frames.

mod activation;
mod arith;
mod context;
mod control;
mod memory;

use kmotiondef::{CodeAddr, GuestAddr};

use self::activation::{Activation, Exit};
use self::context::Context;
use crate::engine::{ContextId, Engine, Slice, Stack, Stop};
use crate::firmware::{Firmware, Outcome, Signature};
use crate::operand::FuncRef;
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
            Stop::Trapped(Trap { kind, at: slice.program.address_of(context.pc), thread: id.thread() })
        })
    }

    fn stack_used(&self, id: ContextId) -> u32 {
        self.contexts[id.index()].as_ref().map_or(0, Context::stack_used)
    }

    fn backtrace(&self, id: ContextId, program: &Program) -> Vec<CodeAddr> {
        let words = self.contexts[id.index()].as_ref().map(Context::calls).unwrap_or_default();
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
        let exit = Activation::run(context, slice);
        // Behind the instruction, from where a call goes on; set back where it does not.
        let next = context.pc + 1;
        match exit {
            Exit::Preempted => {
                context.pc = next;
                return Ok(Stop::Preempted);
            }
            Exit::Trap(kind) => return Err(kind),
            Exit::Call(function) => context.call(program, function)?,
            Exit::Return(result) => {
                context.result = result;
                if !context.leave() {
                    return Ok(Stop::Ended);
                }
            }
            Exit::CallFirmware(address, signature) => {
                let signature = program.signature(signature);
                let Some(callee) = slice.firmware.signature(address) else {
                    return Err(TrapKind::UnknownFirmwareFunction { addr: address });
                };
                check_signature(address, callee, signature)?;
                if let Some(stop) = call_firmware(id, context, slice, address, signature.params.len())? {
                    return Ok(stop);
                }
            }
            Exit::CallPointer(address, signature) => {
                let signature = program.signature(signature);
                if let Some(function) = program.function_at(address) {
                    check_signature(address, program.signature_of(function), signature)?;
                    context.call(program, function)?;
                } else if let Some(callee) = slice.firmware.signature(address) {
                    check_signature(address, callee, signature)?;
                    if let Some(stop) = call_firmware(id, context, slice, address, signature.params.len())? {
                        return Ok(stop);
                    }
                } else {
                    return Err(TrapKind::BadCallTarget { addr: address });
                }
            }
        }
    }
}

/// Makes a firmware call; the stop, if the context does not go on behind it at once.
fn call_firmware<F: Firmware + ?Sized>(
    id: ContextId,
    context: &mut Context,
    slice: &mut Slice<'_, F>,
    address: GuestAddr,
    parameters: usize,
) -> Result<Option<Stop>, TrapKind> {
    let stop = match slice.call_firmware(id, address, context.arguments(parameters))? {
        Outcome::Done(value) => {
            context.result = value.into_slot();
            None
        }
        Outcome::Wait(wake) => return Ok(Some(Stop::Waiting(wake))),
        Outcome::End => return Ok(Some(Stop::Ended)),
        Outcome::Pause => {
            context.result = 0;
            Some(Stop::Paused)
        }
    };
    context.pc += 1;
    Ok(stop)
}

/// Whether `callee` can be called as the instruction says.
fn check_signature(addr: GuestAddr, callee: &Signature, called: &Signature) -> Result<(), TrapKind> {
    if callee.may_be_called_as(called) { Ok(()) } else { Err(TrapKind::SignatureMismatch { addr }) }
}

#[cfg(test)]
mod tests;
