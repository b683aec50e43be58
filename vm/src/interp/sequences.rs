//! Sequences of instructions that programs often execute, and their positions in a program.
//!
//! One handler executes a whole sequence, so that only the last instruction dispatches to the next handler. The words
//! are unchanged except for the opcode of the first, so a jump into the middle works as before. A branch can be
//! followed by another instruction of the sequence only if both of its paths lead to that instruction.
//!
//! Parentheses after an instruction name the operand that the previous instruction assigns and, after a comma, the
//! operand that the instruction before it assigns. These values never have to be loaded from memory. Brackets after the
//! first instruction name the operand that was assigned last before the sequence, and its kind; so there are rows of a
//! single instruction, too. The first matching row applies.
//!
//! The rows are the sequences measured to be most frequent in `c-programs` and `vm/benches`.

use std::ops::Range;

use super::parts::{DST, OperandLinks, Parts};
use crate::for_each_op;
use crate::kind::{Name, OpKind};
use crate::op::{OPCODES, Op};
use crate::operand::{FuncRef, Label, OperandType};
use crate::program::body_of;

/// Passes rows `name: instruction instruction(operand)…;` to the macro `$m`, after the rows given.
macro_rules! for_each_sequence {
    ($m:ident $($rows:tt)*) => {
        $m! {
            $($rows)*
            br_count_up: br charge add_i32_imm lt_i32_s br_if(cond) charge;
            br_charge: br charge;
            br_if_charge: br_if charge;
            br_unless_charge: br_unless charge;
            eq_i32_br_if: eq_i32 br_if(cond) charge;
            eq_i32_br_unless: eq_i32 br_unless(cond) charge;
            ne_i32_br_if: ne_i32 br_if(cond) charge;
            ne_i32_br_unless: ne_i32 br_unless(cond) charge;
            lt_i32_s_br_if: lt_i32_s br_if(cond) charge;
            lt_i32_s_br_unless: lt_i32_s br_unless(cond) charge;
            le_i32_s_br_if: le_i32_s br_if(cond) charge;
            le_i32_s_br_unless: le_i32_s br_unless(cond) charge;
            lt_i32_u_br_if: lt_i32_u br_if(cond) charge;
            lt_i32_u_br_unless: lt_i32_u br_unless(cond) charge;
            eq_f64_br_if: eq_f64 br_if(cond) charge;
            eq_f64_br_unless: eq_f64 br_unless(cond) charge;
            ne_f64_br_if: ne_f64 br_if(cond) charge;
            ne_f64_br_unless: ne_f64 br_unless(cond) charge;
            last_a_lt_f64_br_if: lt_f64[a = double] br_if(cond) charge;
            last_b_lt_f64_br_if: lt_f64[b = double] br_if(cond) charge;
            last_a_lt_f64_br_unless: lt_f64[a = double] br_unless(cond) charge;
            last_b_lt_f64_br_unless: lt_f64[b = double] br_unless(cond) charge;
            lt_f64_br_if: lt_f64 br_if(cond) charge;
            lt_f64_br_unless: lt_f64 br_unless(cond) charge;
            le_f64_br_if: le_f64 br_if(cond) charge;
            le_f64_br_unless: le_f64 br_unless(cond) charge;
            last_a_lt_f32_br_unless: lt_f32[a = single] br_unless(cond) charge;
            last_b_lt_f32_br_unless: lt_f32[b = single] br_unless(cond) charge;
            lt_f32_br_if: lt_f32 br_if(cond) charge;
            lt_f32_br_unless: lt_f32 br_unless(cond) charge;
            le_f32_br_if: le_f32 br_if(cond) charge;
            le_f32_br_unless: le_f32 br_unless(cond) charge;
            and_i32_imm_br_if: and_i32_imm br_if(cond) charge;
            and_i32_imm_br_unless: and_i32_imm br_unless(cond) charge;
            add_mov_const_lt_br_unless: add_i32_imm mov_i32(src) const_i32 lt_i32_s br_unless(cond) charge;
            steps_count_up: add_i32_imm add_i32_imm add_i32_imm lt_i32_s br_if(cond) charge;
            step_count_up: add_i32_imm add_i32_imm lt_i32_s br_if(cond) charge;
            count_up_to_signed: add_i32_imm lt_i32_s br_if(cond) charge;
            count_up_to_unsigned: add_i32_imm lt_i32_u br_if(cond) charge;
            count_until_equal: add_i32_imm ne_i32 br_if(cond) charge;
            add_call: add_i32_imm arg_i32(src) call charge;
            add_load_i8_br_if: add_i32_imm load_i8_s br_if(cond) charge;
            add_load_i8_br_unless: add_i32_imm load_i8_s br_unless(cond) charge;
            add_br: add_i32_imm br charge;
            add_store_i32_at: add_i32_imm store_i32_at(src);
            add_i32_imm_twice: add_i32_imm add_i32_imm;
            add_i32_imm_mov: add_i32_imm mov_i32;
            fill_up: add_i32 store_i8(base) add_i32_imm lt_i32_s(a) br_if(cond) charge;
            fill_in_steps: add_i32 store_i8(base) add_i32 lt_i32_s(a) br_if(cond) charge;
            add_load_i8_s_br_unless: add_i32 load_i8_s(base) br_unless(cond) charge;
            step_up_to_signed: add_i32 lt_i32_s br_if(cond) charge;
            add_load_i8_s: add_i32 load_i8_s(base);
            add_load_i8_u: add_i32 load_i8_u(base);
            add_load_i32: add_i32 load_i32(base);
            add_load_f64: add_i32 load_f64(base);
            add_store_i8: add_i32 store_i8(base);
            add_store_i32: add_i32 store_i32(base);
            add_store_f64: add_i32 store_f64(base);
            add_ret: add_i32 ret_i32(src);
            scale_add_br: mul_i32_imm add_i32_imm(a) br charge;
            scale_index_f64: mul_i32_imm add_i32(a) load_f64(base);
            scale_index: mul_i32_imm add_i32(a);
            scale_add: mul_i32_imm add_i32_imm(a);
            index_f64: shl_i32_imm add_i32(a) load_f64(base);
            index_f32: shl_i32_imm add_i32(a) load_f32(base);
            index_i32: shl_i32_imm add_i32(a) load_i32(base);
            index: shl_i32_imm add_i32(a);
            halve: shr_i32_s_imm shr_i32_u_imm(a) add_i32(a);
            shift_charge: shr_i32_u_imm charge;
            const_lt_br_if: const_i32 lt_i32_s(b) br_if(cond) charge;
            const_lt_br_unless: const_i32 lt_i32_s(b) br_unless(cond) charge;
            load_i32_at_lt_br_if: load_i32_at lt_i32_s br_if(cond) charge;
            load_i32_at_add: load_i32_at add_i32_imm(a) store_i32_at(src);
            load_i32_at_br_if: load_i32_at br_if(cond) charge;
            load_i32_at_br_unless: load_i32_at br_unless(cond) charge;
            load_i8_s_twice_eq_br_if: load_i8_s load_i8_s eq_i32(a, b) br_if(cond) charge;
            load_i8_s_twice_eq_br_unless: load_i8_s load_i8_s eq_i32(a, b) br_unless(cond) charge;
            load_i8_s_br_if: load_i8_s br_if(cond) charge;
            load_i8_s_br_unless: load_i8_s br_unless(cond) charge;
            load_i8_s_store: load_i8_s store_i8(src);
            load_f32_at_twice_mul_add: load_f32_at load_f32_at mul_f32(a, b) add_f32(a);
            load_f32_at_mul_add: load_f32_at mul_f32(a) add_f32(a);
            load_f32_at_mul: load_f32_at mul_f32(a);
            load_f32_at_store: load_f32_at store_f32_at(src);
            load_f32_at_twice: load_f32_at load_f32_at;
            load_f64_at_mul_add: load_f64_at mul_f64(a) add_f64(a);
            load_f64_at_mul: load_f64_at mul_f64(a);
            load_f64_at_store: load_f64_at store_f64_at(src);
            load_f64_at_sub: load_f64_at sub_f64;
            load_f64_at_twice: load_f64_at load_f64_at;
            load_f64_twice_mul_add: load_f64 load_f64 mul_f64(a, b) add_f64(a);
            load_f64_mul_load_add: load_f64 mul_f64(a) load_f64 add_f64(a, b);
            load_f64_mul_twice: load_f64 mul_f64(a) mul_f64(a);
            load_f64_mul_add: load_f64 mul_f64(a) add_f64(a);
            load_f64_add_store: load_f64 add_f64(a) store_f64(src);
            load_f64_sub_store: load_f64 sub_f64(a) store_f64(src);
            load_f64_twice_sub: load_f64 load_f64 sub_f64(b, a);
            load_f64_mul: load_f64 mul_f64(a);
            load_f64_add: load_f64 add_f64(a);
            load_f64_sub_a: load_f64 sub_f64(a);
            load_f64_sub_b: load_f64 sub_f64(b);
            load_f64_store: load_f64 store_f64(src);
            load_f64_twice: load_f64 load_f64;
            load_f32_mul: load_f32 mul_f32(a);
            load_f32_twice: load_f32 load_f32;
            last_store_f64: store_f64[src = double];
            last_store_f64_at: store_f64_at[src = double];
            store_f32_at_twice: store_f32_at store_f32_at;
            last_mul_f64_load_add: mul_f64[a = double] load_f64 add_f64(a, b);
            mul_f64_chain_add: mul_f64 mul_f64(a) add_f64(a);
            mul_f64_twice_add: mul_f64 mul_f64 add_f64(a, b);
            mul_f64_load_add: mul_f64 load_f64 add_f64(a, b);
            last_mul_f64_twice: mul_f64[a = double] mul_f64(a);
            last_mul_f64_add: mul_f64[a = double] add_f64(a);
            mul_f64_chain: mul_f64 mul_f64(a);
            mul_f64_add: mul_f64 add_f64(a);
            mul_f64_sub_a: mul_f64 sub_f64(a);
            mul_f64_sub_b: mul_f64 sub_f64(b);
            mul_f64_div: mul_f64 div_f64(b);
            mul_f64_twice: mul_f64 mul_f64;
            last_mul_f64: mul_f64[a = double];
            last_add_f64_lt_br_if: add_f64[a = double] lt_f64(a) br_if(cond) charge;
            last_add_f64_lt_br_unless: add_f64[a = double] lt_f64(b) br_unless(cond) charge;
            add_f64_lt_br_if: add_f64 lt_f64(a) br_if(cond) charge;
            last_add_f64_mul: add_f64[a = double] mul_f64(a);
            add_f64_add: add_f64 add_f64(a);
            add_f64_mul: add_f64 mul_f64(a);
            last_add_f64: add_f64[a = double];
            sub_f64_add: sub_f64 add_f64(a);
            sub_f64_mul: sub_f64 mul_f64(a);
            last_sub_f64_a: sub_f64[a = double];
            last_sub_f64_b: sub_f64[b = double];
            last_div_f64_a: div_f64[a = double];
            last_div_f64_b: div_f64[b = double];
            last_mul_f32_add: mul_f32[a = single] add_f32(a);
            mul_f32_add: mul_f32 add_f32(a);
            mul_f32_sub: mul_f32 sub_f32(b);
            last_add_f32: add_f32[a = single];
            sub_f32_mul: sub_f32 mul_f32(a);
            mov_i32_br: mov_i32 br charge;
            mov_i32_twice: mov_i32 mov_i32;
            mov_i32_add: mov_i32 add_i32_imm;
            arg_i32_call: arg_i32 call charge;
            arg_i32_twice: arg_i32 arg_i32;
            arg_f32_call: arg_f32 call charge;
            arg_f64_call: arg_f64 call charge;
            last_arg_f64: arg_f64[src = double];
            call_charge: call charge;
            result_i32_charge: result_i32 charge;
            result_f32_charge: result_f32 charge;
            result_f64_charge: result_f64 charge;
        }
    };
}
pub(super) use for_each_sequence;

