//! The results of all passes together on small functions.

use super::Level;
use crate::lower::testing::{check_ir, ir};

fn check(source: &str, expected: &str) {
    check_ir(source, Level::Full, expected);
}

#[test]
fn constants_fold_as_the_machine_computes() {
    check(
        "int f(void) { int a = 2147483647, s = 33; return a + 1 + (1 << s) + -7 / 2; }",
        "function f() -> i32\nblock0:\nreturn 2147483645",
    );
    check("int f(void) { float x = 1.5f; return x * 3.0 > 4.0; }", "function f() -> i32\nblock0:\nreturn 1");
}

#[test]
fn operations_that_would_trap_are_kept() {
    check(
        "int f(int a) { a / 0; return a % (a - a); }",
        "
        function f(v0: i32) -> i32
        block0:
          v1 = div.i32 v0, 0
          v3 = rem.i32 v0, 0
          return v3
        ",
    );
}

#[test]
fn loads_and_stores_keep_their_number_and_order() {
    check(
        "int g; void f(void) { g = 1; g = 1; g; g; while (g == 0) ; }",
        "
        function f()
        block0:
          store.i32 1, [g]
          store.i32 1, [g]
          v0 = load.i32 [g]
          v1 = load.i32 [g]
          v2 = load.i32 [g]
          branch v2, block3, block2
        block2:
          v3 = load.i32 [g]
          branch v3, block3, block2
        block3:
          return
        ",
    );
}

#[test]
fn decided_branches_and_unreachable_code_are_removed() {
    check(
        "int f(int a) { if (0) a = 1; for (;;) { if (a) break; return 3; } return 2; }",
        "
        function f(v0: i32) -> i32
        block0:
          branch v0, block5, block7
        block7:
          return 3
        block5:
          return 2
        ",
    );
}

#[test]
fn addresses_are_folded_into_base_and_offset() {
    check(
        "struct { int a, b[4]; } s[3]; int f(int *p) { int *q = p + 2; return q[1] + s[1].b[2] + *(q - 1); }",
        "
        function f(v0: i32) -> i32
        block0:
          v2 = load.i32 [v0 + 12]
          v3 = load.i32 [s + 32]
          v4 = add.i32 v2, v3
          v5 = load.i32 [v0 + 4]
          v6 = add.i32 v4, v5
          return v6
        ",
    );
}

#[test]
fn powers_of_two_need_no_division() {
    check(
        "int f(int a) { return a / 8; }",
        "
        function f(v0: i32) -> i32
        block0:
          v2 = shr.i32 v0, 31
          v3 = shr_u.i32 v2, 29
          v4 = add.i32 v0, v3
          v1 = shr.i32 v4, 3
          return v1
        ",
    );
    let text = ir("unsigned f(unsigned a) { return a / 4 + a % 4 + a * 16; }", Level::Full);
    assert!(!text.contains("div") && !text.contains("rem") && !text.contains("mul"), "{text}");
    let text = ir("double f(double a) { return a / 4.0; }", Level::Full);
    assert!(text.contains("mul.f64 v0, 0.25"), "{text}");
}

#[test]
fn values_that_nobody_reads_are_not_computed() {
    check(
        "int g(int); int f(int a) { int b = a * 3; b = a + 1; b = b + 1; g(a); return a; }",
        "
        function f(v0: i32) -> i32
        block0:
          call.i32 g(v0)
          return v0
        ",
    );
}

#[test]
fn facts_about_a_value_end_where_it_is_overwritten() {
    check(
        "int f(int a, int b) { int c = a; a = b; if (c) return c; return a; }",
        "
        function f(v0: i32, v1: i32) -> i32
        block0:
          v2 = v0
          v0 = v1
          branch v2, block1, block2
        block1:
          return v2
        block2:
          return v0
        ",
    );
}

#[test]
fn an_endless_empty_loop_is_kept() {
    check("void f(void) { for (;;) ; }", "function f()\nblock0:\njump block1\nblock1:\njump block1");
}

#[test]
fn invariants_leave_the_loop_and_linear_values_are_incremented() {
    check(
        "int a[4][4]; int f(int i, int n) { int k, s = 0; for (k = 0; k < n; k++) s += a[i][k] + (i * 3 ^ n); return s; }",
        "
        function f(v0: i32, v1: i32) -> i32
        block0:
          v3 = 0
          v2 = 0
          v4 = lt.i32 0, v1
          branch v4, block4, block3
        block4:
          v5 = shl.i32 v0, 4
          v6 = add.i32 v5, &a
          v10 = mul.i32 v0, 3
          v11 = xor.i32 v10, v1
          v16 = v6
          jump block1
        block1:
          v9 = load.i32 [v16]
          v12 = add.i32 v9, v11
          v3 = add.i32 v3, v12
          v2 = add.i32 v2, 1
          v16 = add.i32 v16, 4
          v13 = lt.i32 v2, v1
          branch v13, block1, block3
        block3:
          return v3
        ",
    );
}

#[test]
fn an_expression_is_computed_once_but_each_load_stays() {
    check(
        "int a[9]; int f(int i) { return a[3 * i] + a[3 * i]; }",
        "
        function f(v0: i32) -> i32
        block0:
          v1 = mul.i32 v0, 3
          v2 = shl.i32 v1, 2
          v3 = add.i32 v2, &a
          v4 = load.i32 [v3]
          v6 = shl.i32 v1, 2
          v7 = add.i32 v6, &a
          v8 = load.i32 [v7]
          v9 = add.i32 v4, v8
          return v9
        ",
    );
}
