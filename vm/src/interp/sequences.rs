//! Instructions that programs often execute in a row, and where a program has them.
//!
//! One handler executes them all, so that only the last one looks for the handler of what comes next. The
//! words stay as they are: the first gets another opcode, and whoever jumps into the middle finds there
//! what he would find without. After a branch a sequence continues where the branch leads, so it is one only
//! if the next instruction is there on both ways.
//!
//! The list is what was measured to be most frequent in `c-programs` and in `vm/benches`.

use std::ops::Range;

use crate::kind::{Name, OpKind};
use crate::op::{OPCODES, Op};
use crate::operand::{FuncRef, Label};
use crate::program::body_of;

/// Hands rows `name: instruction instruction…;` to the macro `$m`, after those given.
macro_rules! for_each_sequence {
    ($m:ident $($rows:tt)*) => {
        $m! {
            $($rows)*
br_charge: br charge;
            br_if_charge: br_if charge;
            br_unless_charge: br_unless charge;
            eq_i32_br_if: eq_i32 br_if charge;
            eq_i32_br_unless: eq_i32 br_unless charge;
            ne_i32_br_if: ne_i32 br_if charge;
            ne_i32_br_unless: ne_i32 br_unless charge;
            lt_i32_s_br_if: lt_i32_s br_if charge;
            lt_i32_s_br_unless: lt_i32_s br_unless charge;
            le_i32_s_br_if: le_i32_s br_if charge;
            le_i32_s_br_unless: le_i32_s br_unless charge;
            lt_i32_u_br_if: lt_i32_u br_if charge;
            lt_i32_u_br_unless: lt_i32_u br_unless charge;
            eq_f64_br_if: eq_f64 br_if charge;
            eq_f64_br_unless: eq_f64 br_unless charge;
            ne_f64_br_if: ne_f64 br_if charge;
            ne_f64_br_unless: ne_f64 br_unless charge;
            lt_f64_br_if: lt_f64 br_if charge;
            lt_f64_br_unless: lt_f64 br_unless charge;
            le_f64_br_if: le_f64 br_if charge;
            le_f64_br_unless: le_f64 br_unless charge;
            lt_f32_br_if: lt_f32 br_if charge;
            lt_f32_br_unless: lt_f32 br_unless charge;
            le_f32_br_if: le_f32 br_if charge;
            le_f32_br_unless: le_f32 br_unless charge;
            and_i32_imm_br_if: and_i32_imm br_if charge;
            and_i32_imm_br_unless: and_i32_imm br_unless charge;
            count_up_to_signed: add_i32_imm lt_i32_s br_if charge;
            count_up_to_unsigned: add_i32_imm lt_i32_u br_if charge;
            count_until_equal: add_i32_imm ne_i32 br_if charge;
            add_store_i32_at: add_i32_imm store_i32_at;
            add_i32_imm_twice: add_i32_imm add_i32_imm;
            step_up_to_signed: add_i32 lt_i32_s br_if charge;
            add_load_i8_s: add_i32 load_i8_s;
            add_load_i8_u: add_i32 load_i8_u;
            add_load_i32: add_i32 load_i32;
            add_load_f64: add_i32 load_f64;
            add_store_i8: add_i32 store_i8;
            add_store_i32: add_i32 store_i32;
            scale_index_f64: mul_i32_imm add_i32 load_f64;
            scale_index: mul_i32_imm add_i32;
            index_f64: shl_i32_imm add_i32 load_f64;
            index_f32: shl_i32_imm add_i32 load_f32;
            index_i32: shl_i32_imm add_i32 load_i32;
            index: shl_i32_imm add_i32;
            halve: shr_i32_s_imm shr_i32_u_imm add_i32;
            load_i32_at_br_if: load_i32_at br_if charge;
            load_i32_at_br_unless: load_i32_at br_unless charge;
            load_i32_at_lt_br_if: load_i32_at lt_i32_s br_if charge;
            load_i32_at_add: load_i32_at add_i32_imm store_i32_at;
            load_i8_s_br_if: load_i8_s br_if charge;
            load_i8_s_br_unless: load_i8_s br_unless charge;
            load_f32_at_mul_add: load_f32_at mul_f32 add_f32;
            load_f32_at_mul: load_f32_at mul_f32;
            load_f32_at_store: load_f32_at store_f32_at;
            load_f32_at_twice: load_f32_at load_f32_at;
            load_f64_at_mul_add: load_f64_at mul_f64 add_f64;
            load_f64_at_mul: load_f64_at mul_f64;
            load_f64_at_sub: load_f64_at sub_f64;
            load_f64_at_store: load_f64_at store_f64_at;
            load_f64_at_twice: load_f64_at load_f64_at;
            load_f64_mul: load_f64 mul_f64;
            load_f64_add: load_f64 add_f64;
            load_f64_sub: load_f64 sub_f64;
            load_f64_store: load_f64 store_f64;
            load_f64_twice: load_f64 load_f64;
            load_f32_mul: load_f32 mul_f32;
            load_f32_twice: load_f32 load_f32;
            store_f32_at_twice: store_f32_at store_f32_at;
            mul_f64_add: mul_f64 add_f64;
            mul_f64_sub: mul_f64 sub_f64;
            mul_f64_twice: mul_f64 mul_f64;
            add_f64_lt_br_if: add_f64 lt_f64 br_if charge;
            add_f64_mul: add_f64 mul_f64;
            sub_f64_mul: sub_f64 mul_f64;
            mul_f32_add: mul_f32 add_f32;
            mov_i32_twice: mov_i32 mov_i32;
            arg_i32_twice: arg_i32 arg_i32;
            arg_i32_call: arg_i32 call charge;
            arg_f32_call: arg_f32 call charge;
            arg_f64_call: arg_f64 call charge;
            call_charge: call charge;
            result_i32_charge: result_i32 charge;
            result_f32_charge: result_f32 charge;
            result_f64_charge: result_f64 charge;
        }
    };
}
pub(super) use for_each_sequence;