/// The opcode of a word at which a debugger holds a context; it begins no sequence.
pub(super) const BREAK: u16 = u16::MAX;

/// More words than any sequence has.
pub(super) const AHEAD: usize = 8;

/// An instruction of a sequence.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinkedOp {
    /// Its opcode.
    pub(super) code: u16,
    /// The operands that the previous instructions assign.
    pub(super) links: OperandLinks,
}

/// A row of the list: instructions one after another.
pub(super) type Sequence = &'static [LinkedOp];

macro_rules! step {
    ($step:ident $($link:ident $($far:ident)?)?) => {
        LinkedOp {
            code: opcode_of(stringify!($step)),
            links: [
                0 $(+ place_in(stringify!($step), stringify!($link)))?,
                0 $($(+ place_in(stringify!($step), stringify!($far)))?)?,
            ],
        }
    };
}

macro_rules! define_list {
    ($($name:ident: $first:ident $([$recalled:ident = $last:ident])? $($step:ident $(($($link:ident),+))?)*;)*) => {
        /// The list; a sequence has the opcode of its index, after those of the instructions.
        pub(super) const SEQUENCES: &[Sequence] = &[$(&[
            step!($first $($recalled)?),
            $(step!($step $($($link)+)?)),*
        ]),*];
    };
}
for_each_sequence! { define_list }

