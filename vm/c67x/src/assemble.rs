//! The assembler: converts a line of text to an instruction.
//!
//! It reads the text that [`Inst`] prints, in any case and with any blanks. If the unit is omitted, the first form in
//! the table that takes the operands is chosen.

use thiserror::Error;

use crate::alias::Alias;
use crate::inst::Inst;
use crate::kind::Update;
use crate::mnemonic::Mnemonic;
use crate::operand::{Mem, Offset, Operand};
use crate::register::{Control, Pair, Pred, PredReg, Reg, Side};
use crate::spelling::FETCH_PACKET;
use crate::table::Op;

/// A line of assembler text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AssemblyLine {
    /// The instruction.
    pub inst: Inst,
    /// True if it executes in parallel with the instruction before it: `||`.
    pub joins_previous: bool,
}

/// A line that is not an instruction.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SyntaxError {
    /// The line is empty.
    #[error("no instruction on the line")]
    Empty,
    /// The part in brackets is not a condition.
    #[error("`{0}` is not a condition: A0, A1, A2, B0, B1, B2")]
    Condition(String),
    /// Unknown mnemonic.
    #[error("no instruction is named `{0}`")]
    Mnemonic(String),
    /// An operand that cannot be read.
    #[error("`{0}` is not an operand")]
    Operand(String),
    /// The word in braces is not an instruction, or does not match the text before it.
    #[error("`{{{0}}}` is not the word of this instruction")]
    Word(String),
    /// No form of the mnemonic takes these operands on this unit.
    #[error("no form of `{0}` takes these operands on this unit")]
    Form(String),
}

/// Reads one line; `at` is its address, needed for branches with absolute targets.
///
/// # Errors
/// The line is not an instruction in the table.
pub fn assemble(line: &str, at: u32) -> Result<AssemblyLine, SyntaxError> {
    let (rest, joins_previous) = match line.trim().strip_prefix("||") {
        Some(rest) => (rest.trim_start(), true),
        None => (line.trim(), false),
    };
    if let Some((text, word)) = rest.strip_suffix('}').and_then(|rest| rest.split_once('{')) {
        let inst = word_in_braces(text.trim(), word, at).ok_or_else(|| SyntaxError::Word(word.to_owned()))?;
        return Ok(AssemblyLine { inst, joins_previous });
    }
    let (pred, rest) = condition(rest)?;
    let (name, rest) = split_word(rest);
    if name.is_empty() {
        return Err(SyntaxError::Empty);
    }
    let (unit, rest) = match rest.strip_prefix('.') {
        Some(rest) => split_word(rest),
        None => ("", rest),
    };
    let operands = split_operands(rest)
        .into_iter()
        .map(|text| operand(text, name, at).ok_or_else(|| SyntaxError::Operand(text.to_owned())))
        .collect::<Result<Vec<_>, _>>()?;
    let inst = choose(name, unit, pred, &operands)?;
    Ok(AssemblyLine { inst, joins_previous })
}

/// The instruction of a word in braces, if the text before it matches the word.
fn word_in_braces(text: &str, word: &str, at: u32) -> Option<Inst> {
    let inst = Inst::decode(u32::from_str_radix(word, 16).ok()?).ok()?;
    let is_its_text = inst.plain_text(None) == text || inst.plain_text(Some(at)) == text;
    is_its_text.then_some(inst)
}

/// The first form that takes the operands on this unit.
fn choose(name: &str, unit: &str, pred: Pred, operands: &[Operand]) -> Result<Inst, SyntaxError> {
    let (mnemonic, lists) = match (Mnemonic::from_name(name), Alias::from_name(name)) {
        (Some(Mnemonic::Nop), _) if operands.is_empty() => (Mnemonic::Nop, vec![vec![Operand::Const(1)]]),
        (Some(mnemonic), _) => (mnemonic, vec![operands.to_vec()]),
        (None, Some(alias)) => (alias.mnemonic(), alias.complete(operands)),
        (None, None) => return Err(SyntaxError::Mnemonic(name.to_owned())),
    };
    let named =
        |inst: &Inst| unit.is_empty() || inst.unit_text().trim_start_matches('.').eq_ignore_ascii_case(unit);
    let alias = Mnemonic::from_name(name).is_none();
    lists
        .iter()
        .flat_map(|operands| every_form(mnemonic, pred, operands))
        .filter(|inst| {
            !alias || Alias::of(*inst).is_some_and(|alias| alias.name().eq_ignore_ascii_case(name))
        })
        .find(named)
        .ok_or_else(|| SyntaxError::Form(name.to_owned()))
}

/// Every form of the mnemonic with these operands, the disputed ones last.
fn every_form(mnemonic: Mnemonic, pred: Pred, operands: &[Operand]) -> Vec<Inst> {
    let forms = |disputed: bool| {
        let ops = Op::ALL.iter().copied();
        let ops = ops.filter(move |op| op.row().mnemonic == mnemonic && op.is_disputed() == disputed);
        ops.flat_map(move |op| [Side::A, Side::B].map(|side| Inst::new(op, side, pred, operands)))
    };
    forms(false).chain(forms(true)).filter_map(Result::ok).collect()
}

