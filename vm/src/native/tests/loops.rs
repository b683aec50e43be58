//! Loops that run several iterations at once stop at the same instruction as in the bytecode engine.

use super::lockstep;
use crate::engine::Stop;
use crate::trap::TrapKind;

/// A loop that executes `body` with an address in `r0` and the remaining iterations in `r1`; `r2`, `r3` and `d4` are
/// free.
fn walk(from: u32, step: i32, iterations: u32, body: &str) -> String {
    let from = from.cast_signed();
    format!(
        "@main: func sig0, 5, 0\ntypes 0x300\ncharge 9\nconst_i32 r0, {from}\nconst_i32 r1, {iterations}\n\
         @up: charge 50\n{body}\nadd_i32_imm r0, r0, {step}\nadd_i32_imm r1, r1, -1\nbr_if r1, @up\n\
         charge 9\nstore_i32_at r2, 0x10000000\nret"
    )
}

/// Runs `functions` on both engines in one slice, and in many.
fn stop_of(functions: &str) -> Stop {
    let all_at_once = lockstep(functions, &[1_000_000]);
    // Slices that end within the iterations that run at once, before them and after them.
    let budgets: Vec<i64> = (0..400).map(|slice| 1 + slice % 29 * 17).collect();
    assert_eq!(lockstep(functions, &budgets), all_at_once, "{functions}");
    all_at_once
}

fn trap_of(functions: &str) -> TrapKind {
    match stop_of(functions) {
        Stop::Trapped(trap) => trap.kind,
        stop => panic!("{stop:?}: {functions}"),
    }
}

#[test]
fn memory_is_read_and_written_in_every_region() {
    for from in [0x80ff_ff80, 0x1001_ff80, 0x8004_ff00] {
        for body in [
            "load_i32 r2, r0, +0",
            "load_i8_s r2, r0, +3\nstore_i8 r2, r0, +9",
            "load_i16_u r2, r0, +0\nload_i32 r3, r0, +4\nstore_i16 r2, r0, +8\nstore_i32 r3, r0, +0",
            "load_f64 d4, r0, +8\nadd_f64 d4, d4, d4\nstore_f64 d4, r0, +0",
        ] {
            assert_eq!(stop_of(&walk(from, 8, 14, body)), Stop::Ended, "{from:x}: {body}");
            assert_eq!(stop_of(&walk(from + 8 * 14, -8, 14, body)), Stop::Ended, "{from:x}: {body}");
        }
    }
}

#[test]
fn the_end_of_memory_traps_in_the_iteration_that_reaches_it() {
    for iterations in 0..5 {
        let from = 0x8100_0000 - 4 * iterations;
        let load = trap_of(&walk(from, 4, 20, "load_i32 r2, r0, +0"));
        assert!(matches!(load, TrapKind::Unmapped { addr, .. } if addr.get() == 0x8100_0000), "{load}");
        let both = trap_of(&walk(from, 4, 20, "store_i32 r1, r0, +0\nload_i32 r2, r0, +4"));
        assert!(matches!(both, TrapKind::Unmapped { addr, .. } if addr.get() == 0x8100_0000), "{both}");
    }
}

#[test]
fn program_text_is_protected_in_every_iteration() {
    for iterations in 0..5 {
        let up = walk(0x8005_0000 - 4 * iterations, 4, 20, "store_i32 r1, r0, +0");
        assert!(matches!(trap_of(&up), TrapKind::WriteProtected { .. }));
        let down = walk(0x8005_0200 + 4 * iterations, -4, 200, "load_i32 r3, r0, +0\nstore_i32 r3, r0, +0");
        assert!(matches!(trap_of(&down), TrapKind::WriteProtected { .. }));
        let constant = "load_i32 r3, r0, +0\nstore_i32_at r3, 0x80050008";
        assert!(matches!(trap_of(&walk(0x8010_0000, 4, 9, constant)), TrapKind::WriteProtected { .. }));
    }
}

#[test]
fn addresses_that_are_not_aligned_trap() {
    for (step, body) in [
        (2, "load_i32 r2, r0, +0"),
        (1, "load_i8_u r2, r0, +0\nload_i16_s r3, r0, +0"),
        (4, "load_i32 r2, r0, +0\nload_f64 d4, r0, +0"),
        (4, "store_i32 r2, r0, +0\nload_i16_u r2, r0, +1"),
    ] {
        assert!(matches!(trap_of(&walk(0x8010_0000, step, 9, body)), TrapKind::Misaligned { .. }), "{body}");
    }
    // A double may be stored at any word address.
    assert_eq!(stop_of(&walk(0x8010_0000, 4, 9, "store_f64 d4, r0, +0")), Stop::Ended);
}

