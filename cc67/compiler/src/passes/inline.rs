//! Inlining of small functions.
//!
//! The values, blocks and accesses of the callee are copied; its parameters are written before them, and its result is
//! written where it returned. A function with objects in the frame is not inlined, so that a frame contains only its
//! own function's objects.
//!
//! A recursive function is inlined into itself, with its original body, a few levels deep. The remaining calls still
//! use the stack, so an endless recursion still traps.

use std::collections::BTreeMap;

use cranelift_entity::SecondaryMap;
use cranelift_entity::packed_option::PackedOption;

use crate::ir::function::{Block, Function, InlinedCall, SourceVariable, VariableHome, table};
use crate::ir::inst::{
    Address, ArgumentRange, Base, BlockId, Callee, Class, CodeOrigin, InlineId, Inst, InstKind, Operand,
    Terminator, ValueId,
};
use crate::typed::SymbolId;

/// The most instructions of a function that replaces its calls.
const SMALL: usize = 40;

/// The largest function that is inlined where code must not grow: about the size of a call with the function's entry
/// and exit.
const SMALLEST: usize = 32;

/// The size limit, in instructions, of a function whose recursive calls are inlined.
const SMALL_RECURSIVE: usize = 16;

/// The depth to which recursive calls are inlined, unless another is requested.
const LEVELS: usize = 3;

/// The size limit to which a function may grow, in instructions.
const LARGEST: usize = 1500;

/// The functions that may be inlined, each with its source file.
#[derive(Debug)]
pub struct Candidates {
    /// The depth to which recursive calls are inlined.
    levels: usize,
    /// The most instructions of a function that replaces its calls.
    largest: usize,
    functions: BTreeMap<SymbolId, (u32, Function)>,
}

impl Default for Candidates {
    fn default() -> Self {
        Self::new(LEVELS)
    }
}

impl Candidates {
    /// No candidates yet; recursive calls are inlined `levels` times.
    #[must_use]
    pub const fn new(levels: usize) -> Self {
        Self { levels, largest: SMALL, functions: BTreeMap::new() }
    }

    /// The candidates for code that must not grow.
    #[must_use]
    pub const fn small() -> Self {
        Self { levels: 0, largest: SMALLEST, functions: BTreeMap::new() }
    }

    /// Offers an optimised function of the source file `file`.
    pub fn add(&mut self, function: &Function, file: u32) {
        if size(function) <= self.largest && function.slots.is_empty() {
            self.functions.insert(function.symbol, (file, function.clone()));
        }
    }

    /// Inlines calls in `function`, which is in the source file `file`; returns whether there were any.
    ///
    /// Only functions of the same file are inlined: a function's instructions have lines of a single file.
    pub fn run(&self, function: &mut Function, file: u32) -> bool {
        let itself = function.symbol;
        let is_small = size(function) <= SMALL_RECURSIVE && function.slots.is_empty();
        let own = (is_small && callees(function).any(|symbol| symbol == itself)).then(|| function.clone());
        let find = |symbol: SymbolId| {
            let found = self.functions.get(&symbol).filter(|_| symbol != itself);
            found.filter(|(other, _)| *other == file).map(|(_, callee)| callee)
        };
        let mut is_changed = replace_calls(function, find);
        if let Some(own) = &own {
            for _ in 0..self.levels {
                if !replace_calls(function, |symbol| (symbol == itself).then_some(own)) {
                    break;
                }
                is_changed = true;
            }
        }
        is_changed
    }
}

/// Number of instructions, ends of blocks included; costs are none.
fn size(function: &Function) -> usize {
    let is_work = |inst: &&Inst| !matches!(inst.kind, InstKind::Cost { .. });
    function.layout.iter().map(|id| function.blocks[*id].insts.iter().filter(is_work).count() + 1).sum()
}

/// The functions that are called directly, once for each call.
fn callees(function: &Function) -> impl Iterator<Item = SymbolId> {
    let insts = function.layout.iter().flat_map(|id| &function.blocks[*id].insts);
    insts.filter_map(|inst| called_symbol(&inst.kind))
}

/// The function that an instruction calls by name.
const fn called_symbol(kind: &InstKind) -> Option<SymbolId> {
    if let InstKind::Call { callee: Callee::Symbol(symbol), .. } = *kind { Some(symbol) } else { None }
}

/// Replaces every existing call for which `find` returns a function; returns whether there was one.
fn replace_calls<'a>(function: &mut Function, find: impl Fn(SymbolId) -> Option<&'a Function>) -> bool {
    if callees(function).all(|symbol| find(symbol).is_none()) {
        return false;
    }
    let mut total = size(function);
    let writes = writes(function);
    let mut is_changed = false;
    let mut layout = Vec::new();
    for id in std::mem::take(&mut function.layout) {
        layout.push(id);
        let mut block = id;
        for inst in std::mem::take(&mut function.blocks[id].insts) {
            let callee = called_symbol(&inst.kind).and_then(&find);
            let callee = callee.filter(|callee| {
                inst.kind.signature() == Some(callee.signature) && total + size(callee) <= LARGEST
            });
            let Some(callee) = callee else {
                function.blocks[block].insts.push(inst);
                continue;
            };
            total += size(callee);
            is_changed = true;
            let behind = split(function, block);
            Copier::new(function, callee, &writes).copy(block, inst, behind, &mut layout);
            layout.push(behind);
            block = behind;
        }
    }
    function.layout = layout;
    is_changed
}