fn condition(text: &str) -> Result<(Pred, &str), SyntaxError> {
    let Some((inside, rest)) = text.strip_prefix('[').and_then(|text| text.split_once(']')) else {
        return Ok((Pred::Always, text));
    };
    let (name, negated) = match inside.trim().strip_prefix('!') {
        Some(name) => (name, true),
        None => (inside.trim(), false),
    };
    let reg = register(name).and_then(PredReg::from_reg);
    let reg = reg.ok_or_else(|| SyntaxError::Condition(inside.to_owned()))?;
    Ok((if negated { Pred::Unless(reg) } else { Pred::If(reg) }, rest.trim_start()))
}

fn split_word(text: &str) -> (&str, &str) {
    let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    (word, rest.trim_start())
}

fn split_operands(text: &str) -> Vec<&str> {
    text.split(',').map(str::trim).filter(|part| !part.is_empty()).collect()
}

fn operand(text: &str, name: &str, at: u32) -> Option<Operand> {
    if let Some((high, low)) = text.split_once(':') {
        let pair = Pair::new(register(low)?)?;
        return (register(high)? == pair.high()).then_some(Operand::Pair(pair));
    }
    if let Some(address) = text.strip_prefix('*') {
        return memory(address).map(Operand::Mem);
    }
    let named = |name: &str| text.eq_ignore_ascii_case(name);
    let mnemonic = Mnemonic::from_name(name);
    match mnemonic {
        Some(Mnemonic::B) if named("IRP") => return Some(Operand::Irp),
        Some(Mnemonic::B) if named("NRP") => return Some(Operand::Nrp),
        Some(Mnemonic::B) => {
            if let Some(distance) = text.strip_prefix("pc") {
                return distance.parse().ok().map(Operand::Target);
            }
            if let Some(address) = number(text) {
                let from = i64::from(at & !(FETCH_PACKET - 1));
                return i32::try_from(address - from).ok().map(Operand::Target);
            }
        }
        Some(Mnemonic::Mvkh) => {
            if let Some(value) = number(text) {
                let upper = u32::try_from(value & 0xFFFF_FFFF).ok()? >> 16;
                return i32::try_from(upper).ok().map(Operand::Const);
            }
        }
        _ => {}
    }
    if let Some(reg) = register(text) {
        return Some(Operand::Reg(reg));
    }
    let control = Control::ALL.iter().find(|control| named(control.names().0) || named(control.names().1));
    if let Some(control) = control {
        return Some(Operand::Control(*control));
    }
    number(text).and_then(|value| i32::try_from(value).ok()).map(Operand::Const)
}

/// `A0` to `B31`.
fn register(text: &str) -> Option<Reg> {
    let text = text.trim();
    let side = match text.chars().next()? {
        'A' | 'a' => Side::A,
        'B' | 'b' => Side::B,
        _ => return None,
    };
    let digits = text.get(1..)?;
    let plain = digits.bytes().all(|byte| byte.is_ascii_digit());
    let number: u8 = digits.parse().ok().filter(|_| plain)?;
    (number < 32).then(|| Reg::new(side, number))
}

/// A decimal or, with `0x`, a hexadecimal number.
fn number(text: &str) -> Option<i64> {
    let (digits, negative) = match text.strip_prefix('-') {
        Some(digits) => (digits, true),
        None => (text, false),
    };
    let value = match digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X")) {
        Some(hex) => i64::from(u32::from_str_radix(hex, 16).ok()?),
        None => i64::from(digits.parse::<u32>().ok()?),
    };
    Some(if negative { -value } else { value })
}

/// An address without its star.
fn memory(text: &str) -> Option<Mem> {
    let (base, offset) = match text.split_once('[') {
        Some((base, offset)) => (base, offset.strip_suffix(']')?),
        None => (text, ""),
    };
    let marks = base.trim_matches(|letter| letter != '+' && letter != '-');
    let update = match (marks.len(), base.starts_with(['+', '-'])) {
        (2, true) => Update::Before,
        (2, false) => Update::After,
        (0, _) | (1, true) => Update::None,
        _ => return None,
    };
    let negative = match marks {
        "-" | "--" => true,
        "" | "+" | "++" => false,
        _ => return None,
    };
    let base = register(base.trim_matches(['+', '-']))?;
    let offset = match (offset, register(offset)) {
        // Without an offset, a base that changes does so by one element.
        ("", _) => Offset::Const(u16::from(update != Update::None)),
        (_, Some(reg)) => Offset::Reg(reg),
        (constant, None) => Offset::Const(u16::try_from(number(constant)?).ok()?),
    };
    Some(Mem { base, negative, update, offset })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn word(text: &str) -> u32 {
        assemble(text, 0).expect("an instruction").inst.encode(false)
    }

    #[test]
    fn text_without_a_unit_takes_the_first_form() {
        assert_eq!(word("mvk 0, A2"), 0x0100_0028);
        assert_eq!(word("ADD .L1 A2,A3,A2"), 0x010C_4078);
    }

    #[test]
    fn invalid_assembly_is_refused() {
        assert_eq!(assemble("ADD .L1 A2", 0), Err(SyntaxError::Form("ADD".into())));
        assert_eq!(assemble("FROB A2", 0), Err(SyntaxError::Mnemonic("FROB".into())));
        assert_eq!(assemble("ADD A99,A1,A1", 0), Err(SyntaxError::Operand("A99".into())));
        assert_eq!(assemble("[A5] NOP", 0), Err(SyntaxError::Condition("A5".into())));
        assert_eq!(assemble(" ", 0), Err(SyntaxError::Empty));
        assert!(assemble("[A1] NOP 2", 0).is_err(), "NOP has no condition");
    }
}
