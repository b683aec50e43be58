//! Instructions of the processor, ready to be scheduled.
//!
//! A step has every form that its registers allow; the forms differ only in their units.

use c67x::{Inst, Mem, Offset, Operand, Pair, Pred, PredReg, Reg, Side, Update};

use super::abi;
use super::code::{self, Arg, Base, MemoryPlace, Value};
use super::forms::{Form, Kind};
use crate::source::Span;

/// The effect of a step on memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Access {
    None,
    /// Bytes of the frame that no other function can reach: offset and size.
    Own {
        is_store: bool,
        at: i32,
        size: u32,
    },
    /// Anything else: base register, offset if it is a constant, and size.
    Shared {
        is_store: bool,
        base: Reg,
        at: Option<i32>,
        size: u32,
    },
}

/// The placeholder for the target of a branch until it is known.
const UNKNOWN: i32 = 0x3F_FFE0;

/// An instruction with its registers assigned.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Step {
    /// The forms; never empty.
    pub(super) forms: Vec<Inst>,
    /// The value that the linker or the layout completes: a constant, or the target of a branch.
    pub(super) value: Option<Value>,
    pub(super) access: Access,
    pub(super) span: Span,
}

/// An operand as a register of the processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PhysicalOperand {
    None,
    Reg(Reg),
    Pair(Pair),
    Value(Value),
}

/// The sources and the result of an instruction, by field.
#[derive(Clone, Copy, Debug)]
pub(super) struct Operands {
    pub(super) dst: PhysicalOperand,
    pub(super) src1: PhysicalOperand,
    pub(super) src2: PhysicalOperand,
    pub(super) mem: Option<Mem>,
    pub(super) field: (u8, u8),
    pub(super) pred: Pred,
}

/// The step of an instruction; `None` if no form takes its operands, which is a bug of earlier stages.
pub(super) fn step(kind: Kind, operands: &Operands, access: Access, span: Span) -> Option<Step> {
    let side = unit_side(operands);
    let forms: Vec<Inst> = kind.forms().iter().filter_map(|form| build(*form, side, operands)).collect();
    let value = [operands.src1, operands.src2].into_iter().find_map(|operand| match operand {
        PhysicalOperand::Value(value) if matches!(kind, Kind::Mvk | Kind::Mvkh | Kind::Branch) => Some(value),
        _ => None,
    });
    (!forms.is_empty()).then_some(Step { forms, value, access, span })
}

/// The side on which an instruction executes.
fn unit_side(operands: &Operands) -> Option<Side> {
    if let Some(mem) = operands.mem {
        return Some(mem.base.side());
    }
    match operands.dst {
        PhysicalOperand::Reg(reg) => Some(reg.side()),
        PhysicalOperand::Pair(pair) => Some(pair.side()),
        PhysicalOperand::None | PhysicalOperand::Value(_) => None,
    }
}

fn build(form: Form, side: Option<Side>, operands: &Operands) -> Option<Inst> {
    // It has no source: it adds to its destination.
    if form.op == c67x::Op::Addk
        && !matches!(operands.src2, PhysicalOperand::None)
        && operands.src2 != operands.dst
    {
        return None;
    }
    let row = form.op.row();
    let (src1, src2) =
        if form.is_swapped { (operands.src2, operands.src1) } else { (operands.src1, operands.src2) };
    let mut list = [Operand::Const(0); 4];
    for (slot, (field, _)) in list.iter_mut().zip(row.operands) {
        *slot = match field {
            c67x::Field::Src1 => operand(src1, form)?,
            c67x::Field::Src2 | c67x::Field::Src => operand(src2, form)?,
            c67x::Field::Dst => operand(operands.dst, form)?,
            c67x::Field::Mem => Operand::Mem(operands.mem?),
            c67x::Field::Csta => Operand::Const(operands.field.0.into()),
            c67x::Field::Cstb => Operand::Const(operands.field.1.into()),
            c67x::Field::Cst => operand(src1, form)?,
            c67x::Field::N => return None,
        };
    }
    let list = &list[..row.operands.len()];
    // Branches have no result: branches with a displacement can execute on either side, others on side B.
    let side = side.unwrap_or(Side::B);
    Inst::new(form.op, side, operands.pred, list).ok()
}

