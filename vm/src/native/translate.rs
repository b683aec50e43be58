//! Translation of a function of a program to Cranelift's IR.
//!
//! Each register becomes a variable of its class, so the frontend builds SSA form. The function's machine signature has
//! three parameters before those of the program's function, and one more result: it takes the state, the caller's stack
//! pointer and the budget, and returns the budget together with the result as a register slot. So the budget stays in a
//! processor register; it is written to the state for a request and read back after it.
//!
//! A small loop is translated twice, and so is a region of code without calls: `candidates.rs` finds them, `unroll.rs`
//! plans several iterations with a single test of the budget and few address checks, and `fast.rs` translates them.
//!
//! Where threads lose the processor as on the board, a segment is translated twice, too: `split.rs`.
//!
//! Instructions are translated in `arith.rs`, `memory.rs` and `control.rs`, by one method per instruction, named as in
//! the table.

#![deny(clippy::wildcard_enum_match_arm, reason = "a new instruction, operator or mode must be decided")]

mod accesses;
mod arith;
mod candidates;
mod control;
mod fast;
mod memory;
mod nan;
mod observe;
mod parts;
mod shortcut;
mod split;
mod strides;
mod unroll;
mod waits;

use std::collections::{BTreeMap, BTreeSet};
use std::mem::offset_of;

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{
    AbiParam, AliasRegion, AliasRegionData, Block, Endianness, Function as IrFunction, InstBuilder,
    MemFlagsData, Signature, TrapCode, Type, Value, types,
};
use cranelift_codegen::isa::CallConv;
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_module::{FuncId, Module};

use kmotiondef::GuestAddr;

pub(super) use self::observe::ObservedProgram;
use self::parts::{CallParts, Flags, FrameParts, Registers, UnrollState, WaitParts};
use self::unroll::Plan;
use super::request::{Reason, Request};
use super::state::{BYTES_PER_CALL, State};
use crate::engine::Preemption;
use crate::firmware::Pure;
use crate::for_each_op;
use crate::kind::{Name, OpKind};
use crate::meter::branch_target;
use crate::op::Op;
use crate::operand::{Class, RegF32, RegF64, RegI32, RegI64};
use crate::polling::{PollingLoop, Readers};
use crate::program::{Function, Program};

/// Reached only if the engine resumed a context that a trap has stopped.
const RESUMED_BEHIND_TRAP: TrapCode = TrapCode::unwrap_user(1);

/// The calling convention of a program's functions: it returns two results in registers on every host.
const CONVENTION: CallConv = CallConv::Tail;

/// Parameters of a machine function before those of the program: state, stack pointer, budget.
const OWN_PARAMETERS: usize = 3;

/// The input of a translation.
#[derive(Clone, Copy)]
pub(super) struct Translation<'a> {
    /// The program.
    pub(super) program: &'a Program,
    /// The function that is translated.
    pub(super) function: &'a Function,
    /// All functions of the program, as declared in the module.
    pub(super) functions: &'a [FuncId],
    /// The function made by [`translate_request`].
    pub(super) request: FuncId,
    /// The firmware's functions that only compute.
    pub(super) pure: PureFunctions<'a>,
    /// The loops of the program that may only wait.
    pub(super) loops: &'a [PollingLoop],
    /// The points at which the function loses the processor.
    pub(super) preemption: Preemption,
    /// The program, if its accesses to memory that threads can share are reported.
    pub(super) observed: Option<ObservedProgram>,
}

/// The lookup of firmware functions that only compute.
pub(super) type PureFunctions<'a> = &'a dyn Fn(GuestAddr) -> Option<Pure>;

/// The facts about functions of the firmware that a translation relies on.
#[derive(Clone, Copy)]
pub(super) struct FirmwareFacts<'a> {
    /// Those that only compute.
    pub(super) pure: PureFunctions<'a>,
    /// Those that only yield a state.
    pub(super) readers: Readers<'a>,
}

/// The machine signature of a function with `parameters`.
pub(super) fn function_signature(parameters: &[Class]) -> Signature {
    let mut signature = Signature::new(CONVENTION);
    let own: [Type; OWN_PARAMETERS] = [types::I64, types::I32, types::I64];
    signature.params =
        own.into_iter().chain(parameters.iter().map(|class| type_of(*class))).map(AbiParam::new).collect();
    signature.returns = vec![AbiParam::new(types::I64); 2];
    signature
}

