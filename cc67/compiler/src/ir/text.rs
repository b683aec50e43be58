//! The text form of a function, which [`super::parse`] reads back.
//!
//! ```text
//! ; what follows a semicolon is a comment
//! function clamp(v0: i32) -> i32
//!   slot0: 16 bytes, align 8
//!   v3: f64
//! block0:
//!   v1 = lt.i32 v0, 0
//!   v2 = call.i32 limit(v0, &table + 4, 1.5)
//!   store.f64 v3, [slot0 + 8]
//!   branch v1, block1, block2
//! ```
//!
//! An operator is followed by the class of its operands, a load or store by the width of the access, a call by the
//! class of its result, needed or not. Constants are `1` (`i32`), `1L` (`i64`), `1.0f` (`f32`), `1.0` (`f64`) and
//! `&symbol + 4`; infinities and NaNs are their bits, `f64(0x7ff0000000000000)`. A symbol with the name of a value or
//! slot has an `@` before it. A value whose class does not follow from an instruction ([`super::classes`]) is declared
//! after the slots.
//!
//! Source positions, and values and blocks that are not used, are not part of the text.

use std::fmt::{self, Write};

use super::classes::Classes;
use super::function::{Function, Signatures};
use super::inst::{
    Address, Base, Callee, Class, Constant, InstKind, Operand, SignatureId, Terminator, ValueId,
};
use crate::typed::SymbolId;

/// The names of symbols in the text.
pub trait SymbolNames {
    /// The name of a symbol.
    fn symbol_name(&self, symbol: SymbolId) -> &str;
}

/// Reports whether a name looks like a value or slot, so that a symbol with this name must be marked in the text.
pub(super) fn is_taken(name: &str) -> bool {
    ["v", "slot"].iter().any(|prefix| {
        let number = name.strip_prefix(prefix);
        number.is_some_and(|digits| !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit()))
    })
}

impl SymbolNames for cranelift_entity::PrimaryMap<SymbolId, crate::typed::Symbol> {
    fn symbol_name(&self, symbol: SymbolId) -> &str {
        self.get(symbol).map_or("?", |symbol| &symbol.name)
    }
}

/// Prints a function.
#[must_use]
pub fn print(function: &Function, signatures: &Signatures, names: &dyn SymbolNames) -> String {
    let mut printer = FunctionPrinter { function, signatures, names, out: String::new() };
    // Writing to a string cannot fail.
    let _ = printer.function();
    printer.out
}

struct FunctionPrinter<'a> {
    function: &'a Function,
    signatures: &'a Signatures,
    names: &'a dyn SymbolNames,
    out: String,
}

