//! Expansion of instructions over virtual registers to regions of steps.
//!
//! A region is the unit of scheduling: a block, or a part of it up to a call. Calls become moves of their arguments and
//! a branch with the return address in B3; the prologue and the epilogues of the function manage the frame.

use c67x::{Pred, Reg};
use cranelift_entity::SecondaryMap;

use super::abi;
use super::allocate::Assignment;
use super::code::{Arg, Base, Call, CallTarget, Code, Inst, MemoryPlace, Terminator, Value};
use super::forms::Kind;
use super::frame::{self, Frame};
use super::moves;
use super::step::{Access, Finalizer, Operands, PhysicalOperand, Step, pred, step};
use crate::ir::function::{Function, table};
use crate::ir::inst::SlotId;
use crate::source::Span;

/// A region: the unit of scheduling.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Region {
    /// Its label: the number of a block, or a later number for a return point of a call.
    pub(super) label: u32,
    pub(super) steps: Vec<Step>,
    /// The branches at its end, none if execution continues in the next region.
    pub(super) branches: Vec<Step>,
    /// The steps in the delay slots of the branch, in this order: they change the register that it reads.
    pub(super) late: Vec<Step>,
    pub(super) exit_registers: ExitRegisters,
    /// The estimated frequency of its execution, including that of the code around a loop.
    pub(super) weight: f32,
    pub(super) span: Span,
}

impl Region {
    /// An empty region.
    pub(super) fn new(label: u32, weight: f32, span: Span) -> Self {
        let beyond = ExitRegisters::default();
        Self {
            label,
            steps: Vec::new(),
            branches: Vec::new(),
            late: Vec::new(),
            exit_registers: beyond,
            weight,
            span,
        }
    }
}

/// The registers that code elsewhere reads and changes, a bit each, at the exits of the function.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct ExitRegisters {
    pub(super) reads: u64,
    pub(super) changes: u64,
}

/// A function with the registers of the processor.
#[derive(Debug)]
pub(super) struct ExpandedFunction {
    pub(super) regions: Vec<Region>,
    /// The first unused label.
    pub(super) labels: u32,
    /// The regions after calls, in whose first cycle the call's last result may still land.
    pub(super) late: Vec<u32>,
    /// Bytes of its frame.
    pub(super) frame: u32,
}

/// The location of the return address while calls change its register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ReturnAddress {
    /// In a callee-saved register, if one is free.
    Register,
    /// In the frame: an instruction less, and five cycles more.
    Frame,
}

/// The reason why a function cannot be expanded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TooLarge {
    /// The objects of its frame.
    Frame,
    /// An instruction that no form can express.
    Code,
}

/// Expands the function.
pub(super) fn expand(
    function: &Function,
    code: &Code,
    assignment: &Assignment,
    back: ReturnAddress,
) -> Result<ExpandedFunction, TooLarge> {
    let calls = !code.calls.is_empty();
    let mut saved: Vec<Reg> = abi::registers(assignment.kept).collect();
    let home = back;
    let mut back = abi::LINK;
    if calls {
        // From a callee-saved register, the return address is available at once when the function ends.
        let free =
            abi::registers(abi::KEPT & !assignment.kept).last().filter(|_| home == ReturnAddress::Register);
        back = free.unwrap_or(abi::LINK);
        saved.push(back);
    }
    let frame = frame::lay_out(function, code, saved.len() as u32).ok_or(TooLarge::Frame)?;
    let escaping = escaping(function, code);
    let mut expander = Expander {
        finalizer: Finalizer { code, assignment, frame: &frame, escaping: &escaping },
        code,
        frame: &frame,
        saved,
        back,
        regions: Vec::with_capacity(code.blocks.len()),
        region: Region::new(0, 1.0, function.span),
        returns: code.blocks.len() as u32,
        late: Vec::new(),
        is_wrong: false,
    };
    expander.run();
    if expander.is_wrong {
        return Err(TooLarge::Code);
    }
    let Expander { regions, returns: labels, late, .. } = expander;
    Ok(ExpandedFunction { regions, labels, late, frame: frame.size })
}

/// The objects of the frame whose addresses are taken.
fn escaping(function: &Function, code: &Code) -> SecondaryMap<SlotId, bool> {
    let mut escaping = table(function.slots.len());
    if let Some(outgoing) = function.outgoing {
        escaping[outgoing] = true;
    }
    for inst in code.blocks.iter().flat_map(|block| &block.insts) {
        if let (Kind::FrameAddress, Some(MemoryPlace { base: Base::Slot(slot), .. })) =
            (inst.kind, inst.place)
        {
            escaping[slot] = true;
        }
    }
    escaping
}

