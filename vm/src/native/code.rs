//! Compiled programs: memory that holds machine code, and the addresses in it.
#![expect(unsafe_code, reason = "owns machine code and hands out pointers into it")]

use std::collections::BTreeMap;
use std::fmt;
use std::mem::ManuallyDrop;
use std::sync::{Arc, OnceLock};

use cranelift_codegen::Context;
use cranelift_codegen::isa::OwnedTargetIsa;
use cranelift_codegen::settings::{self, Configurable};
use cranelift_frontend::FunctionBuilderContext;
use cranelift_jit::{ArenaMemoryProvider, JITBuilder, JITModule};
use cranelift_module::{FuncId, Module, ModuleError, default_libcall_names};

use super::entry::Begin;
use super::state::BYTES_PER_CALL;
use super::translate::{
    PureFunctions, Translation, begin_signature, function_signature, request_signature, thunk_signature,
    translate, translate_begin, translate_request, translate_thunk,
};
use crate::operand::Class;
use crate::program::Program;

/// Bytes of native stack for what runs besides the program's functions: the way in, and requests.
const STACK_RESERVE: usize = 0x1_0000;

/// Bytes of native stack that a call takes besides what Cranelift counts: return address, frame
/// pointer and alignment.
const NATIVE_CALL_OVERHEAD: u32 = 32;

/// Bytes of address space for the machine code of one function, and of one instruction word.
const RESERVE_PER_FUNCTION: usize = 0x1000;
const RESERVE_PER_WORD: usize = 0x400;

/// Most registers of a function: a stack full of calls of functions like that stays within the
/// interpreter's bound on the registers of all calls together, of which compiled code knows nothing.
const MAX_REGISTERS: usize = 4096;

/// Why a program cannot be compiled on this host; it runs on the bytecode engine then.
#[derive(Debug, thiserror::Error)]
pub(crate) enum CompileError {
    /// Cranelift has no code generator for the host.
    #[error("no native code for this host: {0}")]
    Host(String),
    /// A function has so many registers that the interpreter would bound the depth of its calls by them.
    #[error("a function of {0} registers, more than {MAX_REGISTERS}")]
    TooManyRegisters(usize),
    /// A function is beyond a limit of Cranelift's.
    #[error(transparent)]
    Module(#[from] Box<ModuleError>),
}

impl From<ModuleError> for CompileError {
    fn from(error: ModuleError) -> Self {
        Self::Module(Box::new(error))
    }
}

/// The compiled form of a program, made when it is first started and shared by its copies.
///
/// It follows from the program, so two programs are equal whether or not they have one.
#[derive(Clone, Default)]
pub(crate) struct Compiled(OnceLock<Option<Arc<Code>>>);

impl Compiled {
    /// The machine code of `program`, which holds this; `None` where it cannot be compiled.
    pub(super) fn code(&self, program: &Program, pure: PureFunctions<'_>) -> Option<&Arc<Code>> {
        self.0.get_or_init(|| Code::compile(program, pure).ok().map(Arc::new)).as_ref()
    }
}

impl fmt::Debug for Compiled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Compiled").field(&self.0.get().map(Option::is_some)).finish()
    }
}

impl PartialEq for Compiled {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Eq for Compiled {}

/// How to call a function of a program through a pointer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    /// What passes the function its arguments.
    pub(super) thunk: *const u8,
    /// The function.
    pub(super) pointer: *const u8,
}

/// The machine code of one program.
pub(super) struct Code {
    /// What the pointers point into.
    _memory: CodeMemory,
    begin: Begin,
    entries: Vec<Entry>,
    /// The most native stack that a call takes for each byte of guest stack, and the most it takes at all.
    native_per_guest: u32,
    largest_frame: u32,
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
struct CodeMemory(ManuallyDrop<JITModule>);

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
        let mut compiler = Compiler::new(program)?;
        let functions = compiler.declare_functions(program)?;
        let request = compiler.request()?;
        let begin = compiler.begin()?;
        let (thunks, thunk_frame) = compiler.thunks(program)?;
        let mut native_per_guest = 0;
        let mut largest_frame = 0;
        for (index, function) in program.functions().iter().enumerate() {
            if function.classes.len() > MAX_REGISTERS {
                return Err(CompileError::TooManyRegisters(function.classes.len()));
            }
            let translation = Translation { program, function, functions: &functions, request, pure };
            let frame = compiler.function(functions[index], translation)? + thunk_frame;
            let guest = function.frame + BYTES_PER_CALL;
            native_per_guest = native_per_guest.max(frame.div_ceil(guest));
            largest_frame = largest_frame.max(frame);
        }
        compiler.module.0.finalize_definitions()?;
        let entry = |(function, id): (&crate::program::Function, &FuncId)| {
            let parameters = &program.signatures()[usize::from(function.signature.0)].params;
            Entry {
                thunk: compiler.module.0.get_finalized_function(thunks[parameters]),
                pointer: compiler.module.0.get_finalized_function(*id),
            }
        };
        let entries = program.functions().iter().zip(&functions).map(entry).collect();
        Ok(Self {
            begin: begin_at(&compiler.module.0, begin),
            entries,
            _memory: compiler.module,
            native_per_guest,
            largest_frame,
        })
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
        guest as usize * self.native_per_guest as usize + self.largest_frame as usize + STACK_RESERVE
    }
}