/// Number of writes of each value of a function.
fn writes(function: &Function) -> SecondaryMap<ValueId, u32> {
    let mut writes: SecondaryMap<ValueId, u32> = table(function.values.len());
    let insts = function.layout.iter().flat_map(|id| &function.blocks[*id].insts);
    for dst in insts.filter_map(|inst| inst.kind.dst()) {
        writes[dst] += 1;
    }
    writes
}

/// A new block that ends as `block` did.
fn split(function: &mut Function, block: BlockId) -> BlockId {
    let origin = function.blocks[block].origin;
    let terminator = std::mem::replace(&mut function.blocks[block].terminator, Terminator::Unreachable);
    function.blocks.push(Block { insts: Vec::new(), terminator, origin })
}

/// Copies one function into another.
struct Copier<'a> {
    to: &'a mut Function,
    from: &'a Function,
    /// Number of writes of each value of the calling function.
    writes: &'a SecondaryMap<ValueId, u32>,
    values: SecondaryMap<ValueId, ValueId>,
    blocks: SecondaryMap<BlockId, BlockId>,
    /// The inlined call, and the inlined calls of the callee, with their numbers there.
    call: PackedOption<InlineId>,
    inner: SecondaryMap<InlineId, PackedOption<InlineId>>,
}

impl<'a> Copier<'a> {
    fn new(to: &'a mut Function, from: &'a Function, writes: &'a SecondaryMap<ValueId, u32>) -> Self {
        // Entity 0 means that it is not copied; every entity that is mentioned is.
        let (mut values, mut blocks) = (
            SecondaryMap::with_default(ValueId::from_u32(0)),
            SecondaryMap::with_default(BlockId::from_u32(0)),
        );
        for (value, class) in &from.values {
            values[value] = to.values.push(*class);
        }
        for id in &from.layout {
            // Its inlined call is known when the block is copied.
            let origin = from.blocks[*id].origin;
            blocks[*id] =
                to.blocks.push(Block { insts: Vec::new(), terminator: Terminator::Unreachable, origin });
        }
        let (call, inner) = (PackedOption::default(), SecondaryMap::new());
        Self { to, from, writes, values, blocks, call, inner }
    }

    /// Copies the function between `before`, which should end with `call`, and `behind`.
    fn copy(mut self, before: BlockId, call: Inst, behind: BlockId, layout: &mut Vec<BlockId>) {
        let InstKind::Call { arguments, dst, .. } = call.kind else { return };
        self.record_inlining(call.origin, arguments);
        for (index, param) in arguments.range().zip(&self.from.params) {
            let src = self.to.arguments[index];
            let kind = InstKind::Copy { dst: self.values[*param], src };
            self.to.blocks[before].insts.push(Inst { kind, origin: call.origin });
        }
        let Some(&entry) = self.from.layout.first() else { return };
        self.to.blocks[before].terminator = Terminator::Jump(self.blocks[entry]);
        self.to.blocks[before].origin = call.origin;
        for id in &self.from.layout {
            let block = &self.from.blocks[*id];
            let mut insts: Vec<_> = block.insts.iter().map(|inst| self.inst(*inst)).collect();
            let terminator = match &block.terminator {
                Terminator::Return(value) => {
                    if let Some(dst) = dst.expand() {
                        let class: Class = self.to.values[dst];
                        let src = value.map_or(class.zero().into(), |value| self.operand(value));
                        let kind = InstKind::Copy { dst, src };
                        insts.push(Inst { kind, origin: self.origin(block.origin) });
                    }
                    Terminator::Jump(behind)
                }
                other @ (Terminator::Jump(_)
                | Terminator::Branch { .. }
                | Terminator::Table { .. }
                | Terminator::Unreachable) => self.terminator(other.clone()),
            };
            let copy = self.blocks[*id];
            self.to.blocks[copy].insts = insts;
            self.to.blocks[copy].terminator = terminator;
            self.to.blocks[copy].origin = self.origin(block.origin);
            layout.push(copy);
        }
    }

    /// Records for debuggers the inlined call, and the locations of the callee's locals.
    fn record_inlining(&mut self, origin: CodeOrigin, arguments: ArgumentRange) {
        let variables = self.variables(&self.from.source.variables, arguments);
        let call = InlinedCall { callee: self.from.symbol, origin, variables };
        self.call = self.to.source.inlined.push(call).into();
        for (id, inner) in &self.from.source.inlined {
            let variables = inner.variables.iter().map(|variable| self.copied_variable(*variable)).collect();
            let call = InlinedCall { callee: inner.callee, origin: self.origin(inner.origin), variables };
            self.inner[id] = self.to.source.inlined.push(call).into();
        }
    }

