//! Compiled programs: memory that holds machine code, and the addresses in it.
#![expect(unsafe_code, reason = "owns machine code and hands out pointers into it")]

use std::fmt;
use std::mem::ManuallyDrop;

use cranelift_codegen::ir::{AbiParam, Function, types};
use cranelift_frontend::FunctionBuilderContext;
use cranelift_jit::{ArenaMemoryProvider, JITBuilder, JITModule};
use cranelift_module::{FuncId, Module, default_libcall_names};

use super::compile::{CompileError, StackUse, compile, host_isa};
use super::entry::{BeginFn, RunPiece};
use super::piece::{Handover, Marks, Places};
use super::translate::FirmwareFacts;
use crate::engine::Preemption;
use crate::memory::GuestMemory;
use crate::polling::{PollingLoop, polling_loops};
use crate::program::Program;

/// Bytes of address space for a piece.
const PIECE_ROOM: usize = 0x10_0000;

/// Bytes of native stack for everything except the program's functions: the entry code, and requests.
const STACK_RESERVE: usize = 0x1_0000;

/// Bytes of address space for the machine code of one function, and of one instruction word.
const RESERVE_PER_FUNCTION: usize = 0x1000;
const RESERVE_PER_WORD: usize = 0x400;

/// The longest function, in words, that is translated when it is started: the time that Cranelift takes grows with the
/// square of the length, and is a second or two at this limit. Longer functions are tables written as statements, which
/// run once.
const MAX_WORDS: usize = 0x4000;

/// The entry of a function for calls through a pointer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    /// The thunk, which passes the function its arguments.
    pub(super) thunk: *const u8,
    /// The function.
    pub(super) pointer: *const u8,
}

/// The machine code of one program.
pub(super) struct MachineCode {
    /// The memory that holds the code.
    _memory: CodeMemory,
    begin: BeginFn,
    entries: Vec<Entry>,
    loops: Vec<PollingLoop>,
    stack: StackUse,
}

// SAFETY: nothing changes after `compile`; the pointers lead to memory that any thread may read and execute.
unsafe impl Send for MachineCode {}
// SAFETY: as above; the module, whose methods are not thread-safe, is not used before it is dropped.
unsafe impl Sync for MachineCode {}

impl fmt::Debug for MachineCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Code").field("entries", &self.entries.len()).finish_non_exhaustive()
    }
}

/// A module that frees its machine code when it is dropped.
struct CodeMemory(ManuallyDrop<JITModule>);

impl CodeMemory {
    /// Room for the code of `program`.
    fn new(
        program: &Program,
        loops: &[PollingLoop],
        preemption: Preemption,
        is_observed: bool,
    ) -> Result<Self, CompileError> {
        // A segment that may be split is translated a second time.
        let copies = if preemption == Preemption::Instructions { 3 } else { 1 };
        // A report takes about as much as the access.
        let copies = copies * (1 + usize::from(is_observed));
        // So is an iteration of a loop that may only wait.
        let repeated: usize = loops.iter().map(|polling| polling.words.len()).sum();
        Self::with_room(
            program.functions().len() * 2 * RESERVE_PER_FUNCTION
                + (program.ops().len() + repeated) * RESERVE_PER_WORD * copies,
        )
    }

    /// Room for this many bytes of code.
    fn with_room(reserve: usize) -> Result<Self, CompileError> {
        let mut builder = JITBuilder::with_isa(host_isa()?, default_libcall_names());
        // One piece, so that every call reaches its target.
        let arena =
            ArenaMemoryProvider::new_with_size(reserve).map_err(|error| CompileError::host(&error))?;
        builder.memory_provider(Box::new(arena));
        Ok(Self(ManuallyDrop::new(JITModule::new(builder))))
    }
}

impl Drop for CodeMemory {
    fn drop(&mut self) {
        // SAFETY: the module is taken once and not used again.
        let module = unsafe { ManuallyDrop::take(&mut self.0) };
        // SAFETY: only `Code` gives out pointers to the code, and the fiber that runs the code holds the `Code`, and so
        // this module, until it has stopped.
        unsafe { module.free_memory() };
    }
}

