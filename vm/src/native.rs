//! The native engine: translates a program with Cranelift when it is first started.
//!
//! A context is a fiber: a native stack on which the program's machine code runs. Whatever the
//! code cannot do with registers and RAM alone it requests by suspending its fiber; this file
//! answers, in the words of the interpreter: the same functions load, store, call the firmware and
//! check signatures. So a firmware function runs on the host's stack, may take its time, may wait,
//! and a context can be discarded at any moment.
//!
//! Cycles, stops, traps and back traces are those of the bytecode engine. A program that cannot
//! be compiled (a host without code generator, a function beyond a limit of Cranelift's) runs on
//! a bytecode engine kept for that.

mod code;
mod compile;
mod context;
mod entry;
mod fiber;
mod linked;
mod object;
mod protected;
mod request;
mod state;
#[cfg(test)]
mod tests;
mod translate;

use std::sync::Arc;

use kmotiondef::CodeAddr;

pub use self::compile::CompileError;
pub use self::linked::{Description, Linked, LinkedError};
pub use self::object::{PREFIX, Parts, START, object};

pub(crate) use self::code::Compiled;
use self::context::Context;
use self::fiber::Fiber;
use self::protected::ProtectedBlocks;
use crate::engine::{ContextId, Engine, Slice, Stack, Stop};
use crate::firmware::Firmware;
use crate::interp::BytecodeEngine;
use crate::operand::FuncRef;
use crate::program::Program;
use crate::trap::Trap;

/// Runs programs as machine code.
#[derive(Debug, Default)]
pub struct NativeEngine {
    contexts: [Option<Context>; ContextId::COUNT],
    protected: ProtectedBlocks,
    /// Runs the contexts whose program cannot be compiled.
    bytecode: BytecodeEngine,
}

impl Engine for NativeEngine {
    fn start<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        program: &Program,
        function: FuncRef,
        stack: Stack,
        firmware: &F,
    ) {
        let old = self.contexts[id.index()].take().map(Context::into_fiber);
        let found = program.functions().binary_search_by_key(&function, |function| function.at);
        if let (Some(code), Ok(index)) =
            (program.compiled.code(program, &|address| firmware.pure(address)), found)
        {
            let fiber = Fiber::new(Arc::clone(code), index, stack, old);
            self.contexts[id.index()] = Some(Context::new(fiber, function, stack));
        } else {
            self.bytecode.start(id, program, function, stack, firmware);
        }
    }

    fn resume<F: Firmware + ?Sized>(&mut self, id: ContextId, slice: &mut Slice<'_, F>) -> Stop {
        let Some(context) = &mut self.contexts[id.index()] else {
            return self.bytecode.resume(id, slice);
        };
        context.run(id, slice, &mut self.protected).unwrap_or_else(|kind| {
            let trap = Trap { kind, at: slice.program.address_of(context.at()), thread: id.thread() };
            context.end(Stop::Trapped(trap))
        })
    }

    fn takes_long_slices(&self, id: ContextId) -> bool {
        self.contexts[id.index()].is_some()
    }

    fn stack_used(&self, id: ContextId) -> u32 {
        self.contexts[id.index()].as_ref().map_or_else(|| self.bytecode.stack_used(id), Context::stack_used)
    }

    fn backtrace(&self, id: ContextId, program: &Program) -> Vec<CodeAddr> {
        let Some(context) = &self.contexts[id.index()] else {
            return self.bytecode.backtrace(id, program);
        };
        context.calls(program).into_iter().map(|word| program.address_of(word)).collect()
    }
}
