//! The words before a text's functions: the version, the constants, the signatures.
//!
//! Linked programs and objects have the same head.

use vm::op::{Op, VERSION, WORD};
use vm::operand::{self, Classes, Count, Count32};

use super::registers::register_class;
use crate::ir::function::Signature;
use crate::ir::inst::Class;

/// Classes in a `types` word.
pub(super) const CLASSES: usize = 16;

/// Number of words for the given constants and signatures.
pub(crate) fn word_count(pool: &[u64], signatures: &[Signature]) -> u32 {
    let signatures = signatures.iter().map(|signature| 1 + signature.params.len().div_ceil(CLASSES));
    (1 + pool.len() + signatures.sum::<usize>()) as u32
}

/// Appends them to `text`.
pub(crate) fn write(pool: &[u64], signatures: &[Signature], text: &mut Vec<u8>) {
    let count = Count32(pool.len() as u32);
    text.extend_from_slice(&Op::Program { version: Count(VERSION), pool: count }.encode());
    for value in pool {
        text.extend_from_slice(&value.to_le_bytes());
    }
    for signature in signatures {
        let ret = Count(signature.result.map_or(0, |class| class as u16 + 1));
        let params = Count(signature.params.len() as u16);
        text.extend_from_slice(&Op::Sig { params, ret }.encode());
        for classes in signature.params.chunks(CLASSES) {
            let classes: Vec<_> = classes.iter().map(|class| register_class(*class)).collect();
            text.extend_from_slice(&Op::Types { classes: Classes(bits(&classes)) }.encode());
        }
    }
}

/// At most sixteen classes, two bits each, the first in the lowest.
pub(super) fn bits(classes: &[operand::Class]) -> u32 {
    classes.iter().rev().fold(0, |bits, class| bits << 2 | *class as u32)
}

/// Reads them: constants, signatures, and how many words they take. `None` if they are not
/// of this version or not complete.
pub(crate) fn read(words: &[[u8; WORD]]) -> Option<(Vec<u64>, Vec<Signature>, usize)> {
    let Op::Program { version: Count(VERSION), pool } = Op::decode(*words.first()?)? else { return None };
    let mut at = usize::try_from(pool.0).ok()?.checked_add(1)?;
    let pool = words.get(1..at)?.iter().map(|word| u64::from_le_bytes(*word)).collect();
    let mut signatures = Vec::new();
    while let Some(Op::Sig { params, ret }) = words.get(at).and_then(|word| Op::decode(*word)) {
        at += 1;
        let count = usize::from(params.0);
        let mut params = Vec::with_capacity(count);
        for index in 0..count {
            let types = at + index / CLASSES;
            let Op::Types { classes } = Op::decode(*words.get(types)?)? else { return None };
            params.push(class((classes.0 >> (2 * (index % CLASSES))) as u8));
        }
        at += count.div_ceil(CLASSES);
        let result = match ret.0 {
            0 => None,
            code @ 1..=4 => Some(class(code as u8 - 1)),
            _ => return None,
        };
        signatures.push(Signature { params, result });
    }
    Some((pool, signatures, at))
}

/// The class with the given two-bit code.
const fn class(code: u8) -> Class {
    match operand::Class::from_code(code) {
        operand::Class::I32 => Class::I32,
        operand::Class::I64 => Class::I64,
        operand::Class::F32 => Class::F32,
        operand::Class::F64 => Class::F64,
    }
}
