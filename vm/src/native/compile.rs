//! Compilation of a program to functions of a Cranelift module in the memory of this process ([`code`](super::code)).

use std::collections::BTreeMap;
use std::fmt;

use cranelift_codegen::Context;
use cranelift_codegen::isa::OwnedTargetIsa;
use cranelift_codegen::settings::{self, Configurable};
use cranelift_frontend::FunctionBuilderContext;
use cranelift_module::{FuncId, Module, ModuleError};
use kmotiondef::GuestAddr;
use kmotiondef::jumps::JumpFunction;
use kmotiondef::map::MemoryMap;

use super::state::BYTES_PER_CALL;
use super::translate::{
    ObservedProgram, PureFunctions, Translation, begin_signature, function_signature, request_signature,
    thunk_signature, translate, translate_begin, translate_request, translate_thunk,
};
use crate::engine::Preemption;
use crate::op::Op;
use crate::operand::Class;
use crate::polling::PollingLoop;
use crate::program::{Function, Program};

/// Bytes of native stack that a call takes in addition to the frame counted by Cranelift: return address, frame pointer
/// and alignment.
const NATIVE_CALL_OVERHEAD: u32 = 32;

/// The limit of registers in a function: a stack full of calls of such functions stays within the interpreter's limit
/// on the registers of all calls together, which compiled code does not check.
const MAX_REGISTERS: usize = 4096;

/// The reason why a program cannot be compiled on this host; it then runs on the bytecode engine.
#[derive(Debug, thiserror::Error)]
pub enum CompileError {
    /// Cranelift has no code generator for the host.
    #[error("no native code for this host: {0}")]
    Host(String),
    /// A function has too many registers: the interpreter would bound the depth of its calls by them.
    #[error("a function of {0} registers, more than {MAX_REGISTERS}")]
    TooManyRegisters(usize),
    /// A function is so long that to translate it takes longer than to interpret it.
    #[error("a function of {0} words takes longer to translate than to interpret")]
    TooLong(usize),
    /// The program uses jumps out of calls, but the calls of host code are on a native stack, which cannot be left in
    /// the middle.
    #[error("a program with `setjmp` or `longjmp` is interpreted")]
    Jumps,
    /// Machine code of the host has the addresses of one board's memories in it.
    #[error("a program for a board whose memory is not where that of a KFLOP is, is interpreted")]
    OtherMemory,
    /// A function is beyond a limit of Cranelift's.
    #[error(transparent)]
    Module(#[from] Box<ModuleError>),
}

impl CompileError {
    pub(super) fn host(error: &dyn fmt::Display) -> Self {
        Self::Host(error.to_string())
    }
}

impl From<ModuleError> for CompileError {
    fn from(error: ModuleError) -> Self {
        Self::Module(Box::new(error))
    }
}

/// The code generator for this computer.
pub(super) fn host_isa() -> Result<OwnedTargetIsa, CompileError> {
    let mut flags = settings::builder();
    let verify = if cfg!(debug_assertions) { "true" } else { "false" };
    for (name, value) in [
        ("opt_level", "speed"),
        ("is_pic", "false"),
        ("use_colocated_libcalls", "false"),
        ("enable_probestack", "false"),
        ("enable_verifier", verify),
    ] {
        flags.set(name, value).map_err(|error| CompileError::host(&error))?;
    }
    let builder = cranelift_native::builder().map_err(|error| CompileError::host(&error))?;
    builder.finish(settings::Flags::new(flags)).map_err(|error| CompileError::host(&error))
}

/// The functions of a program in a module.
pub(super) struct Functions {
    /// The function that begins the outermost call.
    pub(super) begin: FuncId,
    /// For each function of the program, the thunk that passes its arguments, and the function itself.
    pub(super) entries: Vec<(FuncId, FuncId)>,
    /// The native stack that calls use.
    pub(super) stack: StackUse,
}

/// The native stack that the calls of a program use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct StackUse {
    /// The most bytes that a call takes for each byte of guest stack.
    pub(super) native_per_guest: u32,
    /// The largest native frame of a call, in bytes.
    pub(super) largest_frame: u32,
}

