//! The costs of the vendor's code for each operation, in cycles without wait states (`spec/costs.md` section 6).
//!
//! [`super::cost`] applies them.

use crate::ir::inst::Class;
use crate::operators::BinaryOp;

/// A branch, taken or not; `goto`, `break`, `continue`, `return`.
pub(super) const BRANCH: i32 = 8;
/// Prologue and epilogue of a function; the branch to it is charged to the caller.
pub(super) const ENTRY: i32 = 16;
/// The branch of a call to a pointer, without loading it.
pub(super) const POINTER_BRANCH: i32 = 6;
/// Adding a constant to an address.
pub(super) const STEP: i32 = 3;
/// The address of a global as a value.
pub(super) const GLOBAL_ADDRESS: i32 = 2;
/// The address of a local as a value.
pub(super) const LOCAL_ADDRESS: i32 = 3;
/// Comparing with one case of a switch, and the branch.
pub(super) const CASE: i32 = 12;
/// Keeping the old value for a postfix operator.
pub(super) const KEEP_OLD: i32 = 1;
/// The presence of `...` arguments.
pub(super) const VARIABLE_ARGUMENTS: i32 = 6;
/// The cost of the value of a truth: on the path without a jump, on the path with it.
pub(super) const TRUTH: [i32; 2] = [6, 1];
/// Moving a computed value to the register of an argument or result; a pair of registers counts twice.
pub(super) const MOVE: i32 = 1;
/// Saving an address in a register across a call.
pub(super) const SAVE_ADDRESS: i32 = 10;
/// A double operation whose right side is an element, or with both sides computed.
pub(super) const CROWDED: i32 = 13;
/// The cost of a comparison with an element, and with one on both sides.
pub(super) const CROWDED_COMPARE: [i32; 2] = [11, 18];
/// An operation on singles with an element, or a computed single stored to one.
pub(super) const CROWDED_SINGLE: i32 = 10;

/// Reports whether values of a class take two registers.
const fn is_pair(class: Class) -> bool {
    matches!(class, Class::F64 | Class::I64)
}

/// `single` for classes that fit a register, `pair` for the others.
pub(super) const fn by_class(class: Class, single: i32, pair: i32) -> i32 {
    if is_pair(class) { pair } else { single }
}

/// Words of memory that a value takes.
pub(super) const fn memory_words(class: Class) -> i32 {
    by_class(class, 1, 2)
}

/// A constant.
pub(super) const fn constant(class: Class) -> i32 {
    match class {
        Class::I32 => 2,
        Class::I64 => 4,
        Class::F32 => 7,
        Class::F64 => 8,
    }
}

/// Number of words of a constant that are loaded from memory.
pub(super) const fn constant_words(class: Class) -> i32 {
    match class {
        Class::I32 | Class::I64 => 0,
        Class::F32 => 1,
        Class::F64 => 2,
    }
}

/// Saving a computed value across a call or division.
pub(super) const fn save(class: Class) -> i32 {
    by_class(class, 10, 13)
}

/// Taking the result of a call.
pub(super) const fn result(class: Class) -> i32 {
    by_class(class, 1, 2)
}

/// Passing an argument to a function of the program, or to one of the firmware.
pub(super) const fn argument(class: Class, is_firmware: bool) -> i32 {
    if is_firmware { by_class(class, 2, 3) } else { by_class(class, 3, 5) }
}

/// The function of the firmware that divides floating numbers.
pub(super) const fn division(class: Class) -> i32 {
    by_class(class, 30, 84)
}

/// An operator, including the function that divides if it is one.
pub(super) const fn binary(op: BinaryOp, class: Class) -> i32 {
    match (op, class) {
        (BinaryOp::Divide, Class::I32) => 13 + 20,
        (BinaryOp::Remainder, Class::I32) => 13 + 18,
        (BinaryOp::Divide | BinaryOp::Remainder, Class::I64) => 150,
        (BinaryOp::Divide | BinaryOp::Remainder, Class::F32) => 15 + division(Class::F32),
        (BinaryOp::Divide | BinaryOp::Remainder, Class::F64) => 20 + division(Class::F64),
        (BinaryOp::Multiply, Class::I32) => 9,
        (BinaryOp::Multiply, Class::I64) => 30,
        (_, Class::F32) => 4,
        (BinaryOp::Multiply, Class::F64) => 10,
        (_, Class::F64) => 7,
        (_, Class::I32) => 1,
        (_, Class::I64) => 4,
    }
}

/// A comparison.
pub(super) const fn compare(class: Class) -> i32 {
    by_class(class, 1, 2)
}

/// A conversion of one class to another.
pub(super) const fn convert(from: Class, to: Class) -> i32 {
    match (from, to) {
        (Class::I32, Class::F64) => 5,
        (Class::I32 | Class::F64, Class::F32) | (Class::F32 | Class::F64, Class::I32) => 4,
        (Class::F32, Class::F64) => 2,
        (Class::I32, Class::I64) | (Class::I64, Class::I32) => 1,
        (Class::I64, Class::F32 | Class::F64) | (Class::F32 | Class::F64, Class::I64) => 60,
        (Class::I32, Class::I32)
        | (Class::I64, Class::I64)
        | (Class::F32, Class::F32)
        | (Class::F64, Class::F64) => 0,
    }
}

/// Copying a structure: the call and its three arguments, without their addresses, and the function's own time.
pub(super) fn copy(bytes: u32) -> i32 {
    16 + if bytes < 8 { 32 } else { 26 + (bytes.saturating_mul(7) / 4).cast_signed() }
}

/// The cost of clearing memory.
pub(super) fn clear(bytes: u32) -> i32 {
    18 + if bytes < 8 { 41 } else { 44 + (u64::from(bytes) * 113 / 100) as i32 }
}