/// The machine signature of [`BeginFn`](super::entry::BeginFn).
pub(super) fn begin_signature(module: &dyn Module) -> Signature {
    let mut signature = module.make_signature();
    signature.params = vec![AbiParam::new(types::I64); 2];
    signature
}

/// The machine signature of a thunk: that of a program's function without parameters.
pub(super) fn thunk_signature() -> Signature {
    function_signature(&[])
}

/// The machine signature of [`RequestFn`](super::state::RequestFn).
fn leave_signature(convention: CallConv) -> Signature {
    let mut signature = Signature::new(convention);
    let parameters = [types::I64, types::I32, types::I32, types::I32, types::I64, types::I64];
    signature.params = parameters.map(AbiParam::new).to_vec();
    signature.returns = vec![AbiParam::new(types::I64)];
    signature
}

/// The signature of the function through which compiled code makes its rare requests.
///
/// It preserves every register, so that the code around a rare request keeps its values in place. For the same reason
/// only the state is passed: it holds the request, and afterwards the answer.
pub(super) fn request_signature() -> Signature {
    let mut signature = Signature::new(CallConv::PreserveAll);
    signature.params.push(AbiParam::new(types::I64));
    signature
}

/// Translates the function of [`request_signature`] into `ir`, whose signature is set.
pub(super) fn translate_request(
    ir: &mut IrFunction,
    context: &mut FunctionBuilderContext,
    module: &dyn Module,
) {
    let mut builder = FunctionBuilder::new(ir, context);
    let block = builder.create_block();
    builder.append_block_params_for_function_params(block);
    builder.switch_to_block(block);
    let (state, flags) = (builder.block_params(block)[0], MemFlagsData::trusted());
    let mut field =
        |ty, field| builder.ins().load(ty, flags, state, offset(offset_of!(State, exchange.request) + field));
    let arguments = [
        state,
        field(types::I32, offset_of!(Request, code)),
        field(types::I32, offset_of!(Request, at)),
        field(types::I32, offset_of!(Request, stack_pointer)),
        field(types::I64, offset_of!(Request, a)),
        field(types::I64, offset_of!(Request, b)),
    ];
    let leave = builder.ins().load(types::I64, flags, state, offset(offset_of!(State, ways_out.request)));
    let signature = builder.import_signature(leave_signature(module.isa().default_call_conv()));
    let call = builder.ins().call_indirect(signature, leave, &arguments);
    let answer = builder.inst_results(call)[0];
    builder.ins().store(flags, answer, state, offset(offset_of!(State, exchange.answer)));
    builder.ins().return_(&[]);
    builder.seal_all_blocks();
    builder.finalize(module.target_config());
}

/// The machine type of a register.
const fn type_of(class: Class) -> Type {
    match class {
        Class::I32 => types::I32,
        Class::I64 => types::I64,
        Class::F32 => types::F32,
        Class::F64 => types::F64,
    }
}

/// The zero of a class.
fn zero(builder: &mut FunctionBuilder<'_>, class: Class) -> Value {
    match class {
        Class::I32 | Class::I64 => builder.ins().iconst(type_of(class), 0),
        Class::F32 => builder.ins().f32const(0.0),
        Class::F64 => builder.ins().f64const(0.0),
    }
}

/// Translates a function into `ir`, which is empty.
pub(super) fn translate(
    ir: &mut IrFunction,
    context: &mut FunctionBuilderContext,
    module: &mut dyn Module,
    translation: Translation<'_>,
) {
    let signature = usize::from(translation.function.signature.0);
    ir.signature = function_signature(&translation.program.signatures()[signature].params);
    let builder = FunctionBuilder::new(ir, context);
    let mut translator = Translator::new(builder, module, translation);
    translator.prologue();
    translator.body();
    translator.builder.seal_all_blocks();
    translator.builder.finalize(module.target_config());
}

/// Translates the entry from Rust to a thunk into `ir`, whose signature is set.
pub(super) fn translate_begin(
    ir: &mut IrFunction,
    context: &mut FunctionBuilderContext,
    module: &dyn Module,
) {
    let mut builder = FunctionBuilder::new(ir, context);
    let block = builder.create_block();
    builder.append_block_params_for_function_params(block);
    builder.switch_to_block(block);
    let (state, thunk) = (builder.block_params(block)[0], builder.block_params(block)[1]);
    let flags = MemFlagsData::trusted();
    let top = builder.ins().load(types::I32, flags, state, offset(offset_of!(State, stack.top)));
    let budget = builder.ins().load(types::I64, flags, state, offset(offset_of!(State, budget)));
    let signature = builder.import_signature(thunk_signature());
    let call = builder.ins().call_indirect(signature, thunk, &[state, top, budget]);
    let budget = builder.inst_results(call)[0];
    builder.ins().store(flags, budget, state, offset(offset_of!(State, budget)));
    builder.ins().return_(&[]);
    builder.seal_all_blocks();
    builder.finalize(module.target_config());
}

