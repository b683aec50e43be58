//! Bytecode as text: disassembler and assembler, both expanded from the instruction table.
//!
//! One word a line, `@12: add_i32 r0, r1, r2`. The number in front is the word's index, to which labels refer. A word
//! that is not an instruction, or a constant of the pool, is printed as `word 0x…`. A `;` begins a comment. Printed
//! text can be parsed again, byte for byte; hand-written text may omit the index or use a name instead: `@loop:`, then
//! `br @loop` and `call fn@main`.

use std::collections::BTreeMap;
use std::fmt::{self, Write as _};

use crate::for_each_op;
use crate::guard;
use crate::op::{Op, WORD};
use crate::operand::{
    Addr, Bits32, Classes, Count, Count32, FuncRef, Imm, Imm16, Label, Off, OperandType, Pool, RegF32,
    RegF64, RegI32, RegI64, SigRef,
};

/// An error in a line of assembly.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {kind}")]
pub struct AssembleError {
    /// Number of the line, from 1.
    pub line: usize,
    /// The kind of error.
    pub kind: AssembleErrorKind,
}

/// A kind of error in a line of assembly.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AssembleErrorKind {
    /// No instruction has this name.
    #[error("there is no instruction `{0}`")]
    UnknownName(String),
    /// The operands do not match the instruction.
    #[error("the operands of `{0}` are not `{1}`")]
    Operands(String, String),
    /// A label is used and not defined.
    #[error("there is no label `{0}`")]
    UnknownLabel(String),
    /// A label is defined twice, or a number in front of a word is not its index.
    #[error("the label `{0}` is not allowed here")]
    BadLabel(String),
}

macro_rules! define_text {
    ($($(#[$doc:meta])* $name:ident = $variant:ident { $($field:ident: $operand:ident),* }, cost $cost:expr, $kind:ident $(($fact:ident))?;)*) => {
        impl fmt::Display for Op {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.name())?;
                match *self {
                    $(Self::$variant { $($field),* } => {
                        let _separator = " ";
                        $(let _separator = print_operand(f, _separator, $field)?;)*
                    })*
                }
                Ok(())
            }
        }

        /// The instruction `name` with `operands`.
        fn parse_op(name: &str, operands: &[String]) -> Result<Op, AssembleErrorKind> {
            match name {
                $(stringify!($name) => {
                    let op = Some(operands.iter()).and_then(|mut rest| {
                        let op = Op::$variant { $($field: $operand::parse(rest.next()?)?),* };
                        rest.next().is_none().then_some(op)
                    });
                    let expected: &[&str] = &[$(concat!(stringify!($field), ": ", stringify!($operand))),*];
                    op.ok_or_else(|| AssembleErrorKind::Operands(name.to_owned(), expected.join(", ")))
                })*
                _ => Err(AssembleErrorKind::UnknownName(name.to_owned())),
            }
        }
    };
}
for_each_op!(define_text);

/// Prints an operand after `separator` and yields the separator of the next.
fn print_operand<O: OperandType>(
    f: &mut fmt::Formatter<'_>,
    separator: &str,
    operand: O,
) -> Result<&'static str, fmt::Error> {
    write!(f, "{separator}{operand}")?;
    Ok(", ")
}

/// The text of `bytes`, which need not be a valid program; bytes after the last whole word are left away, and so are
/// the words before the bytecode of an image.
#[must_use]
pub fn disassemble(bytes: &[u8]) -> String {
    let words = guard::strip(bytes).as_chunks::<WORD>().0;
    let pool = match words.first().and_then(|word| Op::decode(*word)) {
        Some(Op::Program { pool, .. }) => pool.0 as usize,
        _ => 0,
    };
    let mut text = String::new();
    for (index, word) in words.iter().enumerate() {
        let op = if (1..=pool).contains(&index) { None } else { Op::decode(*word) };
        let bits = u64::from_le_bytes(*word);
        // Writing to a string cannot fail.
        let _ = match op {
            Some(op @ Op::Func { .. }) => writeln!(text, "\n@{index}: {op}"),
            Some(op) => writeln!(text, "@{index}: {op}"),
            None => writeln!(text, "@{index}: word {bits:#018x} ; {}", f64::from_bits(bits)),
        };
    }
    text
}

/// The bytes of `text`.
///
/// # Errors
/// The first line that is wrong.
pub fn assemble(text: &str) -> Result<Vec<u8>, AssembleError> {
    let lines: Vec<_> = text.lines().zip(1..).map(|(line, number)| TextLine::read(number, line)).collect();
    let labels = define_labels(&lines)?;
    let mut bytes = Vec::with_capacity(lines.len() * WORD);
    for line in &lines {
        if let Some(instruction) = line.instruction {
            let word = assemble_word(instruction, &labels)
                .map_err(|kind| AssembleError { line: line.number, kind })?;
            bytes.extend(word);
        }
    }
    Ok(bytes)
}

/// The parts of a line.
struct TextLine<'a> {
    number: usize,
    label: Option<&'a str>,
    instruction: Option<&'a str>,
}