/// The opcode of a word at which a debugger holds a context; it begins no sequence.
pub(super) const BREAK: u16 = 255;

/// A row of the list: opcodes one after another.
pub(super) type Sequence = &'static [u16];

macro_rules! define_list {
    ($($name:ident: $($step:ident)+;)*) => {
        /// The list; a sequence has the opcode of its index, after those of the instructions.
        pub(super) const SEQUENCES: &[Sequence] = &[$(&[$(opcode_of(stringify!($step))),+]),*];
    };
}
for_each_sequence! { define_list }

const _: () =
    assert!(OPCODES as usize + SEQUENCES.len() <= BREAK as usize, "an opcode fits a byte, and one is left");

/// For each opcode, the rows among which are those of the sequences that begin with it.
const GROUPS: [Range<usize>; OPCODES as usize] = {
    let mut groups = [const { 0..0 }; OPCODES as usize];
    let mut row = 0;
    while row < SEQUENCES.len() {
        let group = &mut groups[SEQUENCES[row][0] as usize];
        if group.end == 0 {
            group.start = row;
        }
        group.end = row + 1;
        row += 1;
    }
    groups
};

/// The opcode to execute at the word `pc` of `ops`, whose opcodes are `codes`: that of a sequence, or its own.
pub(super) fn opcode(ops: &[Op], codes: &[u16], pc: usize) -> u16 {
    let Some(group) = GROUPS.get(usize::from(codes[pc])) else { return codes[pc] };
    let found = group.clone().find(|row| stands_at(SEQUENCES[*row], ops, codes, pc));
    found.map_or(codes[pc], |row| OPCODES + row as u16)
}

