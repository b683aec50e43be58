//! Every kind of instruction by itself.

mod every;

use crate::machine::Machine;
use crate::testing::{Fake, OUT, run};

/// Runs a `main` of `body` with registers r0…r3, l4…l7, f8…f11, d12…d15 and a frame of 16 bytes.
fn run_body(body: &str, others: &str) -> Machine<Fake> {
    let body = body.replace(" | ", "\n");
    run(&[(1, &format!("@main: func sig0, 16, 2\ntypes 0xffaa5500\ncharge 1000\n{body}\n{others}"))], 1)
}

/// Checks the doubleword that `body` stores at `OUT`.
fn check(body: &str, expected: u64) {
    let machine = run_body(&format!("{body} | ret"), "");
    assert_eq!(machine.firmware().log, [""; 0], "{body}");
    assert_eq!(machine.memory().peek::<u64>(OUT), expected, "{body}");
}

/// Checks the 32 bits of `r0` after `body`.
fn check_i32(body: &str, expected: i32) {
    check(&format!("{body} | store_i32_at r0, 0x10000000"), u64::from(expected.cast_unsigned()));
}

/// Checks `r0` after `op r0, r1, r2` with `a` and `b` in `r1` and `r2`.
fn check_binary(op: &str, a: i32, b: i32, expected: i32) {
    check_i32(&format!("const_i32 r1, {a} | const_i32 r2, {b} | {op} r0, r1, r2"), expected);
}

/// Checks the log after `body`.
fn check_trap(body: &str, expected: &str) {
    let machine = run_body(&format!("{body} | ret"), "");
    assert_eq!(machine.firmware().log, [expected], "{body}");
}

#[test]
fn integers_of_32_bits_wrap() {
    check_binary("add_i32", i32::MAX, 1, i32::MIN);
    check_binary("sub_i32", i32::MIN, 1, i32::MAX);
    check_binary("mul_i32", 0x10000, 0x10001, 0x10000);
    check_binary("div_i32_s", -7, 2, -3);
    check_binary("rem_i32_s", -7, 2, -1);
    check_binary("div_i32_u", -1, 2, i32::MAX);
    check_binary("rem_i32_u", -1, 10, 5);
    check_binary("and_i32", 12, 10, 8);
    check_binary("or_i32", 12, 10, 14);
    check_binary("xor_i32", 12, 10, 6);
    check_binary("shl_i32", 1, 33, 0);
    check_binary("shr_i32_s", -8, 33, -1);
    check_binary("shr_i32_u", -8, 1, 0x7fff_fffc);
    check_i32("const_i32 r1, -3 | mul_i32_imm r0, r1, -5", 15);
    check_i32("const_i32 r1, 255 | and_i32_imm r0, r1, -16", 240);
    check_i32("const_i32 r1, 3 | shl_i32_imm r0, r1, 4", 48);
    check_i32("const_i32 r1, -64 | shr_i32_s_imm r0, r1, 4", -4);
    check_i32("const_i32 r1, -1 | shr_i32_u_imm r0, r1, 28", 15);
    check_i32("const_i32 r1, 0x12345680 | ext8_s r0, r1", -128);
    check_i32("const_i32 r1, 0x12345680 | ext8_u r0, r1", 128);
    check_i32("const_i32 r1, 0x12348000 | ext16_s r0, r1", -32768);
    check_i32("const_i32 r1, 0x12348000 | ext16_u r0, r1", 32768);
}

#[test]
fn comparisons_respect_signedness() {
    check_binary("lt_i32_s", -1, 0, 1);
    check_binary("lt_i32_u", -1, 0, 0);
    check_binary("le_i32_s", 3, 3, 1);
    check_binary("le_i32_u", 0, -1, 1);
    check_binary("eq_i32", -1, -1, 1);
    check_binary("ne_i32", -1, -1, 0);
}

#[test]
fn integers_of_64_bits_use_the_whole_register() {
    let constant = "const_i64 l4, pool[1]";
    let check_long = |op: &str, expected: u64| {
        check(&format!("{constant} | {op} | store_i64_at l5, 0x10000000"), expected);
    };
    check_long("add_i64 l5, l4, l4", 0x2468_acf1_3579_bde0);
    check_long("const_i32 r0, 68 | shl_i64 l5, l4, r0", 0x2345_6789_abcd_ef00);
    check_long("const_i32 r0, -1 | i64_from_i32_s l5, r0", u64::MAX);
    check_long("const_i32 r0, -1 | i64_from_i32_u l5, r0", 0xffff_ffff);
    check_i32(&format!("{constant} | i32_from_i64 r0, l4"), 0x9abc_def0_u32.cast_signed());
    check_i32(&format!("{constant} | sub_i64 l5, l6, l4 | lt_i64_s r0, l5, l4"), 1);
    check_i32(&format!("{constant} | sub_i64 l5, l6, l4 | lt_i64_u r0, l5, l4"), 0);
}

