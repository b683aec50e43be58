//! The engines of a machine: the program of a thread determines the engine of its context.

use kmotiondef::{CodeAddr, GuestAddr};

use crate::dsp::{DspEngine, DspSnapshot};
use crate::engine::{ContextId, Engine, Executor, ForeignSnapshot, Slice, Stack, Stop};
use crate::firmware::Firmware;
use crate::loaded::LoadedCode;
use crate::scheduler::ThreadSet;
use crate::trap::TrapKind;

/// A snapshot of the contexts of all engines; `S` is the snapshot of the bytecode engine.
#[derive(Debug)]
pub(super) struct EnginesSnapshot<S> {
    programs: S,
    images: DspSnapshot,
}

/// One engine for each kind of [`LoadedCode`].
///
/// A context is named with its code, which determines its engine.
#[derive(Debug)]
pub(super) struct Engines<E> {
    /// Runs bytecode.
    pub(super) programs: E,
    /// Runs real images.
    pub(super) images: DspEngine,
    /// The threads that have run bytecode. No snapshot sets it back.
    pub(super) ran: ThreadSet,
}

impl<E: Engine> Engines<E> {
    /// Gives `id` a fresh context at the function `entry` of `loaded`.
    ///
    /// # Errors
    /// [`TrapKind::BadCallTarget`] if there is no such function.
    pub(super) fn start<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        loaded: &LoadedCode,
        entry: GuestAddr,
        stack: Stack,
        firmware: &F,
    ) -> Result<(), TrapKind> {
        match loaded {
            LoadedCode::Program(program) => self.programs.start(id, program, entry, stack, firmware),
            LoadedCode::Image(image) => self.images.start(id, image, entry, stack, firmware),
        }
    }

    /// Runs `id` until it stops.
    pub(super) fn resume<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        loaded: &LoadedCode,
        slice: &mut Slice<'_, F>,
    ) -> Stop {
        match loaded {
            LoadedCode::Program(_) => {
                self.ran = id.thread().map_or(self.ran, |thread| self.ran.with(thread));
                self.programs.resume(id, slice)
            }
            LoadedCode::Image(_) => self.images.resume(id, slice),
        }
    }

    /// A snapshot of all contexts.
    pub(super) fn snapshot(&self) -> EnginesSnapshot<E::Snapshot> {
        EnginesSnapshot { programs: self.programs.snapshot(), images: self.images.snapshot() }
    }

    /// Restores all contexts.
    ///
    /// # Errors
    /// [`ForeignSnapshot`] if they cannot continue here; nothing is changed in that case.
    pub(super) fn restore(&mut self, snapshot: &EnginesSnapshot<E::Snapshot>) -> Result<(), ForeignSnapshot> {
        self.programs.restore(&snapshot.programs)?;
        self.images.restore(&snapshot.images)
    }

    /// Reports whether `id` may be resumed with a [long slice](Slice::is_long).
    pub(super) fn takes_long_slices(&self, id: ContextId, loaded: &LoadedCode) -> bool {
        match loaded {
            LoadedCode::Program(_) => self.programs.takes_long_slices(id),
            LoadedCode::Image(_) => self.images.takes_long_slices(id),
        }
    }

    /// The most bytes of its stack that `id` has used since its start.
    pub(super) fn stack_used(&self, id: ContextId, loaded: &LoadedCode) -> u32 {
        match loaded {
            LoadedCode::Program(_) => self.programs.stack_used(id),
            LoadedCode::Image(_) => self.images.stack_used(id),
        }
    }

    /// The position of `id`: its instruction, then the calls that led to it, innermost first.
    pub(super) fn backtrace(&self, id: ContextId, loaded: &LoadedCode) -> Vec<CodeAddr> {
        match loaded {
            LoadedCode::Program(_) => self.programs.backtrace(id),
            LoadedCode::Image(_) => self.images.backtrace(id),
        }
    }
}
