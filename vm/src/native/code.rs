//! Compiled programs: memory that holds machine code, and the addresses in it.
#![expect(unsafe_code, reason = "owns machine code and hands out pointers into it")]

use std::fmt;
use std::mem::ManuallyDrop;

use cranelift_jit::{ArenaMemoryProvider, JITBuilder, JITModule};
use cranelift_module::{FuncId, default_libcall_names};

use super::compile::{CompileError, Job, Place, StackUse, compile, host_isa};
use super::entry::Begin;
use super::translate::{HostFunctions, PureFunctions};
use crate::program::Program;

/// Bytes of native stack for what runs besides the program's functions: the way in, and requests.
const STACK_RESERVE: usize = 0x1_0000;

/// Bytes of address space for the machine code of one function, and of one instruction word.
const RESERVE_PER_FUNCTION: usize = 0x1000;
const RESERVE_PER_WORD: usize = 0x400;

/// Most words of a function that is translated when it is started: the time that Cranelift takes grows with their square,
/// and this many take it a second or two. Longer ones are tables written as statements, which run once.
const MAX_WORDS: usize = 0x4000;

/// How to call a function of a program through a pointer. An object file has a table of these.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Entry {
    /// What passes the function its arguments.
    pub(super) thunk: *const u8,
    /// The function.
    pub(super) pointer: *const u8,
}

/// The machine code of one program.
pub(super) struct Code {
    /// What the pointers point into; `None` where that is part of the executable.
    pub(super) _memory: Option<CodeMemory>,
    pub(super) begin: Begin,
    pub(super) entries: Vec<Entry>,
    pub(super) stack: StackUse,
}

// SAFETY: nothing changes after `compile`; the pointers are to memory that any thread may read and execute.
unsafe impl Send for Code {}
// SAFETY: as above; the module, whose methods are not for several threads, is not used before it is dropped.
unsafe impl Sync for Code {}

impl fmt::Debug for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Code").field("entries", &self.entries.len()).finish_non_exhaustive()
    }
}

/// A module that frees its machine code when it is dropped.
pub(super) struct CodeMemory(ManuallyDrop<JITModule>);

impl CodeMemory {
    /// Room for the code of `program`.
    fn new(program: &Program) -> Result<Self, CompileError> {
        let mut builder = JITBuilder::with_isa(host_isa(Place::Memory)?, default_libcall_names());
        let reserve =
            program.functions().len() * 2 * RESERVE_PER_FUNCTION + program.ops().len() * RESERVE_PER_WORD;
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
        // SAFETY: pointers to the code are handed out by `Code` only, and whoever runs the code (the
        // fiber) holds the `Code`, and with it this, until it has stopped doing so.
        unsafe { module.free_memory() };
    }
}

impl Code {
    /// Compiles `program`, for a firmware that has the functions `pure`.
    pub(super) fn compile(program: &Program, pure: PureFunctions<'_>) -> Result<Self, CompileError> {
        let mut lengths = program.functions().iter().map(|function| function.body.len());
        if let Some(length) = lengths.find(|length| *length > MAX_WORDS) {
            return Err(CompileError::TooLong(length));
        }
        let mut memory = CodeMemory::new(program)?;
        let job = Job { program, pure, host: HostFunctions::Here, name: &|_| None };
        let functions = compile(&mut *memory.0, job)?;
        memory.0.finalize_definitions()?;
        let at = |id: FuncId| memory.0.get_finalized_function(id);
        let entries = functions.entries.into_iter();
        let entries = entries.map(|(thunk, id)| Entry { thunk: at(thunk), pointer: at(id) }).collect();
        let begin = begin_at(at(functions.begin));
        Ok(Self { begin, entries, _memory: Some(memory), stack: functions.stack })
    }

    /// What begins the outermost call.
    pub(super) const fn begin(&self) -> Begin {
        self.begin
    }

    /// How to call the function with the given index.
    pub(super) fn entry(&self, function: usize) -> Entry {
        self.entries[function]
    }

    /// Bytes of native stack that the program cannot exceed on a guest stack of `guest` bytes.
    ///
    /// Compiled code checks the guest stack at every call, so the depth of calls is bounded, and
    /// with it what they take of the native stack.
    pub(super) fn stack_size(&self, guest: u32) -> usize {
        let StackUse { native_per_guest, largest_frame } = self.stack;
        guest as usize * native_per_guest as usize + largest_frame as usize + STACK_RESERVE
    }
}

/// The function at `pointer`, which begins the outermost call.
pub(super) fn begin_at(pointer: *const u8) -> Begin {
    // SAFETY: it is translated with the signature of `Begin` (`begin_signature`).
    unsafe { std::mem::transmute::<*const u8, Begin>(pointer) }
}