/// Translates the thunk of functions with `parameters` into `ir`, whose signature is set: the state holds the function
/// and the arguments.
///
/// So a call through a pointer need not know the function's parameters.
pub(super) fn translate_thunk(
    ir: &mut IrFunction,
    context: &mut FunctionBuilderContext,
    module: &dyn Module,
    parameters: &[Class],
) {
    let mut builder = FunctionBuilder::new(ir, context);
    let block = builder.create_block();
    builder.append_block_params_for_function_params(block);
    builder.switch_to_block(block);
    let mut arguments = builder.block_params(block).to_vec();
    let (state, flags) = (arguments[0], MemFlagsData::trusted());
    for (index, class) in parameters.iter().enumerate() {
        let place = offset(offset_of!(State, exchange.arguments) + index * size_of::<u64>());
        arguments.push(builder.ins().load(type_of(*class), flags, state, place));
    }
    let function = builder.ins().load(types::I64, flags, state, offset(offset_of!(State, exchange.callee)));
    let signature = builder.import_signature(function_signature(parameters));
    let call = builder.ins().call_indirect(signature, function, &arguments);
    let results = builder.inst_results(call).to_vec();
    builder.ins().return_(&results);
    builder.seal_all_blocks();
    builder.finalize(module.target_config());
}

/// The offset of a field of the state.
fn offset(field: usize) -> i32 {
    i32::try_from(field).expect("the state is small")
}

/// A register operand as a variable.
trait Register: Copy {
    /// Its class.
    const CLASS: Class;

    /// Its number in the function.
    fn index(self) -> usize;
}

macro_rules! registers {
    ($($register:ident is $class:ident;)*) => {$(
        impl Register for $register {
            const CLASS: Class = Class::$class;

            fn index(self) -> usize {
                Self::index(self)
            }
        }
    )*};
}
registers! {
    RegI32 is I32;
    RegI64 is I64;
    RegF32 is F32;
    RegF64 is F64;
}

/// The state of translating a function.
struct Translator<'a, 'b> {
    builder: FunctionBuilder<'b>,
    module: &'a mut dyn Module,
    translation: Translation<'a>,
    registers: Registers,
    calls: CallParts,
    /// Blocks at the words that branches go to or that follow a conditional one.
    blocks: BTreeMap<usize, Block>,
    unroll: UnrollState,
    flags: Flags,
    frame: FrameParts,
    waits: WaitParts,
    /// The word being translated, and whether execution can reach it.
    at: usize,
    reachable: bool,
}

impl<'a, 'b> Translator<'a, 'b> {
    fn new(
        mut builder: FunctionBuilder<'b>,
        module: &'a mut dyn Module,
        translation: Translation<'a>,
    ) -> Self {
        let entry = builder.create_block();
        builder.append_block_params_for_function_params(entry);
        builder.switch_to_block(entry);
        let parameters = builder.block_params(entry).to_vec();
        let registers: Vec<_> =
            translation.function.classes.iter().map(|class| builder.declare_var(type_of(*class))).collect();
        for (register, value) in registers.iter().zip(&parameters[OWN_PARAMETERS..]) {
            builder.def_var(*register, *value);
        }
        let budget = builder.declare_var(types::I64);
        builder.def_var(budget, parameters[2]);
        let request = module.declare_func_in_func(translation.request, builder.func);
        let leave = builder.import_signature(leave_signature(module.isa().default_call_conv()));
        let state_flags = flags(&mut builder, 0, "state");
        let guest_flags = flags(&mut builder, 1, "guest memory");
        let lax =
            nan::lax_registers(translation.program, translation.function, parameters.len() - OWN_PARAMETERS);
        Self {
            registers: Registers { variables: registers, budget, lax, raw: BTreeMap::new() },
            calls: CallParts {
                callees: BTreeMap::new(),
                shortcuts: BTreeMap::new(),
                attempts: 0,
                attempt: None,
                request,
                leave,
                arguments: Vec::new(),
                result: None,
            },
            blocks: BTreeMap::new(),
            unroll: UnrollState::default(),
            flags: Flags { state: state_flags, guest: guest_flags },
            frame: FrameParts {
                state: parameters[0],
                stack_pointer: parameters[1],
                call_entry: parameters[0],
            },
            waits: WaitParts::default(),
            at: translation.function.at.0 as usize,
            reachable: true,
            builder,
            module,
            translation,
        }
    }

