//! Initialisers of static and local objects.

use super::{check, said};

/// The data of one initialised object.
fn data(source: &str, expect: &str) {
    check(source, expect);
}

#[test]
fn static_scalars_are_bytes() {
    data("int a = 0x01020304;", "int a = 04 03 02 01;");
    data("char a = -1; short b = 258;", "char a = ff;\nshort b = 02 01;");
    data("float a = 1; double b = 0.5f;", "float a = 00 00 80 3f;\ndouble b = 00 00 00 00 00 00 e0 3f;");
    data(
        "unsigned char a = (unsigned char)3.9; int b = { 5 };",
        "unsigned char a = 03;\nint b = 05 00 00 00;",
    );
    data("long long a = -2;", "long long a = fe ff ff ff ff ff ff ff;");
}

#[test]
fn aggregates_are_filled_in_order() {
    data("char a[] = { 1, 2, 3 };", "char a[3] = 01 02 03;");
    data("char a[2][3] = { { 1 }, { 2, 3 } };", "char a[2][3] = 01 00 00 02 03 00;");
    data("char a[2][3] = { 1, 2, 3, 4 };", "char a[2][3] = 01 02 03 04 00 00;");
    data("char a[][2] = { 1, 2, 3 };", "char a[2][2] = 01 02 03 00;");
    data(
        "struct { char a; short b; } x[] = { 1, 2, { 3 } };",
        "unnamed struct x[2] = 01 00 02 00 03 00 00 00;",
    );
    data(
        "union { char a; short b; } x = { 1 }, y = { .b = 515 };",
        "unnamed union x = 01 00;\nunnamed union y = 03 02;",
    );
    data("struct { int a : 3, b : 5, c : 24; } x = { 5, 1, 1 };", "unnamed struct x = 0d 01 00 00;");
    data(
        "struct { char a; struct { char b, c; }; char d; } x = { 1, 2, 3, 4 };",
        "unnamed struct x = 01 02 03 04;",
    );
    data("char a[3] = {};", "char a[3] = 00 00 00;");
    data("struct { char n; char rest[]; } x = { 2, { 7, 8 } };", "unnamed struct x = 02 07 08;");
}

#[test]
fn designators_choose_the_position() {
    data("char a[] = { [3] = 1, 2, [0] = 5 };", "char a[5] = 05 00 00 01 02;");
    data("char a[5] = { [1 ... 3] = 7, 8 };", "char a[5] = 00 07 07 07 08;");
    data("struct { char a, b[2]; } x = { .b = { 1, 2 }, .a = 3 };", "unnamed struct x = 03 01 02;");
    data("struct { char a, b[2], c; } x = { .b[1] = 1, 2 };", "unnamed struct x = 00 00 01 02;");
    data("struct { char a, b; } x = { b: 1 };", "unnamed struct x = 00 01;");
    data(
        "struct { char a; struct { char b; union { char c, d; }; }; } x = { .d = 4 };",
        "unnamed struct x = 00 00 04;",
    );
}

#[test]
fn strings_fill_arrays_or_become_objects() {
    data("char a[] = \"ab\";", "char a[3] = 61 62 00;");
    data("char a[4] = { \"ab\" };", "char a[4] = 61 62 00 00;");
    data("char a[2] = \"ab\";", "char a[2] = 61 62;");
    data("int a[] = L\"a\";", "int a[2] = 61 00 00 00 00 00 00 00;");
    data("char a[2][3] = { \"ab\", \"c\" };", "char a[2][3] = 61 62 00 63 00 00;");
    data(
        "char *a[] = { \"b\", 0 };",
        "char *a[2] = 00 00 00 00 00 00 00 00, @L.0+0 at 0;\nchar L.0[2] = 62 00;",
    );
    said("char a[2] = \"abc\";", &["1: long-string: the string is longer than the array"]);
}

#[test]
fn addresses_are_symbols_and_offsets() {
    data(
        "struct { int a, d[4]; } s; int *p = &s.d[2], q = (int)&s + 4; void f(void); void (*t[2])(void) = { f, &f };",
        "unnamed struct s;
        int *p = 00 00 00 00, @s+12 at 0;
        int q = 00 00 00 00, @s+4 at 0;
        void (*t[2])(void) = 00 00 00 00 00 00 00 00, @f+0 at 0, @f+0 at 4;",
    );
    data(
        "int a[10]; int *p = a + 3, *q = &a[9] - 1; float *r = (float *)(a + 1);",
        "int a[10];\nint *p = 00 00 00 00, @a+12 at 0;\nint *q = 00 00 00 00, @a+32 at 0;\nfloat *r = 00 00 00 00, @a+4 at 0;",
    );
    data("volatile double *p = (volatile double *)0x90100000;", "volatile double *p = 00 00 10 90;");
    data("struct S { int a; double b; }; int o = (int)&((struct S *)0)->b;", "int o = 08 00 00 00;");
    data(
        "int *p = (int[]){ 1, 2 };",
        "int *p = 00 00 00 00, @L.0+0 at 0;\nint L.0[2] = 01 00 00 00 02 00 00 00;",
    );
}

#[test]
fn locals_are_cleared_and_stored() {
    check(
        "void f(int i) { int a[3] = { i, 2 }; int b[2] = { 1, i }; char s[4] = \"ab\"; struct { char c; int d; } x = { 1 }; int n = i; }",
        "char L.0[4] = 61 62 00 00;
        void f(int i) {
          clear a;
          a{0:int} = i;
          a{4:int} = 2;
          b{0:int} = 1;
          b{4:int} = i;
          copy s <- @L.0;
          clear x;
          x{0:char} = 1:char;
          n = i;
        }",
    );
    check(
        "struct P { int x, y; }; int g(struct P *); int f(void) { return g(&(struct P){ 1, 2 }); }",
        "int f() {
          return g((t0{0:int} = 1, (t0{4:int} = 2, &t0)));
        }",
    );
}

#[test]
fn wrong_initialisers_are_errors() {
    said(
        "int g(void); int v;\nint a = g();\nint b = v;\nint c[2] = { 1, 2, 3 };\nint d[2] = 5;\nint e = { 1, 2 };\nstruct { int a; } f = { .b = 1 };\nint h[2] = { [2] = 1 };\nint k = 1 / 0;\nvoid t(void) { static int *p = &v, *q = (int *)&p; int l; static int *r = &l; }\nchar m = &v;\nextern struct X x = { 1 };",
        &[
            "2: error: the initialiser of a static object must be constant (assign it at the start of `main`)",
            "3: error: the initialiser of a static object must be constant (assign it at the start of `main`)",
            "4: error: too many initialisers for `int[2]`",
            "5: error: an array needs a list in braces (write `{ … }`)",
            "6: error: `int` takes one value",
            "7: error: `unnamed struct` has no member `b`",
            "8: error: the array has no element 2",
            "9: error: the initialiser of a static object must be constant (assign it at the start of `main`)",
            "11: int-pointer: initialiser makes an integer from a pointer without a cast (write `(char)` if this is meant)",
            "11: error: the initialiser of a static object must be constant (assign it at the start of `main`)",
            "12: error: an object cannot have the incomplete type `struct X`",
            "10: error: the initialiser of a static object must be constant (assign it at the start of `main`)",
        ],
    );
}