#[test]
fn floating_values_are_ieee() {
    let check_double = |op: &str, expected: f64| {
        let body = format!("const_f64 d12, pool[0] | {op} | store_f64_at d13, 0x10000000");
        check(&body, expected.to_bits());
    };
    check_double("add_f64 d13, d12, d12", 5.0);
    check_double("mul_f64 d13, d12, d12", 6.25);
    check_double("neg_f64 d13, d12", -2.5);
    check_double("div_f64 d13, d12, d14", f64::INFINITY);
    check_double("div_f64 d13, d14, d14", f64::from_bits(0x7ff8_0000_0000_0000));
    check_double("const_i32 r0, -3 | f64_from_i32_s d13, r0", -3.0);
    check_double("const_i32 r0, -1 | f64_from_i32_u d13, r0", 4_294_967_295.0);
    check_double("f32_from_f64 f8, d12 | add_f32 f8, f8, f8 | f64_from_f32 d13, f8", 5.0);
    check_i32("const_f32 f8, 0x4f800000 | i32_from_f32_s r0, f8", i32::MAX);
    check_i32("const_f32 f8, 0xbf800000 | i32_from_f32_u r0, f8", -1);
    check_i32("div_f64 d13, d14, d14 | le_f64 r0, d13, d13", 0);
    check_i32("div_f64 d13, d14, d14 | ne_f64 r0, d13, d13", 1);
}

#[test]
fn loads_and_stores_extend_and_truncate() {
    let at = "const_i32 r1, 0x10000010 | const_i32 r2, 0x8081f283";
    let check_load = |op: &str, expected: i32| {
        check_i32(&format!("{at} | store_i32 r2, r1, +4 | {op}"), expected);
    };
    check_load("load_i8_s r0, r1, +4", -125);
    check_load("load_i8_u r0, r1, +5", 0xf2);
    check_load("load_i16_s r0, r1, +6", -32639);
    check_load("load_i16_u r0, r1, +4", 0xf283);
    check_load("load_i32_at r0, 0x10000014", 0x8081_f283_u32.cast_signed());
    check_load("store_i8 r1, r1, +7 | load_i32 r0, r1, +4", 0x1081_f283);
    check_load("store_i16_at r1, 0x10000014 | load_i32 r0, r1, +4", 0x8081_0010_u32.cast_signed());
    check_load("clear r1, 6 | load_i32 r0, r1, +4", 0x8081_0000_u32.cast_signed());
    check_load(
        "copy r1, r1, 8 | add_i32_imm r3, r1, -4 | copy r3, r1, 8 | load_i32 r0, r1, +0",
        0x8081_f283_u32.cast_signed(),
    );
    check_i32("frame_addr r1, 8 | const_i32 r2, 5 | store_i32 r2, r1, +4 | load_i32_at r0, 0x80007ffc", 0);
    check_i32("frame_addr r0, 8", 0x8000_7fe8_u32.cast_signed());
}

#[test]
fn a_double_may_be_stored_but_not_loaded_at_a_word_address() {
    let store = "const_f64 d12, pool[0] | store_f64_at d12, 0x10000004";
    check_i32(&format!("{store} | load_i32_at r0, 0x10000008"), 0x4004_0000);
    let message = "27000 1 thread 1 at 0x80050080: read of 8 bytes at 0x10000004, which is not aligned";
    check_trap(&format!("{store} | load_f64_at d12, 0x10000004"), message);
}

#[test]
fn illegal_operations_trap() {
    let check = |body: &str, at: u32, expected: &str| {
        check_trap(body, &format!("27000 1 thread 1 at {at:#x}: {expected}"));
    };
    check("rem_i32_s r0, r1, r2", 0x8005_0070, "integer division by zero");
    check("load_i32 r0, r1, +0", 0x8005_0070, "read of the unmapped address 0x00000000");
    check("store_i8_at r0, 0x80050000", 0x8005_0070, "write to 0x80050000, which holds program text");
    check("store_i32_at r0, 0x81000000", 0x8005_0070, "write of the unmapped address 0x81000000");
    let unknown = "call of 0x10007000, where the firmware has no function";
    check("call_fw sig0, 0x10007000 | charge 9", 0x8005_0070, unknown);
    let types = "call of 0x10008000 with parameters that do not match the function";
    check("call_fw sig0, 0x10008000 | charge 9", 0x8005_0070, types);
    let pointer = "call of 0x00000000, where no function of this program starts";
    check("call_ptr r0, sig0 | charge 9", 0x8005_0070, pointer);
    let foreign = "call of 0x80060058, where no function of this program starts";
    check("const_i32 r0, 0x80060058 | call_ptr r0, sig0 | charge 9", 0x8005_0078, foreign);
    let missing = "calls `Missing`, whose behaviour the simulated board does not model yet";
    check("call_fw sig0, 0x10008048 | charge 9", 0x8005_0070, missing);
    let end =
        "execution reached an address without code, for example by `goto *` to something other than a label";
    check("unreachable | charge 9", 0x8005_0070, end);
}