/// Compiles all functions of a program, and the ways into them, into `module`, for a firmware with the functions `pure`.
pub(super) fn compile(
    module: &mut dyn Module,
    program: &Program,
    pure: PureFunctions<'_>,
    loops: &[PollingLoop],
    (preemption, is_observed): (Preemption, bool),
) -> Result<Functions, CompileError> {
    let jumps =
        |op: &Op| matches!(op, Op::CallFw { addr, .. } if JumpFunction::at(GuestAddr::new(addr.0)).is_some());
    if program.ops().iter().any(jumps) {
        return Err(CompileError::Jumps);
    }
    if !MemoryMap::KFLOP.programs.holds(program.address_of(0).get()) {
        return Err(CompileError::OtherMemory);
    }
    let mut compiler = Compiler { context: module.make_context(), module, builder: Default::default() };
    let functions = compiler.declare_functions(program)?;
    let request = compiler.request()?;
    let begin = compiler.begin()?;
    let (thunks, thunk_frame) = compiler.thunks(program)?;
    let mut stack = StackUse::default();
    let observed = is_observed.then(|| ObservedProgram { has_call_back: program.has_call_back() });
    for (function, id) in program.functions().iter().zip(&functions) {
        if function.classes.len() > MAX_REGISTERS {
            return Err(CompileError::TooManyRegisters(function.classes.len()));
        }
        let functions = &functions;
        let translation =
            Translation { program, function, functions, request, pure, loops, preemption, observed };
        let frame = compiler.function(*id, translation)? + thunk_frame;
        let guest = function.frame + BYTES_PER_CALL;
        stack.native_per_guest = stack.native_per_guest.max(frame.div_ceil(guest));
        stack.largest_frame = stack.largest_frame.max(frame);
    }
    let thunk_of = |function: &Function| thunks[parameters(program, function)];
    let entries = program.functions().iter().map(thunk_of).zip(functions).collect();
    Ok(Functions { begin, entries, stack })
}

/// The classes of the parameters of a function.
fn parameters<'a>(program: &'a Program, function: &Function) -> &'a Vec<Class> {
    &program.signatures()[usize::from(function.signature.0)].params
}

/// The compiler of the functions of one program.
struct Compiler<'m> {
    module: &'m mut dyn Module,
    context: Context,
    builder: FunctionBuilderContext,
}

impl Compiler<'_> {
    fn declare_functions(&mut self, program: &Program) -> Result<Vec<FuncId>, CompileError> {
        let declare = |function: &Function| {
            let signature = function_signature(parameters(program, function));
            Ok(self.module.declare_anonymous_function(&signature)?)
        };
        program.functions().iter().map(declare).collect()
    }

    /// Compiles one function and yields its use of the native stack for a call.
    fn function(&mut self, id: FuncId, translation: Translation<'_>) -> Result<u32, CompileError> {
        translate(&mut self.context.func, &mut self.builder, self.module, translation);
        self.define(id)
    }

    /// Compiles the function that makes the rare requests of all functions.
    fn request(&mut self) -> Result<FuncId, CompileError> {
        let signature = request_signature();
        let id = self.module.declare_anonymous_function(&signature)?;
        self.context.func.signature = signature;
        translate_request(&mut self.context.func, &mut self.builder, self.module);
        self.define(id)?;
        Ok(id)
    }

    /// Compiles the function that begins the outermost call.
    fn begin(&mut self) -> Result<FuncId, CompileError> {
        let signature = begin_signature(self.module);
        let id = self.module.declare_anonymous_function(&signature)?;
        self.context.func.signature = signature;
        translate_begin(&mut self.context.func, &mut self.builder, self.module);
        self.define(id)?;
        Ok(id)
    }

    /// Compiles a thunk for each parameter list of the functions of `program`, and yields the native stack used by a
    /// thunk.
    fn thunks(&mut self, program: &Program) -> Result<(BTreeMap<Vec<Class>, FuncId>, u32), CompileError> {
        let mut thunks = BTreeMap::new();
        let mut largest = 0;
        for function in program.functions() {
            let parameters = parameters(program, function);
            if !thunks.contains_key(parameters) {
                let signature = thunk_signature();
                let id = self.module.declare_anonymous_function(&signature)?;
                self.context.func.signature = signature;
                translate_thunk(&mut self.context.func, &mut self.builder, self.module, parameters);
                largest = largest.max(self.define(id)?);
                thunks.insert(parameters.clone(), id);
            }
        }
        Ok((thunks, largest))
    }

    fn define(&mut self, id: FuncId) -> Result<u32, CompileError> {
        self.module.define_function(id, &mut self.context)?;
        let layout = self.context.compiled_code().and_then(|code| code.buffer.frame_layout());
        let frame = layout.map_or(0, |layout| layout.frame_to_fp_offset);
        self.module.clear_context(&mut self.context);
        Ok(frame + NATIVE_CALL_OVERHEAD)
    }
}
