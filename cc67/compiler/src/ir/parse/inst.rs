//! Instructions, terminators and their operands.

use super::super::inst::{
    Address, ArgumentRange, Base, BlockId, Callee, Class, Constant, InstKind, Operand, SignatureId,
    Terminator, ValueId,
};
use super::super::operators::{BinaryOp, CompareOp, ConvertOp, UnaryOp, Width};
use super::Symbols;
use super::body::{Body, LineResult};
use super::cursor::{Cursor, number};

/// The content of a line of a block.
pub(super) enum Content {
    Inst(InstKind),
    /// A call; its signature is determined once the classes of its arguments are known.
    Call(InstKind, Option<Class>),
    Terminator(Terminator),
}

/// Reads a line of a block.
pub(super) fn read_line(
    line: &mut Cursor<'_>,
    body: &mut Body,
    symbols: &mut Symbols,
) -> LineResult<Content> {
    let mut reader = InstReader { line, body, symbols };
    let mut ahead = *reader.line;
    let first = ahead.word()?;
    if let Some(dst) = number(first, "v")?
        && ahead.eat("=")
    {
        *reader.line = ahead;
        reader.body.record_mention(dst);
        return reader.assignment(dst);
    }
    *reader.line = ahead;
    reader.statement(first)
}

struct InstReader<'r, 'l> {
    line: &'r mut Cursor<'l>,
    body: &'r mut Body,
    symbols: &'r mut Symbols,
}

impl InstReader<'_, '_> {
    /// Parses an assignment after `dst =`.
    fn assignment(&mut self, dst: ValueId) -> LineResult<Content> {
        let mut ahead = *self.line;
        let word = ahead.word()?;
        let (name, suffix) = word.split_once('.').unwrap_or((word, ""));
        let start = std::mem::replace(self.line, ahead);
        let kind = if let Some(op) = UnaryOp::from_name(name) {
            self.body.record_class(dst, class(suffix)?)?;
            InstKind::Unary { op, dst, src: self.operand()? }
        } else if let Some(op) = BinaryOp::from_name(name) {
            self.body.record_class(dst, class(suffix)?)?;
            let (a, b) = self.pair()?;
            InstKind::Binary { op, dst, a, b }
        } else if let Some(op) = CompareOp::from_name(name) {
            let operands = class(suffix)?;
            self.body.record_class(dst, Class::I32)?;
            let (a, b) = self.pair()?;
            self.body.check_class(a, operands);
            InstKind::Compare { op, dst, a, b }
        } else if let Some(op) = ConvertOp::from_name(word) {
            self.body.record_class(dst, op.to())?;
            InstKind::Convert { op, dst, src: self.operand()? }
        } else if name == "load" {
            let width = width(suffix)?;
            self.body.record_class(dst, width.class())?;
            InstKind::Load { dst, width, address: self.address()? }
        } else if word == "address" {
            self.body.record_class(dst, Class::I32)?;
            let Address { base: Base::Slot(slot), offset } = self.address()? else {
                return Err("`address` takes a slot".to_owned());
            };
            InstKind::FrameAddress { dst, slot, offset }
        } else if name == "call" {
            let result = class(suffix)?;
            self.body.record_class(dst, result)?;
            return Ok(Content::Call(self.call(Some(dst))?, Some(result)));
        } else {
            *self.line = start;
            self.copy(dst)?
        };
        Ok(Content::Inst(kind))
    }

    fn copy(&mut self, dst: ValueId) -> LineResult<InstKind> {
        let src = self.operand()?;
        match src {
            Operand::Value(src) => self.body.classes.copy(dst, src),
            Operand::Constant(constant) => self.body.record_class(dst, constant.class())?,
        }
        Ok(InstKind::Copy { dst, src })
    }

    /// A line that writes no value; its first word has been read.
    fn statement(&mut self, word: &str) -> LineResult<Content> {
        let (name, suffix) = word.split_once('.').unwrap_or((word, ""));
        Ok(match name {
            "store" => {
                let width = width(suffix)?;
                let src = self.operand()?;
                self.line.expect(",")?;
                Content::Inst(InstKind::Store { src, width, address: self.address()? })
            }
            "copy_memory" => {
                let to = self.address()?;
                self.line.expect(",")?;
                let from = self.address()?;
                self.line.expect(",")?;
                Content::Inst(InstKind::CopyMemory { to, from, len: self.line.count()? })
            }
            "clear_memory" => {
                let to = self.address()?;
                self.line.expect(",")?;
                Content::Inst(InstKind::ClearMemory { to, len: self.line.count()? })
            }
            "cost" => Content::Inst(InstKind::Cost { cycles: self.line.count()? }),
            "call" => {
                let result = if suffix.is_empty() { None } else { Some(class(suffix)?) };
                Content::Call(self.call(None)?, result)
            }
            "jump" => Content::Terminator(Terminator::Jump(self.block()?)),
            "branch" => Content::Terminator(self.branch()?),
            "table" => Content::Terminator(self.table()?),
            "return" if self.line.expect_end().is_ok() => Content::Terminator(Terminator::Return(None)),
            "return" => Content::Terminator(Terminator::Return(Some(self.operand()?))),
            "unreachable" => Content::Terminator(Terminator::Unreachable),
            _ => return Err(format!("there is no instruction `{word}`")),
        })
    }