/// The address of what begins the outermost call.
fn begin_at(module: &JITModule, begin: FuncId) -> Begin {
    let pointer = module.get_finalized_function(begin);
    // SAFETY: it is translated with the signature of `Begin` (`begin_signature`).
    unsafe { std::mem::transmute::<*const u8, Begin>(pointer) }
}

/// What compiles the functions of one program.
struct Compiler {
    module: CodeMemory,
    context: Context,
    builder: FunctionBuilderContext,
}

impl Compiler {
    fn new(program: &Program) -> Result<Self, CompileError> {
        let host = |error: &dyn fmt::Display| CompileError::Host(error.to_string());
        let mut builder = JITBuilder::with_isa(host_isa()?, default_libcall_names());
        let reserve =
            program.functions().len() * 2 * RESERVE_PER_FUNCTION + program.ops().len() * RESERVE_PER_WORD;
        // One piece, so that every call reaches its target.
        let arena = ArenaMemoryProvider::new_with_size(reserve).map_err(|error| host(&error))?;
        builder.memory_provider(Box::new(arena));
        let module = CodeMemory(ManuallyDrop::new(JITModule::new(builder)));
        let context = module.0.make_context();
        Ok(Self { module, context, builder: FunctionBuilderContext::new() })
    }

    fn declare_functions(&mut self, program: &Program) -> Result<Vec<FuncId>, CompileError> {
        let declare = |function: &crate::program::Function| {
            let parameters = &program.signatures()[usize::from(function.signature.0)].params;
            Ok(self.module.0.declare_anonymous_function(&function_signature(parameters))?)
        };
        program.functions().iter().map(declare).collect()
    }

    /// Compiles one function and yields what a call of it takes of the native stack.
    fn function(&mut self, id: FuncId, translation: Translation<'_>) -> Result<u32, CompileError> {
        translate(&mut self.context.func, &mut self.builder, &mut self.module.0, translation);
        self.define(id)
    }

    /// Compiles what makes the rare requests of all functions.
    fn request(&mut self) -> Result<FuncId, CompileError> {
        let signature = request_signature();
        let id = self.module.0.declare_anonymous_function(&signature)?;
        self.context.func.signature = signature;
        translate_request(&mut self.context.func, &mut self.builder, &self.module.0);
        self.define(id)?;
        Ok(id)
    }

    /// Compiles what begins the outermost call.
    fn begin(&mut self) -> Result<FuncId, CompileError> {
        let signature = begin_signature(&self.module.0);
        let id = self.module.0.declare_anonymous_function(&signature)?;
        self.context.func.signature = signature;
        translate_begin(&mut self.context.func, &mut self.builder, &self.module.0);
        self.define(id)?;
        Ok(id)
    }

    /// Compiles a thunk for each list of parameters that a function of `program` has, and yields what one takes
    /// of the native stack.
    fn thunks(&mut self, program: &Program) -> Result<(BTreeMap<Vec<Class>, FuncId>, u32), CompileError> {
        let mut thunks = BTreeMap::new();
        let mut largest = 0;
        for function in program.functions() {
            let parameters = &program.signatures()[usize::from(function.signature.0)].params;
            if !thunks.contains_key(parameters) {
                let signature = thunk_signature();
                let id = self.module.0.declare_anonymous_function(&signature)?;
                self.context.func.signature = signature;
                translate_thunk(&mut self.context.func, &mut self.builder, &self.module.0, parameters);
                largest = largest.max(self.define(id)?);
                thunks.insert(parameters.clone(), id);
            }
        }
        Ok((thunks, largest))
    }

    fn define(&mut self, id: FuncId) -> Result<u32, CompileError> {
        self.module.0.define_function(id, &mut self.context)?;
        let layout = self.context.compiled_code().and_then(|code| code.buffer.frame_layout());
        let frame = layout.map_or(0, |layout| layout.frame_to_fp_offset);
        self.module.0.clear_context(&mut self.context);
        Ok(frame + NATIVE_CALL_OVERHEAD)
    }
}

/// The code generator for this computer.
fn host_isa() -> Result<OwnedTargetIsa, CompileError> {
    let host = |error: &dyn fmt::Display| CompileError::Host(error.to_string());
    let mut flags = settings::builder();
    let verify = if cfg!(debug_assertions) { "true" } else { "false" };
    for (name, value) in [
        ("opt_level", "speed"),
        ("is_pic", "false"),
        ("use_colocated_libcalls", "false"),
        ("enable_probestack", "false"),
        ("enable_verifier", verify),
    ] {
        flags.set(name, value).map_err(|error| host(&error))?;
    }
    let builder = cranelift_native::builder().map_err(|error| host(&error))?;
    builder.finish(settings::Flags::new(flags)).map_err(|error| host(&error))
}