/// Whether `sequence` is what is executed from the word `pc` on, whatever the program computes.
fn stands_at(sequence: &[u16], ops: &[Op], codes: &[u16], pc: usize) -> bool {
    let Some((first, then)) = sequence.split_first() else { return true };
    let goes_on = |next: usize| stands_at(then, ops, codes, next);
    codes.get(pc) == Some(first)
        && (then.is_empty()
            || match ops[pc].kind() {
                OpKind::Jump => target(ops[pc]).is_some_and(goes_on),
                OpKind::Branch => goes_on(pc + 1) && target(ops[pc]).is_some_and(goes_on),
                OpKind::Call => callee(ops, ops[pc]).is_some_and(goes_on),
                OpKind::Structure
                | OpKind::Charge
                | OpKind::Constant
                | OpKind::Move
                | OpKind::Address
                | OpKind::Arithmetic
                | OpKind::Negation
                | OpKind::Conversion
                | OpKind::Load(_)
                | OpKind::Store(_)
                | OpKind::Block
                | OpKind::Table
                | OpKind::Argument(_)
                | OpKind::Result(_)
                | OpKind::Return(_)
                | OpKind::Stop => goes_on(pc + 1),
            })
}

/// The word that the branch `op` goes to.
fn target(op: Op) -> Option<usize> {
    op.operand(Name::To).map(|Label(to)| to as usize)
}

/// The first executable word of the function of the program that `op` calls.
fn callee(ops: &[Op], op: Op) -> Option<usize> {
    let func: FuncRef = op.operand(Name::Func)?;
    let Op::Func { regs, .. } = ops.get(func.0 as usize)? else { return None };
    Some(body_of(func, regs.0))
}

/// The opcode of the instruction called `name`.
const fn opcode_of(name: &str) -> u16 {
    let mut code = 0;
    while !is_same(Op::NAMES[code].as_bytes(), name.as_bytes()) {
        code += 1;
    }
    code as u16
}

const fn is_same(a: &[u8], b: &[u8]) -> bool {
    let mut index = 0;
    while index < a.len() && index < b.len() && a[index] == b[index] {
        index += 1;
    }
    index == a.len() && index == b.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::op::WORD;
    use crate::operand::{Count, RegI32, SigRef};

    /// The opcode at the first of `ops`.
    fn opcode_of_first(ops: &[Op]) -> u16 {
        let codes: Vec<u16> = ops.iter().map(code_of).collect();
        opcode(ops, &codes, 0)
    }

    fn code_of(op: &Op) -> u16 {
        let word = op.encode();
        u16::from_le_bytes([word[0], word[1]])
    }

    /// The instructions of `sequence`, each of which leads to the next.
    fn ops_of(sequence: &[u16]) -> Vec<Op> {
        let mut ops = Vec::new();
        for code in sequence {
            let mut word = [0; WORD];
            word[..2].copy_from_slice(&code.to_le_bytes());
            let next = ops.len() as u32 + 1;
            match Op::decode(word).expect("it is an opcode") {
                Op::Br { .. } => ops.push(Op::Br { to: Label(next) }),
                Op::BrIf { cond, .. } => ops.push(Op::BrIf { cond, to: Label(next) }),
                Op::BrUnless { cond, .. } => ops.push(Op::BrUnless { cond, to: Label(next) }),
                Op::Call { .. } => {
                    ops.push(Op::Call { func: FuncRef(next) });
                    ops.push(Op::Func { sig: SigRef(0), regs: Count(0), frame: Count(0) });
                }
                op => ops.push(op),
            }
        }
        ops
    }

    #[test]
    fn every_sequence_is_found_where_it_stands() {
        for (row, sequence) in SEQUENCES.iter().enumerate() {
            assert_eq!(opcode_of_first(&ops_of(sequence)), OPCODES + row as u16, "{sequence:?}");
        }
    }

    #[test]
    fn behind_a_branch_the_next_instruction_is_there_on_both_ways() {
        let branch = Op::BrIf { cond: RegI32(0), to: Label(3) };
        let charge = ops_of(&[opcode_of("charge")])[0];
        let mov = ops_of(&[opcode_of("mov_i32")])[0];
        let is_sequence = |ops: &[Op]| opcode_of_first(ops) >= OPCODES;
        assert!(is_sequence(&[branch, charge, mov, charge]));
        assert!(!is_sequence(&[branch, mov, mov, charge]));
        assert!(!is_sequence(&[branch, charge, charge, mov]));
    }
}