impl MachineCode {
    /// Compiles `program`, for a firmware with these `facts`.
    pub(super) fn compile(
        program: &Program,
        facts: FirmwareFacts<'_>,
        (preemption, is_observed): (Preemption, bool),
    ) -> Result<Self, CompileError> {
        let mut lengths = program.functions().iter().map(|function| function.body.len());
        if let Some(length) = lengths.find(|length| *length > MAX_WORDS) {
            return Err(CompileError::TooLong(length));
        }
        let loops = polling_loops(program, facts.readers);
        let mut memory = CodeMemory::new(program, &loops, preemption, is_observed)?;
        let functions = compile(&mut *memory.0, program, facts.pure, &loops, (preemption, is_observed))?;
        memory.0.finalize_definitions()?;
        let at = |id: FuncId| memory.0.get_finalized_function(id);
        let entries = functions.entries.into_iter();
        let entries = entries.map(|(thunk, id)| Entry { thunk: at(thunk), pointer: at(id) }).collect();
        let begin = begin_at(at(functions.begin));
        Ok(Self { begin, entries, loops, _memory: memory, stack: functions.stack })
    }

    /// The loops of the program that may only wait.
    pub(super) fn loops(&self) -> &[PollingLoop] {
        &self.loops
    }

    /// The function that begins the outermost call.
    pub(super) const fn begin(&self) -> BeginFn {
        self.begin
    }

    /// The entry of the function with the given index.
    pub(super) fn entry(&self, function: usize) -> Entry {
        self.entries[function]
    }

    /// Bytes of native stack that the program cannot exceed on a guest stack of `guest` bytes.
    ///
    /// Compiled code checks the guest stack at every call, so the depth of calls is bounded, and with it their use of
    /// the native stack.
    pub(super) fn stack_size(&self, guest: u32) -> usize {
        let StackUse { native_per_guest, largest_frame } = self.stack;
        guest as usize * native_per_guest as usize + largest_frame as usize + STACK_RESERVE
    }
}

/// The function of a piece at `pointer`.
fn piece_at(pointer: *const u8) -> RunPiece {
    // SAFETY: it is translated with the signature of `RunPiece` (`Piece::compile`).
    unsafe { std::mem::transmute::<*const u8, RunPiece>(pointer) }
}

/// The function at `pointer`, which begins the outermost call.
fn begin_at(pointer: *const u8) -> BeginFn {
    // SAFETY: it is translated with the signature of `BeginFn` (`begin_signature`).
    unsafe { std::mem::transmute::<*const u8, BeginFn>(pointer) }
}

/// A piece of machine code that works on a [`Handover`].
pub(crate) struct Piece {
    _memory: CodeMemory,
    entry: RunPiece,
}

// SAFETY: nothing changes after `compile`; the pointer leads to memory that any thread may read and execute.
unsafe impl Send for Piece {}
// SAFETY: as above; the module is not used before it is dropped.
unsafe impl Sync for Piece {}

impl fmt::Debug for Piece {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Piece").finish_non_exhaustive()
    }
}

impl Piece {
    /// Compiles the function that `translate` writes, if it succeeds: it takes pointers to a [`Handover`] and to
    /// [`Places`] and returns a number.
    ///
    /// It must access nothing but these and the memory that the [`Places`] point to: 64 registers, both RAMs, and a
    /// mark for each line of RAM.
    pub(crate) fn compile(
        translate: impl FnOnce(&mut Function, &mut FunctionBuilderContext, &dyn Module) -> bool,
    ) -> Result<Option<Self>, CompileError> {
        let mut memory = CodeMemory::with_room(PIECE_ROOM)?;
        let module = &mut *memory.0;
        let mut signature = module.make_signature();
        signature.params.extend([AbiParam::new(types::I64); 2]);
        signature.returns.push(AbiParam::new(types::I32));
        let mut context = module.make_context();
        let id = module.declare_anonymous_function(&signature)?;
        context.func.signature = signature;
        if !translate(&mut context.func, &mut FunctionBuilderContext::new(), module) {
            return Ok(None);
        }
        module.define_function(id, &mut context)?;
        module.finalize_definitions()?;
        let entry = piece_at(module.get_finalized_function(id));
        Ok(Some(Self { _memory: memory, entry }))
    }

    /// Runs it; the number that it returns.
    pub(crate) fn run(
        &self,
        handover: &mut Handover,
        regs: &mut [u32; 256],
        memory: &mut GuestMemory,
        marks: &Marks,
    ) -> u32 {
        let (sdram, iram) = memory.ram_mut();
        let places = Places {
            regs: regs.as_mut_ptr(),
            sdram: sdram.as_mut_ptr(),
            iram: iram.as_mut_ptr(),
            marks: marks.as_ptr(),
        };
        // SAFETY: the borrows last until it returns; the translated code accesses only the borrowed memory.
        unsafe { (self.entry)(handover, &raw const places) }
    }
}
