//! Sizes and offsets of the target, checked by the programs themselves.

use super::{accept, said};

#[test]
fn scalar_sizes() {
    accept(
        "_Static_assert(sizeof(char) == 1 && sizeof(short) == 2 && sizeof(int) == 4 && sizeof(long) == 4, \"\");
        _Static_assert(sizeof(long long) == 8 && sizeof(float) == 4 && sizeof(double) == 8, \"\");
        _Static_assert(sizeof(long double) == 8 && _Alignof(long double) == 8 && _Alignof(double) == 8, \"\");
        _Static_assert(sizeof(void *) == 4 && sizeof(int (*)(void)) == 4 && sizeof(_Bool) == 1, \"\");
        enum E { A }; _Static_assert(sizeof(enum E) == 4 && sizeof(void) == 1, \"\");
        _Static_assert(sizeof L\"ab\" == 12 && sizeof \"abc\" == 4 && sizeof 'a' == 4, \"\");
        _Static_assert(sizeof(1 == 1) == 4 && sizeof 1.0f == 4 && sizeof 1.0 == 8, \"\");
        _Static_assert(-1 < sizeof(int), \"sizeof is signed\");",
    );
}

#[test]
fn constants_have_their_types_and_values() {
    accept(
        "_Static_assert((char)200 == -56 && '\\377' == -1, \"char is signed\");
        _Static_assert(-2147483648 == 2147483648 && !(-1 < 2147483648), \"decimal constants may be unsigned\");
        _Static_assert(sizeof 4294967296 == 8 && sizeof 0xffffffff == 4, \"\");
        _Static_assert(-7 / 2 == -3 && -7 % 2 == -1 && 7 / -2 == -3, \"\");
        _Static_assert((int)1e10 == 2147483647 && (unsigned)-1.0 == 0xffffffff && (char)300.0 == 44, \"\");
        _Static_assert(0.1f != 0.1 && (int)!1.5 == 0 && 0.1f + 0.2f == 0.3f, \"float stays float\");
        _Static_assert((1 ? 2 : 1 / 0) == 2 && (0 && 1 / 0) == 0, \"\");",
    );
    said(
        "_Static_assert(2147483647 + 1 == -2147483647 - 1, \"wraps\");",
        &[
            "1: overflow: 2147483648 does not fit in an `int` (write one of the numbers with a decimal point, as in \
           `50000.0`, and store the result in a `double`)",
        ],
    );
    said(
        "_Static_assert(1 << 33 == 0 && -8 >> 40 == -1, \"shift counts are modulo 64\");",
        &["1: shift-count: a shift by 33", "1: shift-count: a shift by 40"],
    );
    said(
        "int a[1 / 0]; enum { A = 5 % 0 };",
        &[
            "1: error: division by zero in a constant expression",
            "1: error: division by zero in a constant expression",
        ],
    );
}

#[test]
fn structures_have_natural_alignment() {
    accept(
        "struct A { char a; double b; char c; };
        _Static_assert(sizeof(struct A) == 24 && __builtin_offsetof(struct A, b) == 8, \"\");
        _Static_assert(__builtin_offsetof(struct A, c) == 16 && _Alignof(struct A) == 8, \"\");
        struct B { char a[3]; short b; char c; };
        _Static_assert(sizeof(struct B) == 8 && __builtin_offsetof(struct B, b) == 4, \"\");
        _Static_assert(__builtin_offsetof(struct B, c) == 6, \"\");
        union C { char a; double b; int c[3]; };
        _Static_assert(sizeof(union C) == 16 && _Alignof(union C) == 8, \"\");
        struct D { int n; double rest[]; }; _Static_assert(sizeof(struct D) == 8, \"\");
        struct E { int n; char rest[0]; }; _Static_assert(sizeof(struct E) == 4, \"\");
        struct F { int a; struct { char b; union { short c; int d; }; }; };
        _Static_assert(sizeof(struct F) == 12 && __builtin_offsetof(struct F, d) == 8, \"\");
        struct G { int a[4]; struct A b[2]; }; _Static_assert(__builtin_offsetof(struct G, b[1].c) == 56, \"\");
        _Static_assert(sizeof(struct G) == 64, \"\");",
    );
    said(
        "int f(int a[10]) { return sizeof a == 4; }",
        &[
            "1: sizeof-pointer: `sizeof(a)` is the size of a pointer (pass the number of elements beside the pointer, or \
           apply `sizeof` to the array itself)",
        ],
    );
}

#[test]
fn bit_fields_are_packed_as_gcc_packs_them() {
    accept(
        "struct A { int a : 3, b : 5, c : 24; }; _Static_assert(sizeof(struct A) == 4, \"\");
        struct B { int a : 20, b : 20; }; _Static_assert(sizeof(struct B) == 8, \"\");
        struct C { int a : 3; int : 0; int b : 3; }; _Static_assert(sizeof(struct C) == 8, \"\");
        struct D { char a : 3; unsigned char b : 5; char c; }; _Static_assert(sizeof(struct D) == 2, \"\");
        enum E { X }; struct F { enum E e : 2; short s : 16; }; _Static_assert(sizeof(struct F) == 4, \"\");
        struct G { int a : 5; char b; int c : 3; }; _Static_assert(sizeof(struct G) == 4, \"\");
        struct H { int a : 19; unsigned char b : 8; }; _Static_assert(sizeof(struct H) == 4, \"\");",
    );
    said(
        "struct A { int a : 33; };\nstruct B { double d : 3; };\nstruct C { int x : 0; };\nint f(struct A *p) { return p->a; }",
        &[
            "1: error: a bit-field of type `int` cannot be 33 bits wide",
            "2: error: a bit-field cannot have the type `double` (use an integer type, such as `int` or `unsigned`)",
            "3: error: a bit-field of type `int` cannot be 0 bits wide",
        ],
    );
}
