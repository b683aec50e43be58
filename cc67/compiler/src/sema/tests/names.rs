//! Names that are not declared.

use super::{accept, said};

#[test]
fn a_firmware_function_has_its_own_prototype() {
    let source = "main() { if (ReadBit(3)) Delay_sec(1); if (ReadBit(4)) Delay_sec(1); }";
    said(
        source,
        &[
            "1: implicit-declaration: `ReadBit` is not declared (include `KMotionDef.h`, or declare the function)",
            "1: implicit-declaration: `Delay_sec` is not declared (include `KMotionDef.h`, or declare the function)",
        ],
    );
    assert!(super::run(source).0.contains("Delay_sec(1.0)"));
}

#[test]
fn misspelt_names_get_a_suggestion() {
    said(
        "int T0, x;\nmain() { Readbit(1); t0 = 1; frobnicate(); y = 1; persist = 2; bool; }",
        &[
            "2: error: undefined function `Readbit` (did you mean `ReadBit`?)",
            "2: error: `t0` is not declared (did you mean `T0`?)",
            "2: error: undefined function `frobnicate`",
            "2: error: `y` is not declared",
            "2: error: `persist` is not declared (is `KMotionDef.h` included?)",
            "2: error: `bool` is not declared",
        ],
    );
}

#[test]
fn names_are_visible_from_their_declaration_on() {
    said("int f(void) { return n; }\nint n;", &["1: error: `n` is not declared (move the declaration up)"]);
    accept(
        "enum { A = 1 }; int f(int a[A]) { return A; } enum { A = 1 }; int a = 3; int g(void) { int a = 4, b = a; return b; }",
    );
}

#[test]
fn members_are_suggested() {
    said(
        "struct { int Position, Dest; } *ch0; double g(void) { return ch0->position; }",
        &["1: error: `unnamed struct` has no member `position` (did you mean `Position`?)"],
    );
}

#[test]
fn unknown_types_suggest_the_header() {
    let (_, said) = super::run("void f(CHAN *c) { c->Dest = 0; } main() { f(0); }");
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said.iter().all(|line| line.contains("KMotionDef.h")), "{said:?}");
}