const _: () = {
    let mut row = 0;
    while row < SEQUENCES.len() {
        assert!(SEQUENCES[row].len() < AHEAD, "after a text there are words for the longest sequence");
        row += 1;
    }
};

macro_rules! define_places {
    ($($(#[$doc:meta])* $name:ident = $variant:ident { $($field:ident: $operand:ident),* }, cost $cost:expr, $kind:ident $(($fact:ident))?;)*) => {
        /// The place of the operand `operand` in the word of the instruction `step`.
        pub(super) const fn place_in(step: &str, operand: &str) -> usize {
            $(
                if is_same(step.as_bytes(), stringify!($name).as_bytes()) {
                    let mut _at = DST;
                    $(
                        if is_same(operand.as_bytes(), stringify!($field).as_bytes()) {
                            return _at;
                        }
                        _at += <crate::operand::$operand as OperandType>::SIZE / 2;
                    )*
                }
            )*
            panic!("no such operand")
        }
    };
}
for_each_op!(define_places);

/// For each opcode, the range of rows with the sequences that begin with it.
const GROUPS: [Range<usize>; OPCODES as usize] = {
    let mut groups = [const { 0..0 }; OPCODES as usize];
    let mut row = 0;
    while row < SEQUENCES.len() {
        let group = &mut groups[SEQUENCES[row][0].code as usize];
        if group.end == 0 {
            group.start = row;
        }
        group.end = row + 1;
        row += 1;
    }
    groups
};

/// The text in which sequences are searched.
pub(super) struct Text<'a> {
    pub(super) ops: &'a [Op],
    /// Their opcodes; [`BREAK`] where contexts are held.
    pub(super) codes: &'a [u16],
    /// Their words.
    pub(super) parts: &'a [Parts],
    /// True for each word that is the target of a branch.
    pub(super) is_target: &'a [bool],
}

impl Text<'_> {
    /// The opcode to execute at the word `pc`: that of a sequence, or that of the word itself.
    pub(super) fn code_at(&self, pc: usize) -> u16 {
        let code = self.codes[pc];
        let Some(group) = GROUPS.get(usize::from(code)) else { return code };
        let found = group.clone().find(|row| self.has(SEQUENCES[*row], pc, [self.before(pc), None]));
        found.map_or(code, |row| OPCODES + row as u16)
    }

    /// The word before `pc`, if it has assigned a register on every path to `pc`.
    fn before(&self, pc: usize) -> Option<usize> {
        let before = pc.checked_sub(1).filter(|_| !self.is_target[pc])?;
        match self.ops[before].kind() {
            OpKind::Constant
            | OpKind::Move
            | OpKind::Address
            | OpKind::Arithmetic
            | OpKind::Negation
            | OpKind::Conversion
            | OpKind::Load(_)
            | OpKind::Result(_) => Some(before),
            OpKind::Structure
            | OpKind::Charge
            | OpKind::Store(_)
            | OpKind::Block
            | OpKind::Jump
            | OpKind::Branch
            | OpKind::Table
            | OpKind::Argument(_)
            | OpKind::Call
            | OpKind::Return(_)
            | OpKind::Stop => None,
        }
    }

    /// Reports whether `sequence` is always executed from the word `pc` on, for any values.
    fn has(&self, sequence: &[LinkedOp], pc: usize, before: [Option<usize>; 2]) -> bool {
        let Some((first, then)) = sequence.split_first() else { return true };
        let ops = self.ops;
        let goes_on = |next: usize| self.has(then, next, [Some(pc), before[0]]);
        let is_linked = || {
            first.links.iter().zip(before).all(|(link, before)| {
                *link == 0 || before.is_some_and(|before| self.parts[before][DST] == self.parts[pc][*link])
            })
        };
        self.codes.get(pc) == Some(&first.code)
            && is_linked()
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
    use crate::interp::parts::parts_of;
    use crate::op::WORD;
    use crate::operand::{Count, Pool, RegF32, RegF64, RegI32, SigRef};

    /// The opcodes of `ops`, none of which is the target of a branch.
    fn opcodes(ops: &[Op]) -> Vec<u16> {
        let parts: Vec<Parts> = ops.iter().map(parts_of).collect();
        let codes: Vec<u16> = parts.iter().map(|parts| parts[0]).collect();
        let is_target = vec![false; ops.len()];
        let text = Text { ops, codes: &codes, parts: &parts, is_target: &is_target };
        (0..ops.len()).map(|pc| text.code_at(pc)).collect()
    }

    /// The opcode at the first of `ops`.
    fn opcode_of_first(ops: &[Op]) -> u16 {
        opcodes(ops)[0]
    }

    /// An instruction that assigns the register that the first of `sequence` recalls, if it does.
    fn assigning(sequence: Sequence) -> Option<Op> {
        let first = sequence.first()?;
        let is_single = Op::NAMES[usize::from(first.code)].ends_with("f32");
        let single = Op::MovF32 { dst: RegF32(0), src: RegF32(0) };
        let double = Op::ConstF64 { dst: RegF64(0), pool: Pool(0) };
        (first.links != [0; 2]).then_some(if is_single { single } else { double })
    }

    /// The instructions of `sequence`, each of which leads to the next; `start` words precede them.
    ///
    /// A linked operand is register 0, any other operand another register: so exactly this sequence matches.
    fn ops_of(sequence: Sequence, start: u32) -> Vec<Op> {
        let mut ops = Vec::new();
        for step in sequence {
            let next = start + ops.len() as u32 + 1;
            #[expect(clippy::wildcard_enum_match_arm, reason = "only these need a target")]
            match decoded(step) {
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

    /// The instruction of a step, without a branch target.
    fn decoded(step: &LinkedOp) -> Op {
        let mut word = [0; WORD];
        word[..2].copy_from_slice(&step.code.to_le_bytes());
        let plain = Op::decode(word).expect("it is an opcode");
        for place in DST..WORD / 2 {
            word[2 * place] = if place == DST || step.links.contains(&place) { 0 } else { place as u8 };
        }
        // Unlinked operands of instructions that assign nothing are another register, too.
        let is_read = matches!(
            plain.kind(),
            OpKind::Store(_) | OpKind::Branch | OpKind::Argument(_) | OpKind::Return(_) | OpKind::Structure
        );
        if is_read && !step.links.contains(&DST) {
            word[2 * DST] = 1;
        }
        Op::decode(word).unwrap_or(plain)
    }

    #[test]
    fn every_sequence_is_recognised() {
        for (row, sequence) in SEQUENCES.iter().enumerate() {
            let mut ops: Vec<Op> = assigning(sequence).into_iter().collect();
            let start = ops.len();
            ops.extend(ops_of(sequence, start as u32));
            assert_eq!(opcodes(&ops)[start], OPCODES + row as u16, "{sequence:?} as {ops:?}");
        }
    }

    #[test]
    fn a_sequence_with_a_branch_needs_its_next_instruction_on_both_paths() {
        let branch = Op::BrIf { cond: RegI32(0), to: Label(3) };
        let charge = Op::Charge { cycles: crate::operand::Count32(1) };
        let mov = Op::MovI32 { dst: RegI32(0), src: RegI32(0) };
        let is_sequence = |ops: &[Op]| opcode_of_first(ops) >= OPCODES;
        assert!(is_sequence(&[branch, charge, mov, charge]));
        assert!(!is_sequence(&[branch, mov, mov, charge]));
        assert!(!is_sequence(&[branch, charge, charge, mov]));
    }

    #[test]
    fn only_the_value_assigned_just_before_is_recalled() {
        let add = |a, b| Op::AddF64 { dst: RegF64(5), a: RegF64(a), b: RegF64(b) };
        let before = |dst| Op::ConstF64 { dst: RegF64(dst), pool: Pool(0) };
        let is_sequence = |ops: [Op; 2]| opcodes(&ops)[1] >= OPCODES;
        assert!(is_sequence([before(1), add(1, 2)]));
        assert!(!is_sequence([before(3), add(1, 2)]));
        assert!(!is_sequence([Op::StoreF64At { src: RegF64(1), addr: crate::operand::Addr(0) }, add(1, 2)]));
        assert!(!is_sequence([Op::Br { to: Label(1) }, add(1, 2)]));
    }

    #[test]
    fn nothing_is_recalled_at_a_branch_target() {
        let ops = [
            Op::ConstF64 { dst: RegF64(1), pool: Pool(0) },
            Op::AddF64 { dst: RegF64(5), a: RegF64(1), b: RegF64(2) },
        ];
        let parts = ops.map(|op| parts_of(&op));
        let codes = parts.map(|parts| parts[0]);
        let opcode = |is_target| Text { ops: &ops, codes: &codes, parts: &parts, is_target }.code_at(1);
        assert!(opcode(&[false, false]) >= OPCODES);
        assert_eq!(opcode(&[false, true]), codes[1]);
    }
}