    /// The homes of the called function's locals: their copies, and for a parameter that is never written also its
    /// argument.
    fn variables(&self, of: &[SourceVariable], arguments: ArgumentRange) -> Vec<SourceVariable> {
        let mut variables = Vec::new();
        for variable in of {
            let VariableHome::Value(value, writes) = variable.home else {
                variables.push(self.copied_variable(*variable));
                continue;
            };
            let Some(index) = self.from.params.iter().position(|param| *param == value) else {
                variables.push(self.copied_variable(*variable));
                continue;
            };
            // The copy of the argument is one more.
            let home = VariableHome::Value(self.values[value], writes + 1);
            variables.push(SourceVariable { home, ..*variable });
            let argument = arguments.range().nth(index).and_then(|index| self.to.arguments.get(index));
            let home = match argument.filter(|_| writes == 0) {
                Some(Operand::Value(value)) => Some(VariableHome::Value(*value, self.writes[*value])),
                Some(Operand::Constant(constant)) => constant.bits().map(VariableHome::Constant),
                None => None,
            };
            variables.extend(home.map(|home| SourceVariable { home, ..*variable }));
        }
        variables
    }

    /// A local of the called function after it was copied.
    fn copied_variable(&self, variable: SourceVariable) -> SourceVariable {
        let home = match variable.home {
            VariableHome::Value(value, writes) => VariableHome::Value(self.values[value], writes),
            VariableHome::Pointer(value) => VariableHome::Pointer(self.values[value]),
            // A function with objects in the frame is not copied.
            home @ (VariableHome::Slot(_) | VariableHome::Constant(_)) => home,
        };
        SourceVariable { home, ..variable }
    }

    /// The source position of copied code.
    fn origin(&self, origin: CodeOrigin) -> CodeOrigin {
        let call = origin.call.expand().map_or(self.call, |inner| self.inner[inner]);
        CodeOrigin { span: origin.span, call }
    }

    fn terminator(&self, mut terminator: Terminator) -> Terminator {
        terminator.visit_targets(|target| *target = self.blocks[*target]);
        if let Some(operand) = terminator.operand_mut() {
            *operand = self.operand(*operand);
        }
        terminator
    }

    fn operand(&self, operand: Operand) -> Operand {
        match operand {
            Operand::Value(value) => Operand::Value(self.values[value]),
            Operand::Constant(_) => operand,
        }
    }

    fn address(&self, address: Address) -> Address {
        match address.base {
            Base::Value(value) => Address { base: Base::Value(self.values[value]), ..address },
            Base::Absolute | Base::Slot(_) | Base::Symbol(_) => address,
        }
    }

    fn arguments(&mut self, arguments: ArgumentRange) -> ArgumentRange {
        let start = self.to.arguments.len() as u32;
        for index in arguments.range() {
            let argument = self.operand(self.from.arguments[index]);
            self.to.arguments.push(argument);
        }
        ArgumentRange { start, count: arguments.count }
    }

    fn inst(&mut self, inst: Inst) -> Inst {
        let of = |value: ValueId| self.values[value];
        let kind = match inst.kind {
            InstKind::Copy { dst, src } => InstKind::Copy { dst: of(dst), src: self.operand(src) },
            InstKind::Unary { op, dst, src } => InstKind::Unary { op, dst: of(dst), src: self.operand(src) },
            InstKind::Binary { op, dst, a, b } => {
                InstKind::Binary { op, dst: of(dst), a: self.operand(a), b: self.operand(b) }
            }
            InstKind::Compare { op, dst, a, b } => {
                InstKind::Compare { op, dst: of(dst), a: self.operand(a), b: self.operand(b) }
            }
            InstKind::Convert { op, dst, src } => {
                InstKind::Convert { op, dst: of(dst), src: self.operand(src) }
            }
            InstKind::Load { dst, width, address } => {
                InstKind::Load { dst: of(dst), width, address: self.address(address) }
            }
            InstKind::Store { src, width, address } => {
                InstKind::Store { src: self.operand(src), width, address: self.address(address) }
            }
            InstKind::FrameAddress { dst, slot, offset } => {
                InstKind::FrameAddress { dst: of(dst), slot, offset }
            }
            InstKind::CopyMemory { to, from, len } => {
                InstKind::CopyMemory { to: self.address(to), from: self.address(from), len }
            }
            InstKind::ClearMemory { to, len } => InstKind::ClearMemory { to: self.address(to), len },
            InstKind::Cost { cycles } => InstKind::Cost { cycles },
            InstKind::Call { callee, arguments, signature, dst } => {
                let dst = dst.expand().map(of).into();
                let callee = match callee {
                    Callee::Pointer(target) => Callee::Pointer(self.operand(target)),
                    Callee::Symbol(_) => callee,
                };
                InstKind::Call { callee, arguments: self.arguments(arguments), signature, dst }
            }
        };
        Inst { kind, origin: self.origin(inst.origin) }
    }
}
