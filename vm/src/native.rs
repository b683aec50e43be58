//! The native engine: translates a program with Cranelift when it is first started.
//!
//! A context is a fiber: a native stack on which the program's machine code runs. For everything that needs more than
//! registers and RAM, the code suspends its fiber with a request. This file answers requests with the functions of the
//! interpreter, which load, store, call the firmware and check signatures. So a firmware function runs on the host's
//! stack and may wait, and a context can be discarded at any moment.
//!
//! Cycles, stops, traps and back traces are those of the bytecode engine. A program that cannot be compiled (on a host
//! without a code generator, or with a function beyond a limit of Cranelift) runs on a fallback bytecode engine.

mod code;
mod compile;
mod context;
mod entry;
mod fiber;
mod piece;
mod protected;
mod request;
mod shared;
mod state;
#[cfg(test)]
mod tests;
mod translate;

use std::sync::Arc;

use kmotiondef::{CodeAddr, GuestAddr};

pub use self::compile::CompileError;
pub use self::shared::SharedCode;

pub(crate) use self::code::Piece;
pub(crate) use self::piece::{Handover, LINES, MARK_BITS, Marks, Places, VALUES};

use self::code::MachineCode;
use self::context::{Context, SavedContext};
use self::fiber::Fiber;
use self::protected::ProtectedBlocks;
use self::translate::FirmwareFacts;
use crate::engine::{ContextId, Executor, ForeignSnapshot, ObservedAccesses, Preemption, Slice, Stack, Stop};
use crate::firmware::Firmware;
use crate::interp::observe::Observer;
use crate::interp::{BytecodeEngine, BytecodeSnapshot};
use crate::program::Program;
use crate::translations::Translations;
use crate::trap::{Trap, TrapKind};

/// Runs programs as machine code, which is compiled when they are started.
#[derive(Debug, Default)]
pub struct NativeEngine {
    contexts: [Option<Context>; ContextId::COUNT],
    /// The machine code of each program; `None` where it cannot be compiled.
    code: Translations<Option<Arc<MachineCode>>>,
    /// Code that this engine has in common with others.
    shared: Option<SharedCode>,
    protected: ProtectedBlocks,
    /// Runs the contexts whose program cannot be compiled.
    bytecode: BytecodeEngine,
    preemption: Preemption,
    /// The observer of accesses to shared memory, if any are reported; if all are, the interpreter runs the program.
    observer: Option<Observer>,
    /// The identity of this engine: a suspended fiber can only continue in its own engine.
    identity: Arc<()>,
}

/// The contexts of a native engine as they were at an instant.
#[derive(Debug)]
pub struct NativeSnapshot {
    contexts: [Option<SavedContext>; ContextId::COUNT],
    bytecode: BytecodeSnapshot,
    identity: Arc<()>,
}

impl NativeEngine {
    /// An engine that shares machine code with the other engines that have the same `shared`.
    #[must_use]
    pub fn with_shared(shared: SharedCode) -> Self {
        Self { shared: Some(shared), ..Self::default() }
    }

    /// The machine code of `program`.
    fn code(&mut self, program: &Arc<Program>, facts: FirmwareFacts<'_>) -> Option<Arc<MachineCode>> {
        let is_observed = self.observer.is_some();
        if self.observer.as_ref().is_some_and(Observer::reports_all) {
            return None;
        }
        let (shared, preemption) = (self.shared.as_ref().filter(|_| !is_observed), self.preemption);
        let compile = |program: &Program| {
            MachineCode::compile(program, facts, (preemption, is_observed)).ok().map(Arc::new)
        };
        self.code.get(program, |program| match shared {
            Some(shared) => shared.get(program, preemption, compile),
            None => compile(program),
        })
    }
}

impl Executor for NativeEngine {
    const TRANSLATES: bool = true;

    type Code = Program;
    type Snapshot = NativeSnapshot;

    fn set_preemption(&mut self, preemption: Preemption) {
        if self.preemption != preemption {
            self.code = Translations::default();
        }
        self.preemption = preemption;
        self.bytecode.set_preemption(preemption);
    }

    fn observe(&mut self, observed: ObservedAccesses) {
        self.observer = Observer::new(observed);
        self.bytecode.observe_with(self.observer.as_ref().map(Observer::for_other_contexts));
    }

    fn start<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        program: &Arc<Program>,
        entry: GuestAddr,
        stack: Stack,
        firmware: &F,
    ) -> Result<(), TrapKind> {
        let missing = TrapKind::BadCallTarget { addr: entry };
        let function = program.function_at(entry).ok_or_else(|| missing.clone())?;
        let old = self.contexts[id.index()].take().map(Context::into_fiber);
        if let Some(observer) = &mut self.observer {
            observer.clear();
        }
        let facts = FirmwareFacts {
            pure: &|address| firmware.pure(address),
            readers: &|address| firmware.reads(address),
        };
        let Some(code) = self.code(program, facts) else {
            return self.bytecode.start(id, program, entry, stack, firmware);
        };
        let index = program.index_of(function).ok_or(missing)?;
        let fiber = Fiber::new(code, index, stack, old);
        self.contexts[id.index()] = Some(Context::new(fiber, Arc::clone(program), function, stack));
        Ok(())
    }

    fn resume<F: Firmware + ?Sized>(&mut self, id: ContextId, slice: &mut Slice<'_, F>) -> Stop {
        let Some(context) = &mut self.contexts[id.index()] else {
            return self.bytecode.resume(id, slice);
        };
        context.run(id, slice, (&mut self.protected, &mut self.observer)).unwrap_or_else(|kind| {
            let trap = Trap::new(kind, context.address(), id.thread());
            context.end(Stop::Trapped(trap))
        })
    }

    fn snapshot(&self) -> NativeSnapshot {
        NativeSnapshot {
            contexts: std::array::from_fn(|index| self.contexts[index].as_ref().map(Context::save)),
            bytecode: self.bytecode.snapshot(),
            identity: Arc::clone(&self.identity),
        }
    }

    fn restore(&mut self, snapshot: &NativeSnapshot) -> Result<(), ForeignSnapshot> {
        if !Arc::ptr_eq(&snapshot.identity, &self.identity) {
            return Err(ForeignSnapshot);
        }
        self.bytecode.restore(&snapshot.bytecode)?;
        for (place, saved) in self.contexts.iter_mut().zip(&snapshot.contexts) {
            // First end the old fiber, which may use the same stack.
            *place = None;
            *place = saved.as_ref().map(SavedContext::context);
        }
        Ok(())
    }

    fn takes_long_slices(&self, id: ContextId) -> bool {
        self.contexts[id.index()].is_some() && self.observer.is_none()
    }

    fn stack_used(&self, id: ContextId) -> u32 {
        self.contexts[id.index()].as_ref().map_or_else(|| self.bytecode.stack_used(id), Context::stack_used)
    }

    fn backtrace(&self, id: ContextId) -> Vec<CodeAddr> {
        self.contexts[id.index()].as_ref().map_or_else(|| self.bytecode.backtrace(id), Context::backtrace)
    }
}
