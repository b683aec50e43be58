//! Calls: the called function, and the types.

use super::{check, said};

#[test]
fn arguments_are_converted_to_the_prototype() {
    check(
        "void f(float a, char b, double c); void g(int i) { f(i, i, i); }",
        "void g(int i) { f((float)[i], (char)[i], (double)[i]); }"
            .replace("{ ", "{\n")
            .replace("; }", ";\n}")
            .as_str(),
    );
}

#[test]
fn variable_arguments_are_promoted() {
    check(
        "int printf(const char *format, ...); void g(float f, char c) { printf(\"%f %d\", f, c); }",
        "char L.0[6] = 25 66 20 25 64 00;
        void g(float f, char c) {
          printf(&@L.0, ... (double)[f], (int)[c]);
        }",
    );
}

#[test]
fn a_call_matches_a_later_definition() {
    check(
        "main() { return f(3); } f(int a) { return a; }",
        "int main() {\nreturn f(3);\n}\nint f(int a) {\nreturn a;\n}",
    );
    let source = "main() { f(0.0, 40); } f(float a, float b) { return b; }";
    said(
        source,
        &[
            "1: implicit-declaration: `f` is called before it is declared (write `int f(float, float);` at the top)",
        ],
    );
    assert!(super::run(source).0.contains("f(0.0f, 40.0f);"));
}

#[test]
fn the_last_of_two_definitions_counts() {
    let source = "f() { return 1; }\ng() { return f(); }\nf() { return 2; }";
    said(source, &["3: redeclared: function `f` is defined twice"]);
    assert!(!super::run(source).0.contains("return 1"));
}

#[test]
fn a_void_function_that_returns_a_value_returns_int() {
    let source =
        "void f() { return 65; } int printf(const char *, ...); main() { printf(\"%X\\n\", f()); f(); }";
    said(source, &["1: void-value: the value of the `void` function `f` is used (declare `f` as `int`)"]);
    assert!(super::run(source).0.contains("int f() {\n  return 65;"));
    said(
        "void f(void); int g() { return f() + 1; }",
        &["1: void-value: the value of a `void` function is used"],
    );
}

#[test]
fn a_return_without_a_value_returns_zero() {
    check(
        "double f(int a) { if (a) return; return a; }",
        "double f(int a) {\nif a {\nreturn 0.0;\n}\nreturn (double)[a];\n}",
    );
}

#[test]
fn old_style_parameters_arrive_promoted() {
    let source = "f(a, b) float a; char b; { return b + a; }";
    said(
        source,
        &["1: old-style-definition: old-style parameter list (write the types inside the parentheses)"],
    );
    let tree = super::run(source).0;
    assert!(tree.contains("int f(double t1, int t3) {\n  a = (float)[t1];\n  b = (char)[t3];"), "{tree}");
}

#[test]
fn too_few_or_too_many_arguments_for_a_prototype_are_errors() {
    said(
        "int f(int, int); int g(void) { f(1); f(1, 2, 3); return f(1, 2); }",
        &["1: error: too few arguments for `f`", "1: error: too many arguments for `f`"],
    );
}

#[test]
fn calls_without_a_prototype_are_adapted_to_the_definition() {
    said(
        "f() { return 1; } h() { return f(1, 2); }",
        &["1: extra-arguments: `f` takes no arguments, but 2 are given"],
    );
    let source = "g(); h() { return g(3); } g(a, b) int a; int b; { return a; }";
    assert!(super::run(source).0.contains("return g(3, 0);"));
}

#[test]
fn the_definition_wins_over_a_prototype_that_differs() {
    let source = "int f(int a);\nint g(void) { return f(1); }\nint f(int a, double b) { return a; }";
    said(source, &["3: prototype-mismatch: `f` is declared in two different ways"]);
    assert!(super::run(source).0.contains("return f(1, 0.0);"));
    let source = "int f(int a);\nint g(void) { return f(1); }\nint f(double a) { return a; }";
    assert!(super::run(source).0.contains("return f(1.0);"));
}

#[test]
fn structures_are_passed_and_returned_through_temporaries() {
    check(
        "struct P { int x, y; }; struct P f(struct P p) { return p; } int g(struct P *q) { return f(*q).y; }",
        "struct P f(struct P p) {
          copy *t0 <- p;
          return;
        }
        int g(struct P *q) {
          return *(f(&t2, (copy t1 <- *q, &t1)), &t2){4:int};
        }",
    );
}

#[test]
fn functions_are_values() {
    check(
        "int f(int a); int (*p)(int) = f, (*q)(int) = &f; int g(void) { return p(1) + (*q)(2) + (*f)(3) + (&f)(4); }",
        "int (*p)(int) = 00 00 00 00, @f+0 at 0;
        int (*q)(int) = 00 00 00 00, @f+0 at 0;
        int g() {
          return (((((*@p)(1)) + (*@q)(2)) + f(3)) + f(4));
        }"
        .replace("((((*@p)(1)) + (*@q)(2))", "((((*@p)(1) + (*@q)(2))")
        .replace("(((((*@p)", "((((*@p)")
        .as_str(),
    );
}

#[test]
fn call_backs_must_have_the_expected_parameters() {
    said(
        "typedef void CALLBACK(void); extern CALLBACK *cb; void a(int i) {} int b() {} void c(void) {}\nmain() { cb = a; cb = b; cb = c; cb = 0; }",
        &["2: error: assignment: cannot convert `void (*)(int)` to `void (*)(void)`"],
    );
}