#[test]
fn division_by_zero_traps_in_its_iteration() {
    for zero in [1, 2, 7, 9] {
        let body = format!("add_i32_imm r3, r1, -{zero}\ndiv_i32_s r2, r0, r3\nstore_i32 r2, r0, +0");
        assert_eq!(trap_of(&walk(0x8010_0000, 4, 12, &body)), TrapKind::DivisionByZero);
    }
}

#[test]
fn devices_can_be_accessed_from_loops() {
    for body in ["load_i32 r2, r0, +0", "store_i32 r1, r0, +0\nload_i32 r2, r0, +4\nstore_i32 r2, r0, +8"] {
        let _ = stop_of(&walk(0x9100_0000, 4, 12, body));
        let _ = stop_of(&walk(0x9100_0000, 0, 12, body));
    }
}

#[test]
fn iterations_cost_what_their_path_costs() {
    for body in [
        "and_i32_imm r3, r1, 1\nbr_if r3, @odd\ncharge 40\nload_i32 r2, r0, +0\n@odd: charge 23",
        "and_i32_imm r3, r1, 2\nbr_if r3, @a\ncharge 40\nstore_i32 r1, r0, +0\nbr @b\n\
         @a: charge 11\nload_i32 r2, r0, +8\n@b: charge 23\nload_i32 r3, r0, +0",
        "add_i32_imm r3, r1, -5\nbr_unless r3, @end\ncharge 23",
        "add_i32_imm r3, r1, -5\nbr_if r3, @on\ncharge 23\nret\n@on: charge 30",
        "and_i32_imm r3, r1, 3\nbr_unless r3, @again\ncharge 30\nbr @on\n\
         @again: charge 10\nadd_i32_imm r1, r1, -1\nbr @up\n@on: charge 30",
    ] {
        let functions = walk(0x8010_0000, 4, 14, body).replace("charge 9\nstore", "@end: charge 9\nstore");
        assert_eq!(stop_of(&functions), Stop::Ended, "{body}");
    }
}

#[test]
fn a_loop_may_be_entered_at_its_condition() {
    for iterations in [0, 1, 3, 4, 9] {
        let functions = format!(
            "@main: func sig0, 4, 0\ntypes 0\ncharge 9\nconst_i32 r0, 0x10000100\nconst_i32 r1, {iterations}\nbr @test\n\
             @up: charge 20\nload_i32 r2, r0, +0\nadd_i32 r2, r2, r1\nstore_i32 r2, r0, +4\nadd_i32_imm r0, r0, 4\n\
             add_i32_imm r1, r1, -1\n@test: charge 7\nbr_unless r1, @end\ncharge 7\nload_i32 r3, r0, +0\n\
             lt_i32_s r3, r3, r0\nbr_if r3, @up\n@end: charge 9\nret"
        );
        assert_eq!(stop_of(&functions), Stop::Ended);
    }
}

#[test]
fn several_accesses_through_one_register_trap_at_the_first_bad_one() {
    for (from, accesses) in [
        (0x80ff_fff8, "load_i32 r2, r0, +0\nload_i32 r3, r0, +4\nstore_i32 r3, r0, +0\nload_i32 r2, r0, +8"),
        (
            0x8004_fff8,
            "store_i32 r2, r0, +4\nstore_i32 r3, r0, +0\nstore_i32 r2, r0, +8\nstore_i32 r2, r0, +4",
        ),
        (0x8010_0002, "load_i16_s r2, r0, +0\nload_i16_s r3, r0, +2\nload_i32 r2, r0, +4"),
    ] {
        let from = u32::cast_signed(from);
        let functions = format!(
            "@main: func sig0, 4, 0\ntypes 0\ncharge 50\nconst_i32 r0, {from}\nconst_i32 r3, 77\n{accesses}\nret"
        );
        let _ = trap_of(&functions);
    }
}

#[test]
fn an_address_may_move_by_a_register() {
    let skips = "and_i32_imm r3, r1, 1\nbr_if r3, @odd\ncharge 40\nstore_i32 r1, r0, +0\n@odd: charge 23";
    for body in
        ["store_i32 r1, r0, +0", "load_i32 r3, r0, +4\nload_i8_u r3, r0, +0", "store_i8 r1, r0, +3", skips]
    {
        for step in [0, 1, 4, 12, 4096, 0x0020_0000, 0x4000_0000, -4, i32::MIN] {
            for from in [0x8010_0000_u32, 0x80ff_ffd0, 0x8004_ffd0, 0x8005_0400] {
                let moved = walk(from, 0, 40, body)
                    .replace(
                        "charge 9\nconst_i32 r0",
                        &format!("charge 9\nconst_i32 r2, {step}\nconst_i32 r0"),
                    )
                    .replace("add_i32_imm r0, r0, 0", "add_i32 r0, r0, r2");
                let _ = stop_of(&moved);
            }
        }
    }
}
