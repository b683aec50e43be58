//! The shape of the code for C constructs, without optimisation.

mod recorded;

use super::testing::check_ir;
use crate::passes::Level;

fn check(source: &str, expected: &str) {
    check_ir(source, Level::None, expected);
}

#[test]
fn locals_are_values_and_globals_are_memory() {
    check(
        "int g; int f(int a) { int b = a + g; g = b; return g; }",
        "
        function f(v0: i32) -> i32
        block0:
          v2 = load.i32 [g]
          v1 = add.i32 v0, v2
          store.i32 v1, [g]
          v3 = load.i32 [g]
          return v3
        ",
    );
}

#[test]
fn a_local_whose_address_is_taken_lives_in_the_frame() {
    check(
        "int f(char c) { char *p = &c; return *p; }",
        "
        function f(v1: i32) -> i32
          slot0: 1 bytes, align 1
        block0:
          store.i8 v1, [slot0]
          v0 = address [slot0]
          v2 = load.i8 [v0]
          return v2
        ",
    );
}

#[test]
fn a_loop_tests_at_the_bottom() {
    check(
        "void f(int n) { while (n) n--; }",
        "
        function f(v0: i32)
        block0:
          branch v0, block1, block3
        block1:
          v0 = sub.i32 v0, 1
          jump block2
        block2:
          branch v0, block1, block3
        block3:
          return
        ",
    );
}

#[test]
fn conditions_become_branches() {
    check(
        "int f(int a, double b) { if (a && !(b < 1.0)) return 1; return 2; }",
        "
        function f(v0: i32, v1: f64) -> i32
        block0:
          branch v0, block3, block2
        block3:
          v2 = lt.f64 v1, 1.0
          branch v2, block2, block1
        block1:
          return 1
        block2:
          return 2
        ",
    );
}

#[test]
fn an_operand_keeps_its_value_when_a_later_one_writes_the_local() {
    check(
        "int f(int i) { return i + (i = 7) + i; }",
        "
        function f(v0: i32) -> i32
        block0:
          v1 = v0
          v0 = 7
          v2 = add.i32 v1, v0
          v3 = add.i32 v2, v0
          return v3
        ",
    );
}

#[test]
fn variable_arguments_go_into_the_frame() {
    check(
        "int p(char *, ...); int f(char *s, float x) { return p(s, 1, x, 2); }",
        "
        function f(v0: i32, v1: f32) -> i32
          slot0: 20 bytes, align 8
        block0:
          v2 = f64_from_f32 v1
          store.i32 1, [slot0]
          store.f64 v2, [slot0 + 8]
          store.i32 2, [slot0 + 16]
          v3 = address [slot0]
          v4 = call.i32 p(v0, v3)
          return v4
        ",
    );
}

#[test]
fn narrow_locals_keep_their_range() {
    check(
        "int f(int a) { char c = a; c += 100; return c; }",
        "
        function f(v0: i32) -> i32
        block0:
          v1 = ext8_s v0
          v2 = add.i32 v1, 100
          v1 = ext8_s v2
          return v1
        ",
    );
}

#[test]
fn bit_fields_are_extracted_and_inserted() {
    check(
        "struct S { int a : 3, b : 5; } s; int f(void) { return s.b = s.a; }",
        "
        function f() -> i32
        block0:
          v0 = load.i32 [s]
          v1 = shl.i32 v0, 29
          v2 = shr.i32 v1, 29
          v3 = load.i32 [s]
          v4 = and.i32 v3, -249
          v5 = and.i32 v2, 31
          v6 = shl.i32 v5, 3
          v7 = or.i32 v4, v6
          store.i32 v7, [s]
          v8 = shl.i32 v2, 27
          v9 = shr.i32 v8, 27
          return v9
        ",
    );
}

#[test]
fn dense_cases_become_a_table_and_scattered_ones_a_search() {
    check(
        "int f(int a) { switch (a) { case 3: case 4: return 1; case 5: return 2; case 7: return 3; } return 0; }",
        "
        function f(v0: i32) -> i32
        block0:
          v1 = sub.i32 v0, 3
          table v1, [block2, block3, block4, block1, block5], block1
        block2:
          jump block3
        block3:
          return 1
        block4:
          return 2
        block5:
          return 3
        block1:
          return 0
        ",
    );
    let source = "void g(int); void f(unsigned a) {
        switch (a) { case 1: g(1); case 100: g(2); case 0xffffffff: g(3); break; case 5000 ... 6000: g(4); } }";
    let text = super::testing::ir(source, Level::None);
    assert!(text.contains("lt_u.i32 v0, 5000"), "{text}");
    assert!(text.contains("le_u.i32"), "{text}");
    assert!(text.contains("eq.i32 v0, -1"), "{text}");
}

#[test]
fn calls_match_the_definition_however_it_was_declared() {
    let text = super::testing::ir("f() { return g(1.5); } int g(double d) { return d; }", Level::None);
    assert!(text.contains("call.i32 g(1.5)"), "{text}");
}

#[test]
fn falling_off_the_end_returns_zero() {
    check("double f(void) { }", "function f() -> f64\nblock0:\nreturn 0.0");
    check("int f(void) { return; }", "function f() -> i32\nblock0:\nreturn 0");
}

#[test]
fn long_chains_do_not_exhaust_the_stack() {
    let terms = ["a"; 20_000];
    for operator in [" + ", " && "] {
        let source = format!("int f(int a) {{ return {}; }}", terms.join(operator));
        assert!(super::testing::ir(&source, Level::Full).len() > 20_000);
    }
}
