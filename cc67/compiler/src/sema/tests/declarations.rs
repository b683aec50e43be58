//! Declarations: permitted repetitions, and their meaning.

use super::{accept, check, said};

#[test]
fn compatible_redeclarations_are_accepted() {
    accept(
        "extern int a; int a; int a; int a = 3; int a; static int s; static int s = 4;
        int f(); int f(int); int f(int x) { return x; } int f(int);
        typedef int T; typedef int T; typedef long T; struct S { int a; }; struct S { int a; };
        enum { A = 1, B }; enum { A = 1 }; extern int v[]; int v[3]; extern int v[];
        int g(void) { extern int a; int h(int); T b = a; return h(b) + sizeof v; }",
    );
}

#[test]
fn conflicting_redeclarations_are_reported() {
    said(
        "int a; double a;\nint b = 1; int b = 2;\ntypedef int T; typedef double T;\nstruct S { int a; }; struct S { int b; };\nenum { A }; enum { A = 5 };\nint f; int f(void);\nint g(void); int g;\nint h(int); int h(double);\nint p(void) { int i = 1; int i = 2; return i; }\nint q(int a) { int a = 0; return a; }",
        &[
            "1: error: `a` is redeclared with a different type",
            "2: error: `b` is defined twice with different values",
            "3: error: typedef `T` is redefined as a different type",
            "4: error: `S` is redefined with different members",
            "5: redeclared: enumerator `A` is redeclared with a different value",
            "6: error: `f` is already declared as something else",
            "7: error: `g` is already declared as something else",
            "8: prototype-mismatch: `h` is declared in two different ways",
            "9: redeclared: `i` is declared twice in one block",
            "10: redeclared: `a` hides a parameter",
        ],
    );
}

#[test]
fn implicit_int_gives_no_warning_where_it_is_intended() {
    accept("main() { static x = 0; const y = 1; register z = 2; return x + y + z; } f(int a) { return a; }");
    said(
        "x; y = 5; static z; f(const a) { return a; }",
        &[
            "1: implicit-int: declaration without a type is `int` (write `int`)",
            "1: implicit-int: declaration without a type is `int` (write `int`)",
            "1: implicit-int: declaration without a type is `int` (write `int`)",
            "1: implicit-int: declaration without a type is `int` (write `int`)",
        ],
    );
}

#[test]
fn static_locals_get_unique_names() {
    check(
        "int f(void) { static int n = 3; static double d[2]; { static int n; n++; } return n++; }",
        "int n.0 = 03 00 00 00;
        double d.1[2];
        int n.2;
        int f() {
          {
            old @n.2 += 1 in int;
          }
          return old @n.0 += 1 in int;
        }",
    );
}

#[test]
fn main_with_parameters_or_static_gives_a_warning() {
    said(
        "int main(int argc, char **argv) { return argc; }",
        &["1: main-parameters: `main` is called without arguments (write `main()`)"],
    );
    said("static main() {}", &["1: extension: `main` is declared `static` (remove `static`)"]);
}

#[test]
fn sizes_must_be_known_and_constant() {
    said(
        "const int N = 5; int a[N]; int b[-1]; int c[0x7fffffff];\nvoid f(int n) { int d[n]; int e[]; struct X x; void v; d[0] = 1; }\nstruct Y y; int g[];",
        &[
            "1: error: an array length must be an integer constant (use `#define` or `enum { … }`)",
            "1: error: an array cannot have -1 elements",
            "1: error: an array of 8589934588 bytes is too large",
            "2: error: an array length must be an integer constant (write the largest length that is needed, as a number)",
            "2: error: `e` has the incomplete type `int[]` (give the number of elements)",
            "2: error: `x` has the incomplete type `struct X`",
            "2: error: `v` has the incomplete type `void`",
            "3: error: `y` has the incomplete type `struct Y`",
        ],
    );
}

#[test]
fn static_functions_that_are_used_must_be_defined() {
    said(
        "static int f(void); static int g(void); int h(void) { return f(); }",
        &["1: error: `f` is declared `static` and used, but not defined"],
    );
}