impl FunctionPrinter<'_> {
    fn function(&mut self) -> fmt::Result {
        let function = self.function;
        write!(self.out, "function ")?;
        self.symbol(function.symbol)?;
        write!(self.out, "(")?;
        for (index, param) in function.params.iter().enumerate() {
            let separator = if index == 0 { "" } else { ", " };
            write!(self.out, "{separator}{param}: {}", function.values[*param])?;
        }
        write!(self.out, ")")?;
        if let Some(class) = self.signatures.get(function.signature).result {
            write!(self.out, " -> {class}")?;
        }
        writeln!(self.out)?;
        for (id, slot) in &function.slots {
            writeln!(self.out, "  {id}: {} bytes, align {}", slot.size, slot.align)?;
        }
        for value in undeclared(function) {
            writeln!(self.out, "  {value}: {}", function.values[value])?;
        }
        for id in &function.layout {
            let block = &function.blocks[*id];
            writeln!(self.out, "{id}:")?;
            for inst in &block.insts {
                write!(self.out, "  ")?;
                self.inst(&inst.kind)?;
                writeln!(self.out)?;
            }
            self.terminator(&block.terminator)?;
        }
        Ok(())
    }

    fn inst(&mut self, kind: &InstKind) -> fmt::Result {
        if let Some(dst) = kind.dst() {
            write!(self.out, "{dst} = ")?;
        }
        match *kind {
            InstKind::Copy { src, .. } => self.operand(src),
            InstKind::Unary { op, src, .. } => self.operator(op.name(), &[src]),
            InstKind::Binary { op, a, b, .. } => self.operator(op.name(), &[a, b]),
            InstKind::Compare { op, a, b, .. } => self.operator(op.name(), &[a, b]),
            InstKind::Convert { op, src, .. } => {
                write!(self.out, "{} ", op.name())?;
                self.operand(src)
            }
            InstKind::Load { width, address, .. } => {
                write!(self.out, "load.{width} ")?;
                self.address(address)
            }
            InstKind::Store { src, width, address } => {
                write!(self.out, "store.{width} ")?;
                self.operand(src)?;
                write!(self.out, ", ")?;
                self.address(address)
            }
            InstKind::FrameAddress { slot, offset, .. } => {
                write!(self.out, "address ")?;
                self.address(Address { base: Base::Slot(slot), offset })
            }
            InstKind::CopyMemory { to, from, len } => {
                write!(self.out, "copy_memory ")?;
                self.address(to)?;
                write!(self.out, ", ")?;
                self.address(from)?;
                write!(self.out, ", {len}")
            }
            InstKind::ClearMemory { to, len } => {
                write!(self.out, "clear_memory ")?;
                self.address(to)?;
                write!(self.out, ", {len}")
            }
            InstKind::Cost { cycles } => write!(self.out, "cost {cycles}"),
            InstKind::Call { callee, arguments, signature, .. } => {
                self.call(callee, signature, &self.function.arguments[arguments.range()])
            }
        }
    }

    /// An operator with the class of its operands.
    fn operator(&mut self, name: &str, operands: &[Operand]) -> fmt::Result {
        let class = operands.first().map(|operand| self.function.class(*operand));
        write!(self.out, "{name}.{} ", class.unwrap_or(Class::I32))?;
        self.operands(operands)
    }

    fn operands(&mut self, operands: &[Operand]) -> fmt::Result {
        for (index, operand) in operands.iter().enumerate() {
            if index > 0 {
                write!(self.out, ", ")?;
            }
            self.operand(*operand)?;
        }
        Ok(())
    }

    fn operand(&mut self, operand: Operand) -> fmt::Result {
        match operand {
            Operand::Value(value) => write!(self.out, "{value}"),
            Operand::Constant(Constant::I32(value)) => write!(self.out, "{value}"),
            Operand::Constant(Constant::I64(value)) => write!(self.out, "{value}L"),
            Operand::Constant(Constant::F32(bits)) => match f32::from_bits(bits) {
                value if value.is_finite() => write!(self.out, "{value:?}f"),
                _ => write!(self.out, "f32({bits:#010x})"),
            },
            Operand::Constant(Constant::F64(bits)) => match f64::from_bits(bits) {
                value if value.is_finite() => write!(self.out, "{value:?}"),
                _ => write!(self.out, "f64({bits:#018x})"),
            },
            Operand::Constant(Constant::Symbol(symbol, offset)) => {
                write!(self.out, "&")?;
                self.symbol(symbol)?;
                self.offset(offset)
            }
        }
    }

    fn symbol(&mut self, symbol: SymbolId) -> fmt::Result {
        let name = self.names.symbol_name(symbol);
        write!(self.out, "{}{name}", if is_taken(name) { "@" } else { "" })
    }

    fn call(&mut self, callee: Callee, signature: SignatureId, arguments: &[Operand]) -> fmt::Result {
        match self.signatures.get(signature).result {
            Some(class) => write!(self.out, "call.{class} ")?,
            None => write!(self.out, "call ")?,
        }
        match callee {
            Callee::Symbol(symbol) => self.symbol(symbol)?,
            Callee::Pointer(target) => {
                write!(self.out, "[")?;
                self.operand(target)?;
                write!(self.out, "]")?;
            }
        }
        write!(self.out, "(")?;
        self.operands(arguments)?;
        write!(self.out, ")")
    }

    fn address(&mut self, address: Address) -> fmt::Result {
        match address.base {
            Base::Absolute => return write!(self.out, "[{:#010x}]", address.offset),
            Base::Value(value) => write!(self.out, "[{value}")?,
            Base::Slot(slot) => write!(self.out, "[{slot}")?,
            Base::Symbol(symbol) => {
                write!(self.out, "[")?;
                self.symbol(symbol)?;
            }
        }
        self.offset(address.offset)?;
        write!(self.out, "]")
    }

    fn offset(&mut self, offset: i32) -> fmt::Result {
        match offset {
            0 => Ok(()),
            1.. => write!(self.out, " + {offset}"),
            _ => write!(self.out, " - {}", offset.unsigned_abs()),
        }
    }

    fn terminator(&mut self, terminator: &Terminator) -> fmt::Result {
        match terminator {
            Terminator::Jump(to) => write!(self.out, "  jump {to}")?,
            Terminator::Branch { condition, then, otherwise } => {
                write!(self.out, "  branch ")?;
                self.operand(*condition)?;
                write!(self.out, ", {then}, {otherwise}")?;
            }
            Terminator::Table { index, targets, default } => {
                write!(self.out, "  table ")?;
                self.operand(*index)?;
                write!(self.out, ", [")?;
                for (at, target) in targets.iter().enumerate() {
                    write!(self.out, "{}{target}", if at == 0 { "" } else { ", " })?;
                }
                write!(self.out, "], {default}")?;
            }
            Terminator::Return(value) => {
                write!(self.out, "  return")?;
                if let Some(value) = value {
                    write!(self.out, " ")?;
                    self.operand(*value)?;
                }
            }
            Terminator::Unreachable => write!(self.out, "  unreachable")?,
        }
        writeln!(self.out)
    }
}

/// The values that are read and whose class does not follow from an instruction, in ascending order.
fn undeclared(function: &Function) -> Vec<ValueId> {
    let mut classes = Classes::default();
    let mut read = Vec::new();
    for param in &function.params {
        let _ = classes.record(*param, function.values[*param]);
    }
    for id in &function.layout {
        let block = &function.blocks[*id];
        for inst in &block.insts {
            let mut kind = inst.kind;
            kind.visit_operands(|operand| read.extend(operand.as_value()));
            if let Some(arguments) = kind.arguments() {
                let arguments = &function.arguments[arguments.range()];
                read.extend(arguments.iter().filter_map(|argument| argument.as_value()));
            }
            match (kind, kind.dst()) {
                (InstKind::Copy { dst, src: Operand::Value(src) }, _) => classes.copy(dst, src),
                (_, Some(dst)) => {
                    let _ = classes.record(dst, function.values[dst]);
                }
                (_, None) => {}
            }
        }
        read.extend(block.terminator.operand().and_then(Operand::as_value));
    }
    classes.propagate();
    read.sort_unstable();
    read.dedup();
    read.retain(|value| classes.get(*value).is_none());
    read
}