    /// Takes the frame from the guest stack and sets the registers to 0.
    fn prologue(&mut self) {
        let bytes = i64::from(self.translation.function.frame + BYTES_PER_CALL);
        let caller = self.frame.stack_pointer;
        let frame = self.builder.ins().iadd_imm_s(caller, -bytes);
        let (deeper, lower, body) =
            (self.builder.create_block(), self.builder.create_block(), self.builder.create_block());
        // Nothing to do as long as the stack has been deeper already.
        let lowest = self.load_state(types::I32, offset_of!(State, stack.lowest));
        self.branch_if_room(caller, lowest, bytes, body, deeper);
        self.enter_cold(deeper);
        self.end_long_slice();
        self.stay_cold();
        let overflow = self.builder.create_block();
        let limit = self.load_state(types::I32, offset_of!(State, stack.limit));
        self.branch_if_room(caller, limit, bytes, lower, overflow);
        self.enter_cold(overflow);
        let bytes = self.builder.ins().iconst(types::I64, bytes);
        self.trap(Reason::StackOverflow, bytes);
        self.enter_cold(lower);
        self.store_state(frame, offset_of!(State, stack.lowest));
        self.builder.ins().jump(body, &[]);
        self.enter(body);
        self.frame.stack_pointer = frame;
        self.set_call_entry();
        self.clear_registers();
    }

    /// Branches to `room` if `bytes` fit between `limit` and `stack_pointer`, otherwise to `none`.
    fn branch_if_room(&mut self, stack_pointer: Value, limit: Value, bytes: i64, room: Block, none: Block) {
        let left = self.builder.ins().isub(stack_pointer, limit);
        let fits = self.builder.ins().icmp_imm_u(IntCC::UnsignedGreaterThanOrEqual, left, bytes);
        self.builder.ins().brif(fits, room, &[], none, &[]);
    }

    fn set_call_entry(&mut self) {
        let size = size_of::<u32>() as u32;
        let mask = i64::from(super::state::CALLS as u32 * size - size);
        let shifted = self
            .builder
            .ins()
            .ushr_imm_u(self.frame.stack_pointer, i64::from((BYTES_PER_CALL / size).ilog2()));
        let masked = self.builder.ins().band_imm_u(shifted, mask);
        let entry = self.builder.ins().uextend(types::I64, masked);
        self.frame.call_entry = self.builder.ins().iadd(self.frame.state, entry);
    }

    fn clear_registers(&mut self) {
        let parameters = self.signature_parameters();
        let mut zeros = BTreeMap::new();
        for (register, class) in
            self.registers.variables.iter().zip(&self.translation.function.classes).skip(parameters)
        {
            let zero = *zeros.entry(*class).or_insert_with(|| zero(&mut self.builder, *class));
            self.builder.def_var(*register, zero);
        }
    }

    fn signature_parameters(&self) -> usize {
        let signature = usize::from(self.translation.function.signature.0);
        self.translation.program.signatures()[signature].params.len()
    }

    /// Translates the words.
    fn body(&mut self) {
        let mut body = self.translation.function.body.clone();
        self.find_blocks();
        while let Some(at) = body.next() {
            let plan = self.unroll.plans.remove(&at);
            let entry = plan.as_ref().map_or(at, Plan::entry);
            if let Some(block) = self.blocks.get(&entry).copied() {
                self.begin(block);
            }
            if let Some(plan) = plan.filter(|_| self.reachable) {
                body.start = *plan.words.end() + 1;
                self.fast_iterations(plan);
            } else {
                self.word(at);
            }
        }
        if self.reachable {
            self.unreachable();
        }
        self.waiting_loops();
    }

    /// Translates the word `at` if it can be reached.
    fn word(&mut self, at: usize) {
        self.at = at;
        if self.reachable {
            self.op(self.translation.program.ops()[at]);
        }
    }

    /// Continues in `block`, which has other predecessors too.
    fn begin(&mut self, block: Block) {
        if self.reachable {
            self.builder.ins().jump(block, &[]);
        }
        self.builder.switch_to_block(block);
        self.reachable = true;
        self.registers.raw.clear();
    }