impl<'a> TextLine<'a> {
    fn read(number: usize, line: &'a str) -> Self {
        let line = line.split(';').next().unwrap_or_default().trim();
        let labelled = line.strip_prefix('@').and_then(|line| line.split_once(':'));
        let (label, rest) = labelled.map_or((None, line), |(label, rest)| (Some(label), rest.trim()));
        Self { number, label, instruction: Some(rest).filter(|rest| !rest.is_empty()) }
    }
}

/// The index of the word after each named label.
fn define_labels<'a>(lines: &[TextLine<'a>]) -> Result<BTreeMap<&'a str, usize>, AssembleError> {
    let mut labels = BTreeMap::new();
    let mut word = 0;
    for line in lines {
        if let Some(label) = line.label {
            let fits = match label.parse::<usize>() {
                Ok(index) => index == word,
                Err(_) => labels.insert(label, word).is_none(),
            };
            if !fits {
                let kind = AssembleErrorKind::BadLabel(label.to_owned());
                return Err(AssembleError { line: line.number, kind });
            }
        }
        word += usize::from(line.instruction.is_some());
    }
    Ok(labels)
}

fn assemble_word(instruction: &str, labels: &BTreeMap<&str, usize>) -> Result<[u8; WORD], AssembleErrorKind> {
    let (name, operands) = instruction.split_once(char::is_whitespace).unwrap_or((instruction, ""));
    let operands = operands.split(',').map(str::trim).filter(|operand| !operand.is_empty());
    let operands: Vec<String> = operands.map(|operand| resolve(operand, labels)).collect::<Result<_, _>>()?;
    if name == "word" {
        let digits = operands.first().and_then(|operand| operand.strip_prefix("0x"));
        let bits = digits.and_then(|digits| u64::from_str_radix(digits, 16).ok());
        let wrong = || AssembleErrorKind::Operands(name.to_owned(), "0x…".to_owned());
        return bits.filter(|_| operands.len() == 1).map(u64::to_le_bytes).ok_or_else(wrong);
    }
    parse_op(name, &operands).map(|op| op.encode())
}

/// An operand with the name of a label replaced by its index.
fn resolve(operand: &str, labels: &BTreeMap<&str, usize>) -> Result<String, AssembleErrorKind> {
    let Some((prefix, label)) = operand.split_once('@') else {
        return Ok(operand.to_owned());
    };
    if label.parse::<u32>().is_ok() {
        return Ok(operand.to_owned());
    }
    let index = labels.get(label).ok_or_else(|| AssembleErrorKind::UnknownLabel(label.to_owned()))?;
    Ok(format!("{prefix}@{index}"))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::op::OPCODES;

    #[test]
    fn labels_may_have_names() {
        let named =
            assemble("@loop: br_if r3, @end ; away\n br @loop\n\n@end:\n ret").expect("it is correct");
        assert_eq!(disassemble(&named), "@0: br_if r3, @2\n@1: br @0\n@2: ret\n");
    }

    #[test]
    fn errors_name_line_and_cause() {
        let check = |text: &str, expected: &str| {
            assert_eq!(assemble(text).expect_err("it is wrong").to_string(), expected);
        };
        check("ret\nfly r1", "line 2: there is no instruction `fly`");
        check("br @up", "line 1: there is no label `up`");
        check("@a:\n@a: ret", "line 2: the label `a` is not allowed here");
        check("@7: ret", "line 1: the label `7` is not allowed here");
        check("mov_i32 r1, d2", "line 1: the operands of `mov_i32` are not `dst: RegI32, src: RegI32`");
        check("ret r1", "line 1: the operands of `ret` are not ``");
    }

    #[test]
    fn operands_are_printed_as_their_types_want() {
        let check = |line: &str| {
            let bytes = assemble(line).expect("it is correct");
            assert_eq!(disassemble(&bytes), format!("@0: {line}\n"));
        };
        check("load_f64 d1, r2, -8");
        check("store_i8_at r1, 0x91000002");
        check("const_f32 f1, 0x3f800000");
        check("const_i64 l1, pool[7]");
        check("call_ptr r9, sig2");
        check("call fn@12");
        check("const_i32 r1, -2147483648");
    }

    proptest! {
        #[test]
        fn every_word_is_printed_and_parsed_again(code in 0..OPCODES + 3, operands: [u8; 6]) {
            let mut word = [0; WORD];
            word[..2].copy_from_slice(&code.to_le_bytes());
            word[2..].copy_from_slice(&operands);
            let text = disassemble(&word);
            prop_assert_eq!(assemble(&text), Ok(word.to_vec()));
        }

        #[test]
        fn every_instruction_is_encoded_and_decoded(code in 0..OPCODES, operands: [u8; 6], used in 0..=6_usize) {
            let mut word = [0; WORD];
            word[..2].copy_from_slice(&code.to_le_bytes());
            word[2..2 + used].copy_from_slice(&operands[..used]);
            if let Some(op) = Op::decode(word) {
                prop_assert_eq!(op.encode(), word);
            }
        }
    }
}