#[test]
fn a_branch_table_jumps_by_its_index() {
    let table = "br_table r1, 2 | br @a | br @b | br @c \
                 | @a: charge 9 | const_i32 r0, 10 | br @end | @b: charge 9 | const_i32 r0, 20 | br @end \
                 | @c: charge 9 | const_i32 r0, 30 | br @end | @end: charge 9";
    for (index, expected) in [(0, 10), (1, 20), (2, 30), (3, 30), (-1, 30)] {
        check_i32(&format!("const_i32 r1, {index} | {table}"), expected);
    }
}

#[test]
fn calls_pass_arguments_and_results() {
    let callee =
        "@twice: func sig3, 2, 0\ntypes 0\ncharge 9\nadd_i32 r1, r1, r0\nadd_i32 r0, r1, r0\nret_i32 r0";
    let body = "const_i32 r0, 21 | arg_i32 r0, 0 | call fn@twice | result_i32 r1 | charge 40 \
                | arg_i32 r1, 0 | call fn@twice | result_i32 r2 | charge 40 | store_i32_at r2, 0x10000000 | ret";
    assert_eq!(run_body(body, callee).memory().peek::<i32>(OUT), 84);
    let firmware = "const_i32 r0, 3 | const_f64 d12, pool[0] | arg_i32 r0, 0 | arg_f64 d12, 1 \
                    | call_fw sig4, 0x10008040 | result_f64 d13 | charge 9 | store_f64_at d13, 0x10000000";
    check(firmware, 7.5_f64.to_bits());
}

#[test]
fn a_pointer_may_be_called_with_any_declared_return_type() {
    let callee = "@add: func sig3, 1, 0\ntypes 0\ncharge 9\nadd_i32_imm r0, r0, 1\nret_i32 r0\n\
                  @none: func sig1, 1, 0\ntypes 0\ncharge 9\nret";
    // `main` takes words 11 to 27.
    let call = |at: u32, sig: &str, result: &str| {
        format!(
            "const_i32 r0, 41 | const_i32 r1, {:#x} | const_i32 r2, 7 | arg_i32 r0, 0 | call_ptr r1, {sig} {result} \
             | charge 9 | store_i32_at r2, 0x10000000 | ret",
            0x8005_0000 + at * 8
        )
    };
    let check = |at, sig: &str, result: &str, expected: i32| {
        let machine = run_body(&call(at, sig, result), callee);
        assert_eq!(machine.firmware().log, [""; 0]);
        assert_eq!(machine.memory().peek::<i32>(OUT), expected);
    };
    check(23, "sig3", "| result_i32 r2", 42);
    check(22, "sig1", "", 7);
    check(28, "sig3", "| result_i32 r2", 0);
}

#[test]
fn registers_of_a_call_begin_at_zero() {
    let dirty = "@dirty: func sig0, 3, 0\ntypes 0\ncharge 9\nconst_i32 r2, 99\nret\n\
                 @clean: func sig2, 3, 0\ntypes 0\ncharge 9\nret_i32 r2";
    let body = "call fn@dirty | charge 9 | call fn@clean | result_i32 r0 | charge 9 \
                | store_i32_at r0, 0x10000000 | ret";
    assert_eq!(run_body(body, dirty).memory().peek::<i32>(OUT), 0);
}

#[test]
fn device_registers_are_reached_through_the_bus() {
    let machine = run_body(
        "const_i32 r1, 0x91000002 | load_i8_u r0, r1, +0 | store_i16_at r1, 0x91000004 | load_i64_at l4, 0x91000008 \
         | store_i32_at r1, 0x90000000 | store_i32_at r0, 0x10000000 | ret",
        "",
    );
    assert_eq!(
        machine.firmware().bus,
        [
            "27040 read 1 of 0x91000002",
            "27080 write 2 of 0x91000004: 0x2",
            "27120 read 4 of 0x91000008",
            "27160 read 4 of 0x9100000c",
            "27200 write 4 of 0x90000000: 0x91000002",
        ]
    );
    assert_eq!(machine.memory().peek::<i32>(OUT), 0x78);
}
