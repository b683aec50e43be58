//! IR to instructions over virtual registers.
//!
//! Every IR value has one virtual register. Constants that no instruction can hold are made where they are needed; in a
//! loop they are made before the first block, and the allocator rematerialises them where it has no register for them.

#![deny(clippy::wildcard_enum_match_arm, reason = "a new instruction, operator or mode must be decided")]

mod call;
mod constants;
mod convert;
mod early;
mod float;
mod integer;
mod memory;
mod terminate;
mod wide;

pub(super) use constants::make;

use std::collections::BTreeMap;

use cranelift_entity::{PrimaryMap, SecondaryMap};

use super::abi;
use super::code::{Arg, Block, Code, Condition, Inst, Terminator, VReg, VRegInfo, Value};
use super::externs::Externs;
use super::forms::Kind;
use crate::ir::function::{Function, Signatures, table};
use crate::ir::inst::{BlockId, Class, InstKind, Operand, ValueId};
use crate::source::Span;

/// The input of selection: the function, and the facts about its surroundings.
pub(super) struct Context<'a> {
    pub(super) function: &'a Function,
    pub(super) signatures: &'a Signatures,
    pub(super) externs: &'a mut Externs,
}

/// The instructions of a function.
pub(super) fn select(context: Context<'_>) -> Code {
    let function = context.function;
    let mut numbers: SecondaryMap<BlockId, u32> = table(function.blocks.len());
    for (number, id) in (0..).zip(&function.layout) {
        numbers[*id] = number;
    }
    let uses = count_uses(function, context.externs);
    let mut selector = Selector {
        function,
        signatures: context.signatures,
        externs: context.externs,
        values: SecondaryMap::new(),
        uses,
        numbers,
        code: Code {
            blocks: Vec::with_capacity(function.layout.len()),
            regs: PrimaryMap::with_capacity(function.values.len()),
            calls: Vec::new(),
            params: Vec::new(),
            tables: Vec::new(),
            spills: 0,
            has_variable_calls: false,
        },
        early: EntryCode::default(),
        constants: BTreeMap::new(),
        out: Vec::new(),
        span: function.span,
        depth: 0,
    };
    selector.values.resize(function.values.len());
    selector.run();
    selector.code
}

/// Number of reads of each value.
fn count_uses(function: &Function, externs: &Externs) -> SecondaryMap<ValueId, u32> {
    let mut uses: SecondaryMap<ValueId, u32> = table(function.values.len());
    let mut count = |operand: Operand| {
        if let Operand::Value(value) = operand {
            uses[value] += 1;
        }
    };
    for id in &function.layout {
        let block = &function.blocks[*id];
        for inst in &block.insts {
            let mut kind = inst.kind;
            kind.visit_operands(|operand| count(*operand));
            if let Some(arguments) = kind.arguments() {
                let operands = &function.arguments[arguments.range()];
                let is_unwanted =
                    matches!(kind, InstKind::Call { callee, .. } if call::takes_stack_alone(callee, externs));
                let wanted = operands.len() - usize::from(is_unwanted);
                operands.iter().take(wanted).for_each(|operand| count(*operand));
            }
        }
        if let Some(operand) = block.terminator.operand() {
            count(operand);
        }
    }
    uses
}

/// The code before the first block.
#[derive(Default)]
struct EntryCode {
    insts: Vec<Inst>,
    /// Constants that are available in registers from the present position on.
    constants: Vec<(Value, VReg)>,
    /// Constants that are available in pairs from the present position on.
    wide_constants: Vec<(u64, VReg)>,
}

pub(super) struct Selector<'a> {
    function: &'a Function,
    signatures: &'a Signatures,
    externs: &'a mut Externs,
    values: SecondaryMap<ValueId, Option<VReg>>,
    uses: SecondaryMap<ValueId, u32>,
    numbers: SecondaryMap<BlockId, u32>,
    code: Code,
    early: EntryCode,
    /// Constants that are in registers in this block.
    constants: BTreeMap<Value, VReg>,
    out: Vec<Inst>,
    span: Span,
    depth: u32,
}