    fn branch(&mut self) -> LineResult<Terminator> {
        let condition = self.operand()?;
        self.line.expect(",")?;
        let then = self.block()?;
        self.line.expect(",")?;
        Ok(Terminator::Branch { condition, then, otherwise: self.block()? })
    }

    fn table(&mut self) -> LineResult<Terminator> {
        let index = self.operand()?;
        self.line.expect(",")?;
        self.line.expect("[")?;
        let mut targets = Vec::new();
        while !self.line.eat("]") {
            if !targets.is_empty() {
                self.line.expect(",")?;
            }
            targets.push(self.block()?);
        }
        self.line.expect(",")?;
        Ok(Terminator::Table { index, targets: targets.into(), default: self.block()? })
    }

    fn block(&mut self) -> LineResult<BlockId> {
        let block = self.line.entity("block")?;
        self.body.target(block);
        Ok(block)
    }

    /// A call; the signature is put in later.
    fn call(&mut self, dst: Option<ValueId>) -> LineResult<InstKind> {
        let callee = if self.line.eat("[") {
            let target = self.operand()?;
            self.line.expect("]")?;
            Callee::Pointer(target)
        } else {
            let name = self.line.word()?;
            Callee::Symbol(self.symbol(name))
        };
        self.line.expect("(")?;
        let mut arguments = Vec::new();
        while !self.line.eat(")") {
            if !arguments.is_empty() {
                self.line.expect(",")?;
            }
            arguments.push(self.operand()?);
        }
        let list = &mut self.body.function.arguments;
        let arguments = {
            let start = list.len() as u32;
            list.extend_from_slice(&arguments);
            ArgumentRange { start, count: arguments.len() as u32 }
        };
        Ok(InstKind::Call { callee, arguments, signature: SignatureId::from_u32(0), dst: dst.into() })
    }

    fn pair(&mut self) -> LineResult<(Operand, Operand)> {
        let a = self.operand()?;
        self.line.expect(",")?;
        Ok((a, self.operand()?))
    }

    fn operand(&mut self) -> LineResult<Operand> {
        let word = self.line.word()?;
        if let Some(value) = number(word, "v")? {
            self.body.record_mention(value);
            return Ok(Operand::Value(value));
        }
        if let Some(name) = word.strip_prefix('&') {
            let symbol = self.symbol(name);
            return Ok(Constant::Symbol(symbol, self.line.offset()?).into());
        }
        if matches!(word, "f32" | "f64") {
            return self.bits(word);
        }
        constant(word).map(Operand::from).ok_or_else(|| format!("`{word}` is not an operand"))
    }

    /// The bits of a floating constant.
    fn bits(&mut self, class: &str) -> LineResult<Operand> {
        self.line.expect("(")?;
        let word = self.line.word()?;
        self.line.expect(")")?;
        let bits = word.strip_prefix("0x").and_then(|digits| u64::from_str_radix(digits, 16).ok());
        let constant = match (class, bits) {
            ("f32", Some(bits)) => u32::try_from(bits).ok().map(Constant::F32),
            (_, bits) => bits.map(Constant::F64),
        };
        constant.map(Operand::from).ok_or_else(|| format!("`{word}` is not the bits of an {class}"))
    }

    fn address(&mut self) -> LineResult<Address> {
        self.line.expect("[")?;
        let word = self.line.word()?;
        let base = if let Some(digits) = word.strip_prefix("0x") {
            let address =
                u32::from_str_radix(digits, 16).map_err(|_| format!("`{word}` is not an address"))?;
            self.line.expect("]")?;
            return Ok(Address { base: Base::Absolute, offset: address.cast_signed() });
        } else if let Some(value) = number(word, "v")? {
            self.body.record_mention(value);
            Base::Value(value)
        } else if let Some(slot) = number(word, "slot")? {
            Base::Slot(slot)
        } else {
            Base::Symbol(self.symbol(word))
        };
        let offset = self.line.offset()?;
        self.line.expect("]")?;
        Ok(Address { base, offset })
    }

    fn symbol(&mut self, name: &str) -> crate::typed::SymbolId {
        self.symbols.intern(name.strip_prefix('@').unwrap_or(name))
    }
}

fn class(name: &str) -> LineResult<Class> {
    Class::from_name(name).ok_or_else(|| format!("a class is expected after the `.`, not `{name}`"))
}

fn width(name: &str) -> LineResult<Width> {
    Width::from_name(name).ok_or_else(|| format!("a width is expected after the `.`, not `{name}`"))
}

/// Reads a number; its spelling determines its class.
fn constant(word: &str) -> Option<Constant> {
    if !word.starts_with(|c: char| c.is_ascii_digit() || c == '-') {
        return None;
    }
    if let Some(digits) = word.strip_suffix('L') {
        return digits.parse().ok().map(Constant::I64);
    }
    if let Some(digits) = word.strip_suffix('f') {
        return digits.parse::<f32>().ok().map(|value| Constant::F32(value.to_bits()));
    }
    if word.contains(['.', 'e']) {
        return word.parse::<f64>().ok().map(|value| Constant::F64(value.to_bits()));
    }
    word.parse().ok().map(Constant::I32)
}
