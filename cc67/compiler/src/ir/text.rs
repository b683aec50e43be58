//! The text form of a function, for `--emit ir` and for tests.
//!
//! ```text
//! function clamp(v0: i32) -> i32
//!   slot0: 16 bytes, align 8
//! block0:
//!   v1 = lt.i32 v0, 0
//!   branch v1, block1, block2
//! ```

use std::fmt::{self, Write};

use super::function::{Function, Signatures};
use super::inst::{Address, Base, Callee, Class, Constant, InstKind, Operand, Terminator};
use crate::typed::SymbolId;

/// How symbols are called in the text.
pub trait SymbolNames {
    /// The name of a symbol.
    fn symbol_name(&self, symbol: SymbolId) -> &str;
}

impl SymbolNames for cranelift_entity::PrimaryMap<SymbolId, crate::typed::Symbol> {
    fn symbol_name(&self, symbol: SymbolId) -> &str {
        self.get(symbol).map_or("?", |symbol| &symbol.name)
    }
}

/// Prints a function.
#[must_use]
pub fn print(function: &Function, signatures: &Signatures, names: &dyn SymbolNames) -> String {
    let mut printer = Printer { function, signatures, names, out: String::new() };
    // Writing to a string cannot fail.
    let _ = printer.function();
    printer.out
}

struct Printer<'a> {
    function: &'a Function,
    signatures: &'a Signatures,
    names: &'a dyn SymbolNames,
    out: String,
}

impl Printer<'_> {
    fn function(&mut self) -> fmt::Result {
        let function = self.function;
        write!(self.out, "function {}(", self.names.symbol_name(function.symbol))?;
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
            InstKind::Call { callee, arguments, .. } => {
                self.call(callee, &self.function.arguments[arguments.range()])
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
            Operand::Constant(Constant::F32(bits)) => write!(self.out, "{:?}f", f32::from_bits(bits)),
            Operand::Constant(Constant::F64(bits)) => write!(self.out, "{:?}", f64::from_bits(bits)),
            Operand::Constant(Constant::Symbol(symbol, offset)) => {
                write!(self.out, "&{}", self.names.symbol_name(symbol))?;
                self.offset(offset)
            }
        }
    }

    fn call(&mut self, callee: Callee, arguments: &[Operand]) -> fmt::Result {
        match callee {
            Callee::Symbol(symbol) => write!(self.out, "call {}(", self.names.symbol_name(symbol))?,
            Callee::Pointer(target) => {
                write!(self.out, "call [")?;
                self.operand(target)?;
                write!(self.out, "](")?;
            }
        }
        self.operands(arguments)?;
        write!(self.out, ")")
    }

    fn address(&mut self, address: Address) -> fmt::Result {
        match address.base {
            Base::Absolute => return write!(self.out, "[{:#010x}]", address.offset),
            Base::Value(value) => write!(self.out, "[{value}")?,
            Base::Slot(slot) => write!(self.out, "[{slot}")?,
            Base::Symbol(symbol) => write!(self.out, "[{}", self.names.symbol_name(symbol))?,
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
                for (at, target) in targets.iter().enumerate() {
                    write!(self.out, "{}{target}", if at == 0 { ", [" } else { ", " })?;
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