    /// Makes a block for each word that is the beginning of one.
    fn find_blocks(&mut self) {
        let mut begins = BTreeSet::new();
        for at in self.translation.function.body.clone() {
            let op = self.translation.program.ops()[at];
            begins.extend(branch_target(&op).map(|to| to.0 as usize));
            if op.kind() == OpKind::Branch {
                begins.insert(at + 1);
            }
            begins.extend(self.after_steps(at));
        }
        let Translation { program, function, loops, .. } = self.translation;
        let is_here = |polling: &&PollingLoop| function.body.contains(&polling.first);
        self.waits.loops = loops.iter().filter(is_here).cloned().collect();
        let waits = |at: usize| self.waits.loops.iter().any(|polling| polling.words.contains(&at));
        self.unroll.plans =
            unroll::plans(program, function, &begins, &waits, &|op| self.cost_in_iterations(op));
        self.blocks = begins.into_iter().map(|at| (at, self.builder.create_block())).collect();
    }

    /// The cycles of an instruction in addition to its charge; `None` for an instruction that the fast iterations of a
    /// loop cannot contain.
    fn cost_in_iterations(&self, op: &Op) -> Option<u32> {
        match op.kind() {
            OpKind::Table | OpKind::Block => None,
            OpKind::Call => {
                let (sig, addr) = (op.operand(Name::Sig)?, op.operand(Name::Addr)?);
                u32::try_from(self.pure_function(sig, addr)?.cost.get()).ok()
            }
            OpKind::Structure
            | OpKind::Charge
            | OpKind::Constant
            | OpKind::Move
            | OpKind::Address
            | OpKind::Arithmetic
            | OpKind::Negation
            | OpKind::Conversion
            | OpKind::Load(_)
            | OpKind::Store(_)
            | OpKind::Jump
            | OpKind::Branch
            | OpKind::Argument(_)
            | OpKind::Result(_)
            | OpKind::Return(_)
            | OpKind::Stop => (memory::is_in_sdram(op) && !self.is_always_observed(op)).then_some(0),
        }
    }

    /// Continues in `block`, all of whose predecessors are known.
    fn enter(&mut self, block: Block) {
        if self.unroll.is_rare {
            self.builder.set_cold_block(block);
        }
        self.builder.switch_to_block(block);
        self.builder.seal_block(block);
    }

    /// Goes on in `block`, which is rarely executed.
    fn enter_cold(&mut self, block: Block) {
        self.builder.set_cold_block(block);
        self.enter(block);
    }

    /// The value of a register; a NaN made by arithmetic is the canonical NaN.
    fn get<R: Register>(&mut self, register: R) -> Value {
        let value = self.builder.use_var(self.registers.variables[register.index()]);
        if self.registers.lax[register.index()] { self.canonical(R::CLASS, value) } else { value }
    }

    fn set<R: Register>(&mut self, register: R, value: Value) {
        self.registers.raw.remove(&register.index());
        self.builder.def_var(self.registers.variables[register.index()], value);
    }

    fn load_state(&mut self, ty: Type, field: usize) -> Value {
        self.builder.ins().load(ty, self.flags.state, self.frame.state, offset(field))
    }

    /// Loads a pointer of the state that stays the same as long as the context lives.
    fn load_pointer(&mut self, field: usize) -> Value {
        let flags = self.flags.state.with_readonly().with_can_move();
        self.builder.ins().load(types::I64, flags, self.frame.state, offset(field))
    }

    fn store_state(&mut self, value: Value, field: usize) {
        self.builder.ins().store(self.flags.state, value, self.frame.state, offset(field));
    }

    /// A value of `class` as a register slot.
    fn slot(&mut self, class: Class, value: Value) -> Value {
        let bits = MemFlagsData::new();
        match class {
            Class::I32 => self.builder.ins().uextend(types::I64, value),
            Class::I64 => value,
            Class::F32 => {
                let value = self.builder.ins().bitcast(types::I32, bits, value);
                self.builder.ins().uextend(types::I64, value)
            }
            Class::F64 => self.builder.ins().bitcast(types::I64, bits, value),
        }
    }

    /// The value of `class` from a register slot; unchanged if it is not a slot.
    fn read_slot(&mut self, class: Class, slot: Value) -> Value {
        if self.builder.func.dfg.value_type(slot) == type_of(class) {
            return slot;
        }
        let bits = MemFlagsData::new();
        match class {
            Class::I32 => self.builder.ins().ireduce(types::I32, slot),
            Class::I64 => slot,
            Class::F32 => {
                let low = self.builder.ins().ireduce(types::I32, slot);
                self.builder.ins().bitcast(types::F32, bits, low)
            }
            Class::F64 => self.builder.ins().bitcast(types::F64, bits, slot),
        }
    }