fn operand(operand: PhysicalOperand, form: Form) -> Option<Operand> {
    Some(match operand {
        PhysicalOperand::None => return None,
        PhysicalOperand::Reg(reg) => Operand::Reg(reg),
        PhysicalOperand::Pair(pair) => Operand::Pair(pair),
        PhysicalOperand::Value(value) => {
            let number = match value {
                Value::Number(number) => number,
                Value::Symbol(..) | Value::Block(_) | Value::Table(_) => 0,
            };
            match form.op {
                c67x::Op::Mvk => Operand::Const(i32::from(number as i16)),
                c67x::Op::Mvkh => Operand::Const((number.cast_unsigned() >> 16).cast_signed()),
                // Until it is known: outside of the code, so that checks treat it as an exit.
                c67x::Op::BDisp => Operand::Target(UNKNOWN),
                _ => Operand::Const(number),
            }
        }
    })
}

/// The condition of an instruction.
pub(super) fn pred(reg: Reg, is_negated: bool) -> Option<Pred> {
    let reg = PredReg::from_reg(reg)?;
    Some(if is_negated { Pred::Unless(reg) } else { Pred::If(reg) })
}

/// Converts registers of one numbering to those of the processor.
pub(super) struct Finalizer<'a> {
    pub(super) code: &'a code::Code,
    pub(super) assignment: &'a super::allocate::Assignment,
    pub(super) frame: &'a super::frame::Frame,
    /// Objects of the frame whose address is taken.
    pub(super) escaping: &'a cranelift_entity::SecondaryMap<crate::ir::inst::SlotId, bool>,
}

impl Finalizer<'_> {
    pub(super) fn arg(&self, arg: Arg) -> PhysicalOperand {
        match arg {
            Arg::None => PhysicalOperand::None,
            Arg::Value(value) => PhysicalOperand::Value(value),
            Arg::Low(reg) => PhysicalOperand::Reg(self.assignment.register_of(reg)),
            Arg::High(reg) => PhysicalOperand::Reg(self.assignment.register_of(reg).pair().high()),
            Arg::Reg(reg) => {
                let at = self.assignment.register_of(reg);
                if self.code.regs[reg].is_pair {
                    PhysicalOperand::Pair(at.pair())
                } else {
                    PhysicalOperand::Reg(at)
                }
            }
        }
    }

    /// The offset above B15, in bytes, to which an address is relative.
    pub(super) fn offset(&self, place: MemoryPlace) -> i32 {
        let base = match place.base {
            Base::Slot(slot) => self.frame.slots[slot],
            Base::Spill(first) => self.frame.spills + 4 * first,
            Base::Stack | Base::Reg(_) => 0,
        };
        base.cast_signed().wrapping_add(place.offset)
    }

    /// The address of an access of `bytes` bytes; `None` if no instruction reaches it.
    pub(super) fn mem(&self, place: MemoryPlace, bytes: u32) -> Option<Mem> {
        let size = bytes.cast_signed();
        let Base::Reg(base) = place.base else {
            let offset = self.offset(place);
            let elements = (offset % size == 0).then_some(offset / size)?;
            return Some(Mem::at(abi::STACK, u16::try_from(elements).ok()?));
        };
        let base = self.assignment.register_of(base);
        if let Some(index) = place.index {
            return Some(Mem::indexed(base, self.assignment.register_of(index)));
        }
        if place.step != 0 {
            let steps = u16::try_from(place.step.unsigned_abs()).ok()?;
            return Some(Mem {
                base,
                negative: place.step < 0,
                update: Update::After,
                offset: Offset::Const(steps),
            });
        }
        let elements = (place.offset % size == 0).then_some(place.offset / size)?;
        let offset = u16::try_from(elements.unsigned_abs()).ok()?;
        Some(Mem { base, negative: elements < 0, update: Update::None, offset: Offset::Const(offset) })
    }

    /// The effect of an access on memory.
    pub(super) fn access(&self, kind: Kind, place: MemoryPlace, mem: Mem) -> Access {
        let (is_store, size) = (kind.is_store(), kind.bytes().unwrap_or(4));
        let at = self.offset(place);
        match place.base {
            Base::Spill(_) => Access::Own { is_store, at, size },
            Base::Slot(slot) if !self.escaping[slot] => Access::Own { is_store, at, size },
            Base::Slot(_) | Base::Stack | Base::Reg(_) => {
                let is_constant = place.index.is_none() && place.step == 0;
                Access::Shared { is_store, base: mem.base, at: is_constant.then_some(at), size }
            }
        }
    }
}