struct Expander<'a> {
    finalizer: Finalizer<'a>,
    code: &'a Code,
    frame: &'a Frame,
    saved: Vec<Reg>,
    /// The register that holds the return address while calls change B3.
    back: Reg,
    regions: Vec<Region>,
    /// The one that grows.
    region: Region,
    /// The label of the next return point of a call.
    returns: u32,
    /// The labels of the return points of calls whose last result lands late.
    late: Vec<u32>,
    is_wrong: bool,
}

impl Expander<'_> {
    fn run(&mut self) {
        let code = self.code;
        for (number, block) in (0..).zip(&code.blocks) {
            self.region.label = number;
            self.region.weight = block.weight();
            if number == 0 {
                self.emit_prologue();
            }
            for inst in &block.insts {
                self.region.span = inst.span;
                self.inst(inst);
            }
            self.region.span = block.span;
            self.emit_terminator(&block.terminator, number + 1);
        }
    }

    /// Ends the region.
    fn close(&mut self, branches: Vec<Step>) {
        let Region { label, weight, span, .. } = self.region;
        let done = std::mem::replace(&mut self.region, Region::new(label, weight, span));
        self.regions.push(Region { branches, ..done });
    }

    fn emit(&mut self, kind: Kind, operands: &Operands, access: Access) {
        match step(kind, operands, access, self.region.span) {
            Some(step) => self.region.steps.push(step),
            None => {
                debug_assert!(false, "no form of {kind:?} takes {operands:?}");
                self.is_wrong = true;
            }
        }
    }

    fn emit_simple(
        &mut self,
        kind: Kind,
        dst: PhysicalOperand,
        src1: PhysicalOperand,
        src2: PhysicalOperand,
    ) {
        let operands = Operands { dst, src1, src2, mem: None, field: (0, 0), pred: Pred::Always };
        self.emit(kind, &operands, Access::None);
    }

    fn move_word(&mut self, to: Reg, from: Reg) {
        let zero = PhysicalOperand::Value(Value::Number(0));
        self.emit_simple(Kind::Move, PhysicalOperand::Reg(to), zero, PhysicalOperand::Reg(from));
    }

    /// A word of the frame that holds a saved register.
    fn saved_word(&mut self, kind: Kind, reg: Reg, index: u32) {
        let at = (self.frame.saved + 4 * index).cast_signed();
        let place = MemoryPlace::new(Base::Stack, at);
        let Some(mem) = self.finalizer.mem(place, 4) else { return };
        let (dst, src2) = if kind.is_store() {
            (PhysicalOperand::None, PhysicalOperand::Reg(reg))
        } else {
            (PhysicalOperand::Reg(reg), PhysicalOperand::None)
        };
        let operands = Operands {
            dst,
            src1: PhysicalOperand::None,
            src2,
            mem: Some(mem),
            field: (0, 0),
            pred: Pred::Always,
        };
        self.emit(kind, &operands, Access::Own { is_store: kind.is_store(), at, size: 4 });
    }

    /// `B15 += bytes`
    fn move_stack(&mut self, bytes: i32) {
        let stack = PhysicalOperand::Reg(abi::STACK);
        self.emit_simple(
            Kind::Addk,
            stack,
            PhysicalOperand::Value(Value::Number(bytes)),
            PhysicalOperand::None,
        );
    }

    /// Emits the steps before the first block.
    fn emit_prologue(&mut self) {
        if self.frame.size > 0 {
            self.move_stack(-self.frame.size.cast_signed());
        }
        for (index, reg) in (0..).zip(self.saved.clone()) {
            self.saved_word(Kind::StoreWord, reg, index);
        }
        if self.back != abi::LINK {
            self.move_word(self.back, abi::LINK);
        }
        let mut list = Vec::new();
        for (reg, at) in &self.code.params {
            // A value that is never read has no register.
            if self.finalizer.assignment.is_used(*reg) {
                self.push_word_moves(
                    self.finalizer.assignment.register_of(*reg),
                    *at,
                    self.code.regs[*reg].is_pair,
                    &mut list,
                );
            }
        }
        self.emit_moves(&list);
    }

    /// The registers of a value that is at `at`, a bit each.
    fn occupied_registers(&self, value: super::code::VReg, at: Reg) -> u64 {
        let high = if self.code.regs[value].is_pair { abi::bit(at.pair().high()) } else { 0 };
        abi::bit(at) | high
    }

    /// The moves of one value, a word each.
    fn push_word_moves(&self, to: Reg, from: Reg, is_pair: bool, list: &mut Vec<(Reg, Reg)>) {
        list.push((to, from));
        if is_pair {
            list.push((to.pair().high(), from.pair().high()));
        }
    }

    fn emit_moves(&mut self, list: &[(Reg, Reg)]) {
        for (to, from) in moves::in_order(list, abi::CHANGED & !abi::bit(abi::LINK)) {
            self.move_word(to, from);
        }
    }

    fn inst(&mut self, inst: &Inst) {
        match (inst.kind, inst.place) {
            (Kind::Begin, _) => {}
            (Kind::Call, _) => self.call(&self.code.calls[inst.number as usize], inst.dst.reg()),
            (Kind::FrameAddress, Some(place)) => {
                let dst = self.finalizer.arg(inst.dst);
                let offset = self.finalizer.offset(place);
                self.emit_simple(
                    Kind::Mvk,
                    dst,
                    PhysicalOperand::Value(Value::Number(offset)),
                    PhysicalOperand::None,
                );
                self.emit_simple(Kind::Add, dst, dst, PhysicalOperand::Reg(abi::STACK));
            }
            (Kind::LoadPair, Some(place)) if !self.reaches_pair(place) => self.load_halves(inst, place),
            _ => self.ordinary(inst),
        }
    }

    /// Reports whether a load of a pair can use this address: an offset in the frame can be at most 31 pairs.
    fn reaches_pair(&self, place: MemoryPlace) -> bool {
        if matches!(place.base, Base::Reg(_)) {
            return true;
        }
        let offset = self.finalizer.offset(place);
        offset % 8 == 0 && (0..32).contains(&(offset / 8))
    }

    fn load_halves(&mut self, inst: &Inst, place: MemoryPlace) {
        let Arg::Reg(dst) = inst.dst else { return };
        for (dst, offset) in [(Arg::Low(dst), 0), (Arg::High(dst), 4)] {
            let place = MemoryPlace { offset: place.offset + offset, ..place };
            self.ordinary(&Inst { kind: Kind::LoadWord, dst, place: Some(place), ..*inst });
        }
    }

    fn ordinary(&mut self, inst: &Inst) {
        let pred = match inst.condition {
            None => Some(Pred::Always),
            Some((reg, negated)) => pred(self.finalizer.assignment.register_of(reg), negated),
        };
        let Some(pred) = pred else {
            self.is_wrong = true;
            return;
        };
        let mut access = Access::None;
        let mut mem = None;
        if let (Some(place), Some(bytes)) = (inst.place, inst.kind.bytes()) {
            mem = self.finalizer.mem(place, bytes);
            if let Some(mem) = mem {
                access = self.finalizer.access(inst.kind, place, mem);
            }
        }
        let dst = self.finalizer.arg(inst.dst);
        let src2 = self.finalizer.arg(inst.src2);
        if inst.kind == Kind::Move && dst == src2 {
            return;
        }
        let operands =
            Operands { dst, src1: self.finalizer.arg(inst.src1), src2, mem, field: inst.field, pred };
        let is_large =
            matches!(inst.src1, Arg::Value(Value::Number(number)) if !(-16..=15).contains(&number));
        if is_large && inst.kind == Kind::Add && step(Kind::Add, &operands, access, inst.span).is_none() {
            // The register does not count on any more, as it did where this was selected.
            self.emit(Kind::Mvk, &Operands { src2: PhysicalOperand::None, ..operands }, Access::None);
            return self.emit(Kind::Add, &Operands { src1: dst, ..operands }, Access::None);
        }
        self.emit(inst.kind, &operands, access);
    }

    fn call(&mut self, call: &Call, result: Option<super::code::VReg>) {
        let mut list = Vec::new();
        for (reg, at) in &call.arguments {
            self.push_word_moves(
                *at,
                self.finalizer.assignment.register_of(*reg),
                self.code.regs[*reg].is_pair,
                &mut list,
            );
        }
        self.emit_moves(&list);
        let label = self.returns;
        self.returns += 1;
        let link = PhysicalOperand::Reg(abi::LINK);
        let back = PhysicalOperand::Value(Value::Block(label));
        self.emit_simple(Kind::Mvk, link, back, PhysicalOperand::None);
        self.emit_simple(Kind::Mvkh, link, back, PhysicalOperand::None);
        let target = match call.target {
            CallTarget::Symbol(symbol) => PhysicalOperand::Value(Value::Symbol(symbol, 0)),
            CallTarget::Register => PhysicalOperand::Reg(abi::TARGET),
        };
        let branch = self.branch(target, Pred::Always);
        let passed = call.arguments.iter();
        let reads = passed.fold(0, |set, (reg, at)| set | self.occupied_registers(*reg, *at));
        self.region.exit_registers = ExitRegisters { reads, changes: call.changes };
        self.close(branch.into_iter().collect());
        self.region.label = label;
        if call.is_late {
            self.late.push(label);
        }
        if let Some(result) = result.filter(|result| self.finalizer.assignment.is_used(*result)) {
            let mut list = Vec::new();
            let to = self.finalizer.assignment.register_of(result);
            self.push_word_moves(to, abi::RESULT, self.code.regs[result].is_pair, &mut list);
            self.emit_moves(&list);
        }
    }

    fn branch(&mut self, target: PhysicalOperand, pred: Pred) -> Option<Step> {
        let operands = match target {
            PhysicalOperand::Value(_) => Operands {
                dst: PhysicalOperand::None,
                src1: target,
                src2: PhysicalOperand::None,
                mem: None,
                field: (0, 0),
                pred,
            },
            _ => Operands {
                dst: PhysicalOperand::None,
                src1: PhysicalOperand::None,
                src2: target,
                mem: None,
                field: (0, 0),
                pred,
            },
        };
        let step = step(Kind::Branch, &operands, Access::None, self.region.span);
        self.is_wrong |= step.is_none();
        step
    }

    fn jump(&mut self, block: u32, pred: Pred) -> Option<Step> {
        self.branch(PhysicalOperand::Value(Value::Block(block)), pred)
    }

    fn emit_terminator(&mut self, end: &Terminator, next: u32) {
        let branches = match *end {
            Terminator::Jump(to) if to == next => Vec::new(),
            Terminator::Jump(to) => self.jump(to, Pred::Always).into_iter().collect(),
            Terminator::Branch { condition, negated, then, otherwise } => {
                let at = self.finalizer.assignment.register_of(condition);
                let (Some(yes), Some(no)) = (pred(at, negated), pred(at, !negated)) else {
                    self.is_wrong = true;
                    return;
                };
                let mut branches = Vec::new();
                if then != next {
                    branches.extend(self.jump(then, yes));
                }
                if otherwise != next {
                    branches.extend(self.jump(otherwise, no));
                }
                branches
            }
            Terminator::Table { address, .. } => {
                self.region.exit_registers.reads = !0;
                let at = self.finalizer.assignment.register_of(address);
                self.branch(PhysicalOperand::Reg(at), Pred::Always).into_iter().collect()
            }
            Terminator::Return(value) => self.emit_epilogue(value),
            // Execution that gets here by mistake leaves the function.
            Terminator::Unreachable => self.emit_epilogue(None),
        };
        self.close(branches);
    }

    /// The end of the function.
    fn emit_epilogue(&mut self, value: Option<super::code::VReg>) -> Vec<Step> {
        self.region.exit_registers.reads = abi::KEPT | abi::bit(abi::STACK);
        if let Some(value) = value {
            self.region.exit_registers.reads |= self.occupied_registers(value, abi::RESULT);
            let mut list = Vec::new();
            let from = self.finalizer.assignment.register_of(value);
            self.push_word_moves(abi::RESULT, from, self.code.regs[value].is_pair, &mut list);
            self.emit_moves(&list);
        }
        let mut late = None;
        for (index, reg) in (0..).zip(self.saved.clone()) {
            self.saved_word(Kind::LoadWord, reg, index);
            if reg == self.back && self.back != abi::LINK {
                late = self.region.steps.pop();
            }
        }
        if self.frame.size > 0 {
            self.move_stack(self.frame.size.cast_signed());
        }
        if let Some(load) = late {
            let stack = self.region.steps.pop();
            self.region.late = [Some(load), stack].into_iter().flatten().collect();
        }
        self.branch(PhysicalOperand::Reg(self.back), Pred::Always).into_iter().collect()
    }
}