    /// Makes a request as the word `at` and yields the answer; for requests that are rare.
    fn request(&mut self, code: u32, at: usize, a: Value, b: Value) -> Value {
        let [_, code, at, stack_pointer, a, b] = self.request_arguments(code, at, a, b);
        for (value, field) in [
            (code, offset_of!(Request, code)),
            (at, offset_of!(Request, at)),
            (stack_pointer, offset_of!(Request, stack_pointer)),
            (a, offset_of!(Request, a)),
            (b, offset_of!(Request, b)),
        ] {
            self.store_state(value, offset_of!(State, exchange.request) + field);
        }
        self.builder.ins().call(self.calls.request, &[self.frame.state]);
        let answer = self.load_state(types::I64, offset_of!(State, exchange.answer));
        self.reload_budget();
        answer
    }

    /// Makes a request that the program makes every time it executes this instruction.
    fn usual_request(&mut self, code: u32, at: usize, a: Value, b: Value) -> Value {
        let arguments = self.request_arguments(code, at, a, b);
        let leave = self.load_pointer(offset_of!(State, ways_out.request));
        let call = self.builder.ins().call_indirect(self.calls.leave, leave, &arguments);
        self.reload_budget();
        self.builder.inst_results(call)[0]
    }

    /// The arguments of a request; the budget is stored in the state.
    fn request_arguments(&mut self, code: u32, at: usize, a: Value, b: Value) -> [Value; 6] {
        let budget = self.builder.use_var(self.registers.budget);
        self.store_state(budget, offset_of!(State, budget));
        let code = self.builder.ins().iconst(types::I32, i64::from(code));
        let at = self.builder.ins().iconst(types::I32, at as i64);
        [self.frame.state, code, at, self.frame.stack_pointer, a, b]
    }

    fn reload_budget(&mut self) {
        let budget = self.load_state(types::I64, offset_of!(State, budget));
        self.builder.def_var(self.registers.budget, budget);
    }

    /// Ends the slice if it is a long one, because the next instruction involves the board.
    fn end_long_slice(&mut self) {
        let is_long = self.load_state(types::I32, offset_of!(State, signs.is_long));
        let (long, go_on) = (self.builder.create_block(), self.builder.create_block());
        self.builder.ins().brif(is_long, long, &[], go_on, &[]);
        self.enter_cold(long);
        let none = self.builder.ins().iconst(types::I64, 0);
        self.request(Reason::NeedsBoard.code(), self.at, none, none);
        self.builder.ins().jump(go_on, &[]);
        self.enter(go_on);
    }

    /// Marks the current block as rarely executed, like its predecessor.
    fn stay_cold(&mut self) {
        let block = self.builder.current_block();
        block.into_iter().for_each(|block| self.builder.set_cold_block(block));
    }

    /// Takes cycles from the budget.
    fn spend(&mut self, cycles: u32) {
        let budget = self.builder.use_var(self.registers.budget);
        let left = self.builder.ins().iadd_imm_s(budget, -i64::from(cycles));
        self.builder.def_var(self.registers.budget, left);
    }

    /// Ends the block with a request that never returns to the context.
    fn trap(&mut self, reason: Reason, a: Value) {
        self.settle_budget();
        let none = self.builder.ins().iconst(types::I64, 0);
        self.request(reason.code(), self.at, a, none);
        self.builder.ins().trap(RESUMED_BEHIND_TRAP);
    }
}

/// The flags of accesses to one kind of memory, all of it mapped.
fn flags(builder: &mut FunctionBuilder<'_>, id: u32, name: &'static str) -> MemFlagsData {
    let region: AliasRegion =
        builder.func.dfg.alias_regions.insert(AliasRegionData { user_id: id, description: name.into() });
    MemFlagsData::new().with_notrap().with_alias_region(Some(region)).with_endianness(Endianness::Little)
}

macro_rules! define_translation {
    ($($(#[$doc:meta])* $name:ident = $variant:ident { $($field:ident: $operand:ident),* }, cost $cost:expr, $kind:ident $(($fact:ident))?;)*) => {
        impl Translator<'_, '_> {
            /// Translates one instruction.
            fn op(&mut self, op: Op) {
                match op {
                    $(Op::$variant { $($field),* } => self.$name($($field),*),)*
                }
            }
        }
    };
}
for_each_op!(define_translation);
