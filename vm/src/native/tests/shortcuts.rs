//! Functions that may return early: executing the path to the return has the same effects as making the call.

use super::lockstep;
use crate::engine::Stop;
use crate::trap::TrapKind;

/// Calls the function `@f` of `functions` with the numbers from `first` down to 0 and stores the sum of the results.
fn calls(functions: &str, first: i32) -> String {
    format!(
        "{functions}@main: func sig0, 3, 0\ntypes 0\ncharge 9\nconst_i32 r0, {first}\n@up: charge 11\narg_i32 r0, 0\n\
         call fn@f\nresult_i32 r1\ncharge 7\nadd_i32 r2, r2, r1\nadd_i32_imm r0, r0, -1\nlt_i32_s r1, r0, r1\n\
         br_if r0, @up\ncharge 9\nstore_i32_at r2, 0x10000000\nret"
    )
}

/// Runs `functions` on both engines in one slice, and in many that end at every position on the way.
fn stop_of(functions: &str) -> Stop {
    let all_at_once = lockstep(functions, &[1_000_000]);
    for length in [1, 3, 17, 40, 66] {
        let budgets: Vec<i64> = (0..4000).map(|slice| length + slice % 13).collect();
        assert_eq!(lockstep(functions, &budgets), all_at_once, "{functions}");
    }
    all_at_once
}

#[test]
fn an_early_return_guard_may_or_may_not_be_taken() {
    for test in ["lt_i32_s r1, r0, r1", "and_i32_imm r1, r0, 1", "sub_i32 r1, r0, r0", "const_i32 r1, 1"] {
        let f = format!(
            "@f: func sig3, 3, 8\ntypes 0\ncharge 13\nconst_i32 r1, 4\n{test}\nbr_if r1, @soon\ncharge 21\n\
             arg_i32 r0, 0\ncall_fw sig1, 0x10008000\ncharge 5\nstore_i32_at r0, 0x80f00100\nret_i32 r0\n\
             @soon: charge 8\nadd_i32 r2, r2, r0\nmul_i32_imm r0, r2, 3\nbr @out\n@out: charge 2\nret_i32 r0\n"
        );
        assert_eq!(stop_of(&calls(&f, 9)), Stop::Ended, "{test}");
    }
}

#[test]
fn a_function_that_returns_soon_may_load_from_anywhere() {
    let at = |address: u32| {
        format!(
            "@f: func sig3, 2, 0\ntypes 0\ncharge 13\nconst_i32 r1, {}\nload_i32 r1, r1, +4\nadd_i32 r0, r0, r1\nret_i32 r0\n",
            address.cast_signed()
        )
    };
    for address in [0x80f0_0000, 0x80ff_fff8, 0x1000_0100, 0x9100_0010, 0x8005_0000] {
        assert_eq!(stop_of(&calls(&at(address), 5)), Stop::Ended, "{address:x}");
    }
    for address in [0x80ff_fffc, 0x80f0_0001, 0] {
        let trapped = stop_of(&calls(&at(address), 5));
        let Stop::Trapped(trap) = trapped else { panic!("{address:x}: {trapped:?}") };
        assert!(matches!(trap.kind, TrapKind::Unmapped { .. } | TrapKind::Misaligned { .. }), "{trap}");
    }
    let constant = "@f: func sig3, 2, 0\ntypes 0\ncharge 13\nload_i32_at r1, 0x80f00028\nxor_i32 r0, r0, r1\nret_i32 r0\n";
    assert_eq!(stop_of(&calls(constant, 5)), Stop::Ended);
}

#[test]
fn a_division_by_zero_traps_in_the_function() {
    let f = "@f: func sig3, 2, 0\ntypes 0\ncharge 13\ndiv_i32_s r1, r0, r1\nret_i32 r1\n";
    let of =
        format!("{f}@main: func sig0, 1, 0\ntypes 0\ncharge 9\narg_i32 r0, 0\ncall fn@f\nresult_i32 r0\nret");
    assert!(matches!(stop_of(&of), Stop::Trapped(_)));
}

#[test]
fn a_function_that_returns_soon_still_needs_its_stack_frame() {
    // The last call does not fit, wherever the recursion ends.
    for frame in [0, 8, 4000] {
        let leaf =
            format!("@leaf: func sig3, 1, {frame}\ntypes 0\ncharge 3\nadd_i32_imm r0, r0, 1\nret_i32 r0\n");
        for depth in [0, 3, 815, 816, 817, 818, 819] {
            let main = format!(
                "{leaf}@f: func sig3, 2, 3\ntypes 0\ncharge 9\narg_i32 r0, 0\ncall fn@leaf\nresult_i32 r1\ncharge 4\n\
                 add_i32_imm r1, r1, -2\nbr_unless r0, @end\ncharge 9\narg_i32 r1, 0\ncall fn@f\nresult_i32 r1\n\
                 charge 9\n@end: charge 9\nadd_i32 r0, r0, r1\nret_i32 r0\n\
                 @main: func sig0, 1, 0\ntypes 0\ncharge 99\nconst_i32 r0, {depth}\narg_i32 r0, 0\n\
                 call fn@f\nresult_i32 r0\ncharge 99\nstore_i32_at r0, 0x10000000\nret"
            );
            assert_eq!(lockstep(&main, &[1_000_000]), lockstep(&main, &[100; 1000]), "{main}");
        }
    }
}

#[test]
fn a_nan_result_has_the_bits_of_arithmetic() {
    let f = "@f: func sig4, 4, 0\ntypes 0xfc\ncharge 13\nsub_f64 d2, d1, d1\nmov_f64 d3, d2\ncharge 4\nret_f64 d3\n";
    let main = format!(
        "{f}@main: func sig0, 3, 0\ntypes 0x3c\ncharge 9\nload_f64_at d1, ADDRESS\narg_i32 r0, 0\narg_f64 d1, 1\n\
         call fn@f\nresult_f64 d2\ncharge 4\nstore_f64_at d2, 0x10000000\nret"
    );
    // Two infinities, two NaNs, and a number.
    for number in 16..=20 {
        let address = format!("{:#x}", super::NUMBERS + 8 * number);
        assert_eq!(stop_of(&main.replace("ADDRESS", &address)), Stop::Ended);
    }
}