impl Selector<'_> {
    fn run(&mut self) {
        let function = self.function;
        self.parameters();
        let depths = depths(function);
        let is_shared = early::is_area_shared(function, self.externs);
        for (id, depth) in function.layout.iter().zip(depths) {
            self.depth = depth;
            self.constants.clear();
            let block = &function.blocks[*id];
            let fused = terminate::fused_compare(function, block, &self.uses);
            let count = block.insts.len() - usize::from(fused.is_some());
            let order = early::order(function, block, self.externs, is_shared);
            for inst in order.into_iter().filter(|index| *index < count).map(|index| &block.insts[index]) {
                self.span = inst.origin.span;
                self.inst(&inst.kind);
            }
            self.span = block.origin.span;
            let end = self.terminator(&block.terminator, fused);
            let insts = std::mem::take(&mut self.out);
            self.code.blocks.push(Block {
                insts,
                terminator: end,
                depth,
                unrolled: 1,
                span: block.origin.span,
            });
        }
        self.insert_entry_code();
    }

    /// Inserts the early instructions before the first block; if that block is a jump target, another block is put
    /// before it.
    fn insert_entry_code(&mut self) {
        let early = std::mem::take(&mut self.early.insts);
        let is_target = self.code.blocks.iter().any(|block| block.terminator.targets().any(|to| to == 0));
        if !is_target {
            if let Some(first) = self.code.blocks.first_mut() {
                first.insts.splice(0..0, early);
            }
            return;
        }
        let up = |to: &mut u32| *to += 1;
        for block in &mut self.code.blocks {
            match &mut block.terminator {
                Terminator::Jump(to) => up(to),
                Terminator::Branch { then, otherwise, .. } => {
                    up(then);
                    up(otherwise);
                }
                Terminator::Table { targets, .. } => targets.iter_mut().for_each(up),
                Terminator::Return(_) | Terminator::Unreachable => {}
            }
        }
        self.code.tables.iter_mut().flatten().for_each(up);
        let span = self.function.span;
        self.code
            .blocks
            .insert(0, Block { insts: early, terminator: Terminator::Jump(1), depth: 0, unrolled: 1, span });
    }

    fn parameters(&mut self) {
        let params = &self.function.params;
        for (param, at) in params.iter().zip(abi::ARGUMENTS) {
            let reg = self.value(*param);
            self.code.regs[reg].hint = Some(at);
            self.code.params.push((reg, at));
        }
        if params.len() > abi::ARGUMENTS.len() {
            let rest = self.word();
            self.code.regs[rest].hint = Some(abi::REST);
            self.code.params.push((rest, abi::REST));
            for (index, param) in (0..).zip(&params[abi::ARGUMENTS.len()..]) {
                let reg = self.value(*param);
                let place = self.offset_address(rest, index * 8);
                self.load_value(reg, self.function.values[*param], place);
            }
            let loads = std::mem::take(&mut self.out);
            self.early.insts.extend(loads);
        }
    }

    /// The register of a value.
    fn value(&mut self, value: ValueId) -> VReg {
        if let Some(reg) = self.values[value] {
            return reg;
        }
        let is_pair = matches!(self.function.values[value], Class::I64 | Class::F64);
        let reg = self.code.reg(VRegInfo { is_pair, ..VRegInfo::default() });
        self.values[value] = Some(reg);
        reg
    }

    /// A new register for a word.
    fn word(&mut self) -> VReg {
        self.code.reg(VRegInfo::default())
    }

    /// A new register for a pair.
    fn pair(&mut self) -> VReg {
        self.code.reg(VRegInfo { is_pair: true, ..VRegInfo::default() })
    }

    /// A new register that is tested.
    fn condition(&mut self) -> VReg {
        self.code.reg(VRegInfo { is_condition: true, ..VRegInfo::default() })
    }

    fn push(&mut self, kind: Kind, dst: impl Into<Arg>, src1: impl Into<Arg>, src2: impl Into<Arg>) {
        self.out.push(Inst::new(kind, dst.into(), src1.into(), src2.into(), self.span));
    }

    /// An instruction whose result is a new word.
    fn make(&mut self, kind: Kind, src1: impl Into<Arg>, src2: impl Into<Arg>) -> VReg {
        let dst = self.word();
        self.push(kind, dst, src1, src2);
        dst
    }

    /// An instruction with one source.
    fn unary(&mut self, kind: Kind, dst: impl Into<Arg>, src: impl Into<Arg>) {
        self.push(kind, dst, Arg::None, src);
    }

    /// An instruction that extracts or inserts a bit field.
    fn field(&mut self, kind: Kind, dst: impl Into<Arg>, src: impl Into<Arg>, field: (u8, u8)) {
        let mut inst = Inst::new(kind, dst.into(), Arg::None, src.into(), self.span);
        inst.field = field;
        self.out.push(inst);
    }

    /// Puts the last instruction under a condition.
    fn only_if(&mut self, condition: Condition) {
        if let Some(last) = self.out.last_mut() {
            last.condition = condition;
        }
    }

    /// `dst = src`, of a word.
    fn copy_word(&mut self, dst: impl Into<Arg>, src: impl Into<Arg>) {
        self.push(Kind::Move, dst, Arg::number(0), src);
    }

    /// `dst = src` for a pair. Nothing if they are the same, since `Begin` must not precede a read.
    fn copy_pair(&mut self, dst: VReg, src: VReg) {
        if dst == src {
            return;
        }
        self.begin(dst);
        self.copy_word(Arg::Low(dst), Arg::Low(src));
        self.copy_word(Arg::High(dst), Arg::High(src));
    }

    /// Marks a pair whose halves will be written one by one.
    fn begin(&mut self, dst: VReg) {
        self.push(Kind::Begin, dst, Arg::None, Arg::None);
    }

    /// The register that holds an operand.
    fn operand(&mut self, operand: Operand) -> VReg {
        match operand {
            Operand::Value(value) => self.value(value),
            Operand::Constant(constant) => self.constant(constant),
        }
    }

    fn class(&self, value: ValueId) -> Class {
        self.function.values[value]
    }

    fn inst(&mut self, kind: &InstKind) {
        match *kind {
            InstKind::Copy { dst, src: Operand::Constant(constant) } => {
                let dst = self.value(dst);
                self.constant_in(dst, constant);
            }
            InstKind::Copy { dst, src: Operand::Value(src) } => {
                let (is_pair, dst, src) = (is_pair(self.class(dst)), self.value(dst), self.value(src));
                if is_pair {
                    self.copy_pair(dst, src);
                } else {
                    self.copy_word(dst, src);
                }
            }
            InstKind::Unary { op, dst, src } => self.unary_op(op, dst, src),
            InstKind::Binary { op, dst, a, b } => match self.class(dst) {
                Class::I32 => self.binary_i32(op, dst, a, b),
                Class::I64 => self.binary_i64(op, dst, a, b),
                class @ (Class::F32 | Class::F64) => self.binary_float(class, op, dst, a, b),
            },
            InstKind::Compare { op, dst, a, b } => {
                let dst = self.value(dst);
                let is_inverted = self.compare(op, dst, a, b);
                if is_inverted {
                    self.push(Kind::Xor, dst, Arg::number(1), dst);
                }
            }
            InstKind::Convert { op, dst, src } => self.convert(op, dst, src),
            InstKind::Load { dst, width, address } => self.load(dst, width, address),
            InstKind::Store { src, width, address } => self.store(src, width, address),
            InstKind::FrameAddress { dst, .. } if self.uses[dst] == 0 => {}
            InstKind::FrameAddress { dst, slot, offset } => {
                let dst = self.value(dst);
                self.frame_address(dst, slot, offset);
            }
            InstKind::CopyMemory { to, from, len } => self.copy_memory(to, from, len),
            InstKind::ClearMemory { to, len } => self.clear_memory(to, len),
            // The processor takes its own time.
            InstKind::Cost { .. } => {}
            InstKind::Call { callee, arguments, signature, dst } => {
                self.call(callee, arguments, signature, dst.expand());
            }
        }
    }
}

/// Reports whether values of a class are in pairs.
const fn is_pair(class: Class) -> bool {
    matches!(class, Class::I64 | Class::F64)
}

/// Number of loops around each block of the layout; a loop is the segment from the target of a backward jump to the
/// jump.
fn depths(function: &Function) -> Vec<u32> {
    let mut places: SecondaryMap<BlockId, u32> = table(function.blocks.len());
    for (index, id) in function.layout.iter().enumerate() {
        places[*id] = index as u32;
    }
    // The last jump back to each block: several such jumps form one loop.
    let mut ends = vec![None; function.layout.len()];
    for (index, id) in function.layout.iter().enumerate() {
        for target in function.blocks[*id].terminator.targets().map(|to| places[to] as usize) {
            if target <= index {
                ends[target] = Some(index);
            }
        }
    }
    let mut changes = vec![0_i32; function.layout.len() + 1];
    for (start, end) in ends.iter().enumerate() {
        if let Some(end) = end {
            changes[start] += 1;
            changes[end + 1] -= 1;
        }
    }
    let mut depth = 0;
    let blocks = changes.iter().take(function.layout.len());
    blocks
        .map(|change| {
            depth += change;
            depth.unsigned_abs()
        })
        .collect()
}
